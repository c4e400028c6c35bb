"""Sums of sines and a straight line for kernels: value, derivatives, bounds, integrals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frictionlab.compile.decorators import fast, fast_embedded, inner
from frictionlab.compile.dispatch import by_dimension
from frictionlab.motion.linalg import dimension
from frictionlab.motion.steppers.dop853 import TIMES
from frictionlab.scene.varying import (
    BELT_FIRST,
    BELT_TERMS,
    LOAD_FIRST,
    LOAD_TERMS,
    PER_WAVE,
    POWERS,
    PRESS_FIRST,
    PRESS_TERMS,
    STAGES,
    TERMS,
    TURNS,
    WAVE_POWERS,
    Course,
)

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


# --- courses of a body --------------------------------------------------------------------------------------------


@fast_embedded
def load_course(body: Any) -> Course:
    """Return the load in the current piece."""
    table, at, zero = body.varying.table, body.varying.at, body.reference_sine
    value, slope = number_at(table, at, zero), number_at(table, at + 2, zero)
    return Course(int(table[LOAD_FIRST]), int(table[LOAD_TERMS]), value, slope)


@fast_embedded
def belt_course(body: Any) -> Course:
    """Return the belt's vibration in the current piece."""
    table, at, zero = body.varying.table, body.varying.at, body.reference_sine
    value, slope = number_at(table, at + 4, zero), number_at(table, at + 6, zero)
    return Course(int(table[BELT_FIRST]), int(table[BELT_TERMS]), value, slope)


@fast_embedded
def press_course(body: Any) -> Course:
    """Return what the normal load adds to its mean in the current piece."""
    table, at = body.varying.table, body.varying.at
    return Course(int(table[PRESS_FIRST]), int(table[PRESS_TERMS]), table[at + 8], table[at + 9])


# --- polynomials about an anchor ----------------------------------------------------------------------------------
#
# The variable s is the angle of the quickest wave since the anchor. A polynomial is TERMS coefficients of s^0, s^2,
# and so on, followed by TERMS of s^1, s^3, ...: to a radian the rest is below rounding. In the plane those of x2
# follow those of x1.


@fast
def polynomial(table: Any, at: int, s: float) -> float:
    """Return the value of the polynomial at this place of the table."""
    q = s * s
    even, odd = table[at + TERMS - 1], table[at + 2 * TERMS - 1]
    for k in range(1, TERMS):
        even = even * q + table[at + TERMS - 1 - k]
        odd = odd * q + table[at + 2 * TERMS - 1 - k]
    return even + s * odd


@fast
def polynomial_slope(table: Any, at: int, s: float) -> float:
    """Return the derivative by s."""
    q = s * s
    even, odd = 0.0, 0.0
    for k in range(TERMS):
        power = 2 * (TERMS - 1 - k)
        odd = odd * q + (power + 1) * table[at + 2 * TERMS - 1 - k]
        if power > 0:
            even = even * q + power * table[at + TERMS - 1 - k]
    return s * even + odd


@fast
def polynomial_bend(table: Any, at: int, s: float) -> float:
    """Return the second derivative by s."""
    q = s * s
    even, odd = 0.0, 0.0
    for k in range(TERMS - 1):
        power = 2 * (TERMS - 1 - k)
        even = even * q + power * (power - 1) * table[at + TERMS - 1 - k]
        odd = odd * q + (power + 1) * power * table[at + 2 * TERMS - 1 - k]
    return even + s * odd


value_near = by_dimension(
    lambda table, at, s, zero: polynomial(table, at, s),
    lambda table, at, s, zero: complex(polynomial(table, at, s), polynomial(table, at + 2 * TERMS, s)),
)
"""value_near(table, at, s, zero): value of a polynomial, that of x1 and x2 in the plane."""
slope_near = by_dimension(
    lambda table, at, s, zero: polynomial_slope(table, at, s),
    lambda table, at, s, zero: complex(
        polynomial_slope(table, at, s), polynomial_slope(table, at + 2 * TERMS, s)
    ),
)
bend_near = by_dimension(
    lambda table, at, s, zero: polynomial_bend(table, at, s),
    lambda table, at, s, zero: complex(
        polynomial_bend(table, at, s), polynomial_bend(table, at + 2 * TERMS, s)
    ),
)


@fast
def integrate(table: Any, at: int, to: int, unit: float) -> None:
    """Leave the integral of one polynomial, times unit and zero at the anchor, as another."""
    table[to] = 0.0
    for k in range(TERMS - 1):
        table[to + 1 + k] = unit * table[at + TERMS + k] / (2 * k + 2)
    for k in range(TERMS):
        table[to + TERMS + k] = unit * table[at + k] / (2 * k + 1)


_part = by_dimension(lambda k, value: value, lambda k, value: value.real if k == 0 else value.imag)
"""_part(k, value): part of a value along x1 (0) or x2 (1)."""


@fast_embedded
def begin_expansion(table: Any, to: int, value: Any, slope: Any) -> None:
    """Write a polynomial: the wave at the drive's frequency with this value, and this slope by the drive's angle."""
    for part in range(dimension(value)):
        here, rate, first = _part(part, value), _part(part, slope), to + 2 * TERMS * part
        for k in range(TERMS):
            table[first + k] = here * table[POWERS + k]
            table[first + TERMS + k] = rate * table[POWERS + TERMS + k]


@fast_embedded
def expand(
    table: Any, to: int, first: int, terms: int, factor: float, tau: float, turn: complex, zero: Any
) -> None:
    """Add factor times so many waves to a polynomial about tau; turn: exp(i Omega tau) of the drive."""
    now = complex(factor, 0.0)  # factor*exp(i frequency tau) of a wave, from that of the wave before it
    for j in range(terms):
        place = first + PER_WAVE * j
        turns = int(table[place + TURNS])
        if turns < 0:
            angle = table[place] * tau
            now = complex(factor * math.cos(angle), factor * math.sin(angle))
        for _ in range(turns):
            now = now * turn
        for part in range(dimension(zero)):
            sine, cosine, at = table[place + 1 + part], table[place + 3 + part], to + 2 * TERMS * part
            value, slope = sine * now.imag + cosine * now.real, sine * now.real - cosine * now.imag
            powers = place + WAVE_POWERS
            for k in range(TERMS):
                table[at + k] = table[at + k] + value * table[powers + k]
                table[at + TERMS + k] = table[at + TERMS + k] + slope * table[powers + TERMS + k]


@fast_embedded
def clear(table: Any, to: int, zero: Any) -> None:
    """Write the polynomial 0."""
    for k in range(2 * TERMS * dimension(zero)):
        table[to + k] = 0.0


@fast_embedded
def add_line(table: Any, to: int, value: Any, slope: Any) -> None:
    """Add a value and a slope by s to a polynomial."""
    for part in range(dimension(value)):
        at = to + 2 * TERMS * part
        table[at] = table[at] + _part(part, value)
        table[at + TERMS] = table[at + TERMS] + _part(part, slope)


# --- values at the stages of a step -------------------------------------------------------------------------------

STAGE_TIMES = np.array(TIMES)
"""Times of the stages over the step."""
assert STAGE_TIMES.size == STAGES


@fast_embedded
def note(table: Any, at: int, to: int, begin: float, step: float, zero: Any) -> None:
    """Leave the values of a polynomial at all stages of a step; begin, step: s at its start, and its length."""
    for part in range(dimension(zero)):
        here, there = at + 2 * TERMS * part, to + STAGES * part
        for i in range(STAGES):
            s = begin + step * STAGE_TIMES[i]
            q = s * s
            even, odd = table[here + TERMS - 1], table[here + 2 * TERMS - 1]
            for k in range(1, TERMS):
                even = even * q + table[here + TERMS - 1 - k]
                odd = odd * q + table[here + 2 * TERMS - 1 - k]
            table[there + i] = even + s * odd


noted = by_dimension(
    lambda table, at, stage, zero: table[at + stage],
    lambda table, at, stage, zero: complex(table[at + stage], table[at + STAGES + stage]),
)
"""noted(table, at, stage, zero): value that ``note`` left for a stage."""
