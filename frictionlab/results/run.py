"""What a run returns: its table, curves, verdicts and orbits."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from frictionlab.results.expectations import Verdict
from frictionlab.results.table import status_counts
from frictionlab.study import Study


@dataclass(frozen=True)
class Run:
    """A study and what came of it: its tables, its kept orbits, and the verdicts on what it expects.

    curves: one row per curve, with its shape; none where belt speed is not swept or the run was stopped.
    """

    study: Study
    table: pd.DataFrame
    orbits: pd.DataFrame | None
    verdicts: tuple[Verdict, ...]
    folder: Path | None
    computed: int
    curves: pd.DataFrame = field(default_factory=pd.DataFrame)

    @property
    def table_file(self) -> Path | None:
        """Where the table is, if it was written."""
        return self.folder / "results.parquet" if self.folder is not None else None

    @property
    def counts(self) -> dict[str, int]:
        """How many rows have each status."""
        return status_counts(self.table)
