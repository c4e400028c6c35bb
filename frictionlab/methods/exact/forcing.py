"""What shakes and presses a mass on the line, for closed-form legs: sums of sines, and parabolas between corners.

In the position less the path p of the belt's vibration v = p', y = x - p, the belt is steady and the equation of
motion that of the canonical scene, under load - 2 damping v - v' - p. Straight lines of load and belt make this a
parabola between corners, whose response is a parabola, too; it jumps where they do, and y' where v does.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.scene.body import Mass
from frictionlab.scene.varying import Varying, Waves
from frictionlab.values.quantities import Floats

# Columns of the waves: sine and cosine parts of the load, of the response to it, of what the varying normal load adds
# to the limit of friction, of the response to that, and of the belt's velocity.
FREQUENCY, LOAD, RESPONSE, PRESS, PRESSED, BELT, WAVE_COLUMNS = 0, 1, 3, 5, 7, 9, 11
# Columns of the pieces: times; value and derivatives at their start of the load and of the response to it (three
# each), of what is added to the limit of friction, of the belt's velocity; the belt's path and its velocity's jump.
START, STOP, PARABOLA, ARC, RAMP, LINE, PATH, JUMP, PIECE_COLUMNS = 0, 2, 4, 7, 10, 12, 14, 15, 16


LEAST_BEND = 1e-6
"""Share of a function, in its period, that the bound on its third derivative is at least: zero for parabolas, it
would let the cubics below them overflow."""


class Forcing(NamedTuple):
    """The functions of time of a scene that are not one sine.

    waves [n, WAVE_COLUMNS], pieces [m, PIECE_COLUMNS], ascending; both repeat after ``period``. shortest: time in
    which any of it may turn round. Bounds: load and size on the load and the response, each wave counted as often as
    it comes round, for its angle is rounded in proportion; swing on the velocity; push and jolt on third derivatives
    of the load and fourth ones of the response. lowest of load + press, highest of load - press.
    """

    waves: Floats
    pieces: Floats
    period: float
    shortest: float
    load: float
    size: float
    swing: float
    push: float
    jolt: float
    lowest: float
    highest: float

    def belt_at_start(self) -> tuple[float, float]:
        """Path and velocity of the belt's vibration just after tau = 0."""
        path = self.pieces[0, PATH] - (self.waves[:, BELT] / self.waves[:, FREQUENCY]).sum()
        return float(path), float(self.pieces[0, LINE] + self.waves[:, BELT + 1].sum())

    def belt_jumps(self) -> bool:
        """Whether the belt's velocity does."""
        return bool(np.any(self.pieces[:, JUMP] != 0.0))


def forcing_of(mass: Mass, coefficient: float) -> Forcing:
    """Of a mass with what varies along x1; coefficient: of friction."""
    varying, b = mass.varying, 0.5 * mass.damping
    waves, pieces = _waves(varying, b, coefficient), _pieces(varying, b, coefficient)
    period, frequency = float(varying.edges[-1]), waves[:, FREQUENCY]
    turns = np.maximum(1.0, frequency * period / (2.0 * math.pi))
    loads = _sizes(waves, LOAD) + _sizes(waves, PRESS)
    responses = _sizes(waves, RESPONSE) + _sizes(waves, PRESSED)
    ramps, slopes = _reach(pieces, RAMP, 2), np.abs(pieces[:, RAMP + 1])
    load = (loads * turns).sum() + (_reach(pieces, PARABOLA, 3) + ramps).max()
    arcs = (_reach(pieces, ARC, 3) + ramps + mass.damping * slopes).max()
    swing = (responses * turns * frequency).sum() + (_reach(pieces, ARC + 1, 2) + slopes).max()
    return Forcing(
        waves=waves,
        pieces=pieces,
        period=period,
        shortest=2.0 * math.pi / varying.quickest,
        load=float(load),
        size=float((responses * turns).sum() + max(1.0, period / (2.0 * math.pi)) * arcs),
        swing=float(swing),
        push=float((loads * frequency**3).sum() + LEAST_BEND * load / period**3),
        jolt=float((responses * frequency**4).sum() + LEAST_BEND * swing / period**3),
        lowest=_least(waves, pieces, 1.0),
        highest=-_least(waves, pieces, -1.0),
    )


def resonates(mass: Mass, within: float) -> bool:
    """Whether a sine among the loads is so near undamped resonance that the response is large beyond use."""
    varying = mass.varying
    frequency = np.concatenate(
        [
            each.frequency[each.sine.real**2 + each.cosine.real**2 > 0.0]
            for each in (varying.load.waves, varying.normal_load.waves)
        ]
    )
    return bool(np.any(np.abs(_stiffness(frequency, 0.5 * mass.damping)) < within))


def _stiffness(frequency: Floats, b: float) -> Any:
    """Force over displacement; (1 - w)(1 + w) keeps the digits that 1 - w^2 loses near resonance."""
    return (1.0 - frequency) * (1.0 + frequency) + 2j * b * frequency


def _waves(varying: Varying, b: float, coefficient: float) -> Floats:
    every = varying.load.waves, varying.belt.waves, varying.normal_load.waves
    frequency = np.unique(np.concatenate([each.frequency for each in every]))
    if len(frequency) == 0:
        return np.zeros((0, WAVE_COLUMNS))
    load, belt, press = (_phasors(each, frequency) for each in every)
    press = coefficient * press
    path, dynamic = belt / (1j * frequency), _stiffness(frequency, b)
    # A belt that swings in undamped resonance pushes the mass through friction alone.
    dynamic[(load == 0.0) & (press == 0.0)] = 1.0
    columns = [
        load - (2.0 * b + 1j * frequency) * belt - path,
        load / dynamic - path,
        press,
        press / dynamic,
        belt,
    ]
    table = np.column_stack([frequency, *(part for each in columns for part in (each.real, each.imag))])
    return np.ascontiguousarray(table[np.any(table[:, 1:] != 0.0, axis=1)])


def _phasors(waves: Waves, frequency: Floats) -> Any:
    """Along x1, of each of these frequencies, ascending."""
    found = np.zeros(len(frequency), dtype=np.complex128)
    np.add.at(found, np.searchsorted(frequency, waves.frequency), waves.sine.real + 1j * waves.cosine.real)
    return found


def _pieces(varying: Varying, b: float, coefficient: float) -> Floats:
    edges, damping = varying.edges, 2.0 * b
    length = np.diff(edges)
    load, rise, belt, gain = (
        each.real for part in (varying.load, varying.belt) for each in (part.lines, part.slopes)
    )
    travel = length * (belt + 0.5 * length * gain)
    path = np.cumsum(travel) - travel
    # of mean zero, so that load and response have no constant part that the other takes back
    path = path - (length * (path + length * (belt / 2.0 + length * gain / 6.0))).sum() / edges[-1]
    end = belt + length * gain
    jump = belt - np.roll(end, 1)
    jump[np.abs(jump) <= 1e-12 * max(np.abs(belt).max(), np.abs(end).max())] = 0.0
    table = np.zeros((len(length), PIECE_COLUMNS))
    for column, each in {
        START: edges[:-1],
        STOP: edges[1:],
        PARABOLA: load - damping * belt - gain - path,
        PARABOLA + 1: rise - damping * gain - belt,
        PARABOLA + 2: -gain,
        ARC: load - damping * rise - path,
        ARC + 1: rise - belt,
        ARC + 2: -gain,
        RAMP: coefficient * varying.normal_load.lines.real,
        RAMP + 1: coefficient * varying.normal_load.slopes.real,
        LINE: belt,
        LINE + 1: gain,
        PATH: path,
        JUMP: jump,
    }.items():
        table[:, column] = each
    return table


def _sizes(waves: Floats, column: int) -> Floats:
    return np.hypot(waves[:, column], waves[:, column + 1])


def _lengths(pieces: Floats) -> Floats:
    return pieces[:, STOP] - pieces[:, START]


def _reach(pieces: Floats, column: int, terms: int) -> Floats:
    """A bound in every piece on the polynomial whose derivatives at its start begin in this column."""
    length, bound = _lengths(pieces), np.abs(pieces[:, column])
    for k in range(1, terms):
        bound = bound + np.abs(pieces[:, column + k]) * length**k / math.factorial(k)
    return bound


SAMPLES_A_WAVE = 16
"""In the time of the quickest wave, from which the extremes are sought."""


def _least(waves: Floats, pieces: Floats, side: float) -> float:
    """The least value of press + side * load over a period."""
    if len(waves) == 0:
        return _least_of_parabolas(pieces, side)
    length, every = _lengths(pieces), np.arange(len(pieces))
    # Of many values, those below their neighbours improved by Newton's method.
    count = 9 + math.ceil(SAMPLES_A_WAVE * length.max() * waves[:, FREQUENCY].max() / (2.0 * math.pi))
    place = np.linspace(0.0, 1.0, count) * length[:, None]
    values = _combined(waves, pieces, side, every[:, None], place)[0]
    least = values.min()
    low = (values[:, 1:-1] <= values[:, :-2]) & (values[:, 1:-1] <= values[:, 2:])
    piece, column = np.nonzero(low)
    r = place[piece, column + 1]
    for _ in range(4):
        value, rate, bend = _combined(waves, pieces, side, piece, r)
        least = min(least, value.min(initial=math.inf))
        step = np.where(bend > 0.0, -rate / np.where(bend > 0.0, bend, 1.0), 0.0)
        r = np.clip(r + step, 0.0, length[piece])
    return float(least)


def _least_of_parabolas(pieces: Floats, side: float) -> float:
    """The same where there are no waves: at the ends or at the bottom."""
    a, b, c = side * pieces[:, PARABOLA : PARABOLA + 3].T
    a, b, length = a + pieces[:, RAMP], b + pieces[:, RAMP + 1], _lengths(pieces)
    bottom = np.clip(-b / np.where(c > 0.0, c, np.inf), 0.0, length)
    places = np.array([0.0 * length, bottom, length])
    return float((a + places * (b + 0.5 * c * places)).min())


def _combined(waves: Floats, pieces: Floats, side: float, piece: Any, r: Floats) -> tuple[Any, Any, Any]:
    """press + side * load, its rate and the rate of that, a time r into these pieces."""
    a, b, c = (side * pieces[piece, PARABOLA + k] for k in range(3))
    a, b = a + pieces[piece, RAMP], b + pieces[piece, RAMP + 1]
    value, rate, bend = a + r * (b + 0.5 * r * c), b + r * c, c + 0.0 * r
    frequency, *sizes = (
        column.reshape(-1, *[1] * np.ndim(r))
        for column in (
            waves[:, FREQUENCY],
            *(waves[:, PRESS + k] + side * waves[:, LOAD + k] for k in range(2)),
        )
    )
    angle = frequency * (pieces[piece, START] + r)
    sine, cosine = np.sin(angle), np.cos(angle)
    now = sizes[0] * sine + sizes[1] * cosine
    value, bend = value + now.sum(axis=0), bend - (frequency**2 * now).sum(axis=0)
    rate = rate + (frequency * (sizes[0] * cosine - sizes[1] * sine)).sum(axis=0)
    return value, rate, bend
