"""Functions of time that repeat: sums of sines, and straight lines between corners."""

from __future__ import annotations

import cmath
import itertools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from frictionlab.scene.waveforms import Form
from frictionlab.values.quantities import Floats

FULL_TURN = 2.0 * math.pi


class Segment(NamedTuple):
    """Straight line from one corner to the next, again in every period: start, value there, and slope."""

    start: float  # in [0, period)
    value: float
    slope: float


class Segments(NamedTuple):
    """Function that is straight between its corners; its lines are in the order of their starts.

    period: that in time.
    """

    period: float
    lines: tuple[Segment, ...]

    def at(self, tau: Floats) -> tuple[Floats, Floats]:
        """Compute values and slopes; at a corner those after it."""
        starts = np.array([line.start for line in self.lines])
        phase = np.mod(tau, self.period)
        # Before the first corner of a period the last line of the one before continues.
        k = np.searchsorted(starts, phase, side="right") - 1
        since = np.where(k < 0, phase + self.period, phase) - starts[k]
        values, slopes = (np.array([line[field] for line in self.lines])[k] for field in (1, 2))
        return values + slopes * since, slopes


class Wave(NamedTuple):
    """Sine of one frequency: Im(phasor exp(i frequency tau))."""

    frequency: float
    phasor: complex


class Signal(NamedTuple):
    """Sum of waves and of lines with corners; zero if it has neither."""

    waves: tuple[Wave, ...] = ()
    pieces: tuple[Segments, ...] = ()

    def __call__(self, tau: ArrayLike) -> Floats:
        """Compute the value at these times; at a jump that after it."""
        at = np.asarray(tau, dtype=np.float64)
        total = sum((piece.at(at)[0] for piece in self.pieces), np.zeros(at.shape))
        return sum((_wave(wave, at) for wave in self.waves), total)

    def lines_at(self, tau: Floats) -> tuple[Floats, Floats]:
        """Compute value and slope of the lines alone."""
        nothing = np.zeros(tau.shape)
        found = [piece.at(tau) for piece in self.pieces]
        return sum((value for value, _ in found), nothing), sum((slope for _, slope in found), nothing)

    def scaled(self, factor: float) -> Signal:
        """Return the signal times a factor; an empty signal for a factor of zero."""
        if factor == 0.0:
            return Signal()
        waves = tuple(Wave(wave.frequency, factor * wave.phasor) for wave in self.waves)
        pieces = tuple(
            Segments(piece.period, tuple(Segment(a, factor * b, factor * c) for a, b, c in piece.lines))
            for piece in self.pieces
        )
        return Signal(waves, pieces)

    def plus(self, other: Signal) -> Signal:
        """Return the sum of two signals."""
        return Signal(self.waves + other.waves, self.pieces + other.pieces)

    @property
    def mean(self) -> float:
        """Mean over time."""
        total = 0.0
        for period, lines in self.pieces:
            ends = [*(line.start for line in lines[1:]), lines[0].start + period]
            for (start, value, slope), end in zip(lines, ends, strict=True):
                total += (value + 0.5 * slope * (end - start)) * (end - start) / period
        return total

    def corners(self, end: float) -> list[float]:
        """Return its corners in [0, end)."""
        found = (
            line.start + k * piece.period
            for piece in self.pieces
            for line in piece.lines
            for k in range(round(end / piece.period) + 1)
        )
        return sorted(tau for tau in found if tau < end)

    def between(self, tau: Floats) -> Floats:
        """Compute the value at rising times from one corner to the next; at both ends that between them."""
        middle = 0.5 * (tau[0] + tau[-1])
        value, slope = (float(numbers[0]) for numbers in self.lines_at(np.array([middle])))
        return sum((_wave(wave, tau) for wave in self.waves), value + slope * (tau - middle))

    def reaches_beyond(self, frequency: float) -> bool:
        """Check whether any of its harmonics is above this frequency."""
        return bool(self.pieces) or any(wave.frequency > frequency for wave in self.waves)

    def harmonic(self, frequency: float, end: float) -> complex:
        """Compute the phasor of its harmonic of this frequency, over a period ``end`` of everything."""
        total = sum((wave.phasor for wave in self.waves if math.isclose(wave.frequency, frequency)), 0j)
        edges = [0.0, *self.corners(end), end]
        for start, stop in itertools.pairwise(edges):
            if stop > start:
                total += _line_in_harmonic(self, frequency, start, stop) * 2.0 / end
        return total

    def extremes(self, end: float) -> tuple[float, float]:
        """Compute the least and the largest value over a period ``end``."""
        if not self.pieces and len(self.waves) <= 1:
            size = abs(self.waves[0].phasor) if self.waves else 0.0
            return -size, size
        quickest = max((wave.frequency for wave in self.waves), default=0.0)
        edges = [0.0, *self.corners(end), end]
        low, high = math.inf, -math.inf
        for start, stop in itertools.pairwise(edges):
            if stop <= start:
                continue
            n = 3 + 2 * math.ceil(1000.0 * quickest * (stop - start) / FULL_TURN)
            values = self.between(np.linspace(start, stop, n))
            low, high = min(low, -highest(-values)), max(high, highest(values))
        return low, high


def _wave(wave: Wave, tau: Floats) -> Floats:
    angle = wave.frequency * tau
    return wave.phasor.real * np.sin(angle) + wave.phasor.imag * np.cos(angle)


def highest(values: Floats) -> float:
    """Return the largest value: the top of the parabola through three neighbours if it is between them."""
    at = min(max(int(np.argmax(values)), 1), len(values) - 2)
    left, middle, right = values[at - 1 : at + 2]
    bend, rise = left - 2.0 * middle + right, 0.5 * (right - left)
    if bend < 0.0 and abs(rise) <= -bend:
        return float(middle - 0.5 * rise**2 / bend)
    return float(values.max())


def _line_in_harmonic(signal: Signal, frequency: float, start: float, stop: float) -> complex:
    """Compute the integral of the lines times i exp(-i frequency tau), between two corners."""
    middle = 0.5 * (start + stop)
    value, slope = (float(numbers[0]) for numbers in signal.lines_at(np.array([middle])))
    half, turn = 0.5 * frequency * (stop - start), cmath.exp(-1j * frequency * middle)
    even = 2.0 * math.sin(half) / frequency
    odd = -2j * (math.sin(half) - half * math.cos(half)) / frequency**2
    return 1j * turn * (value * even + slope * odd)


def constant(value: float, period: float) -> Signal:
    """Return a signal of one value, as a line that begins anew in every period; an empty one for zero."""
    return Signal(pieces=(Segments(period, (Segment(0.0, value, 0.0),)),)) if value else Signal()


def signal_of(form: Form, frequency: float, phase: float, mean: bool = True) -> Signal:
    """Return the signal of a waveform of unit size at this circular frequency; phase in degrees.

    mean: whether it keeps its mean.
    """
    lifted = 0.0 if mean else form.mean
    start, period = math.radians(phase), FULL_TURN / frequency
    waves = tuple(
        Wave(
            term.order * frequency, cmath.rect(term.amplitude, math.radians(term.phase) + term.order * start)
        )
        for term in form.waves
    )
    lines = sorted(
        Segment(
            _wrapped((float(at) * FULL_TURN - start) / frequency, period),
            float(value) - lifted,
            float(slope) / FULL_TURN * frequency,
        )
        for at, value, slope in form.lines
    )
    return Signal(waves, (Segments(period, tuple(lines)),) if lines else ())


def _wrapped(tau: float, period: float) -> float:
    """Return the time within [0, period); a time that is a rounding error below its end becomes 0."""
    rest = math.fmod(math.fmod(tau, period) + period, period)
    return 0.0 if period - rest <= 1e-14 * period else rest


def edges_of(corners: list[float], period: float) -> Floats:
    """Return the ends of the pieces between corners, from 0 to the period; a rounding error long is none of them."""
    return np.array([0.0, *(tau for tau in corners if 1e-13 < tau / period < 1.0 - 1e-13), period])


class Signals(NamedTuple):
    """Excitations of a scene along x1 and x2: everything that changes in time.

    period: the time after which all of them repeat [1/omega_1]. load: in [K_1 L]. belt: vibration of the
    belt's velocity, or for a prescribed slip the oscillation of the slip [omega_1 L]. normal_load: variation
    of the normal load [K_1 L].
    """

    period: float
    load: tuple[Signal, Signal]
    belt: tuple[Signal, Signal]
    normal_load: Signal

    def corners(self) -> list[float]:
        """Return the times in [0, period) of all corners; times a rounding error apart are one."""
        every = (*self.load, *self.belt, self.normal_load)
        found: list[float] = []
        for tau in sorted({tau for signal in every for tau in signal.corners(self.period)}):
            if not found or tau - found[-1] > 1e-13 * self.period:
                found.append(tau)
        return found

    def edges(self) -> Floats:
        """Return the ends of the pieces between corners [pieces + 1], from 0 to the period."""
        return edges_of(self.corners(), self.period)
