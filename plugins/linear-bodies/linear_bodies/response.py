"""Evaluation of a body's periodic response and of what moves it without friction, in kernels."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev, Polynomial

from frictionlab.theory import Floats
from frictionlab.tools import LinearBody, embedded, fast_embedded, inner, periodic_response

BEND, RATE, VALUE, INTEGRAL, TWICE = range(5)
EPSILON = 2.0**-52
"""Distance from one to the next floating-point number."""
PARTS, POWERS = 4, 12
"""Parts of a panel, and terms of a polynomial in one: there its terms fall four times as fast."""


class StepAnswer(NamedTuple):
    """A ``PeriodicResponse`` for kernels: tables [5, parts, POWERS] of V'' (BEND), of which less is asked, V', V, its
    integral and the integral of that, in powers of z in [-1, 1] in every part of a panel.

    static: x1 under a unit force at rest. error: of V.
    """

    period: float
    panels: int
    halvings: int
    tables: Any
    static: float
    error: float


class FreeWaves(NamedTuple):
    """Slip velocity without friction on a belt whose mean velocity is zero, and what has corners in it.

    waves [n, 3]: frequency, sine and cosine parts. corners [n, 2]: times in [0, period) and by how much the slope of
    the load jumps there; steady: added, so that the mean velocity is zero.
    """

    waves: Any
    corners: Any
    steady: float


@lru_cache(maxsize=4)
def _to_powers(terms: int) -> Floats:
    """Return the matrices from Chebyshev terms of a panel to powers of z in its parts [PARTS, POWERS, terms].

    There is no rounding: all numbers are whole over powers of two.
    """
    out = np.zeros((PARTS, POWERS, terms))
    for part in range(PARTS):
        inside = Polynomial([(2.0 * part + 1.0) / PARTS - 1.0, 1.0 / PARTS])
        for k in range(terms):
            powers = Chebyshev.basis(k).convert(kind=Polynomial)(inside).coef[:POWERS]
            out[part, : len(powers), k] = powers
    return out


@lru_cache(maxsize=64)
def response_of(body: LinearBody, frequency: float) -> StepAnswer:
    """Return the response to forces that repeat with this circular frequency, with V'' and the error of V."""
    found = periodic_response(body, frequency)
    to_powers = _to_powers(found.rate.shape[1])

    def powers(panels: Floats) -> Floats:
        return np.ascontiguousarray(np.einsum("ptk,nk->npt", to_powers, panels).reshape(-1, POWERS))

    rate = powers(found.rate)
    slopes = np.arange(POWERS) * rate * (2.0 * PARTS / np.repeat(found.lengths, PARTS))[:, None]
    bend = np.concatenate([slopes[:, 1:], np.zeros((len(slopes), 1))], axis=1)
    error = 4.0 * EPSILON * np.abs(found.value[:, 0]).max() + found.error * found.period / found.panels
    tables = np.array([bend, rate, *map(powers, (found.value, found.integral, found.twice))])
    return StepAnswer(found.period, found.panels, found.halvings, tables, found.static, float(error))


@embedded
def place(of: StepAnswer, u: float) -> tuple[int, float]:
    """Return the row of a time in [0, period] and z there: 0 is just after a jump, the period just before one."""
    share = min(max(u / of.period, 0.0), 1.0) * of.panels
    first = 0
    if of.halvings > 0 and share < 1.0:
        part, exponent = math.frexp(share)
        if part > 0.0 and -exponent < of.halvings:
            first, share = of.panels - exponent, 2.0 * part - 1.0
        else:
            first, share = of.panels + of.halvings, math.ldexp(share, of.halvings)
    row = min(int(PARTS * share), PARTS * of.panels - 1)
    return PARTS * first + row, 2.0 * (PARTS * share - row) - 1.0


@fast_embedded
def in_powers(tables: Any, which: int, row: int, z: float) -> float:
    """Return the polynomial of a row of a table, even and odd powers side by side."""
    y = z * z
    even, odd = tables[which, row, POWERS - 2], tables[which, row, POWERS - 1]
    for k in range(POWERS - 4, -1, -2):
        even, odd = even * y + tables[which, row, k], odd * y + tables[which, row, k + 1]
    return even + z * odd


@embedded
def wrapped(of: StepAnswer, u: float) -> float:
    """Return a time difference in [0, period)."""
    return u if 0.0 <= u < of.period else u - of.period * math.floor(u / of.period)


@embedded
def table_at(of: StepAnswer, which: int, u: float) -> float:
    """Return one of its tables a time in [0, period] after an impulse."""
    row, z = place(of, u)
    return in_powers(of.tables, which, row, z)


@embedded
def waves_at(waves: Any, t: float) -> tuple[float, float]:
    """Return the sum of waves [n, 3] and its rate."""
    value, rate = 0.0, 0.0
    for j in range(waves.shape[0]):
        omega = waves[j, 0]
        sine, cosine = math.sin(omega * t), math.cos(omega * t)
        value = value + (waves[j, 1] * sine + waves[j, 2] * cosine)
        rate = rate + omega * (waves[j, 1] * cosine - waves[j, 2] * sine)
    return value, rate


@inner
def free_slip(of: StepAnswer, forcing: FreeWaves, t: float) -> tuple[float, float]:
    """Return the slip velocity without friction on a belt whose mean velocity is zero, and its rate."""
    slip, rate = waves_at(forcing.waves, t)
    slip = slip + forcing.steady
    for c in range(forcing.corners.shape[0]):
        row, z = place(of, side_lag(of, t - forcing.corners[c, 0], False))
        bend = forcing.corners[c, 1]
        slip = slip + bend * in_powers(of.tables, INTEGRAL, row, z)
        rate = rate + bend * (in_powers(of.tables, VALUE, row, z) - of.static / of.period)
    return slip, rate


@embedded
def side_lag(of: StepAnswer, since: float, before: bool) -> float:
    """Return a time after an instant in [0, period]; at the instant 0 just after it and the period just before it."""
    u = wrapped(of, since)
    if u < 1e-13 * of.period or u > of.period * (1.0 - 1e-13):
        return of.period if before else 0.0
    return u
