"""Excitations other than one sine: their numbers, and one array of them for kernels.

An array of numba's is seven numbers and counts references: a dozen of them in a record that every function
receives make a kernel compile for minutes. Kernels therefore hold a bare pointer, and the few numbers of the
current piece.
"""

from __future__ import annotations

import math
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
    constant_contact: true if bristles keep the stiffness of the mean normal load.
    """

    load: Function
    belt: Function
    normal_load: Function
    edges: Floats
    periods: float
    quickest: float
    belt_swing: float
    constant_contact: bool


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


PER_WAVE = 5
"""Count of numbers per wave: frequency, real and imaginary part of the sine's factor and of the cosine's."""
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


class Whole(NamedTuple):
    """Numbers that are the same in every piece.

    lines, edges: places in the table of the numbers of the pieces and of their ends. pieces: their count.
    periods, quickest, belt_swing: as in ``Varying``. fastest, x, velocity: largest velocity along x1, against
    the belt's vibration, of the motion without friction, and its state at tau = 0; infinite if not known.
    """

    lines: int
    edges: int
    pieces: int
    periods: float
    quickest: float
    belt_swing: float
    fastest: float = math.inf
    x: float = 0.0
    velocity: float = 0.0


class Packed(NamedTuple):
    """``Varying`` for kernels; begins: start of the current piece.

    keeps_stiffness: filled if the contact keeps its stiffness while the normal load changes, a type of its
    own for kernels. table: an array, in kernels a pointer to its items: the waves of the load, the belt and
    the normal load, then the numbers of every piece, then their ends.
    """

    table: Any
    whole: Whole
    begins: float
    load: Course
    belt: Course
    normal_load: Course
    keeps_stiffness: Any


def packed(varying: Any, planar: bool) -> Any:
    """Return the table of everything that varies; empty if nothing does."""
    if not isinstance(varying, Varying):
        return varying
    functions = varying.load, varying.belt, varying.normal_load
    counts = [function.waves.frequency.size for function in functions]
    ends = np.cumsum([PER_WAVE * count for count in counts]).tolist()
    every = [part for function in functions[:2] for line in function[1:] for part in (line.real, line.imag)]
    lines = np.column_stack([*every, *(line.real for line in varying.normal_load[1:])])
    table = np.concatenate([*(_rows(function.waves) for function in functions), lines.ravel(), varying.edges])
    load, belt, normal = (
        Course(end - PER_WAVE * count, count, *(_number(line[0], plane) for line in function[1:]))
        for end, count, function, plane in zip(ends, counts, functions, (planar, planar, False), strict=True)
    )
    whole = Whole(
        lines=ends[2],
        edges=ends[2] + lines.size,
        pieces=len(lines),
        periods=varying.periods,
        quickest=varying.quickest,
        belt_swing=varying.belt_swing,
    )
    stiff = (1.0,) if varying.constant_contact else ()
    return Packed(table, whole, 0.0, load, belt, normal, stiff)


def _number(value: Any, planar: bool) -> Any:
    return complex(value) if planar else float(value.real)


def _rows(waves: Waves) -> Any:
    parts = [waves.frequency, waves.sine.real, waves.sine.imag, waves.cosine.real, waves.cosine.imag]
    return np.column_stack(parts).ravel()
