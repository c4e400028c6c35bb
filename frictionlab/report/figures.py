"""Figures of a run, inside the page, each with a caption made from the study."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from markupsafe import Markup, escape
from pandas import DataFrame

from frictionlab.charts.bifurcation import bifurcations
from frictionlab.charts.curves import Family
from frictionlab.charts.figures import OTHER_FIGURES
from frictionlab.report.facts import Facts
from frictionlab.report.question import given_of, is_taken, values_listed
from frictionlab.report.tables import joined_values, settings, symbol_html, unit_html, word_html
from frictionlab.runner.results import folder_of
from frictionlab.runner.words import counted

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


def pictures(run: Facts) -> list[Picture]:
    """Return the figures of a run, first the one that answers its question; one not in its folder has no address.

    The first caption says what lines mean and what is held fixed; the others lead to it. Those that only some tables
    have are there where they were drawn.
    """
    data, attractors = run.figures, run.saved.attractors
    several = {} if attractors is None else bifurcations(data.shown(attractors))
    drawn = {file.stem for file in (folder_of(run.saved) / "figures").glob("*")}
    expected = sorted(data.columns, key=data.rank)[:1]
    names = sorted({*expected, *(drawn & {*data.columns, *OTHER_FIGURES, *several})}, key=data.rank)
    of_curves = {*data.columns, "differences"}
    lines_in = next((at for at, name in enumerate(names, 1) if name in of_curves), 0)

    def told(at: int, name: str) -> Picture:
        if name in of_curves:
            return _of_table(run, name, lines_in if at != lines_in else 0)
        return _of_bifurcation(run, name, several[name]) if name in several else _of_kept(run, name)

    return [told(*each) for each in enumerate(names, 1)]


def _picture(run: Facts, name: str, caption: Markup, more: str = "", narrow: bool = False) -> Picture:
    data = address(folder_of(run.saved) / "figures" / name)
    return Picture(name, data, caption, f"{caption.striptags()}{more}", narrow)


def address(path: Path) -> str:
    """A figure's data as an address of its own; empty where there is no such file."""
    files = [file for suffix in _KINDS if (file := path.with_suffix(suffix)).is_file()]
    if not files:
        return ""
    first = files[0]
    if first.stat().st_size > LARGEST_SVG:
        first = min(files, key=lambda file: file.stat().st_size)
    return f"data:{_KINDS[first.suffix]};base64,{base64.b64encode(first.read_bytes()).decode('ascii')}"


def _of_kept(run: Facts, name: str) -> Picture:
    family = run.figures.family
    narrow = family is None or len(family.panels) == 1
    return _picture(run, name, _described(run, name) + ".", narrow=narrow)


def _described(run: Facts, name: str) -> Markup:
    return escape(f"{run.figures.described(name)}{OTHER_FIGURES[name][1]}")


def _of_bifurcation(run: Facts, name: str, rows: DataFrame) -> Picture:
    """Every state that motions end in along one curve."""
    periods = sorted({int(period) for period in rows["period"]} - {0})
    found = f"periods of the response found: {', '.join(map(str, periods))}" if periods else "nothing repeats"
    wild = "; grey where the motion does not repeat" if (rows["period"] == 0).any() else ""
    caption = Markup(
        "Law {}, method {}: every state that motions end in, above the means over a whole period (with the range "
        "of means over one drive period), below the position at the start of each drive period. A marker for each "
        "period of the response{}; {}."
    ).format(joined_values(rows["law"].unique()), joined_values(rows["method"].unique()), wild, found)
    return _picture(run, name, caption)


def _of_table(run: Facts, name: str, lines_in: int = 0) -> Picture:
    """Describe one of the table; lines_in: number of the figure whose caption says what lines mean, 0 for its own."""
    family, maps, table = run.figures.family, run.figures.maps, run.figures.table
    assert family is not None
    axes, columns = run.figures.axes_of(name) if name in run.figures.columns else ([], [])
    over, shown = Markup(" and ").join(map(word_html, axes)), Markup(", ").join(map(word_html, columns))
    shown = Markup(shown[:1].upper() + shown[1:])
    if maps is None:
        told = Markup("{} against {}").format(shown, over) if columns else _described(run, name)
        drawn = [each for each in family.curves if name != "differences" or each.law != run.figures.reference]
        lines = [*_lines(replace(family, curves=drawn))]
    else:
        told = Markup("{} over {}, in shades with lines of equal value").format(shown, over)
        lines = [
            Markup("Laws: {}; methods: {}").format(
                *(joined_values(table[each].unique()) for each in ("law", "method"))
            )
        ]
    same = [Markup(f"Lines as in Figure {lines_in}")] if maps is None else []
    caption = Markup(". ").join([told, *(same if lines_in else [*lines, *_held_and_missing(run)])])
    ends = {word_html(column).striptags(): (table[column].min(), table[column].max()) for column in columns}
    spans = "".join(f" {words}: from {low:.4g} to {high:.4g}." for words, (low, high) in ends.items())
    beside = maps is not None and name == "mean_friction" and run.figures.error_seen
    pictures = len(family.panels if maps is None else maps.pictures) * (max(1, len(columns)) + beside)
    return _picture(run, name, caption + ".", spans, pictures == 1)


def _lines(family: Family) -> Iterator[Markup]:
    """Laws, methods and swept values, each named where there are several; what each picture is for."""
    laws, methods = ({getattr(curve, name): None for curve in family.curves} for name in ("law", "method"))
    law = "Law" if len(laws) == 1 else "A colour and dashes for each law:"
    method = "method" if len(methods) == 1 else "methods, one line where their curves coincide:"
    yield Markup("{} {}; {} {}").format(law, joined_values(laws), method, joined_values(methods))
    if family.member is not None:
        members = {curve.place[1]: curve.member.value for curve in family.curves if curve.member}
        values = [value for _, value in sorted(members.items()) if value is not None]
        names = symbol_html(family.member), values_listed(values), unit_html(family.member)
        yield Markup("A curve for each {} = {}{}").format(*names)
    if panels := dict.fromkeys(name for panel in family.panels for name, _ in panel):
        yield Markup("A picture for each {}").format(Markup(", ").join(map(symbol_html, panels)))


def _held_and_missing(run: Facts) -> Iterator[Markup]:
    """List the values of the scene, no defaults, that all points share; count points with a mark for a number."""
    study = run.saved.study
    given = given_of(study, defaults=False).items()
    fixed = {name: value for name, value in given if name not in study.sweep and not is_taken(study, name)}
    if fixed:
        yield Markup("Held fixed: {}").format(settings(fixed))
    counts = {status.replace("_", " "): count for status, count in run.saved.counts.items() if status != "ok"}
    if told := [f"{counted(count, 'point')} {status}" for status, count in counts.items()]:
        yield Markup("Without a number, and marked as such: {}").format(", ".join(told))
