"""The table of onsets of a run: the belt speeds at which its motions change their kind."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frictionlab.columns import ONSETS
from frictionlab.methods.base import Answers
from frictionlab.results.curve_table import curve_inputs
from frictionlab.results.table import slice_of
from frictionlab.runner.chunks import Chunk, Task
from frictionlab.runner.solve import answer
from frictionlab.scene.scenes import Scenes
from frictionlab.study import Study, StudyCurve

if TYPE_CHECKING:
    from frictionlab.onsets.curve import Onset

READ_FOR_ONSETS = ("status", "stick_fraction", "reversals")
"""The result columns from which onsets are bracketed."""
_FEWEST = 2000
"""CurveMotions of all curves together, however few points a run has."""
_SHARE = 8
"""Points of a run for each motion that is solved for, where they are many."""


def onset_table(study: Study, table: pd.DataFrame) -> pd.DataFrame:
    """One row per onset of the curves of sliding laws, curve by curve in the order of the study.

    table: that of the run, or its inputs and ``READ_FOR_ONSETS``; without these columns there are no rows. Onsets are
    found between the belt speeds > 0 of a curve.
    """
    keys = curve_inputs(table.columns)
    curves = [each for each in study.curves() if _has_onsets(each)]
    if not set(READ_FOR_ONSETS) <= set(table.columns) or not curves or not len(table):
        return _frame([], [], keys)
    points = sum(len(each.rows) for each in curves)
    most = max(_FEWEST, points // _SHARE) // len(curves)
    found, heads = [], []
    for each in curves:
        own = _onsets(each, table.iloc[slice_of(each.rows)], study.tolerance, most)
        found += own
        heads += [each.rows.start] * len(own)
    return _frame(found, heads, keys, table)


def _has_onsets(curve: StudyCurve) -> bool:
    """Whether a mass is driven against friction without memory, at more than one belt speed."""
    scene = curve.scenes.scene
    driven = scene.degrees_of_freedom > 0 and not scene.undriven
    return driven and len(curve.rows) > 1 and curve.given_law.memory_kind == "none"


def _onsets(curve: StudyCurve, rows: pd.DataFrame, tolerance: float, most: int) -> list[Onset]:
    from frictionlab.onsets.curve import KnownRow, onsets_along  # brings numba: only where it is needed
    from frictionlab.onsets.motions import CurveMotions

    speeds = curve.scenes.belt_speeds
    stick, reversals = (rows[name].to_numpy(dtype=float) for name in READ_FOR_ONSETS[1:])
    usable = (
        (rows["status"] == "ok").to_numpy() & (speeds > 0.0) & np.isfinite(stick) & np.isfinite(reversals)
    )
    known = {
        float(speeds[i]): KnownRow(float(speeds[i]), stick[i] > 0.0, stick[i] > 0.0 or reversals[i] > 0.0)
        for i in np.flatnonzero(usable).tolist()
    }
    ascending = [known[speed] for speed in sorted(known)]
    scene, law, method = curve.scenes.scene, curve.law, curve.method.method
    solve = partial(_solved, curve, tolerance)
    seconds = method.cost(scene, law, tolerance) if method.resolves_events else math.inf
    return onsets_along(CurveMotions(scene, law, solve, seconds), ascending, most)


def _solved(curve: StudyCurve, tolerance: float, scenes: Scenes) -> list[tuple[Answers, int]]:
    """The answers of every scene, as for the points of the table."""
    rows = np.arange(len(scenes))
    pieces = answer(Chunk(rows, scenes, curve.law, curve.method.method, Task(tolerance)))
    places = {place: (each.answers, i) for each in pieces for i, place in enumerate(each.places)}
    return [places[i] for i in range(len(scenes))]


def _frame(
    found: list[Onset], heads: list[int], keys: list[str], table: pd.DataFrame | None = None
) -> pd.DataFrame:
    columns = zip(*found, strict=True) if found else [[] for _ in ONSETS]
    own = pd.DataFrame(dict(zip(ONSETS, columns, strict=True)))
    if table is None or not found:
        return pd.DataFrame(columns=[*keys, *ONSETS])
    return pd.concat([table.loc[:, keys].iloc[heads].reset_index(drop=True), own], axis=1)
