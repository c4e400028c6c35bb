"""Curves of models, and what one changes of another: the mean, the reduction and the shape, with errors."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import pandas as pd

from frictionlab.analysis.needs.motion import FRICTION_FREE, LesserModel, MotionWay
from frictionlab.curves.verdict import Estimate, reduction
from frictionlab.runner.api import table_of
from frictionlab.runner.curve_table import curve_table
from frictionlab.runner.part import derived_columns
from frictionlab.runner.pieces import Task
from frictionlab.runner.words import counted
from frictionlab.scene.scenes import Scenes
from frictionlab.study import registry
from frictionlab.study.grid import StudyCurve
from frictionlab.study.parts import MethodChoice
from frictionlab.study.study import kind_of
from frictionlab.values.columns import OF_SHAPE, selected
from frictionlab.values.quantities import Floats

OF_A_MODEL = 1e-8
"""Error of the numbers of a reduced model, relative to the friction coefficient: its formulas, loops and balances."""
NO_BALANCE_HERE = "the reduced model has no answer here"
ASKED_FOR = selected([*OF_SHAPE, "model"])
Need = Literal["needed", "not needed", "undecided", "refused"]
NOWHERE = Estimate(math.nan, math.nan)


class Curves:
    """Curves of models along the belt speeds of some scenes, each solved once.

    speeds: these in the scale of the scene; given: as they were given [m/s for scenes in SI units].
    kinds: registered names of laws beside the installed ones. seconds_per_point: the time a point may take [s].
    """

    def __init__(
        self, scenes: Scenes, tolerance: float, kinds: Mapping[type, str], seconds_per_point: float
    ) -> None:
        self.speeds, self.given = scenes.belt_speeds, scenes.given
        self._task = Task(tolerance, columns=ASKED_FOR, seconds_per_point=seconds_per_point)
        self._kinds = kinds
        self._known: dict[LesserModel, pd.DataFrame] = {}

    def solve(self, models: Sequence[LesserModel]) -> None:
        """Solve those that are not known yet, several at once."""
        full = dict.fromkeys(LesserModel(each.scene, each.law) for each in models)
        new = [each for each in full if each not in self._known]
        if not new:
            return
        size, auto = len(self.speeds), MethodChoice("auto", "auto", {})
        places = [range(k * size, (k + 1) * size) for k in range(len(new))]
        curves = [
            StudyCurve(str(k), self._kind(each), each.law, auto, Scenes(each.scene, self.speeds), places[k])
            for k, each in enumerate(new)
        ]
        table = table_of(curves, self._task)
        for rows, each in zip(places, new, strict=True):
            self._known[each] = table.iloc[rows.start : rows.stop].reset_index(drop=True)

    def of(self, model: LesserModel) -> pd.DataFrame:
        """Return the table of a model, a row per belt speed."""
        self.solve([model])
        table = self._known[LesserModel(model.scene, model.law)]
        return table if model.way is None else self._reduced(model, model.way, table)

    def _kind(self, model: LesserModel) -> str:
        return self._kinds.get(type(model.law)) or kind_of(model.law)

    def _reduced(self, model: LesserModel, way: MotionWay, full: pd.DataFrame) -> pd.DataFrame:
        """Return the table with the means of a reduced model in place of those of the full motion."""
        scenes = Scenes(model.scene, self.speeds)
        means = np.asarray(way.model_means(scenes, model.law)).real
        derived = derived_columns(scenes, model.law, means)
        known = np.isfinite(means)
        scale = model.law.sliding_friction(float(np.abs(self.speeds).max()))
        found = full.assign(
            mean_friction=means,
            error=np.where(known, OF_A_MODEL * scale, np.nan),
            status=np.where(known, "ok", "refused"),
            reason=np.where(known, "", NO_BALANCE_HERE),
            normalized_friction=derived["normalized_friction"],
            model=way.name,
        )
        if way.name != FRICTION_FREE:
            return found
        ratio = derived["velocity_ratio"]
        free = np.divide(self.speeds, ratio, where=ratio != 0.0, out=np.full(len(ratio), np.nan))
        reverses = 2.0 * (free > np.abs(self.speeds))
        return found.assign(velocity_amplitude=free, reversals=reverses, stick_fraction=0.0)


@dataclass(frozen=True)
class Change:
    """From the full curve to another: the mean where it changes most, with the errors of both, and the reduction.

    reason: why the verdict, of the largest change against a tolerance, is not plain. belt_speed: where. shapes: the
    verdicts on the full curve and on the other, '' where none is read. Refused: of a model that no method solves.
    """

    reason: str
    mean: Estimate = NOWHERE
    belt_speed: float = math.nan
    reduction: Estimate = NOWHERE
    shapes: tuple[str, str] = ("", "")
    verdict: Need = "refused"

    @property
    def turns(self) -> bool:
        """Check whether both curves have a shape that is decided, and another one."""
        return self.shapes[0] != self.shapes[1] and not {"", "undecided"} & set(self.shapes)


def change_of_curve(
    full: pd.DataFrame, other: pd.DataFrame, speeds: Floats, within: float, laws: registry.Laws
) -> Change:
    """Return the change of the other table against that of the full scene, row by row at these belt speeds."""
    asked = (full["status"] == "ok").to_numpy()
    known = asked & (other["status"] == "ok").to_numpy()
    why = _without_answer(other, asked & ~known, int(asked.sum()))
    if not known.any():
        return Change(why)
    size = (other["mean_friction"] - full["mean_friction"]).to_numpy(float)[known]
    error = (other["error"] + full["error"]).to_numpy(float)[known]
    verdict: Need = "undecided"
    if (np.abs(size) - error > within).any():
        verdict = "needed"
    elif not (np.abs(size) + error <= within).all():
        why = "; ".join(filter(None, ("the error of the change spans the tolerance", why)))
    elif not why:
        verdict = "not needed"
    at = int(np.argmax(np.abs(size)))
    mean = Estimate(float(size[at]), float(error[at]))
    (here, shape), (there, other_shape) = _measures(full, laws), _measures(other, laws)
    less = Estimate(there.value - here.value, there.error + here.error)
    return Change(why, mean, float(speeds[known][at]), less, (shape, other_shape), verdict)


def _measures(table: pd.DataFrame, laws: registry.Laws) -> tuple[Estimate, str]:
    """Return the reduction of a curve, largest 1 - m/steady, and the verdict on its shape, '' where none is read."""
    curves = curve_table(table, laws)
    if not curves.empty:
        row = curves.iloc[0]
        shape = row["shape"] if isinstance(row["shape"], str) else ""
        return Estimate(row["reduction"], row["reduction_error"]), shape
    known = table[(table["status"] == "ok") & np.isfinite(table["normalized_friction"])]
    if known.empty:
        return NOWHERE, ""
    size, mean, error = (
        known[name].to_numpy(float) for name in ("normalized_friction", "mean_friction", "error")
    )
    return reduction(size, error * np.abs(size / mean)), ""


def _without_answer(table: pd.DataFrame, places: Floats, asked: int) -> str:
    """Why a model has no number at some belt speeds."""
    if not places.any():
        return ""
    where = "" if places.sum() == asked else f" at {places.sum()} of {counted(asked, 'belt speed')}"
    return f"no answer{where} ({commonest_reason(table[places])})"


def commonest_reason(rows: pd.DataFrame) -> str:
    """Return the status and the reason that most rows without a number have."""
    return str((rows["status"] + ": " + rows["reason"].astype("str")).value_counts().index[0])
