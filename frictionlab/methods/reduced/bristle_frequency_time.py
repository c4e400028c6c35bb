"""All harmonics of a mass on bristle friction: what one harmonic leaves out, found from what it found.

In harmonics the linear mass answers a friction at once; over a period friction answers a slip at once. Their
agreement is sought from the motion of one harmonic on, by repeating both with the contact's mean stiffness and
damping taken to the side of the mass, and Anderson's mixing of the last repetitions. Harmonics above those kept
are answered by the mass alone, whose springs hardly count there.

Sources: Cameron & Griffin, J. Appl. Mech. 56 (1989), for the alternation; Anderson, J. ACM 12 (1965).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.compile.cache import compiled
from frictionlab.dynamics.radau_panel import STAGES
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.prescribed.quadrature import graded_circle
from frictionlab.methods.reduced.contact import (
    INTEGRAL,
    NODES,
    WEIGHTS,
    Contact,
    disturbance_over,
    friction_over,
)
from frictionlab.methods.reduced.frequency_time import PIECE
from frictionlab.quantities import Floats
from frictionlab.scene.body import Mass

Complexes = NDArray[np.complex128]
MIXED = 8
"""Repetitions that Anderson's mixing remembers."""
MOST_REPETITIONS = 80
AGREED = 1e-9
"""Size of a repetition's move, relative to the slip, at which motion and friction agree."""
LONGEST_PANEL = 8.0
"""Phase [rad] of the highest harmonic across a panel."""
PATH = 0.25
"""Path in a panel, of the largest deflection, where bristles yield."""
MOST_PANELS = 500
ROUNDS = 3
"""Panels are laid around the reversals of the motion found last."""


class Line(NamedTuple):
    """A mass on a line and the contact it rubs on; stiffness and damping of that contact to begin with."""

    mass: Mass
    belt_speed: float
    law: BristleLaw
    contact: Contact
    held: complex  # friction coefficient per velocity, first harmonic


class Settled(NamedTuple):
    """Mean friction coefficient where motion and friction agree, and what it may be off by.

    multiplier: what a period makes of small disturbances at most; NaN for laws that yield at once.
    turns: how often slip turns in a period.
    """

    mean: float
    left: float
    multiplier: float
    turns: int


class _Period(NamedTuple):
    """Quadrature over one period: exp(i k angle) [k, nodes], weights that average, panels by half their angle."""

    turns: Complexes
    weights: Floats
    halves: Floats

    def motion(self, phasors: Complexes) -> Floats:
        """Im(sum phasors exp(i k angle)) at the nodes."""
        return np.concatenate([(phasors @ self.turns[:, part]).imag for part in self._parts()])

    def phasors(self, values: Floats) -> Complexes:
        """Its inverse, the mean left out."""
        weighed = 2.0 * self.weights * values
        sums = sum(self.turns[:, part] @ weighed[part] for part in self._parts())
        return np.asarray(1j * np.conj(sums))

    def integral(self, values: Floats) -> Floats:
        """Over the angle, without mean."""
        rows = values.reshape(-1, STAGES)
        panels = self.halves * (rows @ WEIGHTS)
        within = self.halves[:, None] * (rows @ INTEGRAL.T)
        total = ((np.cumsum(panels) - panels)[:, None] + within).ravel()
        return total - float((self.weights * total).sum())

    def _parts(self) -> list[slice]:
        """Nodes in pieces too small for products to be spread over threads, which would take longer."""
        size = max(1, PIECE // len(self.turns))
        return [slice(first, first + size) for first in range(0, len(self.weights), size)]


class _Agreed(NamedTuple):
    """Motion and friction that answer each other: mean friction, velocity harmonics, slip at the nodes."""

    mean: float
    phasors: Complexes
    slip: Floats


def settle(line: Line, first: complex) -> Settled | None:
    """All harmonics, from the first's velocity phasor on; None where motion and friction do not come to agree."""
    phasors = np.zeros(_harmonics(line), np.complex128)
    phasors[0] = first
    means: list[float] = []
    multiplier = math.nan
    for number in range(ROUNDS):
        last = number == ROUNDS - 1
        edges = panel_edges(line.mass, line.belt_speed, line.contact, phasors, 0.5 if last else 1.0)
        period = _period(edges, len(phasors))
        found = _agreement(line, period, phasors)
        if found is None:
            return None
        means, phasors = [*means, found.mean], found.phasors
        if last and not math.isfinite(line.law.yield_deflection()):
            multiplier = _multiplier(line, period, found.slip)
    turns = len(_reversals(phasors, line.belt_speed))
    return Settled(means[-1], abs(means[-1] - means[-2]), multiplier, turns)


def _multiplier(line: Line, period: _Period, slip: Floats) -> float:
    """The largest modulus of the Floquet multipliers of a motion with this slip."""
    mass, rows = line.mass, slip.reshape(-1, STAGES)
    numbers = mass.damping, mass.stiffness, mass.normal_load
    entry = compiled(disturbance_over, line.law)
    map_of_disturbances = np.asarray(entry(line.contact, numbers, period.halves / mass.frequency, rows))
    return float(np.abs(np.linalg.eigvals(map_of_disturbances)).max())


def _harmonics(line: Line) -> int:
    """As many as the free oscillation may answer, the contact's stiffness included within reason."""
    stiff = math.sqrt(1.0 + max(0.0, -(line.held.imag) * line.mass.frequency * line.mass.normal_load))
    return 24 + min(2 * math.ceil(stiff / line.mass.frequency), 72)


def _impedance(line: Line, count: int) -> Complexes:
    speed = line.mass.frequency * np.arange(1.0, count + 1.0)
    impedance = line.mass.damping + 1j * (speed - line.mass.stiffness / speed)
    return impedance.astype(np.complex128)


def _agreement(line: Line, period: _Period, phasors: Complexes) -> _Agreed | None:
    """Slip that friction answers with a friction that answers with that slip."""
    mass, order = line.mass, np.arange(1.0, len(phasors) + 1.0)
    impedance, load = _impedance(line, len(phasors)), np.zeros(len(phasors), np.complex128)
    load[0] = mass.force
    held = mass.normal_load * (max(line.held.real, 0.0) + 1j * line.held.imag / order)
    friction_of, halves = compiled(friction_over, line.law), period.halves / mass.frequency

    def friction(slip: Floats) -> Floats:
        return np.asarray(friction_of(line.contact, halves, slip.reshape(-1, STAGES))).ravel()

    def answer(slip: Floats) -> Floats:
        resisted = friction(slip)
        heard = period.phasors(resisted)
        kept = (load - mass.normal_load * heard + held * period.phasors(slip)) / (impedance + held)
        rest = resisted - float((period.weights * resisted).sum()) - period.motion(heard)
        tail = mass.normal_load / mass.frequency * period.integral(rest)
        return period.motion(kept) - line.belt_speed - tail

    slip = _mixed(answer, period.motion(phasors) - line.belt_speed, np.sqrt(period.weights))
    if slip is None:
        return None
    return _Agreed(-float((period.weights * friction(slip)).sum()), period.phasors(slip), slip)


def _mixed(answer: Callable[[Floats], Floats], start: Floats, scale: Floats) -> Floats | None:
    """The fixed point of ``answer`` by Anderson's mixing; None where it is not found."""
    at = start
    moves: list[Floats] = []
    answers: list[Floats] = []
    for _ in range(MOST_REPETITIONS):
        given = answer(at)
        move = given - at
        size = float(np.linalg.norm(scale * move))
        if not math.isfinite(size):
            return None
        if size <= AGREED * float(np.linalg.norm(scale * at)):
            return at
        moves, answers = [*moves[-MIXED:], move], [*answers[-MIXED:], given]
        at = given
        if len(moves) > 1:
            steps = np.array([scale * (new - old) for old, new in itertools.pairwise(moves)]).T
            shares = np.linalg.lstsq(steps, scale * move, rcond=1e-10)[0]
            for share, old, new in zip(shares, answers, answers[1:], strict=False):
                at = at - share * (new - old)
    return None


def _period(edges: Floats, count: int) -> _Period:
    half = 0.5 * np.diff(edges)
    angle = (edges[:-1, None] + half[:, None] * (1.0 + NODES)).ravel()
    turns = np.cumprod(np.broadcast_to(np.exp(1j * angle), (count, len(angle))), axis=0)
    weights: Floats = (half[:, None] * WEIGHTS).ravel() / (2.0 * math.pi)
    return _Period(turns, weights, half)


def _reversals(phasors: Complexes, belt_speed: float) -> list[tuple[float, float]]:
    """Where the slip turns or nearly does: the angle, and the pace at which it passes there."""
    order = np.arange(1.0, len(phasors) + 1.0)
    angle = np.linspace(0.0, 2.0 * math.pi, 16 * len(phasors) + 48, endpoint=False)
    turns = np.exp(1j * np.outer(order, angle))
    slip, pace = (phasors @ turns).imag - belt_speed, ((1j * order * phasors) @ turns).imag
    lowest = (np.abs(slip) <= np.abs(np.roll(slip, 1))) & (np.abs(slip) < np.abs(np.roll(slip, -1)))
    spacing = angle[1]
    pace_there = np.where(pace == 0.0, 1e-300, pace)
    move = np.clip(-slip / pace_there, -spacing, spacing)
    crosses = np.abs(slip) < 2.0 * spacing * np.abs(pace_there)
    chosen = lowest & crosses
    return list(zip((angle + move)[chosen].tolist(), np.abs(pace)[chosen].tolist(), strict=True))


def panel_edges(
    mass: Mass, belt_speed: float, contact: Contact, phasors: Complexes, fineness: float = 1.0
) -> Floats:
    """Panels short where slip turns, and where bristles yield behind a turn."""
    size, frequency = contact.size, mass.frequency
    passages = []
    for angle, pace in _reversals(phasors, belt_speed):
        depth = 0.5 * fineness * math.sqrt(2.0 * size * frequency / max(pace, 1e-300))
        passages.append((angle, min(max(depth, 1e-7), 0.2)))
    edges = graded_circle(passages)
    for _ in range(12):
        middle = 0.5 * (edges[:-1] + edges[1:])
        order = np.arange(1.0, len(phasors) + 1.0)
        slip = (phasors @ np.exp(1j * np.outer(order, middle))).imag - belt_speed
        path = np.abs(slip) * np.diff(edges) / frequency
        near = _yielding(contact, middle, passages, path)
        long = (np.diff(edges) > fineness * LONGEST_PANEL / len(phasors)) | (
            near & (path > fineness * PATH * size)
        )
        if not long.any() or len(edges) + long.sum() > MOST_PANELS:
            break
        edges = np.sort(np.concatenate([edges, middle[long]]))
    return edges


def _yielding(
    contact: Contact, middle: Floats, passages: list[tuple[float, float]], path: Floats
) -> NDArray[np.bool_]:
    """Whether the path since the last turn is still some of the largest deflection."""
    gone = np.concatenate([[0.0], np.cumsum(path)[:-1]])
    near = np.zeros(len(middle), np.bool_)
    total = float(path.sum())
    for angle, _ in passages:
        at = np.interp(middle[0] + (angle - middle[0]) % (2.0 * math.pi), middle, gone)
        near |= (gone - at) % max(total, 1e-300) < 6.0 * contact.size
    return near
