"""The curves of a result table: the input along the axis, and the input that distinguishes curves."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from pandas.api.types import is_numeric_dtype

from frictionlab.columns import SCALED, belt_speed, given

MOST_CURVES_IN_A_PICTURE = 12  # of several laws; more cannot be distinguished
POINTS_OF_A_CURVE = 8  # belt speeds; with fewer no shape is read, and what takes more values says more
SweptValue = tuple[
    str, float | str | None
]  # a swept input and its value; None where a law has no such parameter


@dataclass(frozen=True)
class CurveData:
    """The rows of one law and method whose inputs differ in the abscissa alone, sorted along it.

    member: the swept value that distinguishes the curve within its picture, if any; panel: the values that select its
    picture. place: the indices of its law, member and method among those of the table.
    """

    law: str
    method: str
    panel: tuple[SweptValue, ...]
    member: SweptValue | None
    place: tuple[int, int, int]
    rows: pd.DataFrame


@dataclass(frozen=True)
class Family:
    """Every curve of a table, the input along the axis, and the input that distinguishes curves of a picture."""

    abscissa: str
    member: str | None
    curves: list[CurveData]

    @property
    def panels(self) -> list[tuple[SweptValue, ...]]:
        """The pictures the curves belong to, in order."""
        return list(dict.fromkeys(curve.panel for curve in self.curves))

    @property
    def sizes(self) -> tuple[int, int, int]:
        """How many laws, members and methods there are."""
        laws, members, methods = zip(*(curve.place for curve in self.curves), strict=True)
        return max(laws) + 1, max(members) + 1, max(methods) + 1


def family_of(table: pd.DataFrame) -> Family | None:
    """The curves of a table; None where no number is swept.

    Along the axis: belt speed, or the swept number of most values where belt speed takes too few for a curve.
    Of the others the one of most values tells neighbours apart, unless it is one of the scene and several laws
    have too many curves then; each further one sets up panels.
    """
    table = table.rename(columns=_names_in_si(table.columns))
    swept = sorted(_swept_inputs(table), key=lambda name: table[name].nunique())
    numbers = [name for name in swept if is_numeric_dtype(table[name])]
    if not numbers:
        return None
    abscissa = _along_the_axis(table, numbers)
    others = [name for name in swept if name != abscissa]
    member = others.pop() if others and not _merge_crowded(table, others[-1]) else None
    return Family(abscissa, member, _curves(table, abscissa, others, member))


def _merge_crowded(table: pd.DataFrame, member: str) -> bool:
    laws = table["law"].nunique()
    curves = laws * table[member].nunique()
    return laws > 1 and member.startswith("scene.") and curves > MOST_CURVES_IN_A_PICTURE


def _along_the_axis(table: pd.DataFrame, swept: list[str]) -> str:
    speed = belt_speed(table.columns)
    if speed not in swept:
        return swept[-1]
    of_a_curve = table[speed].nunique() >= min(POINTS_OF_A_CURVE, table[swept[-1]].nunique())
    return speed if of_a_curve else swept[-1]


def _names_in_si(columns: Iterable[str]) -> dict[str, str]:
    """Names that tell the parameters of a law given in SI units from nondimensional ones: they have a unit."""
    scaled = [name.removeprefix(SCALED) for name in columns if name.startswith(SCALED)]
    return {f"law.{name}": f"law.dimensional.{name}" for name in scaled}


def _swept_inputs(table: pd.DataFrame) -> list[str]:
    """Inputs of more than one value, as given; a law's parameter counts only where it varies within one law."""
    names = given(table.columns)
    scene = [name for name in names if name.startswith("scene.") and table[name].nunique() > 1]
    parameters = [name for name in names if name.startswith("law.") and is_numeric_dtype(table[name])]
    return scene + [name for name in parameters if table.groupby("law")[name].nunique().max() > 1]


def _curves(table: pd.DataFrame, abscissa: str, panels: list[str], member: str | None) -> list[CurveData]:
    laws, methods = table["law"].unique().tolist(), table["method"].unique().tolist()
    members = table[member].dropna().unique().tolist() if member else []
    if member and is_numeric_dtype(table[member]):
        members = sorted(members)
    names = [*panels, member] if member else panels
    curves = []
    for (law, method, *values), rows in table.groupby(["law", "method", *names], sort=False, dropna=False):
        settings = [_setting(name, value) for name, value in zip(names, values, strict=True)]
        own = settings.pop() if member else None
        place = laws.index(law), _index(members, own), methods.index(method)
        curves.append(CurveData(law, method, tuple(settings), own, place, rows.sort_values(abscissa)))
    seen = list(dict.fromkeys(curve.panel for curve in curves))
    return sorted(curves, key=lambda curve: (_heights(curve), seen.index(curve.panel), curve.place))


def _setting(name: str, value: Any) -> SweptValue:
    return name, None if pd.isna(value) else value if isinstance(value, str) else float(value)


def _index(members: list[Any], member: SweptValue | None) -> int:
    return 0 if member is None or member[1] is None else members.index(member[1])


def _heights(curve: CurveData) -> list[tuple[bool, float]]:
    """By which pictures are ordered: swept numbers by their size; those of words stay in the order of the table."""
    numbers = [None if isinstance(value, str) else value for _, value in curve.panel]
    return [(value is not None, value or 0.0) for value in numbers]


def kinks(curve: CurveData) -> list[float]:
    """V_lin, and its mirror image, inside the belt speeds of a curve that has its closed-form kink there.

    That is a curve whose body moves along the belt alone and whose friction of steady sliding is the same at
    every speed: from V_lin on slip no longer reverses. V_lin is read from velocity_ratio. Friction on bristles that
    keep their stiffness lags behind a normal load that changes, and has no kink there.
    """
    contact = curve.rows.get("scene.normal_load_variation.contact")
    if contact is not None and (contact == "constant").any():
        return []
    rows = curve.rows[curve.rows["velocity_ratio"].abs() > 0]
    sliding = (rows["mean_friction"] / rows["normalized_friction"]).dropna().abs()
    across = rows["transverse_velocity_amplitude"].abs().max() > 0
    if across or sliding.empty or sliding.max() - sliding.min() > 1e-9 * sliding.max():
        return []
    speeds = curve.rows[belt_speed(curve.rows.columns)]
    limit = float((speeds[rows.index] / rows["velocity_ratio"]).median())
    low, high = speeds.min(), speeds.max()
    return [speed for speed in (-limit, limit) if low < speed < high]


def is_logarithmic(values: NDArray[np.float64]) -> bool:
    """Whether the distinct values are spaced evenly in their logarithms rather than in themselves."""
    steps = np.unique(values[np.isfinite(values)])
    if len(steps) < 3 or steps[0] <= 0 or steps[-1] < 5 * steps[0]:
        return False
    return _unevenness(np.log(steps)) < _unevenness(steps)


def _unevenness(steps: NDArray[np.float64]) -> float:
    gaps = np.diff(steps)
    return float(gaps.std() / gaps.mean())
