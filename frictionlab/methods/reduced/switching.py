"""What friction that switches does to a linear mass along a line: its free oscillation between the switches."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.quantities import Floats

COALESCED = 1e-5
"""Smallest distance kept between the two free exponents: critical damping is approached, never met."""


class Jumps(NamedTuple):
    """The velocity of x'' + 2 beta x' + x = force after unit jumps of the force that repeat every period.

    A jump at 0 gives the sum of weight*exp(exponent t), 0 <= t < period: the periodic Green's function.
    """

    exponents: NDArray[np.complex128]
    weights: NDArray[np.complex128]
    period: float

    @classmethod
    def of(cls, damping_ratio: float, frequency: float) -> Jumps:
        """Of a body, and jumps that repeat with this frequency; weights not finite where it resonates undamped."""
        period = 2.0 * math.pi / frequency
        root = np.sqrt(complex(damping_ratio**2 - 1.0))
        root = root if abs(root) > COALESCED else COALESCED
        exponents = np.array([root - damping_ratio, -root - damping_ratio])
        if damping_ratio > 1.0:
            exponents[0] = 1.0 / exponents[1]  # their product is 1: no cancellation in the slow one
        signs = np.array([1.0, -1.0], np.complex128)
        with np.errstate(divide="ignore", invalid="ignore"):
            return cls(exponents, signs / (-2.0 * root * np.expm1(exponents * period)), period)

    def rise(self, t: Floats) -> Floats:
        """The velocity at t less that at 0, without cancellation."""
        return self._sum(self.weights, np.expm1(self._powers(t)))

    def rise_before(self, t: Floats) -> Floats:
        """The same at period - t."""
        powers = self._powers(t)
        ends = np.exp(self._powers(self.period - t))
        return self._sum(-self.weights, ends * np.expm1(powers))

    def slope(self, t: Floats) -> Floats:
        """Its time derivative, at 0 that after the jump."""
        return self._sum(self.weights * self.exponents, np.exp(self._powers(t)))

    def after(self, switches: Floats, jumps: Floats) -> NDArray[np.complex128]:
        """Amplitudes (row, switch, exponent) of the velocity from each switch on, of jumps that sum to zero.

        switches: (row, switch), ascending within a period.
        """
        since = np.mod(switches[:, :, None] - switches[:, None, :], self.period)
        return self.weights * np.einsum("rj,rkje->rke", jumps, np.expm1(self._powers(since)))

    def largest_rise(self) -> float:
        """The largest rise of the velocity between any two instants of a period."""
        rises = self.rise(self._extremes(self.weights))
        return float(rises.max() - rises.min())

    def steepest_slope(self) -> float:
        """The largest size of the velocity's time derivative."""
        return float(np.abs(self.slope(self._extremes(self.weights * self.exponents))).max())

    def _extremes(self, weights: NDArray[np.complex128]) -> Floats:
        """Instants of a period among which the sum of weight*exp(exponent t) is largest and least."""
        (first, second), (slow, quick) = weights * self.exponents, self.exponents
        if slow.imag != 0.0:  # the derivative 2 Re(first exp(slow t)) vanishes twice in a free period
            turn = math.fmod(1.5 * math.pi - float(np.angle(first)), math.pi) / slow.imag
            inner = np.array([turn, turn + math.pi / slow.imag])
        else:
            ratio = float((-second / first).real)
            inner = np.array([math.log(ratio) / float((slow - quick).real)]) if ratio > 0.0 else np.zeros(0)
        inside = inner[(inner > 0.0) & (inner < self.period)]
        return np.concatenate([[0.0, self.period], inside])

    def _powers(self, t: Floats) -> NDArray[np.complex128]:
        return np.asarray(t)[..., None] * self.exponents

    def _sum(self, weights: NDArray[np.complex128], values: NDArray[np.complex128]) -> Floats:
        return (values @ weights).real
