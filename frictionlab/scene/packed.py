"""What changes in time in one array, as kernels hold it: a bare pointer, and the few numbers of the piece that holds.

An array of numba's is seven numbers and counts references: a dozen of them in a record that every function is handed
make a kernel compile for minutes.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.scene.body import Varying, Waves

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


class Packed(NamedTuple):
    """``Varying`` for kernels; begins: when the piece that holds does.

    table: an array, in kernels a pointer to its items: the waves of the load, the belt and the normal load, then from
    ``lines`` on the numbers of every piece, then from ``edges`` on their ends.
    """

    table: Any
    begins: float
    load: Course
    belt: Course
    normal_load: Course
    lines: int
    edges: int
    pieces: int
    periods: float
    quickest: float
    belt_swing: float
    constant_contact: bool


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
        begins=0.0,
        load=load,
        belt=belt,
        normal_load=normal,
        lines=int(ends[2]),
        edges=int(ends[2]) + lines.size,
        pieces=len(lines),
        periods=varying.periods,
        quickest=varying.quickest,
        belt_swing=varying.belt_swing,
        constant_contact=varying.constant_contact,
    )


def _part(value: Any, planar: bool) -> Any:
    return value if planar else value.real


def _rows(waves: Waves) -> Any:
    parts = [waves.frequency, waves.sine.real, waves.sine.imag, waves.cosine.real, waves.cosine.imag]
    return np.column_stack(parts).ravel()
