"""Bristles whose one deflection follows the slip's direction: slip never reverses for them, and they end saturated.

Where they do (theory/sliding_stability.py), friction is that of sliding, set-valued at rest: where it is the same at
every speed, that of Coulomb, and the steady state is the one of a law without memory.

Licence (12 scenes, curves of four belt speeds): 28 times faster in the median than
the period map of mass and bristle in the plane at 1e-6 (19 to 45 times), 33 times at 1e-9 (26 to 39).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from frictionlab.laws.base import FrictionLaw, Positive, SlidingLaw
from frictionlab.methods.base import Answers, Multipliers
from frictionlab.methods.shooting.driven import solve_driven
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.read import read_columns
from frictionlab.scene.scene import Scene
from frictionlab.theory.rest import is_unique_in_slip
from frictionlab.theory.sliding_stability import remaining_share, saturates
from frictionlab.values.quantities import Floats

HELD = "the belt is at rest and static friction balances the loads: the mass may rest anywhere in a range"


class Saturated(SlidingLaw):
    """The friction of bristles whose deflection stays at its limit.

    mu [-], > 0: the law's sliding friction.
    """

    mu: Positive

    def sliding_friction(self, speed: float) -> float:
        """The same at every speed."""
        return self.mu

    def constant_sliding_friction(self) -> bool:
        """Always."""
        return True

    def monotone(self) -> bool:
        """Always."""
        return True


def saturates_in_the_plane(scene: Scene, law: FrictionLaw) -> bool:
    """Whether bristles end at their limit, moved by the length of the way slid, with one friction at every speed."""
    return scene.degrees_of_freedom == 2 and not scene.constant_contact and saturates(law)


def solve_saturated(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """The steady states of sliding friction, with the multiplier of the deflection that is left out.

    On a belt at rest that can hold the mass, where it stops hangs on how far bristles have grown on the way: no start
    chooses.
    """
    mu = law.sliding_friction(1.0)
    free = [scene.model_copy(update={"initial": None, "dimensional": None}) for scene in scenes]
    found = solve_driven(free, Saturated(mu=mu), tolerance)

    def floquet() -> Floats:
        heat = read_columns(free, found.orbit, found.orbits)["energy_contact"]
        way = heat / (scenes[0].mass().normal_load * mu)
        own = np.full(len(way), np.nan) if found.floquet is None else found.floquet()
        return np.asarray(np.maximum(own, remaining_share(law, way)))

    def multipliers() -> Multipliers:
        known = floquet()
        error = np.full(len(known), np.nan) if found.multipliers is None else found.multipliers().error
        return Multipliers(known, error, [""] * len(known))

    reasons = [
        HELD if status == "not_unique" and scene.belt_speed == 0.0 else reason
        for status, reason, scene in zip(found.status, found.reason, scenes, strict=True)
    ]
    models = [f"{model}; {ModelWord.SATURATED}" for model in found.model]
    # The theorem then holds for friction that becomes this, too.
    unique = found.unique if is_unique_in_slip(free[0], Saturated(mu=mu)) else None
    return replace(
        found, reason=reasons, model=models, floquet=floquet, multipliers=multipliers, unique=unique
    )
