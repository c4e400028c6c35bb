"""Answers of the exact method with their means proved, where that can be done."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers
from frictionlab.methods.exact.proof.motion import NotProved
from frictionlab.methods.exact.proof.prove import prove
from frictionlab.methods.words import ModelWord
from frictionlab.scene.scene import Scene
from frictionlab.theory.uniqueness import is_unique

NOT_UNIQUE = "not proved: no theorem says that there is no other orbit"


def certified(answers: Answers, scenes: Sequence[Scene], law: FrictionLaw) -> Answers:
    """The same, its estimated errors replaced by proved ones; where the proof fails the reason says at what."""
    mean, error = answers.mean.copy(), answers.error.copy()
    kind, model, reason = list(answers.error_kind), list(answers.model), list(answers.reason)
    coefficient = law.sliding_friction(1.0)
    for i, scene in enumerate(scenes):
        if answers.status[i] != "ok" or kind[i] == "guaranteed":
            continue
        orbit = answers.orbit(i)
        problem = NOT_UNIQUE
        if orbit is not None and is_unique(scene, law):
            try:
                proved = prove(scene, coefficient, orbit)
            except NotProved as why:
                problem = f"not proved: {why}"
            else:
                mean[i], error[i], kind[i], model[i] = (
                    proved.mean,
                    proved.error,
                    "guaranteed",
                    f"{model[i]}; {ModelWord.INTERVALS}",
                )
                continue
        reason[i] = "; ".join(part for part in (reason[i], problem) if part)
    return replace(answers, mean=mean, error=error, error_kind=kind, model=model, reason=reason)
