"""The files of a table too long to be held: written piece by piece, and read that way."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import wraps
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from frictionlab.runner.errors import SaveError
from frictionlab.runner.folder import SOLVER, RunFolder


def told_as_a_save_error(write: Callable[..., None]) -> Callable[..., None]:
    """A method that writes to a file, with SaveError for OSError."""

    @wraps(write)
    def written(self: LongFiles, path: Path, table: pd.DataFrame) -> None:
        try:
            write(self, path, table)
        except OSError as problem:
            raise SaveError(f"cannot write {path}: {problem.strerror or problem}") from problem

    return written


class LongFiles:
    """results.parquet, orbits.parquet and results.csv while they are written: whole in the end, or not at all.

    as_csv: whether the table is wanted as text, too.
    """

    def __init__(self, folder: RunFolder, as_csv: bool) -> None:
        self._folder, self._as_csv = folder, as_csv
        self._open: dict[Path, Any] = {}
        self._begun: dict[Path, Path] = {}
        self._files: list[Any] = []

    def __enter__(self) -> Self:
        self._folder.remove_texts()
        return self

    def add_rows(self, table: pd.DataFrame) -> None:
        """The next rows of the table. Raises SaveError."""
        self._add(self._folder.table, table)
        if self._as_csv:
            self._add_text(self._folder.csv_file, table)

    def add_orbits(self, orbits: pd.DataFrame | None) -> None:
        """The next rows of the orbits, where there are any. Raises SaveError."""
        if orbits is not None:
            self._add(self._folder.orbits_file, orbits)

    @told_as_a_save_error
    def _add(self, path: Path, table: pd.DataFrame) -> None:
        marked = table.copy(deep=False)
        marked.attrs = {SOLVER: self._folder.identity.solver}
        writer = self._open.get(path)
        if writer is None:
            content = pa.Table.from_pandas(marked, _with_text(marked), preserve_index=False)
            writer = self._open[path] = pq.ParquetWriter(self._opened(path), content.schema)
        else:
            content = pa.Table.from_pandas(marked, writer.schema, preserve_index=False)
        writer.write_table(content, row_group_size=len(table))

    @told_as_a_save_error
    def _add_text(self, path: Path, table: pd.DataFrame) -> None:
        first = path not in self._open
        if first:
            self._open[path] = self._beginning(path).open("w", encoding="utf-8", newline="")
        table.to_csv(self._open[path], index=False, header=first, lineterminator="\n")

    def _opened(self, path: Path) -> Any:
        """A file of our own: arrow opens none whose name is no text."""
        self._files.append(self._beginning(path).open("wb"))
        return self._files[-1]

    def _beginning(self, path: Path) -> Path:
        self._begun[path] = path.with_name(f".{path.name}.{os.getpid()}")
        return self._begun[path]

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        for file in [*self._open.values(), *self._files]:
            with suppress(OSError):  # a disk that is full was told above
                file.close()
        for path, temporary in self._begun.items():
            if problem is None:
                self._folder.adopt(path, temporary)
            temporary.unlink(missing_ok=True)


def _with_text(table: pd.DataFrame) -> pa.Schema:
    """The schema of a table, a column of objects without any as one of text: later rows may have some."""
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
    """How many rows the table of a file has."""
    with file.open("rb") as opened:
        return int(pq.read_metadata(opened).num_rows)


def read_columns_of_file(file: Path, wanted: Callable[[str], bool]) -> pd.DataFrame:
    """Some columns of a table."""
    with file.open("rb") as opened:
        names = [name for name in pq.read_schema(opened).names if wanted(name)]
        return pq.read_table(opened, columns=names).to_pandas()


def read_whole(file: Path) -> pd.DataFrame:
    """A whole table."""
    return read_columns_of_file(file, lambda name: True)
