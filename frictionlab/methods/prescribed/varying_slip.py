"""A prescribed slip of any waveform under a normal load that may change, and friction without memory along it."""

from __future__ import annotations

import math
import time
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import njit
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Status
from frictionlab.methods.prescribed.loop import PrescribedMean, Vectors
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.record import Orbit
from frictionlab.motion.orbit.recorder import NODES, WEIGHTS
from frictionlab.scene.scene import Scene
from frictionlab.scene.signals import Signals, Wave
from frictionlab.theory.piecewise import PieceNumbers, Piecewise, piecewise
from frictionlab.theory.prescribed import MeanDirection, mean_direction
from frictionlab.theory.rest import friction_at_rest
from frictionlab.values.quantities import EPSILON, Floats

NO_SLIP = "the slip rests for a part of the period: friction there is any value up to mu"
WIDEST_PANEL = math.pi / 16.0
"""Half width of a panel, in radians of the quickest harmonic."""
HALVINGS, MOST_PANELS, SAME_MEAN = 50, 4000, 1e-14
"""Most halvings of a panel, as about a corner of the law; most panels at once; the share of friction that halving
all of them may change."""
_CLOSEST = EPSILON
"""Half width of the panels, in shares of the period, at which the refinement towards rest ends: narrower ones have no
middle at the end of the period."""
_CLOSEST_ON_THE_LINE = 1e-11
"""There what is left to quadrature vanishes with slip."""


class VaryingSlip(NamedTuple):
    """A prescribed oscillation, its parts along and across the belt, and the normal load over its mean."""

    along: Piecewise
    across: Piecewise
    normal_load: Piecewise
    quickest: float

    @classmethod
    def of(cls, signals: Signals, normal_load: float) -> VaryingSlip:
        """Read the slip of a scene."""
        edges = signals.edges()
        share = signals.normal_load.scaled(1.0 / normal_load)
        every = (*signals.belt, share)
        quickest = max((wave.frequency for each in every for wave in each.waves), default=0.0)
        along, across = (piecewise(each, edges) for each in signals.belt)
        return cls(along, across, piecewise(share, edges, 1.0), quickest)

    @classmethod
    def of_sines(cls, frequency: float, along: Any, across: Any) -> VaryingSlip:
        """Return the slip of harmonics 1, 2, ... of velocities Im(phasor exp(i k angle)), for a constant load."""
        still = Piecewise(np.array([0.0, math.tau / frequency]), np.zeros(1), np.zeros(1))
        waves = [
            tuple(Wave(frequency * (k + 1), each) for k, each in enumerate(row)) for row in (along, across)
        ]
        share = 1.0 if len(along) == 1 else max(2.0, 0.5 * len(along))
        moved = [still._replace(waves=row) for row in waves]
        return cls(moved[0], moved[1], still._replace(middle=np.ones(1)), share * frequency)

    @property
    def on_the_line(self) -> bool:
        """Check whether nothing oscillates across the belt."""
        return self.across.size() == 0.0

    def keeps_its_side(self, belt_speed: float) -> bool:
        """Check that slip along the belt never reverses and never rests."""
        return not -self.along.negative().maximum() <= belt_speed <= self.along.maximum()

    def velocity(self, tau: Floats, k: PieceNumbers) -> Vectors:
        """x1' + i x2' at times on the pieces k."""
        return np.asarray(self.along.at(tau, k)[0] + 1j * self.across.at(tau, k)[0])

    def position(self, tau: Floats, k: PieceNumbers) -> Vectors:
        """x1 + i x2, from 0 at tau = 0."""
        return np.asarray(_path(self.along, tau, k) + 1j * _path(self.across, tau, k))

    def orbit(self, tau: Floats, friction: Vectors) -> Orbit:
        """One period of the oscillation about its mean position at the nodes of panels, with friction along it."""
        k = piece_at(self.along.edges, 0.5 * (tau[:, :1] + tau[:, -1:]))
        x, weights = self.position(tau, k), 0.5 * (tau[:, -1:] - tau[:, :1]) * WEIGHTS
        x = x - complex((weights * x).sum()) / self.along.period
        return Orbit(tau, x, self.velocity(tau, k), friction, np.zeros(len(tau), np.bool_))

    def friction(self, belt_speed: float, law: FrictionLaw) -> tuple[Floats, Vectors]:
        """Times at the nodes of panels of a period, and there the friction of a law without memory."""
        edges, k = self.panels(belt_speed)
        tau, _ = nodes(edges)
        slip = self.velocity(tau, k[:, None]) - belt_speed
        return tau, self.normal_load.at(tau, k[:, None])[0] * sliding_vectors(law, slip)

    def panels(self, belt_speed: float) -> tuple[Floats, PieceNumbers]:
        """Edges of panels, and the pieces they are on: within half the way to the next slow slip of each they are
        analytic, and on the line they end at reversals."""
        along, across = self.along.minus(belt_speed), self.across
        cuts = along.crossings().tau if self.on_the_line else np.empty(0)
        edges = np.unique(np.concatenate([along.edges, cuts]))
        start, stop = edges[:-1], edges[1:]
        bend, done = along.curvature() + across.curvature(), []
        rounding = along.size() + across.size()
        widest = WIDEST_PANEL / self.quickest if self.quickest else math.inf
        closest = _CLOSEST_ON_THE_LINE if self.on_the_line else _CLOSEST
        while len(start):
            middle, half = 0.5 * (start + stop), 0.5 * (stop - start)
            k = piece_at(along.edges, middle)
            (first, rate), (second, rate_2) = along.at(middle, k), across.at(middle, k)
            moved = np.hypot(rate, rate_2) * 2.0 * half + 0.5 * bend[k] * (2.0 * half) ** 2
            narrow = (np.hypot(first, second) >= moved) & (half <= widest)
            # where slip only touches rest, panels end at the width that rounding leaves of the way there
            kept = narrow | (half <= closest * along.period) | (moved <= EPSILON * rounding)
            done.append(start[kept])
            start, stop = (
                np.concatenate([start[~kept], middle[~kept]]),
                np.concatenate([middle[~kept], stop[~kept]]),
            )
        edges = np.append(np.sort(np.concatenate(done)), along.period)
        return edges, piece_at(along.edges, 0.5 * (edges[:-1] + edges[1:]))


def _path(velocity: Piecewise, tau: Floats, k: PieceNumbers) -> Floats:
    numbers = np.arange(len(velocity.middle))
    gone = velocity.integral(velocity.edges[:-1], velocity.edges[1:], numbers)
    before = np.concatenate([[0.0], np.cumsum(gone)[:-1]])
    return np.asarray(before[k] + velocity.integral(velocity.edges[k], tau, k))


def piece_at(edges: Floats, tau: Floats) -> PieceNumbers:
    """Return the pieces on which these times are, inside."""
    return np.clip(np.searchsorted(edges, tau, side="right") - 1, 0, len(edges) - 2)


def nodes(edges: Floats) -> tuple[Floats, Floats]:
    """Gauss-Lobatto nodes and weights of every panel."""
    half = 0.5 * np.diff(edges)[:, None]
    return edges[:-1, None] + half * (1.0 + NODES), half * WEIGHTS


def sliding_vectors(law: FrictionLaw, slip: Vectors) -> Vectors:
    """Return the friction that resists each slip; zero at rest, which is an instant without duration."""
    if law.constant_sliding_friction():
        return law.sliding_friction(1.0) * _directions(slip)
    friction = np.empty(slip.size, np.complex128)
    KernelCall(friction_of_slips, law)(slip.ravel(), friction)
    friction[~np.isfinite(friction)] = np.nan  # where a law gives no number, neither is the mean
    return friction.reshape(slip.shape)


@njit
def friction_of_slips(law: Any, slip: Any, friction: Any) -> None:
    """Fill friction with that of a law without memory at each slip velocity."""
    for i in range(slip.size):
        friction[i] = law.sliding_vector(slip[i]) if slip[i] != 0.0 else 0j


def _directions(slip: Vectors) -> Vectors:
    speed = np.maximum(np.abs(slip), 1e-300)  # slower than that is at rest, and its inverse overflows
    return slip / speed


class VaryingPoint:
    """One scene of such a slip, a law without memory, and the answer; slip: another than the prescribed one."""

    def __init__(self, scene: Scene, law: FrictionLaw, slip: VaryingSlip | None = None) -> None:
        assert scene.normal_load is not None
        self.slip = slip or VaryingSlip.of(scene.signals(), scene.normal_load)
        self.belt_speed, self.law, self.sines = scene.belt_speed, law, scene.is_harmonic
        self.status: Status = "ok"
        self.reason, self.error_kind = "", "guaranteed"
        self.model: str = ""
        start = time.perf_counter()
        self.found = self._answer()
        self.seconds = time.perf_counter() - start

    def _answer(self) -> PrescribedMean:
        turns = self._turns()
        if turns is not None and self.law.constant_sliding_friction():
            most = self.law.sliding_friction(1.0)
            mean, error = complex(most * turns.mean, 0.0), most * turns.error
            self.model = ModelWord.SLIP_ALONG if self.sines else ModelWord.SLIP_AND_LOAD
        elif self.sines and self.belt_speed == 0.0:
            mean, error, self.model = 0j, 8.0 * EPSILON * self.law.sliding_friction(1.0), ModelWord.SYMMETRY
        else:
            mean, error, self.model = *self._by_quadrature(turns), ModelWord.QUADRATURE
            self.error_kind = "estimated"
        resting = self._resting()
        if resting > 0.0:
            return self._left_open(mean.real, resting * friction_at_rest(self.law))
        return PrescribedMean(mean, error)

    def _turns(self) -> MeanDirection | None:
        """Return the mean direction of a slip along the belt."""
        if not self.slip.on_the_line:
            return None
        return mean_direction(self.slip.along.minus(self.belt_speed), self.slip.normal_load)

    def _resting(self) -> float:
        """Return the share of the normal load that acts while slip rests."""
        along, load = self.slip.along.minus(self.belt_speed), self.slip.normal_load
        k = np.flatnonzero(along.at_rest() & self.slip.across.at_rest())
        return float(load.integral(along.edges[k], along.edges[k + 1], k).sum()) / along.period

    def _by_quadrature(self, turns: MeanDirection | None) -> tuple[complex, float]:
        """Mean and error; along the belt, the share of friction at vanishing speed in closed form.

        What is left to quadrature then vanishes where slip does, and near V_lin nothing hangs on its sign there.
        """
        first = self.law.sliding_friction(0.0) if turns is not None else 0.0
        edges, k = self.slip.panels(self.belt_speed)
        panels = np.stack([edges[:-1], edges[1:]], axis=1)
        whole, largest = self._means(panels, k, first)
        enough, mean, error = SAME_MEAN * largest / len(k), 0j, 64.0 * EPSILON * largest
        for left in reversed(range(HALVINGS)):
            middle = 0.5 * panels.sum(axis=1)
            halves = np.stack([panels[:, 0], middle, middle, panels[:, 1]], axis=1).reshape(-1, 2)
            parts, highest = self._means(halves, np.repeat(k, 2), first)
            largest, parts = max(largest, highest), parts.reshape(-1, 2)
            changed = np.abs(parts.sum(axis=1) - whole)
            done = changed <= (enough if left and len(k) < MOST_PANELS else math.inf)
            mean, error = mean + complex(parts[done].sum()), error + 4.0 * float(changed[done].sum())
            panels, k, whole = halves[np.repeat(~done, 2)], np.repeat(k[~done], 2), parts[~done].ravel()
            if not len(k):
                break
        if turns is None:
            return mean, error
        return mean + first * turns.mean, error + first * turns.error

    def _means(self, panels: Floats, k: PieceNumbers, less: float) -> tuple[Vectors, float]:
        """Return shares of panels in the mean of friction less a constant coefficient, and the largest friction."""
        half = 0.5 * np.diff(panels, axis=1)
        tau, weights = panels[:, :1] + half * (1.0 + NODES), half * WEIGHTS
        slip = self.slip.velocity(tau, k[:, None]) - self.belt_speed
        load = self.slip.normal_load.at(tau, k[:, None])[0]
        friction = load * sliding_vectors(self.law, slip)
        largest = float(np.abs(friction).max())
        if less:
            friction = friction - load * less * _directions(slip)
        return -(weights * friction).sum(axis=1) / self.slip.along.period, largest

    def _left_open(self, mean: float, spread: float) -> PrescribedMean:
        self.status, self.error_kind, self.reason = "not_unique", "", NO_SLIP
        return PrescribedMean(low=mean - spread, high=mean + spread)

    def orbit(self) -> Orbit | None:
        """Return the prescribed motion and the friction along it."""
        return (
            self.slip.orbit(*self.slip.friction(self.belt_speed, self.law)) if self.status == "ok" else None
        )
