"""A comparison at a glance, for notebooks: a small table of its curves, each drawn in its row."""

from __future__ import annotations

from html import escape
from typing import Any

import pandas as pd

from frictionlab.runner.summary import mean_span
from frictionlab.runner.table import swept_inputs
from frictionlab.runner.words import in_words
from frictionlab.scene.dimensional import without_unit
from frictionlab.values.columns import SHOWN_IN, belt_speed

MOST_CURVES = 20
WIDTH, HEIGHT = 120.0, 28.0
"""Of a drawing [pixels]."""


def preview_html(table: pd.DataFrame, curves: pd.DataFrame) -> str:
    """A row per curve: law, method, what is swept, its mean friction drawn, smallest and largest, verdict, status."""
    keys = ["law", "method", *swept_inputs(table)]
    groups = list(table.groupby(keys, sort=False, dropna=False))
    heads = [
        *map(_head, keys),
        "mean friction",
        "least … greatest",
        "shape",
        "points",
    ]
    rows = [_row(dict(zip(keys, key, strict=True)), rows, curves) for key, rows in groups[:MOST_CURVES]]
    more = f"<p>and {len(groups) - MOST_CURVES} more curves</p>" if len(groups) > MOST_CURVES else ""
    head = "".join(f"<th>{escape(each)}</th>" for each in heads)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table>{more}"


def _head(name: str) -> str:
    """An input without what all inputs of a scene begin with, and its unit."""
    inside, _, unit = name.removeprefix("scene.").partition(SHOWN_IN)
    return f"{without_unit(inside.removeprefix('dimensional.'))} [{unit}]" if unit else inside


def _row(inputs: dict[str, Any], rows: pd.DataFrame, curves: pd.DataFrame) -> str:
    statuses = ", ".join(f"{count} {status}" for status, count in rows["status"].value_counts().items())
    words = [
        *(str(inputs.pop(name)) for name in ("law", "method")),
        *(in_words(each) for each in inputs.values()),
    ]
    shape = _shape(rows.iloc[0], curves)
    cells = [*map(escape, words), _drawing(rows), mean_span(rows), escape(shape), escape(statuses)]
    return f"<tr>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"


def _shape(row: pd.Series, curves: pd.DataFrame) -> str:
    """The verdict on the curve of a row; '' where it is on none."""
    shared = [name for name in curves.columns if name in row.index and name not in ("reason", "model")]
    for _, curve in curves.iterrows():
        if all(curve[name] == row[name] or (pd.isna(curve[name]) and pd.isna(row[name])) for name in shared):
            return "" if pd.isna(curve["shape"]) else str(curve["shape"])
    return ""


def _drawing(rows: pd.DataFrame) -> str:
    """Mean friction over belt speed as a line of an SVG drawing, from zero up; nothing without two points."""
    speed = belt_speed(rows.columns)
    told = rows[[speed, "mean_friction"]].dropna().sort_values(speed) if speed in rows else rows.iloc[:0]
    if len(told) < 2:
        return ""
    x, y = told[speed].to_numpy(float), told["mean_friction"].to_numpy(float)
    low, high = min(0.0, float(y.min())), max(float(y.max()), 1e-300)
    across = WIDTH * (x - x[0]) / max(float(x[-1] - x[0]), 1e-300)
    up = HEIGHT * (1.0 - (y - low) / (high - low))
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(across, up, strict=True))
    line = f'<polyline points="{points}" fill="none" stroke="currentColor" stroke-width="1.5"/>'
    return f'<svg width="{WIDTH:g}" height="{HEIGHT:g}" viewBox="-1 -1 {WIDTH + 2:g} {HEIGHT + 2:g}">{line}</svg>'
