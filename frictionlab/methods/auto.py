"""Choice of the least model within the tolerance, the same one for a whole curve, and of its cheapest method."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import ClassVar

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers, FoundState, Method
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.reduced.rung import Rung
from frictionlab.methods.reduced.stiff_bristle import StiffBristle
from frictionlab.methods.shooting.method import Shooting
from frictionlab.orbit.record import Orbit
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import MOST_TOLD, Scenes

METHODS_BY_COST: tuple[Method, ...] = (Exact(), Shooting())
"""From the cheapest method to the most general one."""
RUNGS: tuple[Rung, ...] = (StiffBristle(),)
"""Smaller models, the least first."""
LONG_SHARE = 0.5
"""Share of the tolerance that a smaller model must meet at the belt speeds by which pieces of a long curve know it:
at those between them its error is about as large."""


class Auto(Method):
    """Tries exact, then shooting, on the least model of the scene whose error is within the tolerance; says why.

    A smaller model answers where its error covers what it leaves out and is within the tolerance at every belt speed
    of the curve: one model and one method solve a whole curve, since a change inside a curve would look like physics.
    An answer whose error is above the tolerance counts as failed.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4), method="auto")
    >>> round(state.mean_friction, 4), state.error < 1e-8
    (0.0506, True)
    >>> fl.Auto().choice(scene, fl.Dahl(mu=0.4, stiffness=40))
    (Shooting(), 'cheapest method that applies: exact needs friction without memory (Coulomb)')
    """

    name: ClassVar[str] = "auto"
    resolves_events: ClassVar[bool] = True

    def choice(self, scene: Scene, law: FrictionLaw) -> tuple[Method | None, str]:
        """The method for this scene and law, and why; None where every method refuses."""
        against: list[str] = []
        for method in METHODS_BY_COST:
            reason = method.refusal(scene, law)
            if reason is None:
                why = against[-1].split(";")[0] if against else "it accepts the scene"
                return method, f"cheapest method that applies: {why}"
            against.append(reason)
        return None, "; ".join(dict.fromkeys(part for reason in against for part in reason.split("; ")))

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """The reasons of all methods, where every one refuses."""
        method, reason = self.choice(scene, law)
        return reason if method is None else None

    def refusals(self, scenes: Sequence[Scene], law: FrictionLaw) -> list[str | None]:
        """None where one method accepts them all; else one after another."""
        for method in METHODS_BY_COST:
            reasons = method.refusals(scenes, law)
            if not any(reasons):
                return reasons
        return super().refusals(scenes, law)

    def cost(self, scene: Scene, law: FrictionLaw, tolerance: float) -> float:
        """The cost of the chosen method."""
        method, _reason = self.choice(scene, law)
        return method.cost(scene, law, tolerance) if method is not None else 0.0

    def states(
        self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float, starts: int
    ) -> list[FoundState]:
        """Those that shooting finds: no other method follows motions to wherever they end."""
        shooting = METHODS_BY_COST[-1]
        return [] if any(shooting.refusals(scenes, law)) else shooting.states(scenes, law, tolerance, starts)

    def motion(self, scene: Scene, law: FrictionLaw, periods: int, tolerance: float) -> list[Orbit]:
        """That of shooting: no other method follows a motion from a start."""
        shooting = METHODS_BY_COST[-1]
        return [] if any(shooting.refusals([scene], law)) else shooting.motion(scene, law, periods, tolerance)

    def rungs(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> list[Rung]:
        """The smaller models that may be within the tolerance along the curve of these scenes."""
        taking = [rung for rung in RUNGS if rung.takes(scenes[0], law)]
        curve = Scenes.of(scenes).curve if taking else scenes
        return [rung for rung in taking if rung.may_meet(curve, law, tolerance)]

    def foreseen(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> str:
        """What will answer these scenes and why, as far as that is known before anything is computed."""
        method, why = self.choice(scenes[0], law)
        full = "none" if method is None else f"{method.name} ({why})"
        smaller = [f"{rung.model} where its error allows it" for rung in self.rungs(scenes, law, tolerance)]
        return ", else ".join([*smaller, full])

    def hangs_on_curve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> bool:
        """Where a smaller model may be within the tolerance."""
        return bool(self.rungs(scenes, law, tolerance))

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Solve by the least model within the tolerance along the curve, else by the chosen method.

        Points with an error above the tolerance are failed.
        """
        for rung in self.rungs(scenes, law, tolerance):
            answers = _by_rung(rung, scenes, law, tolerance)
            if answers is not None:
                return self._named(answers, rung, scenes[0], law, tolerance)
        return self._by_method(scenes, law, tolerance)

    def _named(
        self, answers: Answers, rung: Rung, scene: Scene, law: FrictionLaw, tolerance: float
    ) -> Answers:
        """With what was left out, what that may cost, and what the full model would have cost."""
        method, _why = self.choice(scene, law)
        assert method is not None
        why = (
            f"(auto: {rung.name}, least model within {tolerance:.0e} along the curve: leaves out {rung.left_out}, "
            f"which changes the mean by no more than error; {method.name} on the full model takes about "
            f"{_spoken(method.cost(scene, law, tolerance))} a point)"
        )
        named = {model: f"{model} {why}" for model in set(answers.model)}
        return replace(answers, model=[named[model] for model in answers.model])

    def _by_method(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        method, why = self.choice(scenes[0], law)
        assert method is not None, why
        answers = method.solve(scenes, law, tolerance)
        status, reason = list(answers.status), list(answers.reason)
        for i in np.flatnonzero(~(answers.error <= tolerance)).tolist():
            if status[i] == "ok":
                status[i] = "failed"
                reason[i] = (
                    f"{method.name} reaches an error of {answers.error[i]:.1e}, above the tolerance {tolerance:.1e}"
                )
        named = {model: f"{model} (auto: {method.name}, {why})" for model in set(answers.model)}
        model = [named[each] for each in answers.model]
        return replace(answers, status=status, reason=reason, model=model)


def _by_rung(rung: Rung, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers | None:
    """The answers of a smaller model; None where it is not within the tolerance at some belt speed of the curve.

    A piece of a curve solves the curve as well, or of a long one some of it: every piece comes to the same choice.
    """
    curve = Scenes.of(scenes).curve
    asked = tolerance if len(curve) < MOST_TOLD else LONG_SHARE * tolerance
    if len(curve) != len(scenes) and not _within(rung.solve(curve, law, asked), asked):
        return None
    answers = rung.solve(scenes, law, tolerance)
    return answers if _within(answers, tolerance if len(curve) != len(scenes) else asked) else None


def _within(answers: Answers, tolerance: float) -> bool:
    return bool((answers.error <= tolerance).all()) and all(status == "ok" for status in answers.status)


def _spoken(seconds: float) -> str:
    return f"{seconds * 1e3:.3g} ms" if seconds >= 1e-3 else f"{seconds * 1e6:.3g} us"
