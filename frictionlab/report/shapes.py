"""The shape of curves on a page: a sentence on their verdicts, a table of their measures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import pandas as pd
from markupsafe import Markup

from frictionlab.columns import belt_speed
from frictionlab.printable import with_error
from frictionlab.report.curves import in_given_units, speed_scales
from frictionlab.report.markup import symbol_html, unit_html
from frictionlab.report.tables import MOST_ROWS, Grid, curve_rows, grid, listed, named, whose
from frictionlab.results.summary import alike, pattern
from frictionlab.results.table import swept_inputs
from frictionlab.results.words import counted
from frictionlab.runner.saved import Saved

MOST_CURVES_NAMED = 6
"""Curves that are named one by one; more are told by law where those of a law are alike, else counted."""
MEANING = {
    "concave": ("above its chord", "above their chords"),
    "convex": ("below its chord", "below their chords"),
    "mixed": ("on both sides of its chord", "on both sides of their chords"),
    "undecided": ("its errors leave it open", "their errors leave it open"),
}
"""Of each verdict what it says of one curve, and of several."""
MEASURES = {
    "shape": "shape",
    "shape_area": "area between curve and chord",
    "reversal_end": "end of reversal",
    "reduction": "largest reduction",
    "shape_half": "share at half the range",
    "shape_initial": "curvature at rest",
    "shape_by_initial": "shape at rest",
    "reason": "why a measure is missing",
}
"""Columns of ``curves.csv`` that are shown, and their heads."""


@dataclass(frozen=True, eq=False)
class _Verdict:
    """Of a curve: its key, whose it is, and the word for its shape."""

    key: str
    law: str
    where: Mapping[str, object]
    shape: str
    row: pd.Series


def shape_sentence(saved: Saved) -> Markup:
    """The shapes of the curves in words; why there is none."""
    curves = saved.curves
    if curves is None or curves.empty or "shape" not in curves:
        return Markup("No curve has two belt speeds, so no shape is read.")
    found = _verdicts(saved, curves)
    without = int(curves["shape"].isna().sum())
    if not found:
        return Markup("No shape is read: {}.").format(_why_not(curves))
    told = _one(found[0], saved) if len(found) == 1 else _several(found)
    rest = f"; of {counted(without, 'curve')} none is read ({_why_not(curves)})" if without else ""
    return Markup("{}{}.").format(told, rest)


def _why_not(curves: pd.DataFrame) -> str:
    """The commonest reason of curves without a shape."""
    reasons = curves.loc[curves["shape"].isna(), "reason"].dropna()
    kinds = reasons.groupby(reasons.map(pattern), sort=False)
    most = max((list(kind) for _, kind in kinds), key=len, default=["nothing says why"])
    others = len(reasons) - len(most)
    return alike(most) + (
        f"; {counted(others, 'curve')} for other reasons" if others and len(most) > 0 else ""
    )


def _verdicts(saved: Saved, curves: pd.DataFrame) -> list[_Verdict]:
    """One for each law and set of swept values: that of the first method whose verdict is decided."""
    told = _told(saved, curves)
    found: dict[str, _Verdict] = {}
    for curve in curve_rows(curves[curves["shape"].notna()], told):
        row = curve.rows.iloc[0]
        who = f"{curve.law}, {curve.name}"
        if who not in found or found[who].shape == "undecided":
            found[who] = _Verdict(curve.key, curve.law, curve.where, str(row["shape"]), row)
    return list(found.values())


def _told(saved: Saved, curves: pd.DataFrame) -> list[str]:
    return [name for name in swept_inputs(saved.table) if name in curves]


def _one(verdict: _Verdict, saved: Saved) -> Markup:
    row, name = verdict.row, belt_speed(saved.table)
    area = with_error(row["shape_area"], row["shape_area_error"])
    end = in_given_units(row, "reversal_end", speed_scales(saved.table).get(verdict.key, 1.0))
    return Markup(
        'The curve of {} is <a href="#shape">{}</a> ({}, the straight line from rest to the end of reversal at '
        '<span class="short">{} = {}{}</span>; area {})'
    ).format(
        verdict.law, verdict.shape, MEANING[verdict.shape][0], symbol_html(name), end, unit_html(name), area
    )


def _several(found: Sequence[_Verdict]) -> Markup:
    shapes = [shape for shape in MEANING if any(each.shape == shape for each in found)]
    if len(shapes) == 1:
        every = "Both" if len(found) == 2 else f"All {len(found)}"
        return Markup("{} curves are {}").format(every, _linked(shapes[0], len(found)))
    parts = [([each for each in found if each.shape == shape], shape) for shape in shapes]
    if len(found) <= MOST_CURVES_NAMED:
        return Markup("; ").join(
            _named(own, shape, found, not place) for place, (own, shape) in enumerate(parts)
        )
    told = [
        Markup("{}{} {}").format(
            len(own), "" if place else f" {_be(own)}", _linked(shape, len(own), _laws(own, found))
        )
        for place, (own, shape) in enumerate(parts)
    ]
    return Markup("Of {} curves {}").format(len(found), listed(told))


def _named(own: Sequence[_Verdict], shape: str, found: Sequence[_Verdict], first: bool) -> Markup:
    """Curve labels, grouped by shape."""
    one_law = len({each.law for each in found}) == 1
    names = listed([named({"law": each.law} | dict(each.where), one_law) for each in own])
    subject = ("The curves", "The curve") if first else ("those", "that")
    law = Markup(" of {}").format(found[0].law) if one_law and first else ""
    of = Markup(" for {}" if one_law else " of {}").format(names)
    return Markup("{}{}{} {} {}").format(subject[len(own) == 1], law, of, _be(own), _linked(shape, len(own)))


def _be(own: Sequence[_Verdict]) -> str:
    return "is" if len(own) == 1 else "are"


def _laws(own: Sequence[_Verdict], found: Sequence[_Verdict]) -> str:
    """The laws whose every curve is of one shape, where these are all of that shape; nothing otherwise."""
    laws = list(dict.fromkeys(each.law for each in own))
    whole = all(each in own for each in found if each.law in laws)
    several = len({each.law for each in found}) > len(laws)
    return Markup(": {}").format(listed(laws)) if whole and several else ""


def _linked(shape: str, count: int, whose: str = "") -> Markup:
    return Markup('<a href="#shape">{}</a> ({}{})').format(shape, MEANING[shape][count > 1], whose)


def shape_grid(saved: Saved) -> Grid | None:
    """The measures of curves.csv, each with its error, the verdict first; None where there are none."""
    curves = saved.curves
    if curves is None or not set(MEASURES) & set(curves):
        return None
    own = [name for name in MEASURES if name in curves]
    scales = speed_scales(saved.table)
    found = curve_rows(curves.head(MOST_ROWS), _told(saved, curves))
    each = [scales.get(curve.key, 1.0) for curve in found] if scales else [1.0] * len(found)
    rows = [
        [*who, *(_measure(curve.rows.iloc[0], name, scale) for name in own)]
        for who, curve, scale in zip(whose(found), found, each, strict=True)
    ]
    unit = unit_html(belt_speed(saved.table))
    heads = [Markup("{}{}").format(MEASURES[name], unit if name == "reversal_end" else "") for name in own]
    head = ["law", "method", "curve", *heads]
    return grid(
        "Shape of each curve against its chord, the line from rest to the end of reversal",
        head,
        rows,
        "curves",
        "curves.csv",
        len(curves) - len(rows),
    )


def _measure(row: pd.Series, name: str, scale: float) -> str:
    value = row[name]
    if value is None or pd.isna(value):
        return ""
    if isinstance(value, str):
        return value
    if name == "reversal_end":
        return in_given_units(row, name, scale)
    return with_error(float(value), row.get(f"{name}_error"))
