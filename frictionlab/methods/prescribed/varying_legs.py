"""The closed loop of a bristle law with an exact path under a slip of any waveform along one line.

Between two corners or reversals of the slip the law gives the deflection exactly after any way slid. There remain one
equation for the deflection at tau = 0, and quadrature. A normal load that changes weighs friction and leaves the loop
as it is, where the stiffness of the bristles follows it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import njit
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.base import Status
from frictionlab.methods.prescribed.exact_legs import gained
from frictionlab.methods.prescribed.loop import ELASTIC, NOTHING_MOVES, PrescribedMean
from frictionlab.methods.prescribed.varying_slip import WIDEST_PANEL, VaryingSlip, piece_at
from frictionlab.methods.words import ModelWord
from frictionlab.motion.contact import resistance
from frictionlab.motion.orbit.record import Orbit
from frictionlab.motion.orbit.recorder import NODES, WEIGHTS
from frictionlab.scene.scene import Scene
from frictionlab.theory.piecewise import PieceNumbers, Piecewise
from frictionlab.values.quantities import EPSILON, Floats

FORGETS_NOTHING = (
    "in a period the bristle forgets less of its start than rounding hides: the mean depends on the start"
)
_APART = 1e-6
"""Share of the largest deflection by which the deflections that repeat may differ."""
BEND_OVER = 40.0
"""Lengths of a bristle slid since a reversal after which its layer is over."""
_FIRST = 0.1
"""Of the first panel of a layer, in lengths of a bristle."""
_NEAREST = 1e-14
"""Of the panels next to the corner where friction saturates, in lengths of a bristle."""


class OneWay(NamedTuple):
    """Legs of slip in one direction between two times, on one piece: arrays; side 0 where it rests, path >= 0."""

    start: Floats
    stop: Floats
    piece: PieceNumbers
    side: Floats
    path: Floats


def one_way_legs(slip: Piecewise) -> OneWay:
    """Those of a period."""
    cuts = np.unique(np.concatenate([slip.edges, slip.crossings().tau]))
    start, stop = cuts[:-1], cuts[1:]
    middle = 0.5 * (start + stop)
    k = piece_at(slip.edges, middle)
    side = np.where(slip.at_rest()[k], 0.0, np.sign(slip.at(middle, k)[0]))
    return OneWay(start, stop, k, side, np.abs(slip.integral(start, stop, k)))


class LegLoop(NamedTuple):
    """The mean friction of a loop, the largest, and friction at the nodes of panels over a period."""

    mean: float
    largest: float
    tau: Floats
    friction: Floats


class ExactPath:
    """The deflection of a law along the legs of a slip, under a normal load over its mean on the same pieces."""

    def __init__(self, law: BristleLaw, slip: Piecewise, load: Piecewise, widest: float) -> None:
        self.law, self.slip, self.load, self.widest = law, slip, load, widest
        self.legs, self.seconds = one_way_legs(slip), 0.0
        self.reach, fastest = law.largest_deflection(), law.largest_rate(1.0)
        self.length = min(self.reach, 1.0 / fastest) if 0.0 < fastest < math.inf else self.reach

    def changes(self, z: float) -> Floats:
        """What it has gained where each leg begins, and at the end of the period; z: at tau = 0."""
        change = np.zeros(len(self.legs.side) + 1)
        arguments = self.length, self.legs.side, self.legs.path, z, change
        _, seconds = KernelCall(changes_on_legs, self.law).timed(*arguments)
        self.seconds += seconds
        return change

    def opened(self, z: float) -> float:
        """What it gains in a period; that falls as z grows."""
        return float(self.changes(z)[-1])

    def closed(self) -> tuple[float, float]:
        """The least and the largest deflection at tau = 0 that repeat; apart where the contact stays elastic."""
        noise = 4.0 * EPSILON * self.reach
        return self._where_it_gains(noise), self._where_it_gains(-noise)

    def _where_it_gains(self, gain: float) -> float:
        return root(lambda z: gain - self.opened(z), -self.reach, self.reach)

    def loop(self, z: float, cuts: int = 1) -> LegLoop:
        """From this deflection at tau = 0; cuts: the parts into which panels are divided."""
        first = z + self.changes(z)[:-1]
        start, stop, leg = self._panels(first)
        width, shares = (stop - start) / cuts, np.arange(cuts)
        start = (start[:, None] + width[:, None] * shares).ravel()
        half, leg = 0.5 * np.repeat(width, cuts), np.repeat(leg, cuts)
        tau, weights = (start + half)[:, None] + half[:, None] * NODES, half[:, None] * WEIGHTS
        k, moves = self.legs.piece[leg][:, None], np.abs(self.legs.side[leg])[:, None]
        slid = moves * self.slip.integral(self.legs.start[leg][:, None], tau, k)
        speed, friction = moves * self.slip.at(tau, k)[0], np.empty(tau.size)
        begun = np.repeat(first[leg], tau.shape[1])
        _, seconds = KernelCall(friction_on_legs, self.law).timed(
            begun, slid.ravel(), speed.ravel(), friction
        )
        self.seconds += seconds
        force = self.load.at(tau, k)[0] * friction.reshape(tau.shape)
        mean = -math.fsum((weights * force).ravel().tolist()) / self.slip.period
        return LegLoop(mean, float(np.abs(force).max()), tau, force)

    def _panels(self, first: Floats) -> tuple[Floats, Floats, PieceNumbers]:
        """Starts and ends of panels, and their legs, which begin at these deflections: they grow with the way slid,
        and shrink towards the corner of friction where that saturates."""
        legs = self.legs
        pairs = zip(first.tolist(), legs.side.tolist(), strict=True)
        corner = np.array([self.law.saturation_path(z, side) if side else math.inf for z, side in pairs])
        leg = np.flatnonzero((corner > 0.0) & (corner < legs.path))
        turns, leg = self._times_of(leg, corner[leg]), np.concatenate([np.arange(len(first)), leg])
        order = np.argsort(np.concatenate([legs.start, turns]), kind="stable")
        start, leg = np.concatenate([legs.start, turns])[order], leg[order]
        stop, done = np.append(start[1:], self.slip.period), []
        while len(start):
            there, half = corner[leg], 0.5 * (stop - start)
            here, last = self._way(leg, start), self._way(leg, stop)
            most = np.where(
                here < BEND_OVER * self.length, np.maximum(_FIRST * self.length, 0.5 * here), np.inf
            )
            near = np.maximum(0.5 * (there - last), _NEAREST * self.length)
            known = there < math.inf
            most = np.where(
                known, np.where(0.5 * (here + last) < there, np.minimum(most, near), np.inf), most
            )
            if self.law.elastic_deflection() >= self.reach:  # friction is a straight line up to its corner
                most = np.full(len(start), np.inf)
            kept = (last - here <= most) & (half <= self.widest) | (half <= EPSILON * self.slip.period)
            done.append((start[kept], stop[kept], leg[kept]))
            low, high, middle = start[~kept], stop[~kept], (start + half)[~kept]
            start, stop = np.concatenate([low, middle]), np.concatenate([middle, high])
            leg = np.tile(leg[~kept], 2)
        start, stop, leg = (np.concatenate(part) for part in zip(*done, strict=True))
        order = np.argsort(start, kind="stable")
        return start[order], stop[order], leg[order]

    def _way(self, leg: PieceNumbers, tau: Floats) -> Floats:
        slid = self.slip.integral(self.legs.start[leg], tau, self.legs.piece[leg])
        return np.abs(self.legs.side[leg]) * np.abs(slid)

    def _times_of(self, leg: PieceNumbers, way: Floats) -> Floats:
        """When so much way has been slid on these legs, by bisection."""
        low, high = self.legs.start[leg], self.legs.stop[leg]
        for _ in range(70):
            middle = 0.5 * (low + high)
            beyond = self._way(leg, middle) > way
            low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
        return high


def root(rising: Callable[[float], float], low: float, high: float) -> float:
    """Where a rising function crosses zero, by regula falsi (Illinois); the nearer end where it does not."""
    at_low, at_high, side = rising(low), rising(high), 0
    if at_low >= 0.0 or at_high <= 0.0:
        return low if at_low >= 0.0 else high
    for turn in range(300):
        middle = (low * at_high - high * at_low) / (at_high - at_low)
        # every third step is a bisection, which bounds the number of steps
        middle = middle if turn % 3 < 2 and low < middle < high else 0.5 * (low + high)
        here = rising(middle)
        if here == 0.0 or not low < middle < high:
            return middle
        if here < 0.0:
            low, at_low, at_high, side = middle, here, 0.5 * at_high if side < 0 else at_high, -1
        else:
            high, at_high, at_low, side = middle, here, 0.5 * at_low if side > 0 else at_low, 1
    return 0.5 * (low + high)


@njit
def changes_on_legs(law: Any, length: float, side: Any, path: Any, z: float, change: Any) -> None:
    """Fill change with what a deflection z at tau = 0 has gained where each leg begins, and at their end."""
    for i in range(side.size):
        more = gained(law, length, z + change[i], side[i], path[i]) if side[i] != 0.0 else 0.0
        change[i + 1] = change[i] + more


@njit
def friction_on_legs(law: Any, start: Any, slid: Any, speed: Any, rub: Any) -> None:
    """Fill rub with friction after the way slid on a leg that began with the bristle deflected by ``start``."""
    for i in range(rub.size):
        rub[i] = resistance(law, speed[i], law.deflected(start[i], slid[i]))[1]


class LegsPoint:
    """One scene of such a slip along the belt, and the answer."""

    def __init__(self, scene: Scene, law: BristleLaw) -> None:
        motion = scene.motion()
        self.slip = VaryingSlip.of(scene.signals(), motion.normal_load)
        moved = self.slip.along.minus(scene.belt_speed)
        widest = WIDEST_PANEL / self.slip.quickest if self.slip.quickest else math.inf
        self.path = ExactPath(law.under_load(motion.normal_load), moved, self.slip.normal_load, widest)
        self.status: Status = "ok"
        self.reason, self.model, self.error_kind, self.start = "", str(ModelWord.LEGS), "estimated", math.nan
        self.found = self._answer()
        self.seconds = self.path.seconds

    def _answer(self) -> PrescribedMean:
        path = self.path
        if not path.legs.side.any():
            return self._left_open(-path.reach, path.reach, NOTHING_MOVES)
        low, high = path.closed()
        # where a period forgets next to nothing of its start, rounding says what repeats
        lost = (path.opened(low) - path.opened(high) if high > low else 0.0) / max(high - low, 1e-300)
        if high - low > _APART * path.reach:
            return self._left_open(low, high, ELASTIC if lost <= _APART else FORGETS_NOTHING)
        self.start = 0.5 * (low + high)
        coarse, fine = path.loop(self.start), path.loop(self.start, 2)
        stiffness = abs(path.law.friction(0.0, 1.0, 0.0))
        open_ = (high - low) * stiffness * float(np.abs(path.load.middle).max() + path.load.size())
        error = 4.0 * abs(fine.mean - coarse.mean) + 64.0 * EPSILON * fine.largest + open_
        return PrescribedMean(complex(fine.mean, 0.0), error)

    def _left_open(self, low: float, high: float, reason: str) -> PrescribedMean:
        self.status, self.error_kind, self.reason = "not_unique", "", reason
        means = [self.path.loop(z).mean for z in (low, high)]
        return PrescribedMean(low=min(means), high=max(means))

    def orbit(self) -> Orbit | None:
        """The prescribed motion and the friction along it."""
        if self.status != "ok":
            return None
        loop = self.path.loop(self.start)
        return self.slip.orbit(loop.tau, loop.friction.astype(complex))
