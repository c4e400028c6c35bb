"""Laws with memory under a prescribed slip: fixed point of their period map, to which all starts must lead."""

from __future__ import annotations

import math
from typing import Any, cast

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.interpret import interpreted
from frictionlab.laws.memory import BristleLaw, MemoryLaw
from frictionlab.methods.base import Status
from frictionlab.methods.periodic.attraction import Follow, KnownOrbit, corners, unknown_orbit, write_start
from frictionlab.methods.periodic.continuation import DIFFERENTIATED, answer_curve
from frictionlab.methods.periodic.fixed_point import MUCH_WORK, Goal
from frictionlab.methods.periodic.follow import Attractor, DrivePeriods, Follower, closed_orbit, multiplier
from frictionlab.methods.periodic.period_map import map_kind, size_of
from frictionlab.methods.periodic.problem import LEAST_GAP, PeriodicProblem, Transient
from frictionlab.methods.periodic.setting import table_of_maps
from frictionlab.methods.prescribed.loop import PrescribedMean
from frictionlab.methods.prescribed.varying_slip import VaryingSlip
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.record import End, Orbit
from frictionlab.scene.body import BodyNumbers, Motion
from frictionlab.scene.scene import Scene
from frictionlab.scene.varying import Packed, of_one_sine, packed
from frictionlab.theory.rest import friction_at_rest, largest_spring_force
from frictionlab.values.quantities import EPSILON, Floats

PERIODS = 400
"""Largest number of periods for which a memory is followed plainly from each start."""
FINE, SAME_MEAN = 1e-9, 1e-6
"""Accuracy of maps with which starts are followed, over the normal load, and largest range of equal means."""
SLOW, FEW, FINEST_MAP = 1e-3, 4, 1e-13
"""Largest share of a deviation that a slow contact forgets in a period; for how many periods its mean is watched.

FINEST_MAP: accuracy of their maps, whose errors count by that share."""
ENDED = "ended here, with no memory and with that of steady sliding"
HOLDS = "a deflection keeps what it began with, for ever or for thousands of periods"
NO_END = "no steady state found: the memory does not repeat within {} periods"
STAYS_ELASTIC = "the slip stays within the elastic range of the contact"


class PrescribedPeriods(PeriodicProblem):
    """Period map of a memory under a slip that is prescribed."""

    def __init__(self, scene: Scene, law: BristleLaw | MemoryLaw, tolerance: float) -> None:
        self.mass: Any = scene.motion()
        self.law, self.kernel = law.under_load(self.mass.normal_load), answer_curve
        self.zero = 0.0 if scene.load_along_belt_only else 0j
        self.body = driven(self.mass, self.zero)
        self.common, self.undamped, self.gap = self.body.periods, True, LEAST_GAP
        self.maps = table_of_maps(self.law, self.body)
        self.goal = Goal(tolerance, False, False, False, MUCH_WORK)
        self.size = interpreted(size_of)(self.law, self.zero)
        self.kind = map_kind(self.law, isinstance(self.zero, complex))

    def deflected(self, deflection: float) -> Floats:
        """Return the state with a deflection along x1 in the middle of an oscillation."""
        bent, state = deflection - self.mass.velocity.real / self.mass.frequency, np.empty(self.size)
        KernelCall(write_start)(self.maps, (0j, 0j, complex(bent)), state)
        return state

    def carried(
        self, belt_speed: float, state: Floats, most: int, known: KnownOrbit | None = None
    ) -> Transient:
        """Follow a memory by fine maps: one that holds keeps their errors."""
        how = Follow(FINE * self.mass.normal_load, constant=False)
        return self._follow(belt_speed, state, most, how, known or unknown_orbit(self.size))

    @property
    def free_period(self) -> float:
        """Return 0: no free mass swings."""
        return 0.0


class MemoryPoint:
    """Scene of prescribed slip, law with memory, and the answer."""

    def __init__(self, scene: Scene, law: BristleLaw | MemoryLaw, tolerance: float) -> None:
        self.scene, self.problem = scene, PrescribedPeriods(scene, law, tolerance)
        self.law = cast("Any", self.problem.law)
        self.motion = self.problem.mass
        self.slip = None if scene.is_harmonic else VaryingSlip.of(scene.signals(), self.motion.normal_load)
        self.status: Status = "ok"
        self.reason, self.model = "", str(ModelWord.PRESCRIBED_MEMORY)
        self.error_kind, self.seconds = "estimated", 0.0
        self.state: Floats | None = None
        self.reached: list[Floats] = []
        self.tested = ""
        room = self._elastic_room()
        if self._fastest() == 0.0:
            self.found = self._left_open([], "no slip")
        elif room > 0.0:
            ends = abs(self.law.friction(0.0, room, 0.0))
            self.found = self._left_open([-ends, ends], STAYS_ELASTIC)
            if scene.load_along_belt_only:
                self.reached = [self.problem.deflected(each) for each in (-room, room, 0.0)]
        else:
            self.found = self._answer()

    def _fastest(self) -> float:
        """Return a bound on the speed of the slip."""
        parts = self.motion.velocity, self.motion.transverse_velocity
        sizes = map(abs, parts) if self.slip is None else (self.slip.along.size(), self.slip.across.size())
        return float(abs(self.scene.belt_speed) + sum(sizes))

    def _elastic_room(self) -> float:
        """Return the largest mean deflection along x1 of a bristle that never leaves its elastic range; else <= 0."""
        reach: float = self.law.elastic_deflection() if self.law.memory_kind == "bristle" else 0.0
        if self.scene.belt_speed != 0.0 or self.slip is not None or not 0.0 < reach < math.inf:
            return 0.0
        if self.scene.load_along_belt_only:
            return reach - abs(self.motion.velocity) / self.motion.frequency
        turn = np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 1441)) / self.motion.frequency
        path = (self.motion.velocity * turn).real + 1j * (self.motion.transverse_velocity * turn).real
        return largest_spring_force(path, np.full(len(path), reach))

    def _answer(self) -> PrescribedMean:
        problem, scene = self.problem, self.scene
        curve, seconds = problem.close([scene], np.zeros(problem.size), wanted=DIFFERENTIATED)
        found = closed_orbit(curve, curve.closed.mean) if curve.closed.found[0] else None
        follower = Follower(problem, scene, found, PERIODS)
        ends = list[Attractor]()
        for start in self._starts():
            ends.append(follower.led(start)[0])
            if ends[-1].curve is None and not ends[-1].neutral:
                break
        self.seconds = seconds + follower.seconds
        first, last = ends[0], ends[-1]
        if last.curve is None and not last.neutral:
            self.status, self.error_kind, self.reason = "failed", "", NO_END.format(last.followed)
            return PrescribedMean()
        mirrored = self._is_mirrored and abs(first.mean) > max(first.error, SAME_MEAN)
        if first.curve is None or mirrored or not all(first.agrees(one) for one in ends):
            return self._without_one(ends)
        curve, self.state = first.curve, first.points[0]
        self.tested = f"tested: {len(ends)} starts {ENDED}"
        closed = curve.closed
        if self._is_mirrored and self.law.memory_kind == "bristle":
            self.model, self.error_kind = str(ModelWord.SYMMETRY), "guaranteed"
            return PrescribedMean(0j, EPSILON * friction_at_rest(self.law))
        error = float(closed.error[0]) + self._still_to_go(self.state, 1.0 - multiplier(curve))
        return PrescribedMean(complex(closed.mean[0], closed.across[0]), error)

    def _still_to_go(self, state: Floats, gap: float) -> float:
        """Return how far the mean of a contact that forgets little in a period may still move, from its last moves.

        gap: share of a deviation that a period forgets. What maps tell of so slow an orbit is lost in rounding.
        """
        if gap > SLOW:
            return 0.0
        way = self.problem.followed_on(self.scene.belt_speed, state, FEW, FINEST_MAP)
        moved = abs(way.means[-1] - way.means[0]) / (FEW - 1)
        return 2.0 * float(moved + EPSILON * friction_at_rest(self.law)) / gap

    @property
    def _is_mirrored(self) -> bool:
        """Check that the mirror image of a state is a state half a period later."""
        return self.scene.belt_speed == 0.0 and self.slip is None and self.law.obeys("oddness")

    def _starts(self) -> list[Floats]:
        """Return memories to start from: those of steady sliding first, none last.

        On a belt at rest they are combined: a slider that never yields keeps the deflection it began with.
        """
        belt = self.scene.belt_speed
        speed = math.copysign(self._fastest(), belt)
        found = corners(self.problem.maps, self.law, self.problem.size, (0j, 0j), -speed)
        return found if belt == 0.0 and self.law.memory_kind != "scalars" else [found[0], found[-1]]

    def _without_one(self, ends: list[Attractor]) -> PrescribedMean:
        """Return the range of means of starts that end apart, or hold what they began with."""
        section = DrivePeriods(self.problem, self.scene)
        held = [section.held(one.points[-1]) if one.neutral else None for one in ends]
        pairs = list(zip(ends, held, strict=True))
        self.reached = [one.points[-1] if state is None else state.state for one, state in pairs]
        means = [
            each for one, state in pairs for each in ((one.low, one.high) if state is None else (state.mean,))
        ]
        means += [-mean for mean in means] if self._is_mirrored else []
        spread = max(means) - min(means)
        if spread > SAME_MEAN:
            return self._left_open(means, HOLDS)
        # closing may fail beside a corner of the map, to which starts far apart come all the same
        self.state, self.tested = self.reached[0], f"tested: {len(ends)} starts {ENDED}"
        follow, speed = self.problem.followed_on, self.scene.belt_speed
        fine, coarse = (follow(speed, self.state, 1, each).means[0] for each in (1e-11, FINE))
        return PrescribedMean(complex(fine), float(spread + 2.0 * abs(coarse - fine) + FINE))

    def _left_open(self, means: list[float], reason: str) -> PrescribedMean:
        self.status, self.error_kind = "not_unique", ""
        most = friction_at_rest(self.law)
        self.reason = f"{reason}: the mean depends on the start"
        low, high = (min(means), max(means)) if means else (-most, most)
        return PrescribedMean(low=low, high=high)

    def orbit(self) -> Orbit | None:
        """Return one period of the prescribed motion with its friction; None if the memory was not found."""
        return None if self.state is None else self._recorded(self.state)

    def ends(self) -> list[End]:
        """Return where starts ended, that from rest last, if the mean depends on the start."""
        reached = self.reached if self.status == "not_unique" else []
        return [End(self._recorded(state), self.problem.goal.tolerance) for state in reached]

    def _recorded(self, state: Floats) -> Orbit:
        found = self.problem.orbits([self.scene], [state]).one(0)
        assert found is not None
        return found if self.slip is None else self.slip.orbit(found.tau, found.friction)


def driven(motion: Motion, zero: complex) -> BodyNumbers:
    """Return a body whose motion is prescribed; its spring and dashpot only give the units of a state.

    A sine is the reference motion of the body. For any other slip the body stays at rest, and the belt moves
    with the opposite velocity.
    """
    omega, across, varying = motion.frequency, motion.transverse_velocity, _moved_belt(motion)
    share = 0.0 if motion.varying else 1.0 / omega
    sine = share * complex(motion.velocity.imag, across.imag)
    cosine = -share * complex(motion.velocity.real, across.real)
    parts: Any = (sine, cosine, 0j) if isinstance(zero, complex) else (sine.real, cosine.real, 0.0)
    return BodyNumbers(
        damping_mean=2.0,
        damping_split=0.0,
        stiffness_mean=1.0,
        stiffness_split=0.0,
        normal_load=motion.normal_load,
        frequency=omega,
        load_sine=parts[2],
        load_cosine=parts[2],
        balanced_sine=parts[2],
        balanced_cosine=parts[2],
        reference_sine=parts[0],
        reference_cosine=parts[1],
        periods=motion.varying.periods if motion.varying else 1.0,
        prescribed=True,
        varying=varying,
    )


def _moved_belt(motion: Motion) -> Packed:
    """Return what varies with the motion of the belt in place of that of the body; nothing for one sine."""
    moved = of_one_sine(0j, 0j, motion.frequency)
    if motion.varying:
        moved = motion.varying._replace(belt=motion.varying.belt.scaled(-1.0))
    return packed(moved, (0j, 0j), motion.frequency)
