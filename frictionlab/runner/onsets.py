"""The table of onsets of a run: the belt speeds at which its motions change their kind."""

from __future__ import annotations

import math
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frictionlab.columns import OF_MULTIPLIERS, OF_REST, ONSETS
from frictionlab.methods.base import Answers
from frictionlab.results.curve_table import curve_inputs
from frictionlab.results.derived import beside_in_si
from frictionlab.results.sentences_in_si import column_in_si_words
from frictionlab.results.table import slice_of
from frictionlab.runner.chunks import Chunk, Task
from frictionlab.runner.solve import answer
from frictionlab.scene.scenes import Scenes
from frictionlab.study import Study, StudyCurve
from frictionlab.theory.uniqueness import is_convergent

if TYPE_CHECKING:
    from frictionlab.onsets.curve import Onset

READ_FOR_ONSETS = frozenset([*OF_REST, *OF_MULTIPLIERS])
_FEWEST = 2000
"""Motions of all curves together, however few points a run has."""
_SHARE = 8
"""Points of a run for each motion that is solved for, where they are many."""


def onset_table(study: Study, table: pd.DataFrame) -> pd.DataFrame:
    """One row per onset of the curves of driven masses, curve by curve in the order of the study.

    table: that of the run, or its inputs and ``READ_FOR_ONSETS``; what lacks columns has no rows. Onsets are
    found between the belt speeds > 0 of a curve.
    """
    keys = curve_inputs(table.columns)
    curves = [each for each in study.curves() if _is_followed(each)]
    if not curves or not len(table):
        return _frame([], [], keys)
    points = sum(len(each.rows) for each in curves)
    most = max(_FEWEST, points // _SHARE) // len(curves)
    found, heads, scales = [], [], []
    for each in curves:
        own = _onsets(each, table.iloc[slice_of(each.rows)], study.tolerance, most)
        found += own
        heads += [each.rows.start] * len(own)
        scales += [_speed_scale(each)] * len(own)
    onsets = _frame(found, heads, keys, table)
    units = {} if curves[0].scenes.scene.dimensional is None else {"velocity": np.array(scales)}
    return onsets.assign(how=column_in_si_words(onsets["how"], units), **beside_in_si(onsets, units))


def _speed_scale(curve: StudyCurve) -> float:
    si = curve.scenes.scene.dimensional
    return 1.0 if si is None else si.scales.velocity


def lacks_multipliers(study: Study, table: pd.DataFrame) -> bool:
    """Whether onsets of multipliers would be missed, since the table was not asked for what they are found from."""
    return not set(OF_MULTIPLIERS) <= set(table.columns) and any(
        _is_followed(each) and _may_lose_stability(each) for each in study.curves()
    )


def _is_followed(curve: StudyCurve) -> bool:
    """Whether a mass is driven, at more than one belt speed."""
    scene = curve.scenes.scene
    return scene.degrees_of_freedom > 0 and not scene.undriven and len(curve.rows) > 1


def _onsets(curve: StudyCurve, rows: pd.DataFrame, tolerance: float, most: int) -> list[Onset]:
    found = []
    if curve.given_law.memory_kind == "none" and set(OF_REST) <= set(rows.columns):
        found += _onsets_of_rest(curve, rows, tolerance, most)
    if _may_lose_stability(curve) and set(OF_MULTIPLIERS) <= set(rows.columns):
        found += _onsets_of_multipliers(curve, rows, tolerance, most)
    return found


def _onsets_of_rest(curve: StudyCurve, rows: pd.DataFrame, tolerance: float, most: int) -> list[Onset]:
    from frictionlab.onsets.curve import KnownRow, onsets_along  # brings numba: only where it is needed
    from frictionlab.onsets.motions import CurveMotions

    speeds = curve.scenes.belt_speeds
    stick, reversals = (rows[name].to_numpy(dtype=float) for name in OF_REST[1:])
    known = {
        float(speeds[i]): KnownRow(float(speeds[i]), stick[i] > 0.0, stick[i] > 0.0 or reversals[i] > 0.0)
        for i in np.flatnonzero((rows["status"] == "ok").to_numpy() & (speeds > 0.0)).tolist()
        if math.isfinite(stick[i]) and math.isfinite(reversals[i])
    }
    ascending = [known[speed] for speed in sorted(known)]
    scene, law, method = curve.scenes.scene, curve.law, curve.method.method
    solve = partial(_solved, curve, tolerance)
    return onsets_along(CurveMotions(scene, law, solve, method.resolves_events), ascending, most)


def _may_lose_stability(curve: StudyCurve) -> bool:
    """Whether no theorem makes every motion attract, and the method closes the motion of one period."""
    scene, law = curve.scenes.scene, curve.law
    vectorial = scene.degrees_of_freedom < 2 or law.planar_form() == "vectorial"
    return curve.method.method.resolves_events and vectorial and not is_convergent(scene, law)


def _onsets_of_multipliers(curve: StudyCurve, rows: pd.DataFrame, tolerance: float, most: int) -> list[Onset]:
    from frictionlab.onsets.multipliers import MOST_CLOSED, StabilityRow, multiplier_onsets

    speeds = curve.scenes.belt_speeds
    period, modulus = (rows[name].to_numpy(dtype=float) for name in OF_MULTIPLIERS[1:])
    ok = (rows["status"] == "ok").to_numpy()
    attracts = ok & (period == curve.scenes.scene.periods) & ~(modulus >= 1.0)
    # where motions end on an orbit of several periods, or never repeat, that of one period does not attract
    answered = (ok | (rows["status"] == "not_unique").to_numpy() | (modulus >= 1.0)) & (speeds > 0.0)
    known = {
        float(speeds[i]): StabilityRow(float(speeds[i]), bool(attracts[i])) for i in np.flatnonzero(answered)
    }
    changes = sum(one.attracts != other.attracts for one, other in pairwise(known[v] for v in sorted(known)))
    if not changes or most < MOST_CLOSED * changes:
        return []
    return multiplier_onsets(
        curve.scenes.scene, curve.law, tolerance, [known[speed] for speed in sorted(known)]
    )


def _solved(curve: StudyCurve, tolerance: float, scenes: Scenes) -> list[tuple[Answers, int]]:
    """The answers of every scene."""
    pieces = answer(Chunk(np.arange(len(scenes)), scenes, curve.law, curve.method.method, Task(tolerance)))
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
