"""The first three sentences of a report: who is highest where, how the curves bend, what needs attention."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import pandas as pd
from markupsafe import Markup, escape

from frictionlab.charts.sweeps import sweep_of
from frictionlab.columns import belt_speed
from frictionlab.printable import with_error
from frictionlab.report.shapes import shape_sentence
from frictionlab.report.tables import listed, named, settings
from frictionlab.report.trouble import with_remark
from frictionlab.results.pairs import best_rows, method_pairs
from frictionlab.results.ranking import NOBODY, Ranking, ranking_of
from frictionlab.results.table import swept_inputs
from frictionlab.results.words import counted
from frictionlab.runner.saved import Saved

MOST_STRETCHES = 4
"""Stretches of the axis that are told one by one; of more, how many points each has."""


def sentences(saved: Saved) -> list[Markup]:
    """Three sentences on a run, made from its tables."""
    along = axis_of(saved.table)
    return [height_sentence(saved.table, along), shape_sentence(saved), attention_sentence(saved)]


def axis_of(table: pd.DataFrame) -> str:
    """The input along the axis of the figures; the belt speed where nothing is swept."""
    return sweep_of(table).along or belt_speed(table.columns)


def height_sentence(table: pd.DataFrame, along: str) -> Markup:
    """Who has the highest mean friction where, and by how much; of one alone, between what it lies."""
    best = best_rows(table)
    if best.empty:
        one = "one mean friction" if (table["status"] == "not_unique").any() else "a number"
        return Markup("No point has {}.").format(one)
    ranking = ranking_of(table, along)
    told = _span(best, along) if ranking is None else _ranking_in_words(ranking, along)
    silent = [law for law in table["law"].unique() if law not in set(best["law"])]
    without = Markup("; {} no number").format(_have(silent)) if silent else ""
    return Markup("{}{}{}.").format(told, _methods(table) if table["law"].nunique() == 1 else "", without)


def _have(laws: Sequence[str]) -> Markup:
    return Markup("{} {}").format(listed(laws), "has" if len(laws) == 1 else "have")


def _methods(table: pd.DataFrame) -> Markup:
    """Where the methods of one law differ most."""
    pairs = method_pairs(table)
    if not pairs:
        return Markup("")
    most = max(pairs, key=lambda each: (each.apart > 0, abs(each.value)))
    told = with_error(abs(most.value), most.error)
    where = Markup(" at {}").format(settings(most.where)) if most.where else ""
    which = "" if len(pairs) == 1 else "of the methods, "
    alike = ", the same within errors" if most.apart == 0 else ""
    return Markup("; {}{} and {} differ most, by {}{}{}").format(
        which, most.one, most.other, told, where, alike
    )


def _ranking_in_words(ranking: Ranking, along: str) -> Markup:
    size = len(ranking.first)
    laws = {each["law"] for each in ranking.ranked}
    what = Markup("Mean friction of {}").format(*laws) if len(laws) == 1 else Markup("Mean friction")
    if (ranking.first == NOBODY).all():
        names = listed([_name(ranking, who) for who in range(len(ranking.ranked))])
        return Markup("{} is the same within errors for {}{}").format(
            what, names, _everywhere(ranking, along)
        )
    gaps = Markup(" (of those with a number)") if ranking.has_gaps else ""
    if size == 1:
        return Markup("{} is highest for {}{}: {}").format(
            what, _name(ranking, ranking.first[0]), gaps, _excess(ranking)
        )
    return Markup("{} is highest for {}{}; {}").format(what, _winners(ranking, along), gaps, _excess(ranking))


def _everywhere(ranking: Ranking, along: str) -> str:
    return f" at all {_points(ranking, along)}" if len(ranking.first) > 1 else ""


def _winners(ranking: Ranking, along: str) -> Markup:
    """Each with where it is highest: stretches of the axis where these are few, else at how many points."""
    winners = [who for who in dict.fromkeys(ranking.first.tolist()) if who != NOBODY]
    tied = int((ranking.first == NOBODY).sum())
    if len(winners) == 1 and not tied:
        return Markup("{}{}").format(_name(ranking, winners[0]), _everywhere(ranking, along))
    if list(ranking.points) == [along] and len(ranking.stretches) <= MOST_STRETCHES:
        told = [
            Markup("{} {}").format(_name(ranking, who), _where(ranking, start, stop, along))
            for who, start, stop in ranking.stretches
            if who != NOBODY
        ]
        ties = [
            _where(ranking, start, stop, along) for who, start, stop in ranking.stretches if who == NOBODY
        ]
    else:
        counts = sorted(((int((ranking.first == who).sum()), -who) for who in winners), reverse=True)
        told = [Markup("{} at {}").format(_name(ranking, -who), count) for count, who in counts]
        told[0] = Markup("{} of {}").format(told[0], _points(ranking, along))
        ties = [Markup("at {}").format(tied)] if tied else []
    alike = [Markup("{} the highest are the same within errors").format(listed(ties))] if ties else []
    return Markup("; ").join([listed(told), *alike])


def _where(ranking: Ranking, start: int, stop: int, along: str) -> Markup:
    first, last = (settings({along: ranking.points[along].iloc[place]}) for place in (start, stop))
    if start == stop:
        return Markup("at {}").format(first)
    if start == 0:
        return Markup("up to {}").format(last)
    if stop == len(ranking.first) - 1:
        return Markup("from {} on").format(first)
    return Markup("from {} to {}").format(first, last)


def _excess(ranking: Ranking) -> Markup:
    """How far the highest is above the next, at most, and where."""
    at = ranking.largest_excess
    who, other = int(ranking.first[at]), int(ranking.second[at])
    excess = with_error(float(ranking.excess[at]), float(ranking.excess_error[at]))
    if len(ranking.first) == 1:
        value = with_error(float(ranking.mean[at, who]), float(ranking.error[at, who]))
        return Markup("{}, which is {} above {}, the next").format(value, excess, _name(ranking, other))
    where = settings(ranking.points.iloc[at].to_dict())
    told = "the largest distance to the next is {}, of {} above {} at {}"
    return Markup(told).format(excess, _name(ranking, who), _name(ranking, other), where)


def _name(ranking: Ranking, who: int) -> Markup:
    """What tells one from the others: its law where there are several, and its values."""
    return named(ranking.ranked[who], one_law=len({each["law"] for each in ranking.ranked}) == 1)


def _points(ranking: Ranking, along: str) -> str:
    speeds = list(ranking.points) == [along] and "belt_speed" in along
    return counted(len(ranking.first), "belt speed" if speeds else "point")


def _span(best: pd.DataFrame, along: str) -> Markup:
    """Between what the mean friction of one law lies, and where."""
    law = escape(str(best["law"].iloc[0]))
    names = dict.fromkeys(
        [*swept_inputs(best), *([along] if best[along].nunique() > 1 else [belt_speed(best)])]
    )
    rows = best.sort_values(along, kind="stable")
    ends = rows.iloc[0], rows.iloc[-1]
    mean, error = (rows[name].to_numpy(dtype=float) for name in ("mean_friction", "error"))
    if len(rows) == 1:
        return Markup("The mean friction coefficient of {} is {} at {}").format(
            law, _mean(ends[0]), _at(ends[0], names)
        )
    if mean.max() - mean.min() <= error[mean.argmax()] + error[mean.argmin()]:
        told = f"is the same within its errors at all {len(rows)} points:"
        return Markup("Mean friction of {} {} {}").format(law, told, _mean(ends[0]))
    if list(names) == [along]:
        steps, slack = mean[1:] - mean[:-1], error[1:] + error[:-1]
        for verb, sign in (("rises", 1.0), ("falls", -1.0)):
            if (sign * steps >= -slack).all():
                return Markup("Mean friction of {} {} from {} at {} to {} at {}").format(
                    law, verb, *(part for end in ends for part in (_mean(end), _at(end, names)))
                )
    least, most = rows.iloc[int(mean.argmin())], rows.iloc[int(mean.argmax())]
    return Markup("Mean friction of {} is smallest, {}, at {} and largest, {}, at {}").format(
        law, *(part for end in (least, most) for part in (_mean(end), _at(end, names)))
    )


def _mean(row: pd.Series) -> str:
    return with_error(float(row["mean_friction"]), float(row["error"]))


def _at(row: pd.Series, names: Any) -> Markup:
    return settings({name: row[name] for name in names})


def attention_sentence(saved: Saved) -> Markup:
    """What is not as it should be, each with where on the page it is told; that nothing is."""
    found = [*_unanswered(saved), *_rough(saved), *_remarked(saved), *_unmet(saved)]
    killed = saved.counts.get("killed", 0)
    if killed:
        found.insert(
            0,
            Markup('<a href="#odd">{} not reached</a>, as the run was interrupted').format(
                f"{killed} of {counted(saved.size, 'point')} {'was' if killed == 1 else 'were'}"
            ),
        )
    if found:
        return Markup('<span class="warn">Needs attention:</span> {}.').format(Markup("; ").join(found))
    held = len(saved.verdicts)
    expected = f", and {_all(held, 'expectation')}" if held else ""
    points = "the point is" if saved.size == 1 else f"all {saved.size} points are"
    return Markup(
        '<span class="good">Nothing needs attention:</span> {} ok, with no error above the tolerance of {:g}{}.'
    ).format(points, saved.study.tolerance, expected)


def _all(count: int, noun: str) -> str:
    every = "both" if count == 2 else f"all {count}"
    return f"its {noun} holds" if count == 1 else f"{every} {noun}s hold"


def _unanswered(saved: Saved) -> Iterator[Markup]:
    for status, count in saved.counts.items():
        if status in ("ok", "killed"):
            continue
        rows = saved.table[saved.table["status"] == status]
        of = "the only point" if saved.size == 1 else f"{count} of {saved.size} points"
        said = f"{'is' if count == 1 else 'are'} {status.replace('_', ' ')}"
        yield Markup('<a href="#odd">{} {}</a>{}{}').format(of, said, _who(rows, saved.table), _seen(rows))


def _seen(rows: pd.DataFrame) -> str:
    """Between what means lie that are not unique."""
    known = rows[rows["mean_low"].notna()] if "mean_low" in rows else rows.iloc[:0]
    if known.empty:
        return ""
    return f", with means from {known['mean_low'].min():.3g} to {known['mean_high'].max():.3g}"


def _rough(saved: Saved) -> Iterator[Markup]:
    """Errors above the tolerance."""
    rows = saved.table[saved.table["error"] > saved.study.tolerance]
    if len(rows):
        at = f"{counted(len(rows), 'point')}, up to {rows['error'].max():.2g}"
        yield Markup('<a href="#curves">the error exceeds the tolerance of {:g}</a> at {}{}').format(
            saved.study.tolerance, at, _who(rows, saved.table)
        )


def _remarked(saved: Saved) -> Iterator[Markup]:
    """Points that are ok with something to note that is not the size of the error."""
    rows = saved.table[with_remark(saved.table) & ~(saved.table["error"] > saved.study.tolerance)]
    if len(rows):
        yield Markup('<a href="#odd">{} a remark</a>{}').format(
            f"{counted(len(rows), 'point')} {'carries' if len(rows) == 1 else 'carry'}",
            _who(rows, saved.table),
        )


def _unmet(saved: Saved) -> Iterator[Markup]:
    failed, size = sum(not verdict.passed for verdict in saved.verdicts), len(saved.verdicts)
    if failed:
        yield Markup('<a href="#expected">{} FAILED</a>').format(
            f"{failed} of {counted(size, 'expectation')}"
        )


def _who(rows: pd.DataFrame, table: pd.DataFrame) -> Markup:
    """Whose rows they are, where that is not everybody's."""
    told = [
        Markup("{}{}").format(before, listed(list(rows[name].unique())))
        for name, before in (("law", ""), ("method", "by "))
        if rows[name].nunique() < table[name].nunique()
    ]
    return Markup(" ({})").format(Markup(", ").join(told)) if told else Markup("")
