"""Motion of the mass under Coulomb friction in intervals: flow in slip, functions of time, and their integrals.

    x'' + 2 b x' + x + s mu N(tau) = F(tau), slip velocity w = x' - B(tau) of sign s.

Positions and velocities are absolute: where only the belt's velocity jumps, nothing of the flow does.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from flint import acb, arb

from certified.forces import Forces, Sine, SmoothPiece, TimeCourse


class NotProved(Exception):
    """Failure of a proof, and at what."""


class PieceTime(NamedTuple):
    """Time, the common periods passed before it, and the piece that holds there."""

    tau: Any  # since the start of that common period
    piece: int


class Values(NamedTuple):
    """Function of time and its first two derivatives."""

    value: Any
    rate: Any
    bend: Any


class FreeFlow(NamedTuple):
    """Free motion over a time: x = keep U + turn V, x' = damp V - turn U from displacement U and velocity V."""

    keep: Any
    turn: Any
    damp: Any


class Mechanics(NamedTuple):
    """Scene in intervals: half the damping coefficient, friction coefficient and forces."""

    b: Any
    mu: Any
    forces: Forces


def values_at(course: TimeCourse, start: Any, tau: Any) -> Values:
    """Return the values of a function in its piece."""
    value, rate, bend = course.value + course.slope * (tau - start), course.slope, arb(0)
    for frequency, sine, cosine in course.waves:
        s, c = (frequency * tau).sin_cos()
        now = sine * s + cosine * c
        value, bend = value + now, bend - frequency * frequency * now
        rate = rate + frequency * (sine * c - cosine * s)
    return Values(value, rate, bend)


def integral(course: TimeCourse, start: Any, low: Any, high: Any) -> Any:
    """Return the integral of a function in its piece."""
    length = high - low
    total = length * (course.value + course.slope * ((low - start) + (high - start)) / 2)
    for frequency, sine, cosine in course.waves:
        (s0, c0), (s1, c1) = (frequency * low).sin_cos(), (frequency * high).sin_cos()
        total = total + (sine * (c0 - c1) + cosine * (s1 - s0)) / frequency
    return total


def double_integral(course: TimeCourse, start: Any, low: Any, high: Any) -> Any:
    """Return the integral from low to high of the integral from low to there."""
    length = high - low
    total = length * length * ((course.value + course.slope * (low - start)) / 2 + course.slope * length / 6)
    for frequency, sine, cosine in course.waves:
        (s0, c0), (s1, c1) = (frequency * low).sin_cos(), (frequency * high).sin_cos()
        total = total + length * (sine * c0 - cosine * s0) / frequency
        total = total - (sine * (s1 - s0) + cosine * (c1 - c0)) / (frequency * frequency)
    return total


def net_course(mechanics: Mechanics, piece: SmoothPiece, sign: int) -> TimeCourse:
    """Return the load less friction in slip of this sign."""
    load, pressed = piece.load, piece.normal_load
    if not sign:
        return load
    share = -sign * mechanics.mu
    pushed = tuple(Sine(w, share * s, share * c) for w, s, c in pressed.waves)
    return TimeCourse(
        load.waves + pushed, load.value + share * pressed.value, load.slope + share * pressed.slope
    )


def forced_motion(course: TimeCourse, b: Any) -> TimeCourse:
    """Return a motion that this force drives; its velocity is the course's rate."""
    waves = []
    for frequency, sine, cosine in course.waves:
        stiffness = acb((1 - frequency) * (1 + frequency), 2 * b * frequency)
        phasor = acb(sine, cosine) / stiffness
        waves.append(Sine(frequency, phasor.real, phasor.imag))
    return TimeCourse(tuple(waves), course.value - 2 * b * course.slope, course.slope)


def free_flow(b: Any, h: Any) -> FreeFlow:
    """Return the free motion over a time h; below, at and above critical damping."""
    square = 1 - b * b
    if square > 0:
        rate, e = square.sqrt(), (-b * h).exp()
        s, c = (rate * h).sin_cos()
        s, c = e * s / rate, e * c
    elif square < 0:
        rate = (-square).sqrt()
        quick, slow = (-(b + rate) * h).exp(), (-h / (b + rate)).exp()
        s, c = (slow - quick) / (2 * rate), (slow + quick) / 2
    else:
        e = (-h).exp()
        s, c = e * h, e
    return FreeFlow(c + b * s, s, c - b * s)


def stretches(
    forces: Forces, start: PieceTime, stop: PieceTime, laps: int
) -> Iterator[tuple[SmoothPiece, Any, Any]]:
    """Yield the parts of a leg within pieces: each piece, and when the part begins and ends in it.

    laps: how often the leg passes the end of the common period.
    """
    count, first, last = len(forces.pieces), start.piece, stop.piece + laps * len(forces.pieces)
    if last < first:
        raise NotProved("a leg ends before it begins")
    for k in range(first, last + 1):
        piece = forces.pieces[k % count]
        low = start.tau if k == first else piece.start
        high = stop.tau if k == last else piece.stop
        yield piece, low, high
