"""Figures of a result table: mean friction, velocity response and energies, for the page of a journal.

One colour per law, from dark to light along a swept number; one line style per method; a marker per law and
swept value, so that black and white print tells curves apart too. More than two methods have markers of their
own, staggered where curves coincide, and colours of their own where there is one law without a sweep; so have swept
words. A point without a number is a mark on the axis and a line in the legend: nothing is dropped in silence.
"""

from __future__ import annotations

import math
import textwrap
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.textpath import TextPath
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, NullLocator, StrMethodFormatter
from numpy.typing import NDArray

from frictionlab.charts.curves import CurveData, Family, SweptValue, family_of, is_logarithmic, kinks
from frictionlab.charts.onsets import OnsetMark, draw_onsets, onset_entries, onsets_on
from frictionlab.columns import SI, belt_speed, word
from frictionlab.printable import printable

FIGURES = {
    "mean_friction": ["mean_friction"],
    "velocity": ["velocity_amplitude", "transverse_velocity_amplitude"],
    "energies": ["energy_input", "energy_viscous", "energy_friction", "energy_contact"],
}
IN_SI = {made.column: name for name, made in SI.items() if made.scale != "load"}

COLUMN, PAGE = 85 / 25.4, 170 / 25.4  # widths of a journal's column and page [inch]
PANEL_HEIGHT, LINE = 2.2, 0.16  # of a picture, and of a line of text around it [inch]
SHADES = ("Blues", "Oranges", "Greens", "Purples", "Reds", "Greys")
MARKERS = "os^Dvph<>d"
COLORS = "tab10"
LINES = (
    "solid",
    *((0, dashes) for dashes in [(4, 2), (1, 1.5), (6, 2, 1, 2), (2, 1), (4, 1, 1, 1, 1, 1), (7, 3)]),
    *((0, dashes) for dashes in [(5, 1, 2, 1), (1, 3), (8, 1, 1, 1, 1, 1, 1, 1)]),
)
BROADEST = 0.9  # what the first of several methods is broader than the last, however many [point]
WITHOUT_NUMBER = {"failed": "x", "killed": "x", "refused": "|"}
LEGEND_MARKS = WITHOUT_NUMBER | {"not_unique": r"$\mathrm{I}$"}
MOST_VALUES_IN_LEGEND = 8
LONGEST_LABEL, BESIDE = 36, 22  # letters of a name alone, and beside another name or a count
LEGEND_FONT = 7  # [point]
DEGREES = [1, 1.5, 3, 4.5, 9, 10]  # between ticks of an angle, times a power of ten
ROUNDING = 1e-9  # of the largest level: less is zero, whatever its sign
LEAST_VISIBLE = 0.004  # share of an axis: half a line width at the size of a panel

STYLE: Any = {
    "font.family": "sans-serif",
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.1,
    "lines.markersize": 3.5,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "legend.fontsize": LEGEND_FONT,
    "legend.title_fontsize": LEGEND_FONT,
    "legend.frameon": False,
    "svg.hashsalt": "frictionlab",
    "savefig.dpi": 300,
}


class Data(NamedTuple):
    """One curve of one quantity as arrays: where, how much, and the shape it is drawn in."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    rows: pd.DataFrame
    color: Any


def draw_figures(
    table: pd.DataFrame, title: str, folder: Path, onsets: pd.DataFrame | None = None
) -> list[Path]:
    """Draw every figure of a result table into a folder, onsets marked along belt speed; the files written.

    A table without a sweep has no figure, nor has a quantity that applies nowhere. Raises OSError where the
    folder cannot be written.
    """
    family = family_of(table)
    if family is None:
        return []
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    with mpl.rc_context(STYLE), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing from")  # of a title: an empty box says it
        for name, columns in figure_columns(table).items():
            files += write_figure(_figure(family, columns, printable(title), onsets), folder / name)
    return files


def figure_columns(table: pd.DataFrame) -> dict[str, list[str]]:
    """The columns that each figure of a table shows; a figure without any is not there."""
    shown = {
        name: [column for column in _as_given(wanted, table) if table[column].notna().any()]
        for name, wanted in FIGURES.items()
    }
    return {name: columns for name, columns in shown.items() if columns}


def _as_given(columns: Sequence[str], table: pd.DataFrame) -> list[str]:
    """Velocities and energies in SI units where the scene is."""
    return [IN_SI[column] if IN_SI.get(column) in table else column for column in columns]


def write_figure(figure: Figure, path: Path) -> list[Path]:
    """Write a figure as a drawing and as pixels; the files. Raises OSError."""
    svg, png = path.with_suffix(".svg"), path.with_suffix(".png")
    figure.savefig(svg, metadata={"Date": None})
    figure.set_layout_engine("none")  # the layout found for the first file serves the second
    figure.savefig(png, metadata={"Software": None})
    return [svg, png]


def _figure(family: Family, columns: Sequence[str], title: str, onsets: pd.DataFrame | None = None) -> Figure:
    if family.abscissa != belt_speed([family.abscissa]):
        onsets = None
    marks = [mark for curve in family.curves for mark in onsets_on(curve, onsets)]
    pictures = [(panel, column) for panel in family.panels for column in columns]
    wide = min(2, len(pictures))
    high = -(-len(pictures) // wide)
    width = (COLUMN, PAGE)[wide - 1]
    figure = Figure(figsize=(width, high * PANEL_HEIGHT), layout="constrained")
    FigureCanvasAgg(figure)
    lines = textwrap.wrap(_plain(title), round(width * 13))
    figure.suptitle("\n".join(lines), x=0.01, ha="left", fontsize=8, fontweight="bold")
    figure.set_figheight(
        high * PANEL_HEIGHT + LINE * (len(lines) + _add_legend(figure, family, columns, marks))
    )
    for place, (panel, column) in enumerate(pictures, start=1):
        _draw_panel(figure.add_subplot(high, wide, place), family, panel, column, onsets)
    return figure


def _draw_panel(
    axes: Axes, family: Family, panel: tuple[SweptValue, ...], column: str, onsets: pd.DataFrame | None
) -> None:
    curves = [curve for curve in family.curves if curve.panel == panel]
    for curve in curves:
        _draw_curve(axes, family, curve, column)
    axes.set_xlabel(word(family.abscissa))
    axes.set_ylabel(word(column, 28))
    if panel:
        axes.set_title(", ".join(_sentence(setting) for setting in panel), loc="left")
    axes.margins(x=0.02)
    if word(family.abscissa).endswith("deg]"):
        axes.xaxis.set_major_locator(MaxNLocator(steps=DEGREES))
    if is_logarithmic(
        np.concatenate([curve.rows[family.abscissa].to_numpy(dtype=float) for curve in curves])
    ):
        axes.set_xscale("log")
        _label_decades(axes.xaxis)
    _scale_upwards(axes, [curve.rows[column] for curve in curves], column)
    if family.abscissa == belt_speed([family.abscissa]):
        _mark_kinks(axes, [speed for curve in curves for speed in kinks(curve)])
    for curve in curves:
        draw_onsets(axes, onsets_on(curve, onsets), _color(family, curve))


def _scale_upwards(axes: Axes, curves: Sequence[pd.Series], column: str) -> None:
    """A foot at zero for what is not negative; logarithmic where whole curves lie decades apart."""
    if column != "mean_friction" and _lie_decades_apart(curves):
        axes.set_yscale("log")
        _label_decades(axes.yaxis)
        return
    low, high = axes.get_ylim()
    if -0.06 * high < low:  # nothing but the margin below zero, so zero itself is the natural foot
        axes.set_ylim(0.0, max(high, 1.05 * axes.dataLim.y1))


def _label_decades(axis: Axis) -> None:
    """Of few decades 1, 2 and 5 are labelled, as plain numbers: every multiple would be one on the other."""
    low, high = sorted(axis.get_view_interval())
    if high < 1000.0 * low:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(NullFormatter())


def _lie_decades_apart(curves: Sequence[pd.Series]) -> bool:
    """Whether every curve keeps to a level above rounding, and the levels are decades apart."""
    known = [curve for curve in curves if curve.notna().any()]
    if not known:
        return False
    levels = [float(curve.median()) for curve in known]
    low, high = min(levels), max(levels)
    return high > 30.0 * low > ROUNDING * high and min(float(curve.min()) for curve in known) > 0.2 * low


def _draw_curve(axes: Axes, family: Family, curve: CurveData, column: str) -> None:
    x, y = (curve.rows[name].to_numpy(dtype=float) for name in (family.abscissa, column))
    look = _look(family, curve)
    if np.isnan(x).all():  # a law without the swept parameter: the level that the others are held against
        ends = [0.0, 0.5, 1.0]
        axes.plot(ends, y[[0, 0, 0]], markevery=[1], transform=axes.get_yaxis_transform(), **look)
        return
    axes.plot(x, y, markevery=_marked(y, curve, family), **look)
    data = Data(x, y, curve.rows, look["color"])
    if column == "mean_friction":
        _draw_error(axes, data)
        _draw_ranges(axes, data)
    _mark_missing(axes, data)


def _look(family: Family, curve: CurveData) -> dict[str, Any]:
    """Colour, line and marker. Of several methods the first is broad and pale, the last lies thin on top."""
    law, member, method = curve.place
    _, members, methods = family.sizes
    broader = BROADEST * (methods - 1 - method) / max(1, methods - 1)
    sign = law * members + member + (method if _methods_have_markers(family) else 0)
    return {
        "color": _color(family, curve),
        "linestyle": LINES[method % len(LINES)],
        "linewidth": (1.1 if members <= MOST_VALUES_IN_LEGEND else 0.6) + broader,
        "gapcolor": "white" if method % len(LINES) else None,
        "marker": MARKERS[sign % len(MARKERS)],
        "markeredgecolor": "white",
        "markeredgewidth": 0.4,
    }


def _color(family: Family, curve: CurveData) -> Any:
    law, member, method = curve.place
    laws, members, _ = family.sizes
    if laws * members == 1 and _methods_have_markers(family):
        return mpl.colormaps[COLORS](method % mpl.colormaps[COLORS].N)
    if laws == 1 and curve.member is not None and isinstance(curve.member[1], str):
        return mpl.colormaps[COLORS](member % mpl.colormaps[COLORS].N)  # words are no steps of a scale
    shade = 0.8 if members == 1 else 1.0 - 0.6 * member / (members - 1)
    return mpl.colormaps[SHADES[law % len(SHADES)]](shade)


def _methods_have_markers(family: Family) -> bool:
    """Whether methods are too many to be told apart as broad below and thin on top."""
    return family.sizes[2] > 2


def _marked(y: NDArray[np.float64], curve: CurveData, family: Family) -> list[int]:
    """The points that get a marker: some of a curve with neighbours, and all that no line reaches."""
    known = np.isfinite(y)
    neighbours = np.concatenate([known[1:], [False]]) | np.concatenate([[False], known[:-1]])
    marks = known & ~neighbours
    several = math.prod(family.sizes[:2]) > 1 or _methods_have_markers(family)
    if several and curve.place[1] in _shown(family):
        first, step = _stagger(len(y), curve, family)
        marks[first::step] = True
    return [int(place) for place in np.flatnonzero(marks & known)]


def _stagger(points: int, curve: CurveData, family: Family) -> tuple[int, int]:
    """The first marker of a curve and the step to the next: about ten, fewer where many methods coincide."""
    (law, member, method), (laws, members, methods) = curve.place, family.sizes
    step = max(1, points // 10)
    if not _methods_have_markers(family):
        return step * (member + law) // (laws + members) % step, step
    step = max(step, min(methods, points // 3))
    return (method * step // methods + law + member) % step, step


def _draw_error(axes: Axes, data: Data) -> None:
    """The error as a band, where it is wide enough to be seen at all."""
    error = data.rows["error"].to_numpy(dtype=float)
    seen = np.nan_to_num(error) > LEAST_VISIBLE * np.ptp(axes.get_ylim())
    if seen.any():
        axes.fill_between(data.x, data.y - error, data.y + error, color=data.color, alpha=0.25, linewidth=0)


def _draw_ranges(axes: Axes, data: Data) -> None:
    """A bar from mean_low to mean_high where the steady state is not unique."""
    rows = (data.rows["status"] == "not_unique").to_numpy()
    if not rows.any():
        return
    low, high = (data.rows[name].to_numpy(dtype=float)[rows] for name in ("mean_low", "mean_high"))
    centre = 0.5 * (low + high)
    axes.errorbar(data.x[rows], centre, yerr=high - centre, fmt="none", color=data.color, capsize=1.5)


def _mark_missing(axes: Axes, data: Data) -> None:
    """A mark on the axis for every point without a number; a curve refused as a whole is only counted."""
    if (data.rows["status"] == "refused").all():
        return
    for status, mark in WITHOUT_NUMBER.items():
        x = data.x[(data.rows["status"] == status).to_numpy()]
        where = axes.get_xaxis_transform()
        if len(x):
            axes.plot(x, 0.0 * x, mark, color=data.color, ms=4, clip_on=False, transform=where, zorder=5)


def _mark_kinks(axes: Axes, speeds: Sequence[float]) -> None:
    """A thin line at every V_lin, named on a scale of its own above the picture where there is room."""
    low, high = axes.get_xlim()
    named: list[float] = []
    for speed in sorted(set(speeds)):
        axes.axvline(speed, color="0.45", linewidth=0.5, zorder=0)
        if not named or speed - named[-1] > 0.12 * (high - low):
            named.append(speed)
    above = axes.secondary_xaxis("top")
    above.spines["top"].set_visible(False)
    above.set_xticks(named, [r"$V_\mathrm{lin}$" if speed > 0 else r"$-V_\mathrm{lin}$" for speed in named])
    above.xaxis.set_minor_locator(NullLocator())  # of a logarithmic axis below
    above.tick_params(length=0, pad=1)


def _add_legend(figure: Figure, family: Family, columns: Sequence[str], marks: Sequence[OnsetMark]) -> int:
    """Name what tells curves apart, and count what has no number, below the pictures; the lines it takes."""
    entries = _curve_entries(family, columns) + _status_entries(family) + onset_entries(marks)
    if not entries:
        return 0
    handle = 3.5 if _methods_have_markers(family) else 2.0
    abreast = _abreast([str(entry.get_label()) for entry in entries], handle, 72 * figure.get_figwidth())
    title = word(family.member) if family.member else None
    figure.legend(
        handles=entries, loc="outside lower center", ncols=abreast, title=title, handlelength=handle
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


def _curve_entries(family: Family, columns: Sequence[str]) -> list[Line2D]:
    """One entry per look that is drawn; of a long family only values spread over it."""
    if math.prod(family.sizes) == 1:
        return []
    shown = _shown(family)
    seen = [*columns, *(["mean_low"] if "mean_friction" in columns else [])]
    drawn = [curve for curve in family.curves if curve.rows[seen].notna().any(axis=None)]
    looks = {curve.place: curve for curve in drawn if curve.place[1] in shown}
    chosen = [looks[place] for place in sorted(looks)]
    return [Line2D([], [], label=_label(family, curve), **_look(family, curve)) for curve in chosen]


def _shown(family: Family) -> set[int]:
    """The members that get markers and a place in the legend: all of a few, else a few from first to last."""
    members = family.sizes[1]
    return set(np.linspace(0, members - 1, min(members, MOST_VALUES_IN_LEGEND)).round().astype(int).tolist())


def _label(family: Family, curve: CurveData) -> str:
    laws, _, methods = family.sizes
    value = curve.member[1] if curve.member is not None else None
    room = LONGEST_LABEL if laws == 1 or methods == 1 else BESIDE
    law, method = [_name(curve.law, room)] * (laws > 1), [_name(curve.method, room)] * (methods > 1)
    return ", ".join(law + method + [_value(value)] if value is not None else law + method)


def _status_entries(family: Family) -> list[Line2D]:
    """One entry per method and status that gives no number, with how many points it has."""
    several = family.sizes[2] > 1
    entries = []
    for method in dict.fromkeys(curve.method for curve in family.curves):
        rows = pd.concat([curve.rows["status"] for curve in family.curves if curve.method == method])
        for status, mark in LEGEND_MARKS.items():
            if count := int((rows == status).sum()):
                points = "1 point" if count == 1 else f"{count} points"
                label = f"{points} {status.replace('_', ' ')}" + (
                    f" ({_name(method, BESIDE)})" if several else ""
                )
                entries.append(Line2D([], [], color="0.3", linestyle="none", marker=mark, label=label))
    return entries


def _plain(text: str) -> str:
    """Words of the study: a dollar sign in them is one, and begins no formula."""
    return text.replace("$", r"\$")


def _name(label: str, room: int) -> str:
    """A label of the study, as many letters of it as a legend has room for."""
    return _plain(label if len(label) <= room else f"{label[: room - 1]}…")


def _sentence(setting: SweptValue) -> str:
    name, value = setting
    return f"no {word(name)}" if value is None else f"{word(name)} = {_value(value)}"


def _value(value: float | str) -> str:
    return _name(value, LONGEST_LABEL) if isinstance(value, str) else f"{value:.5g}"
