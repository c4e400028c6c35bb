"""The first three sentences of a report: who is highest where, how the curves bend, what needs attention."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import pandas as pd
from markupsafe import Markup, escape

from frictionlab.charts.sweeps import sweep_of
from frictionlab.report.facts import Facts
from frictionlab.report.findings import above_tolerance, place_of, with_remark
from frictionlab.report.shapes import shape_sentence
from frictionlab.report.tables import begun, listed, minus, named, settings, the
from frictionlab.runner.pairs import NOBODY, Difference, Ranking, best_rows, ranking_of
from frictionlab.runner.table import swept_inputs
from frictionlab.runner.words import counted
from frictionlab.values.printable import MOST_DIGITS, with_error
from frictionlab.values.quantities import Floats

MOST_STRETCHES = 4
"""Stretches of the axis that are told one by one; of more, how many points each has."""
IN_SHORT = 3
"""Digits of a distance that is told in a sentence."""
OF_A_PLACE = 4
"""Digits of a swept value in a sentence."""
ALL_WELL = Markup('<span class="good">Nothing needs attention:</span> {} ok{}{}.')


def sentences(run: Facts) -> list[Markup]:
    """Three on a run: its means, the shapes of its curves, what needs attention."""
    return [height_sentence(run), shape_sentence(run), attention_sentence(run)]


def height_sentence(run: Facts) -> Markup:
    """Who has the highest mean friction where, and by how much; of one alone, between what it lies."""
    table, best = run.table, best_rows(run.table)
    if best.empty:
        one = "one mean friction" if (table["status"] == "not_unique").any() else "a number"
        return Markup("No point has {}.").format(one)
    along = sweep_of(table).along or run.speed
    if told := _models(run):
        return begun(Markup("; ").join(told) + _without(table, best))
    ranking = ranking_of(table, along)
    first = _span(best, along, run.speed) if ranking is None else _Ranked(ranking, along, run).sentence()
    if table["law"].nunique() == 1:
        first += _methods(run)
    return first + _alone(run) + _without(table, best)


def _without(table: pd.DataFrame, best: pd.DataFrame) -> Markup:
    """Which laws have no number anywhere, and the end of the sentence."""
    silent = [law for law in table["law"].unique() if law not in best["law"].unique()]
    has = "has" if len(silent) == 1 else "have"
    return Markup("; {} {} no number.").format(listed(silent), has) if silent else Markup(".")


def _models(run: Facts) -> list[Markup]:
    """Of each reduced model how far it is from the full answers that stand beside it: at most, and where."""
    found: dict[tuple[str, str], list[Difference]] = {}
    for pair in run.method_pairs:
        if pair.one in run.reduced and pair.other not in run.reduced:
            found.setdefault((pair.law, pair.one), []).append(pair)
    if len(found) == 1:
        ((law, method), pairs), several = next(iter(found.items())), run.table["law"].nunique() > 1
        if len(pairs) <= MOST_STRETCHES:
            return [_off(run, f"{the(method)} of {law}" if several else the(method), pairs)]
    widest = [(who, max(pairs, key=lambda each: abs(each.value))) for who, pairs in found.items()]
    widest.sort(key=lambda each: -abs(each[1].value))
    return [_off(run, f"{the(method)} of {law}", [pair]) for (law, method), pair in widest[:MOST_STRETCHES]]


def _off(run: Facts, who: str, pairs: Sequence[Difference]) -> Markup:
    """How far a model is off, setting by setting."""
    if not any(pair.apart for pair in pairs):
        return Markup("{} agrees with {} within errors").format(who, the(pairs[0].other))
    if len(pairs) == 1:
        return Markup("{} is {}, at {}").format(who, _far(pairs[0]), _at(pairs[0].where))
    told: list[Markup] = []
    for pair in pairs:
        speed = {name: value for name, value in pair.where.items() if name == run.speed}
        others = _at({name: value for name, value in pair.where.items() if name not in speed})
        by = Markup(" ({})").format(_at(speed)) if speed else ""
        told.append(Markup("at {} {}{}{}").format(others, "" if told else f"{who} is ", _far(pair), by))
    return Markup(", ").join(told)


def _far(pair: Difference) -> str:
    if not pair.apart:
        return "right within errors"
    side = "low" if pair.value < 0 else "high"
    return f"up to {with_error(abs(pair.value), pair.error, IN_SHORT)} too {side}"


def _alone(run: Facts) -> Markup:
    """How far reduced models are off where no full answers stand beside them: by their own errors."""
    rows = run.table[run.table["method"].isin(run.reduced) & run.table["error"].notna()]
    if rows.empty:
        return Markup("")
    worst = rows.loc[rows["error"].idxmax()]
    models, told = [the(each) for each in rows["method"].unique()], Markup("; {} {} off by at most {}, at {}")
    be = "is" if len(models) == 1 else "are"
    return told.format(listed(models), be, with_error(worst["error"], None, 2), place_of(run, worst))


def _methods(run: Facts) -> Markup:
    """Where the methods of one law differ most."""
    pairs = run.method_pairs
    if not pairs:
        return Markup("")
    most = max(pairs, key=lambda each: (each.apart > 0, abs(each.value)))
    which = "" if len(pairs) == 1 else "of the methods, "
    where = Markup(" at {}").format(_at(most.where)) if most.where else ""
    alike = "" if most.apart else ", the same within errors"
    told = Markup("; {}{} and {} differ most, by {}{}{}")
    return told.format(which, most.one, most.other, with_error(abs(most.value), most.error), where, alike)


class _Ranked(NamedTuple):
    """A ranking in words; along: the input of the axis."""

    ranking: Ranking
    along: str
    run: Facts

    def sentence(self) -> Markup:
        """Who is highest where, and by how much."""
        first, ranked = self.ranking.first, self.ranking.ranked
        what = Markup("Mean friction of {}").format(ranked[0]["law"]) if self.one_law else "Mean friction"
        if (first == NOBODY).all():
            names = listed([self.name(who) for who in range(len(ranked))])
            return Markup("{} is the same within errors for {}{}").format(what, names, self.everywhere)
        gaps = " (of those with a number)" if self.ranking.has_gaps else ""
        if self.winners is None:
            what = "curve" if self.one_law else "law"
            return Markup("No {} is highest everywhere{}{}").format(what, gaps, self.spread())
        told = Markup("{} is highest for {}{}{} {}")
        if len(first) == 1:
            return told.format(what, self.name(first[0]), gaps, ":", self.excess())
        return told.format(what, self.winners, gaps, ";", self.excess())

    @property
    def one_law(self) -> bool:
        return len({each["law"] for each in self.ranking.ranked}) == 1

    @property
    def on_the_axis(self) -> bool:
        """Whether points differ by the input of the axis alone."""
        return list(self.ranking.points) == [self.along]

    def name(self, who: int) -> Markup:
        """What tells one from the others: its law where there are several, and its values."""
        return named(self.ranking.ranked[who], self.one_law)

    @property
    def points(self) -> str:
        speeds = self.on_the_axis and "belt_speed" in self.along
        return counted(len(self.ranking.first), "belt speed" if speeds else "point")

    @property
    def everywhere(self) -> str:
        return f" at all {self.points}" if len(self.ranking.first) > 1 else ""

    @property
    def winners(self) -> Markup | None:
        """Each with the stretch of the axis where it is highest; None where these are many."""
        first = self.ranking.first
        winners = [who for who in dict.fromkeys(first.tolist()) if who != NOBODY]
        if len(winners) == 1 and NOBODY not in first:
            return self.name(winners[0]) + self.everywhere
        if not self.on_the_axis or len(self.ranking.stretches) > MOST_STRETCHES:
            return None
        stretches = [(who, self.where(*ends)) for who, *ends in self.ranking.stretches]
        told = [Markup("{} {}").format(self.name(who), at) for who, at in stretches if who != NOBODY]
        ties = [at for who, at in stretches if who == NOBODY]
        alike = [Markup("{} the highest are the same within errors").format(listed(ties))] if ties else []
        return Markup("; ").join([listed(told), *alike])

    def spread(self) -> Markup:
        """How far the highest is above the lowest at most, or any from the reference law, by settings if few."""
        against, names = None, [each["law"] for each in self.ranking.ranked]
        if len(names) > 2 and not self.one_law and names.count(self.run.figures.reference) == 1:
            against = names.index(self.run.figures.reference)
        ends = self.ranking.widest(self.along, MOST_STRETCHES, against)
        begin = ": " if against is None else f"; furthest from {escape(names[against])}: "
        pairs = [None, *((high, low) for _, high, low in ends)]
        told = [self.apart(*each, again=each[1:] == last) for each, last in zip(ends, pairs, strict=False)]
        return Markup(begin) + Markup("; ").join(told)

    def apart(self, at: int, high: int, low: int, again: bool = False) -> Markup:
        """How far one is above another at a point; who they are is not said again."""
        mean, error = self.ranking.mean[at], self.ranking.error[at]
        far = with_error(float(mean[high] - mean[low]), float(error[high] + error[low]), IN_SHORT)
        where = _at(self.ranking.points.iloc[at].to_dict())
        if again:
            return Markup("{} at {}").format(far, where)
        return Markup("{} is up to {} above {}, at {}").format(self.name(high), far, self.name(low), where)

    def where(self, start: int, stop: int) -> Markup:
        """A stretch of the axis."""
        values = self.ranking.points[self.along]
        first, last = (_at({self.along: values.iloc[place]}) for place in (start, stop))
        if start == stop:
            return Markup("at {}").format(first)
        if start == 0:
            return Markup("up to {}").format(last)
        whole = Markup("from {} on") if stop == len(values) - 1 else Markup("from {} to {}")
        return whole.format(first, last)

    def excess(self) -> Markup:
        """How far the highest is above the lowest, at most, and where; of one point above the next."""
        if len(self.ranking.first) > 1:
            return self.apart(*self.ranking.widest(self.along, 0)[0])
        ranking, who, other = self.ranking, int(self.ranking.first[0]), int(self.ranking.second[0])
        excess = with_error(float(ranking.excess[0]), float(ranking.excess_error[0]), IN_SHORT)
        value = with_error(float(ranking.mean[0, who]), float(ranking.error[0, who]))
        return Markup("{}, which is {} above {}, the next").format(value, excess, self.name(other))


def _span(best: pd.DataFrame, along: str, speed: str) -> Markup:
    """Between what the mean friction of one law lies, and where."""
    law = escape(str(best["law"].iloc[0]))
    names = dict.fromkeys([*swept_inputs(best), along if best[along].nunique() > 1 else speed])
    rows = best.sort_values(along, kind="stable")
    mean, error = (rows[name].to_numpy(dtype=float) for name in ("mean_friction", "error"))
    least, most = int(mean.argmin()), int(mean.argmax())
    if len(rows) == 1:
        told = Markup("The mean friction coefficient of {} is {} at {}")
        return told.format(law, *_means_at(rows, names, [0]))
    if mean[most] - mean[least] <= error[most] + error[least]:
        told = Markup("Mean friction of {} is the same within its errors at all {} points: {}")
        return told.format(law, len(rows), *_means_at(rows, names, [0])[:1])
    steps, slack = mean[1:] - mean[:-1], error[1:] + error[:-1]
    for verb, sign in (("rises", 1.0), ("falls", -1.0)):
        if list(names) == [along] and (sign * steps >= -slack).all():
            told = Markup("Mean friction of {} {} from {} at {} to {} at {}")
            ends = told.format(law, verb, *_means_at(rows, names, [0, -1], IN_SHORT))
            return ends + _zero(mean, error, rows[along])
    told = Markup("Mean friction of {} is smallest, {}, at {} and largest, {}, at {}")
    low, at_low, high, at_high = _means_at(rows, names, [least, most], IN_SHORT)
    alike = int((mean >= mean[most] - error[most] - error).sum())
    where = at_high if alike == 1 else Markup("{} of {} points").format(alike, len(rows))
    return told.format(law, low, at_low, high, where)


def _zero(mean: Floats, error: Floats, places: pd.Series) -> Markup:
    """Where a curve that rises or falls throughout passes zero, if it does: at a point or between neighbours."""
    past = [at for at, value in enumerate(mean) if value * mean[0] <= abs(mean[0]) * error[at]]
    if not past or past[0] == 0:
        return Markup("")
    after = past[0]
    before, at = (_at({places.name: places.iloc[place]}) for place in (after - 1, after))
    if abs(mean[after]) <= error[after]:
        return Markup(", through zero at {}").format(at)
    return Markup(", through zero between {} and {}").format(before, at)


def _means_at(
    rows: pd.DataFrame, names: Iterable[str], places: list[int], digits: int = MOST_DIGITS
) -> list[str | Markup]:
    """Of some rows the mean with its error, and the values of these inputs."""
    told: list[str | Markup] = []
    for _, row in rows.iloc[places].iterrows():
        told.append(minus(with_error(float(row["mean_friction"]), float(row["error"]), digits)))
        told.append(_at({name: row[name] for name in names}))
    return told


def attention_sentence(run: Facts) -> Markup:
    """What needs attention; that nothing does, and what was looked at."""
    saved, held = run.saved, len(run.saved.verdicts)
    found = [*_unanswered(run), *_rough_or_remarked(run)]
    if failed := sum(not verdict.passed for verdict in saved.verdicts):
        of = f"{failed} of {counted(held, 'expectation')}"
        found.append(Markup('<a href="#expected">{} FAILED</a>').format(of))
    if found:
        return Markup('<span class="warn">Needs attention:</span> {}.').format(Markup("; ").join(found))
    every = {0: "", 1: ", and its expectation holds", 2: ", and both expectations hold"}
    points = "the point is" if saved.size == 1 else f"all {saved.size} points are"
    expected = every.get(held, f", and all {held} expectations hold")
    of_models = run.table["method"].isin(run.reduced)
    errors = run.table.loc[~of_models, "error"]
    exact = "" if errors.isna().all() else f", with errors of at most {errors.max():.1e}"
    besides = " but for what the models leave out" if exact and of_models.any() else ""
    return ALL_WELL.format(points, exact + besides, expected)


def _unanswered(run: Facts) -> Iterator[Markup]:
    """Points that an interruption left, then those of another status, with between what means lie."""
    counts, size = dict(run.saved.counts), run.saved.size
    if killed := counts.pop("killed", 0):
        reached = f"{killed} of {counted(size, 'point')} {'was' if killed == 1 else 'were'} not reached"
        yield Markup('<a href="#odd">{}</a>, as the run was interrupted').format(reached)
    for status, count in counts.items():
        if status == "ok":
            continue
        rows = run.table[run.table["status"] == status]
        of = "the only point" if size == 1 else f"{count} of {size} points"
        said = f"{of} {'is' if count == 1 else 'are'} {status.replace('_', ' ')}"
        known = rows[rows["mean_low"].notna()] if "mean_low" in rows else rows.iloc[:0]
        low, high = known.get("mean_low"), known.get("mean_high")
        seen = "" if known.empty else f", with means from {low.min():.3g} to {high.max():.3g}"
        yield Markup('<a href="#odd">{}</a>{}{}').format(said, _who(rows, run.table), seen)


def _rough_or_remarked(run: Facts) -> Iterator[Markup]:
    """Errors above the tolerance, and points that are ok with something else to note."""
    table = run.table
    above = above_tolerance(run, table) & ~table["method"].isin(run.reduced)
    if len(rows := table[above]):
        at = f"{counted(len(rows), 'point')}, up to {rows['error'].max():.2g}"
        told = Markup('<a href="#curves">the error exceeds the tolerance of {:g}</a> at {}{}')
        yield told.format(run.saved.study.tolerance, at, _who(rows, table))
    if len(rows := table[with_remark(run) & ~above]):
        carry = f"{counted(len(rows), 'point')} {'carries' if len(rows) == 1 else 'carry'}"
        yield Markup('<a href="#odd">{} a remark</a>{}').format(carry, _who(rows, table))


def _who(rows: pd.DataFrame, table: pd.DataFrame) -> Markup:
    """Whose rows they are, where that is not everybody's."""
    told = [
        Markup("{}{}").format(before, listed(list(rows[name].unique())))
        for name, before in (("law", ""), ("method", "by "))
        if rows[name].nunique() < table[name].nunique()
    ]
    return Markup(" ({})").format(Markup(", ").join(told)) if told else Markup("")


def _at(values: Mapping[str, Any]) -> Markup:
    return settings(values, OF_A_PLACE)
