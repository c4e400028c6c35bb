"""What a run returns: its table, curves, verdicts and orbits."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import pandas as pd

from frictionlab.results.expectations import Verdict
from frictionlab.results.table import status_counts
from frictionlab.results.words import counted
from frictionlab.study import Study


@dataclass(frozen=True, repr=False)
class Run:
    """A study and what came of it: its tables, its kept orbits, and the verdicts on what it expects.

    made, orbits_made: the table and the orbits, or what reads them from their file. curves: one row per curve, with
    its shape; none where belt speed is not swept or the run was stopped. onsets_made: finds the onsets of its curves.
    attractors: a row per Poincare point of every state that motions end in, None where the study does not keep them.
    harmonics: a row per harmonic of every orbit, None where the study does not keep them.
    shown, found: of a table too long to be held, the rows that figures and pages show, and how many of all rows have
    each status.
    """

    study: Study
    made: Callable[[], pd.DataFrame]
    orbits_made: Callable[[], pd.DataFrame | None]
    verdicts: tuple[Verdict, ...]
    folder: Path | None
    computed: int
    curves: pd.DataFrame = field(default_factory=pd.DataFrame)
    onsets_made: Callable[[], pd.DataFrame] = pd.DataFrame
    shown: pd.DataFrame | None = None
    found: Mapping[str, int] | None = None
    attractors: pd.DataFrame | None = None
    harmonics: pd.DataFrame | None = None

    def __repr__(self) -> str:
        """How many points there are of each status, and where the table is."""
        told = ", ".join(f"{count} {status}" for status, count in self.counts.items())
        where = f"; table in {self.table_file}" if self.table_file else ""
        return f"Run({counted(self.size, 'point')}: {told}{where})"

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row per scene, law and method."""
        return self.made()

    @cached_property
    def orbits(self) -> pd.DataFrame | None:
        """The kept orbits; None where none are kept."""
        return self.orbits_made()

    @cached_property
    def onsets(self) -> pd.DataFrame:
        """One row per onset of a curve, found when first asked for: belt speeds where stick begins, ends, ..."""
        return self.onsets_made()

    @property
    def to_show(self) -> pd.DataFrame:
        """The table, or of a long one the rows that are shown."""
        return self.table if self.shown is None else self.shown

    @property
    def table_file(self) -> Path | None:
        """Where the table is, if it was written."""
        return self.folder / "results.parquet" if self.folder is not None else None

    @property
    def counts(self) -> dict[str, int]:
        """How many rows have each status."""
        return status_counts(self.table) if self.found is None else dict(self.found)

    @property
    def size(self) -> int:
        """How many rows there are."""
        return sum(self.counts.values())
