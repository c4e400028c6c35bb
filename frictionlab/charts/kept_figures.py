"""Figures of what a run kept: hysteresis loops, phase portraits with Poincaré points, time series, and harmonics.

Of many points some are drawn, spread over the axis: every picture is one point, with a line for each law. Amplitudes
of harmonics lie along a sweep, a picture for each harmonic.

Friction that jumps where slip reverses: the instant between two samples, so that the jump is drawn upright.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import zip_longest
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from frictionlab.charts.curve_figure import CurveFigure
from frictionlab.charts.curves import MOST_PICTURES, CurveData, CurveNumbers, Family, family_by
from frictionlab.charts.looks import Looks, curve_entries
from frictionlab.charts.sheet import Heading, Sheet, part_told, scale_alike, write_heading
from frictionlab.charts.sweeps import SweptValue, headings, some_of, sweep_of
from frictionlab.study.figure_options import FigureOptions
from frictionlab.values.columns import (
    ALSO_IN_SI,
    BELT_SPEEDS,
    belt_speed,
    by_plain_names,
    shown_column,
    unit_shown,
    word,
)
from frictionlab.values.units import ShownUnit, in_shown_units

STEEPER = 4.0  # how much more than before and after it friction changes in a jump
LEAST_SLIP = 1e-9  # of the largest slip: less is rest


def with_jumps(samples: pd.DataFrame) -> pd.DataFrame:
    """Samples in time, with two more at every instant at which friction without memory jumps, before and after it.

    That is where slip reaches zero, as it went until then; friction at rest is that of the stick that follows.
    """
    if "slip" not in samples or ("memory_0" in samples and samples["memory_0"].notna().any()):
        return samples
    slip, friction = (samples[name].to_numpy(dtype=float) for name in ("slip", "friction"))
    slip = np.where(np.abs(slip) > LEAST_SLIP * np.abs(slip).max(), slip, 0.0)
    pieces, done = [], 0
    for at in np.flatnonzero((slip[:-1] != 0.0) & (slip[:-1] * slip[1:] <= 0.0)).tolist():
        share = _reaches_zero(slip, at)
        end = friction[at + 1]
        sticks = at + 2 < len(slip) and slip[at + 1] == slip[at + 2] == 0.0
        if sticks:
            end -= (1.0 - share) * (friction[at + 2] - end)
        around = [abs(friction[at] - friction[at - 1])] if at else [0.0]
        if not sticks and at + 2 < len(slip):
            around.append(abs(friction[at + 2] - end))
        if abs(end - friction[at]) > STEEPER * max(around):
            between = samples.iloc[[at]] + share * (samples.iloc[at + 1] - samples.iloc[at])
            pieces += [
                samples.iloc[done : at + 1],
                *(between.assign(friction=f) for f in (friction[at], end)),
            ]
            done = at + 1
    return pd.concat([*pieces, samples.iloc[done:]], ignore_index=True)


def _reaches_zero(slip: np.ndarray, at: int) -> float:
    """Return the share of the step after a sample at which slip does, as it went before, else as it is after."""
    slope = slip[at] - slip[at - 1] if at else 0.0
    share = -slip[at] / slope if slope else -1.0
    return float(share if 0.0 < share < 1.0 else slip[at] / (slip[at] - slip[at + 1]))


MOST_ORBITS, MOST_OF_A_PANEL = 6, 3  # pictures of a figure, and of them along one axis
MOST_IN_TIME = 4  # points with a picture of velocity and one of friction
FRICTION_LABEL = "friction coefficient\nagainst the mass"
PHASE, IN_TIME = ("x1", "v1"), ("tau", "v1")
KINDS = {
    "hysteresis": [("x1", "friction")],
    "phase": [PHASE],
    "time_series": [IN_TIME, ("tau", "friction")],
}
"""Columns that the pictures of each figure show of a point, along the axis and upwards."""
HARMONIC = "harmonic"
_SPEEDS = dict(zip(("belt_speed", ALSO_IN_SI["belt_speed"][0]), BELT_SPEEDS, strict=True))
"""Belt speeds of harmonics.csv, by the columns of the table."""
AMPLITUDES = {
    "velocity_harmonics": ("velocity_amplitude", "amplitude of the harmonic\nof the velocity"),
    "friction_harmonics": ("friction_amplitude", "amplitude of the harmonic\nof the friction coefficient"),
}
POINCARE: Any = {"marker": "o", "markersize": 3.5, "markerfacecolor": "white", "markeredgewidth": 0.9}
SPEED_LINE: Any = {"color": "0.45", "linewidth": 0.6}
ACROSS_LINE: Any = {
    "linestyle": (0, (1.2, 1.2)),
    "marker": "o",
    "markersize": 3.0,
    "markevery": 0.05,
    "markerfacecolor": "white",
    "markeredgewidth": 0.8,
    "zorder": 3,
}
"""Seen where it lies on the velocity along the belt, too."""
LOAD_LINE: Any = {"color": "0.45", "linewidth": 0.9, "linestyle": (0, (6, 2))}
LOAD_SHARE = 0.9
"""Height of the load, which has a scale of its own, over the largest velocity of a picture."""
FREQUENCIES = tuple(
    f"scene.{part}.frequency" for part in ("drive", "belt_vibration", "normal_load_variation", "slip")
)


class DrawnOrbit(NamedTuple):
    """One orbit: its curve, its row of the table, and its samples, the first again at the end where it repeats."""

    curve: CurveData
    row: pd.Series
    samples: pd.DataFrame

    def shown(self, name: str) -> str:
        """Return the column of a sample in the units in which it is shown, those of the scene where it has others."""
        return shown_column(self.samples, name)

    def column(self, name: str) -> CurveNumbers:
        """A column of the samples."""
        return self.samples[name].to_numpy(dtype=float)

    def label(self, name: str) -> str:
        """Return the label of an axis."""
        return FRICTION_LABEL if name == "friction" else word(self.shown(name))

    @property
    def moves_across(self) -> bool:
        """Check whether there is motion across the belt."""
        return bool(self.column(self.shown("v2")).any())

    @property
    def load(self) -> CurveNumbers:
        """Return what drives the mass along the belt."""
        return self.column(self.shown("load"))

    @property
    def drive_period(self) -> float | None:
        """Return the time between two starts of the drive; None where nothing drives."""
        known = [float(self.row[name]) for name in FREQUENCIES if name in self.row and self.row[name] > 0.0]
        return 2.0 * np.pi / known[0] if known else None


class OrbitPicture(NamedTuple):
    """Orbits of one picture and what they have in common."""

    settings: tuple[SweptValue, ...]
    loops: list[DrawnOrbit]


def orbit_figures(
    family: Family,
    orbits: Callable[[Sequence[int]], pd.DataFrame | None],
    units: Mapping[str, ShownUnit],
) -> dict[str, Callable[[Heading], Figure]]:
    """Return what draws those of some points of a table, by its name; none where no orbit is kept. orbits: of rows.

    units: in which the numbers of a scene in SI units were written.
    """
    chosen = list(_chosen(family))
    found = orbits([int(row.name) for _, rows in chosen for _, row in rows])
    if found is None or found.empty:
        return {}
    samples = {row: rows.sort_values("tau") for row, rows in in_shown_units(found, units).groupby("row")}
    points = []
    for settings, rows in chosen:
        loops = {
            (curve.law, curve.member): DrawnOrbit(curve, row, with_jumps(_closed(samples[row.name], row)))
            for curve, row in reversed(rows)  # of several methods the first has the last word
            if row.name in samples
        }
        points += [OrbitPicture(settings, list(loops.values())[::-1])] if loops else []
    total = sum(len(_values(family, panel)) for panel in family.panels)
    swept = family.word(family.member) if family.member else None
    drawn = {name: partial(_draw, points, kinds, total, swept) for name, kinds in KINDS.items()}
    return dict(drawn) if points else {}


def _draw(
    every: Sequence[OrbitPicture],
    kinds: Sequence[tuple[str, str]],
    total: int,
    swept: str | None,
    heading: Heading,
) -> Figure:
    points = _side_by_side(every) if len(kinds) == 1 else some_of(every, MOST_IN_TIME)
    pictures = [(point, kind) for point in points for kind in kinds]
    entries = [_without_marker(entry) for entry in curve_entries(_looks(points), ["mean_friction"])]
    if PHASE in kinds:
        look: Any = {"linestyle": "none", "color": "0.2", **POINCARE}
        entries.append(Line2D([], [], label="start of a drive period", **look))
        entries.append(Line2D([], [], label="belt speed", **SPEED_LINE))
    if IN_TIME in kinds:
        shown = [loop for point in points for loop in point.loops]
        if any(loop.moves_across for loop in shown):
            entries.append(Line2D([], [], label="velocity across the belt", color="0.2", **ACROSS_LINE))
        if any(loop.load.any() for loop in shown):
            entries.append(Line2D([], [], label="load along the belt, not to scale", **LOAD_LINE))
    sheet = Sheet.blank(len(pictures), heading, entries + part_told(len(points), total, "points"), swept)
    looks, titles = _looks(every), headings([point.settings for point, _ in pictures])
    drawn = [_draw_point(sheet.axes(at), *picture, looks) for at, picture in enumerate(pictures)]
    for axes, title in zip(drawn, titles, strict=True):
        write_heading(axes, title, sheet.picture_width)
    # one scale for friction: that which is constant but for rounding is a level line on it
    scale_alike([axes for axes, (_, kind) in zip(drawn, pictures, strict=True) if kind[1] == "friction"])
    sheet.label_once(drawn)
    return sheet.figure


def _without_marker(entry: Line2D) -> Line2D:
    """Return the entry of a line as its curve is drawn here; one that is a marker alone stays."""
    if entry.get_linestyle() != "None":
        entry.set_marker("")
    return entry


def _side_by_side(points: Sequence[OrbitPicture]) -> list[OrbitPicture]:
    """Return the first point of each panel, then the second of each, that panels stand beside each other."""
    panels: dict[tuple[SweptValue, ...], list[OrbitPicture]] = {}
    for point in points:
        panels.setdefault(point.settings[:-1], []).append(point)
    return [point for row in zip_longest(*panels.values()) for point in row if point is not None]


def _looks(points: Sequence[OrbitPicture]) -> Looks:
    return Looks([loop.curve for point in points for loop in point.loops])


def _worth_drawing(family: Family, panel: tuple[SweptValue, ...], most: int) -> list[float]:
    """Values along the axis of a panel: where slip reverses, the last of many where the body sticks."""
    values = _values(family, panel, "reversals") or _values(family, panel)
    if len(values) <= most:
        return values
    chosen = some_of(values, most + 2)[1:-1] or values[:1]
    sticking = _values(family, panel, "stick_fraction")
    if sticking and not set(sticking) & set(chosen):
        chosen[-1] = sticking[len(sticking) // 2]
    return chosen


def _values(family: Family, panel: tuple[SweptValue, ...], positive: str | None = None) -> list[float]:
    """Return the values along the axis of a panel, or those at which a column of some curve is positive."""
    found = set[float]()
    for curve in (each for each in family.curves if each.panel == panel):
        values = curve.column(family.abscissa)
        if positive is not None:
            values = values[curve.column(positive) > 0.0] if positive in curve.rows else values[:0]
        found |= set(values[~np.isnan(values)].tolist())
    return sorted(found)


def _chosen(family: Family) -> Iterator[tuple[tuple[SweptValue, ...], list[tuple[CurveData, pd.Series]]]]:
    """Points spread over pictures and, where slip reverses, along their axis: settings and rows of curves."""
    looks = Looks(family.curves)
    panels = some_of(family.panels, MOST_ORBITS)
    each = max(1, min(MOST_OF_A_PANEL, MOST_ORBITS // len(panels)))
    for panel in panels:
        curves = [one for one in family.curves if one.panel == panel and one.place[1] in looks.shown]
        for value in _worth_drawing(family, panel, each):
            rows = [
                (curve, curve.rows.iloc[at])
                for curve in curves
                for at in np.flatnonzero(curve.column(family.abscissa) == value)[:1]
            ]
            yield (*panel, SweptValue(family.abscissa, value)), rows


def _closed(inside: pd.DataFrame, row: pd.Series) -> pd.DataFrame:
    """Return the samples in time, and the first again after the last, but for a motion that does not repeat."""
    if row.get("error_kind") == "statistical":
        return inside
    # in SI units, too, where the scene is
    times = inside[[name for name in inside if name.startswith("tau")]]
    steps = times.iloc[1] - times.iloc[0] if len(inside) > 1 else 0.0 * times.iloc[0]
    again = inside.iloc[:1].assign(**dict(times.iloc[-1] + steps))
    return pd.concat([inside, again], ignore_index=True)


def _draw_point(axes: Axes, point: OrbitPicture, kind: tuple[str, str], looks: Looks) -> Axes:
    """Return the orbits of a point as a picture."""
    along, upwards = kind
    for loop in point.loops:
        x, y, label = loop.column(loop.shown(along)), loop.column(loop.shown(upwards)), loop.label(along)
        if along == "tau" and loop.drive_period is not None:
            x, label = loop.column("tau") / loop.drive_period, "drive periods $\\Omega\\tau/2\\pi$"
        axes.plot(x, y, **looks.line(loop.curve) | {"marker": ""})
        if kind == IN_TIME and loop.moves_across:
            across = loop.column(loop.shown("v2"))
            axes.plot(
                x,
                across,
                **looks.line(loop.curve) | ACROSS_LINE | {"markeredgecolor": looks.color(loop.curve)},
            )
        axes.set(xlabel=label, ylabel=loop.label(upwards))
        if kind == PHASE and (period := loop.drive_period) is not None:
            tau = loop.column("tau")[:-1]
            at = np.searchsorted(tau, np.arange(0.0, tau[-1] + 1e-9, period) - 1e-9 * period)
            axes.plot(x[at], y[at], ls="none", color=looks.color(loop.curve), zorder=4, **POINCARE)
    if kind == IN_TIME and (load := point.loops[-1].load).any():  # at the times x of the last
        highest = max(np.abs(axes.dataLim.get_points()[:, 1]))
        axes.plot(x, LOAD_SHARE * highest / np.abs(load).max() * load, zorder=0, **LOAD_LINE)
    if kind == PHASE:
        row = point.loops[0].row
        axes.axhline(float(row[belt_speed(row.index)]), zorder=0, **SPEED_LINE)
    return axes


def harmonic_figures(
    harmonics: pd.DataFrame, options: FigureOptions
) -> dict[str, Callable[[Heading], Figure]]:
    """Return the drawers by name; none where nothing is swept. harmonics: of ``harmonics.csv``, means left out."""
    family = _family(harmonics)
    if family is None:
        return {}
    orders = list(dict.fromkeys(dict(panel)[HARMONIC] for panel in family.panels))
    most = orders[: max(1, MOST_PICTURES * len(orders) // len(family.panels))]
    first = replace(family, curves=[curve for curve in family.curves if dict(curve.panel)[HARMONIC] in most])
    told = part_told(len(most), len(orders), "harmonics")
    shown = {name: _amplitude(harmonics, *told) for name, told in AMPLITUDES.items()}
    return {
        name: CurveFigure(first, [column], None, options, {column: label}, more=told).draw
        for name, (column, label) in shown.items()
    }


def _amplitude(harmonics: pd.DataFrame, column: str, label: str) -> tuple[str, str]:
    """Return the column of an amplitude in the units in which it is shown, and its label."""
    shown = shown_column(harmonics, column)
    return shown, f"{label} [{unit_shown(shown)}]" if unit_shown(shown) else label


def _family(harmonics: pd.DataFrame) -> Family | None:
    names = by_plain_names(harmonics)
    speeds = {names[each]: names[each].replace(each, of) for each, of in _SPEEDS.items() if each in names}
    rows = harmonics[harmonics[HARMONIC] > 0].rename(columns=speeds)
    rows = rows.assign(status="ok", **{HARMONIC: rows[HARMONIC].astype(float)})
    sweep = sweep_of(rows)
    others = [name for name in sweep.inputs if name != sweep.along]
    apart = others if rows["law"].nunique() == 1 else [name for name in others if name.startswith("law.")]
    member = apart[-1] if apart else None
    return family_by(rows, sweep, [HARMONIC, *(name for name in others if name != member)], member)
