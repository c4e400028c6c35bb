"""Failure maps of one method or peer as a section of a bench list."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import pandas as pd

from frictionlab.bench.charts import failures_figure
from frictionlab.bench.contenders import Contender
from frictionlab.bench.failure_maps import FailureMap
from frictionlab.bench.result import SectionResult, Tell, file_stem, nothing_measured

OUTCOMES = ("ok", "refused", "failed", "not_unique", "silent")
"""Outcomes of a point."""
OUTCOME_WORDS = {"not_unique": "not unique", "silent": "wrong, silent"}
MAPS_CAPTION = (
    "A panel at one value of its vertical axis is a curve over belt speed: shade is the error of the mean friction "
    "(left stated, right true), hatching is no number, a cross is a number that is wrong without a word."
)


@dataclass(frozen=True)
class FailureSection:
    """Maps one method or peer is measured on, each with its own setting."""

    label: str
    maps: tuple[tuple[FailureMap, Contender], ...]

    @property
    def name(self) -> str:
        """Return the name of its files."""
        return f"failures_{file_stem(self.label)}"

    def measure(self, tell: Tell) -> SectionResult:
        """Solve every point of every map. What the references say is found once for all sections."""
        first, style = self.maps[0][1], {"hatch.linewidth": 0.5}
        title = f"Failure maps of {self.label}{' (peer)' if first.side == 'peer' else ''}"
        if missing := first.missing():
            return nothing_measured(self.name, title, missing)
        for drawn, _ in self.maps:
            tell(f"{self.name}: {drawn.name}, references")
            _ = drawn.known  # found here, where it is told
        tables = []
        for drawn, contender in self.maps:
            tell(f"{self.name}: {drawn.name}")
            tables.append(drawn.measured(contender))
        table, figure = pd.concat(tables).drop(columns="ordinate"), partial(self._figure, title, tables)
        said = failures_summary(title, table)
        return SectionResult(self.name, title, table, said, figure, MAPS_CAPTION, style=style)

    def _figure(self, title: str, tables: Sequence[pd.DataFrame]) -> Any:
        """Return the maps that are not refused everywhere, the others in words."""
        maps, refused = [], list[str]()
        for (drawn, _), table in zip(self.maps, tables, strict=True):
            if (table["outcome"] == "refused").all():
                told = f"{drawn.name}: refused at every point: {table['reason'].iloc[0]}"
                refused += textwrap.wrap(told, 110)
            else:
                maps.append(drawn.picture(table))
        outcome = pd.concat(tables)["outcome"]
        silent = int((outcome == "silent").sum())
        head = f"{title}: {len(outcome):,} points, {silent:,} wrong without a word"
        kinds = ["true"] if self.maps[0][1].side == "peer" else ["stated", "true"]
        return failures_figure(head, maps, kinds, "\n".join(refused))


def failures_summary(title: str, table: pd.DataFrame) -> str:
    """Counts by map, those that are wrong without a word last, and the median of the references' own errors."""
    counts = pd.crosstab(table["map"], table["outcome"]).reindex(table["map"].unique())
    counts = counts.reindex(columns=list(OUTCOMES), fill_value=0)
    known, wide = table.groupby("map")["reference_error"].median(), max(map(len, counts.index))
    heads = [*(OUTCOME_WORDS.get(each, each) for each in OUTCOMES), "known to"]
    lines = [f"{title}: points", " " * wide + "".join(f"{head:>14}" for head in heads)]
    for name, row in counts.iterrows():
        told = f"{known[name]:.0e}" if known[name] == known[name] else ""
        lines.append(f"{name:<{wide}}" + "".join(f"{count:>14,}" for count in row) + f"{told:>14}")
    lines.append(f"{'all':<{wide}}" + "".join(f"{count:>14,}" for count in counts.sum()))
    return "\n".join(lines)


def failure_sections(maps: Sequence[FailureMap]) -> list[FailureSection]:
    """A section for each contender of these maps, in the order of their first map."""
    found: dict[str, list[tuple[FailureMap, Contender]]] = {}
    for drawn in maps:
        for contender in drawn.contenders:
            found.setdefault(contender.label, []).append((drawn, contender))
    return [FailureSection(label, tuple(each)) for label, each in found.items()]
