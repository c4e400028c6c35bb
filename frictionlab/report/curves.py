"""The curves of a run, a row each: where mean friction lies, its largest error; and the onsets along them."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from markupsafe import Markup

from frictionlab.columns import BELT_SPEED, belt_speed
from frictionlab.printable import with_error
from frictionlab.report.markup import symbol_html, unit_html
from frictionlab.report.tables import (
    MOST_ROWS,
    Cell,
    CurveRows,
    Grid,
    curve_rows,
    grid,
    joined_values,
    setting,
    size,
    whose,
)
from frictionlab.results.summary import mean_span, statuses
from frictionlab.results.table import swept_inputs
from frictionlab.results.words import counted


def curves_grid(table: pd.DataFrame, tolerance: float) -> Grid:
    """One line per curve: everything equal but belt speed."""
    head = [
        *("law", "method", "curve", "points"),
        Markup("mean friction {}, least … greatest").format(symbol_html("mean_friction")),
        "mean friction force [N]",
        *("largest error", "at", "kind of error", "errors above the tolerance"),
    ]
    curves = curve_rows(table, swept_inputs(table))
    rows = [
        [*who, _statuses(curve.rows), mean_span(curve.rows), _force(curve.rows), *_errors(curve, tolerance)]
        for who, curve in zip(whose(curves)[:MOST_ROWS], curves, strict=False)
    ]
    left = len(curves) - len(rows)
    return grid("Curves: everything equal but belt speed", head, rows, "curves", left=left)


def _force(rows: pd.DataFrame) -> str:
    """Where the mean force lies in a scene given in SI units."""
    return mean_span(rows, unit="_N") if "mean_friction_N" in rows else ""


def _statuses(rows: pd.DataFrame) -> str:
    return statuses(rows).replace("_", " ")


def _errors(curve: CurveRows, tolerance: float) -> list[Cell]:
    """The largest error and where it is, of which kind the errors are, how many are above the tolerance."""
    error = curve.rows["error"]
    if error.isna().all():
        return [""] * 4
    worst = curve.rows.loc[error.idxmax()]
    speed = belt_speed(worst.index)
    above = int((error > tolerance).sum())
    kinds = joined_values(curve.rows.loc[error.notna(), "error_kind"].dropna())
    return [
        size(float(error.max())),
        setting(speed, worst[speed]),
        kinds,
        counted(above, "point") if above else "",
    ]


def onset_grid(onsets: pd.DataFrame, table: pd.DataFrame) -> Grid:
    """The onsets of onsets.csv, each with its error, curve by curve."""
    scales = speed_scales(table)
    curves = curve_rows(onsets.head(MOST_ROWS), _told(table, onsets))
    rows = [
        [*who, row["onset"].replace("_", " "), _at(row, scales.get(curve.key, 1.0)), row["how"]]
        for who, curve in zip(whose(curves), curves, strict=True)
        for _, row in curve.rows.iterrows()
    ]
    speed = Markup("belt speed{}").format(unit_html(belt_speed(table)))
    head = ["law", "method", "curve", "what", speed, "how it was found"]
    return grid("Onsets along rising belt speed", head, rows, "onsets", "onsets.csv", len(onsets) - len(rows))


def _at(row: pd.Series, scale: float) -> str:
    return in_given_units(row, "belt_speed", scale)


def _told(table: pd.DataFrame, others: pd.DataFrame) -> Sequence[str]:
    return [name for name in swept_inputs(table) if name in others]


def in_given_units(row: pd.Series, name: str, scale: float) -> str:
    """A belt speed of a row with its error, in the units given."""
    return with_error(scale * float(row[name]), scale * float(row[f"{name}_error"]))


def speed_scales(table: pd.DataFrame) -> dict[str, float]:
    """Of each curve by its key a belt speed in the units given over the nondimensional one; none where it is that."""
    if belt_speed(table) == BELT_SPEED:
        return {}
    return {curve.key: _scale(curve.rows) for curve in curve_rows(table, swept_inputs(table))}


def _scale(rows: pd.DataFrame) -> float:
    ratios = rows[belt_speed(rows)] / rows[BELT_SPEED]
    known = ratios[ratios.abs() < float("inf")].dropna()
    return 1.0 if known.empty else float(known.median())
