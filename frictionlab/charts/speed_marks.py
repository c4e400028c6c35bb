"""The marks of V_lin on the axis of belt speed, each with the swept value it belongs to."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.textpath import TextPath
from matplotlib.ticker import NullLocator

from frictionlab.charts.curves import CurveData
from frictionlab.charts.looks import Looks
from frictionlab.charts.words import swept_text
from frictionlab.columns import symbol

MOST_LINES = 3  # of names above a picture
NAME_FONT = 6.5  # [point]


class SpeedMark(NamedTuple):
    """A belt speed at which curves have a kink, and the first of these curves."""

    at: float
    curve: CurveData


def speed_marks(curves: Sequence[CurveData]) -> list[SpeedMark]:
    """Every V_lin of these curves once, in the order of belt speed."""
    found: list[SpeedMark] = []
    for curve in curves:
        for at in curve.kinks:
            if all(abs(at - mark.at) > 1e-9 * abs(at) for mark in found):
                found.append(SpeedMark(at, curve))
    return sorted(found, key=lambda mark: mark.at)


def draw_speed_marks(axes: Axes, curves: Sequence[CurveData], looks: Looks, width: float) -> None:
    """A thin line at every V_lin and its name on a scale above the picture. width: of the picture [point].

    Where the picture has several, each has the look of its curve and is named with the swept value that it is for.
    A name without room is left out: its line then has the curve's marker alone.
    """
    marks = speed_marks(curves)
    several = len({abs(mark.at) for mark in marks}) > 1
    for mark in marks:
        look = looks.line(mark.curve)
        axes.axvline(mark.at, color=look["color"] if several else "0.45", linewidth=0.6, zorder=0)
        if several:
            sign = {name: look[name] for name in ("color", "marker")}
            axes.plot([mark.at], [1.0], ms=3, clip_on=False, transform=axes.get_xaxis_transform(), **sign)
    if marks:
        _name(axes, marks, several, width)


def _name(axes: Axes, marks: Sequence[SpeedMark], several: bool, width: float) -> None:
    ends: list[float] = []  # of the names in each line above the picture
    places, names = [], []
    for mark in marks:
        text = _text(mark, several)
        half = 0.5 * TextPath((0, 0), text, size=NAME_FONT).get_extents().width + 2.0
        (at, _) = axes.transScale.transform((mark.at, 1.0))
        low, high = (axes.transScale.transform((end, 1.0))[0] for end in axes.get_xlim())
        centre = width * (at - low) / (high - low)
        line = next((i for i, end in enumerate(ends) if end < centre - half), len(ends))
        if line == MOST_LINES:
            continue
        ends[line:] = [centre + half, *ends[line + 1 :]]
        places.append(mark.at)
        names.append(text + "\n" * line)
    above = axes.secondary_xaxis("top")
    above.spines["top"].set_visible(False)
    above.set_xticks(places, names, fontsize=NAME_FONT, linespacing=1.0)
    above.xaxis.set_minor_locator(NullLocator())  # of a logarithmic axis below
    above.tick_params(length=0, pad=3 if several else 1)


def _text(mark: SpeedMark, several: bool) -> str:
    name = r"$V_\mathrm{lin}$" if mark.at > 0 else r"$-V_\mathrm{lin}$"
    if not several or mark.curve.member is None:
        return name
    swept, value = mark.curve.member
    return f"{name}, {symbol(swept)} = {swept_text(value)}"
