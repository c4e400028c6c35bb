"""Why march cannot step a scene under a law, as sentences."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import about_rest, beyond_linear, beyond_springs
from frictionlab.methods.march.steppers import STEPPERS, StepperFacts, StepperName, fewest_steps, steppers_of
from frictionlab.methods.periodic.problem import along_the_belt
from frictionlab.methods.shooting.method import suggest_shooting
from frictionlab.scene.parts import BENDING
from frictionlab.scene.scene import Scene
from frictionlab.theory.rest import friction_at_rest

FEWEST_LAPS, WORK = 10, 16_000_000
"""Fewest laps that a motion takes to settle; steps that a point may cost in all, where ``steps`` is left out."""
SEVERAL = "deflections", "scalars"
"""Kinds of memory that are several numbers, or no deflection."""


@dataclass(frozen=True)
class Request:
    """A scene, a law under its load, the stepper and the keys of a study that may not suit them."""

    scene: Scene
    law: Any
    stepper: StepperName
    theta: float | None
    steps: int | None

    @property
    def kind(self) -> str:
        """Return what the law remembers."""
        return self.law.memory_kind

    @property
    def facts(self) -> StepperFacts:
        """Facts of the stepper."""
        return STEPPERS[self.stepper]


def reasons_against(asked: Request) -> Iterator[str]:
    """Every reason why march cannot do what is asked, the first to be mended first."""
    law, scene = asked.law, asked.scene
    if scene.degrees_of_freedom == 0:
        yield suggest_shooting("march steps a mass, and this slip is prescribed", scene, law)
        return
    bent = beyond_linear("march", scene, BENDING) or about_rest("march", scene)
    if reason := beyond_springs(scene) or bent:
        yield reason
        return
    if not steppers_of(asked.kind):
        yield "march needs a SlidingLaw, a BristleLaw or a MemoryLaw"
        return
    yield from _against_the_stepper(asked)
    if asked.theta is not None and law.count() > 0:
        yield "theta is a key of stepper moreau, which does not support friction with memory; leave it out"
    yield from _against_constant_contact(asked)
    yield from _against_several_memories(asked)
    planar = law.planar_form() == "vectorial" and not along_the_belt(scene, law)
    if planar and law.no_vector_form():
        yield law.no_vector_form()
    yield from _against_jumps(asked)
    yield from _against_rates(asked)
    yield from _against_so_few_steps(asked)


def _against_constant_contact(asked: Request) -> Iterator[str]:
    if asked.kind in SEVERAL and asked.scene.constant_contact:
        yield (
            "normal_load_variation.contact: constant needs a law of one bristle, whose limit follows the load while "
            "its stiffness stays; for this law give per_load"
        )


def _against_the_stepper(asked: Request) -> Iterator[str]:
    if asked.kind in asked.facts.kinds:
        return
    use = " or ".join(", ".join(steppers_of(asked.kind)).rsplit(", ", 1))
    if asked.kind == "none":
        yield f"stepper {asked.stepper} needs a bristle law; use {use}"
    else:
        what = "friction with memory" if asked.kind == "bristle" else "laws with several memories or scalars"
        yield f"stepper {asked.stepper} does not support {what}; use {use}"


def _against_several_memories(asked: Request) -> Iterator[str]:
    if asked.kind not in SEVERAL:
        return
    if asked.law.remembers_stick():
        yield "march steps follow no stick or slip of single elements; shooting does"
    if asked.scene.undriven:
        reason = "for a law with several memories or scalars march needs a driven mass"
        yield suggest_shooting(reason, asked.scene, asked.law)


def _against_jumps(asked: Request) -> Iterator[str]:
    """Static friction above sliding friction, for steppers without stick."""
    jumps = asked.kind == "none" and friction_at_rest(asked.law) > asked.law.sliding_friction(0.0)
    if jumps and not asked.facts.sticks:
        yield (
            f"stepper {asked.stepper} has no stick, and static friction above sliding friction needs it; "
            f"use stepper moreau"
        )


def _against_rates(asked: Request) -> Iterator[str]:
    """Rates of a memory without a bound, or that jump."""
    law = asked.law
    if asked.facts.limited_by_rates and math.isinf(law.largest_rate(1.0)):
        what, use = ("the memory", "shooting") if asked.kind in SEVERAL else ("bristles", "sdirk2")
        yield f"stepper {asked.stepper} needs a bound on the decay rate of {what}, and this law has none; use {use}"
    if not asked.facts.bears_jumps and math.isfinite(law.yield_deflection()):
        yield f"stepper {asked.stepper} needs continuous rates, and those of this law jump at yield; use rk4"


def _against_so_few_steps(asked: Request) -> Iterator[str]:
    """A stepper that needs more steps than are given, or than can be refined."""
    law, stepper = asked.law, asked.stepper
    fewest = fewest_steps(asked.scene, law, asked.facts)
    if asked.steps is not None and asked.steps < fewest:
        yield unstable(asked.steps, fewest, law, stepper)
    if asked.steps is None and 3 * FEWEST_LAPS * fewest > WORK:
        yield (
            f"stepper {stepper} is unstable on {_stiff(law)} below about {fewest:,} steps per period, too "
            f"many to refine with {WORK:,} steps in all; give steps, or use {_others(law)}"
        )


def unstable(steps: int, fewest: int, law: FrictionLaw, stepper: str) -> str:
    """Why an explicit stepper is unstable with so many steps, and how many are enough."""
    return (
        f"stepper {stepper} is unstable on {_stiff(law)} with {steps:,} steps per period: about {fewest:,} "
        f"are enough; or use {_others(law)}"
    )


def _stiff(law: FrictionLaw) -> str:
    return "memory this fast" if law.memory_kind in SEVERAL else "bristles this stiff"


def _others(law: Any) -> str:
    smooth = law.memory_kind == "bristle" and not math.isfinite(law.yield_deflection())
    return "stepper sdirk2" if smooth else "method shooting"
