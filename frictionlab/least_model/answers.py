"""The curves of models: their mean friction with its error, and what the shape of a curve is read from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from frictionlab.columns import OF_SHAPE, selected
from frictionlab.least_model.lesser import LesserModel, MotionWay
from frictionlab.least_model.motion import FRICTION_FREE
from frictionlab.results.derived import derived_columns
from frictionlab.runner.api import table_of
from frictionlab.runner.chunks import Task
from frictionlab.scene.scenes import Scenes
from frictionlab.study import MethodChoice, StudyCurve
from frictionlab.study.objects import kind_of

OF_A_MODEL = 1e-8
"""Error of the numbers of a reduced model, relative to the friction coefficient: its formulas, loops and balances."""
NO_BALANCE_HERE = "the reduced model has no answer here"
ASKED_FOR = selected([*OF_SHAPE, "model"])


class Curves:
    """The curves of models along the belt speeds of some scenes, each solved once.

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
        full = [LesserModel(each.scene, each.law) for each in models]
        new = [each for each in dict.fromkeys(full) if each not in self._known]
        if not new:
            return
        size = len(self.speeds)
        auto = MethodChoice("auto", "auto", {})
        curves = [
            StudyCurve(
                str(k),
                self._kind(each),
                each.law,
                auto,
                Scenes(each.scene, self.speeds),
                range(k * size, (k + 1) * size),
            )
            for k, each in enumerate(new)
        ]
        table = table_of(curves, self._task)
        for curve, each in zip(curves, new, strict=True):
            self._known[each] = table.iloc[curve.rows.start : curve.rows.stop].reset_index(drop=True)

    def of(self, model: LesserModel) -> pd.DataFrame:
        """The table of a model, a row per belt speed."""
        self.solve([model])
        table = self._known[LesserModel(model.scene, model.law)]
        return table if model.way is None else self._reduced(model, model.way, table)

    def _kind(self, model: LesserModel) -> str:
        return self._kinds.get(type(model.law)) or kind_of(model.law)

    def _reduced(self, model: LesserModel, way: MotionWay, full: pd.DataFrame) -> pd.DataFrame:
        """The table with the means of a reduced model in place of those of the full motion."""
        scenes = Scenes(model.scene, self.speeds)
        means = np.asarray(way.model_means(scenes, model.law)).real
        derived = derived_columns(scenes, model.law, means)
        known = np.isfinite(means)
        found = full.assign(
            mean_friction=means,
            error=np.where(
                known, OF_A_MODEL * model.law.sliding_friction(float(np.abs(self.speeds).max())), np.nan
            ),
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
