"""What a legend says: what tells curves apart, which methods share a line, and what has no number."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pandas as pd
from matplotlib.lines import Line2D

from frictionlab.charts.curves import CurveData
from frictionlab.charts.looks import Looks
from frictionlab.charts.sweeps import BESIDE, LONGEST_LABEL, shortened

WITHOUT_NUMBER = {"failed": "x", "killed": "x", "refused": "|"}
LEGEND_MARKS = WITHOUT_NUMBER | {"not_unique": r"$\mathrm{I}$"}


def curve_entries(looks: Looks, columns: Sequence[str]) -> list[Line2D]:
    """One entry per look that is drawn; of a long family only values spread over it."""
    if math.prod(looks.sizes) == 1 and not any(curve.same for curve in looks.curves):
        return []
    seen = [*columns, *(["mean_low"] if "mean_friction" in columns else [])]
    labels: dict[tuple[int, int, int], tuple[CurveData, list[str]]] = {}
    for curve in looks.curves:
        if curve.place[1] in looks.shown and curve.rows[seen].notna().any(axis=None):
            _, methods = labels.setdefault(curve.place, (curve, [curve.method]))
            methods += [name for name in curve.same if name not in methods]
    several = looks.sizes[2] > 1 or any(len(methods) > 1 for _, methods in labels.values())
    return [
        Line2D([], [], label=_label(looks, curve, methods if several else []), **looks.sample(curve))
        for _, (curve, methods) in sorted(labels.items())
    ]


def _label(looks: Looks, curve: CurveData, methods: Sequence[str]) -> str:
    several_laws = looks.sizes[0] > 1
    room = BESIDE if several_laws and methods else LONGEST_LABEL
    told = [shortened(curve.law, room)] if several_laws else []
    if methods:
        told.append(joined_methods(methods, room))
    if curve.member is not None and curve.member.value is not None:
        told.append(curve.member.text)
    return ", ".join(told)


def joined_methods(methods: Sequence[str], room: int = BESIDE) -> str:
    """The names of methods that share a line."""
    names = [shortened(name, room) for name in methods]
    together = " = ".join(names)
    return together if len(together) <= 2 * room else f"{names[0]} = {len(names) - 1} others"


def status_entries(table: pd.DataFrame) -> list[Line2D]:
    """One entry per method and status that gives no number, with how many points it has."""
    counts = table.groupby("method", sort=False)["status"].value_counts()
    entries = []
    for method in table["method"].unique():
        of_method = f" ({shortened(str(method), BESIDE)})" if table["method"].nunique() > 1 else ""
        for status, mark in LEGEND_MARKS.items():
            if count := counts.get((method, status), 0):
                points = "1 point" if count == 1 else f"{count} points"
                label = f"{points} {status.replace('_', ' ')}{of_method}"
                entries.append(Line2D([], [], color="0.3", linestyle="none", marker=mark, label=label))
    return entries
