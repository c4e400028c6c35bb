"""Figures of kept orbits: hysteresis loops, phase portraits with Poincaré points, and time series.

Of many points some are drawn, spread over the axis: every picture is one point, with a line for each law.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from frictionlab.charts.curves import CurveData, Family, SweptValue, some_of
from frictionlab.charts.legend import add_entries, curve_entries
from frictionlab.charts.looks import Looks
from frictionlab.charts.style import LINE, PANEL_HEIGHT, blank_figure, page_of
from frictionlab.charts.words import label_once, sentence, write_title
from frictionlab.columns import BELT_SPEED
from frictionlab.study.figure_options import USUAL_FIGURES, FigureOptions

MOST_ORBITS, MOST_OF_A_PANEL = 6, 3  # pictures of a figure, and of them along one axis
MOST_IN_TIME = 4  # points with a picture of velocity and one of friction
POSITION, VELOCITY = "position $x_1$", "velocity $\\dot x_1$"
COEFFICIENT = "friction coefficient\nagainst the mass"
POINCARE: Any = {"marker": "o", "markersize": 3.5, "markerfacecolor": "white", "markeredgewidth": 0.9}
FREQUENCIES = tuple(
    f"scene.{part}.frequency" for part in ("drive", "belt_vibration", "normal_load_variation", "slip")
)


class DrawnOrbit(NamedTuple):
    """One orbit: its curve, its row of the table, and its samples, the first of them again at the end."""

    curve: CurveData
    row: pd.Series
    samples: pd.DataFrame

    def column(self, name: str) -> NDArray[np.float64]:
        """A column of the samples."""
        return self.samples[name].to_numpy(dtype=float)

    @property
    def drive_period(self) -> float | None:
        """The time between two starts of the drive; None where nothing drives."""
        known = [float(self.row[name]) for name in FREQUENCIES if name in self.row and self.row[name] > 0.0]
        return 2.0 * np.pi / known[0] if known else None


class OrbitPicture(NamedTuple):
    """The orbits of one picture and what they have in common."""

    settings: tuple[SweptValue, ...]
    loops: list[DrawnOrbit]


@dataclass(frozen=True)
class OrbitFigures:
    """The orbits of some points of a table, and the figures of them."""

    points: Sequence[OrbitPicture]
    looks: Looks
    total: int
    title: str = ""
    options: FigureOptions = USUAL_FIGURES

    def figures(self) -> dict[str, Callable[[], Figure]]:
        """What draws each, by its name."""
        return {
            "hysteresis": lambda: self._draw([_draw_hysteresis]),
            "phase": lambda: self._draw([_draw_phase]),
            "time_series": lambda: self._draw([_draw_velocity, _draw_friction]),
        }

    def _draw(self, kinds: Sequence[Callable[[Axes, DrawnOrbit, Looks], None]]) -> Figure:
        points = self._side_by_side() if len(kinds) == 1 else some_of(self.points, MOST_IN_TIME)
        pictures = [(point, kind) for point in points for kind in kinds]
        width, wide = page_of(len(pictures), self.options.width)
        high = -(-len(pictures) // wide)
        figure = blank_figure(width, high * PANEL_HEIGHT)
        above = write_title(figure, self.title if self.options.title else "")
        below = self._add_legend(figure, points, poincare=_draw_phase in kinds)
        figure.set_figheight(high * PANEL_HEIGHT + LINE * (above + below))
        of_friction: list[Axes] = []
        for place, (point, kind) in enumerate(pictures, start=1):
            axes = figure.add_subplot(high, wide, place)
            of_friction += [axes] if kind in (_draw_hysteresis, _draw_friction) else []
            for loop in point.loops:
                kind(axes, loop, self.looks)
            if kind is _draw_phase:
                axes.axhline(float(point.loops[0].row[BELT_SPEED]), color="0.45", linewidth=0.6, zorder=0)
            axes.set_title(", ".join(sentence(setting) for setting in point.settings), loc="left")
        _scale_friction(of_friction)
        label_once(figure.axes, wide)
        return figure

    def _side_by_side(self) -> list[OrbitPicture]:
        """The first point of each panel, then the second of each, that panels stand beside each other."""
        panels: dict[tuple[SweptValue, ...], list[OrbitPicture]] = {}
        for point in self.points:
            panels.setdefault(point.settings[:-1], []).append(point)
        return [point for row in zip_longest(*panels.values()) for point in row if point is not None]

    def _add_legend(self, figure: Figure, points: Sequence[OrbitPicture], poincare: bool) -> int:
        drawn = [loop.curve for point in points for loop in point.loops]
        entries = curve_entries(Looks(drawn), ["mean_friction"])
        if poincare:
            look: Any = {"linestyle": "none", "color": "0.2", **POINCARE}
            entries.append(Line2D([], [], label="start of a drive period", **look))
            entries.append(Line2D([], [], color="0.45", linewidth=0.6, label="belt speed"))
        if len(points) < self.total:
            entries.append(Line2D([], [], linestyle="none", label=f"{len(points)} of {self.total} points"))
        return add_entries(figure, entries) if entries else 0


def orbit_figures(
    family: Family, orbits: Callable[[Sequence[int]], pd.DataFrame | None], title: str, options: FigureOptions
) -> OrbitFigures | None:
    """Those of some points of a table; None where none of them has an orbit. orbits: those of rows of the table."""
    chosen = list(_chosen(family))
    wanted = [int(row.name) for _, rows in chosen for _, row in rows]
    found = orbits(wanted)
    if found is None or found.empty:
        return None
    by_row = dict(list(found.groupby("row")))
    points = []
    for settings, rows in chosen:
        loops = [
            DrawnOrbit(curve, row, _closed(by_row[int(row.name)]))
            for curve, row in rows
            if int(row.name) in by_row
        ]
        if loops := list({(loop.curve.law, loop.curve.member): loop for loop in reversed(loops)}.values()):
            points.append(OrbitPicture(settings, loops[::-1]))
    if not points:
        return None
    drawn = [loop.curve for point in points for loop in point.loops]
    total = sum(len(_values(family, panel)) for panel in family.panels)
    return OrbitFigures(points, Looks(drawn), total, title, options)


def _worth_drawing(family: Family, panel: tuple[SweptValue, ...], most: int) -> list[float]:
    """Values along the axis of a panel: where slip reverses, the last of them where the body sticks."""
    values = _values(family, panel, "reversals") or _values(family, panel)
    chosen = some_of(values, most + 2)[1:-1] or values[:1]
    sticking = _values(family, panel, "stick_fraction")
    if sticking and not set(sticking) & set(chosen):
        chosen[-1] = sticking[len(sticking) // 2]
    return chosen


def _values(family: Family, panel: tuple[SweptValue, ...], positive: str | None = None) -> list[float]:
    """Those along the axis of a panel, or those of them at which a column of some curve is positive."""
    found = []
    for curve in (each for each in family.curves if each.panel == panel):
        values = curve.rows[family.abscissa].to_numpy(dtype=float)
        if positive is not None:
            there = curve.rows.get(positive, pd.Series(0.0, curve.rows.index)).to_numpy(dtype=float) > 0.0
            values = values[there]
        found.append(values[~np.isnan(values)])
    return [float(value) for value in np.unique(np.concatenate(found))]


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
                for at in np.flatnonzero(curve.rows[family.abscissa].to_numpy(dtype=float) == value)[:1]
            ]
            yield (*panel, (family.abscissa, value)), rows


def _closed(samples: pd.DataFrame) -> pd.DataFrame:
    """The samples in time, and the first again after the last."""
    inside = samples.sort_values("tau")
    step = inside["tau"].iloc[1] - inside["tau"].iloc[0] if len(inside) > 1 else 0.0
    again = inside.iloc[:1].assign(tau=inside["tau"].iloc[-1] + step)
    return pd.concat([inside, again], ignore_index=True)


def _line(loop: DrawnOrbit, looks: Looks) -> dict[str, Any]:
    return looks.line(loop.curve) | {"marker": ""}


def _scale_friction(pictures: Sequence[Axes]) -> None:
    """One scale for all: friction that is constant but for rounding is a level line on it."""
    ranges = [axes.get_ylim() for axes in pictures]
    for axes in pictures:
        axes.set_ylim(min(low for low, _ in ranges), max(high for _, high in ranges))


def _draw_hysteresis(axes: Axes, loop: DrawnOrbit, looks: Looks) -> None:
    axes.plot(loop.column("x1"), loop.column("friction"), **_line(loop, looks))
    axes.set(xlabel=POSITION, ylabel=COEFFICIENT)


def _draw_phase(axes: Axes, loop: DrawnOrbit, looks: Looks) -> None:
    x, v = loop.column("x1"), loop.column("v1")
    axes.plot(x, v, **_line(loop, looks))
    if (period := loop.drive_period) is not None:
        tau = loop.column("tau")[:-1]
        starts = np.arange(0.0, tau[-1] + 1e-9, period)
        at = np.searchsorted(tau, starts - 1e-9 * period)
        axes.plot(x[at], v[at], linestyle="none", color=looks.color(loop.curve), zorder=4, **POINCARE)
    axes.set(xlabel=POSITION, ylabel=VELOCITY)


def _draw_velocity(axes: Axes, loop: DrawnOrbit, looks: Looks) -> None:
    _draw_in_time(axes, loop, looks, "v1", VELOCITY)


def _draw_friction(axes: Axes, loop: DrawnOrbit, looks: Looks) -> None:
    _draw_in_time(axes, loop, looks, "friction", COEFFICIENT)


def _draw_in_time(axes: Axes, loop: DrawnOrbit, looks: Looks, name: str, label: str) -> None:
    period = loop.drive_period
    axes.plot(loop.column("tau") / (period or 1.0), loop.column(name), **_line(loop, looks))
    axes.set(xlabel="time $\\tau$" if period is None else "drive periods $\\Omega\\tau/2\\pi$", ylabel=label)
