"""Files of a table: written piece by piece, whole in the end or not at all, and read that way."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from frictionlab.runner.csv_text import as_csv
from frictionlab.runner.files import SaveError, written_whole
from frictionlab.runner.folder import RunFolder

ROWS_OF_TEXT = 10_000
"""Rows whose text is held at once."""


class TableFiles:
    """results.parquet, results.csv, orbits.parquet and harmonics.csv of a run while they are written.

    folder: None where nothing is. as_csv: whether the table is wanted as text, too. Once a file cannot be written
    none is, and the end of ``with`` raises SaveError.
    """

    def __init__(self, folder: RunFolder | None, as_csv: bool = True) -> None:
        self._folder, self._as_csv = folder, as_csv
        self._files, self._open = ExitStack(), dict[Path, Any]()
        self._problem: SaveError | None = None

    def __enter__(self) -> Self:
        if self._folder is not None:
            self._folder.remove_beside()
        return self

    def add_rows(self, table: pd.DataFrame) -> None:
        """Write the next rows of the table."""
        if self._folder is not None:
            self._add(self._folder.table, table, self._add_parquet)
        if self._folder is not None and self._as_csv:
            self._add(self._folder.csv_file, table, self._add_text)

    def add_orbits(self, orbits: pd.DataFrame | None) -> None:
        """Write the next rows of the orbits, where there are any."""
        if self._folder is not None and orbits is not None:
            self._add(self._folder.orbits_file, orbits, self._add_parquet)

    def add_harmonics(self, harmonics: pd.DataFrame | None) -> None:
        """Write the next rows of the harmonics, where they are kept."""
        if self._folder is not None and harmonics is not None:
            self._add(self._folder.harmonics_file, harmonics, self._add_text)

    @property
    def has_harmonics(self) -> bool:
        """True if any were added."""
        return self._folder is not None and self._folder.harmonics_file in self._open

    def _add(self, path: Path, table: pd.DataFrame, write: Callable[[Path, pd.DataFrame], None]) -> None:
        try:
            if self._problem is None:
                write(path, table)
        except OSError as problem:
            self._problem = SaveError(f"cannot write {path}: {problem.strerror or problem}")
        except SaveError as problem:
            self._problem = problem

    def _add_parquet(self, path: Path, table: pd.DataFrame) -> None:
        if path not in self._open:
            schema = pa.Table.from_pandas(table, _with_text(table), preserve_index=False).schema
            file = self._files.enter_context(written_whole(path))
            self._open[path] = self._files.enter_context(pq.ParquetWriter(file, schema))
        writer = self._open[path]
        writer.write_table(pa.Table.from_pandas(table, writer.schema, preserve_index=False))

    def _add_text(self, path: Path, table: pd.DataFrame) -> None:
        first = path not in self._open
        if first:
            self._open[path] = self._files.enter_context(written_whole(path))
        for start in range(0, max(1, len(table)), ROWS_OF_TEXT):
            text = as_csv(table.iloc[start : start + ROWS_OF_TEXT], header=first and start == 0)
            self._open[path].write(text)

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        found = problem or self._problem  # each file is then removed, else put in its place, the table last
        self._files.__exit__(None if found is None else type(found), found, trace)
        if problem is None and self._problem is not None:
            raise self._problem


def _with_text(table: pd.DataFrame) -> pa.Schema:
    """Return the schema of a table, a column of objects without any as one of text: later rows may have some."""
    schema = pa.Schema.from_pandas(table, preserve_index=False)
    for place, name in enumerate(schema.names):
        if table[name].dtype == object and table[name].isna().all():
            schema = schema.set(place, pa.field(name, pa.string()))
    return schema


def read_pieces(file: Path) -> Iterator[pd.DataFrame]:
    """A table as it was written, piece by piece."""
    with file.open("rb") as opened:
        whole = pq.ParquetFile(opened)
        for place in range(whole.num_row_groups):
            yield whole.read_row_group(place).to_pandas()


def rows_of_file(file: Path) -> int:
    """Return how many rows the table of a file has."""
    with file.open("rb") as opened:
        return int(pq.read_metadata(opened).num_rows)


def read_head(file: Path) -> pd.DataFrame:
    """Return a table without its rows."""
    with file.open("rb") as opened:
        return pq.read_schema(opened).empty_table().to_pandas()


def read_columns_of_file(file: Path, wanted: Callable[[str], bool]) -> pd.DataFrame:
    """Some columns of a table."""
    with file.open("rb") as opened:
        names = [name for name in pq.read_schema(opened).names if wanted(name)]
        return pq.read_table(opened, columns=names).to_pandas()


def read_whole(file: Path) -> pd.DataFrame:
    """A whole table."""
    return read_columns_of_file(file, lambda name: True)
