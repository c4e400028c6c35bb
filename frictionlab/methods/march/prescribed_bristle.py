"""Time stepping of bristles under a prescribed slip: only their deflection is stepped, until it repeats.

Licence (tests/benchmarks/specialists.py, 12 scenes): 4 times faster in the median at 1e-3 than the laps of march
with a mass that friction does not move (0.8 to 33 times; kernels alone 138 times).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import length
from frictionlab.dynamics.contact import advance_bristle, project_to_yield, resistance
from frictionlab.dynamics.motion import mean_friction
from frictionlab.laws.memory import PER_AXIS, VECTORIAL
from frictionlab.methods.base import Status
from frictionlab.methods.march.answers import PointAnswer
from frictionlab.methods.march.error import COARSEST, ROUNDING, Plan
from frictionlab.methods.march.prescribed_slip import path_between, slip_at_angle
from frictionlab.methods.march.stability import fewest_steps
from frictionlab.numerics.richardson import REVERSING, SMOOTH, first_error, richardson
from frictionlab.orbit.panels import NODES
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.body import Motion
from frictionlab.scene.scene import Scene

MOST_STEPS, WORK = 1 << 20, 16_000_000
"""Steps per period, and in all, of one point."""
PANELS = 1024
"""Of the record of an orbit: friction has corners inside them."""
REPEATED = 1e-13
"""Change of the deflection over a period, over the largest met, that counts as none."""


class PrescribedSteps(NamedTuple):
    """The slip that drags the bristle along, and how it is stepped."""

    motion: Motion
    belt_speed: float
    steps: int  # per period
    by_rk4: bool
    most: int  # periods


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
def _by_rk4(law: Any, drive: PrescribedSteps, angle: float, h: float, z: Any) -> BristleStep:
    """The classical Runge-Kutta method (W. Kutta, 1901)."""
    motion, half = drive.motion, 0.5 * h
    # The slip is known at any time: the deflection alone is stepped, and its two middle stages share a slip.
    w1 = slip_of(drive, angle, z)
    w2 = slip_of(drive, angle + half * motion.frequency, z)
    w4 = slip_of(drive, angle + h * motion.frequency, z)
    r1, f1 = resistance(law, w1, z)
    r2, f2 = resistance(law, w2, z + half * r1)
    r3, f3 = resistance(law, w2, z + half * r2)
    r4, f4 = resistance(law, w4, z + h * r3)
    after = z + (h / 6.0) * (r1 + 2.0 * r2 + 2.0 * r3 + r4)
    return BristleStep(project_to_yield(law, after), (f1 + 2.0 * f2 + 2.0 * f3 + f4) / 6.0)


@inner
def _exponentially(law: Any, drive: PrescribedSteps, angle: float, h: float, z: Any) -> BristleStep:
    """Straight slip over as much path as there is; friction is that of the middle."""
    motion, half = drive.motion, 0.5 * h
    # Two halves, each straight and at its mean velocity; friction is asked for between them.
    middle = angle + half * motion.frequency
    bent = advance_bristle(law, half, path_of(drive, angle, middle, z) / half, z)
    _, rub = resistance(law, slip_of(drive, middle, z), bent)
    end = middle + half * motion.frequency
    return BristleStep(advance_bristle(law, half, path_of(drive, middle, end, z) / half, bent), rub)


@inner
def step_periods(law: Any, drive: PrescribedSteps, z: Any) -> BristlePeriod:
    """Period after period from the deflection z, until it repeats or the periods are used up."""
    motion, n = drive.motion, drive.steps
    h = 2.0 * math.pi / (motion.frequency * n)
    each = np.empty(n, np.complex128)
    period, last_gap, left, total, reversals, bends = 0, 0.0, 1e300, 0.0 * z, 0, 0
    while period < drive.most and left > REPEATED:
        # A period anew: of the last one alone the mean, the reversals and the bends are kept.
        before, deepest, total, reversals, bends = z, 1e-300, 0.0 * z, 0, 0
        last = slip_of(drive, 0.0, z)
        for i in range(n):
            angle, bent = 2.0 * math.pi * i / n, (z * last.conjugate()).real
            step = (
                _by_rk4(law, drive, angle, h, z) if drive.by_rk4 else _exponentially(law, drive, angle, h, z)
            )
            z, deepest = step.z, max(deepest, length(step.z))
            total = total + step.mu
            each[i] = step.mu + 0j
            # Where slip reverses, or the bristle begins or ends to be bent back, friction has a corner in this step.
            ahead = slip_of(drive, angle + 2.0 * math.pi / n, z)
            reversals += 1 if (ahead * last.conjugate()).real < 0.0 else 0
            bends += 1 if (z * ahead.conjugate()).real * bent < 0.0 else 0
            last = ahead
        # Gaps shrink like a geometric series: what is left is their sum. Rounding alone keeps the last ones open.
        gap = length(z - before) / deepest
        rate = min(gap / last_gap, 0.9999999) if last_gap > 0.0 else 0.0
        left = gap / (1.0 - rate) if period > 0 else 1e300
        left = gap if gap <= REPEATED else left
        last_gap, period = gap, period + 1
    return BristlePeriod(mean_friction(total, n) + 0j, reversals, bends, z + 0j, left, period, each)


class SteppedPoint:
    """One scene of prescribed slip, stepped."""

    def __init__(self, scene: Scene, law: Any, tolerance: float, plan: Plan) -> None:
        self.scene, self.law, self.plan, self.motion = scene, law, plan, scene.motion()
        self.straight = scene.load_along_belt_only
        self.seconds, self.reason = 0.0, ""
        self.status: Status = "ok"
        self.runs: list[BristlePeriod] = []
        self.mean, self.error = self._given() if plan.steps else self._halved(tolerance)
        self.model = f"prescribed slip, {plan.stepper}: {len(self.runs[0].each)} steps per period"
        self.answer = PointAnswer(self.mean, self.error, 1.0)
        self._judge(tolerance)

    def _judge(self, tolerance: float) -> None:
        last = self.runs[-1]
        if last.open > 1e-6:
            self._leave(
                "failed", f"the deflection still changes after {last.periods} periods; give more periods"
            )
            return
        starts = [self._run(len(self.runs[0].each), side * self.law.presliding()) for side in (1, -1)]
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

    def _run(self, steps: int, start: complex) -> BristlePeriod:
        call = KernelCall(step_periods, self.law)
        most = max(2, min(self.plan.periods, WORK // steps))
        drive = PrescribedSteps(self.motion, self.scene.belt_speed, steps, self.plan.stepper == "rk4", most)
        z = float(start.real) if self.straight else complex(start)
        found, seconds = call.timed(drive, z)
        self.seconds += seconds
        return found

    def _given(self) -> tuple[complex, float]:
        """The mean of so many steps; twice and four times as many tell its error."""
        assert self.plan.steps is not None
        self.runs = [self._run(part * self.plan.steps, 0.0) for part in (1, 2, 4)]
        means = [run.mean.real for run in self.runs]
        return self.runs[0].mean, first_error(means) + self._beside(self.runs[0])

    def _halved(self, tolerance: float) -> tuple[complex, float]:
        """Steps doubled until the error is below the tolerance; ``runs`` keeps the finest, and one before it."""
        steps = max(COARSEST, fewest_steps(self.scene, self.law, self.plan.stepper))
        runs, error, value, across = [self._run(steps, 0.0)], math.inf, 0.0, 0.0
        while error > tolerance and (2 * steps <= MOST_STEPS or len(runs) < 3):
            steps *= 2
            runs.append(self._run(steps, runs[-1].z))
            least = REVERSING if self._has_corners(runs[-1]) else SMOOTH
            found = richardson([run.mean.real for run in runs], self.plan.order, least)
            across = richardson([run.mean.imag for run in runs], self.plan.order, least).value
            value, error = found.value, found.error + self._beside(runs[-1])
            error = error if len(runs) > 2 else math.inf
        self.runs = runs[-1:]
        return complex(value, across), error

    def _beside(self, run: BristlePeriod) -> float:
        """Rounding, what is open, and what steps in which slip reverses may misplace."""
        friction, n = self.law.sliding_friction(0.0), len(run.each)
        turn = self.motion.frequency * math.hypot(
            abs(self.motion.velocity), abs(self.motion.transverse_velocity)
        )
        bending = math.sqrt(2.0 * self.law.presliding() / turn) if turn > 0.0 else math.inf
        step = 2.0 * math.pi / self.motion.frequency / n
        missed = friction * self._turns(run) / n * min(1.0, 0.5 * step / bending)
        missed += (
            0.5 * friction * self._jumps(run) / n
        )  # half a step, for as long as the friction takes to build up
        return missed + friction * self._lag(n) + 2.0 * friction * run.open + ROUNDING

    def _lag(self, n: int) -> float:
        """Mean angle by which bristles trail behind slip that turns, over the steps that pass the presliding length.

        Steps as long as that tell nothing of it, nor does the change to others as long.
        """
        if self.straight or self.law.form != VECTORIAL:
            return 0.0
        motion, angle = self.motion, (np.arange(n) + 0.5) * (2.0 * math.pi / n)
        along, across = motion.velocity * np.exp(1j * angle), motion.transverse_velocity * np.exp(1j * angle)
        slip = along.imag - self.scene.belt_speed + 1j * across.imag
        speed, rate = np.abs(slip), motion.frequency * (along.real + 1j * across.real)
        with np.errstate(divide="ignore", invalid="ignore"):
            trailed = self.law.presliding() * np.abs((slip.conj() * rate).imag) / speed**3
        passed = speed * (2.0 * math.pi / motion.frequency / n) > self.law.presliding()
        return float(np.where(passed, np.fmin(trailed, 1.0), 0.0).mean())

    def _along(self) -> int:
        """How often per period slip reverses along x1."""
        return 2 if abs(self.motion.velocity) > abs(self.scene.belt_speed) else 0

    def _turns(self, run: BristlePeriod) -> int:
        """How often slip turns round for the law: of a law of each axis, along either."""
        if self.law.form != PER_AXIS or self.straight:
            return run.reversals
        return self._along() + (2 if self.motion.transverse_velocity != 0 else 0)

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
        angle = (np.arange(PANELS)[:, None] + 0.5 * (1.0 + NODES)) * (2.0 * math.pi / PANELS)
        turn = np.exp(1j * angle)
        phasors = self.motion.velocity, self.motion.transverse_velocity
        v = (phasors[0] * turn).imag + 1j * (phasors[1] * turn).imag
        x = -((phasors[0] * turn).real + 1j * (phasors[1] * turn).real) / self.motion.frequency
        rub = _between(self.runs[0].each, angle)
        return Orbit(angle / self.motion.frequency, x, v, rub, None)


def _between(each: NDArray[np.complex128], angle: Floats) -> NDArray[np.complex128]:
    """Friction at these angles, from that of the middle of every step by the cubic through the nearest four.

    The straight line between two would bend every loop inwards, and take of its area.
    """
    place = angle * (len(each) / (2.0 * math.pi)) - 0.5
    below = np.floor(place).astype(np.int64)
    s = place - below
    weights = (
        -s * (s - 1.0) * (s - 2.0) / 6.0,
        (s * s - 1.0) * (s - 2.0) / 2.0,
        -s * (s + 1.0) * (s - 2.0) / 2.0,
        s * (s * s - 1.0) / 6.0,
    )
    parts = [weight * each[(below + k - 1) % len(each)] for k, weight in enumerate(weights)]
    return np.asarray(sum(parts))
