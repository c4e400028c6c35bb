"""Looks by which the curves of a figure differ, in colour and in grey print, and its legend.

Laws differ in colour and in dashes; where there is one law, so do the words of a sweep, else the methods. A swept
number runs from dark to light within a colour, with a marker for each value. Of one law at several values by a few
methods, colour is the value and dashes are the method. What is left has markers.

How dark a colour is, as WCAG 2 measures it, and colours of one hue that are as dark as asked for.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from frictionlab.charts.curves import CurveData
from frictionlab.charts.sheet import CYCLE
from frictionlab.charts.sweeps import BESIDE, LONGEST_LABEL, shortened, some_of

_WEIGHTS = np.array([0.2126, 0.7152, 0.0722])


def luminance(color: Any) -> float:
    """0 for black, 1 for white."""
    return float(_WEIGHTS @ _linear(color))


def contrast(color: Any) -> float:
    """Compute the contrast of a colour against white, 1 to 21."""
    return 1.05 / (luminance(color) + 0.05)


def with_contrast(color: Any, wanted: float) -> tuple[float, float, float]:
    """Return the colour mixed with as much black or white as gives it this contrast against white."""
    light, level = _linear(color), 1.05 / wanted - 0.05
    own = float(_WEIGHTS @ light)
    mixed = light * level / own if level < own else 1.0 - (1.0 - light) * (1.0 - level) / (1.0 - own)
    red, green, blue = np.where(mixed <= 0.0031308, 12.92 * mixed, 1.055 * mixed ** (1 / 2.4) - 0.055)
    return float(red), float(green), float(blue)


def _linear(color: Any) -> NDArray[np.float64]:
    levels = np.array(to_rgb(color), dtype=np.float64)
    return np.where(levels <= 0.04045, levels / 12.92, ((levels + 0.055) / 1.055) ** 2.4)


MOST_BY_DASHES = 4  # methods that colour and dashes tell apart, without markers
MARKERS = "os^Dvph<>d"
MOST_VALUES_IN_LEGEND = 8
MOST_DOTTED = 12  # points of a curve that all get a marker
WITHOUT_NUMBER = {"failed": "x", "killed": "x", "refused": "|"}
LEGEND_MARKS = WITHOUT_NUMBER | {"not_unique": r"$\mathrm{I}$"}
DARKEST, PALEST = 14.0, 3.2  # contrast against white of the ends of a swept number
BROADEST = 0.9  # what the first of several methods is broader than the last, however many [point]


@dataclass(frozen=True)
class Looks:
    """Looks of these curves; each has a place among the laws, swept values and methods of its table."""

    curves: Sequence[CurveData]

    @cached_property
    def sizes(self) -> tuple[int, int, int]:
        """Return how many laws, swept values and methods there are."""
        laws, members, methods = zip(*(curve.place for curve in self.curves), strict=True)
        return max(laws) + 1, max(members) + 1, max(methods) + 1

    def line(self, curve: CurveData) -> dict[str, Any]:
        """Colour, dashes and marker. Of several methods the first is broad, the last lies thin on top."""
        _, member, method = curve.place
        _, members, methods = self.sizes
        broader = BROADEST * (methods - 1 - method) / max(1, methods - 1)
        sign = member + members * method if self._methods_have_markers else member
        return {
            "color": self.color(curve),
            "linestyle": self.cycle(curve)["linestyle"],
            "linewidth": (1.1 if members <= MOST_VALUES_IN_LEGEND else 0.6) + broader,
            "marker": MARKERS[sign % len(MARKERS)],
            "markeredgecolor": "white",
            "markeredgewidth": 0.4,
        }

    def color(self, curve: CurveData) -> tuple[float, float, float]:
        """Return the colour of what sets it, from dark to light along a swept number."""
        if self.of_values:
            return to_rgb(CYCLE[curve.place[1]]["color"])
        color = self.cycle(curve)["color"]
        return to_rgb(color) if self.sizes[1] == 1 or self._words else self.shade(color, curve.place[1])

    @property
    def of_values(self) -> bool:
        """Check whether colour is the swept value and dashes are the method."""
        laws, members, methods = self.sizes
        return laws == 1 and 1 < methods <= MOST_BY_DASHES and 1 < members <= len(CYCLE)

    def shade(self, color: str, member: int) -> tuple[float, float, float]:
        """Return the colour for the swept value at this place, from dark to light."""
        return with_contrast(color, DARKEST * (PALEST / DARKEST) ** (member / max(1, self.sizes[1] - 1)))

    def cycle(self, curve: CurveData) -> dict[str, Any]:
        """Colour and dashes of what sets them."""
        law, member, method = curve.place
        place = law if self.sizes[0] > 1 else member if self._words and not self.of_values else method
        return CYCLE[place % len(CYCLE)]

    def marked(self, y: NDArray[np.float64], curve: CurveData) -> list[int]:
        """Return the points that get a marker: all of few, some of a long curve, and all that no line reaches."""
        known = np.isfinite(y)
        beside = np.pad(known, 1)
        marks = ~(beside[2:] | beside[:-2])
        if not self._has_signs and known.sum() <= MOST_DOTTED:
            return [*np.flatnonzero(known).tolist()]
        if self._has_signs and curve.place[1] in self.shown:
            first, step = self._stagger(len(y), curve)
            marks[first::step] = True
        return [int(place) for place in np.flatnonzero(marks & known)]

    def _stagger(self, points: int, curve: CurveData) -> tuple[int, int]:
        """First marker of a curve and the step to the next: about ten, fewer where many methods coincide."""
        (law, member, method), (laws, members, methods) = curve.place, self.sizes
        step = max(1, points // 10)
        if not self._methods_have_markers:
            return step * (member + law) // (laws + members) % step, step
        step = max(step, min(methods, points // 3))
        return (method * step // methods + law + member) % step, step

    @cached_property
    def shown(self) -> set[int]:
        """Swept values that get markers and a place in the legend: all of a few, else some, first to last."""
        return set(some_of(range(self.sizes[1]), MOST_VALUES_IN_LEGEND))

    def sample(self, curve: CurveData) -> dict[str, Any]:
        """Return the look of its line in the legend: without a marker where its curve has none."""
        return self.line(curve) | ({} if self._has_signs else {"marker": ""})

    @cached_property
    def _words(self) -> bool:
        """Check whether the swept values are words, which are no steps of a scale."""
        return any(curve.member is not None and isinstance(curve.member.value, str) for curve in self.curves)

    @property
    def words_or_signs(self) -> bool:
        """Check whether a swept value has no shade or no marker of its own."""
        return (self._words and not self.of_values) or self._methods_have_markers

    @property
    def _methods_have_markers(self) -> bool:
        """Check whether neither colour and dashes tell methods apart, or they are many."""
        laws, _, methods = self.sizes
        return methods > MOST_BY_DASHES or (methods > 1 and not self.of_values and (laws > 1 or self._words))

    @property
    def _has_signs(self) -> bool:
        return self.sizes[1] > 1 or self._methods_have_markers


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
    if shorter := _apart(looks, [curve for _, (curve, _) in sorted(labels.items())]):
        return shorter
    return [
        Line2D([], [], label=curve_name(looks, curve, methods if several else []), **looks.sample(curve))
        for _, (curve, methods) in sorted(labels.items())
    ]


def _apart(looks: Looks, curves: Sequence[CurveData]) -> list[Line2D]:
    """Laws and methods on the one hand, swept values on the other; nothing where that is not shorter."""
    lines = {(curve.law, curve.method, curve.same): curve for curve in curves}
    valued = [curve for curve in curves if curve.member is not None and curve.member.value is not None]
    values = {curve.place[1]: curve for curve in valued}
    longer = len(lines) + len(values) - len(curves)
    if looks.words_or_signs or longer > 0 or (longer == 0 and not looks.of_values):
        return []
    entries = []
    for curve in lines.values():
        color = "0.3" if looks.of_values else looks.cycle(curve)["color"]
        look = looks.line(curve) | {"marker": "", "color": color}
        methods = (curve.method, *curve.same) if looks.sizes[2] > 1 or curve.same else ()
        entries.append(Line2D([], [], label=", ".join(_names(looks, curve, methods)), **look))
    for at, (place, curve) in enumerate(sorted(values.items())):
        assert curve.member is not None
        color = looks.color(curve) if looks.of_values else looks.shade("0.5", place)
        look = looks.line(curve) | {"linestyle": "none", "color": color}
        entries.append(Line2D([], [], label=curve.member.text if at else curve.member.sentence, **look))
    return entries


def curve_name(looks: Looks, curve: CurveData, methods: Sequence[str]) -> str:
    """Return the names of what tells a curve from the others: law, methods, swept value."""
    told = _names(looks, curve, methods)
    if curve.member is not None and curve.member.value is not None:
        told.append(curve.member.brief if told else curve.member.text)
    return ", ".join(told)


def _names(looks: Looks, curve: CurveData, methods: Sequence[str]) -> list[str]:
    several_laws = looks.sizes[0] > 1
    room = BESIDE if several_laws and methods else LONGEST_LABEL
    told = [shortened(curve.law, room)] if several_laws else []
    return [*told, joined_methods(methods, room)] if methods else told


def joined_methods(methods: Sequence[str], room: int = BESIDE) -> str:
    """Return the names of methods that share a line."""
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
