"""Harmonic balance of a mass on Coulomb friction along the belt in two harmonics or more, on its switching angles.

Most motions reverse their slip twice a period: those of all belt speeds are found together (reversals.py). Where
such a motion would slip against its friction, the mass rests on the belt or reverses more often. With the tail, which
lets a mass rest, those are found one by one from the legs of the exact motion (legs.py). A slip of H harmonics and
nothing else cannot rest: it crosses zero again and again instead, and is refused.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.reduced.common import TOLERANCE, Modelled, line_reasons, line_refusal
from frictionlab.methods.reduced.legs import LegStarts, SwitchedLine, balanced_legs, force_on, holds, orbit_of
from frictionlab.methods.reduced.reversals import (
    DrivenLine,
    harmonic_impedances,
    response_of_harmonics,
    reversals_at,
)
from frictionlab.methods.words import ModelWord
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.theory import friction_free_velocity

CROSSES_AGAIN = (
    "the slip of {harmonics} harmonics crosses zero more than twice a period: it cannot rest on the belt; give "
    "tail: true, or use exact"
)
NOT_FOUND = (
    "no motion of {harmonics} harmonics found near the legs of slip and rest that exact finds; use exact"
)
_SAME = 1e-9
"""Distance of the belt speed of a motion from the one asked for, relative to V_lin."""


class Switched(NamedTuple):
    """Motions at belt speeds >= 0: their means relative to mu, NaN without one, and their legs."""

    mean: Floats
    legs: list[LegStarts | None]


def switched_refusal(name: str, scene: Scene, law: FrictionLaw, harmonics: int) -> str | None:
    """Why H harmonics cannot do this scene and law at any belt speed; None if they can."""
    reason = line_refusal(name, scene, law)
    if reason is not None:
        return reason
    resonant = 1 + np.flatnonzero(harmonic_impedances(scene.mass(), harmonics) == 0.0)
    if len(resonant):
        return f"{name}: without damping, harmonic {resonant[0]} of friction drives the mass without bound"
    return None


def switched(scenes: Sequence[Scene], law: FrictionLaw, harmonics: int, tail: bool) -> Modelled:
    """The motions of H harmonics of scenes that differ in belt speed alone."""
    mu, speeds, mass = law.sliding_friction(1.0), belt_speeds_of(scenes), scenes[0].mass()
    friction, free = mu * mass.normal_load, friction_free_velocity(scenes[0])
    line = SwitchedLine.of(mass, harmonics, friction, free, tail)
    found = switched_motions(scenes[0], law, line, np.abs(speeds))
    mean = mu * np.copysign(1.0, speeds) * found.mean
    without = (NOT_FOUND if tail else CROSSES_AGAIN).format(harmonics=harmonics)
    reasons = line_reasons(scenes[0], friction, speeds, mean, without)

    def orbit(i: int) -> Orbit | None:
        legs, side = found.legs[i], math.copysign(1.0, speeds[i])
        if legs is None:
            return None
        one = orbit_of(line, legs, abs(float(speeds[i])), _lead(scenes[0]))
        # On a belt that runs backward the same motion the other way, half a period later.
        tau = one.tau - (0.0 if side > 0.0 else math.pi / mass.frequency)
        x = side * one.x + mass.normal_load * mean[i]
        return replace(one, tau=tau, x=x, v=side * one.v, friction=mu * side * one.friction)

    beyond = ModelWord.TAIL if tail else ModelWord.NO_TAIL
    return Modelled(mean, reasons, f"{harmonics} {ModelWord.SWITCHED}; {beyond}", orbit)


def switched_motions(scene: Scene, law: FrictionLaw, line: SwitchedLine, speeds: Floats) -> Switched:
    """Those of a scene at belt speeds >= 0."""
    never = LegStarts(np.zeros(1), np.array([-1]))
    found = Switched(np.ones(len(speeds)), [never for _ in speeds])
    reverses = np.flatnonzero(speeds < line.friction_free)
    if not len(reverses):
        return found
    response = response_of_harmonics(scene.mass(), len(line.compliances) - 1, line.tail)
    two = reversals_at(DrivenLine(response, line.friction, line.friction_free), speeds[reverses])
    same = np.abs(two.belt_speed - speeds[reverses]) <= _SAME * line.friction_free
    ends = np.where(same, two.middle, 0.0)[:, None] + two.half[:, None] * np.array([-1.0, 1.0])
    slips = LegStarts(ends, np.array([1, -1]))
    same &= holds(line, slips, force_on(line, slips))
    found.mean[reverses] = np.where(same, 1.0 - 2.0 / math.pi * two.half, np.nan)
    for place, settled, row in zip(reverses.tolist(), same, ends, strict=True):
        found.legs[place] = LegStarts(row, slips.kinds) if settled else None
    if line.tail and not same.all():
        _add_rests(scene, law, line, speeds, found)
    return found


def _add_rests(scene: Scene, law: FrictionLaw, line: SwitchedLine, speeds: Floats, found: Switched) -> None:
    """Motions that rest or reverse often, from the legs that exact finds."""
    places = [place for place, legs in enumerate(found.legs) if legs is None]
    scenes = [scene.model_copy(update={"belt_speed": float(speeds[place])}) for place in places]
    full = Exact().solve(scenes, law, TOLERANCE * law.sliding_friction(1.0))
    for k, place in enumerate(places):
        orbit = full.orbit(k) if full.status[k] == "ok" else None
        if orbit is not None:
            legs = balanced_legs(line, _legs_of(orbit, scene), float(speeds[place]))
            if legs is not None:
                found.legs[place] = legs
                found.mean[place] = -force_on(line, legs).friction[0].real


def _legs_of(orbit: Orbit, scene: Scene) -> LegStarts:
    """The legs of an orbit of Coulomb friction along the belt."""
    assert orbit.stick is not None
    kinds = np.where(orbit.stick, 0, np.sign(orbit.friction[:, 1].real)).astype(np.int64)
    begins = kinds != np.roll(kinds, 1)
    return LegStarts(scene.frequency * orbit.tau[begins, 0] + _lead(scene), kinds[begins])


def _lead(scene: Scene) -> float:
    """The phase of the friction-free velocity at tau = 0 [rad]."""
    mass = scene.mass()
    return float(np.angle(mass.force) - np.angle(harmonic_impedances(mass, 1)[0]))
