"""Onsets are marked on the axis of belt speed, each on its own curve, in the units of the axis."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
import pytest
from drawn_figures import NOTHING, drawn, legend_of

from frictionlab.charts.curves import CurveData, family_of
from frictionlab.charts.marks import SIGNS, onsets_on

SPEEDS = np.linspace(1.0, 60.0, 12)


def curve(mu: float, si: bool = False) -> pd.DataFrame:
    given = {"scene.dimensional.belt_speed_m_per_s": 0.01 * SPEEDS} if si else {}
    names = {"law": "coulomb", "kind": "coulomb", "method": "exact", "status": "ok", "reason": ""}
    means = {"mean_friction": mu * np.minimum(SPEEDS / 50.0, 1.0), "error": 1e-12}
    return pd.DataFrame(NOTHING | names | {"law.mu": mu, "scene.belt_speed": SPEEDS} | given | means)


def curves_in(*tables: pd.DataFrame) -> Sequence[CurveData]:
    family = family_of(pd.concat(tables, ignore_index=True))
    assert family is not None
    return family.curves


TABLE = pd.concat([curve(0.2), curve(0.4)], ignore_index=True)
ONSETS = pd.DataFrame(
    [
        ("coulomb", "coulomb", "exact", 0.4, "stick_begins", 44.0, 1e-6, "so"),
        ("coulomb", "coulomb", "exact", 0.4, "stick_ends", 50.0, 1e-6, "so"),
        ("coulomb", "coulomb", "exact", 0.2, "reversal_ends", 50.0, 1e-6, "so"),
    ],
    columns=["law", "kind", "method", "law.mu", "onset", "belt_speed", "belt_speed_error", "how"],
)


def test_every_curve_has_its_own_onsets() -> None:
    marks = {one.rows["law.mu"].iloc[0]: onsets_on(one, ONSETS) for one in curves_in(TABLE)}

    assert marks[0.2] == [("reversal_ends", 50.0)]
    assert marks[0.4] == [("stick_begins", 44.0), ("stick_ends", 50.0)]


def test_marks_lie_in_the_units_of_the_axis() -> None:
    first, _ = curves_in(curve(0.2, si=True), curve(0.4, si=True))

    (mark,) = onsets_on(first, ONSETS)
    assert mark.at == pytest.approx(0.5)


def test_a_figure_draws_them_and_names_each_kind_once() -> None:
    figure = drawn(TABLE, onsets=ONSETS)

    marks = [line for line in figure.axes[0].lines if line.get_marker() in SIGNS.values()]
    places = [(line.get_xdata()[0], line.get_marker()) for line in marks if len(line.get_xdata()) == 1]
    assert sorted(places) == [(44.0, ">"), (50.0, "<"), (50.0, "d")]
    assert legend_of(figure)[-3:] == ["stick begins", "stick ends", "reversal ends"]


def test_the_end_of_reversal_is_not_marked_again_where_v_lin_is() -> None:
    ratio = SPEEDS / 50.0
    known = curve(0.2).assign(velocity_ratio=ratio, normalized_friction=np.minimum(ratio, 1.0))
    onsets = pd.concat([ONSETS, ONSETS.assign(onset="reversal_ends", belt_speed=50.0)], ignore_index=True)

    first, other = (onsets_on(one, onsets) for one in curves_in(known, curve(0.4)))

    assert first == []
    assert [mark.onset for mark in other] == ["stick_begins", "stick_ends", "reversal_ends", "reversal_ends"]
