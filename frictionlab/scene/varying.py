"""What changes in time otherwise than as one sine: its numbers, and one array of them for kernels.

An array of numba's is seven numbers and counts references: a dozen of them in a record that every function is handed
make a kernel compile for minutes. Kernels hold a bare pointer, and the few numbers of the piece that holds.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.quantities import Floats
from frictionlab.scene.signals import Signal, Signals


class Waves(NamedTuple):
    """Sum of sine[j]*sin(frequency[j] tau) + cosine[j]*cos(frequency[j] tau), along x1 and x2 as x1 + i x2."""

    frequency: Floats
    sine: Any
    cosine: Any


class Varying(NamedTuple):
    """What changes in time otherwise than as one sine, in pieces between corners of any of its functions.

    Within a piece every function is smooth, and beyond its ends it goes on as within.
    edges [pieces + 1]: from 0 to the common period; lines [pieces]: value at the beginning of each piece, and slope.
    periods: of the drive in a common period. quickest: the highest frequency of any wave, at least that of the drive.
    belt_swing: the largest velocity of the belt's vibration.
    constant_contact: whether bristles keep the stiffness of the mean normal load.
    """

    load: Waves
    belt: Waves
    normal_load: Waves
    edges: Floats
    load_lines: Any
    load_slopes: Any
    belt_lines: Any
    belt_slopes: Any
    normal_lines: Floats
    normal_slopes: Floats
    periods: float
    quickest: float
    belt_swing: float
    constant_contact: bool


def varying_of(signals: Signals, frequency: float, constant_contact: bool) -> Varying:
    """The numbers of signals, those along x1 and x2 as x1 + i x2; frequency: of the drive."""
    edges = signals.edges()
    middles = 0.5 * (edges[:-1] + edges[1:])
    half = 0.5 * np.diff(edges)
    every = (*signals.load, *signals.belt, signals.normal_load)
    quickest = max((wave.frequency for each in every for wave in each.waves), default=frequency)
    load, load_lines, load_slopes = _planar_waves(*signals.load, middles, half)
    belt, belt_lines, belt_slopes = _planar_waves(*signals.belt, middles, half)
    normal, normal_lines, normal_slopes = _planar_waves(signals.normal_load, Signal(), middles, half)
    return Varying(
        load=load,
        belt=belt,
        normal_load=normal,
        edges=edges,
        load_lines=load_lines,
        load_slopes=load_slopes,
        belt_lines=belt_lines,
        belt_slopes=belt_slopes,
        normal_lines=normal_lines.real.copy(),
        normal_slopes=normal_slopes.real.copy(),
        periods=float(round(signals.period * frequency / (2.0 * math.pi))),
        quickest=max(quickest, frequency),
        belt_swing=math.hypot(*(max(map(abs, each.extremes(signals.period))) for each in signals.belt)),
        constant_contact=constant_contact,
    )


def _planar_waves(along: Signal, across: Signal, middles: Floats, half: Floats) -> tuple[Waves, Any, Any]:
    """The waves; the values of the lines at the beginnings of all pieces, and their slopes."""
    waves = [(each.frequency, each.phasor, 0j) for each in along.waves]
    waves += [(each.frequency, 0j, each.phasor) for each in across.waves]
    frequency = np.array([each for each, _, _ in waves])
    sine = np.array([complex(first.real, second.real) for _, first, second in waves], dtype=np.complex128)
    cosine = np.array([complex(first.imag, second.imag) for _, first, second in waves], dtype=np.complex128)
    (first, rise), (second, rise_2) = along.lines_at(middles), across.lines_at(middles)
    slopes = rise + 1j * rise_2
    lines = first + 1j * second - half * slopes
    return Waves(frequency, sine, cosine), lines, slopes


PER_WAVE = 5
"""Frequency, real and imaginary part of the sine's factor and of the cosine's."""
PER_PIECE = 10
"""Value and slope, real and imaginary, of the load and of the belt; value and slope of the normal load."""


class Course(NamedTuple):
    """One function of time: so many waves from this place of the table on, and a line with this value where the piece
    begins and this slope; numbers are real on the line and x1 + i x2 in the plane."""

    first: int
    terms: int
    value: Any
    slope: Any


class Whole(NamedTuple):
    """What is the same in every piece: where in the table the numbers of the pieces (lines) and their ends (edges)
    are, how many pieces there are, and of ``Varying`` the periods, quickest and belt_swing."""

    lines: int
    edges: int
    pieces: int
    periods: float
    quickest: float
    belt_swing: float


class Packed(NamedTuple):
    """``Varying`` for kernels; begins: when the piece that holds does.

    keeps_stiffness: filled where the contact does while the normal load changes, a type of its own for kernels.
    table: an array, in kernels a pointer to its items: the waves of the load, the belt and the normal load, then the
    numbers of every piece, then their ends.
    """

    table: Any
    whole: Whole
    begins: float
    load: Course
    belt: Course
    normal_load: Course
    keeps_stiffness: Any


def packed(varying: Any, planar: bool) -> Any:
    """The table of what varies; nothing where nothing does."""
    if not isinstance(varying, Varying):
        return varying
    waves = varying.load, varying.belt, varying.normal_load
    counts = [each.frequency.size for each in waves]
    ends = np.cumsum([PER_WAVE * count for count in counts])
    lines = np.column_stack(
        [
            varying.load_lines.real,
            varying.load_lines.imag,
            varying.load_slopes.real,
            varying.load_slopes.imag,
            varying.belt_lines.real,
            varying.belt_lines.imag,
            varying.belt_slopes.real,
            varying.belt_slopes.imag,
            varying.normal_lines,
            varying.normal_slopes,
        ]
    )
    table = np.concatenate([*(_rows(each) for each in waves), lines.ravel(), varying.edges])
    kind = complex if planar else float
    load, belt = (
        Course(int(end) - PER_WAVE * count, count, kind(_part(value, planar)), kind(_part(slope, planar)))
        for end, count, value, slope in zip(
            ends[:2],
            counts[:2],
            (varying.load_lines[0], varying.belt_lines[0]),
            (varying.load_slopes[0], varying.belt_slopes[0]),
            strict=True,
        )
    )
    normal = Course(int(ends[1]), counts[2], float(varying.normal_lines[0]), float(varying.normal_slopes[0]))
    return Packed(
        table=table,
        whole=Whole(
            lines=int(ends[2]),
            edges=int(ends[2]) + lines.size,
            pieces=len(lines),
            periods=varying.periods,
            quickest=varying.quickest,
            belt_swing=varying.belt_swing,
        ),
        begins=0.0,
        load=load,
        belt=belt,
        normal_load=normal,
        keeps_stiffness=(1.0,) if varying.constant_contact else (),
    )


def _part(value: Any, planar: bool) -> Any:
    return value if planar else value.real


def _rows(waves: Waves) -> Any:
    parts = [waves.frequency, waves.sine.real, waves.sine.imag, waves.cosine.real, waves.cosine.imag]
    return np.column_stack(parts).ravel()
