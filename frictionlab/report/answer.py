"""First three paragraphs of a report: who is highest where, how the curves bend, what needs attention."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pandas as pd
from markupsafe import Markup, escape

from frictionlab.charts.sweeps import sweep_of
from frictionlab.report import sentences as say
from frictionlab.report.facts import CurveRows, Facts
from frictionlab.report.findings import above_tolerance, why_missing, with_remark
from frictionlab.report.sentences import tell
from frictionlab.report.tables import (
    Cell,
    listed,
    minus,
    named,
    number,
    settings,
    symbol_html,
    the,
    unit_html,
)
from frictionlab.runner.pairs import NOBODY, Difference, Ranking, best_rows, ranking_of
from frictionlab.runner.table import swept_inputs
from frictionlab.runner.words import counted
from frictionlab.values.columns import SHAPES
from frictionlab.values.printable import MOST_DIGITS, with_error

MOST_TOLD = 4
"""Places at which two means are told to be apart."""
IN_SHORT = 3
"""Digits of a distance that is told in a sentence."""
OF_A_PLACE = 4
"""Digits of a swept value in a sentence."""
MOST_CURVES_NAMED = 6
"""Curves of which each is named; of more, what tells those of one shape from the others, else how many they are."""
FEW = 3
"""Curves of one shape that are named among many."""
MOST_VALUES = 4
"""Laws, or values of what is swept, that are named in place of all their curves."""


def paragraphs(run: Facts) -> list[Markup]:
    """Write three paragraphs on a run: its means, the shapes of its curves, what needs attention."""
    return [means_told(run), shapes_told(run), attention_told(run)]


def means_told(run: Facts) -> Markup:
    """Tell who has the highest mean friction where, and by how much; of one alone, between what it lies."""
    best = best_rows(run.table)
    if best.empty:
        return tell(say.NO_MEANS, run.table)
    if not (found := [*_models(run)]):
        along = sweep_of(run.table).along or run.speed
        ranking = ranking_of(run.table, along)
        found = [_curve(run, best, along)] if ranking is None else [*_ranked(run, ranking, along)]
        found += _of_methods(run)
    silent = (tell(say.ON_SILENT, rows, law=law) for law, rows in run.table.groupby("law", sort=False))
    return Markup(" ").join(filter(None, [*found, *silent]))


def _far(value: float, error: float, where: Mapping[str, Any], digits: int = IN_SHORT) -> Markup:
    """A number with its error, and where it is found."""
    far, place = minus(with_error(float(value), float(error), digits)), settings(where, OF_A_PLACE)
    return Markup("{} at {}").format(far, place) if place else escape(far)


def _models(run: Facts) -> Iterator[Markup]:
    """Reduced models against the full answers beside them; each once, where it is furthest off, if these are many."""
    pairs = [pair for pair in run.method_pairs if pair.one in run.reduced and pair.other not in run.reduced]
    pairs.sort(key=lambda pair: -abs(pair.value))
    if len(pairs) > MOST_TOLD:
        whose = [(pair.law, pair.one) for pair in pairs]
        pairs = [pair for at, pair in enumerate(pairs) if whose.index(whose[at]) == at][:MOST_TOLD]
    of_law = " of {}" if run.table["law"].nunique() > 1 else ""
    return (_pair(say.ON_MODEL, pair, of_law.format(pair.law)) for pair in pairs)


def _pair(sentences: say.Sentences, pair: Difference, of_law: str = "") -> Markup:
    far = _far(abs(pair.value), pair.error, pair.where)
    return tell(sentences, pair, one=f"{the(pair.one)}{of_law}", other=the(pair.other), far=far)


def _of_methods(run: Facts) -> Iterator[Markup]:
    """Tell where the methods of one law differ most; errors of reduced models beside which no full answers stand."""
    if run.method_pairs and run.table["law"].nunique() == 1:
        yield _pair(say.ON_METHODS, max(run.method_pairs, key=lambda each: (each.apart > 0, abs(each.value))))
    rows = run.table[run.table["method"].isin(run.reduced) & run.table["error"].notna()]
    for method, own in rows.groupby("method", sort=False):
        worst = own.loc[own["error"].idxmax()]
        far = _far(worst["error"], 0.0, run.where(worst))
        yield tell(say.ON_OWN_ERROR, worst, one=the(str(method)), far=far)


def _curve(run: Facts, best: pd.DataFrame, along: str) -> Markup:
    """Tell between what the mean friction of one law lies, and where."""
    rows = best.sort_values(along, kind="stable").set_index(along, drop=False)
    names = dict.fromkeys([*swept_inputs(best), along if best[along].nunique() > 1 else run.speed])
    before, after = say.passes_zero(rows) or (0, 0)
    least, most = rows["mean_friction"].argmin(), rows["mean_friction"].argmax()
    places = {"first": 0, "last": -1, "least": least, "most": most, "before": before, "after": after}
    digits = IN_SHORT if len(rows) > 1 else MOST_DIGITS
    slots = {
        slot: _far(row["mean_friction"], row["error"], {name: row[name] for name in names}, digits)
        for slot, row in ((slot, rows.iloc[place]) for slot, place in places.items())
    }
    return tell(say.ON_CURVE, rows, law=rows["law"].iloc[0], points=counted(len(rows), "point"), **slots)


def _ranked(run: Facts, ranking: Ranking, along: str) -> Iterator[Markup]:
    """Tell who is highest where, and how far apart the highest and the lowest are at most."""
    names, count = [*map(named, ranking.ranked)], len(ranking.first)
    speeds = list(ranking.points) == [along] and "belt_speed" in along
    everywhere = f" at all {counted(count, 'belt speed' if speeds else 'point')}" if count > 1 else ""
    who = {NOBODY: "none beyond errors"} | dict(enumerate(names))
    stretches = ranking.stretches[: say.MOST_STRETCHES]
    winners = listed(
        [Markup("{} {}").format(who[at], _stretch(ranking.points, *ends)) for at, *ends in stretches]
    )
    everyone = listed(names) if len(names) <= MOST_TOLD else f"{len(names)} curves"
    slots = {"names": everyone, "winner": who[ranking.first[0]], "winners": winners}
    yield tell(say.ON_RANKED, ranking, everywhere=everywhere, **slots)
    if not say.is_tied(ranking):
        yield from _apart(run, ranking, along)


def _apart(run: Facts, ranking: Ranking, along: str) -> Iterator[Markup]:
    """Tell where highest and lowest are furthest apart; of many, where one is from the reference law."""
    names, laws = [*map(named, ranking.ranked)], [each["law"] for each in ranking.ranked]
    in_short = say.is_won(ranking) or say.changes(ranking)
    held = len({*laws}) > 2 and laws.count(run.figures.reference) == 1 and not in_short
    against = laws.index(run.figures.reference) if held else None
    group, places = say.ON_FURTHEST if held else say.ON_LAWS, ranking.points.to_dict("records")
    widest = ranking.widest(along, 0 if in_short else MOST_TOLD, against)
    if len(places) == 1:
        group, places, widest = say.ON_NEXT, [{}], [(0, ranking.first[0], ranking.second[0])]
    for at, high, low in widest:
        one, other = (low, high) if high == against else (high, low)
        mean, error = ranking.mean[at], ranking.error[at]
        value, slack = mean[one] - mean[other], error[one] + error[other]
        slots = {"one": names[one], "other": names[other], "mean": with_error(mean[one], error[one])}
        yield tell(group, value, far=_far(value, slack, places[at]), **slots)


def _stretch(points: pd.DataFrame, start: int, stop: int) -> Markup:
    """Neighbouring points on one axis."""
    first, last = (settings(points.iloc[at].to_dict(), OF_A_PLACE) for at in (start, stop))
    if start == stop:
        return Markup("at {}").format(first)
    return Markup("from {} to {}").format(first, last) if start else Markup("up to {}").format(last)


def shapes_told(run: Facts) -> Markup:
    """Tell the shapes of the curves, and why some have none."""
    table = run.saved.curves
    if table is None or "shape" not in table or table.empty:
        return tell(say.NO_SHAPE, pd.DataFrame({"shape": []}))
    shaped, bare = run.curves_of(table[table["shape"].notna()]), table[table["shape"].isna()]
    found, reasons = _verdicts(run, shaped), [reason for _, reason in why_missing(bare)]
    said = [tell(say.ON_BENDS, own[0].rows, who=_who(own, found)) for own in _by_shape(found)]
    said += _otherwise(run, shaped, found)
    if len(found) == 1:
        area = with_error(*found[0].rows[["shape_area", "shape_area_error"]].abs().iloc[0])
        said.append(tell(say.ON_AREA, found[0].rows, area=area))
    without = f"{len(bare)} of {counted(len(table), 'curve')}"
    why = f"{reasons[0]}{', and other reasons' * (len(reasons) > 1)}" if reasons else "nothing says why"
    said.append(tell(say.NO_SHAPE, table, without=without, why=why))
    if found:
        said.append(tell(say.ON_ENDS, pd.concat(curve.rows for curve in found), end=_end(run, found)))
    return Markup(" ").join(filter(None, said))


def _shape(curve: CurveRows) -> str:
    return str(curve.row["shape"])


def _by_shape(curves: Sequence[CurveRows]) -> list[list[CurveRows]]:
    """Curves of each shape, those of one shape together."""
    groups = [[curve for curve in curves if _shape(curve) == shape] for shape in SHAPES["area"]]
    return [own for own in groups if own]


def _end(run: Facts, found: Sequence[CurveRows]) -> Markup:
    """Tell where slip stops reversing: at one belt speed, or between which; of ends known to some digits."""
    known = [curve for curve in found if len(say.known_ends(curve.rows))]
    ends = [curve.measure("reversal_end") for curve in known]
    if not ends:
        return Markup("")
    (low, low_error), (high, high_error) = min(ends), max(ends)
    best = with_error(*min(ends, key=lambda each: each[1]))
    where = f"= {best}" if high - low <= low_error + high_error else f"from {low:.4g} to {high:.4g}"
    told_end = Markup('<span class="short">{} {}{}</span>')
    return told_end.format(symbol_html(run.speed), where, unit_html(run.speed))


def _verdicts(run: Facts, curves: Sequence[CurveRows]) -> list[CurveRows]:
    """Select one for each law and set of swept values: of the first method that decides it, full ones first."""
    found: dict[tuple[str, ...], CurveRows] = {}
    for curve in sorted(curves, key=lambda curve: curve.method in run.reduced):
        first = found.setdefault(curve.of, curve)
        if _shape(first) == "undecided" and curve.method not in run.reduced:
            found[curve.of] = curve
    return list(found.values())


def _otherwise(run: Facts, curves: Sequence[CurveRows], found: Sequence[CurveRows]) -> Iterator[Markup]:
    """Curves of reduced models that bend another way than the full ones."""
    full = {curve.of: _shape(curve) for curve in found}
    for method in dict.fromkeys(curve.method for curve in curves if curve.method in run.reduced):
        own = [curve for curve in curves if curve.method == method]
        others = [curve for curve in own if full[curve.of] not in ("undecided", _shape(curve))]
        for group in _by_shape(others):
            slots = {"model": the(method), "shape": _shape(group[0]), "who": _who(group, own)}
            yield tell(say.ON_OTHERWISE, group[0].rows, **slots)


def _who(own: Sequence[CurveRows], among: Sequence[CurveRows]) -> Markup | str:
    """Curves by name where these are few, by what all of them and no others have, or by how many they are."""
    if len(own) == len(among) > 1:
        return f"all {len(own)} curves"
    if len(among) <= MOST_CURVES_NAMED or len(own) == 1:
        return _names(own, among)
    for name in ("law", *own[0].where):
        values = dict.fromkeys(_value(curve, name) for curve in own)
        alike_ones = [curve for curve in among if _value(curve, name) in values]
        if "" not in values and len(values) <= MOST_VALUES and len(alike_ones) == len(own):
            return Markup("all {} curves for {}").format(len(own), listed([*values]))
    return _names(own, among) if len(own) <= FEW else f"{len(own)} of {len(among)} curves"


def _value(curve: CurveRows, name: str) -> Cell:
    return curve.law if name == "law" else settings({name: curve.where[name]})


def _names(own: Sequence[CurveRows], among: Sequence[CurveRows]) -> Markup:
    """Curves by their laws, and by what does not have one value in all."""
    varied = [name for name in own[0].where if len({each.where[name] for each in among}) > 1]
    return listed([named({"law": each.law} | {name: each.where[name] for name in varied}) for each in own])


def attention_told(run: Facts) -> Markup:
    """Tell what needs attention; that nothing does, and what was looked at."""
    saved, table = run.saved, run.table
    passed = [verdict.passed for verdict in saved.verdicts]
    held = {"failed": passed.count(False), "expected": counted(len(passed), "expectation")}
    trouble = [*_unanswered(run), *_rough_or_remarked(run), tell(say.ON_FAILED, passed, **held)]
    needed = Markup("; ").join(filter(None, trouble))
    first = tell(say.ON_NEEDED, needed, trouble=needed, points=counted(saved.size, "point"))
    if needed:
        return first
    full = table[~table["method"].isin(run.reduced)]
    besides = ", but for what models leave out" if len(full) < len(table) else ""
    errors = tell(say.ON_WELL, full, error=f"{full['error'].max():.1e}", besides=besides)
    return Markup(" ").join(filter(None, [first, errors, tell(say.ON_HELD, passed, **held)]))


def _unanswered(run: Facts) -> Iterator[Markup]:
    """Points that an interruption left, then those of another status, with between what means lie."""
    for status in sorted(run.saved.counts, key=lambda each: each != "killed"):
        rows, words = run.table[run.table["status"] == status], status.replace("_", " ")
        points = _whose(run, rows, f"{run.saved.counts[status]} of {counted(run.saved.size, 'point')}")
        seen = rows.reindex(columns=["mean_low", "mean_high"])
        low, high = (number(each, IN_SHORT) for each in (seen["mean_low"].min(), seen["mean_high"].max()))
        if clause := tell(say.ON_UNANSWERED, words, status=words, points=points):
            yield clause + tell(say.ON_SEEN, rows, low=low, high=high)


def _rough_or_remarked(run: Facts) -> Iterator[Markup]:
    """Errors above the tolerance, and points that are ok with something else to note."""
    rough = above_tolerance(run, run.table) & ~run.table["method"].isin(run.reduced)
    for sentences, which in ((say.ON_ROUGH, rough), (say.ON_REMARKS, with_remark(run) & ~rough)):
        rows = run.table[which]
        slots = {"error": f"{rows['error'].max():.2g}", "tolerance": f"{run.saved.study.tolerance:g}"}
        yield tell(sentences, rows, points=_whose(run, rows, counted(len(rows), "point")), **slots)


def _whose(run: Facts, rows: pd.DataFrame, points: str) -> Markup:
    """Add whose the points are, where that is not everybody's."""
    by = {"law": "", "method": "by "}
    several = [name for name in by if 0 < rows[name].nunique() < run.table[name].nunique()]
    whose = [Markup("{}{}").format(by[name], listed([*rows[name].unique()])) for name in several]
    return Markup("{} ({})").format(points, Markup(", ").join(whose)) if whose else escape(points)
