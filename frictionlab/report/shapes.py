"""The shape of curves on a page: a sentence on their verdicts, a table of their measures."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import pandas as pd
from markupsafe import Markup

from frictionlab.report.facts import CurveRows, Facts, whose
from frictionlab.report.tables import (
    Cell,
    Grid,
    grid,
    listed,
    named,
    setting,
    size,
    symbol_html,
    the,
    unit_html,
)
from frictionlab.runner.summary import alike, pattern
from frictionlab.runner.words import counted
from frictionlab.values.columns import ALSO_IN_SI
from frictionlab.values.printable import with_error

MOST_CURVES_NAMED = 6
"""Curves that are named one by one; more are told by what parts their shapes best, else counted."""
MOST_OF_A_SHAPE = 3
"""Curves of one shape that are named among more of another."""
MOST_GROUPS = 4
MEANING = {
    "concave": ("above its chord", "above their chords"),
    "convex": ("below its chord", "below their chords"),
    "mixed": ("on both sides of its chord", "on both sides of their chords"),
    "undecided": ("its errors leave it open", "their errors leave it open"),
}
"""Of each verdict what it says of one curve, and of several."""
CONTRADICTORY = [{"concave", "convex"}, {"concave", "mixed"}, {"convex", "mixed"}]
"""Verdicts on the same curve that speak against each other."""
SHAPE_HEADS = {
    "shape": "shape",
    "shape_area": "area between curve and chord",
    "reversal_end": "end of reversal",
    "reduction": "largest reduction",
    "shape_half": "share at half the range",
    "shape_initial": "curvature at rest",
    "shape_by_initial": "shape at rest",
    "model_distance": "distance to the full curve",
    "not_unique_from": "not unique from",
    "not_unique_to": "not unique to",
}
"""Columns of ``curves.csv`` that are shown, and their heads."""


def shape_sentence(run: Facts) -> Markup:
    """The shapes of the curves in words; why there is none."""
    curves = run.saved.curves
    if curves is None or curves.empty or "shape" not in curves:
        return Markup("No curve has two belt speeds, so none has a shape.")
    found, without = _verdicts(run, curves), int(curves["shape"].isna().sum())
    if not found:
        return Markup("No curve has a shape: {}.").format(_why_not(curves))
    told = _one(found[0]) if len(found) == 1 else _several(found, every=not without)
    has = "has" if without == 1 else "have"
    rest = f"; {counted(without, 'curve')} {has} no shape ({_why_not(curves)})" if without else ""
    return Markup("{}{}{}. {}").format(told, _otherwise(run, curves, found), rest, _end(run, found))


def _end(run: Facts, found: Sequence[CurveRows]) -> Markup:
    """Where slip stops reversing: one belt speed for all, or between which; those known to more than themselves."""
    name = "reversal_end"
    ends = [run.speed_in_given_units(curve, curve.first(name, f"{name}_error"), name) for curve in found]
    known = [(value, error) for value, error in ends if error <= abs(value)]
    if not known:
        return Markup("Where slip stops reversing is left open by errors.")
    (low, low_error), (high, high_error) = min(known), max(known)
    alike = high - low <= low_error + high_error
    best = with_error(*min(known, key=lambda each: each[1]))
    where = f"= {best}" if alike else f"from {low:.4g} to {high:.4g}"
    told = Markup('Slip stops reversing at <span class="short">{} {}{}</span>.')
    return told.format(symbol_html(run.speed), where, unit_html(run.speed))


def _why_not(curves: pd.DataFrame) -> str:
    """The commonest reason of curves without a shape."""
    reasons = curves.loc[curves["shape"].isna(), "reason"].dropna()
    kinds = reasons.groupby(reasons.map(pattern), sort=False)
    most = max((list(kind) for _, kind in kinds), key=len, default=["nothing says why"])
    others = len(reasons) - len(most)
    return alike(most) + (f"; {counted(others, 'curve')} for other reasons" if others > 0 else "")


def _verdicts(run: Facts, curves: pd.DataFrame) -> list[CurveRows]:
    """One for each law and set of swept values: of the first method that decides it, full ones first."""
    found: dict[tuple[str, ...], CurveRows] = {}
    read = run.curves_of(curves[curves["shape"].notna()])
    for curve in sorted(read, key=lambda curve: curve.method in run.reduced):
        who = curve.of
        if who not in found or (_shape(found[who]) == "undecided" and curve.method not in run.reduced):
            found[who] = curve
    return list(found.values())


def _otherwise(run: Facts, curves: pd.DataFrame, found: Sequence[CurveRows]) -> Markup:
    """Which reduced models have curves of another shape than the full ones."""
    if not run.reduced:
        return Markup("")
    full = {curve.of: _shape(curve) for curve in found}
    own = [each for each in run.curves_of(curves[curves["shape"].notna()]) if each.method in run.reduced]
    told = Markup("")
    for method in dict.fromkeys(each.method for each in own):
        of_it = [each for each in own if each.method == method]
        others = [each for each in of_it if {_shape(each), full[each.of]} in CONTRADICTORY]
        if others:
            shapes = listed([*dict.fromkeys(_shape(each) for each in others)])
            which = (
                f"{len(others)} of {len(of_it)} curves"
                if len(others) > MOST_OF_A_SHAPE
                else "it"
                if len(of_it) == 1
                else Markup("{} for {}").format(
                    "that" if len(others) == 1 else "those", _names(others, of_it)
                )
            )
            told += Markup("; by {} {} {} {}").format(the(method), which, _be(others), shapes)
    return told


def _shape(curve: CurveRows) -> str:
    return str(curve.first("shape")["shape"])


def _one(curve: CurveRows) -> Markup:
    row, shape = curve.rows.iloc[0], _shape(curve)
    area = with_error(abs(row["shape_area"]), row["shape_area_error"])
    share = f", by {area} of the area under it" if shape in ("concave", "convex") else ""
    told = Markup('The curve of {} is <a href="#shape">{}</a> ({}{})')
    return told.format(curve.law, shape, MEANING[shape][0], share)


def _several(found: Sequence[CurveRows], every: bool) -> Markup:
    """every: whether these are all curves."""
    parts = {shape: [curve for curve in found if _shape(curve) == shape] for shape in MEANING}
    parts = {shape: own for shape, own in parts.items() if own}
    if len(parts) == 1:
        which = ("Both" if len(found) == 2 else f"All {len(found)}") if every else len(found)
        return Markup("{} curves are {}").format(which, _linked(next(iter(parts)), len(found)))
    if len(found) <= MOST_CURVES_NAMED:
        named_ones = [_named(own, shape, found, not at) for at, (shape, own) in enumerate(parts.items())]
        return Markup("; ").join(named_ones)
    groups = _groups(found)
    if not groups:
        most = max(map(len, parts.values()))
        counts = [
            Markup("{}{} {}").format(
                len(own), "" if at else f" {_be(own)}", _linked(shape, len(own), _few(own, found, most))
            )
            for at, (shape, own) in enumerate(parts.items())
        ]
        return Markup("Of {} curves {}").format(len(found), listed(counts))
    told = []
    for where, curves in groups.items():
        most = max(Counter(map(_shape, curves)).values())
        kinds = [
            Markup("{} {}").format(
                "all" if len(own) == len(curves) else len(own),
                _linked(shape, len(own), _few(own, curves, most)),
            )
            for shape in MEANING
            if (own := [curve for curve in curves if _shape(curve) == shape])
        ]
        told.append(Markup("{}: {}").format(where, Markup(", ").join(kinds)))
    return Markup("Curves for {}").format(Markup("; for ").join(told))


def _groups(found: Sequence[CurveRows]) -> dict[Cell, list[CurveRows]]:
    """Curves by law, or by one of the swept values: by what parts their shapes best; none where nothing does."""
    most, best = max(Counter(map(_shape, found)).values()), dict[Cell, list[CurveRows]]()
    for name in ("law", *found[0].where):
        groups: dict[Cell, list[CurveRows]] = {}
        for curve in found:
            value = curve.law if name == "law" else setting(name, curve.where[name])
            groups.setdefault(value, []).append(curve)
        alike = sum(max(Counter(map(_shape, curves)).values()) for curves in groups.values())
        if 2 <= len(groups) <= MOST_GROUPS and alike > most:
            most, best = alike, groups
    return best


def _named(own: Sequence[CurveRows], shape: str, found: Sequence[CurveRows], first: bool) -> Markup:
    """Curve labels, grouped by shape."""
    one_law, names = len({each.law for each in found}) == 1, _names(own, found)
    subject = ("The curves", "The curve") if first else ("those", "that")
    law = Markup(" of {}").format(found[0].law) if one_law and first else ""
    of = Markup(" for {}" if one_law else " of {}").format(names)
    return Markup("{}{}{} {} {}").format(subject[len(own) == 1], law, of, _be(own), _linked(shape, len(own)))


def _names(own: Sequence[CurveRows], among: Sequence[CurveRows]) -> Markup:
    """Curves by what tells them from others: the law, and what does not have one value in all."""
    one_law = len({each.law for each in among}) == 1
    varied = [name for name in own[0].where if len({each.where[name] for each in among}) > 1]
    return listed(
        [named({"law": each.law} | {name: each.where[name] for name in varied}, one_law) for each in own]
    )


def _few(own: Sequence[CurveRows], among: Sequence[CurveRows], most: int) -> Markup:
    """The names of a few curves that are no others' shape."""
    return _names(own, among) if len(own) < most and len(own) <= MOST_OF_A_SHAPE else Markup("")


def _be(own: Sequence[CurveRows]) -> str:
    return "is" if len(own) == 1 else "are"


def _linked(shape: str, count: int, names: Markup | str = "") -> Markup:
    told = Markup(": {}").format(names) if names else ""
    return Markup('<a href="#shape">{}</a> ({}{})').format(shape, MEANING[shape][count > 1], told)


def shape_grid(run: Facts) -> Grid | None:
    """The measures of curves.csv, each with its error, the verdict first; None where no curve has a shape."""
    table = run.saved.curves
    own = (
        [] if table is None else [name for name in SHAPE_HEADS if name in table and table[name].notna().any()]
    )
    if table is None or {*own} <= {"reversal_end", "reduction"}:
        return None
    curves, unit = run.curves_of(table), unit_html(run.speed)
    rows = (
        [*who, *(_measure(run, curve, row, name) for name in own)]
        for who, curve in zip(whose(curves), curves, strict=True)
        for row in [curve.rows.iloc[0]]
    )
    heads = [Markup("{}{}").format(SHAPE_HEADS[name], unit if name in ALSO_IN_SI else "") for name in own]
    caption = "Shape of each curve against its chord, the line from rest to the end of reversal"
    found = grid(caption, ["law", "method", "curve", *heads], rows, "curves", "curves.csv", len(table))
    return found._replace(below=" ".join(filter(None, [found.below, *_missing(table)])))


def _missing(curves: pd.DataFrame) -> list[str]:
    """Why measures are missing, each reason once."""
    reasons = curves["reason"].dropna()
    kinds = reasons.groupby(reasons.map(pattern), sort=False)
    return [f"A measure is missing of {counted(len(kind), 'curve')}: {alike(kind)}." for _, kind in kinds]


def _measure(run: Facts, curve: CurveRows, row: pd.Series, name: str) -> Cell:
    if isinstance(row[name], str):
        return row[name]
    if pd.isna(row[name]):
        return ""
    if name in ALSO_IN_SI:
        return with_error(*run.speed_in_given_units(curve, row, name))
    return (
        size(row[name])
        if name == "model_distance"
        else with_error(float(row[name]), row.get(f"{name}_error"))
    )
