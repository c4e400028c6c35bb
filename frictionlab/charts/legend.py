"""The legend of a figure: what tells its curves apart, which methods share a line, and what has no number."""

from __future__ import annotations

import math
from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.textpath import TextPath

from frictionlab.charts.curves import CurveData, Family
from frictionlab.charts.looks import Looks
from frictionlab.charts.style import LEGEND_FONT
from frictionlab.charts.words import BESIDE, LONGEST_LABEL, shortened, swept_text

WITHOUT_NUMBER = {"failed": "x", "killed": "x", "refused": "|"}
LEGEND_MARKS = WITHOUT_NUMBER | {"not_unique": r"$\mathrm{I}$"}
HANDLE = 3.5  # length of a sample of a line, long enough for its dashes [letter]


def add_legend(
    figure: Figure, family: Family, looks: Looks, columns: Sequence[str], more: Sequence[Line2D]
) -> int:
    """Below the pictures: what tells curves apart, how much has no number, and more; the lines it takes."""
    entries = [
        *curve_entries(looks, columns),
        *status_entries(pd.concat([curve.rows[["method", "status"]] for curve in family.curves])),
        *more,
    ]
    if not entries:
        return 0
    return add_entries(figure, entries, family.word(family.member) if family.member else None)


def add_entries(figure: Figure, entries: Sequence[Line2D], title: str | None = None) -> int:
    """A legend below the pictures; the lines it takes."""
    abreast = _abreast([str(entry.get_label()) for entry in entries], HANDLE, 72 * figure.get_figwidth())
    figure.legend(
        handles=entries, loc="outside lower center", ncols=abreast, title=title, handlelength=HANDLE
    )
    return math.ceil(len(entries) / abreast) + (title is not None)


def _abreast(labels: Sequence[str], handle: float, room: float) -> int:
    """The most columns of a legend whose rows fit into a width [point]; its entries run down the columns."""
    style = mpl.rcParams
    around = handle + style["legend.handletextpad"] + style["legend.columnspacing"]
    widths = [TextPath((0, 0), label, size=LEGEND_FONT).get_extents().width for label in labels]
    entries = np.asarray(widths) + around * LEGEND_FONT
    for lines in range(1, len(labels)):
        columns = math.ceil(len(labels) / lines)
        if sum(part.max() for part in np.array_split(entries, columns)) <= room:
            return columns
    return 1


def curve_entries(looks: Looks, columns: Sequence[str]) -> list[Line2D]:
    """One entry per look that is drawn; of a long family only values spread over it."""
    if math.prod(looks.sizes) == 1 and not any(curve.same for curve in looks.curves):
        return []
    seen = [*columns, *(["mean_low"] if "mean_friction" in columns else [])]
    drawn = [curve for curve in looks.curves if curve.rows[seen].notna().any(axis=None)]
    labels: dict[tuple[int, int, int], tuple[CurveData, list[str]]] = {}
    for curve in drawn:
        if curve.place[1] in looks.shown:
            _, methods = labels.setdefault(curve.place, (curve, [curve.method]))
            methods += [name for name in curve.same if name not in methods]
    several = looks.sizes[2] > 1 or any(len(methods) > 1 for _, methods in labels.values())
    return [
        Line2D([], [], label=_label(looks, curve, methods if several else []), **looks.sample(curve))
        for _, (curve, methods) in sorted(labels.items())
    ]


def _label(looks: Looks, curve: CurveData, methods: Sequence[str]) -> str:
    value = curve.member[1] if curve.member is not None else None
    several_laws = looks.sizes[0] > 1
    room = BESIDE if several_laws and methods else LONGEST_LABEL
    law = [shortened(curve.law, room)] * several_laws
    method = [_joined(methods, room)] if methods else []
    return ", ".join(law + method + ([swept_text(value)] if value is not None else []))


def _joined(methods: Sequence[str], room: int) -> str:
    """The names of methods that share a line."""
    names = [shortened(name, room) for name in methods]
    joined = " = ".join(names)
    return joined if len(joined) <= 2 * room else f"{names[0]} = {len(names) - 1} others"


def status_entries(table: pd.DataFrame) -> list[Line2D]:
    """One entry per method and status that gives no number, with how many points it has."""
    several = table["method"].nunique() > 1
    entries = []
    for method, rows in table.groupby("method", sort=False):
        for status, mark in LEGEND_MARKS.items():
            if count := int((rows["status"] == status).sum()):
                points = "1 point" if count == 1 else f"{count} points"
                label = f"{points} {status.replace('_', ' ')}" + (
                    f" ({shortened(str(method), BESIDE)})" if several else ""
                )
                entries.append(Line2D([], [], color="0.3", linestyle="none", marker=mark, label=label))
    return entries
