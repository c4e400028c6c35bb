"""Excitations other than one sine: their numbers, and one array of them for kernels.

An array of numba's is seven numbers and counts references: a dozen of them in a record that every function
receives make a kernel compile for minutes. Kernels therefore hold a bare pointer, and the few numbers of the
current piece.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from frictionlab.scene.signals import Signal, Signals
from frictionlab.values.quantities import Floats


class Waves(NamedTuple):
    """Sum of sine[j]*sin(frequency[j] tau) + cosine[j]*cos(frequency[j] tau), as x1 + i x2."""

    frequency: Floats
    sine: Any
    cosine: Any


class Function(NamedTuple):
    """Function of time, smooth in every piece: waves and lines.

    lines, slopes [pieces]: values of the lines at the start of each piece, and their slopes.
    Values are x1 + i x2, those of a normal load real.
    """

    waves: Waves
    lines: Any
    slopes: Any

    def scaled(self, factor: float) -> Function:
        """Return the function times a factor."""
        frequency, sine, cosine = self.waves
        waves = Waves(frequency, factor * sine, factor * cosine)
        return Function(waves, factor * self.lines, factor * self.slopes)


class Varying(NamedTuple):
    """Excitations other than one sine, in pieces between corners of any of their functions.

    Beyond the ends of a piece every function continues as within it. edges [pieces + 1]: ends of the pieces,
    from 0 to the common period. periods: number of periods of the drive in a common period. quickest: highest
    frequency of any wave, at least that of the drive. belt_swing: largest velocity of the belt's vibration.
    constant_contact: true if bristles keep the stiffness of the mean normal load. fastest: -1 if one sine is all
    that varies, else infinity.
    """

    load: Function
    belt: Function
    normal_load: Function
    edges: Floats
    periods: float
    quickest: float
    belt_swing: float
    constant_contact: bool
    fastest: float = math.inf


def varying_of(signals: Signals, frequency: float, constant_contact: bool) -> Varying:
    """Return the numbers of signals; ``frequency`` is that of the drive."""
    edges = signals.edges()
    every = (*signals.load, *signals.belt, signals.normal_load)
    quickest = max((wave.frequency for signal in every for wave in signal.waves), default=frequency)
    return Varying(
        load=_function(signals.load, edges),
        belt=_function(signals.belt, edges),
        normal_load=_function((signals.normal_load, Signal()), edges),
        edges=edges,
        periods=float(round(signals.period * frequency / (2.0 * math.pi))),
        quickest=max(quickest, frequency),
        belt_swing=math.hypot(*(max(map(abs, signal.extremes(signals.period))) for signal in signals.belt)),
        constant_contact=constant_contact,
    )


def _function(pair: tuple[Signal, Signal], edges: Floats) -> Function:
    """Return the function of time of a signal along x1 and one along x2."""
    along, across = pair
    waves = [(wave.frequency, wave.phasor, 0j) for wave in along.waves]
    waves += [(wave.frequency, 0j, wave.phasor) for wave in across.waves]
    frequency = np.array([number for number, _, _ in waves])
    sine = np.array([complex(first.real, second.real) for _, first, second in waves], dtype=np.complex128)
    cosine = np.array([complex(first.imag, second.imag) for _, first, second in waves], dtype=np.complex128)
    middles = 0.5 * (edges[:-1] + edges[1:])
    (first, rise), (second, rise_2) = along.lines_at(middles), across.lines_at(middles)
    slopes = rise + 1j * rise_2
    return Function(
        Waves(frequency, sine, cosine), first + 1j * second - 0.5 * np.diff(edges) * slopes, slopes
    )


# The table of numbers that kernels take: head, rows of waves, lines of every piece, ends of the pieces.
#
# The head begins with the polynomials and stage values that a step of slip leaves there (motion/waves.py).

TERMS, STAGES = 8, 12
"""Counts of even and of odd terms of a polynomial, and of the stages of a step.

Within a radian 16 terms are right to 5e-14 of a wave, and within .7 radians to rounding: longer are only steps that
are asked to be right to less than 1e-4.
"""
SWING, PUSH, SHARE, PLACE = 0, 4 * TERMS, 8 * TERMS, 10 * TERMS
"""Polynomials: slip of the reference, load that it leaves, normal load over its mean, way of the reference."""
AT_SWING, AT_PUSH, AT_SHARE, AT_PLACE = (12 * TERMS + k * STAGES for k in (0, 2, 4, 5))
"""Their values at the stages."""
POWERS = 12 * TERMS + 6 * STAGES
"""Terms of cosine and sine of r*s, with r the frequency of the drive over the quickest."""
(
    PUSHES, PRESSES, REST_FIRST, REST_TERMS, LINES, EDGES, PIECES, PERIODS, QUICKEST, BELT_SWING, FASTEST, FREE_X,
    FREE_VELOCITY, LOAD_FIRST, LOAD_TERMS, BELT_FIRST, BELT_TERMS, PRESS_FIRST, PRESS_TERMS, WAVES,
) = range(POWERS + 2 * TERMS, POWERS + 2 * TERMS + 20)  # fmt: skip
"""Numbers that are the same in every piece.

PUSHES, PRESSES: 1 if the reference leaves some load, if the normal load changes. REST: rows of the load that is left.
FASTEST: largest velocity along x1, against the belt's vibration, of the motion without friction; infinite if not
known, -1 if one sine is all. FREE: state of that motion at tau = 0. WAVES: number of waves of every kind.
"""
HEAD = WAVES + 1

WAVE_POWERS, TURNS = 5, 5 + 2 * TERMS
PER_WAVE = TURNS + 1
"""Count of numbers per wave: frequency, real and imaginary part of the sine's factor and of the cosine's, terms of
cosine and sine as in POWERS, and how many multiples of the drive it is above the wave before (-1: none)."""
MOST_TURNS = 8
"""Largest number of them; a sine and a cosine of its own cost less than more."""
PER_PIECE = 10
"""Count of numbers per piece.

They are value and slope, real and imaginary, of load and belt; value and slope of the normal load."""


class Course(NamedTuple):
    """Function of time in a piece: its waves and its line.

    The waves are ``terms`` many from place ``first`` of the table. The line has this value at the start of
    the piece and this slope. Numbers are real on the line and x1 + i x2 in the plane.
    """

    first: int
    terms: int
    value: Any
    slope: Any


class Packed(NamedTuple):
    """``Varying`` for kernels; begins: start of the current piece. at: place of its lines in the table.

    keeps_stiffness: filled if the contact keeps its stiffness while the normal load changes, which compilers then
    know. table: an array, in kernels a pointer to its items.
    """

    table: Any
    begins: float
    at: int
    keeps_stiffness: Any


def packed(varying: Varying, balanced: tuple[complex, complex], drive: float) -> Packed:
    """Return the table of everything that varies.

    balanced: sine and cosine of the load that the reference motion takes. drive: its frequency.
    """
    quickest, press = varying.quickest, varying.normal_load
    left = _left(varying.load.waves, balanced, drive)
    waves = varying.load.waves, varying.belt.waves, press.waves, left
    terms = [each.frequency.size for each in waves]
    firsts = [HEAD + PER_WAVE * sum(terms[:k]) for k in range(5)]
    pieces = varying.edges.size - 1
    edges = firsts[4] + PER_PIECE * pieces
    table = np.zeros(edges + pieces + 1)
    table[AT_SHARE : AT_SHARE + STAGES] = 1.0
    table[POWERS : POWERS + 2 * TERMS] = _powers(drive / quickest)
    table[PUSHES] = terms[3] > 0 or _has_lines(varying.load)
    table[PRESSES] = terms[2] > 0 or _has_lines(press)
    table[REST_FIRST : REST_TERMS + 1] = firsts[3], terms[3]
    table[LINES : WAVES + 1] = (
        firsts[4], edges, pieces, varying.periods, quickest, varying.belt_swing, varying.fastest, 0.0, 0.0,
        firsts[0], terms[0], firsts[1], terms[1], firsts[2], terms[2], sum(terms[:3]),
    )  # fmt: skip
    for first, each in zip(firsts[:4], waves, strict=True):
        _write_rows(table, first, each, quickest, drive)
    lines = table[firsts[4] : edges].reshape(pieces, PER_PIECE)
    for k, each in enumerate(
        (varying.load.lines, varying.load.slopes, varying.belt.lines, varying.belt.slopes)
    ):
        lines[:, 2 * k], lines[:, 2 * k + 1] = each.real, each.imag
    lines[:, 8], lines[:, 9] = press.lines.real, press.slopes.real
    table[edges:] = varying.edges
    return Packed(table, 0.0, firsts[4], (1.0,) if varying.constant_contact else ())


def _has_lines(function: Function) -> bool:
    return bool(function.lines.any() or function.slopes.any())


_NO_LINE, _NO_NUMBER = np.zeros(1, complex), np.zeros(0)
_NOTHING = Function(Waves(_NO_NUMBER, _NO_NUMBER + 0j, _NO_NUMBER + 0j), _NO_LINE, _NO_LINE)
NEVER = 1e300
"""Time of the end of the only piece where nothing has corners."""


def of_one_sine(sine: complex, cosine: complex, frequency: float) -> Varying:
    """Return the numbers of a load that is one sine, or of none, and of nothing else that varies."""
    load = _NOTHING
    if sine != 0 or cosine != 0:
        waves = Waves(np.array([frequency]), np.array([complex(sine)]), np.array([complex(cosine)]))
        load = load._replace(waves=waves)
    return Varying(load, _NOTHING, _NOTHING, np.array([0.0, NEVER]), NEVER, frequency, 0.0, False, -1.0)


def _write_rows(table: Floats, first: int, waves: Waves, quickest: float, drive: float) -> None:
    """Write PER_WAVE numbers for each wave."""
    last = 0
    for j, (frequency, sine, cosine) in enumerate(zip(*waves, strict=True)):
        row = table[first + PER_WAVE * j : first + PER_WAVE * (j + 1)]
        row[:WAVE_POWERS] = frequency, sine.real, sine.imag, cosine.real, cosine.imag
        row[WAVE_POWERS:TURNS] = _powers(frequency / quickest)
        multiple = round(frequency / drive)
        exact = abs(frequency - multiple * drive) <= 1e-15 * frequency and 0 <= multiple - last <= MOST_TURNS
        row[TURNS] = multiple - last if exact else -1
        last = multiple if exact else 10**9


_ORDERS = np.concatenate([np.arange(0, 2 * TERMS, 2), np.arange(1, 2 * TERMS, 2)])
_FACTORS = np.array([(-1.0) ** (n // 2) / math.factorial(n) for n in _ORDERS.tolist()])


@lru_cache(maxsize=256)  # a curve, and curves of one waveform, share them
def _powers(ratio: float) -> Floats:
    """Return the terms of the cosine of ratio*s, then those of its sine [2*TERMS]."""
    terms: Floats = _FACTORS * ratio**_ORDERS
    return terms


def _left(waves: Waves, balanced: tuple[complex, complex], drive: float) -> Waves:
    """Return what the reference leaves of the waves of a load, by frequency."""
    left = {drive: (-balanced[0], -balanced[1])}
    for frequency, sine, cosine in zip(*waves, strict=True):
        before = left.get(frequency, (0j, 0j))
        left[frequency] = before[0] + sine, before[1] + cosine
    kept = sorted(frequency for frequency, (sine, cosine) in left.items() if sine != 0 or cosine != 0)
    pairs = [left[frequency] for frequency in kept]
    return Waves(np.array(kept), *(np.array([pair[k] for pair in pairs], dtype=complex) for k in (0, 1)))
