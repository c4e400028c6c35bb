"""Loads, belt and normal load along a line, for closed-form legs: sums of sines, and parabolas between corners.

In the position less the path p of the belt's vibration v = p', y = x - p, the belt is steady and the equation of
motion that of the canonical scene, under load - 2 damping v - v' - p. Straight lines of load and belt make this a
parabola between corners, whose response is a parabola, too; it jumps where they do, and y' where v does.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.scene.body import Mass
from frictionlab.scene.varying import Varying, Waves, of_one_sine
from frictionlab.values.quantities import Floats

# One table for kernels: numbers of all, rows of waves, rows of pieces.
SHORTEST, SWING, PUSH, LOWEST, HIGHEST, FASTEST, HEAD = range(7)
"""Numbers of all.

SHORTEST: time in which any load may turn round. SWING, PUSH: bounds on the velocity of the response and on the third
derivative of the loads. LOWEST, HIGHEST: least load + press, largest load - press. FASTEST: speed of the belt from
which slip never reverses, infinite if not known.
"""
FREQUENCY, LOAD, RESPONSE, PRESS, PRESSED, BELT, GROWING, GROWS, WAVE_COLUMNS = 0, 1, 3, 5, 7, 9, 11, 13, 14
"""Columns of the waves: sine and cosine parts of the load, of the response to it, of what the varying normal load
adds to the limit of friction, of the response to that, and of the belt's velocity.

GROWS is 1 near undamped resonance, where the response from rest at tau = 0 to GROWING and PRESS is added: the
periodic one is too large.
"""
START, STOP, PARABOLA, ARC, RAMP, LINE, PATH, JUMP, PIECE_COLUMNS = 0, 2, 4, 7, 10, 12, 14, 15, 16
"""Columns of the pieces: times; value and derivatives at their start of the load and of the response to it (three
each), of what is added to the limit of friction, of the belt's velocity; the belt's path and its velocity's jump."""

LEAST_BEND = 1e-6
"""Share of a function, in its period, that the bound on its third derivative is at least: zero for parabolas, it
would let the cubics below them overflow."""
RESONANT = 1e-3
"""Dynamic stiffness below which a load is near undamped resonance."""


class Forcing(NamedTuple):
    """Canonical scenes of a curve, at any belt speed; all that varies repeats after ``period``.

    friction: its limit under the mean normal load, coefficient times ``normal_load``. Bounds, each wave counted as
    often as it comes round, for its angle is rounded in proportion: load and size on the load and the response; jolt
    on the fourth derivative of the response. terms, segments: counts of the waves and the pieces. smooth: whether
    waves are all; presses: whether the normal load changes; steady: whether the closed-form response repeats; alone:
    whether it is that of one wave of the load. table: what kernels read.
    """

    damping: float
    period: float
    coefficient: float
    normal_load: float
    friction: float
    load: float
    size: float
    jolt: float
    terms: int
    segments: int
    smooth: bool
    presses: bool
    steady: bool
    alone: bool
    table: Floats

    @property
    def waves(self) -> Floats:
        """Rows of the waves [terms, WAVE_COLUMNS]."""
        return self.table[HEAD : HEAD + self.terms * WAVE_COLUMNS].reshape(-1, WAVE_COLUMNS)

    @property
    def pieces(self) -> Floats:
        """Rows of the pieces [segments, PIECE_COLUMNS]."""
        return self.table[HEAD + self.terms * WAVE_COLUMNS :].reshape(-1, PIECE_COLUMNS)

    def belt_at_start(self) -> tuple[float, float]:
        """Return path and velocity of the belt's vibration just after tau = 0."""
        path = self.pieces[0, PATH] - (self.waves[:, BELT] / self.waves[:, FREQUENCY]).sum()
        return float(path), float(self.pieces[0, LINE] + self.waves[:, BELT + 1].sum())

    def belt_jumps(self) -> bool:
        """Check whether the belt's velocity does."""
        return bool(np.any(self.pieces[:, JUMP] != 0.0))

    def unbounded(self) -> bool:
        """Check for an undamped mass that resonates and whose friction takes less energy than its load gives.

        In a period of the free motion friction of the limit f takes at most 4 f a of a motion of amplitude a, a load
        of amplitude P in resonance gives pi P a.
        """
        at_resonance = self.waves[self.waves[:, FREQUENCY] == 1.0]
        clear = self.damping == 0.0 and self.smooth and not self.presses
        return clear and self.friction < 0.25 * math.pi * float(_sizes(at_resonance, LOAD).sum())


def forcing_of(mass: Mass, coefficient: float) -> Forcing:
    """Return the forcing of a mass by what varies along x1; coefficient: of friction.

    If a sine of the load is all, time begins where it rises through zero.
    """
    varying = mass.varying
    if not varying:
        varying = of_one_sine(abs(mass.force), 0.0, mass.frequency)
        varying = varying._replace(edges=np.array([0.0, 2.0 * math.pi / mass.frequency]))
    b, period = 0.5 * mass.damping, float(varying.edges[-1])
    (waves, fastest), pieces = _waves(varying, b, coefficient), _pieces(varying, b, coefficient)
    frequency = waves[:, FREQUENCY]
    turns = np.maximum(1.0, frequency * period / (2.0 * math.pi))
    presses = _sizes(waves, PRESS)
    loads = _sizes(waves, LOAD) + presses
    # The growing response is bounded by half of the load times the time, and by as much as it was at the start.
    grown = waves[:, GROWS] * (_sizes(waves, GROWING) + presses) * (0.5 * period + 1.0)
    responses = _sizes(waves, RESPONSE) + _sizes(waves, PRESSED)
    smooth, parabolas, arcs, slopes = len(pieces) == 1 and not pieces[:, PARABOLA:].any(), 0.0, 0.0, 0.0
    if not smooth:
        ramps, rises = _reach(pieces, RAMP, 2), np.abs(pieces[:, RAMP + 1])
        parabolas, slopes = (
            (_reach(pieces, PARABOLA, 3) + ramps).max(),
            (_reach(pieces, ARC + 1, 2) + rises).max(),
        )
        arcs = (_reach(pieces, ARC, 3) + ramps + mass.damping * rises).max()
    load = float((loads * turns).sum() + parabolas)
    swing = ((responses + grown) * turns * frequency).sum() + slopes
    push = (loads * frequency**3).sum() + LEAST_BEND * load / period**3
    changes = bool(presses.any() or pieces[:, RAMP : RAMP + 2].any())
    steady = smooth and not waves[:, GROWS].any()
    extremes = [side * _least(waves, pieces, side, smooth) for side in (1.0, -1.0)]
    numbers = 2.0 * math.pi / varying.quickest, swing, push, *extremes, fastest if smooth else math.inf
    return Forcing(
        damping=b,
        period=period,
        coefficient=coefficient,
        normal_load=mass.normal_load,
        friction=coefficient * mass.normal_load,
        load=load,
        size=float(((responses + grown) * turns).sum() + max(1.0, period / (2.0 * math.pi)) * arcs),
        jolt=float((responses * frequency**4 + 2.0 * grown).sum() + LEAST_BEND * swing / period**3),
        terms=len(waves),
        segments=len(pieces),
        smooth=smooth,
        presses=changes,
        steady=steady,
        alone=steady and len(waves) == 1 and not changes,
        table=np.concatenate([numbers, waves.ravel(), pieces.ravel()]),
    )


def _stiffness(frequency: Floats, b: float) -> Any:
    """Return force over displacement; (1 - w)(1 + w) keeps the digits that 1 - w^2 loses near resonance."""
    return (1.0 - frequency) * (1.0 + frequency) + 2j * b * frequency


def _waves(varying: Varying, b: float, coefficient: float) -> tuple[Floats, float]:
    """Return the rows of the waves, and the largest velocity that all of them give."""
    every = varying.load.waves, varying.belt.waves, varying.normal_load.waves
    frequency = np.concatenate([each.frequency for each in every])
    frequency = np.unique(frequency) if len(frequency) > 1 else frequency
    if len(frequency) == 0:
        return np.zeros((0, WAVE_COLUMNS)), 0.0
    load, belt, press = (_phasors(each, frequency) for each in every)
    press = coefficient * press
    path, dynamic = belt / (1j * frequency), _stiffness(frequency, b)
    # A belt that swings in undamped resonance pushes the mass through friction alone.
    pushed = (load != 0.0) | (press != 0.0)
    grows = pushed & (np.abs(dynamic) < RESONANT)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        answer, pressed = (np.where(each == 0.0, 0.0, each / dynamic) for each in (load, press))
    fastest = float((frequency * (np.abs(answer - path) + np.abs(pressed))).sum())
    columns = [
        load - (2.0 * b + 1j * frequency) * belt - path,
        np.where(grows, 0.0, answer) - path,
        press,
        np.where(grows, 0.0, pressed),
        belt,
        np.where(grows, load, 0.0),
    ]
    table = np.column_stack(
        [frequency, *(part for each in columns for part in (each.real, each.imag)), grows]
    )
    return np.ascontiguousarray(table[np.any(table[:, 1:] != 0.0, axis=1)]), fastest


def _phasors(waves: Waves, frequency: Floats) -> Any:
    """Return the phasors along x1 of each of these frequencies, ascending."""
    found = np.zeros(len(frequency), dtype=np.complex128)
    if len(waves.frequency):
        np.add.at(
            found, np.searchsorted(frequency, waves.frequency), waves.sine.real + 1j * waves.cosine.real
        )
    return found


def _pieces(varying: Varying, b: float, coefficient: float) -> Floats:
    edges, damping = varying.edges, 2.0 * b
    if len(edges) == 2 and not any(each.lines.any() or each.slopes.any() for each in varying[:3]):
        return np.array([[edges[1] if column == STOP else 0.0 for column in range(PIECE_COLUMNS)]])
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
    """Bound, in every piece, the polynomial whose derivatives at its start begin in this column."""
    length, bound = _lengths(pieces), np.abs(pieces[:, column])
    for k in range(1, terms):
        bound = bound + np.abs(pieces[:, column + k]) * length**k / math.factorial(k)
    return bound


SAMPLES_A_WAVE = 16
"""In the time of the quickest wave, from which the extremes are sought."""


def _least(waves: Floats, pieces: Floats, side: float, smooth: bool) -> float:
    """Find the least value of press + side * load over a period."""
    if len(waves) == 0:
        return _least_of_parabolas(pieces, side)
    if smooth and len(waves) == 1:
        return -float(np.hypot(*(waves[0, PRESS : PRESS + 2] + side * waves[0, LOAD : LOAD + 2])))
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
    """Find the least value where there are no waves: it lies at the ends or at the bottom."""
    a, b, c = side * pieces[:, PARABOLA : PARABOLA + 3].T
    a, b, length = a + pieces[:, RAMP], b + pieces[:, RAMP + 1], _lengths(pieces)
    bottom = np.clip(-b / np.where(c > 0.0, c, np.inf), 0.0, length)
    places = np.array([0.0 * length, bottom, length])
    return float((a + places * (b + 0.5 * c * places)).min())


def _combined(waves: Floats, pieces: Floats, side: float, piece: Any, r: Floats) -> tuple[Any, Any, Any]:
    """Return press + side * load, its rate and the rate of that, a time r into these pieces."""
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
