"""What a scene needs, in sentences."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from frictionlab.least_model.lesser import LesserModel
from frictionlab.least_model.motion import FRICTION_FREE
from frictionlab.least_model.search import Without
from frictionlab.least_model.without_rest import WithoutRest
from frictionlab.printable import with_error
from frictionlab.results.words import counted, in_words
from frictionlab.shape.verdict import Estimate

WHERE_IT_MOVES = {
    0: "slip prescribed",
    1: "motion along the belt alone",
    2: "motion along and across the belt",
}


def model_in_words(model: LesserModel) -> str:
    """What a model still has."""
    law = type(model.law).__name__
    values = model.law.model_dump(exclude_none=True, mode="json", exclude_defaults=True)
    told = ", ".join(f"{name} {in_words(value)}" for name, value in values.items())
    return f"{WHERE_IT_MOVES[model.scene.degrees_of_freedom]}, {law} friction ({told}){_way(model)}"


def _way(model: LesserModel) -> str:
    if model.way is None:
        return ""
    if model.way.name == FRICTION_FREE:
        return ", friction averaged over the friction-free motion (mdsm)"
    if isinstance(model.way, WithoutRest):
        return ", a motion of two reversals a period without rest"
    harmonics = getattr(model.way, "harmonics", 1)
    return f", {counted(harmonics, 'harmonic')} balanced ({model.way.name})"


def written_size(number: Estimate) -> str:
    """A change by its magnitude, and its error where that is not small beside it."""
    size = abs(number.value)
    if size <= number.error:
        return f"at most {size + number.error:.2g}"
    return with_error(size, number.error, 3, " +- ")


def sentence_of(each: Without) -> str:
    """Whether what is gone is needed, and what the mean changes by without it."""
    names = " and ".join(each.names)
    plural = len(each.names) > 1 or names.startswith("harmonics")
    verb, it = ("are", "them") if plural else ("is", "it")
    if each.change.verdict == "refused":
        return f"{names} cannot be taken away: {each.change.reason}"
    changes = f"without {it} {_changes(each)}"
    if each.change.turns:
        changes += ", its curve from {} to {}".format(*each.change.shapes)
    why = f" ({each.change.reason})" if each.change.reason else ""
    if each.change.verdict == "undecided":
        return f"whether {names} {verb} needed is undecided: {changes}{why}"
    return f"{names} {verb} {each.change.verdict}: {changes}{why}"


def smallest_in_words(smallest: Without | None, full: LesserModel, within: float) -> str:
    """The smallest model, what it is without, and what that changes."""
    if smallest is None or smallest.model is None:
        return f"the smallest model within {within:.3g} is the full one: {model_in_words(full)}"
    less = f"the smallest model within {within:.3g} is without {_listed(smallest.names)}"
    return f"{less}: {model_in_words(smallest.model)}; {_changes(smallest)}"


def _changes(each: Without) -> str:
    return f"the mean changes by {written_size(each.change.mean)} at belt speed {each.change.belt_speed:.6g}"


def missing_means(answers: pd.DataFrame) -> list[str]:
    """What is said of belt speeds at which the full scene has no one mean."""
    rest = answers[answers["status"] != "ok"]
    if rest.empty:
        return []
    why = (rest["status"] + ": " + rest["reason"].astype("str")).value_counts().index[0]
    if len(rest) == len(answers):
        return [f"the full scene has no one mean to compare with ({why})"]
    where = f"{counted(len(rest), 'belt speed')} of {len(answers)}"
    return [f"left out: {where} at which the full scene has no one mean ({why})"]


def _listed(names: Sequence[str]) -> str:
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last
