"""Curves made of curves: in shares of V_lin and of steady sliding friction, and as differences from one law."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from frictionlab.charts.curves import CurveData, Family
from frictionlab.columns import belt_speed

SPEED_RATIO = "velocity_ratio"
BAND = "mean_friction", "mean_low", "mean_high"


def is_along_speed(family: Family) -> bool:
    """Whether belt speed, as given or over V_lin, runs along the axis."""
    return family.abscissa in (SPEED_RATIO, belt_speed([family.abscissa]))


def normalized(family: Family) -> Family | None:
    """The same curves against belt speed over V_lin, mean friction over that of steady sliding.

    None where belt speed is not the axis, or a curve with a number has no V_lin.
    """
    if family.abscissa == SPEED_RATIO or not is_along_speed(family):
        return None
    with_numbers = [curve for curve in family.curves if curve.rows["mean_friction"].notna().any()]
    wanted = [SPEED_RATIO, "normalized_friction"]
    if any(set(wanted) - set(curve.rows) or curve.rows[wanted].isna().all().any() for curve in with_numbers):
        return None
    scaled = [
        replace(curve, rows=_in_shares(curve, family.abscissa), kinks=_signs(curve)) for curve in with_numbers
    ]
    return replace(family, abscissa=SPEED_RATIO, curves=scaled)


def _signs(curve: CurveData) -> tuple[float, ...]:
    return tuple(float(np.sign(kink)) for kink in curve.kinks)


def _in_shares(curve: CurveData, abscissa: str) -> pd.DataFrame:
    """Its rows; V_lin and steady sliding friction are carried on to points that have no number of their own."""
    rows = curve.rows
    speed = rows[abscissa].to_numpy(dtype=float)
    ratio = (rows[SPEED_RATIO] / speed).replace([np.inf, -np.inf], np.nan).median()
    steady = (rows["mean_friction"] / rows["normalized_friction"]).to_numpy(dtype=float)
    known = np.isfinite(steady)
    share = 1.0 / np.interp(speed, speed[known], steady[known])
    columns = {name: rows[name] * share for name in BAND if name in rows}
    return rows.assign(**columns, error=rows["error"] * np.abs(share), **{SPEED_RATIO: ratio * speed})


def reference_law(family: Family, against: str | None = None) -> str | None:
    """The label of the law that others are held against; None where there is only one.

    That is the one asked for, else that of Coulomb friction, else the first.
    """
    laws = {curve.law: str(curve.rows["kind"].iloc[0]) for curve in family.curves}
    if len(laws) < 2:
        return None
    if against is not None:
        return against if against in laws else None
    return next((law for law, kind in laws.items() if kind == "coulomb"), next(iter(laws)))


def differences(family: Family, law: str) -> Family | None:
    """Mean friction less that of a law at the same points, with the sum of both errors; None where nothing is left.

    A curve is compared by its own method where that has one of the law, else by the first that has.
    """
    found = []
    for curve in family.curves:
        if curve.law == law or (of := _counterpart(curve, family.curves, law)) is None:
            continue
        less = of.rows["mean_friction"].to_numpy(dtype=float)
        both = curve.rows["error"].to_numpy(dtype=float) + of.rows["error"].to_numpy(dtype=float)
        columns = {name: curve.rows[name] - less for name in BAND if name in curve.rows}
        found.append(replace(curve, rows=curve.rows.assign(**columns, error=both)))
    known = any(curve.rows["mean_friction"].notna().any() for curve in found)
    return replace(family, curves=found) if known else None


def _counterpart(curve: CurveData, others: Sequence[CurveData], law: str) -> CurveData | None:
    """The curve of that law in the same picture, at the same points, of the same swept value if it has one."""
    fit = [
        other
        for other in others
        if other.law == law
        and other.panel == curve.panel
        and (other.member == curve.member or other.member is None or other.member[1] is None)
        and _same_points(curve, other)
        and other.rows["mean_friction"].notna().any()
    ]
    return next((other for other in fit if other.method == curve.method), fit[0] if fit else None)


def _same_points(one: CurveData, other: CurveData) -> bool:
    names = [name for name in one.rows if name.startswith("scene.") and name in other.rows]
    numbers = [each.rows[names].select_dtypes("number").to_numpy(dtype=float) for each in (one, other)]
    return bool(np.array_equal(numbers[0], numbers[1], equal_nan=True))
