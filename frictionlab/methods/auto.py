"""Choice of the cheapest method that takes a scene."""

from __future__ import annotations

import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cache
from importlib.metadata import entry_points
from typing import ClassVar

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import FOR_MEMORY, STATISTICAL, Answers, FoundState, Method
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.shooting.method import Shooting
from frictionlab.methods.words import AUTO, ModelWord
from frictionlab.motion.orbit.record import Orbit
from frictionlab.scene.scene import Scene

METHODS_BY_COST: tuple[Method, ...] = (Exact(), Shooting())
"""From the cheapest method to the most general one."""
NOT_INSTALLED = (
    "a body that remembers, or is known by a table, is solved by method relay_locus: install the package "
    "frictionlab-linear-bodies, which brings it, or give a body of springs and dashpots"
)


@cache
def _for_memory() -> tuple[Method, ...]:
    """Return the method for bodies that remember; none where it is not installed, or cannot be imported."""
    for door in entry_points(group="frictionlab.methods", name=FOR_MEMORY):
        with suppress(ImportError):
            return (door.load()(),)
    return ()


def _methods_for(scene: Scene) -> tuple[Method, ...]:
    return _for_memory() if scene.remembers else METHODS_BY_COST


class Auto(Method):
    """Cheapest method that applies: exact, else shooting; relay_locus, a plugin, for a body with memory.

    One method solves a whole curve, since a change of method inside a curve would look like physics. The
    column ``model`` tells why it was chosen. An answer whose error is above the tolerance counts as failed.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4), method="auto")
    >>> round(state.mean_friction, 4), state.error < 1e-8
    (0.0506, True)
    >>> fl.Auto().choice(scene, fl.Dahl(mu=0.4, stiffness=40))
    (Shooting(), 'cheapest method that applies: exact needs friction without memory (Coulomb)')
    """

    name: ClassVar[str] = "auto"
    in_words: ClassVar[str] = "steady state"
    resolves_events: ClassVar[bool] = True

    def choice(self, scene: Scene, law: FrictionLaw) -> tuple[Method | None, str]:
        """Return the method for this scene and law, and why; None where every method refuses."""
        methods, against = _methods_for(scene), list[str]()
        if not methods:
            return None, NOT_INSTALLED
        for method in methods:
            reason = method.refusal(scene, law)
            if reason is None:
                why = against[-1].split(";")[0] if against else ModelWord.CHEAPEST.sentence
                return method, f"cheapest method that applies: {why}"
            against.append(reason)
        return None, "; ".join(dict.fromkeys(part for reason in against for part in reason.split("; ")))

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Return the reasons of all methods, where every one refuses."""
        method, reason = self.choice(scene, law)
        return reason if method is None else None

    def refusals(self, scenes: Sequence[Scene], law: FrictionLaw) -> list[str | None]:
        """None where one method accepts them all; else one after another."""
        for method in _methods_for(scenes[0]):
            reasons = method.refusals(scenes, law)
            if not any(reasons):
                return reasons
        return super().refusals(scenes, law)

    def states(
        self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float, starts: int
    ) -> list[FoundState]:
        """Return the states that shooting finds: no other method follows motions to wherever they end."""
        shooting = METHODS_BY_COST[-1]
        return [] if any(shooting.refusals(scenes, law)) else shooting.states(scenes, law, tolerance, starts)

    def motion(self, scene: Scene, law: FrictionLaw, periods: int, tolerance: float) -> list[Orbit]:
        """Follow a motion by shooting: no other method follows one from a start."""
        shooting = METHODS_BY_COST[-1]
        return [] if any(shooting.refusals([scene], law)) else shooting.motion(scene, law, periods, tolerance)

    def foreseen(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> str:
        """Return what will answer these scenes and why, as far as that is known before anything is computed."""
        method, why = self.choice(scenes[0], law)
        return "none" if method is None else f"{method.name} ({why})"

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Solve by the chosen method. Points with an error above the tolerance are failed."""
        method, why = self.choice(scenes[0], law)
        assert method is not None, why
        answers = method.solve(scenes, law, tolerance)
        status, reason = list(answers.status), list(answers.reason)
        for i in np.flatnonzero(answers.error > tolerance).tolist():
            if status[i] == "ok" and answers.error_kind[i] != STATISTICAL:
                status[i] = "failed"
                reaches = f"reaches an error of {answers.error[i]:.1e}, above the tolerance {tolerance:.1e}"
                told = re.search(r"above the tolerance[^:;]*(: [^;]+)", reason[i])
                reason[i] = f"{method.name} {reaches}{told[1] if told else ''}"
        word = next((str(each) for each in ModelWord if why.endswith(each.sentence)), why)
        named = {model: f"{model}{AUTO}{method.name}, {word})" for model in set(answers.model)}
        model = [named[each] for each in answers.model]
        return replace(answers, status=status, reason=reason, model=model)
