"""Onsets are marked on the axis of belt speed, each on its own curve, in the units of the axis."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from frictionlab.charts import figures
from frictionlab.charts.curve_figure import CurveFigure
from frictionlab.charts.curves import family_of
from frictionlab.charts.onsets import SIGNS, onset_entries, onsets_on

SPEEDS = np.linspace(1.0, 60.0, 12)


def curve(mu: float, si: bool = False) -> pd.DataFrame:
    given = {"scene.dimensional.belt_speed_m_per_s": 0.01 * SPEEDS} if si else {}
    inputs = {
        "law": "coulomb",
        "kind": "coulomb",
        "method": "exact",
        "law.mu": mu,
        "scene.belt_speed": SPEEDS,
    }
    found = {
        "mean_friction": mu * np.minimum(SPEEDS / 50.0, 1.0),
        "error": 1e-12,
        "status": "ok",
        "reason": "",
    }
    numbers = dict.fromkeys(
        ("velocity_amplitude", "transverse_velocity_amplitude", "velocity_ratio", "mean_low"), np.nan
    )
    energies = dict.fromkeys(
        (f"energy_{what}" for what in ("input", "viscous", "friction", "contact")), np.nan
    )
    return pd.DataFrame(inputs | given | found | numbers | energies | {"normalized_friction": np.nan})


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
    family = family_of(TABLE)
    assert family is not None

    marks = {one.rows["law.mu"].iloc[0]: onsets_on(one, ONSETS) for one in family.curves}

    assert marks[0.2] == [("reversal_ends", 50.0)]
    assert marks[0.4] == [("stick_begins", 44.0), ("stick_ends", 50.0)]


def test_marks_lie_in_the_units_of_the_axis() -> None:
    table = pd.concat([curve(0.2, si=True), curve(0.4, si=True)], ignore_index=True)
    family = family_of(table)
    assert family is not None

    (mark,) = onsets_on(family.curves[0], ONSETS)
    assert mark.at == pytest.approx(0.5)


def test_a_figure_draws_them_and_names_each_kind_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[tuple[float, str]] = []
    plot = Axes.plot

    def noted(self: Axes, *arguments: object, **look: object) -> list[Line2D]:
        if len(arguments) == 3 and arguments[2] in SIGNS.values():
            drawn.append((arguments[0][0], str(arguments[2])))  # type: ignore[index]  # a list of places
        return plot(self, *arguments, **look)  # type: ignore[arg-type]  # as they were given

    monkeypatch.setattr(Axes, "plot", noted)
    figures.draw_figures(figures.FigureData(TABLE, "Two curves", ONSETS), tmp_path)

    assert sorted(drawn) == [(44.0, ">"), (50.0, "<"), (50.0, "d")]
    family = family_of(TABLE)
    assert family is not None
    legend = onset_entries([mark for one in family.curves for mark in onsets_on(one, ONSETS)])
    assert [entry.get_label() for entry in legend] == ["stick begins", "stick ends", "reversal ends"]


def test_the_end_of_reversal_is_not_marked_again_where_v_lin_is() -> None:
    speeds = np.linspace(1.0, 60.0, 12)
    known = curve(0.2).assign(
        velocity_ratio=speeds / 50.0, normalized_friction=np.minimum(speeds / 50.0, 1.0)
    )
    family = family_of(pd.concat([known, curve(0.4)], ignore_index=True))
    assert family is not None
    onsets = pd.concat([ONSETS, ONSETS.assign(onset="reversal_ends", belt_speed=50.0)], ignore_index=True)

    first, other = (
        CurveFigure(family, ["mean_friction"], onsets=onsets).onsets_of(one) for one in family.curves
    )

    assert first == []
    assert [mark.onset for mark in other] == ["stick_begins", "stick_ends", "reversal_ends", "reversal_ends"]
