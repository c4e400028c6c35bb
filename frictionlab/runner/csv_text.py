"""Tables as CSV text, a column at a time: numbers in shortest form that reads back to the same number."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc

_LARGEST_PLAIN = 1e10
"""Whole numbers below it are written without an exponent, so that a point is put behind them."""


def as_csv(table: pd.DataFrame, header: bool = True) -> bytes:
    """Return the rows, below the names of the columns; empty cells for what is not there."""
    names = _line(table.columns).encode() if header else b""
    if not len(table) or not len(table.columns):
        return names
    cells = [_cells(table.iloc[:, place]) for place in range(len(table.columns))]
    lines = pc.binary_join_element_wise(*cells, ",", null_handling="replace")
    text = pc.binary_join_element_wise(lines, "", "\n")
    return names + text.buffers()[2].to_pybytes()


def _cells(column: pd.Series) -> pa.Array:
    """Return the text of every cell; null for an empty one."""
    if column.dtype.kind == "f":
        return _numbers(column.to_numpy())
    places, different = pd.factorize(column)
    words = pa.array([_quoted(str(word)) for word in different], pa.string())
    return words.take(pa.array(places, mask=places < 0))


def _numbers(numbers: np.ndarray) -> pa.Array:
    cells = pc.cast(pa.array(numbers, from_pandas=True), pa.string())
    plain = (np.trunc(numbers) == numbers) & (np.abs(numbers) < _LARGEST_PLAIN)
    if not plain.any():
        return cells
    return pc.if_else(pa.array(plain), pc.binary_join_element_wise(cells, "0", "."), cells)


def _quoted(word: str) -> str:
    return _line([word])[:-1] if set(word) & set(',"\r\n') else word


def _line(words: Iterable[str]) -> str:
    told = io.StringIO()
    csv.writer(told, lineterminator="\n").writerow(words)
    return told.getvalue()
