"""Sentences of a report: templates of three slots at most, each with a check of the table that it is true of."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pandas as pd
from markupsafe import Markup
from pandas.api.types import is_numeric_dtype

from frictionlab.runner.pairs import NOBODY, Ranking
from frictionlab.scene.scene import Scene

Sentences = Mapping[str, Callable[[Any], bool]]
"""Templates, and when each is true."""
MOST_STRETCHES = 4
"""Stretches of the axis, on each of which another is highest, that are told one by one."""


def tell(sentences: Sentences, of: Any, **slots: Any) -> Markup:
    """Write those that are true of something; an article that begins one has a capital."""
    written = [Markup(words).format(**slots) for words, holds in sentences.items() if holds(of)]
    return Markup(" ").join(Markup(f"T{each[1:]}") if each.startswith("the ") else each for each in written)


# Rows of one curve, by the input of the axis


def way(rows: pd.DataFrame) -> str:
    """Way of a curve, but for errors: flat, up or down along one axis throughout, else to and fro; or a point."""
    if len(rows) == 1:
        return "point"
    mean, error = (rows[name].to_numpy(float) for name in ("mean_friction", "error"))
    low, high = mean.argmin(), mean.argmax()
    if mean[high] - mean[low] <= error[high] + error[low]:
        return "flat"
    steps, slack = np.diff(mean), error[1:] + error[:-1]
    ways = {"up": steps >= -slack, "down": steps <= slack}
    return next((name for name, so in ways.items() if rows.index.is_unique and so.all()), "to and fro")


def goes(wanted: str) -> Callable[[pd.DataFrame], bool]:
    """Check for a curve that goes this way."""
    return lambda rows: way(rows) == wanted


def passes_zero(rows: pd.DataFrame) -> list[int]:
    """Places along one axis of the first two neighbours, but for zeros within errors, on both sides of zero."""
    clear = np.flatnonzero(rows["mean_friction"].abs() > rows["error"])
    turns = np.flatnonzero(np.diff(np.sign(rows["mean_friction"].to_numpy(float)[clear])))
    return [*map(int, clear[turns[0] : turns[0] + 2])] if len(turns) and rows.index.is_unique else []


ON_CURVE: Sentences = {
    "The mean friction coefficient of {law} is {first}.": goes("point"),
    "Mean friction of {law} is the same within its errors at all {points}: {first}.": goes("flat"),
    "Mean friction of {law} rises from {first} to {last}.": goes("up"),
    "Mean friction of {law} falls from {first} to {last}.": goes("down"),
    "Mean friction of {law} lies between {least} and {most}.": goes("to and fro"),
    "It passes zero between {before} and {after}.": lambda rows: bool(passes_zero(rows)),
}

# Laws, or what else is swept, ranked at every point


def is_tied(ranking: Ranking) -> bool:
    """Check that nowhere one is highest beyond errors."""
    return bool((ranking.first == NOBODY).all())


def is_won(ranking: Ranking) -> bool:
    """Check for one that is highest everywhere."""
    return not is_tied(ranking) and bool((ranking.first == ranking.first[0]).all())


def changes(ranking: Ranking) -> bool:
    """Check for several that are highest in turn, on few stretches of one axis."""
    along = len(ranking.points.columns) == 1 and is_numeric_dtype(ranking.points.iloc[:, 0])
    few = along and len(ranking.stretches) <= MOST_STRETCHES
    return few and not (is_tied(ranking) or is_won(ranking))


ON_RANKED: Sentences = {
    "Of {names} the highest agree within errors{everywhere}.": is_tied,
    "Mean friction is highest for {winner}{everywhere}.": is_won,
    "Mean friction is highest for {winners}.": changes,
    "None is highest everywhere.": lambda ranking: (
        not (is_tied(ranking) or is_won(ranking) or changes(ranking))
    ),
    "Where one has no number, the others are ranked.": lambda ranking: ranking.has_gaps,
}

# Two means at the point where they are furthest apart, or one with its error

ON_NEXT: Sentences = {"Its mean is {mean}, above {other}, the next, by {far}.": lambda value: value > 0.0}
ON_LAWS: Sentences = {"{one} is above {other} by up to {far}.": lambda value: value > 0.0}
ON_FURTHEST: Sentences = {"{one} is furthest from {other}, by {far}.": lambda value: value != 0.0}
ON_MODEL: Sentences = {
    "{one} agrees with {other} within errors.": lambda apart: not apart.apart,
    "{one} is too low by up to {far}.": lambda apart: apart.apart and apart.value < 0.0,
    "{one} is too high by up to {far}.": lambda apart: apart.apart and apart.value > 0.0,
}
ON_METHODS: Sentences = {
    "{one} and {other} differ by up to {far}.": lambda apart: bool(apart.apart),
    "{one} and {other} agree within errors: they differ by {far}.": lambda apart: not apart.apart,
}
ON_OWN_ERROR: Sentences = {"{one} is off by up to {far}.": lambda row: row["error"] > 0.0}

# Rows of a table: all, or those of one law, of one status, with large errors, with remarks


def has(column: str, *values: str) -> Callable[[pd.DataFrame], bool]:
    """Check for rows with one of these values in a column; with any where none is named."""

    def holds(rows: pd.DataFrame) -> bool:
        return column in rows and bool((rows[column].isin(values) if values else rows[column].notna()).any())

    return holds


NO_MEANS: Sentences = {
    "No point has a number.": lambda rows: not has("status", "not_unique")(rows),
    "No point has one mean friction.": has("status", "not_unique"),
}
ON_SILENT: Sentences = {"{law} has no number.": lambda rows: not has("mean_friction")(rows)}
ON_UNANSWERED: Sentences = {
    '<a href="#odd">not reached</a> at {points}, as the run was interrupted': lambda status: (
        status == "killed"
    ),
    '<a href="#odd">{status}</a> at {points}': lambda status: status in ("refused", "failed", "not unique"),
}
ON_SEEN: Sentences = {", with means from {low} to {high}": has("mean_low")}
ON_ROUGH: Sentences = {
    '<a href="#curves">errors up to {error}</a> above the tolerance of {tolerance} at {points}': has("error")
}
ON_REMARKS: Sentences = {'<a href="#odd">a remark</a> at {points}': has("reason")}
ON_NEEDED: Sentences = {
    '<span class="warn">Needs attention:</span> {trouble}.': bool,
    '<span class="good">Nothing needs attention:</span> {points} ok.': lambda trouble: not trouble,
}
ON_WELL: Sentences = {"Errors are at most {error}{besides}.": has("error")}
ON_FAILED: Sentences = {'<a href="#expected">{failed} of {expected} FAILED</a>': lambda held: not all(held)}
ON_HELD: Sentences = {"What the study expects holds: {expected}.": lambda held: all(held) and held != []}

# Curves of one shape, by a reduced model or not, and the table of all curves
ON_BENDS: Sentences = {
    '<a href="#shape">Concave</a> (above the chord): {who}.': has("shape", "concave"),
    '<a href="#shape">Convex</a> (below the chord): {who}.': has("shape", "convex"),
    '<a href="#shape">Mixed</a> (on both sides of the chord): {who}.': has("shape", "mixed"),
    '<a href="#shape">Undecided</a> (errors leave it open): {who}.': has("shape", "undecided"),
}
ON_OTHERWISE: Sentences = {"By {model} {shape}: {who}.": has("shape", "concave", "convex", "mixed")}
ON_AREA: Sentences = {
    "The area between curve and chord is {area} of that under the chord.": has("shape", "concave", "convex")
}
NO_SHAPE: Sentences = {
    "No curve has two belt speeds, so none has a shape.": lambda curves: curves.empty,
    "Without a shape: {without} ({why}).": lambda curves: curves["shape"].isna().any(),
}
ON_ENDS: Sentences = {
    "Slip stops reversing at {end}.": lambda curves: not known_ends(curves).empty,
    "Where slip stops reversing is left open by errors.": lambda curves: known_ends(curves).empty,
}


def known_ends(curves: pd.DataFrame) -> pd.DataFrame:
    """Curves whose end of reversal is known to more than itself."""
    return curves[curves["reversal_end_error"] <= curves["reversal_end"].abs()]


# A scene, and what changes in time in it


def has_degrees(count: int) -> Callable[[Scene], bool]:
    """Check for a scene of so many degrees of freedom."""
    return lambda scene: scene.degrees_of_freedom == count


ON_SCENE: Sentences = {
    "Prescribed slip: a body whose slip over the belt is given, not computed.": has_degrees(0),
    "A body with one degree of freedom, on a moving belt.": has_degrees(1),
    "A body with two degrees of freedom, in the plane, on a moving belt.": has_degrees(2),
    "No spring holds it along the belt.": lambda scene: scene.is_free,
    "Nothing shakes it.": lambda scene: scene.undriven,
}
GIVEN_IN_SI = "Given in SI units; a law's parameters are per unit normal load, but for those of the contact."
NONDIMENSIONAL = (
    "Nondimensional: lengths in L, times in 1/ω₁, forces in K₁L, speeds in ω₁L; friction coefficients are per unit "
    "normal load."
)
ON_UNITS: Sentences = {
    GIVEN_IN_SI: lambda scene: scene.dimensional is not None,
    NONDIMENSIONAL: lambda scene: scene.dimensional is None,
}
_SIZES = "amplitude", "unbalance", "velocity_amplitude"
ON_SHAKEN: Sentences = {
    "{load} varies {wave}{often}.": lambda given: any(given.get(size) for size in _SIZES),
    "A constant force pushes the body {where}.": lambda given: bool(given.get("offset")),
    "The stiffness of bristles follows it.": lambda given: given.get("contact") == "per_load",
    "The stiffness of bristles stays that of its mean.": lambda given: given.get("contact") == "constant",
    "The stiffness of bristles follows it or stays that of its mean.": lambda given: (
        given.get("contact") == "swept"
    ),
}

# The equations of a scene


def has_letter(*letters: str) -> Callable[[str], bool]:
    """Check for equations with one of these letters."""
    return lambda equations: any(f"<i>{letter}</i>" in equations for letter in letters)


def counts_cycles(letter: str) -> Callable[[str], bool]:
    """Check for equations in the circular frequency, and a table that has this letter in its place."""
    return lambda equations: has_letter("ω")(equations) and has_letter(letter)(equations)


ON_LETTERS: Sentences = {
    "v is the slip velocity.": has_letter("v"),
    "T is the friction coefficient of the law along it; a mass that sticks has v = 0.": has_letter("T"),
    "w is the waveform.": has_letter("w"),
    "H is the receptance of the table, harmonic by harmonic.": has_letter("H"),
    "Forces are in N, lengths in m, t in s.": has_letter("M", "t"),
    "ω is 2π times the f of the table.": counts_cycles("f"),
    "ω is 2π times the n of the table.": counts_cycles("n"),
    "Other letters have their numbers in the table below.": bool,
}
