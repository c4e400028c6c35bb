"""Sums of sines and a straight line for kernels: value, derivatives, bounds, integrals."""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension
from frictionlab.scene.varying import PER_WAVE, Course

number_at = by_dimension(
    lambda table, place, example: table[place],
    lambda table, place, example: complex(table[place], table[place + 1]),
)
"""number_at(table, place, example): number at this place of a table, float or complex as the example is."""


@inner
def _turned(table: Any, place: int, angle: float, example: Any) -> Any:
    """Return the wave whose numbers begin at this place of the table, at this angle."""
    sine, cosine = number_at(table, place + 1, example), number_at(table, place + 3, example)
    return sine * math.sin(angle) + cosine * math.cos(angle)


@inner
def wave_at(table: Any, course: Course, begins: float, tau: float) -> Any:
    """Return the value at time tau; begins: time at which the line has ``course.value``."""
    total = course.value + (tau - begins) * course.slope
    for j in range(course.terms):
        place = course.first + PER_WAVE * j
        total = total + _turned(table, place, table[place] * tau, course.value)
    return total


@inner
def wave_rate(table: Any, course: Course, tau: float, order: int) -> Any:
    """Return the derivative of this order, 1 or higher."""
    total = course.slope if order == 1 else 0.0 * course.slope
    for j in range(course.terms):
        # every derivative is the wave a quarter of a period later
        place = course.first + PER_WAVE * j
        angle = table[place] * tau + 0.5 * math.pi * order
        total = total + table[place] ** order * _turned(table, place, angle, course.value)
    return total


@inner
def wave_bound(table: Any, course: Course, order: int) -> float:
    """Return a bound on the size of the derivative of this order, 1 or higher, at any time."""
    total = abs(course.slope) if order == 1 else 0.0
    for j in range(course.terms):
        place = course.first + PER_WAVE * j
        sine, cosine = (
            number_at(table, place + 1, course.value),
            number_at(table, place + 3, course.value),
        )
        total = total + table[place] ** order * (abs(sine) + abs(cosine))
    return total


@inner
def wave_impulse(table: Any, course: Course, begins: float, start: float, end: float) -> Any:
    """Return the integral from start to end; begins: time at which the line has ``course.value``."""
    lasts, middle = end - start, 0.5 * (start + end)
    total = lasts * (course.value + (middle - begins) * course.slope)
    for j in range(course.terms):
        place = course.first + PER_WAVE * j
        half = 0.5 * table[place] * lasts
        mean = math.sin(half) / half if half > 0.0 else 1.0
        total = total + (lasts * mean) * _turned(table, place, table[place] * middle, course.value)
    return total


@inner
def wave_path_integral(table: Any, course: Course, begins: float, start: float, end: float) -> Any:
    """Return the integral, from start to end, of the integral since the start."""
    lasts = end - start
    total = 0.5 * lasts * lasts * (course.value + (start + lasts / 3.0 - begins) * course.slope)
    for j in range(course.terms):
        place = course.first + PER_WAVE * j
        frequency = table[place]
        first, half = frequency * start, 0.5 * frequency * lasts
        # integral of a sine: lasts*cos(first) less lasts times the mean cosine, over the frequency
        mean = math.sin(half) / half if half > 0.0 else 1.0
        by_sine = lasts * (math.cos(first) - mean * math.cos(first + half)) / frequency
        by_cosine = lasts * (mean * math.sin(first + half) - math.sin(first)) / frequency
        sine, cosine = (
            number_at(table, place + 1, course.value),
            number_at(table, place + 3, course.value),
        )
        total = total + sine * by_sine + cosine * by_cosine
    return total
