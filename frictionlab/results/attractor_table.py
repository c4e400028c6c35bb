"""The table of attractors: every state that motions end in along the curves of a study, a row per Poincare point.

Of a study that does not ask for it, a row per state of the points that have several.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd

from frictionlab.columns import ALSO_IN_SI, ATTRACTORS, BELT_SPEED, OF_STATES
from frictionlab.methods.base import STATISTICAL, FoundState
from frictionlab.results.curve_table import curve_inputs
from frictionlab.results.derived import beside_in_si
from frictionlab.results.part import STATE_NUMBERS, KeptRows
from frictionlab.results.table import Inputs, inputs, scales_of_row
from frictionlab.study import StudyCurve


def attractor_table(curves: Sequence[StudyCurve], tolerance: float, starts: int) -> pd.DataFrame:
    """Of all curves whose method follows motions to wherever they end, by so many starts at each belt speed."""
    given = inputs(curves)
    keys = curve_inputs(given.columns)
    rows = [row for curve in curves for row in _rows(curve, given, keys, tolerance, starts)]
    in_si = [ALSO_IN_SI[name][0] for name in ATTRACTORS if name in ALSO_IN_SI and given.scales is not None]
    return pd.DataFrame(rows, columns=[*keys, *ATTRACTORS, *in_si])


def states_table(given: Inputs, states: KeptRows) -> pd.DataFrame:
    """Of points that have several states a row each; states: by row of the result table."""
    keys = curve_inputs(given.columns)
    frames = []
    for row, columns in sorted(states.items()):
        head = {name: given.columns[name][row] for name in keys}
        numbers = np.arange(1, 1 + len(columns["period"]))
        kinds = map(_error_kind, columns["error"].tolist(), columns["period"].tolist())
        own = {
            "belt_speed": given.columns[BELT_SPEED][row],
            "state": numbers,
            "error_kind": [*kinds],
            **columns,
        }
        own["period"] = columns["period"].astype(int)
        beside = beside_in_si(own, scales_of_row(given, row))
        frames.append(pd.DataFrame(head | {name: own[name] for name in OF_STATES} | beside))
    return pd.concat(frames, ignore_index=True) if frames else pd.DataFrame(columns=[*keys, *OF_STATES])


def _error_kind(error: float, period: float) -> str:
    if math.isnan(error):
        return ""
    return "estimated" if period else STATISTICAL


def _rows(
    curve: StudyCurve, given: Inputs, keys: Sequence[str], tolerance: float, starts: int
) -> Iterator[dict[str, Any]]:
    head = {name: given.columns[name][curve.rows[0]] for name in keys}
    units = scales_of_row(given, curve.rows[0])
    speeds, places = np.unique(curve.scenes.belt_speeds, return_index=True)
    scenes, law, method = curve.scenes.taken(places), curve.law, curve.method.method
    if method.refusal(scenes[0], law) is not None:
        return
    numbers = dict.fromkeys(range(len(speeds)), 0)
    for state in method.states(scenes, law, tolerance, starts):
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
