"""Test of several starts for the same steady state, where no theorem guarantees it."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Protocol

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import FoundState
from frictionlab.methods.periodic.follow import FEWEST, MOST, Attractor, Follower, multiplier
from frictionlab.methods.periodic.plateau import GOLDEN_SHARE
from frictionlab.methods.periodic.problem import PeriodicProblem, along_the_belt
from frictionlab.scene.body import one_harmonic_motions
from frictionlab.scene.scene import Initial, Scene
from frictionlab.theory.linear import velocity_scale
from frictionlab.theory.rest import friction_at_rest
from frictionlab.values.quantities import Floats

PLACES_ON_THE_BELT = 6
"""Number of starts at rest on the belt, at places along its travel in a period."""
UNREPEATED = 8
"""Number of starts followed if motions do not repeat.

So many starts miss a state that is reached from a third of all starts in 4 % of cases."""
ONE_BRANCH = 1e-3
"""Largest distance, over their size, at which orbits of neighbouring belt speeds count as one orbit.

Belt speed moves such an orbit."""
DECAYS, CLIMBS = 30.0, 2.0
"""Time constants after which nothing is left of a start, and distance that a belt carries a mass to its mean.

The distance is at most this multiple of the deflection of the spring under the friction force."""


@dataclass(frozen=True)
class Trial:
    """Starts that all ended in one state.

    starts: number of starts. apart [scene velocity]: largest distance between two of them, with a
    displacement counted by the energy of the spring. periods: smallest number of drive periods for which one
    was followed. carried: number of states of neighbouring belt speeds that were also followed, for as long
    as it took.
    """

    starts: int
    apart: float
    periods: int
    carried: int = 0

    @classmethod
    def of(
        cls, at: Sequence[tuple[complex, complex]], stiffness: float, periods: int, carried: int = 0
    ) -> Trial:
        """Return the trial of starts at these positions and velocities."""
        pairs = combinations(at, 2)
        apart = max(
            (math.sqrt(stiffness * abs(x - y) ** 2 + abs(v - u) ** 2) for (x, v), (y, u) in pairs),
            default=0.0,
        )
        return cls(len(at), apart, periods, carried)

    def sentence(self, multiplier: float) -> str:
        """Return the sentence for ``reason``.

        multiplier: largest multiplier of the state, whose decay is the slowest; NaN if unknown.
        """
        told = f"tested: {self.starts} starts up to {self.apart:.3g} apart"
        told += " and the states of neighbouring belt speeds" if self.carried else ""
        told = f"{told} ended here, the starts followed for {self.periods} periods"
        if math.isnan(multiplier):
            return f"{told} or more"
        constants = self.periods * -math.log(max(multiplier, 1e-300))
        return f"{told} or more, {max(constants, 0.0):.2g} of the slowest time constant"


def starts(scene: Scene, law: FrictionLaw) -> list[Initial | None]:
    """Return starts far apart: shaken freely, resting on the belt, flung against it, let go ahead of it.

    ``scene.initial`` comes first if it is given. If the belt would carry the mass, before it slips, for
    longer than a start is followed, the others start nearer to the place at which it slips. In the plane the
    last two move across the belt, too.
    """
    limit = scene.mass().normal_load * friction_at_rest(law)
    given: list[Initial | None] = [] if scene.initial is None else [scene.initial]
    belt, periods = scene.belt_speed, carried_for(scene, limit)
    side, way = math.copysign(1.0, belt), limit * (FEWEST / periods if periods > MOST else 1.0)
    last = side * (limit - way)
    shaken = None if way == limit else Initial(x=side * limit)
    flung = Initial(x=last - side * 2.0 * way, velocity=-side * (abs(belt) + way))
    ahead = Initial(x=side * (limit + force_swing(scene)))
    resting = Initial(x=last, velocity=belt)
    return [*given, shaken, resting, *moving_across(scene, law, [flung, ahead]), *_bent_starts(scene, limit)]


def _bent_starts(scene: Scene, limit: float) -> list[Initial]:
    """Return starts on motions of a nonlinear body that balance one harmonic; none for a linear body.

    The motions are those without friction and those with the largest friction.
    """
    mass = scene.mass()
    rubs = (0.0, 4.0 / math.pi * limit) if mass.bends else ()
    motions = [each for rub in rubs for each in one_harmonic_motions(mass, rub)]
    return [Initial(x=each.imag, velocity=mass.frequency * each.real) for each in motions]


def moving_across(scene: Scene, law: FrictionLaw, along: Sequence[Initial]) -> list[Initial]:
    """Return these starts, in the plane each with an additional motion across the belt.

    Its amplitude is the deflection that friction and load hold across the belt. Its phases are spread.
    """
    if along_the_belt(scene, law):
        return list(along)
    mass, signals = scene.mass(), scene.signals()
    load = max(map(abs, signals.load[1].extremes(signals.period)))
    width = (mass.normal_load * friction_at_rest(law) + load) / mass.transverse_stiffness
    pace = math.sqrt(mass.transverse_stiffness)
    # multiples of this share, less whole numbers, are spread evenly however many there are
    across = [cmath.rect(width, 2.0 * math.pi * GOLDEN_SHARE * k) for k in range(1, len(along) + 1)]
    return [
        one.model_copy(update={"x2": one.x2 + each.real, "velocity2": one.velocity2 + pace * each.imag})
        for one, each in zip(along, across, strict=True)
    ]


def carried_for(scene: Scene, limit: float) -> float:
    """Return the number of periods in which the belt carries a mass over both deflections of its spring.

    These are the deflections under the force ``limit`` that holds the mass, in either direction. Return 0 on
    a belt at rest.
    """
    mass = scene.mass()
    way = abs(scene.belt_speed) * 2.0 * math.pi / mass.frequency * scene.periods
    return CLIMBS * limit / mass.stiffness / way if way > 0.0 else 0.0


def resting_starts(scene: Scene, law: FrictionLaw, count: int = PLACES_ON_THE_BELT) -> list[Initial]:
    """Return starts at rest on the belt, along its travel in the period before slip begins.

    A mass that rests on the belt at some time begins to slip at one phase of the drive. All masses that begin
    to slip at the same phase move alike from there on. These starts begin to slip at phases spread over the
    period; in the plane friction holds them in directions that are spread, too.
    """
    mass, signals, belt = scene.mass(), scene.signals(), scene.belt_speed
    velocity, velocity2 = belt + float(signals.belt[0](0.0)), float(signals.belt[1](0.0))
    side, period = math.copysign(1.0, belt), 2.0 * math.pi / mass.frequency * scene.periods
    limit, planar = mass.normal_load * friction_at_rest(law), not along_the_belt(scene, law)
    load, load2 = (float(each(0.0)) for each in signals.load)
    places = []
    for k in range(count):
        held = cmath.rect(limit, math.pi * (GOLDEN_SHARE * (k + 1) % 1.0 - 0.5) if planar else 0.0)
        last = (load - mass.damping * velocity + side * held.real) / mass.stiffness
        longest = 2.0 * held.real / mass.stiffness
        way = min(abs(belt) * period, longest) if belt != 0.0 else longest
        x2 = (load2 - mass.transverse_damping * velocity2 + held.imag) / mass.transverse_stiffness
        aside = {"x2": x2, "velocity2": velocity2} if planar else {}
        places.append(Initial(x=last - side * way * (k + 0.5) / count, velocity=velocity, **aside))
    return places


def thrown_starts(problem: PeriodicProblem, scene: Scene) -> list[Initial]:
    """Return starts thrown off sliding that never reverses, in all directions of position and velocity.

    They are thrown by half and by all of the swing of the loads (``force_swing``).
    """
    x, v = _sliding_on(problem, scene)
    turns, swing = [math.pi * (k + 0.5) / 2.0 for k in range(4)], force_swing(scene)
    thrown = [cmath.rect(share * swing, turn) for share in (0.5, 1.0) for turn in turns]
    along = [
        Initial(x=x.real + each.real, velocity=v.real + each.imag, x2=x.imag, velocity2=v.imag)
        for each in thrown
    ]
    return moving_across(scene, problem.law, along)


def _sliding_on(problem: PeriodicProblem, scene: Scene) -> tuple[complex, complex]:
    """Return position and velocity of the friction-free motion about steady sliding.

    It is a steady state if its slip never reverses.
    """
    (x, v), law = problem.place(scene.belt_speed, None), problem.law
    if law.count() == 0:  # for laws with memory this place already includes the shift by friction
        shift = problem.mass.normal_load * law.sliding_friction(abs(scene.belt_speed))
        x += math.copysign(shift, scene.belt_speed)
    return x, v


def force_swing(scene: Scene) -> float:
    """Return the static deflection under the load along the belt, or the swing of a free mass if larger.

    At undamped resonance, where the swing of a free mass is unbounded, it is the static deflection.
    """
    signals, frequency = scene.signals(), scene.frequency
    largest = max(map(abs, signals.load[0].extremes(signals.period)))
    shaken = velocity_scale(scene) / frequency
    return max(largest, shaken) if math.isfinite(shaken) else largest


def quick_starts(problem: PeriodicProblem, belt_speed: float) -> list[tuple[complex, complex]]:
    """Return position and velocity of the two starts that are followed while a curve is closed.

    These are at rest on the belt, and sliding as if slip never reversed.
    """
    return [(0.0, belt_speed), problem.place(belt_speed, None)]


def follow_all(problem: PeriodicProblem, scene: Scene, candidate: Attractor | None) -> FollowedStarts:
    """Follow starts to their destinations. The candidate is an orbit already known.

    More starts follow the first ones as long as all of them reach one closed orbit, or if motions that do not
    repeat leave open what other starts reach. If there are such motions the candidate itself is one of the
    starts.
    """
    followed = FollowedStarts(problem, scene, candidate)
    first, more = all_starts(problem, scene)
    for start in first:
        # motions of too many steps have no mean; others are followed until there are two such motions
        if followed.slow < 2:
            followed.follow(start)
    for start in more:
        if not followed.one_state_so_far() or followed.slow > 1:
            break
        followed.follow(start)
    wild = any(one.curve is None and not one.stopped for one in followed.ended)
    if candidate is not None and wild and not any(one.agrees(candidate) for one in followed.ended):
        followed.carry(candidate.points[-1])  # an orbit that attracts, which no start happened to reach
    return followed


def all_starts(
    problem: PeriodicProblem, scene: Scene, more: int = 0
) -> tuple[list[Initial | None], list[Initial]]:
    """Return the starts that are always followed, and those that are followed if the first ones agree.

    more: number of further starts at rest on the belt.
    """
    law, (x, v) = problem.law, _sliding_on(problem, scene)
    # for laws with memory the start None is this one, with the memory of sliding
    smooth = None if law.count() else Initial(x=x.real, velocity=v.real, x2=x.imag, velocity2=v.imag)
    first = starts(scene, law)
    others = [*resting_starts(scene, law), *thrown_starts(problem, scene)]
    return [*first, *([] if smooth in first else [smooth])], [*others, *resting_starts(scene, law, more)]


class FollowedStarts(Follower):
    """Starts at one belt speed, and their destinations."""

    def __init__(self, problem: PeriodicProblem, scene: Scene, candidate: Attractor | None) -> None:
        super().__init__(problem, scene, candidate, _patience(scene, problem.law, candidate))
        self.reached: list[Attractor] = []
        self._starts: list[Initial | None] = []
        self._lengths: list[int] = []

    @property
    def ended(self) -> list[Attractor]:
        """Destinations of starts that were not stopped on the way; of all starts if all were stopped."""
        return [one for one in self.reached if not one.stopped] or self.reached

    @property
    def slow(self) -> int:
        """Number of starts that were stopped after too many steps."""
        return sum(one.stopped and not one.lost for one in self.reached)

    def one_state_so_far(self) -> bool:
        """Check whether all starts that were not stopped ended on one closed orbit, or may still do so.

        They may if some do not repeat and fewer than ``UNREPEATED`` were followed.
        """
        repeating = [one for one in self.ended if one.curve is not None]
        alike = all(repeating[0].agrees(other) for other in repeating[1:])
        return alike and (len(repeating) == len(self.ended) or len(self.reached) < UNREPEATED)

    @property
    def trial(self) -> Trial:
        """Record of the starts if all of them ended in one state."""
        at = [self._problem.place(self._scene.belt_speed, start) for start in self._starts]
        carried = len(self.reached) - len(at)
        fewest = min(
            (each for each in self._lengths if each > 1), default=MOST
        )  # one starts on the orbit itself
        return Trial.of(at, self._problem.mass.stiffness, fewest, carried)

    def follow(self, start: Initial | None) -> None:
        """Follow a start to its end, or until it is sure to end on the first known orbit of one period."""
        self._starts.append(start)
        self._lengths.append(self.carry(self._problem.state_at(self._scene.belt_speed, start)))

    def carry(self, state: Floats) -> int:
        """Follow a state in the same way, for example one of another belt speed.

        Return the number of periods for which it was followed.
        """
        end, periods = self.led(state)
        self.reached.append(end)
        return periods

    def lead_to(self, ends: dict[int, Attractor]) -> None:
        """Replace destinations in ``reached``, by place, by those that longer following has found."""
        self.reached = [ends.get(place, one) for place, one in enumerate(self.reached)]
        left = [one for one in self.known if one.curve is not None]
        for one in ends.values():
            if not any(one.agrees(each) for each in left):
                left.append(one)
        self.known = left

    def carry_on(self, one: Attractor) -> bool:
        """Follow a state of another belt speed, unless its orbit is known here, moved by belt speed.

        Return whether it was followed.
        """
        if one.period == 1 and one.curve is not None and self._has_beside(one.points[-1]):
            return False
        self.carry(one.points[-1])
        return True

    def _has_beside(self, state: Floats) -> bool:
        orbits = [one.points[0] for one in self.known if one.period == 1 and one.curve is not None]
        return any(np.linalg.norm(state - one) <= ONE_BRANCH * np.linalg.norm(one) for one in orbits)


def _patience(scene: Scene, law: FrictionLaw, candidate: Attractor | None) -> int:
    """Return the periods after which every start is at the candidate, if the candidate attracts them all.

    This is the longest of three times: that in which dashpots end a motion, that in which the belt carries
    the mass to the mean friction, and that in which the candidate attracts it.
    """
    mass = scene.mass()
    period = 2.0 * math.pi / mass.frequency
    weakest = mass.damping if scene.load_along_belt_only else min(mass.damping, mass.transverse_damping)
    own = 2.0 * DECAYS / (weakest * period) if weakest > 0.0 else MOST
    own = max(own, carried_for(scene, mass.normal_load * friction_at_rest(law)))
    if candidate is None or candidate.curve is None:
        return int(min(max(5 * FEWEST, own), MOST))
    rate = max(-math.log(max(multiplier(candidate.curve), 1e-3)), 1e-9)
    return int(min(max(FEWEST, own, 2.0 * DECAYS / rate), MOST))


def same_state(one: Attractor, other: Attractor) -> bool:
    """Check whether two states are the same.

    Two motions that never repeat count as the same if the mean of one is unknown.
    """
    unknown = one.period == other.period == 0 and math.isnan(one.mean + other.mean)
    return one is other or one.agrees(other) or unknown


def found_state(
    problem: PeriodicProblem, place: int, state: Attractor, ended: Sequence[Attractor], found_from: str = ""
) -> FoundState:
    """Return a state as a table holds it. ended: destinations of all starts."""
    x, velocity = problem.positions(state.points)
    numbers = state.mean, state.error, state.low, state.high
    share = sum(same_state(state, one) for one in ended) / len(ended)
    return FoundState(place, round(state.period * problem.common), *numbers, x, velocity, found_from, share)


class Destination(Protocol):
    """Destination of a start.

    period: drive periods after which the motion repeats; 0 if it never does. mean: mean over them; NaN for a
    motion that never repeats and was not followed for long.
    """

    @property
    def period(self) -> int: ...
    @property
    def mean(self) -> float: ...
    @property
    def low(self) -> float: ...
    @property
    def high(self) -> float: ...
    @property
    def followed(self) -> int: ...


def describe(reached: Sequence[Destination], digits: int = 9) -> str:
    """Write a sentence on the steady states that several starts reached; digits: digits of their means."""
    parts = [_describe_state(one, digits) for one in _different(reached)]
    wild = [one.followed for one in reached if math.isnan(one.mean)]
    if wild:
        parts.append(f"{len(wild)} of {len(reached)} starts do not repeat within {max(wild)} drive periods")
    return "; ".join(parts)


def _different(reached: Sequence[Destination]) -> list[Destination]:
    """Return the destinations with a mean, each state once.

    A longer orbit with the mean of a shorter one counts as that one, repeated.
    """
    found: list[Destination] = []
    for one in sorted((each for each in reached if not math.isnan(each.mean)), key=lambda each: each.period):
        if not any(_repeats(one, other) for other in found):
            found.append(one)
    return sorted(found, key=list(reached).index)


def _repeats(one: Destination, other: Destination) -> bool:
    whole = one.period % other.period == 0 if other.period else one.period == 0
    return whole and f"{one.mean:.6g}" == f"{other.mean:.6g}"


def left_unfinished(reached: Sequence[Attractor]) -> str:
    """Write a sentence on the starts that were stopped; '' if none was."""
    stopped, lost = [one.followed for one in reached if one.stopped], sum(one.lost for one in reached)
    if lost:
        return f"{lost} of {len(reached)} starts run away: far out the spring along the belt pushes outward"
    if not stopped:
        return ""
    starts, periods = f"{len(stopped)} of {len(reached)} starts", max(stopped)
    if min(stopped) >= FEWEST:
        return f"{starts} had not ended after {periods} drive periods"
    steep = "that took hundreds of thousands of steps, for friction near rest is steep"
    return f"{starts} were followed for {periods} drive periods only: {steep}"


def _describe_state(orbit: Destination, digits: int) -> str:
    if orbit.period == 0:
        return f"a motion that does not repeat has a mean of {orbit.mean:.6g} over {orbit.followed} drive periods"
    if orbit.period == 1:
        return f"an orbit of one drive period has a mean of {orbit.mean:.{digits}g}"
    if f"{orbit.low:.6g}" == f"{orbit.high:.6g}":
        return f"an orbit of {orbit.period} drive periods has a mean of {orbit.mean:.{digits}g} over each"
    return (
        f"an orbit of {orbit.period} drive periods has means over one from {orbit.low:.6g} to {orbit.high:.6g}, "
        f"{orbit.mean:.{digits}g} over all"
    )
