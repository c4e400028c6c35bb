"""What is not as it should be in a run, in one sentence, each with where on the page it is told."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd
from markupsafe import Markup

from frictionlab.report.facts import Facts
from frictionlab.report.findings import with_remark
from frictionlab.report.tables import listed
from frictionlab.results.words import counted

NOTHING = Markup(
    '<span class="good">Nothing needs attention:</span> {} ok, with no error above the tolerance of {:g}{}.'
)


def attention_sentence(run: Facts) -> Markup:
    """What needs attention; that nothing does, and what was looked at."""
    found = Markup("; ").join([*_unanswered(run), *_rough_or_remarked(run), *_unmet(run)])
    if found:
        return Markup('<span class="warn">Needs attention:</span> {}.').format(found)
    saved, held = run.saved, len(run.saved.verdicts)
    every = {0: "", 1: ", and its expectation holds", 2: ", and both expectations hold"}
    points = "the point is" if saved.size == 1 else f"all {saved.size} points are"
    expected = every.get(held, f", and all {held} expectations hold")
    return NOTHING.format(points, saved.study.tolerance, expected)


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
    table, tolerance = run.table, run.saved.study.tolerance
    above = table["error"] > tolerance
    if len(rows := table[above]):
        at = f"{counted(len(rows), 'point')}, up to {rows['error'].max():.2g}"
        told = Markup('<a href="#curves">the error exceeds the tolerance of {:g}</a> at {}{}')
        yield told.format(tolerance, at, _who(rows, table))
    if len(rows := table[with_remark(table) & ~above]):
        carry = f"{counted(len(rows), 'point')} {'carries' if len(rows) == 1 else 'carry'}"
        yield Markup('<a href="#odd">{} a remark</a>{}').format(carry, _who(rows, table))


def _unmet(run: Facts) -> Iterator[Markup]:
    verdicts = run.saved.verdicts
    if failed := sum(not verdict.passed for verdict in verdicts):
        of = f"{failed} of {counted(len(verdicts), 'expectation')}"
        yield Markup('<a href="#expected">{} FAILED</a>').format(of)


def _who(rows: pd.DataFrame, table: pd.DataFrame) -> Markup:
    """Whose rows they are, where that is not everybody's."""
    told = [
        Markup("{}{}").format(before, listed(list(rows[name].unique())))
        for name, before in (("law", ""), ("method", "by "))
        if rows[name].nunique() < table[name].nunique()
    ]
    return Markup(" ({})").format(Markup(", ").join(told)) if told else Markup("")
