"""The figures of a run, inside the page, each with a caption made from the study."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from markupsafe import Markup, escape
from pandas import DataFrame

from frictionlab.charts.bifurcation import bifurcations
from frictionlab.charts.curves import Family
from frictionlab.charts.derived import reference_law
from frictionlab.charts.figures import OTHER_FIGURES, FigureData
from frictionlab.charts.maps import MapFigure
from frictionlab.report.markup import symbol_html, unit_html, word_html
from frictionlab.report.question import values_listed
from frictionlab.report.tables import joined_values, setting
from frictionlab.results.words import counted
from frictionlab.runner.saved import Saved

LARGEST_SVG = 400_000
"""Bytes of a drawing above which the pixels of the same figure are put into the page, where they are fewer."""
_KINDS = {".svg": "image/svg+xml", ".png": "image/png"}


class Picture(NamedTuple):
    """A figure in the page: its data as an address, its caption, its description in words.

    narrow: whether it is one picture alone, drawn for the column of a journal.
    """

    name: str
    address: str
    caption: Markup
    description: str
    narrow: bool


def pictures(saved: Saved) -> list[Picture]:
    """The figures of a run, the one that answers its question first; one that is not in its folder has no address.

    The first caption says what lines mean and what is held fixed; the others lead to it.
    """
    data = FigureData(saved.table, options=saved.study.figures)
    family, found, maps = data.family, data.columns, data.maps
    usual = [
        _picture(saved, family, name, columns, maps, not place)
        for place, (name, columns) in enumerate(found.items())
        if family
    ]
    several = {} if saved.attractors is None else bifurcations(saved.attractors)
    return [
        *usual,
        *_others(saved, family),
        *(_bifurcation(saved, name, rows) for name, rows in several.items()),
    ]


def _others(saved: Saved, family: Family | None) -> list[Picture]:
    """The figures that only some tables have, where they were drawn."""
    reference = reference_law(family, saved.study.figures.against) if family else None
    narrow = family is None or len(family.panels) == 1
    found = []
    for name, told in OTHER_FIGURES.items():
        if data := address(saved.folder / "figures" / name):
            caption = escape(f"{told.format(reference=reference)}.")
            found.append(Picture(name, data, Markup(caption), str(caption), narrow))
    return found


def _bifurcation(saved: Saved, name: str, rows: DataFrame) -> Picture:
    """Every state that motions end in along one curve."""
    periods = sorted({int(period) for period in rows["period"]} - {0})
    told = (
        f"Of {joined_values(rows['law'])} by {joined_values(rows['method'])}: every state that motions end in"
    )
    found = f"periods of the response found: {', '.join(map(str, periods))}" if periods else "nothing repeats"
    wild = "; grey where the motion does not repeat" if (rows["period"] == 0).any() else ""
    caption = escape(
        f"{told}, above the means over a whole period (with the range of means over one drive period), below the "
        f"position at the start of each drive period. A marker for each period of the response{wild}; {found}."
    )
    return Picture(name, address(saved.folder / "figures" / name), Markup(caption), str(caption), False)


def _picture(
    saved: Saved, family: Family, name: str, columns: Sequence[str], maps: MapFigure | None, first: bool
) -> Picture:
    drawn = _drawn(family, columns) if maps is None else _mapped(maps, columns)
    caption = Markup(". ").join([drawn, *(_told(saved, family, maps) if first else _as_before(maps))]) + "."
    spans = [_span(saved, column) for column in columns]
    description = f"{caption.striptags()} {' '.join(spans)}"
    alone = maps is None and len(family.panels) * len(columns) == 1
    return Picture(name, address(saved.folder / "figures" / name), caption, description, alone)


def address(path: Path) -> str:
    """A figure's data as an address of its own; empty where there is no such file."""
    files = [file for suffix in _KINDS if (file := path.with_suffix(suffix)).is_file()]
    if not files:
        return ""
    first = files[0]
    if first.stat().st_size > LARGEST_SVG:
        first = min(files, key=lambda file: file.stat().st_size)
    return f"data:{_KINDS[first.suffix]};base64,{base64.b64encode(first.read_bytes()).decode('ascii')}"


def _drawn(family: Family, columns: Sequence[str]) -> Markup:
    """What is drawn against what."""
    shown = Markup(", ").join(word_html(column) for column in columns)
    return Markup("{} against {}").format(_capital(shown), word_html(family.abscissa))


def _mapped(maps: MapFigure, columns: Sequence[str]) -> Markup:
    """What is drawn over which two numbers."""
    shown = Markup(", ").join(word_html(column) for column in columns)
    over = Markup(" and ").join(word_html(name) for name in maps.over)
    return Markup("{} over {}, in shades with lines of equal value").format(_capital(shown), over)


def _told(saved: Saved, family: Family, maps: MapFigure | None) -> list[Markup]:
    """What tells curves apart, what is held fixed, what has no number."""
    laws, methods = (joined_values(saved.table[name]) for name in ("law", "method"))
    lines = (
        [Markup("Laws: {}; methods: {}").format(laws, methods)]
        if maps
        else [*_lines(family), *_panels(family)]
    )
    return [*lines, *_fixed(saved), *_missing(saved)]


def _as_before(maps: MapFigure | None) -> list[Markup]:
    return [] if maps else [Markup("Lines as in Figure 1")]


def _capital(text: Markup) -> Markup:
    return Markup(text[:1].upper() + text[1:])


def _lines(family: Family) -> list[Markup]:
    """Laws, methods and swept values, each named where there are several."""
    laws = list(dict.fromkeys(curve.law for curve in family.curves))
    methods = list(dict.fromkeys(curve.method for curve in family.curves))
    told = [
        Markup("{} {}").format(
            "Law" if len(laws) == 1 else "A colour and dashes for each law:", joined_values(laws)
        )
    ]
    told += [
        Markup("{} {}").format(
            "method" if len(methods) == 1 else "methods, one line where their curves coincide:",
            joined_values(methods),
        )
    ]
    sentence = Markup("; ").join(told)
    if family.member is None:
        return [sentence]
    swept = {
        curve.place[1]: curve.member[1]
        for curve in family.curves
        if curve.member is not None and curve.member[1] is not None
    }
    members = [swept[place] for place in sorted(swept)]
    name, unit = symbol_html(family.member), unit_html(family.member)
    return [sentence, Markup("A curve for each {} = {}{}").format(name, values_listed(members), unit)]


def _panels(family: Family) -> list[Markup]:
    names = list(dict.fromkeys(name for panel in family.panels for name, _ in panel))
    if not names:
        return []
    return [Markup("A picture for each {}").format(Markup(", ").join(symbol_html(name) for name in names))]


def _fixed(saved: Saved) -> list[Markup]:
    """The values of the scene that are the same in every point."""
    values = {f"scene.{path}": value for path, value in saved.study.scene.given_values().items()}
    fixed = [setting(name, value) for name, value in values.items() if name not in saved.study.sweep]
    return [Markup("Held fixed: {}").format(Markup(", ").join(fixed))] if fixed else []


def _missing(saved: Saved) -> list[Markup]:
    """How many points have no number, which the figures show as marks."""
    without = {status: count for status, count in saved.counts.items() if status != "ok"}
    told = [f"{counted(count, 'point')} {status.replace('_', ' ')}" for status, count in without.items()]
    return [Markup("Without a number, and marked as such: {}").format(", ".join(told))] if told else []


def _span(saved: Saved, column: str) -> str:
    found = saved.table[column].dropna()
    return f"{word_html(column).striptags()}: from {found.min():.4g} to {found.max():.4g}."
