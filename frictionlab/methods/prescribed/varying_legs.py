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
from frictionlab.compile.interpret import interpreted
from frictionlab.dynamics.contact import resistance
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.base import Status
from frictionlab.methods.prescribed.closed_loop_line import ELASTIC, NOTHING_MOVES
from frictionlab.methods.prescribed.exact_legs import gained
from frictionlab.methods.prescribed.motion import PrescribedMean
from frictionlab.methods.prescribed.quadrature import nodes
from frictionlab.methods.prescribed.varying_slip import WIDEST_PANEL, VaryingSlip, piece_at
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import EPSILON, Floats
from frictionlab.scene.scene import Scene
from frictionlab.theory.piecewise import Piecewise

ANY_LEGS = "prescribed slip along a line: deflection exact along every leg, Gauss-Lobatto quadrature"
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
    """Slip in one direction between two times, on one piece; side 0 where it rests. path: the way slid, >= 0."""

    start: float
    stop: float
    piece: int
    side: float
    path: float


def one_way_legs(slip: Piecewise) -> list[OneWay]:
    """Those of a period."""
    cuts = np.unique(np.concatenate([slip.edges, slip.crossings().tau]))
    start, stop = cuts[:-1], cuts[1:]
    middle = 0.5 * (start + stop)
    k = piece_at(slip.edges, middle)
    side = np.where(slip.at_rest()[k], 0.0, np.sign(slip.at(middle, k)[0]))
    path = np.abs(slip.integral(start, stop, k))
    rows = zip(*(each.tolist() for each in (start, stop, k, side, path)), strict=True)
    return [OneWay(*row) for row in rows]


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

    def deflections(self, z: float) -> list[float]:
        """What it gains until each leg begins, and until the end of the period; z: at tau = 0."""
        gain, change = interpreted(gained), [0.0]
        for leg in self.legs:
            more = gain(self.law, self.length, z + change[-1], leg.side, leg.path) if leg.side else 0.0
            change.append(change[-1] + more)
        return change

    def opened(self, z: float) -> float:
        """What it gains in a period; that falls as z grows."""
        return self.deflections(z)[-1]

    def closed(self) -> tuple[float, float]:
        """The least and the largest deflection at tau = 0 that repeat; apart where the contact stays elastic."""
        noise = 4.0 * EPSILON * self.reach
        return self._where_it_gains(noise), self._where_it_gains(-noise)

    def _where_it_gains(self, gain: float) -> float:
        return root(lambda z: gain - self.opened(z), -self.reach, self.reach)

    def loop(self, z: float, cuts: int = 1) -> LegLoop:
        """From this deflection at tau = 0; cuts: the parts into which panels are divided."""
        rows = []
        for leg, change in zip(self.legs, self.deflections(z), strict=False):
            tau, weights = nodes(self._edges(leg, z + change, cuts))
            k, begin = np.full(tau.shape, leg.piece), np.full(tau.shape, leg.start)
            moves = abs(leg.side)
            slid, speed = moves * self.slip.integral(begin, tau, k), moves * self.slip.at(tau, k)[0]
            start = np.full(tau.shape, z + change)
            rows.append((tau, weights, start, slid, speed, self.load.at(tau, k)[0]))
        tau, weights, start, slid, speed, load = (np.concatenate(part) for part in zip(*rows, strict=True))
        friction = np.empty(tau.size)
        arguments = start.ravel(), slid.ravel(), speed.ravel(), friction
        _, seconds = KernelCall(friction_on_legs, self.law).timed(*arguments)
        self.seconds += seconds
        force = load * friction.reshape(tau.shape)
        mean = -math.fsum((weights * force).ravel().tolist()) / self.slip.period
        return LegLoop(mean, float(np.abs(force).max()), tau, force)

    def _edges(self, leg: OneWay, z: float, cuts: int) -> Floats:
        """Of panels of a leg that begins at z: they grow with the way slid, and shrink towards the corner of friction
        where that saturates."""
        corner = self.law.saturation_path(z, leg.side) if leg.side else math.inf
        edges = [leg.start, leg.stop]
        if 0.0 < corner < leg.path:
            edges.insert(1, self._time_of(leg, corner))
        start, stop, done = np.array(edges[:-1]), np.array(edges[1:]), []
        while len(start):
            first, last = self._way(leg, start), self._way(leg, stop)
            most = np.where(
                first < BEND_OVER * self.length, np.maximum(_FIRST * self.length, 0.5 * first), np.inf
            )
            if corner < math.inf:
                near = np.maximum(0.5 * (corner - last), _NEAREST * self.length)
                most = np.where(0.5 * (first + last) < corner, np.minimum(most, near), np.inf)
            half = 0.5 * (stop - start)
            kept = (last - first <= most) & (half <= self.widest) | (half <= EPSILON * self.slip.period)
            done.append(start[kept])
            low, high, middle = start[~kept], stop[~kept], (start + half)[~kept]
            start, stop = np.concatenate([low, middle]), np.concatenate([middle, high])
        whole = np.append(np.sort(np.concatenate(done)), leg.stop)
        parts = whole[:-1, None] + np.diff(whole)[:, None] * (np.arange(cuts) / cuts)
        return np.append(parts.ravel(), leg.stop)

    def _way(self, leg: OneWay, tau: Floats) -> Floats:
        k, begin = np.full(tau.shape, leg.piece), np.full(tau.shape, leg.start)
        return abs(leg.side) * np.abs(self.slip.integral(begin, tau, k))

    def _time_of(self, leg: OneWay, way: float) -> float:
        return root(lambda tau: float(self._way(leg, np.array([tau]))[0]) - way, leg.start, leg.stop)


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
        self.reason, self.model, self.error_kind, self.start = "", ANY_LEGS, "estimated", math.nan
        self.found = self._answer()
        self.seconds = self.path.seconds

    def _answer(self) -> PrescribedMean:
        path = self.path
        if not any(leg.side for leg in path.legs):
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
