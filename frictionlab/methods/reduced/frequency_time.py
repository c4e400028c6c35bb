"""What friction does to the motion it is averaged over: fed back through springs and dashpots until both agree.

In harmonics the linear body answers a friction at once; in time friction answers a slip at once. Weak friction
settles by mere repetition. Strong Coulomb friction, rest included, settles by Douglas-Rachford splitting, which
alternates the two and converges for all friction that never falls with slip.

Source: Lions & Mercier, SIAM Journal on Numerical Analysis 16 (1979), for sums of two monotone operators.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.prescribed.motion import slow_passages
from frictionlab.methods.prescribed.quadrature import graded_circle, sliding_vectors
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene

Complexes = NDArray[np.complex128]
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)
_powers = np.arange(6.0)
_PRIMITIVES = (_NODES[:, None] ** (_powers + 1.0) - (-1.0) ** (_powers + 1.0)) / (_powers + 1.0)
_INTEGRAL: Floats = _PRIMITIVES @ np.linalg.inv(_NODES[:, None] ** _powers)
"""From -1 to each node, of the polynomial through the nodes."""
SHALLOWEST = 1e-6
"""Depth [rad] at which panels stop shrinking towards slow slip: far below the shifts friction makes."""
PIECE = 30_000
"""Harmonics times angles of one matrix product."""
LONGEST_PANEL = 8.0
"""Phase [rad] of the highest harmonic across a panel: six nodes integrate its products with smooth friction."""
SETTLED = 0.003
"""What is left of the change of the mean, relative to that change, at which steps end."""
WIDEST = 0.25
"""Uncertainty of a mean, relative to the largest it can be, above which it is not called known."""
LONGEST_STICK = 0.25
"""Share of the period at rest above which the settled motion is not trusted: its steps settle too slowly."""
MOST_REPETITIONS = 20
SLOWEST_REPETITION = 0.8
"""Ratio of a repetition's move to the one before above which repeating is given up."""
MOST_SPLITTINGS = 120


class Change(NamedTuple):
    """Mean friction of the friction-free motion and of the settled one; what of the change may be left.

    stuck: the share of the period in which the settled motion is at rest on the belt.
    """

    before: float
    after: float
    left: float
    stuck: float

    def margin(self) -> float:
        """What the settled mean may be off by: a quarter of its change, and three times what may be left."""
        return 0.25 * abs(self.after - self.before) + 3.0 * self.left


def mistrusted(change: Change | None, largest: float) -> str:
    """Why a change says nothing useful of a mean that is at most ``largest``; empty where it does."""
    if change is None or change.left > WIDEST * largest:
        return "no useful bound on the model error: friction fed back to the motion does not settle; use shooting"
    if change.stuck > LONGEST_STICK:
        return (
            "no useful bound on the model error: with friction fed back the mass rests for long; use shooting"
        )
    return ""


class _Angles(NamedTuple):
    """Quadrature over one period: turns exp(i k angle) [k, angles], and weights that average."""

    turns: Complexes
    weights: Floats

    def at(self, harmonics: Complexes) -> Floats:
        """Motions Im(sum harmonics exp(i k angle)) at the angles."""
        return np.concatenate([(harmonics @ self.turns[:, part]).imag for part in self._parts()], axis=1)

    def harmonics(self, values: Complexes) -> Complexes:
        """Phasors of the x1 and x2 parts of values at the angles, each Im(phasor exp(i k angle))."""
        both = 2.0 * self.weights * np.stack([values.real, values.imag])
        sums = sum(both[:, part] @ self.turns[:, part].T for part in self._parts())
        return np.asarray(1j * np.conj(sums))

    def _parts(self) -> list[slice]:
        """Angles in pieces too small for products to be spread over threads, which would take longer."""
        size = max(1, PIECE // len(self.turns))
        return [slice(first, first + size) for first in range(0, len(self.weights), size)]


class _Body(NamedTuple):
    """The linear body by harmonics of the drive, x1 and x2: force over velocity, and the loads; and its contact."""

    impedance: Complexes
    loads: Complexes
    frequency: float
    normal_load: float
    belt_speed: float
    law: FrictionLaw

    def velocities(self, angles: _Angles, friction: Complexes) -> Complexes:
        """Its answer to the loads and to this friction coefficient, by harmonics."""
        return (self.loads - self.normal_load * angles.harmonics(friction)) / self.impedance

    def slip(self, angles: _Angles, velocities: Complexes) -> Complexes:
        """x1' - belt speed + i x2' of a motion given by harmonics."""
        moving = angles.at(velocities)
        return moving[0] + 1j * moving[1] - self.belt_speed


def settle(scene: Scene, law: FrictionLaw) -> Change | None:
    """Feed friction back to the friction-free motion until its mean no longer moves; None where it does not settle.

    Panels are laid around slow slip: first that of the friction-free motion, then that of its first answer.
    """
    body = _body(scene, law)
    free = body.loads / body.impedance
    passages = slow_passages(complex(free[0, 0]), complex(free[1, 0]), body.belt_speed)
    angles = _angles(body, passages)
    friction = sliding_vectors(law, body.slip(angles, free))
    before = _mean(angles, friction)
    first = body.velocities(angles, friction)
    repeated = _repeat(body, _angles(body, _passages(body, first)), first, before)
    if repeated is not None or not law.constant_sliding_friction():
        return repeated
    return _split_twice(body, angles, free, before)


def _body(scene: Scene, law: FrictionLaw) -> _Body:
    """As many harmonics as the free motions may answer, and sixteen more."""
    mass = scene.mass()
    fastest = max(1.0, math.sqrt(mass.transverse_stiffness)) / mass.frequency
    order: Floats = np.arange(1.0, 17.0 + min(2.0 * math.ceil(fastest), 64.0))
    frequency = mass.frequency * order
    along = mass.damping + 1j * (frequency - mass.stiffness / frequency)
    across = mass.transverse_damping + 1j * (frequency - mass.transverse_stiffness / frequency)
    across = np.where(
        across == 0.0, 1.0, across
    )  # undamped and at resonance: taken only where nothing moves x2
    loads = np.zeros((2, len(order)), np.complex128)
    loads[:, 0] = mass.force, mass.transverse_force
    impedance = np.stack([along, across])
    return _Body(impedance, loads, mass.frequency, mass.normal_load, scene.belt_speed, law)


def _angles(body: _Body, passages: list[tuple[float, float]]) -> _Angles:
    edges = graded_circle([(angle, max(depth, SHALLOWEST)) for angle, depth in passages])
    while np.diff(edges).max() > LONGEST_PANEL / body.loads.shape[1]:
        wide = np.diff(edges) > LONGEST_PANEL / body.loads.shape[1]
        edges = np.sort(np.concatenate([edges, 0.5 * (edges[:-1] + edges[1:])[wide]]))
    half = 0.5 * np.diff(edges)[:, None]
    angle = (edges[:-1, None] + half * (1.0 + _NODES)).ravel()
    turns = np.cumprod(np.broadcast_to(np.exp(1j * angle), (body.loads.shape[1], len(angle))), axis=0)
    weights: Floats = (half * _WEIGHTS).ravel() / (2.0 * math.pi)
    return _Angles(turns, weights)


def _passages(body: _Body, velocities: Complexes) -> list[tuple[float, float]]:
    """Where the slip of this motion is slowest: the angle, and the angle in which it passes there."""
    order = np.arange(1.0, velocities.shape[1] + 1.0)
    count = 16 * len(order)
    angle: Floats = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    angles = _Angles(np.exp(1j * np.outer(order, angle)), angle)
    slip = body.slip(angles, velocities)
    rate = body._replace(belt_speed=0.0).slip(angles, velocities * 1j * order)
    speed, pace = np.abs(slip), np.maximum(np.abs(rate), 1e-300)
    lowest = (speed <= np.roll(speed, 1)) & (speed < np.roll(speed, -1))
    spacing = 2.0 * math.pi / count
    move = np.clip(-(slip * rate.conjugate()).real / pace**2, -spacing, spacing)
    depth = np.abs(slip + move * rate) / pace
    return list(zip((angle + move)[lowest].tolist(), depth[lowest].tolist(), strict=True))


def _mean(angles: _Angles, friction: Complexes) -> float:
    return -float((angles.weights * friction.real).sum())


def _size(angles: _Angles, slip: Complexes) -> float:
    return math.sqrt(float((angles.weights * np.abs(slip) ** 2).sum()))


def _tail(body: _Body, angles: _Angles, friction: Complexes) -> Complexes:
    """The velocity that the harmonics left out take from the motion: to them the body is hardly more than a mass."""
    kept = angles.at(angles.harmonics(friction))
    rest = friction - (angles.weights * friction).sum() - (kept[0] + 1j * kept[1])
    return body.normal_load / body.frequency * _integral(angles, rest)


def _integral(angles: _Angles, values: Complexes) -> Complexes:
    """Over the angle, without mean."""
    rows = (len(values) // len(_NODES), len(_NODES))
    values, scale = values.reshape(rows), 2.0 * math.pi * angles.weights.reshape(rows)
    panels = (scale * values).sum(axis=1)
    within = 0.5 * scale.sum(axis=1, keepdims=True) * (values @ _INTEGRAL.T)
    total = ((np.cumsum(panels) - panels)[:, None] + within).ravel()
    shifted: Complexes = total - (angles.weights * total).sum()
    return shifted


def _repeat(body: _Body, angles: _Angles, velocities: Complexes, before: float) -> Change | None:
    """Friction of the motion, motion under that friction, and again; None where that does not settle quickly."""
    slip = body.slip(angles, velocities)
    friction = sliding_vectors(body.law, slip)
    moved = left = math.inf
    for _ in range(MOST_REPETITIONS):
        answer = body.slip(angles, body.velocities(angles, friction)) - _tail(body, angles, friction)
        last_moved, moved = moved, _size(angles, answer - slip)
        ratio = moved / last_moved if last_moved else 0.0
        if not ratio <= SLOWEST_REPETITION:
            return None
        slip, last = answer, friction
        friction = sliding_vectors(body.law, slip)
        mean, last_left = _mean(angles, friction), left
        left = abs(_mean(angles, friction - last)) / (1.0 - ratio)
        if max(left, last_left) <= SETTLED * abs(mean - before):  # twice: once may be by chance
            return Change(before, mean, left, 0.0)
    return None


class _Split(NamedTuple):
    """Where splitting has come: friction coefficient, what of its mean may be left, and the motion by harmonics."""

    friction: Complexes
    left: float
    velocities: Complexes


def _split_twice(body: _Body, angles: _Angles, free: Complexes, before: float) -> Change:
    """On the panels of the friction-free motion, then on those of the motion found; last the harmonics left out."""
    rough = _split(body, angles, free, before)
    rough_mean = _mean(angles, rough.friction)
    angles = _angles(body, _passages(body, rough.velocities))
    fine = _split(body, angles, rough.velocities, before)
    mean = _mean(angles, fine.friction)
    slip = body.slip(angles, fine.velocities) - _tail(body, angles, fine.friction)
    mu, width = body.law.sliding_friction(1.0), _width(body)
    again = mu * _within(slip + width / mu * fine.friction, width)
    left = fine.left + 2.0 * abs(_mean(angles, again) - mean) + 0.5 * abs(mean - rough_mean)
    stuck = float(angles.weights[np.abs(fine.friction) < 0.999 * mu].sum())
    return Change(before, mean, left, stuck)


def _width(body: _Body) -> float:
    """The slip to which friction is tied while splitting: friction over twice the impedance that the loads meet."""
    met = np.linalg.norm(body.loads[:, 0] / body.impedance[:, 0]) / np.linalg.norm(body.loads[:, 0])
    return 0.5 * body.normal_load * body.law.sliding_friction(1.0) * float(met)


def _within(values: Complexes, width: float) -> Complexes:
    """Of these sizes or less: unit vectors, shorter ones within the width. Friction of slip, or less at rest."""
    return values / np.maximum(np.abs(values), width)


def _split(body: _Body, angles: _Angles, velocities: Complexes, before: float) -> _Split:
    mu, width = body.law.sliding_friction(1.0), _width(body)
    gain = body.normal_load * mu / width
    slip = body.slip(angles, velocities)
    z = slip + width * _within(slip, 1e-300)
    moved = left = math.inf
    for _ in range(MOST_SPLITTINGS):
        friction = _within(z, width)
        w = z - width * friction
        pushed = body.loads + gain * angles.harmonics(w - width * friction + body.belt_speed)
        velocities = pushed / (body.impedance + gain)
        step = body.slip(angles, velocities) - w
        z = z + step
        ratio, moved = min(_size(angles, step) / moved, 0.9), _size(angles, step)
        last_left, left = left, mu * abs(_mean(angles, _within(z, width) - friction)) / (1.0 - (ratio or 0.9))
        if max(left, last_left) <= SETTLED * abs(mu * _mean(angles, friction) - before):
            break
    return _Split(mu * friction, max(left, last_left), velocities)
