"""What an undriven mass on a moving belt does in the long run: steady sliding, stick-slip, or a cycle of slip.

The motion is followed from scene.initial. Once rest on the belt has ended, the orbit is known: slip always begins
at the one deflection at which the spring overcomes static friction. A cycle without rest is a fixed point of the
map from one largest deflection to the next. The period is an unknown of both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import inner
from frictionlab.compile.interpret import interpreted
from frictionlab.dynamics.motion import (
    Instant,
    acceleration,
    belt_velocity,
    holding_force,
    mean_friction,
    normal_load,
    slip,
)
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers, Status
from frictionlab.methods.periodic.case import case_of
from frictionlab.methods.periodic.continuation import record_orbit
from frictionlab.methods.periodic.fixed_point import FINER, ROUNDING, UTMOST_WORK
from frictionlab.methods.periodic.maps.sliding import Mapped, sliding_map
from frictionlab.methods.periodic.period_map import pack, size_of
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.methods.shooting.undriven_memory import UndrivenMemory
from frictionlab.methods.shooting.undriven_motion import (
    COMES_TO_REST,
    SLIDES,
    SLIDES_FREELY,
    TURN,
    Effort,
    Follower,
    NotFound,
    PeriodicMotion,
)
from frictionlab.methods.shooting.undriven_path import follow_undriven
from frictionlab.orbit.record import Orbit
from frictionlab.orbit.recorder import Track, track_of
from frictionlab.scene.body import Body, Mass, on_the_line
from frictionlab.scene.scene import Scene
from frictionlab.theory.rest import friction_at_rest

PIECE = 1.0 / 32.0
"""Of a turn: how far the motion is followed between looks at it."""
MOST_PIECES = 200_000
WORK_OF_A_PIECE = 3
"""What following one costs beside its steps [steps]."""
ANY_INSTANT = Instant(0.0, 0.0, 1.0)
"""Nothing shakes the mass: what acts on it is the same at every instant."""


@inner
def flow(law: Any, body: Body, belt_speed: float, x: float, v: float, accuracy: float) -> Mapped:
    """The motion from x, v over the span of the body."""
    return sliding_map(case_of(law, body, belt_speed), x, v, accuracy, track_of(0))


@inner
def record_flow(law: Any, body: Body, belt_speed: float, x: float, v: float, accuracy: float) -> Track:
    """The motion from x, v over the span of the body, piece by piece."""
    z = np.empty(size_of(law, x))
    pack(body, z, x, v)
    return record_orbit(case_of(law, body, belt_speed), z, accuracy, track_of(128))


def solve_undriven(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """Answer undriven scenes, each by the state it reaches from its start."""
    numbers = np.full((5, len(scenes)), np.nan)
    mean, error, period, multipliers, seconds = numbers
    status: list[Status] = ["failed"] * len(scenes)
    reason, model, kind = [""] * len(scenes), [""] * len(scenes), [""] * len(scenes)
    found: dict[int, tuple[Follower, PeriodicMotion]] = {}
    for i, scene in enumerate(scenes):
        following: type[_Undriven | UndrivenMemory] = UndrivenMemory if law.count() > 0 else _Undriven
        undriven: Follower = following(scene, law, tolerance)
        try:
            motion = undriven.motion()
        except NotFound as problem:
            reason[i] = str(problem)
            continue
        finally:
            seconds[i] = undriven.effort.seconds
        found[i] = undriven, motion
        status[i], model[i], kind[i] = "ok", f"undriven: {motion.kind}", "estimated"
        mean[i], error[i] = motion.mean, motion.error
        period[i], multipliers[i] = motion.period / TURN, motion.multiplier
        if not motion.error <= tolerance:
            reason[i] = f"the error is above the tolerance {tolerance:.1e}"
    return Answers(
        status=status,
        reason=reason,
        model=model,
        error_kind=kind,
        mean=mean,
        error=error,
        period=period,
        floquet=lambda: multipliers,
        seconds=seconds,
        orbit=lambda i: found[i][0].orbit(found[i][1]) if i in found else None,
    )


@dataclass(frozen=True)
class _Undriven:
    """An undriven scene and a law, followed through time."""

    scene: Scene
    law: FrictionLaw
    tolerance: float
    effort: Effort = field(default_factory=Effort)

    @cached_property
    def _mass(self) -> Mass:
        return self.scene.mass()

    @cached_property
    def _body(self) -> Body:
        return on_the_line(self._mass)

    @cached_property
    def _speed(self) -> float:
        """Of the belt."""
        return interpreted(belt_velocity)(self._body, self.scene.belt_speed, ANY_INSTANT)

    @cached_property
    def _pressed(self) -> float:
        """The normal load."""
        return interpreted(normal_load)(self._body, ANY_INSTANT)

    @cached_property
    def _kernel(self) -> KernelCall:
        return KernelCall(flow, self.law)

    @property
    def _accuracy(self) -> float:
        return max(0.1 * self.tolerance * self._mass.normal_load, 1e-13)

    @property
    def _of_a_step(self) -> float:
        """What one step of the finer motion may cost the mean: two step sizes may agree by chance."""
        return self._accuracy / FINER / self._mass.normal_load + 1e-12

    def motion(self) -> PeriodicMotion:
        """The motion reached from the start. Raises NotFound."""
        if self._speed == 0.0:
            return self._at_rest()
        x, v, peaks = self.scene.start.x, self.scene.start.velocity, 0
        for count in range(MOST_PIECES):
            image = self._follow(x, v, PIECE, self._accuracy)
            # Judged at every peak, and now and then between: a motion without peaks may be overdamped.
            look = v > 0.0 >= image.u or count % 32 == 31
            ended = self._ended(x, v, peaks) if look else None
            rests = image.stuck > 0.0 and ended is None
            # From the end of rest the motion is one and the same, whatever came before.
            if rests:
                ended = self._stick_slip()
            if ended is not None:
                return ended
            peaks += 1 if v > 0.0 >= image.u else 0
            # the belt carries what rests to where slip begins
            x, v = (self._release, self._speed) if rests else (image.y, image.u)
            self.effort.turns = count * PIECE
        raise NotFound(f"no steady state within {MOST_PIECES * PIECE:.0f} periods of the free mass")

    def _follow(self, x: float, v: float, turns: float, accuracy: float) -> Mapped:
        body = self._body._replace(periods=turns)
        image: Mapped
        image, seconds = self._kernel.timed(body, self.scene.belt_speed, x, v, accuracy)
        self.effort.seconds += seconds
        self.effort.work += WORK_OF_A_PIECE + image.steps
        if image.steps < 0 or self.effort.work > UTMOST_WORK:
            raise NotFound(
                f"no steady state within {UTMOST_WORK:,} steps: after {self.effort.turns:.3g} periods of "
                f"the free mass it is at x = {x:.6g} with velocity {v:.6g}"
            )
        return image

    def _force(self, x: float, v: float) -> float:
        """Acceleration of a mass that slips."""
        w = interpreted(slip)(self._body, self.scene.belt_speed, ANY_INSTANT, v)
        friction = math.copysign(self.law.sliding_friction(abs(w)), w)
        return interpreted(acceleration)(self._body, ANY_INSTANT, x, v, friction)

    # --- the ends ---

    def _ended(self, x: float, v: float, peaks: int) -> PeriodicMotion | None:
        """The steady motion that this one is sure to become; now and then, near a peak, the cycle next to it."""
        reach = math.hypot(x - self._deflection(), v)
        # Slip never reverses within this energy.
        if self._conserves() and reach <= abs(self._speed):
            return self._free(x, v)
        if self._settles(x, v):
            return self._sliding()
        # The search for a cycle is costly: one peak in twenty starts it.
        if peaks % 20 == 19 and v > 0.0:
            return self._slip_cycle(self._peak(x, v, PIECE, self._accuracy)[0])
        return None

    def _conserves(self) -> bool:
        """Whether a slip that never reverses keeps the energy of the oscillation."""
        return self._mass.damping == 0.0 and self.law.constant_sliding_friction()

    def _free(self, x: float, v: float) -> PeriodicMotion:
        mean = math.copysign(self.law.sliding_friction(1.0), self._speed)
        return PeriodicMotion(np.array([x, v]), TURN, mean, ROUNDING, 1.0, SLIDES_FREELY)

    def _at_rest(self) -> PeriodicMotion:
        state, periods = PeriodicProblem(self.scene, self.law, self.tolerance).settle(self.scene.start)
        if periods < 0:
            raise NotFound(f"the mass still creeps towards rest after {-periods} periods of the free mass")
        mean = state[0] / self._pressed
        error = 1e-11 * periods + ROUNDING
        return PeriodicMotion(np.array([state[0], 0.0]), math.nan, mean, error, math.nan, COMES_TO_REST)

    def _deflection(self) -> float:
        """Of the spring in steady sliding."""
        drag = self._pressed * self.law.sliding_friction(abs(self._speed))
        return math.copysign(drag / self._mass.stiffness, self._speed)

    def _settles(self, x: float, v: float) -> bool:
        """Whether every motion with no more energy than this one loses it, down to steady sliding.

        It does where no slip velocity within its reach makes friction differ from that of steady sliding in the
        direction of the motion by more than damping takes. Slip that has turned round, and rest where it holds by
        no more than that, lose energy by themselves.
        """
        reach = math.hypot(x - self._deflection(), v)
        speed = abs(self._speed)
        slowest = max(speed - reach, 0.0)
        # Where the range is small against the speed the slopes are those of a millionth of it.
        speeds = np.concatenate((np.linspace(slowest, speed + reach, 129), speed * _NEAR))
        speeds = speeds[np.abs(speeds - speed) >= 0.9e-6 * speed]
        friction = np.array([self._largest_friction(float(each)) for each in speeds])
        chords = (friction - self.law.sliding_friction(speed)) / (speeds - speed)
        return bool((self._pressed * chords).min() > -self._mass.damping + 1e-9)

    def _largest_friction(self, speed: float) -> float:
        """Of slip at this speed, zero included."""
        return self.law.sliding_friction(speed) if speed > 0.0 else friction_at_rest(self.law)

    def _sliding(self) -> PeriodicMotion:
        speed = self._speed
        mean = math.copysign(self.law.sliding_friction(abs(speed)), speed)
        still = np.array([self._deflection(), 0.0])
        return PeriodicMotion(still, math.nan, mean, ROUNDING, math.nan, SLIDES)

    @property
    def _release(self) -> float:
        """The deflection at which rest ends."""
        unstretched, _rate, _bend = interpreted(holding_force)(
            self._body, self.scene.belt_speed, ANY_INSTANT, 0.0
        )
        limit = self._pressed * friction_at_rest(self.law)
        return (math.copysign(limit, self._speed) + unstretched) / self._mass.stiffness

    def _stick_slip(self) -> PeriodicMotion | None:
        """From the end of rest to the next; None where the mass does not come to rest again."""
        x, speed = self._release, self._speed
        if self._conserves() and self.law.monotone():
            return self._free(x, speed)
        if self._settles(x, speed):
            return self._sliding()
        # Twice, the second time much finer: the difference is the error.
        rough, fine = (self._cycle_from(x, part * self._accuracy) for part in (1.0, 1.0 / FINER))
        if rough is None or fine is None:
            return None
        error = 2.0 * abs(fine[1] - rough[1]) + self._of_a_step
        kind = "stick-slip, from the end of one stick phase to the next"
        return PeriodicMotion(np.array([x, speed]), fine[0], fine[1], error, 0.0, kind)

    def _cycle_from(self, x: float, accuracy: float) -> tuple[float, float] | None:
        """Period and mean friction from release at x to the next; None where the mass does not come to rest.

        A way that has gone around once without rest is caught within itself, and will not meet rest any more.
        """
        speed, y, v, turns, peaks = self._speed, x, self._speed, 0.0, 0
        patience = 10.0 * (1.0 + self._mass.damping)  # for one damped too heavily to have peaks
        while peaks < 3 and turns < patience:
            image = self._follow(y, v, PIECE, accuracy)
            turns += PIECE
            # At rest again: the belt carries the mass on to where slip began.
            if turns > PIECE and image.stuck > 0.0:
                period = turns * TURN + (x - image.y) / speed
                whole = self._follow(x, speed, period / TURN, accuracy)
                return period, interpreted(mean_friction)(whole.rubbed, period)
            peaks += 1 if v > 0.0 >= image.u else 0
            y, v = image.y, image.u
        return None

    def _slip_cycle(self, x: float) -> PeriodicMotion | None:
        """A cycle that never rests, by Newton's method on the map from peak to peak; None where there is none."""
        for _ in range(12):
            step = 1e-5 * (1.0 + abs(x))
            (here, _), (ahead, _), (behind, _) = (
                self._next_peak(x + shift, 1e-13) for shift in (0.0, step, -step)
            )
            # Newton on the map from peak to peak; a slope of one, where cycles are born, is kept away from.
            slope = (ahead - behind) / (2.0 * step)
            change = (here - x) / max(1.0 - slope, 1e-6)
            x += change
            if abs(change) < 1e-11 * (1.0 + abs(x)):
                break
        else:
            return None
        # Steady sliding is a fixed point of this map, too; and a cycle that repels is none to end on.
        if abs(x - self._deflection()) < 1e-7 or abs(slope) >= 1.0:
            return None
        return self._slip_motion(x, slope)

    def _slip_motion(self, x: float, slope: float) -> PeriodicMotion:
        (fine, period), (rough, _) = self._next_peak(x, 1e-13), self._next_peak(x, self._accuracy)
        means = [
            interpreted(mean_friction)(self._follow(x, 0.0, period / TURN, accuracy).rubbed, period)
            for accuracy in (1e-13, self._accuracy)
        ]
        error = (
            2.0 * abs(means[1] - means[0]) + 2.0 * abs(fine - rough) / (1.0 - abs(slope)) + self._of_a_step
        )
        kind = "a cycle of slip without rest"
        return PeriodicMotion(np.array([x, 0.0]), period, means[0], error, abs(slope), kind)

    def _next_peak(self, x: float, accuracy: float) -> tuple[float, float]:
        """The next largest deflection after one at x, and the time it takes. Raises NotFound."""
        y, v, turns = x, 0.0, 0.0
        for count in range(round(1e3 / PIECE)):
            image = self._follow(y, v, PIECE, accuracy)
            if count > 0 and v > 0.0 >= image.u:
                place, time_left = self._peak(y, v, PIECE, accuracy)
                return place, turns * TURN + time_left
            y, v, turns = image.y, image.u, turns + PIECE
        raise NotFound("the motion has no period")

    def _peak(self, x: float, v: float, turns: float, accuracy: float) -> tuple[float, float]:
        """Where and when, within these turns, the velocity falls through zero."""
        low, high, force = 0.0, turns * TURN, self._force(x, v)
        # Nothing slows a mass down that starts where steady sliding is: look from the middle.
        at = 0.0 if v <= 0.0 else min(high, -v / force) if force < 0.0 else 0.5 * high
        for _ in range(60):
            image = self._follow(x, v, at / TURN, accuracy)
            # Newton's method, kept inside the bracket of the zero of the velocity.
            low, high = (at, high) if image.u > 0.0 else (low, at)
            force = self._force(image.y, image.u)
            new = at - image.u / force if force != 0.0 else 0.5 * (low + high)
            new = new if low <= new <= high else 0.5 * (low + high)
            if abs(new - at) <= 1e-15 * TURN or low == high:
                break
            at = new
        return image.y, at

    def orbit(self, motion: PeriodicMotion) -> Orbit:
        """The orbit of the motion; of one that stands still, over 2 pi."""
        turns = motion.period / TURN if math.isfinite(motion.period) else 1.0
        body = self._body._replace(periods=turns)
        speed, accuracy = self.scene.belt_speed, self._accuracy / FINER
        track = KernelCall(record_flow, self.law)(body, speed, *motion.state.tolist(), accuracy)
        parts = track.tau, track.x, track.v, track.friction, track.stick
        return Orbit(*(part[: track.filled[0]] for part in parts))


_NEAR = np.array([1.0 - 1e-6, 1.0 + 1e-6])


def undriven_kernels(law: FrictionLaw) -> list[tuple[Any, FrictionLaw | None]] | None:
    """The kernels that solve undriven scenes; None where that is not known beforehand."""
    known = {"none": (flow, record_flow), "bristle": (follow_undriven,)}
    kernels = known.get(law.memory_kind)
    return None if kernels is None else [(kernel, law) for kernel in kernels]
