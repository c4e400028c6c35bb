"""Time stepping of bristles under a prescribed slip: only their deflection is stepped, until it repeats.

Licence (12 scenes): 4 times faster in the median at 1e-3 than the laps of march
with a mass that friction does not move (0.8 to 33 times; kernels alone 138 times).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import length
from frictionlab.dynamics.motion import in_piece, mean_friction, pieces_of
from frictionlab.laws.memory import PER_AXIS, VECTORIAL
from frictionlab.methods.base import Status
from frictionlab.methods.march.adapters import (
    bristle_advance,
    bristle_resistance,
    bristle_within_yield,
    in_shares,
)
from frictionlab.methods.march.answers import PointAnswer
from frictionlab.methods.march.error import COARSEST, ROUNDING, Plan
from frictionlab.methods.march.prescribed_slip import (
    load_at_angle,
    path_between,
    piece_angles,
    slip_at_angle,
    whole_angle,
)
from frictionlab.methods.march.stability import fewest_steps, lightest_contact, shares_of_load
from frictionlab.methods.march.steppers import STEPPERS
from frictionlab.methods.prescribed.memory import driven
from frictionlab.methods.prescribed.varying_slip import VaryingSlip, piece_at
from frictionlab.numerics.richardson import REVERSING, SMOOTH, first_error, richardson
from frictionlab.orbit.panels import NODES
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene

PlaneVectors = NDArray[np.complex128]

MOST_STEPS, WORK = 1 << 20, 16_000_000
"""Steps per period, and in all, of one point."""
PANELS = 1024
"""Of the record of an orbit: friction has corners inside them."""
REPEATED = 1e-13
"""Change of the deflection over a period, over the largest met, that counts as none."""


class PrescribedSteps(NamedTuple):
    """The slip that drags the bristle along, and how it is stepped."""

    motion: Any  # a Motion; a Body whose belt moves where the slip is no sine (prescribed_slip.py)
    belt_speed: float
    steps: int  # per period of the slip
    by_rk4: bool
    most: int  # periods
    refined: int = 1  # parts that the coarsest steps are cut into


class BristlePeriod(NamedTuple):
    """Over the last period: mean coefficient; reversals; how often bristles begin or end to be bent back, z.v = 0;
    deflection at its end.

    open: by how much the deflection still changes in all, over the largest met; each: friction of every step.
    """

    mean: complex
    reversals: int
    bends: int
    z: complex
    open: float
    periods: int
    each: Any


@inner
def slip_of(drive: PrescribedSteps, angle: float, like: Any) -> Any:
    """Slip velocity at an angle of the period."""
    return slip_at_angle(drive.motion, drive.belt_speed, angle, like)


@inner
def path_of(drive: PrescribedSteps, start: float, end: float, like: Any) -> Any:
    """The way slid from one angle to another."""
    return path_between(drive.motion, drive.belt_speed, start, end, like)


class BristleStep(NamedTuple):
    """Deflection at the end of a step, and friction over it."""

    z: Any
    mu: Any


@inner
def contact_at(law: Any, drive: PrescribedSteps, angle: float, z: Any) -> Any:
    """Rate of the deflection, and friction in shares of the mean normal load."""
    pressed = load_at_angle(drive.motion, angle)
    rate, mu = bristle_resistance(drive.motion, law, slip_of(drive, angle, z), z, pressed)
    return rate, in_shares(drive.motion, pressed, mu)


@inner
def advanced(law: Any, drive: PrescribedSteps, angle: float, half: float, z: Any) -> Any:
    """The deflection half a step later, at the mean of its slip and of the normal loads at its ends."""
    motion, end = drive.motion, angle + half * drive.motion.frequency
    pressed = 0.5 * (load_at_angle(motion, angle) + load_at_angle(motion, end))
    return bristle_advance(motion, law, half, path_of(drive, angle, end, z) / half, z, pressed)


@inner
def _by_rk4(law: Any, drive: PrescribedSteps, angle: float, h: float, z: Any) -> BristleStep:
    """The classical Runge-Kutta method (W. Kutta, 1901)."""
    motion, half = drive.motion, 0.5 * h
    # The slip is known at any time: the deflection alone is stepped.
    middle, end = angle + half * motion.frequency, angle + h * motion.frequency
    r1, f1 = contact_at(law, drive, angle, z)
    r2, f2 = contact_at(law, drive, middle, z + half * r1)
    r3, f3 = contact_at(law, drive, middle, z + half * r2)
    r4, f4 = contact_at(law, drive, end, z + h * r3)
    after = z + (h / 6.0) * (r1 + 2.0 * r2 + 2.0 * r3 + r4)
    after = bristle_within_yield(motion, law, after, load_at_angle(motion, end))
    return BristleStep(after, (f1 + 2.0 * f2 + 2.0 * f3 + f4) / 6.0)


@inner
def _exponentially(law: Any, drive: PrescribedSteps, angle: float, h: float, z: Any) -> BristleStep:
    """Straight slip over as much path as there is; friction is that of the middle."""
    half = 0.5 * h
    # Two halves, each straight and at its mean velocity; friction is asked for between them.
    middle = angle + half * drive.motion.frequency
    bent = advanced(law, drive, angle, half, z)
    _, rub = contact_at(law, drive, middle, bent)
    return BristleStep(advanced(law, drive, middle, half, bent), rub)


@inner
def steps_over(drive: PrescribedSteps, goes: float) -> int:
    """Equal steps between two corners that are an angle apart: halved steps are halved there, too."""
    coarsest = drive.steps // drive.refined
    return drive.refined * max(1, math.ceil(coarsest * (goes / (2.0 * math.pi)) - 1e-9))


class PieceOfSteps(NamedTuple):
    """The angle from which n equal steps go on for another angle; the place of the first among all of a period."""

    first: float
    goes: float
    n: int
    at: int


class PieceTally(NamedTuple):
    """What is met between two corners: friction summed up, reversals, bends, and the deepest deflection."""

    total: Any
    reversals: int
    bends: int
    deepest: float


@inner
def step_piece(law: Any, drive: PrescribedSteps, piece: PieceOfSteps, z: Any, each: Any) -> Any:
    """From one corner to the next from the deflection z: where that ends, and what was met; friction of every step
    is written into ``each``."""
    first, goes, n, at = piece
    h = goes / (drive.motion.frequency * n)
    total, reversals, bends, deepest = 0.0 * z, 0, 0, 1e-300
    last = slip_of(drive, first, z)
    for i in range(n):
        angle, bent = first + goes * i / n, (z * last.conjugate()).real
        step = _by_rk4(law, drive, angle, h, z) if drive.by_rk4 else _exponentially(law, drive, angle, h, z)
        z, deepest = step.z, max(deepest, length(step.z))
        total = total + step.mu
        each[at + i] = step.mu + 0j
        # Where slip reverses, or the bristle begins or ends to be bent back, friction has a corner in this step.
        ahead = slip_of(drive, angle + goes / n, z)
        reversals += 1 if (ahead * last.conjugate()).real < 0.0 else 0
        bends += 1 if (z * ahead.conjugate()).real * bent < 0.0 else 0
        last = ahead
    return z, PieceTally(total, reversals, bends, deepest)


@inner
def step_periods(law: Any, drive: PrescribedSteps, z: Any) -> BristlePeriod:
    """Period after period from the deflection z, until it repeats or the periods are used up."""
    motion, total = drive.motion, 0
    for k in range(pieces_of(motion)):
        total += steps_over(drive, piece_angles(motion, k)[1])
    each = np.empty(total, np.complex128)
    period, last_gap, left, mean, reversals, bends = 0, 0.0, 1e300, 0.0 * z, 0, 0
    while period < drive.most and left > REPEATED:
        # A period anew: of the last one alone the mean, the reversals and the bends are kept.
        before, deepest, mean, reversals, bends, at = z, 1e-300, 0.0 * z, 0, 0, 0
        for k in range(pieces_of(motion)):
            first, goes = piece_angles(motion, k)
            steps = PieceOfSteps(first, goes, steps_over(drive, goes), at)
            own = PrescribedSteps(
                in_piece(motion, k), drive.belt_speed, drive.steps, drive.by_rk4, drive.most, drive.refined
            )
            z, met = step_piece(law, own, steps, z, each)
            mean = mean + (goes / whole_angle(motion)) * mean_friction(met.total, steps.n)
            reversals, bends, deepest = (
                reversals + met.reversals,
                bends + met.bends,
                max(deepest, met.deepest),
            )
            at += steps.n
        # Gaps shrink like a geometric series: what is left is their sum. Rounding alone keeps the last ones open.
        gap = length(z - before) / deepest
        rate = min(gap / last_gap, 0.9999999) if last_gap > 0.0 else 0.0
        left = gap / (1.0 - rate) if period > 0 else 1e300
        left = gap if gap <= REPEATED else left
        last_gap, period = gap, period + 1
    return BristlePeriod(mean + 0j, reversals, bends, z + 0j, left, period, each)


class SteppedPoint:
    """One scene of prescribed slip, stepped."""

    def __init__(self, scene: Scene, law: Any, tolerance: float, plan: Plan) -> None:
        self.scene, self.law, self.plan, self.motion = scene, law, plan, scene.motion()
        self.straight = scene.load_along_belt_only
        self.moved = self.motion if scene.is_harmonic else driven(self.motion, 0.0 if self.straight else 0j)
        self.slip = None if scene.is_harmonic else VaryingSlip.of(scene.signals(), self.motion.normal_load)
        self.periods = 1.0 if scene.is_harmonic else float(scene.periods)
        self.seconds, self.reason = 0.0, ""
        self.status: Status = "ok"
        self.runs: list[BristlePeriod] = []
        self.mean, self.error = self._given() if plan.steps else self._halved(tolerance)
        self.model = f"prescribed slip, {plan.stepper}: {len(self.runs[0].each)} steps per period"
        self.answer = PointAnswer(self.mean, self.error, self.periods)
        self._judge(tolerance)

    def _judge(self, tolerance: float) -> None:
        last = self.runs[-1]
        if last.open > 1e-6:
            self._leave(
                "failed", f"the deflection still changes after {last.periods} periods; give more periods"
            )
            return
        starts = [self._run(self.steps, side * self.law.presliding(), self.refined) for side in (1, -1)]
        others = [other.mean.real for other in starts]
        apart = max(abs(other - self.runs[0].mean.real) for other in others)
        changing = 2.0 * self.law.sliding_friction(0.0) * max(other.open for other in starts)
        if apart > max(self.error, 1e-9) + changing:
            low, high = min(*others, self.mean.real), max(*others, self.mean.real)
            self._leave(
                "not_unique",
                "the mean depends on the start: slip stays within the elastic range",
            )
            self.answer = PointAnswer(low=low, high=high)
        elif self.error > tolerance:
            self.reason = f"the error is above the tolerance {tolerance:.1e}"

    def _leave(self, status: Status, reason: str) -> None:
        self.status, self.reason, self.answer = status, reason, PointAnswer()

    def _run(self, steps: int, start: complex, refined: int) -> BristlePeriod:
        call = KernelCall(step_periods, self.law)
        most = max(2, min(self.plan.periods, WORK // steps))
        by_rk4 = self.plan.stepper == "rk4"
        drive = PrescribedSteps(self.moved, self.scene.belt_speed, steps, by_rk4, most, refined)
        z = float(start.real) if self.straight else complex(start)
        found, seconds = call.timed(drive, z)
        self.seconds += seconds
        return found

    def _given(self) -> tuple[complex, float]:
        """The mean of so many steps; twice and four times as many tell its error."""
        assert self.plan.steps is not None
        self.steps, self.refined = self.plan.steps, 1
        self.runs = [self._run(part * self.plan.steps, 0.0, part) for part in (1, 2, 4)]
        means = [run.mean.real for run in self.runs]
        return self.runs[0].mean, first_error(means) + self._beside(self.runs[0])

    def _halved(self, tolerance: float) -> tuple[complex, float]:
        """Steps doubled until the error is below the tolerance; ``runs`` keeps the finest, and one before it."""
        steps = max(COARSEST, fewest_steps(self.scene, self.law, STEPPERS[self.plan.stepper]))
        runs, error, value, across, coarsest = [self._run(steps, 0.0, 1)], math.inf, 0.0, 0.0, steps
        while error > tolerance and (2 * steps <= MOST_STEPS or len(runs) < 3):
            steps *= 2
            runs.append(self._run(steps, runs[-1].z, steps // coarsest))
            least = REVERSING if self._has_corners(runs[-1]) else SMOOTH
            found = richardson([run.mean.real for run in runs], self.plan.order, least)
            across = richardson([run.mean.imag for run in runs], self.plan.order, least).value
            value, error = found.value, found.error + self._beside(runs[-1])
            error = error if len(runs) > 2 else math.inf
        self.runs, self.steps, self.refined = runs[-1:], steps, steps // coarsest
        return complex(value, across), error

    def _beside(self, run: BristlePeriod) -> float:
        """Rounding, what is open, and what steps in which slip reverses may misplace."""
        heaviest = shares_of_load(self.scene)[1]
        friction, n, turn = heaviest * self.law.sliding_friction(0.0), len(run.each), self._largest_turn()
        presliding = lightest_contact(self.scene) * self.law.presliding()
        bending = math.sqrt(2.0 * presliding / turn) if turn > 0.0 else math.inf
        step = 2.0 * math.pi * self.periods / self.motion.frequency / n
        missed = friction * self._turns(run) / n * min(1.0, 0.5 * step / bending)
        missed += (
            0.5 * friction * self._jumps(run) / n
        )  # half a step, for as long as the friction takes to build up
        return missed + friction * self._lag(n) + 2.0 * friction * run.open + ROUNDING

    def _largest_turn(self) -> float:
        """The largest rate of the slip."""
        if self.slip is None:
            sizes = abs(self.motion.velocity), abs(self.motion.transverse_velocity)
            return self.motion.frequency * math.hypot(*sizes)
        _, _, rate = self._slips(4096)
        return 1.1 * float(np.abs(rate).max())

    def _slips(self, n: int) -> tuple[Floats, PlaneVectors, PlaneVectors]:
        """Time, slip and its rate at the middle of n equal parts of a period of everything."""
        whole = 2.0 * math.pi * self.periods / self.motion.frequency
        tau = np.asarray((np.arange(n) + 0.5) * (whole / n), np.float64)
        if self.slip is not None:
            k = piece_at(self.slip.along.edges, tau)
            (along, rate), (across, rate_2) = self.slip.along.at(tau, k), self.slip.across.at(tau, k)
            slip: PlaneVectors = along - self.scene.belt_speed + 1j * across
            return tau, slip, rate + 1j * rate_2
        turn = np.exp(1j * self.motion.frequency * tau)
        first, second = self.motion.velocity * turn, self.motion.transverse_velocity * turn
        slip = first.imag - self.scene.belt_speed + 1j * second.imag
        return tau, slip, self.motion.frequency * (first.real + 1j * second.real)

    def _lag(self, n: int) -> float:
        """Mean angle by which bristles trail behind slip that turns, over the steps that pass the presliding length.

        Steps as long as that tell nothing of it, nor does the change to others as long.
        """
        if self.straight or self.law.form != VECTORIAL:
            return 0.0
        tau, slip, rate = self._slips(n)
        speed, step = np.abs(slip), tau[1] - tau[0]
        with np.errstate(divide="ignore", invalid="ignore"):
            trailed = self.law.presliding() * np.abs((slip.conj() * rate).imag) / speed**3
        passed = speed * step > self.law.presliding()
        return float(np.where(passed, np.fmin(trailed, 1.0), 0.0).mean())

    def _along(self) -> int:
        """How often per period slip reverses along x1."""
        if self.slip is not None:
            return self._sign_changes(lambda slip: slip.real)
        return 2 if abs(self.motion.velocity) > abs(self.scene.belt_speed) else 0

    def _across(self) -> int:
        """How often it reverses along x2."""
        if self.slip is not None:
            return self._sign_changes(lambda slip: slip.imag)
        return 2 if self.motion.transverse_velocity != 0 else 0

    def _sign_changes(self, part: Callable[[PlaneVectors], Floats]) -> int:
        _, slip, _ = self._slips(4096)
        sides = np.sign(part(slip))
        return int(np.count_nonzero(sides * np.roll(sides, 1) < 0.0))

    def _turns(self, run: BristlePeriod) -> int:
        """How often slip turns round for the law: of a law of each axis, along either."""
        if self.law.form != PER_AXIS or self.straight:
            return run.reversals
        return self._along() + self._across()

    def _jumps(self, run: BristlePeriod) -> int:
        """How often the rate of bristles jumps: in the plane slip need not stop for z.v = 0."""
        return (
            0
            if self.straight or self.law.form != VECTORIAL or not self.law.elastic_unloading()
            else run.bends
        )

    def _has_corners(self, run: BristlePeriod) -> bool:
        """Whether friction has corners within steps: an order is then seen by chance alone."""
        yields = math.isfinite(self.law.yield_deflection()) and not self.straight
        return self._turns(run) + self._jumps(run) > 0 or yields

    def orbit(self) -> Orbit | None:
        """The prescribed motion and the friction along it."""
        if self.status != "ok":
            return None
        if self.slip is not None:
            return self._orbit_of_pieces(self.slip)
        angle = (np.arange(PANELS)[:, None] + 0.5 * (1.0 + NODES)) * (2.0 * math.pi / PANELS)
        turn = np.exp(1j * angle)
        phasors = self.motion.velocity, self.motion.transverse_velocity
        v = (phasors[0] * turn).imag + 1j * (phasors[1] * turn).imag
        x = -((phasors[0] * turn).real + 1j * (phasors[1] * turn).real) / self.motion.frequency
        rub = _between(self.runs[0].each, angle)
        return Orbit(angle / self.motion.frequency, x, v, rub, None)

    def _orbit_of_pieces(self, slip: VaryingSlip) -> Orbit:
        """Panels between corners; friction from that of the middle of every step, as in ``_between``."""
        edges, run = slip.along.edges, self.runs[0]
        coarsest, whole = self.steps // self.refined, 2.0 * math.pi / self.motion.frequency
        panels: list[Floats] = []
        friction: list[PlaneVectors] = []
        at = 0
        for start, stop in itertools.pairwise(edges):
            n = self.refined * max(1, math.ceil(coarsest * ((stop - start) / whole) - 1e-9))
            own = max(1, round(PANELS * (stop - start) / edges[-1]))
            tau = start + (stop - start) / own * (np.arange(own)[:, None] + 0.5 * (1.0 + NODES))
            place = (tau - start) * (n / (stop - start)) - 0.5
            rub = _cubic(run.each[at : at + n], place, np.clip(np.floor(place), 1, max(1, n - 3)))
            panels.append(tau)
            friction.append(rub)
            at += n
        return replace(slip.orbit(np.concatenate(panels), np.concatenate(friction)), stick=None)


def _between(each: PlaneVectors, angle: Floats) -> PlaneVectors:
    """Friction at these angles, from that of the middle of every step by the cubic through the nearest four.

    The straight line between two would bend every loop inwards, and take of its area.
    """
    place = angle * (len(each) / (2.0 * math.pi)) - 0.5
    return _cubic(each, place, np.floor(place))


def _cubic(each: PlaneVectors, place: Floats, second: Floats) -> PlaneVectors:
    """The cubic through the four values that begin before the place ``second``, evaluated at a place among them."""
    below = second.astype(np.int64)
    s = place - below
    weights = (
        -s * (s - 1.0) * (s - 2.0) / 6.0,
        (s * s - 1.0) * (s - 2.0) / 2.0,
        -s * (s + 1.0) * (s - 2.0) / 2.0,
        s * (s * s - 1.0) / 6.0,
    )
    parts = [weight * each[(below + k - 1) % len(each)] for k, weight in enumerate(weights)]
    return np.asarray(sum(parts))
