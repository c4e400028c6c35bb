"""A comparison at a glance, for notebooks: a small table of its curves, each drawn in its row."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import pandas as pd
from markupsafe import Markup

from frictionlab.report.page import rendered
from frictionlab.report.tables import Cell, grid, number, word_html
from frictionlab.runner.summary import mean_span, statuses
from frictionlab.runner.table import swept_inputs
from frictionlab.values.columns import belt_speed

MOST_CURVES = 20
WIDTH, HEIGHT = 120.0, 28.0
"""Size of a drawing [pixels]."""


def preview_html(table: pd.DataFrame, curves: pd.DataFrame) -> str:
    """A row per curve: law, method, what is swept, its mean friction drawn, smallest and largest, verdict, status."""
    keys = ["law", "method", *swept_inputs(table)]
    groups = [rows for _, rows in table.groupby(keys, sort=False, dropna=False)]
    columns: dict[Cell, Callable[[pd.DataFrame], Cell]] = {
        **{word_html(name): partial(_value, name) for name in keys},
        "mean friction": _drawing,
        "least … greatest": mean_span,
        "shape": lambda rows: _shape(rows.iloc[0], curves),
        "points": statuses,
    }
    left = len(groups) - MOST_CURVES
    shown = grid("Curves", columns, groups[:MOST_CURVES])
    return rendered("preview.html", grid=shown._replace(below=f"and {left} more curves" if left > 0 else ""))


def _value(name: str, rows: pd.DataFrame) -> Cell:
    return number(rows[name].iloc[0])


def _shape(row: pd.Series, curves: pd.DataFrame) -> str:
    """Return the verdict on the curve of a row; '' where it is on none."""
    shared = [name for name in curves.columns if name in row.index and name not in ("reason", "model")]
    alike = curves[(curves[shared].fillna("") == row[shared].fillna("")).all(axis=1)]
    return "".join(alike.get("shape", pd.Series(dtype=str)).dropna().iloc[:1])


def _drawing(rows: pd.DataFrame) -> Markup:
    """Mean friction over belt speed as a line of an SVG drawing, from zero up; nothing without two points."""
    speed = belt_speed(rows.columns)
    told = rows[[speed, "mean_friction"]].dropna().sort_values(speed) if speed in rows else rows.iloc[:0]
    if len(told) < 2:
        return Markup("")
    x, y = told[speed].to_numpy(float), told["mean_friction"].to_numpy(float)
    low, high = min(0.0, float(y.min())), max(float(y.max()), 1e-300)
    across = WIDTH * (x - x[0]) / max(float(x[-1] - x[0]), 1e-300)
    up = HEIGHT * (1.0 - (y - low) / (high - low))
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(across, up, strict=True))
    line = f'<polyline points="{points}" fill="none" stroke="currentColor" stroke-width="1.5"/>'
    size = f'width="{WIDTH:g}" height="{HEIGHT:g}" viewBox="-1 -1 {WIDTH + 2:g} {HEIGHT + 2:g}"'
    return Markup(f"<svg {size}>{line}</svg>")
