"""Effect of every part of a scene: bars of the change without it, a panel a curve, the tolerance as a line."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import NullLocator

from frictionlab.charts.sheet import STYLE, Heading, Sheet, write_figure
from frictionlab.charts.sweeps import plain
from frictionlab.values.printable import printable

PLUS = " + "
"""Between the things of a set in the column ``without``."""
BAR, AROUND = 0.19, 0.6  # of a bar and of what stands around a panel [inch]
_BELOW = 5
"""Decades that the axis goes below the tolerance: less is as good as nothing."""
VERDICT_LOOKS: dict[str, Any] = {
    "needed": {"facecolor": "#16324f", "edgecolor": "#16324f"},
    "undecided": {"facecolor": "#8fa9c4", "edgecolor": "#16324f", "hatch": "xxxx"},
    "not needed": {"facecolor": "white", "edgecolor": "#16324f", "hatch": "////"},
}
SMALLEST = "the smallest model"
ERROR = "#c2571a"
LINE_OF_TOLERANCE: Any = {"color": "0.15", "linewidth": 1.0, "linestyle": (0, (4, 2))}


def needs_figure(table: pd.DataFrame, title: str = "", into: Axes | None = None) -> Figure:
    """Bars of the largest change of the mean without each thing, and without all that the smallest model lacks."""
    curves = list(table.groupby("curve", sort=False))
    names = [name for name in dict.fromkeys(table["without"]) if PLUS not in name] + [SMALLEST]
    entries: list[Any] = [
        Patch(label=name, **look) for name, look in VERDICT_LOOKS.items() if name in set(table["verdict"])
    ]
    entries.append(Line2D([], [], color=ERROR, marker="|", linewidth=1.6, label="error"))
    entries.append(Line2D([], [], label="tolerance", **LINE_OF_TOLERANCE))
    with mpl.rc_context(STYLE):
        heading = Heading(title, "double", into=into)
        sheet = Sheet.blank(len(curves), heading, entries, height=BAR * len(names) + AROUND)
        for place, (curve, rows) in enumerate(curves):
            axes = sheet.axes(place)
            _draw_panel_of_needs(axes, names, rows, _ends(table))
            axes.set(xlabel="largest change of the mean friction coefficient")
            axes.set_title(plain(str(curve)), loc="left")
            axes.tick_params(labelleft=not place % sheet.wide, labelbottom=place + sheet.wide >= len(curves))
        sheet.label_once(sheet.figure.axes if into is None else [into])
    return sheet.figure


def draw_needs(table: pd.DataFrame, title: str, folder: Path) -> list[Path]:
    """Draw a table of needs into a folder; the files. Raises OSError where it cannot be written."""
    if table.empty:
        return []
    folder.mkdir(parents=True, exist_ok=True)
    with mpl.rc_context(STYLE):
        return write_figure(needs_figure(table, printable(title)), folder / "needs")


def _draw_panel_of_needs(axes: Axes, names: list[str], rows: pd.DataFrame, ends: tuple[float, float]) -> None:
    within, (least, largest) = float(rows["within"].iloc[0]), ends
    bars = {row["without"]: row for _, row in rows.iterrows() if PLUS not in row["without"]}
    if rows["smallest"].any():
        bars[SMALLEST] = rows[rows["smallest"]].iloc[0]
    for place, name in enumerate(names):
        if name in bars:
            _draw_bar(axes, place, bars[name], least)
        else:
            _say(axes, place, "the full one" if name == SMALLEST else "no such part")
    axes.axvline(within, color="white", linewidth=2.4, zorder=3)
    axes.axvline(within, zorder=3, **LINE_OF_TOLERANCE)
    axes.set_xscale("log")
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlim(least, largest)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.set_yticks(range(len(names)), names)
    axes.tick_params(axis="y", length=0)


def _ends(table: pd.DataFrame) -> tuple[float, float]:
    """Return the ends of the axis, the same for all curves."""
    largest = (table["change"].abs() + table["change_error"]).max()
    return float(table["within"].min()) * 10.0**-_BELOW, 3.0 * float(max(largest, table["within"].max()))


def _draw_bar(axes: Axes, place: int, row: Any, least: float) -> None:
    """One bar with its error."""
    if row["verdict"] not in VERDICT_LOOKS:
        _say(axes, place, "cannot go alone")
        return
    size, error = abs(float(row["change"])), float(row["change_error"])
    axes.barh(
        place, max(size - least, 0.0), left=least, height=0.62, linewidth=0.6, **VERDICT_LOOKS[row["verdict"]]
    )
    if size + error > least:
        ends = [max(size - error, least), size + error]
        axes.plot(ends, [place, place], color=ERROR, marker="|", markersize=5, linewidth=1.6, zorder=4)
    else:
        _say(axes, place, "0" if size == 0.0 else f"{size:.0e}")


def _say(axes: Axes, place: int, text: str) -> None:
    where = axes.get_yaxis_transform()
    axes.text(0.01, place, text, transform=where, va="center", fontsize=6.5, color="0.3")
