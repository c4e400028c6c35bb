"""Bristles whose one deflection follows the slip's direction: slip never reverses for them, and they end saturated.

The deflection z of a ``rotated`` law in the plane moves with |v|: wherever the way slid has no end it grows until it
stays at its limit. Friction is then sliding friction along the slip, set-valued at rest: where it is the same at
every speed, that of Coulomb, and the steady state is the one of a law without memory.

Licence (tests/benchmarks/specialists.py, 12 scenes, curves of four belt speeds): 28 times faster in the median than
the period map of mass and bristle in the plane at 1e-6 (19 to 45 times), 33 times at 1e-9 (26 to 39).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from frictionlab.laws.base import Positive, SlidingLaw
from frictionlab.laws.memory import ROTATED, BristleLaw
from frictionlab.methods.base import Answers
from frictionlab.orbit.read import read_columns
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene

Solver = Callable[[Sequence[Scene], SlidingLaw, float], Answers]

SATURATED = "the one deflection along the slip stays at its limit: friction is that of sliding"
HELD = "the belt is at rest and static friction balances the loads: the mass may rest anywhere in a range"
SHORT = 1e-7
"""Share of the limit that a deflection lacks where its approach is told."""


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


def saturates(scene: Scene, law: BristleLaw) -> bool:
    """Whether bristles end at their limit, moved by the length of the way slid, with one friction at every speed."""
    if law.form != ROTATED or scene.degrees_of_freedom < 2 or not law.constant_sliding_friction():
        return False
    limit, friction = law.largest_deflection(), law.sliding_friction(1.0)
    short = (1.0 - SHORT) * limit
    return (
        math.isfinite(limit)
        and math.isclose(law.friction(1.0, limit, 0.0), friction, rel_tol=1e-9)
        and math.isclose(law.rate(2.0, short), 2.0 * law.rate(1.0, short), rel_tol=1e-9)
    )


def solve_saturated(solve: Solver, scenes: Sequence[Scene], law: BristleLaw, tolerance: float) -> Answers:
    """The steady states of sliding friction, with the multiplier of the deflection that is left out.

    On a belt at rest that can hold the mass, where it stops hangs on how far bristles have grown on the way: no start
    chooses.
    """
    mu = law.sliding_friction(1.0)
    free = [scene.model_copy(update={"initial": None, "dimensional": None}) for scene in scenes]
    found = solve(free, Saturated(mu=mu), tolerance)

    def floquet() -> Floats:
        heat = read_columns(free, found.orbit, found.orbits)["energy_contact"]
        way = heat / (scenes[0].mass().normal_load * mu)
        own = np.full(len(way), np.nan) if found.floquet is None else found.floquet()
        return np.asarray(np.maximum(own, _forgotten(law, way)))

    reasons = [
        HELD if status == "not_unique" and scene.belt_speed == 0.0 else reason
        for status, reason, scene in zip(found.status, found.reason, scenes, strict=True)
    ]
    models = [f"{model}; {SATURATED}" for model in found.model]
    return replace(found, reason=reasons, model=models, floquet=floquet)


def _forgotten(law: BristleLaw, way: Floats) -> Floats:
    """What is left of a deflection short of the limit after this way slid, of what was there before."""
    limit = law.largest_deflection()
    return np.exp(-way * law.rate(1.0, (1.0 - SHORT) * limit) / (SHORT * limit))
