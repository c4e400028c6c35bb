"""Steady states of a driven mass along a curve in belt speed: closed orbits that every start must reach."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property, reduce
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import (
    NOT_UNIQUE,
    PROVED,
    STATISTICAL,
    TESTED,
    Answers,
    FoundState,
    Ledger,
    Multipliers,
)
from frictionlab.methods.periodic.continuation import CLOSED, DIFFERENTIATED, Curve
from frictionlab.methods.periodic.follow import MOST, Attractor, DrivePeriods, closed_orbit, multiplier
from frictionlab.methods.periodic.long_mean import DRIVEN, SHARED, is_earned, spread_of_one_mean, too_wide
from frictionlab.methods.periodic.period_map import MAP_KINDS
from frictionlab.methods.periodic.problem import PeriodicProblem, largest_modulus, undamped
from frictionlab.methods.prescribed.memory import HOLDS
from frictionlab.methods.shooting.attractors import (
    FollowedStarts,
    Trial,
    carried_for,
    describe,
    follow_all,
    found_state,
    left_unfinished,
    quick_starts,
    same_state,
)
from frictionlab.methods.shooting.long_motions import average_unrepeated
from frictionlab.methods.under_way import each_told
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.record import End, Orbit, Orbits
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes, belt_speeds_of
from frictionlab.theory.linear import velocity_scale
from frictionlab.theory.rest import (
    can_hold,
    friction_at_rest,
    is_unique_in_slip,
    resting_range,
    stays_at_rest,
)
from frictionlab.values.quantities import Floats

Complexes = NDArray[np.complex128]

READ_OVER = 512
"""Periods of a motion that does not repeat over which columns other than the mean are read."""
SURELY = 1e-6
"""By how much a multiplier above one is no rounding error."""
CENTRAL = 1e-6
"""Error of multipliers by central quotients of a law without memory, absolute or of those above one."""
FINE, KINK = 1e-8, 1e-3
"""Least error of multipliers by quotients of fine maps, and change that only a map without a derivative explains."""
NO_DERIVATIVE = (
    "no multiplier: the period map has no derivative here; over two shifts its quotients give {rough:.4g} and "
    "{fine:.4g}"
)
UNDAMPED = "without damping a free oscillation remains, and the state depends on the start"
UNBOUNDED = "at undamped resonance the amplitude may grow without bound"
CARRIED = "friction holds the mass, and the belt carries it for some {:.0e} drive periods from slip to slip"
BY_ROUNDING = (
    "next to rest two motions hardly approach each other in a period, and rounding alone leaves this error"
)
MAY_REST = (
    "the belt is at rest and static friction balances the loads: the mass may rest anywhere in a range; "
    "give scene.initial to choose a start"
)


def solve_driven(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """Answer driven scenes that differ in belt speed alone, by continuation."""
    states = SteadyStates(scenes, PeriodicProblem(scenes[0], law, tolerance))
    at_rest = np.flatnonzero(belt_speeds_of(scenes) == 0.0).tolist()
    resting = [i for i in at_rest if stays_at_rest(scenes[i], law)]
    moving = [i for i in range(len(scenes)) if i not in resting]
    states.close_all(moving)
    for i in each_told(moving, 0.5) if not states.problem.goal.contracts else ():
        states.check_attraction(i)
    states.carry_on()
    for i in resting:
        states.settle(i)
    states.judge(tolerance)
    states.tell_uniqueness()
    return states.answers()


class SteadyStates(Ledger):
    """Steady states of a curve, as far as they are known.

    spans: of all that changes in time, in the orbit of each. multipliers: NaN where nothing has asked for them.
    reached: for how many periods the two cheap starts were followed until they ended here, 0 where they do not.
    tried: starts that all ended here. followed: starts where the answer hangs on all of them. repelling: where an
    orbit of one period is known that motions leave. whole: states have every degree of freedom; along the line
    multipliers across the belt are left out.
    """

    def __init__(self, scenes: Sequence[Scene], problem: PeriodicProblem) -> None:
        n = len(scenes)
        super().__init__(n)
        self.scenes, self.problem = Scenes.of(scenes), problem
        self.belt_speeds = self.scenes.belt_speeds
        self.states: list[Floats | None] = [None] * n
        self.reached = [0] * n
        self.tried: dict[int, Trial] = {}
        self.followed: dict[int, FollowedStarts] = {}
        self.continua: dict[int, list[Floats]] = {}
        self.repelling: set[int] = set()
        self.multipliers = np.full(n, np.nan)
        self.error_kind = ["estimated"] * n
        self.spans = np.ones(n, np.int64)
        self.whole = (scenes[0].degrees_of_freedom == 2) == isinstance(problem.zero, complex)
        judged_by_multipliers = not problem.goal.contracts or undamped(scenes[0])
        self.matrices: list[Floats | None] = [None] * n
        self.wanted = DIFFERENTIATED if judged_by_multipliers else CLOSED
        self.proof = is_unique_in_slip(scenes[0], problem.law)
        self.near_rest = problem.by_implicit_steps
        self.solved_by = [problem] * n

    def close_all(self, where: list[int]) -> None:
        """Close the orbits of the scenes at these places: near rest by implicit steps, or where others fail.

        Where all do, from the end of a motion that is followed until it repeats, as all do that one orbit attracts.
        """
        held = self._held(where)
        self.close(sorted(held), by=self.near_rest)
        self.close([i for i in where if i not in held or self.status[i] == "failed"])
        failed = [i for i in where if i not in held and self.status[i] == "failed"]
        self.close(failed if self.near_rest else [], by=self.near_rest)
        for i in where if self.problem.goal.contracts else ():
            if self.status[i] == "failed":
                self._close_where_it_ends(i)

    def _close_where_it_ends(self, i: int) -> None:
        speed = float(self.belt_speeds[i])
        way = self.problem.carried(speed, self.problem.state_at(speed, None), MOST)
        self.seconds[i] += way.seconds
        self.close([i], way.state)

    def close(self, where: list[int], state: Floats | None = None, by: PeriodicProblem | None = None) -> None:
        """Close the orbits of the scenes at these places, from a known state at the first where there is one."""
        if not where:
            return
        problem = by or self.problem
        curve, seconds = problem.close(self.scenes.taken(where), state, wanted=self.wanted)
        self.seconds[where] = np.nan_to_num(self.seconds[where]) + seconds / len(where)
        multipliers, remains = _multipliers(curve), undamped(self.scenes.scene)
        closed = curve.closed
        found = closed.found.tolist()
        for row, i in enumerate(where):
            self.reached[i] = int(curve.reached[row])
            self.solved_by[i] = problem
            if not found[row]:
                steps = "" if problem is self.problem else " of implicit steps"
                self.remark(i, f"no closed orbit found in {-closed.maps[row]:.0f} period maps{steps}")
            elif remains and self._repeats(curve, row, multipliers[row], problem):
                self._leave_open(i, UNDAMPED, closed.mean[row], closed.mean[row])
            else:
                self.reason[i], self.status[i], self.states[i] = "", "ok", curve.states[row]
        good = [row for row, i in enumerate(where) if self.status[i] == "ok"]
        places = np.array(where)[good]
        self._put(places, curve, good)
        self.multipliers[places] = multipliers[good]
        for row in good if len(curve.matrices) else ():
            self.matrices[where[row]] = curve.matrices[row]

    def _held(self, where: list[int]) -> set[int]:
        """Return where friction can hold the mass at all times and the belt is too slow to keep it from rest."""
        near_rest = self.near_rest
        if near_rest is None or not can_hold(self.scenes.scene, near_rest.law):
            return set()
        speeds = np.abs(self.belt_speeds[where])
        return set(np.array(where)[(speeds > 0.0) & (speeds < near_rest.swing)].tolist())

    def _repeats(self, curve: Curve, row: int, multiplier: float, problem: PeriodicProblem) -> bool:
        """Check whether a motion beside an orbit goes on beside it: difference quotients know less of that."""
        known = 1e-6 if problem is self.problem else 1e-12
        return multiplier > 1.0 - known and not _at_rest(curve, row)

    def check_attraction(self, i: int) -> None:
        """Keep an answer that no theorem makes unique only where starts far from it end there."""
        if self._may_hold(i) and (continuum := DrivePeriods(self.problem, self.scenes[i]).continuum()):
            means = [each.mean for each in continuum]
            self.clear(i)
            self._leave_open(i, f"{HOLDS}: the mean depends on the start", min(means), max(means))
            self.continua[i] = [each.state for each in continuum]
        elif self.problem.goal.check_attraction and self._attracts(i):
            at = quick_starts(self.problem, float(self.belt_speeds[i]))
            self.tried[i] = Trial.of(at, self.problem.mass.stiffness, self.reached[i])
        else:
            self._compare_starts(i)

    def settle(self, i: int) -> None:
        """Find the state in which a mass that friction can hold comes to rest from scene.initial; else a range."""
        start = self.scenes[i].initial
        if start is None:
            scene, law = self.scenes[i], self.problem.law
            self._leave_open(i, MAY_REST, -resting_range(scene, law, -1.0), resting_range(scene, law))
            return
        state, periods = self.problem.settle(start)
        if periods < 0:
            self.reason[i] = f"started from scene.initial the mass still creeps after {-periods} periods"
            return
        self.close([i], state)
        self.error[i] += 1e-11 * periods  # of the steps on the way there
        self.reason[i] = "the state reached from scene.initial; other starts come to rest at other places"
        self.unique[i] = NOT_UNIQUE

    def judge(self, tolerance: float) -> None:
        """Say where the error is above the tolerance, and what may keep a motion from any steady state."""
        scene, law = self.scenes.scene, self.problem.law
        resonant = math.isinf(velocity_scale(scene)) and not can_hold(scene, law)
        for i, error in enumerate(self.error):
            if resonant and self.status[i] == "failed":
                self.remark(i, UNBOUNDED)
            periods = carried_for(self.scenes[i], self.problem.mass.normal_load * friction_at_rest(law))
            if periods > MOST and self.status[i] != "ok" and can_hold(scene, law):
                self.remark(i, CARRIED.format(periods * self.problem.common))
            statistical = self.status[i] == "ok" and self.error_kind[i] == STATISTICAL
            if statistical and not is_earned(error, scene, law, tolerance):
                said = f"{self.reason[i]}; {too_wide(self.mean[i].real, error)}"
                self.clear(i)
                self.reason[i] = said
            if self.status[i] == "ok" and not error <= tolerance and not statistical:
                said = f"the error is above the tolerance {tolerance:.1e}"
                self.remark(i, said if self.solved_by[i] is self.problem else f"{said}: {BY_ROUNDING}")

    def tell_uniqueness(self) -> None:
        """Say of answers that no other start was found to leave how that is known."""
        for i, status in enumerate(self.status):
            if status != "ok" or self.unique[i]:
                continue
            if i in self.tried:
                self.unique[i] = TESTED
                self.remark(i, self.tried[i].sentence(self._known(i)))
            elif self.proof or (self.problem.goal.contracts and self.multipliers[i] < 1.0):
                self.unique[i] = PROVED

    def answers(self, **others: Any) -> Answers:
        """As every method gives them."""
        ways = list(dict.fromkeys(self.solved_by))
        models = {(way, ""): _model(self.scenes.scene, self.problem, way) for way in ways}
        damped = ModelWord.DAMPED if self.problem.law.monotone() else ModelWord.SLOW_FALL
        theorem = damped if self.proof else ModelWord.NEIGHBOURS
        models |= {(way, PROVED): f"{models[way, '']}; {theorem}" for way in ways}
        proved = [PROVED if each == PROVED else "" for each in self.unique]
        self.model = [models[each] for each in zip(self.solved_by, proved, strict=True)]
        return super().answers(
            floquet=self._floquet,
            multipliers=lambda: self._multipliers,
            orbit=self._orbit,
            orbits=None if STATISTICAL in self.error_kind else self._orbits,
            states=self._found_states,
            ends=self._ends,
        )

    def _found_states(self, i: int) -> list[FoundState]:
        """Return the states that the starts reached, each once."""
        reached = self.followed[i].reached if i in self.followed else []
        different: list[Attractor] = []
        for one in reached:
            if not any(same_state(one, other) for other in different):
                different.append(one)
        return [found_state(self.problem, i, one, reached) for one in different]

    def _states_by(self, problem: PeriodicProblem, spans: int = 1) -> list[Floats | None]:
        """Return the states of the orbits of so many spans that one way of solving has found."""
        each = zip(self.states, self.solved_by, self.spans, strict=True)
        return [state if by is problem and length == spans else None for state, by, length in each]

    def _orbits(self) -> Orbits:
        kinds = dict.fromkeys(zip(self.solved_by, self.spans.tolist(), strict=True))
        found = [way.orbits(self.scenes, self._states_by(way, spans), spans) for way, spans in kinds]
        return reduce(Orbits.and_those_of, found)

    def _orbit(self, i: int) -> Orbit | None:
        made = self.solved_by[i].orbits([self.scenes[i]], [self.states[i]], int(self.spans[i]))
        found = made.one(0)
        if found is None or self.error_kind[i] != STATISTICAL:
            return found
        return replace(found, periods=READ_OVER)

    def _floquet(self) -> Floats:
        """Largest multipliers, where those of every degree of freedom are known; computed where not known yet."""
        if not self.whole:
            return np.full(len(self.scenes), np.nan)
        found = self.multipliers
        for way in dict.fromkeys(self.solved_by):
            unknown = [
                state if math.isnan(known) else None
                for state, known in zip(self._states_by(way), found, strict=True)
            ]
            found = np.fmax(found, way.multipliers(self.scenes, unknown))
        return found

    @cached_property
    def _multipliers(self) -> Multipliers:
        if self.whole and self.problem.law.count() > 0:
            return self._by_central_quotients()
        found = self._floquet()
        ok = np.array([status == "ok" for status in self.status])
        error = np.where(ok & ~np.isnan(found), CENTRAL * np.maximum(found, 1.0), np.nan)
        return Multipliers(found, error, [""] * len(found))

    def _by_central_quotients(self) -> Multipliers:
        """Differentiate anew, by fine maps on both sides, the map of a law with memory: it had one-sided quotients.

        The change is the error. Where the map has a kink within the shift no number is the multiplier.
        """
        n = len(self.scenes)
        modulus, error, reason = self.multipliers.copy(), np.full(n, np.nan), [""] * n
        for i, (state, matrix) in enumerate(zip(self.states, self.matrices, strict=True)):
            if state is None or matrix is None or not matrix.any() or not np.isfinite(matrix).all():
                continue
            if self.status[i] != "ok" or self.spans[i] != 1:
                continue
            central = self.problem.derivative(float(self.belt_speeds[i]), state)
            rough, fine = largest_modulus(np.array([matrix, central])).tolist()
            change = abs(fine - rough)
            if change <= KINK * max(fine, 1e-2):
                modulus[i], error[i] = fine, 2.0 * change + FINE
            else:
                modulus[i] = math.nan
                reason[i] = NO_DERIVATIVE.format(rough=rough, fine=fine)
        return Multipliers(modulus, error, reason)

    def _attracts(self, i: int) -> bool:
        """Check whether no small disturbance leaves the answer, and both of the cheap starts end there."""
        return self.status[i] == "ok" and self.reached[i] > 0 and not self.multipliers[i] > 1.0 + SURELY

    def _may_hold(self, i: int) -> bool:
        """Check that the belt is at rest and a deflection may only follow the mass, and keep what it began with."""
        law = self.problem.law
        follows = law.memory_kind == "deflections" or law.elastic_deflection() > 0.0
        return follows and bool(self.belt_speeds[i] == 0.0)

    def _ends(self, i: int) -> list[End]:
        """Make the orbits of the states found at the ends of a range of means."""
        scene, states = self.scenes[i], self.continua.get(i, [])
        made = [self.problem.orbits([scene], [state]).one(0) for state in states]
        return [End(one, self.problem.goal.tolerance) for one in made if one is not None]

    def _compare_starts(self, i: int) -> None:
        """Keep an answer only where every start reaches it; else the one reached from scene.initial, or none."""
        problem, scene, known = self.problem, self.scenes[i], None
        if self.states[i] is not None:
            curve, _ = problem.close([scene], self.states[i])
            known = closed_orbit(curve, curve.closed.mean, gap=problem.gap)
            if curve.closed.found[0] and multiplier(curve) > 1.0 + SURELY:
                self.repelling.add(i)
        self.followed[i] = followed = follow_all(problem, scene, known)
        average_unrepeated(problem, scene, followed)
        self.seconds[i] += followed.seconds
        self._judge_starts(i)

    def carry_on(self) -> None:
        """Follow the orbits found at each belt speed on at the next, upwards and downwards.

        A state that only few starts reach may be reached by many at a neighbour, or be the neighbour's answer.
        """
        rising = sorted(self.followed)
        for here, there in each_told([*pairwise(rising), *pairwise(rising[::-1])], 0.25):
            if self.status[there] != "ok" or self.unique[there]:
                continue
            followed = self.followed[there]
            before = followed.seconds
            for one in list(self.followed[here].known):
                if one.curve is not None:
                    followed.carry_on(one)
            average_unrepeated(self.problem, self.scenes[there], followed)
            self.seconds[there] += followed.seconds - before
            self._judge_starts(there)

    def _judge_starts(self, i: int) -> None:
        """Keep the answer that all starts reach; else the one reached from scene.initial, or none.

        Starts that were stopped on their way tell nothing of where they lead.
        """
        problem, scene, followed = self.problem, self.scenes[i], self.followed[i]
        reached, unfinished = followed.ended, left_unfinished(followed.reached)
        first, unique = reached[0], all(reached[0].agrees(other) for other in reached)
        self.clear(i)
        if scene.initial is not None and followed.reached[0].lost:
            self.reason[i] = f"from scene.initial the motion runs away; {unfinished}"
            return
        if not unique and scene.initial is None and (shared := self._shared(reached)) is not None:
            found, spread = shared
            self._accept(i, found)
            self.error[i] += spread
            said = f"{self.reason[i]}; " if found.curve is None else ""
            self.reason[i] = said + SHARED + describe(reached)
            self.unique[i] = NOT_UNIQUE
            return
        own = scene.initial is not None and not followed.reached[0].stopped
        if not math.isnan(first.mean) and (unique or own):
            self._accept(i, first)
            if unfinished:
                self.remark(i, unfinished)
                self.unique[i] = NOT_UNIQUE if any(one.lost for one in followed.reached) else ""
            elif unique:
                self.tried[i] = followed.trial
            if not unique:
                self.remark(i, f"reached from scene.initial; {describe(reached)}")
                self.unique[i] = NOT_UNIQUE
            return
        ranges = [(one.low, one.high) if math.isnan(one.mean) else (one.mean, one.mean) for one in reached]
        low, high = min(ranges)[0], max(high for _, high in ranges)
        if any(one.neutral for one in reached):
            others = [one for one in reached if not one.neutral]
            self._leave_open(i, f"{UNDAMPED}; {describe(others)}" if others else UNDAMPED, low, high)
            return
        # Where the orbit of one period is known to repel, motions that never repeat are what they seem.
        wanders = (problem.falls_slowly or undamped(scene)) and i not in self.repelling
        if all(one.stopped for one in reached) or (
            wanders and all(one.curve is None and one.average is None for one in reached)
        ):
            self.reason[i] = f"no steady state found: {unfinished or describe(reached)}"
            return
        lags = (
            f"the {'deflection' if problem.law.memory_kind == 'bristle' else 'memory'} lags behind the slip"
        )
        why = lags if problem.falls_slowly else "friction falls with speed"
        why = "springs and dashpots are not linear" if scene.bends else why
        self._leave_open(i, f"{why}: {describe(reached)}", low, high)
        self.window[i] = max(one.averaged_over for one in reached) * problem.common

    def _shared(self, reached: Sequence[Attractor]) -> tuple[Attractor, float] | None:
        """A state whose mean passes for that of all, a closed orbit where the tolerance allows, and their spread."""
        means, errors = [one.mean for one in reached], [one.error for one in reached]
        for there, tolerance in (("curve", self.problem.goal.tolerance), ("average", 0.0)):
            found = next((one for one in reached if getattr(one, there) is not None), None)
            spread = spread_of_one_mean(means, errors, tolerance)
            if found is not None and not math.isnan(spread):
                return found, spread
        return None

    def _accept(self, i: int, found: Attractor) -> None:
        """Answer by where the starts lead."""
        self.status[i] = "ok"
        if found.curve is not None:
            self._put(i, found.curve, 0)
            self.spans[i], self.period[i] = found.period, found.period * self.problem.common
            self.states[i] = found.curve.states[0]
            self.multipliers[i], self.matrices[i] = multiplier(found.curve), found.curve.matrices[0]
            self.reason[i] = describe([found]) if found.period > 1 else ""
            return
        assert found.average is not None
        mean, error = complex(found.average.mean, math.nan), found.average.error
        self.mean[i], self.error[i], self.error_kind[i] = mean, error, STATISTICAL
        self.states[i], self.spans[i] = found.points[-1], READ_OVER
        self.window[i] = found.followed * self.problem.common
        self.reason[i] = found.average.sentence(float(self.window[i]), DRIVEN)

    def _known(self, i: int) -> float:
        """Return the largest multiplier, where those of every degree of freedom are known."""
        return float(self.multipliers[i]) if self.whole else math.nan

    def clear(self, i: int) -> None:
        """Forget all that is known of an answer."""
        super().clear(i)
        self.states[i], self.spans[i], self.error_kind[i] = None, 1, "estimated"
        self.multipliers[i] = math.nan

    def _leave_open(self, i: int, reason: str, low: float, high: float) -> None:
        self.leave_open(i, reason, low, high, self.problem.common)

    def _put(self, places: Any, curve: Curve, rows: Any) -> None:
        """Enter the numbers of these rows at these places."""
        closed = curve.closed
        self.mean.real[places], self.mean.imag[places] = closed.mean[rows], closed.across[rows]
        self.error[places], self.period[places] = closed.error[rows], self.problem.common


def _at_rest(curve: Curve, row: int) -> bool:
    return bool(curve.closed.stuck[row] > 1.0 - 1e-9)


def _model(scene: Scene, problem: PeriodicProblem, solved_by: PeriodicProblem) -> str:
    planar = isinstance(problem.zero, complex)
    words = [
        ModelWord.SHOOTING_PLANE if planar else ModelWord.SHOOTING_LINE,
        ModelWord.X2_DECAYS if scene.degrees_of_freedom == 2 and not planar else "",
        MAP_KINDS[problem.kind].said,
        "" if solved_by is problem else ModelWord.NEAR_REST,
    ]
    return "; ".join(filter(None, words))


def _multipliers(curve: Curve) -> Floats:
    """Return the largest modulus of each orbit's; NaN where the maps were not differentiated."""
    if not len(curve.matrices):
        return np.full(len(curve.states), np.nan)
    return largest_modulus(curve.matrices)
