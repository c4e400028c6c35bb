"""Figures of kept harmonics: amplitudes along a sweep, a picture for each harmonic, a line for each law."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pandas as pd
from matplotlib.figure import Figure

from frictionlab.charts.curve_figure import CurveFigure
from frictionlab.charts.curves import (
    MOST_PICTURES,
    Family,
    along_the_axis,
    family_by,
    swept_by_size,
    swept_numbers,
)
from frictionlab.columns import BELT_SPEED
from frictionlab.study.figure_options import FigureOptions

HARMONIC = "harmonic"
AMPLITUDES = {
    "velocity_harmonics": ("velocity_amplitude", "amplitude of the harmonic\nof the velocity"),
    "friction_harmonics": ("friction_amplitude", "amplitude of the harmonic\nof the friction coefficient"),
}


def harmonic_figures(
    harmonics: pd.DataFrame, title: str, options: FigureOptions
) -> dict[str, Callable[[], Figure]]:
    """What draws each, by its name; none where nothing is swept. harmonics: of ``harmonics.csv``, means left out."""
    family = _family(harmonics)
    if family is None:
        return {}
    orders = list(dict.fromkeys(dict(panel)[HARMONIC] for panel in family.panels))
    most = orders[: max(1, MOST_PICTURES * len(orders) // len(family.panels))]
    shown = [curve for curve in family.curves if dict(curve.panel)[HARMONIC] in most]
    told = f"{len(most)} of {len(orders)} harmonics" if len(most) < len(orders) else ""
    first = replace(family, curves=shown)
    return {
        name: CurveFigure(first, [column], title, None, options, {column: label}, left_out=told).draw
        for name, (column, label) in AMPLITUDES.items()
    }


def _family(harmonics: pd.DataFrame) -> Family | None:
    rows = harmonics[harmonics[HARMONIC] > 0].rename(columns={"belt_speed": BELT_SPEED})
    rows = rows.assign(status="ok", **{HARMONIC: rows[HARMONIC].astype(float)})
    numbers = swept_numbers(rows)
    if not numbers:
        return None
    abscissa = along_the_axis(rows, numbers)
    others = [name for name in swept_by_size(rows) if name != abscissa]
    apart = others if rows["law"].nunique() == 1 else [name for name in others if name.startswith("law.")]
    member = apart[-1] if apart else None
    return family_by(rows, abscissa, [HARMONIC, *(name for name in others if name != member)], member)
