"""Tables beside the main one: onsets, attractors, harmonics.

The table of onsets of a run: the belt speeds at which its motions change their kind.

The table of attractors: every state that motions end in along the curves of a study, a row per Poincare point.

Of a study that does not ask for it, a row per state of the points that have several.

The table of harmonics: of every kept orbit velocity and friction by harmonics, a row each.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import pyarrow as pa

from frictionlab.methods.base import STATISTICAL, Answers, FoundState, in_own_lengths
from frictionlab.runner.curve_table import curve_inputs
from frictionlab.runner.part import STATE_NUMBERS, beside_in_si
from frictionlab.runner.pieces import Chunk, Task
from frictionlab.runner.solve import answer
from frictionlab.runner.table import Inputs, inputs, kept_rows, slice_of
from frictionlab.runner.words import column_in_si_words
from frictionlab.scene.scenes import Scenes
from frictionlab.study.grid import StudyCurve
from frictionlab.study.study import Study
from frictionlab.values.columns import (
    ALSO_IN_SI,
    ATTRACTORS,
    BELT_SPEED,
    HARMONICS,
    OF_REST,
    OF_STATES,
    ONSETS,
)

if TYPE_CHECKING:
    from frictionlab.curves.onsets import Onset


READ_FOR_ONSETS = frozenset(OF_REST)
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


def _is_followed(curve: StudyCurve) -> bool:
    """Check whether a mass on a spring is driven, at more than one belt speed."""
    scene = curve.scenes.scene
    return scene.degrees_of_freedom > 0 and not scene.undriven and not scene.is_free and len(curve.rows) > 1


def _onsets(curve: StudyCurve, rows: pd.DataFrame, tolerance: float, most: int) -> list[Onset]:
    if curve.given_law.memory_kind != "none" or not set(OF_REST) <= set(rows.columns):
        return []
    from frictionlab.curves.motions import CurveMotions
    from frictionlab.curves.onsets import KnownRow, onsets_along  # brings numba: only where it is needed

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


def _solved(curve: StudyCurve, tolerance: float, scenes: Scenes) -> list[tuple[Answers, int]]:
    """Return the answers of every scene."""
    found = answer(Chunk(scenes, curve.law, curve.method.method, Task(tolerance)))
    places = {place: (each.answers, i) for each in found for i, place in enumerate(each.places)}
    return [places[i] for i in range(len(scenes))]


def _frame(
    found: list[Onset], heads: list[int], keys: list[str], table: pd.DataFrame | None = None
) -> pd.DataFrame:
    columns = zip(*found, strict=True) if found else [[] for _ in ONSETS]
    own = pd.DataFrame(dict(zip(ONSETS, columns, strict=True)))
    if table is None or not found:
        return pd.DataFrame(columns=[*keys, *ONSETS])
    return pd.concat([table.loc[:, keys].iloc[heads].reset_index(drop=True), own], axis=1)


def attractor_table(curves: Sequence[StudyCurve], tolerance: float, starts: int) -> pd.DataFrame:
    """Find the states of curves whose method follows motions to their ends, from so many starts a belt speed."""
    given = inputs(curves)
    keys = curve_inputs(given.columns)
    rows = [row for curve in curves for row in _rows(curve, given, keys, tolerance, starts)]
    in_si = [ALSO_IN_SI[name][0] for name in ATTRACTORS if name in ALSO_IN_SI and given.scales is not None]
    return pd.DataFrame(rows, columns=[*keys, *ATTRACTORS, *in_si])


def states_table(given: Inputs, answers: pa.Table) -> pd.DataFrame:
    """Return a row for each state of points that have several."""
    found = kept_rows(answers, "states", given)
    if found.empty:
        return pd.DataFrame(columns=[*curve_inputs(given.columns), *OF_STATES])
    found["state"] = found.groupby("row").cumcount() + 1
    found["error_kind"] = [*map(_error_kind, found["error"].tolist(), found["period"].tolist())]
    found["period"] = found["period"].astype(int)
    return _beside_inputs(given, found, OF_STATES)


def harmonic_table(given: Inputs, answers: pa.Table) -> pd.DataFrame:
    """Return the inputs that are equal along a curve, the belt speed, then ``HARMONICS``, in the order of the table.

    Columns across the belt are left out where no orbit has them.
    """
    found = kept_rows(answers, "harmonics", given)
    if len(found.columns) == 1:
        return pd.DataFrame(columns=[*curve_inputs(given.columns), *HARMONICS])
    found["harmonic"] = found["harmonic"].astype(int)
    return _beside_inputs(given, found, HARMONICS)


def _beside_inputs(given: Inputs, found: pd.DataFrame, order: Iterable[str]) -> pd.DataFrame:
    """Return what is kept, its inputs and belt speed before it, columns in SI units last."""
    rows = found.pop("row").to_numpy()
    heads = {name: given.columns[name][rows] for name in curve_inputs(given.columns)}
    speeds = pd.DataFrame({"belt_speed": given.columns[BELT_SPEED][rows]})
    own = pd.concat([speeds, found, pd.DataFrame(beside_in_si(speeds, given.scales_of(rows)))], axis=1)
    names = dict.fromkeys([*(name for name in order if name in own), *own.columns])
    return pd.DataFrame(heads | {name: own[name] for name in names})


def _error_kind(error: float, period: float) -> str:
    if math.isnan(error):
        return ""
    return "estimated" if period else STATISTICAL


def _rows(
    curve: StudyCurve, given: Inputs, keys: Sequence[str], tolerance: float, starts: int
) -> Iterator[dict[str, Any]]:
    head = {name: given.columns[name][curve.rows[0]] for name in keys}
    units = given.scales_of(curve.rows[0])
    speeds, places = np.unique(curve.scenes.belt_speeds, return_index=True)
    scenes, law, method = curve.scenes.taken(places), curve.law, curve.method.method
    if scenes.scene.is_free or method.refusal(scenes[0], law) is not None:
        return
    numbers = dict.fromkeys(range(len(speeds)), 0)
    for state in in_own_lengths(method.states, scenes, law, tolerance, starts):
        numbers[state.place] += 1
        for point in range(len(state.x)):
            own = _row(state, point, float(speeds[state.place]), numbers[state.place])
            yield head | own | beside_in_si(own, units)


def _row(state: FoundState, point: int, speed: float, number: int) -> dict[str, Any]:
    return {
        "belt_speed": speed,
        "state": number,
        "error_kind": _error_kind(state.error, state.period),
        **{name: getattr(state, field) for name, field in STATE_NUMBERS.items()},
        "point": point + 1,
        "x": float(state.x[point]),
        "velocity": float(state.velocity[point]),
        "found_from": state.found_from,
    }
