"""One curve's way to closed orbits: its scenes as kernels see them, and the kernels called on them."""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from typing import Any, NamedTuple, Self

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.interpret import interpreted
from frictionlab.compile.lane_arrays import takes_lanes
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.periodic.attraction import (
    Follow,
    KnownOrbit,
    Trail,
    iterate_until_periodic,
    settle,
    unknown_orbit,
    write_start,
)
from frictionlab.methods.periodic.continuation import (
    CLOSED,
    DIFFERENTIATED,
    MAPPED,
    MULTIPLIERS,
    RECORDED,
    Curve,
    Wanted,
    answer_curve,
    recorded_accuracy,
)
from frictionlab.methods.periodic.fixed_point import LITTLE_WORK, MUCH_WORK, UTMOST_WORK, Goal
from frictionlab.methods.periodic.lane_curve import CLOSED_ORBIT, answer_lanes
from frictionlab.methods.periodic.lane_record import differentiate_in_lanes, record_in_lanes
from frictionlab.methods.periodic.near_rest import answer_near_rest
from frictionlab.methods.periodic.period_map import (
    MAP_KINDS,
    map_kind,
    size_of,
    size_of_deviation,
    unpack,
)
from frictionlab.methods.periodic.setting import table_of_maps
from frictionlab.methods.periodic.steady_sliding import memory_of_sliding, state_of_sliding
from frictionlab.motion.equation import runs_away, swing_of
from frictionlab.motion.orbit.record import Orbits
from frictionlab.motion.orbit.recorder import WEIGHTS, Track, track_of
from frictionlab.scene.body import BodyNumbers, Mass, in_the_plane, on_the_line
from frictionlab.scene.scene import Initial, Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.scene.signals import Signal
from frictionlab.scene.varying import FASTEST, FREE_VELOCITY, FREE_X
from frictionlab.theory.linear import friction_free_response, velocity_scale
from frictionlab.theory.rest import falls_slower_than_dashpots, falls_slowly, is_convergent, resonates_once
from frictionlab.theory.sliding_stability import SHORT, slides_saturated
from frictionlab.values.quantities import Floats


def along_the_belt(scene: Scene, law: FrictionLaw) -> bool:
    """Check whether the motion is on a line: nothing pushes across the belt, and what moves across it dies out.

    A law damps motion across the slip up to some speed: here the largest that the loads could drive.
    """
    if scene.degrees_of_freedom < 2 or not scene.load_along_belt_only:
        return scene.load_along_belt_only
    mass = scene.mass()
    swing = abs(mass.force) / mass.damping if mass.damping > 0.0 else math.inf  # at resonance
    if not scene.is_harmonic:
        # a dashpot alone answers no load with more than 4/pi of what it does at resonance to the largest sine
        signals = scene.signals()
        load, belt = (_largest(each[0], signals.period) for each in (signals.load, signals.belt))
        swing = (4.0 / math.pi * load / mass.damping if mass.damping > 0.0 else math.inf) + belt
    return law.obeys("reflection") and law.damps_across(abs(scene.belt_speed) + swing)


def undamped(scene: Scene) -> bool:
    """Check whether a free oscillation, along the belt or across it, has no dashpot."""
    mass = scene.mass()
    damps = mass.damping > 0.0 or (
        mass.bends and (mass.bends.dashpot_1 != 0.0 or mass.bends.dashpot_2 != 0.0)
    )
    return not damps or (scene.transverse is not None and mass.transverse_damping == 0.0)


def _least_gap(mass: Mass, common: float) -> float:
    """Return the least difference to one of a multiplier that shows attraction: less than usual if dashpots do less.

    Multipliers of laws with memory are quotients, which do not tell less than the usual.
    """
    weakest = min(mass.damping, mass.transverse_damping or mass.damping)
    lost = -math.expm1(-math.pi * weakest / mass.frequency * common)
    return min(LEAST_GAP, 0.3 * lost) if lost > 0.0 else LEAST_GAP


def _with_free_state(scene: Scene, law: Any, body: BodyNumbers) -> BodyNumbers:
    """Return a body that several waves drive along the line, with its motion without friction.

    Bristles that near their limit exponentially do without: maps close their orbits, too.
    """
    if law.rate(1.0, (1.0 - SHORT) * law.largest_deflection()) > 0.1 * SHORT:
        return body
    free = friction_free_response(scene, None, 0)
    if free is None:
        return body
    x, v = (float(value[0]) for value in free[0].at(np.zeros(1), np.zeros(1, np.int64)))
    fastest = max(velocity_scale(scene.model_copy(update={"belt_speed": way})) for way in (1.0, -1.0))
    table = body.varying.table.copy()
    table[[FASTEST, FREE_X, FREE_VELOCITY]] = fastest, x, v
    return body._replace(varying=body.varying._replace(table=table))


def _largest(signal: Signal, period: float) -> float:
    """Its largest size."""
    return max(map(abs, signal.extremes(period)))


class Transient(NamedTuple):
    """A motion followed until it repeats: after how many periods of all that changes in time (0: never, ARRIVED: it
    ends on the orbit that is known), its one-period means, the states at the end of each [n, size], its end."""

    period: int
    means: Floats
    states: Floats
    state: Floats
    seconds: float
    steps: int = 0

    def then(self, later: Transient) -> Transient:
        """Join the motion that goes on from the end of this one."""
        means, states = np.concatenate([self.means, later.means]), np.concatenate([self.states, later.states])
        return Transient(
            later.period, means, states, later.state, self.seconds + later.seconds, self.steps + later.steps
        )


LEAST_GAP = 1e-7
"""Least difference to one of the Floquet multipliers of an orbit that counts as attractive."""
FEWEST_IN_LANES = 4
"""Points of a curve; fewer are answered one by one."""
SHIFT = 1e-5
"""Largest offset of difference quotients, over the size of a state."""
FINEST = 1e-15
"""No orbit is asked to be closed to less: rounding moves the mean more, and steps would go on for ever."""


class PeriodicProblem:
    """Kernels of shooting for scenes that differ in belt speed alone; on the line where nothing pushes across.

    tolerance: on the mean friction.
    """

    def __init__(self, scene: Scene, law: FrictionLaw, tolerance: float) -> None:
        self.mass, self.law = scene.mass(), law
        self.kernel: Any = answer_curve
        self.falls_slowly = falls_slowly(scene, law)
        check_attraction = law.count() > 0 and self.falls_slowly
        if self.mass.bends and falls_slower_than_dashpots(scene, law):
            check_attraction = resonates_once(scene, law)
        self.body: BodyNumbers
        self.zero: complex  # a number of the kind of its positions
        if along_the_belt(scene, law):
            self.body, self.zero = on_the_line(self.mass), 0.0
        else:
            self.body, self.zero = in_the_plane(self.mass), 0j
        # after how many periods of the drive everything repeats
        self.common = float(scene.periods)
        self.undamped = undamped(scene)
        self.gap = _least_gap(self.mass, self.common) if law.count() == 0 else LEAST_GAP
        self.body = self.body._replace(periods=self.common)
        constant = (
            not (self.mass.bends or isinstance(self.zero, complex))
            and scene.signals().normal_load == Signal()
            and slides_saturated(law)
        )
        if constant and self.mass.varying:
            self.body = _with_free_state(scene, law, self.body)
        self.maps = table_of_maps(law, self.body)
        contracts, planar = is_convergent(scene, law), isinstance(self.zero, complex)
        # in the plane other searches follow; where one orbit attracts all motions it is there to be found
        work = MUCH_WORK if not contracts else LITTLE_WORK if planar else UTMOST_WORK
        self.goal = Goal(max(tolerance, FINEST), contracts, check_attraction, constant, work)
        self.size = interpreted(size_of)(law, self.zero)  # of a state
        self.kind = map_kind(law, isinstance(self.zero, complex))
        self._slides: dict[float, tuple[complex, complex]] = {}  # places, by the friction that shifts them

    @property
    def free_period(self) -> float:
        """Period of the free mass, over that after which everything repeats."""
        return self.mass.frequency / math.sqrt(self.mass.stiffness) / self.common

    @property
    def by_implicit_steps(self) -> Self | None:
        """Same problem solved next to rest: a sliding law's in the plane whose motions converge; else None."""
        if not (isinstance(self.zero, complex) and self.goal.contracts) or self.mass.varying:
            return None
        other = copy.copy(self)
        other.kernel = answer_near_rest
        return other

    @property
    def swing(self) -> float:
        """Return the speed of the friction-free response."""
        return float(interpreted(swing_of)(self.body))

    def close(
        self,
        scenes: Sequence[Scene],
        state: Floats | None = None,
        periods: float = 1.0,
        wanted: Wanted = DIFFERENTIATED,
    ) -> tuple[Curve, float]:
        """Return the orbits of these scenes, from a known state at the first where there is one; and kernel time [s].

        periods: of everything that changes in time, in one orbit.
        """
        if state is None and wanted == CLOSED and self.in_lanes(len(scenes)):
            return self._close_in_lanes(belt_speeds_of(scenes), periods)
        guess = np.empty((0, 0)) if state is None else state[None, :]
        work = UTMOST_WORK if self.goal.contracts else MUCH_WORK
        goal = self.goal if state is None else self.goal._replace(check_attraction=False, work=work)
        return self.called(belt_speeds_of(scenes), guess, goal, wanted, periods)

    def in_lanes(self, points: int) -> bool:
        """Check whether eight are solved at once: converging motions in the plane, without memory, under loads of one
        sine, of a curve that has more than a few points."""
        planar = isinstance(self.zero, complex) and self.kernel is answer_curve and not self.mass.varying
        return points >= FEWEST_IN_LANES and planar and self.goal.contracts and takes_lanes(self.law)

    @property
    def body_in_lanes(self) -> BodyNumbers:
        """Return the body without a table: one sine is all that lanes know."""
        return self.body._replace(varying=())

    def _close_in_lanes(self, speeds: Floats, periods: float) -> tuple[Curve, float]:
        """Return the orbits at these belt speeds; those that lanes leave by the search for one."""
        body = self.body_in_lanes._replace(periods=float(periods))
        found, seconds = KernelCall(answer_lanes, self.law).timed(body, speeds, self.goal)
        left = np.flatnonzero(found.fate != CLOSED_ORBIT).tolist()
        if left:
            rest, more = self.called(speeds[left], np.empty((0, 0)), self.goal, CLOSED, periods)
            found.states[left], found.results[left] = rest.states, rest.results
            seconds += more
        n, size = found.states.shape
        nothing = np.zeros(n, np.int64), interpreted(track_of)(0), np.zeros(n, np.int64)
        return Curve(found.states, found.results, np.empty((0, size, size)), *nothing), seconds

    def called(
        self, belt_speeds: Floats, states: Floats, goal: Goal, wanted: Wanted, periods: float = 1.0
    ) -> tuple[Curve, float]:
        """Return what is wanted of the orbits at these belt speeds, and kernel time [s]."""
        span, told = periods * self.common, (belt_speeds, states, goal, wanted)
        if self.kernel is answer_curve:
            return KernelCall(answer_curve).timed(self.maps, span, *told)
        return KernelCall(self.kernel, self.law).timed(self.body._replace(periods=span), *told)

    def orbits(self, scenes: Sequence[Scene], states: Sequence[Floats | None], periods: int = 1) -> Orbits:
        """Return the motions from these states, one for each scene; without panels where there is no state.

        periods: of everything that changes in time, in each.
        """
        places, known = self._known(states)
        if periods > 1 or not self.in_lanes(len(places)):
            return self._recorded(places, scenes, known, periods)
        accuracy = interpreted(recorded_accuracy)(self.body.normal_load, self.goal)
        call = KernelCall(record_in_lanes, self.law)
        track, ends = call(self.body_in_lanes, belt_speeds_of(scenes)[places], known, accuracy)
        found = _orbits_at(places, track, ends, len(scenes))
        left = np.diff(ends, prepend=0) == 0
        others = [i for i, is_left in zip(places, left, strict=True) if is_left]
        return found.and_those_of(self._recorded(others, scenes, known[left])) if others else found

    def _recorded(
        self, places: list[int], scenes: Sequence[Scene], states: Floats, periods: int = 1
    ) -> Orbits:
        """Return the orbits of the scenes at these places, one by one."""
        curve, _ = self.called(belt_speeds_of(scenes)[places], states, self.goal, RECORDED, periods)
        return _orbits_at(places, curve.orbits, curve.ends, len(scenes))

    def multipliers(self, scenes: Sequence[Scene], states: Sequence[Floats | None]) -> Floats:
        """Return the largest modulus of the Floquet multipliers of these orbits; NaN where there is no state."""
        places, known = self._known(states)
        found = np.full(len(scenes), np.nan)
        if self.in_lanes(len(places)):
            call = KernelCall(differentiate_in_lanes, self.law)
            matrices = call(self.body_in_lanes, belt_speeds_of(scenes)[places], known)
            regular = ~np.isnan(matrices).any(axis=(1, 2))
            found[np.array(places)[regular]] = largest_modulus(matrices[regular])
            places, known = [i for i in places if math.isnan(found[i])], known[~regular]
        if places:
            curve, _ = self.called(belt_speeds_of(scenes)[places], known, self.goal, MULTIPLIERS)
            found[places] = largest_modulus(curve.matrices)
        return found

    def _known(self, states: Sequence[Floats | None]) -> tuple[list[int], Floats]:
        places = [i for i, state in enumerate(states) if state is not None]
        return places, np.array([states[i] for i in places]).reshape(len(places), self.size)

    def settle(self, start: Initial) -> tuple[Floats, int]:
        """State at which the mass stays put on a belt at rest, and in how many periods; negative for never."""
        accuracy = 1e-13 * self.mass.normal_load
        return KernelCall(settle)(self.maps, self.common, *self.place(0.0, start), accuracy)

    def state_at(self, belt_speed: float, start: Initial | None) -> Floats:
        """Return the state of a start (None: on the friction-free orbit)."""
        # on the friction-free orbit it remembers as in sliding that never reverses
        z = -memory_of_sliding(self.law, belt_speed) if start is None else 0.0
        state = np.empty(self.size)
        KernelCall(write_start)(self.maps, (*self.place(belt_speed, start), complex(z)), state)
        return state

    def carried(
        self, belt_speed: float, state: Floats, most: int, known: KnownOrbit | None = None
    ) -> Transient:
        """Return the motion from a state, that of another belt speed for one, for so many periods at most.

        known: an orbit that attracts; a motion that is sure to end there is followed no farther.
        """
        how = Follow(MAP_KINDS[self.kind].rough * self.mass.normal_load, self.goal.constant)
        return self._follow(belt_speed, state, most, how, known or unknown_orbit(self.size))

    def positions(self, states: Floats) -> tuple[Floats, Floats]:
        """Position and velocity along x1 of states at the start of a period."""
        sine, cosine = complex(self.body.reference_sine), complex(self.body.reference_cosine)
        pairs = [interpreted(unpack)(self.body, state, self.zero) for state in states]
        x = np.array([complex(y).real for y, _ in pairs]) + cosine.real
        return x, np.array([complex(u).real for _, u in pairs]) + self.body.frequency * sine.real

    def runs_away(self, state: Floats) -> bool:
        """Check whether a mass in this state never comes back."""
        x, _velocity = interpreted(unpack)(self.body, state, self.zero)
        return bool(interpreted(runs_away)(self.body, x))

    def place(self, belt_speed: float, start: Initial | None) -> tuple[complex, complex]:
        """Position and velocity of a start; on the friction-free orbit, with memory, shifted as in sliding on."""
        if start is not None:
            return complex(start.x, start.x2), complex(start.velocity, start.velocity2)
        friction = self.law.sliding_friction(abs(belt_speed)) if self.law.count() > 0 else 0.0
        friction = math.copysign(friction, belt_speed)
        if friction not in self._slides:
            x, v, _z = interpreted(state_of_sliding)(self.body, friction, self.zero)
            self._slides[friction] = complex(x), complex(v)
        return self._slides[friction]

    def repeated(self, belt_speed: float, state: Floats, periods: int) -> Transient:
        """An orbit of so many periods, from its state."""
        return self.followed_on(belt_speed, state, periods, 1e-9)

    def followed_on(self, belt_speed: float, state: Floats, periods: int, accuracy: float) -> Transient:
        """Return the motion from a state for so many periods, each by itself; fewer where they take too many steps.

        accuracy: of their maps, over the normal load.
        """
        how = Follow(accuracy * self.mass.normal_load, constant=False, whole=True)
        return self._follow(belt_speed, state, periods, how, unknown_orbit(self.size))

    def mapped(self, belt_speeds: Floats, states: Floats) -> Floats:
        """Follow states [n, size], each at its belt speed, until all that changes in time has repeated once.

        By fine maps: as close as differences of them need.
        """
        curve, _ = self.called(belt_speeds, states.copy(), self.goal, MAPPED)
        return np.asarray(curve.states)

    def derivative(self, belt_speed: float, state: Floats) -> Floats:
        """Return the derivative of that map at a state [size, size], by central differences of fine maps.

        Shifts are below the way the belt moves in a period, on which the pattern of events hangs.
        """
        usual = SHIFT * float(interpreted(size_of_deviation)(self.mass.normal_load, state))
        way = abs(belt_speed) * 2.0 * math.pi / self.mass.frequency
        shift, n = min(usual, max(0.01 * way, 1e-3 * usual)), self.size
        starts = np.concatenate([state + shift * np.eye(n), state - shift * np.eye(n)])
        ends = self.mapped(np.full(2 * n, belt_speed), starts)
        return np.asarray((ends[:n] - ends[n:]).T / (2.0 * shift))

    def repeated_once(self, scene: Scene, states: Floats) -> tuple[Floats, Floats]:
        """Return states [n, size] after all that changes in time has repeated once, and the mean friction along x1
        meanwhile [n], of motions as fine as the tolerance asks."""
        scenes = [scene] * len(states)
        ends = self.mapped(belt_speeds_of(scenes), states)
        found, means = self._recorded(list(range(len(states))), scenes, states), np.full(len(states), np.nan)
        for i in range(len(states)):
            orbit = found.one(i)
            if orbit is not None:
                lengths = orbit.tau[:, -1] - orbit.tau[:, 0]
                means[i] = -0.5 * (lengths * (orbit.friction.real @ WEIGHTS)).sum() / lengths.sum()
        return ends, means

    def _follow(
        self, belt_speed: float, state: Floats, most: int, how: Follow, known: KnownOrbit
    ) -> Transient:
        means, states = np.empty(most), np.empty((most + 1, self.size))
        states[0] = state
        arguments = float(belt_speed), self.common, how, known, Trail(means, states)
        (period, count, steps), seconds = KernelCall(iterate_until_periodic).timed(self.maps, *arguments)
        return Transient(period, means[:count], states[1 : count + 1], states[count], seconds, steps)


def largest_modulus(matrices: Floats) -> Floats:
    """Return the largest modulus of each matrix's eigenvalues; NaN of one that holds numbers that are not finite."""
    found = np.full(len(matrices), np.nan)
    known = np.isfinite(matrices).all(axis=(1, 2))
    found[known] = np.abs(np.linalg.eigvals(matrices[known])).max(axis=1)
    return found


def _orbits_at(places: list[int], track: Track, ends: Any, n: int) -> Orbits:
    """Return the orbits of a track as those of the scenes at these places, of n."""
    panels, filled = np.zeros(n, np.int64), int(ends[-1]) if len(ends) else 0
    panels[places] = np.diff(ends, prepend=0)
    parts = track.tau[:filled], track.x[:filled], track.v[:filled], track.friction[:filled]
    return Orbits(*parts, track.stick[:filled], np.cumsum(panels))
