"""Loads, belt velocity and normal load of a scene in intervals, from the numbers the scene was given.

Angles are given in degrees and frequencies as p/q of the drive's, so that every corner is at a rational share of the
common period: corners are compared without rounding, and two that are equal are one.
"""

from __future__ import annotations

import itertools
from fractions import Fraction
from typing import Any, NamedTuple

from flint import acb, arb

import frictionlab as fl


class Sine(NamedTuple):
    """sine*sin(frequency tau) + cosine*cos(frequency tau)."""

    frequency: Any
    sine: Any
    cosine: Any


class TimeCourse(NamedTuple):
    """A function within one piece: waves, and value + slope*(tau - start of the piece)."""

    waves: tuple[Sine, ...]
    value: Any
    slope: Any


class SmoothPiece(NamedTuple):
    """Between two corners: its ends [1/omega_1], the load along x1, the belt's velocity and the normal load.

    belt_jumps: whether the belt's velocity does where the piece starts.
    """

    start: Any
    stop: Any
    load: TimeCourse
    belt: TimeCourse
    normal_load: TimeCourse
    belt_jumps: bool


class Forces(NamedTuple):
    """A common period of everything, from a corner to itself: its length, and its pieces, in the order of time.

    smooth: whether there is no corner; the one piece is then valid at all times.
    """

    period: Any
    pieces: tuple[SmoothPiece, ...]
    smooth: bool


class _Wave(NamedTuple):
    """Sine of a waveform: its order, amplitude and phase [degrees]."""

    order: int
    amplitude: float
    phase: float


class _Part(NamedTuple):
    """Waveform of a scene, None for a sine; rate: its turns in a common period, start: its phase in turns."""

    form: Any
    size: Any
    rate: Fraction
    start: Fraction

    @property
    def waves(self) -> tuple[Any, ...]:
        """Sines that it is a sum of."""
        return (_Wave(1, 1.0, 0.0),) if self.form is None else self.form.waves

    @property
    def lines(self) -> tuple[Any, ...]:
        """Straight lines between its corners."""
        return () if self.form is None else self.form.lines


def forces_of(scene: fl.Scene) -> Forces:
    """Return the forces of a driven scene, as its records state them."""
    omega, periods = arb(scene.frequency), scene.periods
    period = 2 * arb.pi() * periods / omega
    drive, belt, normal = scene.drive, scene.belt_vibration, scene.normal_load_variation
    loads, moves, presses = [], [], []
    if drive is not None:
        size = arb(drive.amplitude) if drive.unbalance is None else arb(drive.unbalance) * omega * omega
        size = size * _cosine(drive.direction or 0.0)
        loads.append(_part(drive.waveform, size, periods, drive.phase))
    if belt is not None and belt.velocity_amplitude > 0.0:
        turns = round(periods * (belt.frequency_ratio or 1.0))  # ratios p/q, and q divides periods
        size = arb(belt.velocity_amplitude) * _cosine(belt.direction)
        moves.append(_part(belt.waveform, size, turns, belt.phase))
    if normal is not None and normal.amplitude > 0.0:
        turns = round(periods * (normal.frequency_ratio or 1.0))
        size = arb(normal.amplitude) * arb(scene.normal_load)
        presses.append(_part(normal.waveform, size, turns, normal.phase))
    corners = sorted({each for part in (*loads, *moves, *presses) for each in _corners(part)})
    jumps = {each for part in moves if part.form.jumps for each in _corners(part)}
    steady = arb(scene.belt_speed), arb(scene.normal_load)
    return Forces(
        period,
        tuple(
            SmoothPiece(
                period * _exact(start),
                period * _exact(stop),
                _course(loads, arb(0), start, stop, period),
                _course(moves, steady[0], start, stop, period),
                _course(presses, steady[1], start, stop, period),
                start in jumps,
            )
            for start, stop in itertools.pairwise(_closed(corners))
        ),
        not corners,
    )


def _closed(corners: list[Fraction]) -> list[Fraction]:
    """Return the corners of a period, and the first again."""
    first = corners[0] if corners else Fraction(0)
    return [*corners, first + 1] if corners else [first, first + 1]


def _part(form: Any, size: Any, turns: int, phase: float) -> _Part:
    return _Part(form, size, Fraction(turns), Fraction(phase) / 360)


def _cosine(direction: float) -> Any:
    """Return the cosine of an angle in degrees, of right angles without rounding."""
    return _turn(Fraction(direction) / 360)[1]


def _turn(turns: Fraction) -> tuple[Any, Any]:
    """Sine and cosine of an angle in turns."""
    return (2 * _exact(turns)).sin_cos_pi()


def _exact(number: Fraction) -> Any:
    return arb(number.numerator) / number.denominator


def _corners(part: _Part) -> list[Fraction]:
    """In shares of the common period, from 0 to below 1."""
    every = range(int(part.rate) + 2)
    found = ((at - part.start % 1 + lap) / part.rate for at, _, _ in part.lines for lap in every)
    return [each for each in found if 0 <= each < 1]


def _course(parts: list[_Part], constant: Any, start: Fraction, stop: Fraction, period: Any) -> TimeCourse:
    phasors: dict[Fraction, Any] = {}
    value, slope = constant, arb(0)
    for part in parts:
        for rate, phasor in _phasors(part):
            phasors[rate] = phasors.get(rate, acb(0)) + phasor
        here, rise = _line(part, start, stop)
        value, slope = value + here, slope + rise / period
    waves = tuple(
        Sine(2 * arb.pi() * _exact(rate) / period, phasor.real, phasor.imag)
        for rate, phasor in phasors.items()
    )
    return TimeCourse(waves, value, slope)


def _phasors(part: _Part) -> list[tuple[Fraction, Any]]:
    """Return the sines of a part: turns in a common period, and P of Im(P exp(i ...))."""
    found = []
    for term in part.waves:
        sine, cosine = _turn(Fraction(term.phase) / 360 + term.order * part.start)
        found.append((term.order * part.rate, acb(cosine, sine) * part.size * arb(term.amplitude)))
    return found


def _line(part: _Part, start: Fraction, stop: Fraction) -> tuple[Any, Any]:
    """Return the value of a shape with corners where a piece starts, and its slope per common period."""
    corners = part.lines
    if not corners:
        return arb(0), arb(0)
    middle = (part.rate * (start + stop) / 2 + part.start) % 1
    before = [each for each in corners if each[0] <= middle]
    at, value, slope = before[-1] if before else corners[-1]
    since = (middle - at) % 1 - part.rate * (stop - start) / 2
    return part.size * _exact(value + slope * since), part.size * _exact(slope * part.rate)
