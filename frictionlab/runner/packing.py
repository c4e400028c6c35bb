"""Answers of points as one table of arrow: what crosses to other processes, and what the store holds."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc
from numpy.typing import NDArray

from frictionlab.runner.part import KeptRows, Part
from frictionlab.values.quantities import Floats

IN_LISTS = "."
"""Between the name of what is kept and that of its column: ``orbits.x``, a list of numbers in each row."""


def packed_answers(parts: Sequence[Part]) -> pa.Table:
    """Return the answers of chunks, one after another, as a table; columns in which nothing is are left out."""
    return _packed(parts[0] if len(parts) == 1 else _in_a_row(parts))


def _in_a_row(parts: Sequence[Part]) -> Part:
    sizes = [len(part.text["status"]) for part in parts]
    firsts = [0, *accumulate(sizes)]
    names = dict.fromkeys(name for part in parts for name in part.numbers)
    missing = [np.full(size, np.nan) for size in sizes]
    numbers = {
        name: np.concatenate(
            [part.numbers.get(name, none) for part, none in zip(parts, missing, strict=True)]
        )
        for name in names
    }
    text = {name: [word for part in parts for word in part.text[name]] for name in parts[0].text}
    kept: dict[str, KeptRows] = {}
    for first, part in zip(firsts, parts, strict=False):
        for kind, rows in part.kept.items():
            kept.setdefault(kind, {}).update({first + row: columns for row, columns in rows.items()})
    return Part(text, numbers, kept)


def rows_joined(tables: Sequence[pa.Table]) -> pa.Table:
    """Return the rows of tables as one; a row is empty where its table has no such column."""
    return pa.concat_tables(tables, promote_options="default") if len(tables) > 1 else tables[0]


def _packed(part: Part) -> pa.Table:
    words = {name: pa.array(column).dictionary_encode() for name, column in part.text.items() if any(column)}
    numbers = {name: pa.array(column) for name, column in part.numbers.items() if not np.isnan(column).all()}
    lists: dict[str, pa.Array] = {}
    size = len(part.text["status"])
    for kind, rows in part.kept.items():
        for name in dict.fromkeys(name for columns in rows.values() for name in columns):
            cells = [rows[row].get(name) if row in rows else None for row in range(size)]
            floats = [None if cell is None else np.asarray(cell, float) for cell in cells]
            lists[f"{kind}{IN_LISTS}{name}"] = pa.array(floats, pa.list_(pa.float64()))
    return pa.table(words | numbers | lists)


def numbers_of(answers: pa.Table, name: str) -> Floats:
    """Return a column of numbers; NaN where there is none."""
    if name not in answers.column_names:
        return np.full(len(answers), np.nan)
    found: Floats = answers[name].to_numpy().copy()  # else nobody may write into the table
    return found


def words_of(answers: pa.Table, name: str) -> pd.Series:
    """Return a column of words; empty where there is none."""
    if name not in answers.column_names:
        return pd.Series(np.nan, range(len(answers)), WORDS)
    return answers[name].cast(pa.string()).to_pandas().replace("", np.nan).astype(WORDS)


def kept_of(answers: pa.Table, kind: str) -> pd.DataFrame:
    """Return what is kept beside rows, ``orbits``, ``harmonics`` or ``states``, by their ``row``; may be empty."""
    start = f"{kind}{IN_LISTS}"
    names = [name for name in answers.column_names if name.startswith(start)]
    if not names:
        return pd.DataFrame({"row": np.empty(0, np.int64)})
    there = answers.filter(pc.field(names[0]).is_valid())
    sizes = pc.list_value_length(there[names[0]]).to_numpy()
    rows = np.repeat(np.flatnonzero(answers[names[0]].is_valid().to_numpy()), sizes)
    return pd.DataFrame(
        {"row": rows} | {name.removeprefix(start): _flat(there[name], sizes) for name in names}
    )


def _flat(lists: pa.ChunkedArray, sizes: NDArray[np.int64]) -> Floats:
    """Return the numbers of all lists; NaN for a row that has none in this column."""
    flat, own = pc.list_flatten(lists).to_numpy(), pc.fill_null(pc.list_value_length(lists), 0).to_numpy()
    if len(flat) == sizes.sum():
        return flat
    found = np.full(int(sizes.sum()), np.nan)
    found[np.repeat(own > 0, sizes)] = flat
    return found


WORDS = pd.StringDtype(na_value=np.nan)
"""Type of the columns of words in tables."""
