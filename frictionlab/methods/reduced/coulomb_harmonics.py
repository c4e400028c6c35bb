"""Harmonic balance of a mass on Coulomb friction along a line in two harmonics or more: answers and errors.

Most motions reverse their slip twice a period: those of all belt speeds are found together (balanced_reversals.py).
Where such a motion would slip against its friction, the mass rests on the belt or reverses more often. With the tail,
which lets a mass rest, those are found one by one from the legs of the exact motion (balanced_rests.py). A slip of H
harmonics and nothing else cannot rest: it crosses zero again and again instead, and is refused.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers
from frictionlab.methods.exact.method import REDUCED, Exact
from frictionlab.methods.reduced.balanced_motion import BalancedMotion, orbit_of
from frictionlab.methods.reduced.balanced_rests import (
    BalancedLegs,
    Force,
    FreeMassLine,
    LegStarts,
    balanced_legs,
    force_on,
    free_mass_line,
)
from frictionlab.methods.reduced.balanced_reversals import DrivenLine, balanced_reversals
from frictionlab.methods.reduced.common import (
    Modelled,
    far_from_full,
    judged,
    line_refusal,
    point_refusal,
)
from frictionlab.methods.reduced.full_mean import TOLERANCE
from frictionlab.methods.reduced.switch_response import harmonic_impedances, switch_response
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.theory import friction_free_velocity

BALANCED = (
    "{harmonics} harmonics of x1' and of Coulomb friction balanced on its exact switching angles; {beyond}"
)
TAIL = "beyond them the mass as a free one, in closed form"
PLAIN = "those beyond left out"
CROSSES_AGAIN = (
    "the slip of {harmonics} harmonics crosses zero more than twice a period: it cannot rest on the belt; give "
    "tail: true, or use exact"
)
NOT_FOUND = (
    "no motion of {harmonics} harmonics found near the legs of slip and rest that exact finds; use exact"
)
DRIVEN_BY_FRICTION = "{name}: without damping, harmonic {order} of friction drives the mass without bound"


class Balancing(NamedTuple):
    """What is balanced: a scene's mass and law, in so many harmonics, with the tail or without."""

    scene: Scene
    mu: float
    harmonics: int
    tail: bool

    @property
    def friction(self) -> float:
        """Of sliding [K_1 L]."""
        return self.mu * self.scene.mass().normal_load

    def driven_line(self) -> DrivenLine:
        """For motions of two reversals."""
        response = switch_response(self.scene.mass(), self.harmonics, self.tail)
        return DrivenLine(response, self.friction, friction_free_velocity(self.scene))

    def free_mass_line(self) -> FreeMassLine:
        """For motions of any legs."""
        free = friction_free_velocity(self.scene)
        return free_mass_line(self.scene.mass(), self.harmonics, self.friction, free)

    def lead(self) -> float:
        """The phase of the friction-free velocity at tau = 0 [rad]."""
        mass = self.scene.mass()
        return float(np.angle(mass.force) - np.angle(harmonic_impedances(mass, 1)[0]))


class Balanced(NamedTuple):
    """Motions at belt speeds >= 0: their means relative to mu, NaN without one.

    half, middle: of forward slip, where it reverses twice. rests: of other motions that reverse, by their places.
    """

    mean: Floats
    half: Floats
    middle: Floats
    rests: dict[int, BalancedLegs]


def coulomb_refusal(name: str, scene: Scene, law: FrictionLaw, harmonics: int) -> str | None:
    """Why H harmonics cannot do this scene and law at any belt speed; None if they can."""
    reason = line_refusal(name, scene, law)
    if reason is not None:
        return reason
    resonant = np.flatnonzero(harmonic_impedances(scene.mass(), harmonics) == 0.0)
    return DRIVEN_BY_FRICTION.format(name=name, order=resonant[0] + 1) if len(resonant) else None


def coulomb_means(scenes: Sequence[Scene], law: FrictionLaw, harmonics: int, tail: bool) -> Floats:
    """The mean friction of the model alone; NaN where there is none."""
    mu, speeds = law.sliding_friction(1.0), belt_speeds_of(scenes)
    found = balanced(Balancing(scenes[0], mu, harmonics, tail), law, np.abs(speeds))
    return mu * np.copysign(1.0, speeds) * found.mean


def answer_coulomb(
    scenes: Sequence[Scene], law: FrictionLaw, tolerance: float, harmonics: int, tail: bool
) -> Answers:
    """Answers on scenes that differ in belt speed alone."""
    start = time.perf_counter()
    mu, speeds = law.sliding_friction(1.0), belt_speeds_of(scenes)
    what = Balancing(scenes[0], mu, harmonics, tail)
    found = balanced(what, law, np.abs(speeds))
    means = mu * np.copysign(1.0, speeds) * found.mean
    left_out = far_from_full(scenes, law, means, np.where(np.isnan(means), "no mean", "").tolist())
    without = (NOT_FOUND if tail else CROSSES_AGAIN).format(harmonics=harmonics)
    reasons = [
        point_refusal(scene, what.friction) or (without if math.isnan(mean) else other)
        for scene, mean, other in zip(scenes, found.mean.tolist(), left_out.reasons, strict=True)
    ]
    text = BALANCED.format(harmonics=harmonics, beyond=TAIL if tail else PLAIN)
    text += REDUCED if scenes[0].degrees_of_freedom == 2 else ""

    def orbit(i: int) -> Orbit:
        motion = _motion(what, found, i, abs(float(speeds[i])))
        position = scenes[i].mass().normal_load * float(means[i])
        side = math.copysign(1.0, speeds[i])
        return orbit_of(motion, what.lead(), side, mu, position)

    return judged(
        Modelled(means, left_out.error, time.perf_counter() - start), reasons, text, tolerance, orbit
    )


def balanced(what: Balancing, law: FrictionLaw, speeds: Floats) -> Balanced:
    """Motions at belt speeds >= 0."""
    line = what.driven_line()
    mean, half, middle = np.full((3, len(speeds)), np.nan)
    reverses = speeds < line.friction_free
    mean[~reverses] = 1.0
    if reverses.any():
        half[reverses], middle[reverses], settled = balanced_reversals(line, speeds[reverses])
        half[reverses] = np.where(settled, half[reverses], np.nan)
        mean[reverses] = 1.0 - 2.0 / math.pi * half[reverses]
    found = Balanced(mean, half, middle, {})
    others = np.flatnonzero(np.isnan(mean))
    if what.tail and len(others):
        _add_rests(what, law, speeds, others, found)
    return found


def _add_rests(
    what: Balancing, law: FrictionLaw, speeds: Floats, places: NDArray[np.int64], found: Balanced
) -> None:
    """Motions that rest or reverse often, from the legs that exact finds."""
    scenes = [what.scene.model_copy(update={"belt_speed": speed}) for speed in speeds[places].tolist()]
    full = Exact().solve(scenes, law, TOLERANCE * what.mu)
    line, lead = what.free_mass_line(), what.lead()
    for k, place in enumerate(places.tolist()):
        orbit = full.orbit(k)
        if full.status[k] != "ok" or orbit is None:
            continue
        legs = balanced_legs(line, _legs(orbit, what.scene.frequency, lead), float(speeds[place]))
        if legs is not None:
            found.rests[place] = legs
            found.mean[place] = -legs.force.friction[0].real


def _legs(orbit: Orbit, frequency: float, lead: float) -> LegStarts:
    """The legs of an orbit of Coulomb friction along the belt."""
    assert orbit.stick is not None
    kinds = np.where(orbit.stick, 0, np.sign(orbit.friction[:, 1].real)).astype(np.int64)
    begins = kinds != np.roll(kinds, 1)
    return LegStarts(frequency * orbit.tau[begins, 0] + lead, kinds[begins])


def _motion(what: Balancing, found: Balanced, i: int, speed: float) -> BalancedMotion:
    """The motion at a belt speed >= 0."""
    line, frequency = what.free_mass_line(), what.scene.frequency
    if i in found.rests:
        legs, force = found.rests[i]
        return BalancedMotion(legs, force, line.friction, line.friction, frequency, speed, 0.0)
    if math.isnan(found.half[i]):
        legs, slip = LegStarts(np.zeros(1), np.array([-1])), -speed
    else:
        ends = found.middle[i] - found.half[i], found.middle[i] + found.half[i]
        legs, slip = LegStarts(np.array(ends), np.array([1, -1])), 0.0
    force = force_on(line, legs)
    if what.tail:
        return BalancedMotion(legs, force, line.friction, line.friction, frequency, speed, slip)
    # No harmonics but these: the mass falls under no others.
    all_of_it = Force(force.coefficients - line.friction * force.friction, force.friction)
    return BalancedMotion(legs, all_of_it, 0.0, line.friction, frequency, speed, slip)
