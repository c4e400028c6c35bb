"""Shooting: the period map of adaptive eighth-order steps, stick included, closed by quasi-Newton steps."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw
from frictionlab.methods.base import Answers, Method, Status
from frictionlab.methods.periodic.attraction import MOST_PERIODS
from frictionlab.methods.periodic.continuation import CLOSED, DIFFERENTIATED, Curve
from frictionlab.methods.periodic.problem import PeriodicProblem, along_the_belt
from frictionlab.methods.prescribed.bristle import refusal_of_prescribed
from frictionlab.methods.prescribed.method import solve_prescribed
from frictionlab.methods.shooting.attractors import attractors, closed_orbit, multiplier, told
from frictionlab.methods.shooting.decoupled import axes_apart, solve_apart
from frictionlab.methods.shooting.saturated import saturates, solve_saturated
from frictionlab.methods.shooting.undriven import solve_undriven
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.theory.rest import resting_range, stays_at_rest

NOTHING = complex(math.nan, math.nan)


class Shooting(Method):
    """Shooting on the period map of any law, with whatever memory, on the line and in the plane.

    Integrates the deviation from the friction-free response by DOP853 with the instants of stick and release
    resolved, and closes the orbit by Broyden's method with Newton and Picard steps where it stalls. The error comes
    from a last map sixteen times finer: what it leaves open, carried to the mean by the contraction of monotone
    friction, or by the mean's own change where friction falls with speed. There the orbit must attract, and starts
    far from each other must reach it; otherwise the mean is not unique.
    Along the belt a bristle whose path is exact is put in as a function of the way slid; otherwise mass and bristle
    are solved for together by Rodas5P, as mass and any other memory are. In the plane, friction by axis leaves two
    bodies of one direction, and a deflection along the slip ends at its limit: friction is then without memory.
    Without a drive the period is an unknown too, and the answer is the state reached from scene.initial. A prescribed
    slip leaves a mass nothing to close: the mean is quadrature, or that of the closed loop of the memory.

    Sources: DOP853: Hairer, Nørsett & Wanner (1993); Broyden (1965); Rodas5P: Steinebach (2023).
    """

    name: ClassVar[str] = "shooting"

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Memory where nothing drives; an undriven start across the belt; a law of none of the kinds known."""
        if isinstance(law, BristleLaw) and scene.degrees_of_freedom == 0:
            return refusal_of_prescribed(scene, law)
        if isinstance(law, MemoryLaw):
            return _refusal_with_memory(scene)
        if not isinstance(law, SlidingLaw | BristleLaw):
            return "shooting needs a SlidingLaw, a BristleLaw or a MemoryLaw"
        if isinstance(law, BristleLaw):
            return _refusal_with_a_bristle(scene, law)
        if scene.undriven and (scene.start.x2 != 0.0 or scene.start.velocity2 != 0.0):
            return "undriven scenes are solved along the belt only: leave initial.x2 and velocity2 at 0"
        return None

    def cost(self, scene: Scene, law: FrictionLaw, tolerance: float) -> float:
        """About 0.3 ms in the plane and 0.1 ms on the line at 1e-9; steps grow as tolerance^(-1/8).

        With a bristle, other starts included, 1 ms on the line where the path is exact, else ten times as long and as
        tolerance^(-1/5), and 50 ms in the plane. With another memory 20 ms on the line and 200 ms in the plane.
        """
        if isinstance(law, MemoryLaw):
            return (2e-2 if scene.load_along_belt_only else 2e-1) * (1e-6 / tolerance) ** 0.2
        if not isinstance(law, BristleLaw):
            return (1e-4 if scene.load_along_belt_only else 3e-4) * (1e-9 / tolerance) ** 0.125
        if not scene.load_along_belt_only:
            return 5e-2 * (1e-6 / tolerance) ** 0.2
        return 1e-3 * (1e-9 / tolerance) ** 0.125 if law.exact_path() else 1e-2 * (1e-6 / tolerance) ** 0.2

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Answer a curve by continuation in belt speed."""
        if scenes[0].degrees_of_freedom == 0:
            return solve_prescribed(scenes, law, tolerance)
        if scenes[0].undriven:
            assert isinstance(law, SlidingLaw)
            return solve_undriven(scenes, law, tolerance)
        if isinstance(law, BristleLaw) and saturates(scenes[0], law):
            return solve_saturated(self.solve, scenes, law, tolerance)
        if isinstance(law, BristleLaw) and axes_apart(scenes[0], law):
            return solve_apart(self.solve, scenes, law, tolerance)
        closer = PeriodicProblem(scenes[0], law, tolerance)
        found = Found.empty(scenes, closer)
        resting = [i for i, scene in enumerate(scenes) if stays_at_rest(scene, law)]
        moving = [i for i in range(len(scenes)) if i not in resting]
        judged_by_multipliers = not closer.goal.contracts or _undamped(scenes[0])
        wanted = DIFFERENTIATED if judged_by_multipliers else CLOSED
        if moving:
            found.take(moving, scenes[0], *closer.closed([scenes[i] for i in moving], wanted=wanted))
        for i in moving if not closer.goal.contracts else ():
            if isinstance(law, BristleLaw) and found.holds_elastically(i, scenes[i], law):
                found.leave_elastic(i, law)
            elif isinstance(law, SlidingLaw) or not closer.falls_slowly or not found.attracts(i):
                found.hold_to_other_starts(i, closer, scenes[i])
        for i in resting:
            assert isinstance(law, SlidingLaw)
            start = scenes[i].initial
            settled = closer.settled(start) if start is not None else None
            if settled is None:
                found.leave_open(i, resting_range(scenes[i], law))
            elif settled[1] < 0:
                found.reason[i] = (
                    f"started from scene.initial the mass still creeps after {MOST_PERIODS} periods"
                )
            else:
                found.take([i], scenes[i], *closer.closed([scenes[i]], settled[0], wanted=wanted))
                found.error[i] += 1e-11 * settled[1]  # of the steps on the way there
                found.reason[i] = (
                    "the state reached from scene.initial; other starts come to rest at other places"
                )
        found.judge(tolerance)
        return Answers(
            status=found.status,
            reason=found.reason,
            model=[_model(scenes[0], closer)] * len(scenes),
            error_kind=["estimated" if status == "ok" else "" for status in found.status],
            mean=found.mean,
            error=found.error,
            period=found.period,
            floquet=lambda: found.floquet(closer, scenes),
            mean_low=found.low,
            mean_high=found.high,
            window=np.where(np.isnan(found.low), np.nan, 1.0),
            seconds=found.seconds,
            orbit=lambda i: closer.orbits([scenes[i]], [found.states[i]]).one(0),
            orbits=lambda: closer.orbits(scenes, found.states),
        )


@dataclass(frozen=True)
class Found:
    """What has been found so far of a curve's answers; multipliers: NaN where nothing has asked for them."""

    status: list[Status]
    reason: list[str]
    states: list[Floats | None]
    reached: list[bool]
    mean: NDArray[np.complex128]
    error: Floats
    low: Floats
    high: Floats
    period: Floats
    multipliers: Floats
    seconds: Floats
    whole: (
        bool  # states have every degree of freedom: along the line, multipliers across the belt are left out
    )

    @classmethod
    def empty(cls, scenes: Sequence[Scene], closer: PeriodicProblem) -> Found:
        """Nothing found yet for these scenes."""
        n = len(scenes)
        whole = (scenes[0].degrees_of_freedom == 2) == isinstance(closer.like, complex)
        error, low, high, period, multipliers, seconds = np.full((6, n), np.nan)
        return cls(
            status=["failed"] * n,
            reason=[""] * n,
            states=[None] * n,
            reached=[False] * n,
            mean=np.full(n, NOTHING),
            error=error,
            low=low,
            high=high,
            period=period,
            multipliers=multipliers,
            seconds=seconds,
            whole=whole,
        )

    def take(self, where: list[int], scene: Scene, curve: Curve, seconds: float) -> None:
        """Take in the closed orbits of the scenes at these places."""
        self.seconds[where] = seconds / len(where)
        multipliers = _multipliers(curve)
        for row, i in enumerate(where):
            self.reached[i] = bool(curve.reached[row])
            maps, error = curve.results[row, 3], curve.results[row, 2]
            if maps < 0.0:
                self.reason[i] = f"no steady state found in {-maps:.0f} period maps (error {error:.1e})"
            elif _undamped(scene) and multipliers[row] > 1.0 - 1e-6 and not _at_rest(curve, row):
                self.reason[i] = (
                    "without damping a free oscillation remains, and the state depends on the start"
                )
                self._range(i, curve.results[row, 0], curve.results[row, 0])
            else:
                self._put(i, curve, row)
                self.multipliers[i] = multipliers[row]

    def floquet(self, closer: PeriodicProblem, scenes: Sequence[Scene]) -> Floats:
        """The largest multipliers, where those of every degree of freedom are known; found where not known yet."""
        if not self.whole:
            return np.full(len(scenes), np.nan)
        open_ones = [
            state if math.isnan(known) else None
            for state, known in zip(self.states, self.multipliers, strict=True)
        ]
        return np.fmax(self.multipliers, closer.multipliers(scenes, open_ones))

    def attracts(self, i: int) -> bool:
        """Whether no small disturbance leaves the answer, and both starts that are quick to ask end there."""
        return self.status[i] == "ok" and self.reached[i] and not self._known(i) > 1.0 + 1e-6

    def holds_elastically(self, i: int, scene: Scene, law: BristleLaw) -> bool:
        """Whether on a belt at rest the bristle only follows the mass: nothing then decides about its mean."""
        if scene.belt_speed != 0.0 or law.elastic_deflection() == 0.0:
            return False
        return self.status[i] != "ok" or bool(self._known(i) > 1.0 - 1e-6)

    def leave_elastic(self, i: int, law: BristleLaw) -> None:
        """A bristle that never yields on a belt at rest: its mean deflection depends on the start."""
        most = abs(law.friction(0.0, law.elastic_deflection(), 0.0))
        self._clear(i)
        self._range(i, -most, most)
        self.reason[i] = (
            "the belt is at rest and the bristle is elastic under these loads: the mean depends on the start"
        )

    def hold_to_other_starts(self, i: int, closer: PeriodicProblem, scene: Scene) -> None:
        """Keep an answer only where every start reaches it; else the one reached from scene.initial, or none."""
        known = None
        if self.states[i] is not None:
            curve, _ = closer.closed([scene], self.states[i])
            known = closed_orbit(curve, curve.results[0, :1])
        reached, seconds = attractors(closer, scene, known)
        self.seconds[i] += seconds
        first, unique = reached[0], all(reached[0].agrees(other) for other in reached)
        self._clear(i)
        if first.period == 1 and first.curve is not None and (unique or scene.initial is not None):
            self._put(i, first.curve, 0)
            self.multipliers[i] = multiplier(first.curve)
            self.reason[i] = "" if unique else f"reached from scene.initial; {told(reached)}"
            return
        if closer.falls_slowly and all(one.curve is None for one in reached):
            self.reason[i] = f"no steady state found: {told(reached)}"
            return
        self._range(i, min(one.low for one in reached), max(one.high for one in reached))
        lags = "the memory" if isinstance(closer.law, MemoryLaw) else "the deflection"
        why = f"{lags} lags behind the slip" if closer.falls_slowly else "friction falls with speed"
        self.reason[i] = f"{why}: {told(reached)}"
        if unique and first.curve is not None:
            self.period[i] = first.period
            self.multipliers[i] = multiplier(first.curve)

    def _known(self, i: int) -> float:
        """The largest multiplier, where those of every degree of freedom are known."""
        return float(self.multipliers[i]) if self.whole else math.nan

    def _clear(self, i: int) -> None:
        self.status[i], self.reason[i], self.states[i] = "failed", "", None
        self.mean[i] = NOTHING
        for numbers in (self.error, self.low, self.high, self.period, self.multipliers):
            numbers[i] = np.nan

    def leave_open(self, i: int, highest: float) -> None:
        """A mass that can rest for ever on a belt at rest: where it rests depends on where it starts."""
        self._range(i, -highest, highest)
        self.reason[i] = (
            "the belt is at rest and static friction balances the loads: the mass may rest anywhere in a range; "
            "give scene.initial to choose a start"
        )

    def _range(self, i: int, low: float, high: float) -> None:
        self.status[i] = "not_unique"
        self.low[i], self.high[i] = low, high

    def _put(self, i: int, curve: Curve, row: int) -> None:
        mean, across, error = curve.results[row, :3]
        self.mean[i], self.error[i], self.period[i] = complex(mean, across), error, 1.0
        self.status[i], self.states[i] = "ok", curve.states[row]

    def judge(self, tolerance: float) -> None:
        """Say where the error is above the tolerance."""
        for i, error in enumerate(self.error):
            if self.status[i] == "ok" and not error <= tolerance:
                said = f"the error is above the tolerance {tolerance:.1e}"
                self.reason[i] = f"{self.reason[i]}; {said}" if self.reason[i] else said


def _refusal_with_a_bristle(scene: Scene, law: BristleLaw) -> str | None:
    if scene.undriven:
        return "for undriven scenes shooting needs friction without memory: use march, or give a drive"
    if not along_the_belt(scene, law) and law.planar == "vectorial" and law.no_vector_form():
        return law.no_vector_form()
    return None


def _refusal_with_memory(scene: Scene) -> str | None:
    if scene.undriven:
        return "for undriven scenes shooting needs friction without memory: give a drive"
    return None


def _undamped(scene: Scene) -> bool:
    mass = scene.mass()
    return mass.damping == 0.0 or (scene.transverse is not None and mass.transverse_damping == 0.0)


def _at_rest(curve: Curve, row: int) -> bool:
    return bool(curve.results[row, 4] > 1.0 - 1e-9)


def _model(scene: Scene, closer: PeriodicProblem) -> str:
    directions = "two degrees" if isinstance(closer.like, complex) else "one degree"
    if scene.degrees_of_freedom == 2 and directions == "one degree":
        model = "shooting, one degree of freedom: without a load across the belt x2 decays"
    else:
        model = f"shooting, {directions} of freedom"
    if isinstance(closer.law, MemoryLaw):
        return f"{model}; mass and memory solved together (Rodas5P)"
    if not isinstance(closer.law, BristleLaw):
        return model
    if directions == "one degree" and closer.law.exact_path():
        return f"{model}; deflection as a function of the slip path"
    return f"{model}; mass and bristle solved together (Rodas5P)"


def _multipliers(curve: Curve) -> Floats:
    """The largest modulus of each orbit's; NaN where the maps were not differentiated."""
    if not len(curve.matrices):
        return np.full(len(curve.states), np.nan)
    return np.asarray(np.abs(np.linalg.eigvals(curve.matrices)).max(axis=1))
