"""Functions of time that are smooth between corners: their zeros, largest value and integrals."""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.scene.signals import Signal, Wave
from frictionlab.values.quantities import EPSILON, Floats

PieceNumbers = NDArray[np.int64]
_ROUNDING = 8.0 * EPSILON
"""Relative size below which a value of a piecewise function counts as rounding."""
_FINEST = EPSILON
"""Smallest half-length of an interval that is cut, over the period.

A shorter one has no floating-point number between its ends near the end of the period."""


class FreeMotion(NamedTuple):
    """Free motions of an oscillator x'' + damping x' + stiffness x = 0, one on each piece.

    x, v: at the beginnings of the pieces. order: 0 if the function is x, 1 if it is x', and so on.
    """

    damping: float
    stiffness: float
    x: Floats
    v: Floats
    order: int

    def derivatives(self, since: Floats, k: PieceNumbers) -> tuple[Floats, Floats]:
        """Return the derivative of this order and the next one, at times since the start of the pieces k."""
        cosine, sine = oscillation(self.damping, self.stiffness, since)
        x0, v0, half = self.x[k], self.v[k], 0.5 * self.damping
        x = x0 * (cosine + half * sine) + v0 * sine
        v = v0 * (cosine - half * sine) - x0 * (self.stiffness * sine)
        found = [x, v]
        for _ in range(self.order):
            found.append(-self.damping * found[-1] - self.stiffness * found[-2])
        return found[self.order], found[self.order + 1]

    def curvature(self) -> Floats:
        """Bound the second derivative of the function on each piece.

        The bound is valid because the energy of a free motion never grows.
        """
        swing = np.sqrt(self.stiffness * self.x**2 + self.v**2)
        return swing * (math.sqrt(self.stiffness) + self.damping) ** (self.order + 1)


def oscillation(damping: float, stiffness: float, since: Floats) -> tuple[Floats, Floats]:
    """Return exp(-damping/2 t) times cosine, and times sine/frequency, of the damped oscillation.

    For an overdamped oscillator these are the hyperbolic functions.
    """
    half = 0.5 * damping
    square = stiffness - half**2
    frequency = math.sqrt(abs(square))
    if square > 0.0:
        fade = np.exp(-half * since)
        return fade * np.cos(frequency * since), fade * np.sin(frequency * since) / frequency
    # both exponentials separately: a hyperbolic function would overflow
    slow = np.exp(-(stiffness / (half + frequency)) * since)
    share = -np.expm1(-2.0 * frequency * since)
    sine = since * slow if frequency == 0.0 else slow * share / (2.0 * frequency)
    return slow * (1.0 - 0.5 * share), sine


class Piecewise(NamedTuple):
    """Sum of waves, a straight line on each piece, and a free motion.

    edges [n + 1]: from 0 to the period. middle, slope [n]: value at mid-piece and slope of the straight line.
    """

    edges: Floats
    middle: Floats
    slope: Floats
    waves: tuple[Wave, ...] = ()
    free: FreeMotion | None = None

    @property
    def period(self) -> float:
        """Period: the end of the last piece."""
        return float(self.edges[-1])

    def at(self, tau: Floats, k: PieceNumbers) -> tuple[Floats, Floats]:
        """Return value and derivative at times on the pieces k.

        A piece continues smoothly beyond its ends.
        """
        slope = self.slope[k]
        value = self.middle[k] + slope * (tau - 0.5 * (self.edges[k] + self.edges[k + 1]))
        for frequency, phasor in self.waves:
            angle = frequency * tau
            sine, cosine = np.sin(angle), np.cos(angle)
            value = value + phasor.real * sine + phasor.imag * cosine
            slope = slope + frequency * (phasor.real * cosine - phasor.imag * sine)
        if self.free is not None:
            first, second = self.free.derivatives(tau - self.edges[k], k)
            value, slope = value + first, slope + second
        return value, slope

    def curvature(self) -> Floats:
        """Bound the second derivative on each piece."""
        bound = np.full(len(self.middle), sum(each.frequency**2 * abs(each.phasor) for each in self.waves))
        return bound if self.free is None else bound + self.free.curvature()

    def size(self) -> float:
        """Bound the magnitude of the function, the scale of rounding."""
        half = 0.5 * np.diff(self.edges)
        bound = np.abs(self.middle) + np.abs(self.slope) * half
        if self.free is not None:
            rate = math.sqrt(self.free.stiffness)
            swing = np.sqrt(self.free.x**2 + (self.free.v / rate) ** 2)
            bound = bound + swing * (rate + self.free.damping) ** self.free.order
        return float(bound.max()) + sum(abs(each.phasor) for each in self.waves)

    def integral(self, start: Floats, stop: Floats, k: PieceNumbers) -> Floats:
        """Integrate waves and lines between two times on the pieces k.

        ``free`` must be None: it is not integrated.
        """
        middle, length = 0.5 * (start + stop), stop - start
        total = length * (
            self.middle[k] + self.slope[k] * (middle - 0.5 * (self.edges[k] + self.edges[k + 1]))
        )
        for frequency, phasor in self.waves:
            angle = frequency * middle
            share = 2.0 * np.sin(0.5 * frequency * length) / frequency
            total = total + share * (phasor.real * np.sin(angle) + phasor.imag * np.cos(angle))
        return np.asarray(total)

    def minus(self, level: float) -> Piecewise:
        """Return the function minus a constant."""
        return self._replace(middle=self.middle - level)

    def negative(self) -> Piecewise:
        """Return the negative of the function."""
        free = self.free and self.free._replace(x=-self.free.x, v=-self.free.v)
        waves = tuple(Wave(each.frequency, -each.phasor) for each in self.waves)
        return Piecewise(self.edges, -self.middle, -self.slope, waves, free)

    def maximum(self) -> float:
        """Return the largest value, to rounding.

        Intervals that cannot hold it are dropped, the others cut in two.
        """
        k = np.arange(len(self.middle))
        start, stop, curvature = self.edges[:-1], self.edges[1:], self.curvature()
        best, rounding = -math.inf, _ROUNDING * self.size()
        while len(k):
            middle, half = 0.5 * (start + stop), 0.5 * (stop - start)
            value, slope = self.at(middle, k)
            ends = [self.at(each, k)[0] for each in (start, stop)]
            best = max(best, *(float(each.max()) for each in (value, *ends)))
            most = value + np.abs(slope) * half + 0.5 * curvature[k] * half**2
            left = (most > best + rounding) & (half > _FINEST * self.period)
            start, stop, k = _halves(start, stop, k, left)
        return best

    def at_rest(self) -> NDArray[np.bool_]:
        """Mark the pieces on which the function is zero throughout."""
        still = (self.slope == 0.0) & (self.curvature() == 0.0)
        return still & (np.abs(self.middle) <= _ROUNDING * self.size()) if still.any() else still

    def crossings(self) -> Crossings:
        """Return the zeros of the function.

        Intervals that cannot hold a zero are dropped, the others cut in two.
        """
        if len(self.waves) == 1 and self.free is None and not self.slope.any() and np.ptp(self.middle) == 0.0:
            return self._crossings_of_a_sine()
        k = np.flatnonzero(~self.at_rest())
        start, stop, curvature = self.edges[k], self.edges[k + 1], self.curvature()
        rounding, found = _ROUNDING * self.size(), Crossings(np.empty(0), np.empty(0))
        while len(k):
            middle, half = 0.5 * (start + stop), 0.5 * (stop - start)
            value, slope = self.at(middle, k)
            most = np.abs(slope) * half + 0.5 * curvature[k] * half**2
            near = np.abs(value) <= most + rounding
            lost = near & ((np.abs(value) + most <= 4.0 * rounding) | (half <= _FINEST * self.period))
            monotone = near & ~lost & (np.abs(slope) > curvature[k] * half)
            found = found.plus(self._roots(start[monotone], stop[monotone], k[monotone], rounding))
            found = found.plus(Crossings(middle[lost], 2.0 * half[lost]))
            start, stop, k = _halves(start, stop, k, near & ~lost & ~monotone)
        return found

    def _crossings_of_a_sine(self) -> Crossings:
        """Return the zeros of a constant plus one sine, in closed form.

        Rounded values near a turning point of the sine would give a zero with half of the digits.
        """
        (frequency, phasor), level = self.waves[0], float(self.middle[0])
        size, far = abs(phasor), abs(level)
        if far >= size:
            return Crossings(np.empty(0), np.empty(0))
        half = 2.0 * math.asin(math.sqrt(0.5 * (size - far) / size))
        peak = -math.copysign(0.5 * math.pi, level) - cmath.phase(phasor)
        turns = math.tau * np.arange(round(frequency * self.period / math.tau))
        angles = np.add.outer(np.array([peak - half, peak + half]), turns).ravel()
        tau = np.sort(np.mod(angles / frequency, self.period))
        unsure = 2.0 * EPSILON / (frequency * math.sin(half)) + 4.0 * EPSILON * self.period
        return Crossings(tau, np.full(len(tau), unsure))

    def _roots(self, start: Floats, stop: Floats, k: PieceNumbers, rounding: float) -> Crossings:
        """Return the zero in each of these intervals, on which the function rises or falls throughout."""
        first, last = self.at(start, k)[0], self.at(stop, k)[0]
        inside = (first < 0.0) != (last < 0.0)
        low, high, k, rises = start[inside], stop[inside], k[inside], (last > first)[inside]
        tau, room = 0.5 * (low + high), high - low
        for _ in range(60 if len(k) else 0):
            value, slope = self.at(tau, k)
            above = (value > 0.0) == rises
            low, high = np.where(above, low, tau), np.where(above, tau, high)
            newton = tau - value / slope  # slope is not zero: the function is monotone
            following = np.where((newton >= low) & (newton <= high), newton, 0.5 * (low + high))
            moved, tau = np.abs(following - tau), following
            if not np.any(moved > EPSILON * self.period):
                break
        slope = np.abs(self.at(tau, k)[1])
        return Crossings(tau, np.minimum(2.0 * rounding / slope, room))


class Crossings(NamedTuple):
    """Zeros of a function, and the error of each due to rounded values of the function."""

    tau: Floats
    unsure: Floats

    def plus(self, other: Crossings) -> Crossings:
        """Return the zeros of both."""
        return Crossings(*(np.concatenate(pair) for pair in zip(self, other, strict=True)))


def _halves(
    start: Floats, stop: Floats, k: PieceNumbers, which: NDArray[np.bool_]
) -> tuple[Floats, Floats, PieceNumbers]:
    """Return both halves of each marked interval."""
    low, high, k = start[which], stop[which], k[which]
    middle = 0.5 * (low + high)
    return np.concatenate([low, middle]), np.concatenate([middle, high]), np.concatenate([k, k])


def piecewise(signal: Signal, edges: Floats, mean: float = 0.0) -> Piecewise:
    """Return a signal, plus a constant, on pieces between these edges."""
    middle, slope = signal.lines_at(0.5 * (edges[:-1] + edges[1:]))
    return Piecewise(edges, middle + mean, slope, signal.waves)
