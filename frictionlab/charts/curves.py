"""Curves of a result table: the input along the axis, and the input that distinguishes curves."""

from __future__ import annotations

import math
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from pandas.api.types import is_numeric_dtype

from frictionlab.charts.sweeps import Sweep, SweptValue, linked_with, linked_words, sweep_of, swept_columns
from frictionlab.values.columns import (
    BELT_SPEED,
    SCALED,
    belt_speed,
    is_belt_speed,
    quantity,
    without_shown_unit,
    word,
)

CurveNumbers = NDArray[np.float64]
MOST_PICTURES = 12  # in which several laws are compared; of more values each law has a picture of its own
LEAST_VISIBLE = 0.004  # share of an axis: half a line width at the size of a panel
SPEED_RATIO = "velocity_ratio"
READ_FOR_KINKS = SPEED_RATIO, "mean_friction", "normalized_friction"
INPUTS_ACROSS = "load.unbalance", "load.amplitude", "slip.velocity_amplitude", "direction"  # ends of inputs
_ROUNDING = 1e-15  # rounding of a mean of order one


@dataclass(frozen=True)
class CurveData:
    """Rows of one law and method whose inputs differ in the abscissa alone, sorted along it.

    member: the swept value that distinguishes the curve within its picture, if any; panel: the values that select its
    picture. place: the indices of its law, member and method among those of the table. kinks: V_lin and its mirror
    image where it has its kink there, in the units of the axis. same: other methods whose curve is this very line.
    """

    law: str
    method: str
    panel: tuple[SweptValue, ...]
    member: SweptValue | None
    place: tuple[int, int, int]
    rows: pd.DataFrame
    kinks: tuple[float, ...] = ()
    same: tuple[str, ...] = ()

    def column(self, name: str) -> CurveNumbers:
        """Return the numbers of a column, NaN where it does not apply."""
        return self.rows[name].to_numpy(dtype=float)

    def having(self, status: str) -> NDArray[np.bool_]:
        """Select those of its points that have this status."""
        return (self.rows["status"] == status).to_numpy(dtype=bool)

    def rows_in(self, table: pd.DataFrame, columns: Container[str]) -> pd.DataFrame:
        """Rows of a table that are those of this curve, by their inputs: what is not among these columns."""
        own = self.rows.iloc[0]
        same = pd.Series(True, table.index)
        for name in [each for each in table.columns if each not in columns and each in own]:
            same &= table[name].isna() if pd.isna(own[name]) else table[name] == own[name]
        return table[same]

    def speed_scale(self, along: str | None = None) -> float:
        """A belt speed in the units of this column (as given where left out) over the nondimensional one."""
        speeds = self.rows[along or belt_speed(self.rows.columns)]
        scales = (speeds / self.rows[BELT_SPEED]).replace([float("inf")], float("nan")).dropna()
        return 1.0 if scales.empty else float(scales.median())


@dataclass(frozen=True)
class Family:
    """Every curve of a table, the input along the axis, and the input that distinguishes curves of a picture.

    linked: the names of these two in words, where another input changes together with them.
    """

    abscissa: str
    member: str | None
    curves: list[CurveData]
    linked: Mapping[str, str] = field(default_factory=dict)

    def word(self, name: str) -> str:
        """Return the name of an input in words, with what changes together with it."""
        return self.linked.get(name) or word(name)

    @property
    def panels(self) -> list[tuple[SweptValue, ...]]:
        """Return the pictures the curves belong to, in order."""
        return list(dict.fromkeys(curve.panel for curve in self.curves))

    @property
    def along_speed(self) -> bool:
        """Check whether belt speed, as given or over V_lin, runs along the axis."""
        return self.abscissa == SPEED_RATIO or is_belt_speed(self.abscissa)


def family_of(table: pd.DataFrame) -> Family | None:
    """Return the curves of a table; None where no number is swept.

    Several laws are compared in a picture for each value of the scene, and the parameter of most values tells the
    curves of a law apart; where that makes too many pictures, each law has its own. Of one law the quantity of most
    values tells curves apart. Each further one sets up pictures.
    """
    table = _with_one_friction(table.rename(columns=_names_in_si(table.columns)))
    sweep = sweep_of(table)
    panels, member = [name for name in sweep.inputs if name != sweep.along], None
    parameters = [name for name in panels if name.startswith("law.")]
    if table["law"].nunique() == 1:
        member = panels.pop() if panels else None
    elif parameters:
        panels.remove(member := parameters[-1])
    elif math.prod(table[name].nunique() for name in panels) > MOST_PICTURES:
        panels, member = ["law", *panels[:-1]], panels[-1]
    return family_by(table, sweep, panels, member)


def family_by(table: pd.DataFrame, sweep: Sweep, panels: list[str], member: str | None) -> Family | None:
    """Return the curves of a table along the axis of its sweep; None where it has none.

    panels: what sets up pictures, ``law`` where each law has its own.
    """
    if sweep.along is None:
        return None
    linked = {name: linked_with(table, name, sweep.inputs) for name in panels if name != "law"}
    panels = list(dict.fromkeys(each for name in panels for each in (name, *linked.get(name, ()))))
    words = {sweep.along: linked_words(table, sweep.along, sweep.inputs)}
    if member is not None:  # its values are told with their unit
        words[member] = linked_words(table, member, sweep.inputs, quantity)
    return Family(sweep.along, member, curves_of(table, sweep.along, panels, member), words)


def _names_in_si(columns: Iterable[str]) -> dict[str, str]:
    """Names that tell the parameters of a law given in SI units from nondimensional ones: they have a unit."""
    names = [*columns]
    scaled = {f"law.{name.removeprefix(SCALED)}" for name in names if name.startswith(SCALED)}
    given = [name for name in names if without_shown_unit(name) in scaled]
    return {name: f"law.dimensional.{name.removeprefix('law.')}" for name in given}


def _with_one_friction(table: pd.DataFrame) -> pd.DataFrame:
    """Return the table with mu_kinetic under mu, where both are swept over the same values: friction of every law."""
    mu, kinetic = "law.mu", "law.mu_kinetic"
    if mu not in table or kinetic not in table or not {mu, kinetic} <= set(swept_columns(table)):
        return table
    if (
        set(table[mu].dropna()) != set(table[kinetic].dropna())
        or table[[mu, kinetic]].notna().all(axis=1).any()
    ):
        return table
    return table.assign(**{mu: table[mu].fillna(table[kinetic])}).drop(columns=kinetic)


def curves_of(
    table: pd.DataFrame, abscissa: str, panels: Sequence[str], member: str | None = None
) -> list[CurveData]:
    """Curves of a table along this column, picture by picture: numbers by their size, words as they come."""
    laws, methods = table["law"].unique().tolist(), table["method"].unique().tolist()
    members = table[member].dropna().unique().tolist() if member else []
    if member and is_numeric_dtype(table[member]):
        members = sorted(members)
    apart = "law" in panels
    names = [*(name for name in panels if name != "law"), *([member] if member else [])]
    curves = []
    for (law, method, *values), rows in table.groupby(["law", "method", *names], sort=False, dropna=False):
        settings = [SweptValue.of(name, value) for name, value in zip(names, values, strict=True)]
        own = settings.pop() if member else None
        panel = (*([SweptValue("law", law)] if apart else []), *settings)
        at = 0 if own is None or own.value is None else members.index(own.value)
        place = 0 if apart else laws.index(law), at, methods.index(method)
        rows = rows if rows[abscissa].is_monotonic_increasing else rows.sort_values(abscissa)
        kinks = kinks_of(rows) if is_belt_speed(abscissa) else ()
        curves.append(CurveData(law, method, panel, own, place, rows, kinks))
    seen = list(dict.fromkeys(curve.panel for curve in curves))
    return sorted(curves, key=lambda curve: (_heights(curve), seen.index(curve.panel), curve.place))


def _heights(curve: CurveData) -> list[tuple[bool, float]]:
    numbers = [None if isinstance(value, str) else value for _, value in curve.panel]
    return [(value is not None, value or 0.0) for value in numbers]


def drawn_once(curves: Sequence[CurveData], columns: Sequence[str]) -> list[CurveData]:
    """Return the curves without those of a method that are the line of an earlier one in all of these columns.

    That is: no point is further off than both errors allow, nor far enough to be seen. Methods are counted anew.
    """
    kept: list[CurveData] = []
    for curve in curves:
        at = next((at for at, one in enumerate(kept) if _is_line_of(curve, one, curves, columns)), None)
        if at is None:
            kept.append(curve)
        else:
            kept[at] = replace(kept[at], same=(*kept[at].same, curve.method))
    left = sorted({curve.place[2] for curve in kept})
    return [replace(each, place=(*each.place[:2], left.index(each.place[2]))) for each in kept]


def _is_line_of(
    curve: CurveData, one: CurveData, everyone: Sequence[CurveData], columns: Sequence[str]
) -> bool:
    """Check whether a curve of another method, of the same law and values, lies on this one."""
    alike = (curve.law, curve.member, curve.panel) == (one.law, one.member, one.panel)
    if not alike or curve.method == one.method or len(curve.rows) != len(one.rows):
        return False
    if curve.having("not_unique").any() or curve.rows[list(columns)].isna().all(axis=None):
        return False
    beside = [each for each in everyone if each.panel == curve.panel]
    return all(_coincide(curve, one, column, beside) for column in columns)


def _coincide(curve: CurveData, one: CurveData, column: str, beside: Sequence[CurveData]) -> bool:
    """Check whether no difference in a column is visible beside the others of a picture, nor the mean's errors."""
    here, there = curve.column(column), one.column(column)
    known, values = np.isfinite(here), np.concatenate([each.column(column) for each in beside])
    near = np.full(len(here), LEAST_VISIBLE * np.ptp(values[np.isfinite(values)]) if known.any() else 0.0)
    if column == "mean_friction":
        near = np.minimum(near, curve.column("error") + one.column("error") + _ROUNDING * np.abs(here))
    return bool(np.all(np.abs(here - there)[known] <= near[known]))


def kinks_of(curve: pd.DataFrame) -> tuple[float, ...]:
    """V_lin, and its mirror image, inside the belt speeds of a curve that has its closed-form kink there.

    That is a curve whose body moves along the belt alone and whose friction of steady sliding is the same at
    every speed: from V_lin on slip no longer reverses. V_lin is read from velocity_ratio. Friction on bristles that
    keep their stiffness lags behind a normal load that changes, and has no kink there.
    """
    if any(name not in curve for name in READ_FOR_KINKS):
        return ()
    contact = curve.get("scene.normal_load_variation.contact")
    if contact is not None and (contact == "constant").any():
        return ()
    ratio, mean, normalized = (curve[name].to_numpy(dtype=float) for name in READ_FOR_KINKS)
    moving = np.abs(ratio) > 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        sliding = np.abs(mean / normalized)[moving]
    sliding = sliding[~np.isnan(sliding)]
    if _moves_across(curve, moving) or not len(sliding) or np.ptp(sliding) > 1e-9 * sliding.max():
        return ()
    speeds = curve[belt_speed(curve.columns)].to_numpy(dtype=float)
    limit = float(np.median(speeds[moving] / ratio[moving]))
    return tuple(speed for speed in (-limit, limit) if speeds.min() < speed < speeds.max())


def _moves_across(rows: pd.DataFrame, moving: NDArray[np.bool_]) -> bool:
    """Check whether a load or slip across the belt, or at an angle to it, moves the body."""
    if "transverse_velocity_amplitude" in rows:
        across = rows["transverse_velocity_amplitude"].to_numpy(dtype=float)
        return bool((np.abs(across[moving]) > 0.0).any())
    names = [
        name
        for name in rows
        if name.endswith(INPUTS_ACROSS) and ("transverse" in name or "direction" in name)
        if is_numeric_dtype(rows[name])
    ]
    return any(bool((np.abs(rows[name].to_numpy(dtype=float)[moving]) > 0.0).any()) for name in names)
