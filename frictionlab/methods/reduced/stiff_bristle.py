"""Coulomb friction in the place of a stiff bristle, with what the deflection may change in the mean."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.reduced.rung import Rung
from frictionlab.methods.reduced.stiff_contact import CoulombOrbit, StiffContact, bound_each
from frictionlab.methods.shooting.saturated import Saturated
from frictionlab.orbit.record import Orbit
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.theory import friction_free_velocity
from frictionlab.theory.saturation import follows_the_way, lost_on_reversal

NO_ERRORS = "; motion and energies are those of Coulomb friction, without errors"
COULOMB_IS_OPEN = "the motion under Coulomb friction is open"


class StiffBristle(Rung):
    """Coulomb's motion for a bristle of one sliding friction, its error of the order of sqrt(presliding).

    Source of the error: methods/reduced/stiff_contact.py.
    """

    name: ClassVar[str] = Exact.name
    model: ClassVar[str] = "Coulomb friction for a stiff contact"
    left_out: ClassVar[str] = "the deflection of the contact"

    def takes(self, scene: Scene, law: FrictionLaw) -> bool:
        """Dahl, Jenkins, LuGre and elasto-plastic friction without a fall or viscosity, along one line."""
        if not (law.memory_kind == "bristle" and scene.degrees_of_freedom and scene.is_harmonic):
            return False
        alone = scene.degrees_of_freedom == 1 or law.damps_across(abs(scene.belt_speed))
        driven = not scene.undriven and scene.load_along_belt_only and scene.mass().damping > 0.0
        return alone and driven and law.constant_sliding_friction()

    def may_meet(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> bool:
        """By the steepest reversals that loads and friction could make; then by what the law loses on one."""
        free, speeds = friction_free_velocity(scenes[0]), np.abs(belt_speeds_of(scenes))
        bristle, normal_load = law.under_load(scenes[0].mass().normal_load), scenes[0].mass().normal_load
        mu, lasts = law.sliding_friction(1.0), 2.0 * math.pi / scenes[0].frequency

        def least_error(lost: float) -> float:
            if speeds.min() >= free:
                return 2.0 * mu * lost / ((free + speeds.max()) * lasts)
            steepest = free * scenes[0].frequency + 2.0 * mu * normal_load
            return 2.0 * mu * math.sqrt(lost / steepest) / lasts

        near = least_error(bristle.presliding()) <= tolerance  # a reversal loses as much or more
        return near and follows_the_way(bristle) and least_error(lost_on_reversal(bristle)) <= tolerance

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Coulomb's answers; refused where Coulomb's motion is not the only one."""
        contact, speeds = _contact(scenes[0], law), belt_speeds_of(scenes)
        found = Exact().solve(scenes, Saturated(mu=contact.coefficient), tolerance)
        assert found.orbits is not None
        orbits, left = found.orbits(), np.full(len(scenes), np.nan)
        seen = CoulombOrbit(orbits.tau, orbits.v, orbits.friction, orbits.stick)
        _, seconds = KernelCall(bound_each).timed(contact, seen, orbits.ends, speeds, left)
        known = np.isfinite(left) & (np.array(found.status) == "ok")
        own = np.zeros(len(scenes)) if found.seconds is None else found.seconds
        texts = [f"{self.model}: {text.partition('; ')[0]}{NO_ERRORS}" for text in found.model]

        def orbit(i: int) -> Orbit | None:
            one = orbits.one(i)
            return (
                None if one is None else replace(one, stick=None)
            )  # bristles move where Coulomb's mass rests

        return Answers(
            status=["ok" if each else "refused" for each in known],
            reason=[
                "" if each else f"{COULOMB_IS_OPEN}: {why}"
                for each, why in zip(known, found.reason, strict=True)
            ],
            model=[text if each else "" for each, text in zip(known, texts, strict=True)],
            error_kind=["estimated" if each else "" for each in known],
            mean=np.where(known, found.mean, np.nan),
            error=np.where(known, found.error + left, np.nan),
            period=found.period,
            seconds=own + seconds / len(scenes),
            orbit=orbit,
            balanced=False,
        )


def _contact(scene: Scene, law: Any) -> StiffContact:
    mass = scene.mass()
    bristle = law.under_load(mass.normal_load)
    mu, deflection = bristle.sliding_friction(1.0), bristle.largest_deflection()
    lag = bristle.friction(0.0, 0.0, 1.0) * deflection / mu
    return StiffContact(deflection, lost_on_reversal(bristle), lag, mu, mu * mass.normal_load, mass.damping)
