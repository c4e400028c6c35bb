"""The curves of a result table: the input along the axis, and the input that distinguishes curves."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from pandas.api.types import is_numeric_dtype

from frictionlab.columns import BELT_SPEEDS, SCALED, SHOWN_IN_PART, belt_speed, given, leading, word

T = TypeVar("T")
MOST_PICTURES = 12  # in which several laws are compared; of more values each law has a picture of its own
LEAST_VISIBLE = 0.004  # share of an axis: half a line width at the size of a panel
READ_FOR_KINKS = "velocity_ratio", "mean_friction", "normalized_friction"
INPUTS_ACROSS = "load.unbalance", "load.amplitude", "slip.velocity_amplitude", "direction"  # ends of inputs
_ROUNDING = 1e-15  # rounding of a mean of order one
POINTS_OF_A_CURVE = 8  # belt speeds; with fewer no shape is read, and what takes more values says more
SweptValue = tuple[
    str, float | str | None
]  # a swept input and its value; None where a law has no such parameter


@dataclass(frozen=True)
class CurveData:
    """The rows of one law and method whose inputs differ in the abscissa alone, sorted along it.

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
        """The name of an input in words, with what changes together with it."""
        return self.linked.get(name) or word(name)

    @property
    def panels(self) -> list[tuple[SweptValue, ...]]:
        """The pictures the curves belong to, in order."""
        return list(dict.fromkeys(curve.panel for curve in self.curves))


def family_of(table: pd.DataFrame) -> Family | None:
    """The curves of a table; None where no number is swept.

    Along the axis: belt speed, or the swept number of most values where belt speed takes too few for a curve.
    Several laws are compared in a picture for each value of the scene, and the parameter of most values tells the
    curves of a law apart; where that makes too many pictures, each law has its own. Of one law the quantity of most
    values tells curves apart. Each further one sets up pictures.
    """
    table = _with_one_friction(table.rename(columns=_names_in_si(table.columns)))
    swept, numbers = swept_by_size(table), swept_numbers(table)
    if not numbers:
        return None
    abscissa = along_the_axis(table, numbers)
    panels = [name for name in swept if name != abscissa]
    if table["law"].nunique() == 1:
        member = panels.pop() if panels else None
        return family_by(table, abscissa, panels, member)
    parameters = [name for name in panels if name.startswith("law.")]
    if member := parameters[-1] if parameters else None:
        panels.remove(member)
    elif math.prod(table[name].nunique() for name in panels) > MOST_PICTURES:
        member = panels.pop()
        return family_by(table, abscissa, ["law", *panels], member)
    return family_by(table, abscissa, panels, member)


def family_by(table: pd.DataFrame, abscissa: str, panels: list[str], member: str | None) -> Family:
    """The curves of a table along this column. panels: what sets up pictures, ``law`` where each law has its own."""
    panels = list(dict.fromkeys(each for name in panels for each in (name, *_linked_with(table, name))))
    linked = {name: linked_words(table, name) for name in (abscissa, member) if name}
    return Family(abscissa, member, _curves(table, abscissa, panels, member), linked)


def linked_words(table: pd.DataFrame, name: str) -> str:
    """An input in words, with those of the scene that change together with it."""
    return ", with ".join(map(word, (name, *_linked_with(table, name))))


def _linked_with(table: pd.DataFrame, name: str) -> list[str]:
    """Inputs of the scene that count as no sweep of their own, for they follow from this one."""
    swept = swept_columns(table)
    names = [each for each in given(table.columns) if each.startswith("scene.") and each not in swept]
    return [
        each for each in names if table[each].nunique() > 1 and table.groupby(name)[each].nunique().max() == 1
    ]


def along_the_axis(table: pd.DataFrame, swept: list[str]) -> str:
    """Of these swept numbers, the fewest values first, the one along the axis."""
    speed = belt_speed(table.columns)
    if speed not in swept:
        return swept[-1]
    of_a_curve = table[speed].nunique() >= min(POINTS_OF_A_CURVE, table[swept[-1]].nunique())
    return speed if of_a_curve else swept[-1]


def _names_in_si(columns: Iterable[str]) -> dict[str, str]:
    """Names that tell the parameters of a law given in SI units from nondimensional ones: they have a unit."""
    scaled = [name.removeprefix(SCALED) for name in columns if name.startswith(SCALED)]
    return {f"law.{name}": f"law.dimensional.{name}" for name in scaled}


def swept_by_size(table: pd.DataFrame) -> list[str]:
    """The swept columns, those of the fewest values first."""
    return sorted(swept_columns(table), key=lambda name: table[name].nunique())


def swept_numbers(table: pd.DataFrame) -> list[str]:
    """The swept columns that are numbers, those of the fewest values first."""
    return [name for name in swept_by_size(table) if is_numeric_dtype(table[name])]


def some_of(values: Sequence[T], most: int) -> list[T]:
    """So many of the values at most, spread over all of them, the first and the last among them."""
    places = np.unique(np.linspace(0, len(values) - 1, min(len(values), most)).round().astype(int))
    return [values[place] for place in places]


def swept_columns(table: pd.DataFrame) -> list[str]:
    """Inputs of more than one value, as given; a law's parameter counts only where it varies within one law.

    Of those that change together, the first; belt speed comes first.
    """
    names = sorted(given(table.columns), key=lambda name: name != belt_speed(table.columns))
    scene = [name for name in names if name.startswith("scene.") and table[name].nunique() > 1]
    parameters = [name for name in names if name.startswith("law.") and is_numeric_dtype(table[name])]
    laws = [name for name in parameters if table.groupby("law")[name].nunique().max() > 1]
    return scene + laws if SHOWN_IN_PART in table.attrs else leading(scene + laws, table)


def _with_one_friction(table: pd.DataFrame) -> pd.DataFrame:
    """The table with mu_kinetic under mu, where both are swept over the same values: friction of every law."""
    mu, kinetic = "law.mu", "law.mu_kinetic"
    if mu not in table or kinetic not in table or not {mu, kinetic} <= set(swept_columns(table)):
        return table
    if (
        set(table[mu].dropna()) != set(table[kinetic].dropna())
        or table[[mu, kinetic]].notna().all(axis=1).any()
    ):
        return table
    return table.assign(**{mu: table[mu].fillna(table[kinetic])}).drop(columns=kinetic)


def _curves(table: pd.DataFrame, abscissa: str, panels: list[str], member: str | None) -> list[CurveData]:
    laws, methods = table["law"].unique().tolist(), table["method"].unique().tolist()
    members = table[member].dropna().unique().tolist() if member else []
    if member and is_numeric_dtype(table[member]):
        members = sorted(members)
    apart = "law" in panels
    panels = [name for name in panels if name != "law"]
    names = [*panels, member] if member else panels
    curves = []
    for (law, method, *values), rows in table.groupby(["law", "method", *names], sort=False, dropna=False):
        settings = [swept_value(name, value) for name, value in zip(names, values, strict=True)]
        own = settings.pop() if member else None
        settings = [*([("law", law)] if apart else []), *settings]
        place = 0 if apart else laws.index(law), _index(members, own), methods.index(method)
        rows = rows if rows[abscissa].is_monotonic_increasing else rows.sort_values(abscissa)
        kinks = kinks_of(rows) if abscissa in BELT_SPEEDS else ()
        curves.append(CurveData(law, method, tuple(settings), own, place, rows, kinks))
    seen = list(dict.fromkeys(curve.panel for curve in curves))
    return sorted(curves, key=lambda curve: (_heights(curve), seen.index(curve.panel), curve.place))


def swept_value(name: str, value: Any) -> SweptValue:
    """A swept input and its value as figures tell them."""
    return name, None if pd.isna(value) else value if isinstance(value, str) else float(value)


def _index(members: list[Any], member: SweptValue | None) -> int:
    return 0 if member is None or member[1] is None else members.index(member[1])


def _heights(curve: CurveData) -> list[tuple[bool, float]]:
    """By which pictures are ordered: swept numbers by their size; those of words stay in the order of the table."""
    numbers = [None if isinstance(value, str) else value for _, value in curve.panel]
    return [(value is not None, value or 0.0) for value in numbers]


def drawn_once(curves: Sequence[CurveData], columns: Sequence[str]) -> list[CurveData]:
    """The curves without those of a method that are the line of an earlier one in all of these columns.

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
    curve: CurveData, one: CurveData, all_of_them: Sequence[CurveData], columns: Sequence[str]
) -> bool:
    """Whether a curve of another method lies on this one, of the same law and values, wherever it has numbers."""
    if (curve.law, curve.member, curve.panel) != (
        one.law,
        one.member,
        one.panel,
    ) or curve.method == one.method:
        return False
    if len(curve.rows) != len(one.rows) or (curve.rows["status"] == "not_unique").any():
        return False
    if not curve.rows[list(columns)].notna().any(axis=None):
        return False
    return all(_coincide(curve, one, column, _span(all_of_them, curve, column)) for column in columns)


def _coincide(curve: CurveData, one: CurveData, column: str, span: float) -> bool:
    here, there = (each.rows[column].to_numpy(dtype=float) for each in (curve, one))
    known = np.isfinite(here)
    near = LEAST_VISIBLE * span * np.ones(len(here))
    if column == "mean_friction":
        both = sum(each.rows["error"].to_numpy(dtype=float) for each in (curve, one))
        near = np.minimum(near, both + _ROUNDING * np.abs(here))
    return bool(np.all(np.abs(here - there)[known] <= near[known]))


def _span(curves: Sequence[CurveData], of: CurveData, column: str) -> float:
    """The range of a column in the picture of a curve."""
    values = np.concatenate(
        [each.rows[column].to_numpy(dtype=float) for each in curves if each.panel == of.panel]
    )
    known = values[np.isfinite(values)]
    return float(np.ptp(known)) if known.size else 0.0


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
    """Whether something moves the body across the belt: a load or slip there, or one at an angle to the belt."""
    if "transverse_velocity_amplitude" in rows:
        across = rows["transverse_velocity_amplitude"].to_numpy(dtype=float)
        return bool((np.abs(across[moving]) > 0.0).any())
    names = [
        name
        for name in rows
        if name.endswith(INPUTS_ACROSS) and ("transverse" in name or "direction" in name)
    ]
    numbers = [rows[name].to_numpy(dtype=float) for name in names if is_numeric_dtype(rows[name])]
    return any(bool((np.abs(each[moving]) > 0.0).any()) for each in numbers)


EVEN = 0.3
"""Unevenness below which logarithms count as even: of 1, 2, 5, 10 it is 0.14, of chosen belt speeds 0.4 and more."""


def is_logarithmic(values: NDArray[np.float64]) -> bool:
    """Whether the distinct values are spaced evenly in their logarithms rather than in themselves."""
    steps = np.unique(values[np.isfinite(values)])
    if len(steps) < 3 or steps[0] <= 0 or steps[-1] < 5 * steps[0]:
        return False
    return _unevenness(np.log(steps)) < min(_unevenness(steps), EVEN)


def _unevenness(steps: NDArray[np.float64]) -> float:
    gaps = np.diff(steps)
    return float(gaps.std() / gaps.mean())
