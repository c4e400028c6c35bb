"""Evaluation of a body's periodic response and of what moves it without friction, in kernels."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.quantities import EPSILON
from frictionlab.theory.periodic_response import TERMS, PeriodicResponse


class StepAnswer(NamedTuple):
    """A ``PeriodicResponse`` for kernels: V'', of which less is asked, V', V and its integral [panels, TERMS].

    static: x1 under a unit force at rest. error: of V.
    """

    period: float
    panels: int
    halvings: int
    bend: Any
    rate: Any
    value: Any
    integral: Any
    static: float
    error: float


def response_of(found: PeriodicResponse) -> StepAnswer:
    """With V'' and the error of V."""
    slopes = np.polynomial.chebyshev.chebder(found.rate, axis=1) * (2.0 / found.lengths[:, None])
    bend = np.concatenate([slopes, np.zeros((len(slopes), 1))], axis=1)
    error = 4.0 * EPSILON * np.abs(found.value[:, 0]).max() + found.error * found.period / found.panels
    parts = bend, found.rate, found.value, found.integral
    return StepAnswer(found.period, found.panels, found.halvings, *parts, found.static, float(error))


@inner
def place(of: StepAnswer, u: float) -> tuple[int, float]:
    """The panel of a time in [0, period] and where it lies in it, in [-1, 1]: 0 is just after a jump, the period just
    before the next."""
    share = min(max(u / of.period, 0.0), 1.0) * of.panels
    if of.halvings > 0 and share < 1.0:
        part, exponent = math.frexp(share)
        if part > 0.0 and -exponent < of.halvings:
            return of.panels - exponent, 4.0 * part - 3.0
        return of.panels + of.halvings, math.ldexp(share, of.halvings + 1) - 1.0
    panel = min(int(share), of.panels - 1)
    return panel, 2.0 * (share - panel) - 1.0


@inner
def chebyshev(coefficients: Any, panel: int, x: float) -> float:
    """Clenshaw's sum."""
    last, now = 0.0, 0.0
    for k in range(TERMS - 1, 0, -1):
        last, now = now, 2.0 * x * now - last + coefficients[panel, k]
    return x * now - last + coefficients[panel, 0]


@inner
def wrapped(of: StepAnswer, u: float) -> float:
    """A time difference in [0, period)."""
    return u - of.period * math.floor(u / of.period)


@inner
def response_value(of: StepAnswer, u: float) -> float:
    """V, at any time difference."""
    panel, x = place(of, wrapped(of, u))
    return chebyshev(of.value, panel, x)


@inner
def rate_at(of: StepAnswer, u: float) -> float:
    """V' a time in [0, period] after an impulse."""
    panel, x = place(of, u)
    return chebyshev(of.rate, panel, x)


@inner
def bend_at(of: StepAnswer, u: float) -> float:
    """V'' a time in [0, period] after an impulse."""
    panel, x = place(of, u)
    return chebyshev(of.bend, panel, x)


@inner
def integral_at(of: StepAnswer, u: float) -> float:
    """The integral of V less its mean, at any time difference."""
    panel, x = place(of, wrapped(of, u))
    return chebyshev(of.integral, panel, x)


@inner
def free_slip(waves: Any, t: float) -> tuple[float, float]:
    """The slip velocity without friction on a belt whose mean velocity is zero, and its rate.

    waves [n, 3]: frequency, sine and cosine parts.
    """
    slip, rate = 0.0, 0.0
    for j in range(waves.shape[0]):
        omega = waves[j, 0]
        sine, cosine = math.sin(omega * t), math.cos(omega * t)
        slip = slip + (waves[j, 1] * sine + waves[j, 2] * cosine)
        rate = rate + omega * (waves[j, 1] * cosine - waves[j, 2] * sine)
    return slip, rate
