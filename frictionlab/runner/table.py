"""Tidy table of a run: inputs first, then what was found, one row per scene, law and method."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.runner.packing import WORDS, kept_of, numbers_of, words_of
from frictionlab.runner.part import beside_in_si, si_columns, si_scales
from frictionlab.runner.words import column_in_si_words
from frictionlab.scene.units import scaled_parameters
from frictionlab.study.grid import StudyCurve
from frictionlab.values.columns import (
    BELT_SPEEDS,
    RESULTS,
    SCALED,
    SHOWN_IN_PART,
    SI,
    TEXT,
    belt_speed,
    given,
    leading,
)
from frictionlab.values.quantities import Floats


class Inputs(NamedTuple):
    """Input columns of each row; scales: the units of its results, for scenes in SI units."""

    columns: dict[str, ColumnValues]
    size: int
    scales: dict[str, Floats] | None = None

    def scales_of(self, rows: Any) -> dict[str, Any]:
        """Return the units of the results of a row, or of several; none where its scene is not given in SI units."""
        return {name: scale[rows] for name, scale in (self.scales or {}).items()}


def inputs(curves: Sequence[StudyCurve]) -> Inputs:
    """law, kind, method, then every value of the scenes and of the laws; empty (NaN, None) where a row has none."""
    return InputColumns(curves).of(range(len(curves)))


class InputColumns:
    """Input columns of a study's curves: of all rows or of some at a time, each time the same columns."""

    def __init__(self, curves: Sequence[StudyCurve]) -> None:
        self._curves = curves
        named = [{"law": each.law_label, "kind": each.kind, "method": each.method.label} for each in curves]
        # Curves share their scenes and laws: the values of each are read once.
        scenes = _once(curves, lambda each: each.scenes.scene, lambda scene: scene.values())
        laws = _once(curves, lambda each: each.given_law, _values)
        scaled = [_scaled(each) for each in curves]
        self._records = [("", named), ("scene.", scenes), ("law.", laws), (SCALED, scaled)]
        self._kinds = [_kinds(records) for _, records in self._records]

    def of(self, chosen: range) -> Inputs:
        """Return the inputs of the curves at these places, whose rows are all rows from the first to the last."""
        curves = self._curves[chosen.start : chosen.stop]
        first = min(each.rows.start for each in curves)
        where = [slice_of(each.rows, first) for each in curves]
        size = sum(len(each.rows) for each in curves)
        columns: dict[str, ColumnValues] = {}
        for (prefix, records), kinds in zip(self._records, self._kinds, strict=True):
            columns |= _spread(prefix, records[chosen.start : chosen.stop], kinds, where, size)
        for each, places in zip(curves, where, strict=True):
            for name, speeds in zip(BELT_SPEEDS, (each.scenes.belt_speeds, each.scenes.given), strict=True):
                if name in columns:
                    columns[name][places] = speeds
        return Inputs(columns, size, _scales(curves, where, size))


ColumnValues = NDArray[Any]
Told = TypeVar("Told")


def _once(
    curves: Sequence[StudyCurve], part: Callable[[StudyCurve], Any], told: Callable[[Any], Told]
) -> list[Told]:
    """Return what is told of a part of each curve, made once of each different one."""
    found = {id(part(each)): part(each) for each in curves}
    made = {key: told(one) for key, one in found.items()}
    return [made[id(part(each))] for each in curves]


def slice_of(rows: range, first: int = 0) -> slice:
    """Their places in an array that begins with the row ``first``."""
    return slice(rows.start - first, rows.stop - first, rows.step)


def _scaled(curve: StudyCurve) -> dict[str, Any]:
    """Return the parameters of its law that were given in SI units in the scales of the scene."""
    si = curve.scenes.scene.dimensional
    return {} if si is None else cells(scaled_parameters(curve.given_law, si.scales))


def _scales(curves: Sequence[StudyCurve], where: list[slice], size: int) -> dict[str, Floats] | None:
    if not curves or curves[0].scenes.scene.dimensional is None:
        return None
    found = _once(curves, lambda each: each.scenes.scene, si_scales)
    return _spread("", found, _kinds(found), where, size)


def _values(law: FrictionLaw) -> dict[str, Any]:
    return cells(law.model_dump(exclude_none=True, mode="json"))


def cells(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return values by name; several numbers go to separate cells, ``mu[0]``, ``mu[1]``."""
    found: dict[str, Any] = {}
    for name, value in values.items():
        several = enumerate(value) if isinstance(value, list | tuple) else ()
        found |= {f"{name}[{k}]": each for k, each in several} or {name: value}
    return found


def _kinds(records: list[dict[str, Any]]) -> dict[str, bool]:
    """Return the names in records, and whether all their values are numbers."""
    found: dict[str, bool] = {}
    for record in {id(record): record for record in records}.values():
        for name, value in record.items():
            found[name] = found.get(name, True) and isinstance(value, float | int)
    return found


def _spread(
    prefix: str, records: list[dict[str, Any]], kinds: dict[str, bool], where: list[slice], size: int
) -> dict[str, ColumnValues]:
    """A column for each name, each record's value at its places; numbers with gaps as floats."""
    found: dict[str, ColumnValues] = {}
    for name, are_numbers in kinds.items():
        column = np.full(size, np.nan) if are_numbers else np.full(size, None, dtype=object)
        for record, places in zip(records, where, strict=True):
            if name in record:
                column[places] = record[name]
        found[f"{prefix}{name}"] = column
    return found


def value_in(cells: Mapping[str, Any], name: str) -> Any:
    """Return the value of this name, one or several, of a row's cells; None where they are empty."""
    given = {key: cells[key] for key in cells if key == name or key.startswith(f"{name}[")}
    filled = {key: value for key, value in given.items() if value is not None and value == value}
    return filled[name] if name in filled else [*filled.values()] or None


def result_frame(answers: pa.Table, given: Inputs, names: Collection[str]) -> pd.DataFrame:
    """Return the table of some rows: inputs, then these results in the order of the contract, those in SI units too.

    Cells are empty where a column does not apply.
    """
    told = [name for name in RESULTS if name in names]
    found = {name: words_of(answers, name) if name in TEXT else numbers_of(answers, name) for name in told}
    if given.scales is not None:
        numbers = {name: column for name, column in found.items() if name not in TEXT}
        found |= si_columns(numbers, given.scales)
        if "reason" in found:
            found["reason"] = pd.Series(column_in_si_words(found["reason"], given.scales), dtype=WORDS)
    frame = pd.DataFrame(given.columns | found, copy=False)
    for name in [name for name in given.columns if frame[name].dtype.kind == "O"]:
        if not frame[name].isna().all():  # else words of other rows
            frame[name] = _column_of_words_or_numbers(frame[name])
    return frame


def whole(table: pd.DataFrame) -> pd.DataFrame:
    """Return the table with every result column, empty where it was not asked for."""
    if all(name in table for name in RESULTS):
        return table
    given = [name for name in table.columns if name not in RESULTS and name not in SI]
    names = [*given, *RESULTS, *(name for name in SI if name in table)]
    columns = {name: table[name] if name in table else _nothing(name, table.index) for name in names}
    found = pd.DataFrame(columns, copy=False)
    found.attrs = table.attrs
    return found


def _nothing(name: str, index: pd.Index) -> pd.Series:
    return pd.Series(np.nan, index, WORDS if name in TEXT else float)


def _column_of_words_or_numbers(column: pd.Series) -> pd.Series:
    """Numbers with gaps as floats; words as strings, the empty word as a gap."""
    if all(value is None or isinstance(value, float | int) for value in column):
        return column.astype(float)
    return column.where(column != "", None).astype(WORDS)


def status_counts(table: pd.DataFrame) -> dict[str, int]:
    """Return how many rows have each status, the most frequent first."""
    return {str(name): int(count) for name, count in table["status"].value_counts().items()}


def swept_inputs(table: pd.DataFrame) -> list[str]:
    """Inputs besides belt speed that take several values within one law; its label distinguishes laws.

    Of those that change together, the first; belt speed may be one of them.
    """
    speed = belt_speed(table.columns)
    names = [speed, *(name for name in given(table.columns) if name != speed)]
    names = [name for name in names if name in table]
    within = table.groupby("law", sort=False)[names].nunique(dropna=False).max()
    swept = [name for name in names if within[name] > 1]
    apart = swept if SHOWN_IN_PART in table.attrs else leading(swept, table)
    return [name for name in apart if name != speed]


def records(frame: pd.DataFrame) -> list[dict[str, Any]]:
    """One plain record per row for JSON, None for an empty cell."""
    columns = {name: [_plain(value) for value in frame[name].tolist()] for name in frame.columns}
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def _plain(value: Any) -> Any:
    """Return the value for JSON, which has neither NaN nor infinity."""
    return None if isinstance(value, float) and not np.isfinite(value) else value


def kept_rows(answers: pa.Table, kind: str, given: Inputs, first: int = 0) -> pd.DataFrame:
    """Return what is kept beside rows, of scenes in SI units with columns in these, too; may be empty.

    ``row`` is the point's place in the table, which begins with the row ``first``.
    """
    found = kept_of(answers, kind)
    places = found["row"].to_numpy()
    own = {name: found[name].to_numpy() for name in found.columns if name != "row"}
    return pd.DataFrame({"row": places + first} | own | beside_in_si(own, given.scales_of(places)))
