"""Model no more than a scene needs: the cheapest method that is right for it, one for a whole curve."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import ClassVar

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers, Method
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Scene

LADDER: tuple[Method, ...] = (Exact(), Shooting())
"""From the cheapest method to the most general one. Reduced models have no rung: an honest bound on what they
leave out costs more than the exact answer along the belt, and more than shooting in the plane."""


class Auto(Method):
    """The lowest rung of the ladder exact, shooting that accepts the scene and the law; says which and why.

    One rung answers a whole curve: a seam between rungs inside a curve would look like physics. An answer whose
    error is above the tolerance counts as failed.
    """

    name: ClassVar[str] = "auto"

    def choice(self, scene: Scene, law: FrictionLaw) -> tuple[Method | None, str]:
        """The rung for this scene and law, and why; None where every rung refuses."""
        against: list[str] = []
        for rung in LADDER:
            reason = rung.refusal(scene, law)
            if reason is None:
                why = against[-1].split(";")[0] if against else "it accepts the scene"
                return rung, f"lowest rung that can: {why}"
            against.append(reason)
        return None, "; ".join(dict.fromkeys(part for reason in against for part in reason.split("; ")))

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Why every rung refuses, where all do."""
        rung, reason = self.choice(scene, law)
        return reason if rung is None else None

    def cost(self, scene: Scene, law: FrictionLaw, tolerance: float) -> float:
        """That of the chosen rung."""
        rung, _reason = self.choice(scene, law)
        return rung.cost(scene, law, tolerance) if rung is not None else 0.0

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Answer by the chosen rung, holding it to the tolerance."""
        rung, why = self.choice(scenes[0], law)
        assert rung is not None, why
        answers = rung.solve(scenes, law, tolerance)
        status, reason = list(answers.status), list(answers.reason)
        for i, error in enumerate(answers.error):
            if status[i] == "ok" and not error <= tolerance:
                status[i] = "failed"
                reason[i] = (
                    f"{rung.name} reaches an error of {error:.1e}, above the tolerance {tolerance:.1e}"
                )
        model = [f"{model} (auto: {rung.name}, {why})" for model in answers.model]
        return replace(answers, status=status, reason=reason, model=model)
