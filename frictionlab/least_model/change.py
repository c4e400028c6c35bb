"""What the curve of a model without something changes: the mean, the reduction and the shape, each with its error."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
import pandas as pd

from frictionlab import registry
from frictionlab.quantities import Floats
from frictionlab.results.curve_table import curve_table
from frictionlab.results.words import counted
from frictionlab.shape.verdict import Estimate, reduction

Need = Literal["needed", "not needed", "undecided", "refused"]
NOWHERE = Estimate(math.nan, math.nan)


class Measures(NamedTuple):
    """The reduction of a curve, largest 1 - m/steady, and the verdict on its shape, '' where none is read."""

    reduction: Estimate
    shape: str


@dataclass(frozen=True)
class Change:
    """From the full curve to another: the mean where it changes most, with the errors of both, and the reduction.

    belt_speed: where. shapes: the verdicts on the full curve and on the other, '' where none is read. verdict: of the
    largest change against a tolerance; reason: why it is not plain.
    """

    mean: Estimate
    belt_speed: float
    reduction: Estimate
    shapes: tuple[str, str]
    verdict: Need
    reason: str

    @property
    def turns(self) -> bool:
        """Whether both curves have a shape that is decided, and another one."""
        return self.shapes[0] != self.shapes[1] and not {"", "undecided"} & set(self.shapes)


def refused_change(reason: str) -> Change:
    """Of a model that no method solves."""
    return Change(NOWHERE, math.nan, NOWHERE, ("", ""), "refused", reason)


def measures(table: pd.DataFrame, laws: registry.Laws) -> Measures:
    """Those of a table that is one curve."""
    curves = curve_table(table, laws)
    if not curves.empty:
        row = curves.iloc[0]
        shape = row["shape"]
        return Measures(
            Estimate(row["reduction"], row["reduction_error"]), shape if isinstance(shape, str) else ""
        )
    known = table[(table["status"] == "ok") & np.isfinite(table["normalized_friction"])]
    if known.empty:
        return Measures(NOWHERE, "")
    size, mean = (known[name].to_numpy(float) for name in ("normalized_friction", "mean_friction"))
    return Measures(reduction(size, known["error"].to_numpy(float) * np.abs(size / mean)), "")


def change_of_curve(
    full: pd.DataFrame, other: pd.DataFrame, speeds: Floats, within: float, laws: registry.Laws
) -> Change:
    """Of the other table against that of the full scene, row by row at these belt speeds."""
    asked = (full["status"] == "ok").to_numpy()
    known = asked & (other["status"] == "ok").to_numpy()
    why = _without_answer(other, asked & ~known, int(asked.sum()))
    if not known.any():
        return refused_change(why)
    size = (other["mean_friction"] - full["mean_friction"]).to_numpy(float)[known]
    error = (other["error"] + full["error"]).to_numpy(float)[known]
    at = int(np.argmax(np.abs(size)))
    here, there = measures(full, laws), measures(other, laws)
    less = Estimate(
        there.reduction.value - here.reduction.value, there.reduction.error + here.reduction.error
    )
    verdict, reason = _judged(np.abs(size), error, within)
    if why and verdict == "not needed":
        verdict = "undecided"
    mean = Estimate(float(size[at]), float(error[at]))
    return Change(
        mean,
        float(speeds[known][at]),
        less,
        (here.shape, there.shape),
        verdict,
        "; ".join(filter(None, (reason, why))),
    )


def _judged(size: Floats, error: Floats, within: float) -> tuple[Need, str]:
    if (size - error > within).any():
        return "needed", ""
    if (size + error <= within).all():
        return "not needed", ""
    return "undecided", "the error of the change spans the tolerance"


def _without_answer(table: pd.DataFrame, places: Floats, asked: int) -> str:
    """Why a model has no number at some belt speeds."""
    if not places.any():
        return ""
    rows = table[places]
    reasons = (rows["status"] + ": " + rows["reason"].astype("str")).value_counts()
    where = "" if len(rows) == asked else f" at {len(rows)} of {counted(asked, 'belt speed')}"
    return f"no answer{where} ({reasons.index[0]})"
