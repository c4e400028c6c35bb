"""Figures of kept harmonics: amplitudes along a sweep, a picture for each harmonic, a line for each law."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pandas as pd
from matplotlib.figure import Figure

from frictionlab.charts.curve_figure import CurveFigure
from frictionlab.charts.curves import MOST_PICTURES, Family, family_by
from frictionlab.charts.sheet import Heading, part_told
from frictionlab.charts.sweeps import sweep_of
from frictionlab.columns import BELT_SPEED
from frictionlab.study.figure_options import FigureOptions

HARMONIC = "harmonic"
AMPLITUDES = {
    "velocity_harmonics": ("velocity_amplitude", "amplitude of the harmonic\nof the velocity"),
    "friction_harmonics": ("friction_amplitude", "amplitude of the harmonic\nof the friction coefficient"),
}


def harmonic_figures(
    harmonics: pd.DataFrame, heading: Heading, options: FigureOptions
) -> dict[str, Callable[[], Figure]]:
    """What draws each, by its name; none where nothing is swept. harmonics: of ``harmonics.csv``, means left out."""
    family = _family(harmonics)
    if family is None:
        return {}
    orders = list(dict.fromkeys(dict(panel)[HARMONIC] for panel in family.panels))
    most = orders[: max(1, MOST_PICTURES * len(orders) // len(family.panels))]
    first = replace(family, curves=[curve for curve in family.curves if dict(curve.panel)[HARMONIC] in most])
    told = part_told(len(most), len(orders), "harmonics")
    return {
        name: CurveFigure(first, [column], heading, None, options, {column: label}, more=told).draw
        for name, (column, label) in AMPLITUDES.items()
    }


def _family(harmonics: pd.DataFrame) -> Family | None:
    rows = harmonics[harmonics[HARMONIC] > 0].rename(columns={"belt_speed": BELT_SPEED})
    rows = rows.assign(status="ok", **{HARMONIC: rows[HARMONIC].astype(float)})
    sweep = sweep_of(rows)
    others = [name for name in sweep.inputs if name != sweep.along]
    apart = others if rows["law"].nunique() == 1 else [name for name in others if name.startswith("law.")]
    member = apart[-1] if apart else None
    return family_by(rows, sweep, [HARMONIC, *(name for name in others if name != member)], member)
