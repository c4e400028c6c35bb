"""Response in time of a linear body to a jump of force in every period, from its response in frequency.

V(t) = (1/T) sum over all k of H(i k Omega) exp(i k Omega t), T = 2 pi/Omega, is the position after a unit
impulse of force in every period, and, up to a constant, the velocity after a unit step of force at every t =
0. V' jumps by 1/mass at 0. The sum up to k = K is taken term by term; the rest is closed by the formula of
Abel and Plana in its midpoint form, c = K + 1/2, f(k) = H(i k Omega) exp(i k Omega t):

    sum over k > K of f(k)
        = i integral over y > 0 of [f(c + iy) + exp(-2 pi y) f(c - iy)] / (1 + exp(-2 pi y)),

in which exp(i k Omega t) decays. First a body (p + lam)^-2 / mass + d (p + lam)^-3 with the same response to
high frequencies, in closed form, is subtracted, so that the remaining part of V' is continuous.

Source: Olver, Asymptotics and Special Functions (1974), section 8.3.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from frictionlab.scene.receptance import ComplexValues, LinearBody
from frictionlab.values.quantities import Floats

TERMS = 16
"""Number of Chebyshev terms of a panel. A sine through half a radian a side is a polynomial of 15th degree to
rounding, and so is a power over [1/2, 1]."""
RADIANS_OF_PANEL = 2.5
"""Radians of the quickest free motion in a panel."""
HALVINGS = 40
"""Halvings of the first panel, where the response has powers of t that are not whole numbers."""

_k = np.arange(TERMS)
_at = -np.cos(np.pi * (_k + 0.5) / TERMS)
_PLACES: Floats = 0.5 * (1.0 + _at)
TO_CHEBYSHEV: Floats = (2.0 / TERMS * np.cos(np.outer(_k, np.arccos(_at)))) * np.where(_k == 0, 0.5, 1.0)[
    :, None
]
"""Matrix from values at Chebyshev's points of a panel to coefficients."""

_step = 0.1
_u = np.arange(-3.4, 38.0, _step)
_y = np.exp(_u - np.exp(-_u))
_WEIGHTS = _step * _y * (1.0 + np.exp(-_u)) / (1.0 + np.exp(-2.0 * np.pi * _y))


class PeriodicResponse(NamedTuple):
    """V', V, the integral W of V less its mean, and that of W, in Chebyshev polynomials of panels.

    Both integrals have mean zero.

    Panels 0 ... panels - 1 are equally long. With halvings > 0 the first one is not used. Those from
    ``panels`` on are its right half, the right half of its left half and so on; the last one is all that is
    left. lengths: of all panels. static: x1 under a unit force at rest. error: of V'.
    """

    period: float
    panels: int
    halvings: int
    rate: Floats
    value: Floats
    integral: Floats
    twice: Floats
    lengths: Floats
    static: float
    error: float

    def at(self, table: Floats, since: Floats) -> Floats:
        """Evaluate one of the tables at these times in [0, period] after an impulse."""
        starts, _, order = _panels(self.panels, self.halvings)
        panel = order[np.searchsorted(starts[order], since / self.period, side="right") - 1]
        z = 2.0 * (since - starts[panel] * self.period) / self.lengths[panel] - 1.0
        return np.asarray(np.polynomial.chebyshev.chebval(z, table[panel].T, tensor=False))


@lru_cache(maxsize=256)
def periodic_response(body: LinearBody, frequency: float) -> PeriodicResponse:
    """Return the response to forces that repeat with this circular frequency."""
    period = 2.0 * math.pi / frequency
    count = max(4, math.ceil(period * body.detail / RADIANS_OF_PANEL))
    halvings = 0 if body.smooth else HALVINGS
    starts, lengths, order = _panels(count, halvings)
    first = max(1.0, frequency)  # rate at which the reference decays
    reference = Reference(1.0 / body.mass, 2.0 * first / body.mass - body.damping / body.mass**2, first)
    at = starts[:, None] + lengths[:, None] * _PLACES
    values = _summed(body, reference, frequency, count, halvings) + reference.rate(period, period * at)
    rate = values @ TO_CHEBYSHEV.T
    lengths = period * lengths
    static = float(body.receptance(np.zeros(1))[0].real)
    value = _primitive(rate, lengths, order, static / period)
    less = value.copy()
    less[:, 0] -= static / period
    integral = _primitive(less, lengths, order, 0.0)
    twice = _primitive(integral, lengths, order, 0.0)
    error = float(np.abs(rate[order, -2:]).max())
    return PeriodicResponse(period, count, halvings, rate, value, integral, twice, lengths, static, error)


@lru_cache(maxsize=64)
def _panels(count: int, halvings: int) -> tuple[Floats, Floats, Any]:
    """Return starts and lengths of all panels in shares of the period, and the used ones in order of time."""
    halves = 0.5 ** np.arange(halvings + 1.0)
    starts = np.concatenate([np.arange(count), halves[1:], [0.0] * (halvings > 0)]) / count
    lengths = np.concatenate([np.ones(count), halves[1:], halves[-1:] * (halvings > 0)][: 2 + (halvings > 0)])
    lengths = lengths[: len(starts)] / count
    used = np.arange(1 if halvings else 0, len(starts))
    return starts, lengths, used[np.argsort(starts[used])]


class Reference(NamedTuple):
    """Body (p + lam)^-2 a + d (p + lam)^-3."""

    a: float
    d: float
    lam: float

    def receptance(self, p: ComplexValues) -> ComplexValues:
        """Return x1 over force."""
        q = 1.0 / (p + self.lam)
        return q * q * (self.a + self.d * q)

    def rate(self, period: float, t: Floats) -> Floats:
        """Return V' in closed form, 0 <= t <= period: the sum of responses to all earlier impulses.

        There is an impulse in every period.
        """
        lam, e = self.lam, math.exp(-self.lam * period)
        one = 1.0 / (1.0 - e)
        # Sums over m of (t + m T)^j exp(-lam m T), j = 0, 1, 2.
        first = period * e * one**2
        second = period**2 * e * (1.0 + e) * one**3
        s0, s1 = one, t * one + first
        s2 = t * t * one + 2.0 * t * first + second
        return np.exp(-lam * t) * (self.a * (s0 - lam * s1) + self.d * (s1 - 0.5 * lam * s2))


@lru_cache(maxsize=16)
def _tail_factors(count: int, halvings: int) -> tuple[Floats, Floats]:
    """Return exp(-y theta) and exp(-y (2 pi - theta)) [nodes, y], with the weights of the integral over y."""
    starts, lengths, _ = _panels(count, halvings)
    theta = 2.0 * np.pi * (starts[:, None] + lengths[:, None] * _PLACES).reshape(-1, 1)
    with np.errstate(under="ignore"):
        return np.exp(-_y * theta) * _WEIGHTS, np.exp(-_y * (2.0 * np.pi - theta)) * _WEIGHTS


def _summed(body: LinearBody, reference: Reference, frequency: float, count: int, halvings: int) -> Floats:
    """Return the share of V' of the harmonics of body less reference, at every node [panels, nodes]."""
    known = math.floor(max(body.known_to, 2.0 * reference.lam) / frequency)
    omega = frequency * np.arange(1.0, known + 1.0)
    p = 1j * omega
    harmonics = p * (body.receptance(omega) - reference.receptance(p))
    starts, lengths, _ = _panels(count, halvings)
    theta = 2.0 * np.pi * (starts[:, None] + lengths[:, None] * _PLACES)
    total = np.zeros(theta.shape, dtype=np.complex128)
    for k, each in enumerate(harmonics, 1):
        total += each * np.exp(1j * k * theta)
    middle = known + 0.5
    up, down = 1j * frequency * (middle + 1j * _y), 1j * frequency * (middle - 1j * _y)
    far, near = _tail_factors(count, halvings)
    closed = _sums(far, up * (body.beyond(up) - reference.receptance(up)))
    closed = closed + _sums(near, down * (body.beyond(down) - reference.receptance(down)))
    total += 1j * np.exp(1j * middle * theta) * closed.reshape(theta.shape)
    return total.real * (frequency / np.pi)


def _sums(factors: Floats, terms: ComplexValues) -> ComplexValues:
    """Return the product of a real matrix and a complex vector."""
    return np.asarray(factors @ terms.real + 1j * (factors @ terms.imag))


def _primitive(rate: Floats, lengths: Floats, order: Any, mean: float) -> Floats:
    """Return the continuous integral of panels of Chebyshev polynomials, with this mean over the period.

    The highest degree of the integral is left out.
    """
    integrals = np.zeros_like(rate)
    n = TERMS
    k = np.arange(1, n)
    after = np.concatenate([rate[:, 2:], np.zeros((len(rate), 1))], axis=1)
    before = rate[:, :-1].copy()
    before[:, 0] *= 2.0
    integrals[:, 1:] = 0.5 * lengths[:, None] * (before - after) / (2.0 * k)
    signs = np.where(np.arange(n) % 2, -1.0, 1.0)
    means = np.where(np.arange(n) % 2, 0.0, 1.0 / (1.0 - np.arange(n) ** 2.0 + (np.arange(n) == 1)))
    at, total = 0.0, 0.0
    for panel in order:
        integrals[panel, 0] = at - (integrals[panel, 1:] * signs[1:]).sum()
        at = integrals[panel].sum()
        total += lengths[panel] * (integrals[panel] * means).sum()
    integrals[order, 0] += mean - total / lengths[order].sum()
    return integrals
