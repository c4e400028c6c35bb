"""Measurements as they are fitted: curves of mean friction, or slip and friction over time; mistakes located."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from frictionlab.scene.dimensional import without_unit
from frictionlab.scene.scene import Scene
from frictionlab.study.keys import column_in_si
from frictionlab.values.columns import BELT_SPEEDS
from frictionlab.values.notes import closest
from frictionlab.values.quantities import Floats
from frictionlab.values.validation import field_path, number_paths

OF_A_PATH = ("time", "slip", "friction")
"""Columns that a path of slip needs."""
OTHERS = ("sigma", "block")
GAP = 3.0
"""A step of time so many times the usual one is a gap: what was remembered before it is not known after it."""


@dataclass(frozen=True, eq=False)
class Measurements:
    """Checked measurements, a row each. along: the columns of the model's inputs, ``scene.<path>`` among them.

    value: the column that a law has to meet; missing: rows of a path that were left out. timed: False for a path
    without times.
    """

    table: pd.DataFrame
    value: str
    missing: int = 0
    timed: bool = True

    @property
    def is_path(self) -> bool:
        """Check whether it is slip and friction over time, without a body."""
        return self.value == "friction"

    @cached_property
    def values(self) -> Floats:
        """Return what was measured."""
        return self.table[self.value].to_numpy(dtype=float)

    @cached_property
    def sigma(self) -> Floats | None:
        """Return the stated standard error of each row, where one is stated."""
        return self.table["sigma"].to_numpy(dtype=float) if "sigma" in self.table else None

    @cached_property
    def pieces(self) -> list[slice]:
        """Return the rows of a path between gaps of time and missing samples."""
        times = self.table["time"].to_numpy(dtype=float)
        steps = np.diff(times)
        far = steps > GAP * np.median(steps) if steps.size else steps > 0.0
        ends = [0, *(int(place) + 1 for place in np.flatnonzero(far)), len(times)]
        return [slice(start, stop) for start, stop in pairwise(ends)]

    @cached_property
    def groups(self) -> list[tuple[dict[str, float], NDArray[np.int64]]]:
        """Return the inputs of each scene of a curve, by path, and its rows."""
        inputs = [name for name in self.table if name.startswith("scene.")]
        if not inputs:
            return [({}, np.arange(len(self.table)))]
        found = self.table.groupby(inputs, sort=False).indices.items()
        each = ((values if isinstance(values, tuple) else (values,), places) for values, places in found)
        return [
            ({name.removeprefix("scene."): x for name, x in zip(inputs, values, strict=True)}, places)
            for values, places in each
        ]

    @property
    def scenes_rising(self) -> list[NDArray[np.int64]]:
        """Return the rows of each scene of a curve, their belt speeds rising."""
        speeds = self.table[self.along].to_numpy(dtype=float)
        return [places[np.argsort(speeds[places], kind="stable")] for _, places in self.groups]

    @property
    def speed(self) -> str:
        """Return the input of a study that the belt speeds of a curve are."""
        return BELT_SPEEDS[self.along.endswith("_m_per_s")]

    @property
    def along(self) -> str:
        """Return the column that residuals are told along."""
        return "time" if self.is_path else next(name for name in self.table if name.startswith("belt_speed"))


class WrongData(ValueError):
    """Measurements that cannot be fitted, with the place and what to do."""


def given_measurements(
    data: Any,
    where: str = "data",
    scene: Scene | None = None,
    blocks: ArrayLike | None = None,
    units: Mapping[str, str] | None = None,
) -> Measurements:
    """Join a table, a mapping of columns, or a list of such. where: what messages call it. scene: of a curve.

    blocks: a label for each row, in place of the column. units: of columns. Raises WrongData.
    """
    tables = data if isinstance(data, Sequence) and not isinstance(data, str) else [data]
    if not len(tables):
        raise WrongData(f"{where}: no table is given")
    whole = pd.concat([_as_table(each, where) for each in tables], ignore_index=True)
    if blocks is not None:
        if len(labels := np.asarray(blocks)) != len(whole):
            raise WrongData(f"blocks: one label a row is needed, {len(whole)}, got {len(labels)}")
        whole = whole.assign(block=labels)
    for name, unit in (units or {}).items():
        whole = _in_si(whole, name, unit, where)
    return _checked(whole, where, None if scene is None else scene.dimensional)


def _in_si(table: pd.DataFrame, name: str, unit: str, where: str) -> pd.DataFrame:
    """Return the table with a column in SI units, under the name that says so. Raises WrongData."""
    if name not in table:
        there = ", ".join(map(str, table.columns))
        raise WrongData(f"{where}: units.{name}: there is no such column, there are {there}")
    try:
        column, factor = column_in_si(name, unit)
    except ValueError as problem:
        raise WrongData(f"{where}: units.{name}: {problem}") from None
    return table.assign(**{column: _numbers(table[name], name, where) * factor}).drop(columns=name)


def _as_table(data: Any, where: str) -> pd.DataFrame:
    if isinstance(data, pd.DataFrame):
        return data.reset_index(drop=True)
    if isinstance(data, Mapping):
        try:
            return pd.DataFrame({name: np.asarray(column) for name, column in data.items()})
        except ValueError as problem:
            raise WrongData(f"{where}: columns of one length are needed: {problem}") from None
    raise WrongData(f"{where}: must be a table (a pandas DataFrame or a mapping of columns), got {data!r}")


def _is_a_number(text: Any) -> bool:
    with suppress(ValueError):
        return math.isfinite(float(str(text)))
    return False


def _checked(table: pd.DataFrame, where: str, si: Any) -> Measurements:
    is_path, timed = "time" in table or "slip" in table, "time" in table or "slip" not in table
    table = table if timed else table.assign(time=np.arange(float(len(table))))
    speed = "belt_speed" if si is None else "belt_speed_m_per_s"
    table = _friction_over_load(table, is_path, where, None if si is None else si.load)
    wanted = OF_A_PATH if is_path else (speed, "mean_friction")
    for name in wanted:
        if name not in table:
            if all(_is_a_number(each) for each in table.columns):
                told = (
                    f"{where}: its first line has numbers; write the names of the columns above them, such as"
                )
                raise WrongData(f"{told} {','.join(wanted)}")
            there = f"the column '{name}' is missing, there are {', '.join(map(str, table.columns))}"
            if (bare := without_unit(name)) in table:
                raise WrongData(
                    f"{where}: {there}; '{bare}' tells no unit: say units: {{{bare}: mm/s}}, or call it {name}"
                )
            hint = closest(name, list(table.columns))
            raise WrongData(f"{where}: {there}{hint and f'; did you mean {hint!r}?'}")
    kept = [name for name in table if name in (*wanted, *OTHERS) or str(name).startswith("scene.")]
    for name in kept:
        _check_input(str(name), where)
    table = table[kept]
    for name in kept:
        if name != "block":
            table = table.assign(**{name: _numbers(table[name], name, where)})
    missing = 0
    if is_path:
        known = table[list(OF_A_PATH)].notna().all(axis=1)
        missing, table = int((~known).sum()), table[known].reset_index(drop=True)
        _check_times(table, where)
    _check_finite(table, where)
    if "sigma" in table and (bad := np.flatnonzero(~(table["sigma"].to_numpy() > 0.0))).size:
        raise WrongData(
            f"{where}: sigma must be > 0, got {table['sigma'].iloc[bad[0]]:g} in row {bad[0] + 1}"
        )
    if "block" in table and table["block"].nunique() < 2:
        raise WrongData(
            f"{where}: block: all rows are of one block; give two or more, or leave the column out"
        )
    if len(table) < 2:
        raise WrongData(f"{where}: at least two rows are needed, got {len(table)}")
    return Measurements(table, wanted[-1], missing, timed)


def _check_input(name: str, where: str) -> None:
    """Raise WrongData for a column of a scene that has no such number, or that tells no unit."""
    path, known = name.removeprefix("scene."), number_paths(Scene)
    if path == name or path in known:
        return
    if (whole := field_path(Scene, path)) in known:
        raise WrongData(f"{where}: the column '{name}' tells no unit: its name is scene.{whole}")
    hint = closest(path, known)
    raise WrongData(f"{where}: no number of a scene is '{name}'{hint and f'; did you mean scene.{hint}?'}")


def _friction_over_load(table: pd.DataFrame, is_path: bool, where: str, load: float | None) -> pd.DataFrame:
    """Divide forces in N by the normal load in N: that of the row, else of the scene."""
    name = "friction" if is_path else "mean_friction"
    forces = [each for each in (name, "sigma") if f"{each}_N" in table and each not in table]
    if not forces:
        return table
    rows = [each for each in ("normal_load_N", "scene.dimensional.normal_load_N") if each in table]
    if not rows and load is None:
        raise WrongData(
            f"{where}: {forces[0]}_N needs the column normal_load_N, or give {forces[0]}, the coefficient"
        )
    over = table[rows[0]] if rows else load
    return table.assign(**{each: table[f"{each}_N"] / over for each in forces})


def _numbers(column: pd.Series, name: str, where: str) -> pd.Series:
    read = pd.to_numeric(column, errors="coerce")
    wrong = np.flatnonzero(read.isna() & column.notna())
    if wrong.size:
        raise WrongData(
            f"{where}: {name} must be numbers, got {column.iloc[wrong[0]]!r} in row {wrong[0] + 1}"
        )
    return read.astype(float)


def _check_times(table: pd.DataFrame, where: str) -> None:
    steps = np.diff(table["time"].to_numpy(dtype=float))
    if (back := np.flatnonzero(~(steps > 0.0))).size:
        at = int(back[0])
        before, after = table["time"].iloc[at], table["time"].iloc[at + 1]
        raise WrongData(f"{where}: time must rise, but goes from {before:g} to {after:g} in row {at + 2}")


def _check_finite(table: pd.DataFrame, where: str) -> None:
    for name in table:
        if name == "block":
            continue
        bad = np.flatnonzero(~np.isfinite(table[name].to_numpy(dtype=float)))
        if bad.size:
            raise WrongData(
                f"{where}: {name} is {table[name].iloc[bad[0]]} in row {bad[0] + 1}; leave the row out"
            )
