"""Curves made of curves: in shares of V_lin and of steady sliding friction, and as differences from one law.

V_lin between the points of a sweep, from its formula.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pandas as pd

from frictionlab.charts.curves import SPEED_RATIO, CurveData, Family
from frictionlab.scene.scene import Scene, with_values
from frictionlab.study.study import Study
from frictionlab.theory import friction_free_velocity
from frictionlab.values.columns import BELT_SPEEDS, without_shown_unit
from frictionlab.values.units import ShownUnit


def v_lin_of(study: Study, values: Mapping[str, float | str]) -> float:
    """Compute V_lin of the scene with these inputs, by their columns and as those show them.

    NaN where it asks for the law, and where there is no such scene, as there is none of a normal load below zero.
    """
    given = {}
    for shown, value in values.items():
        name = without_shown_unit(shown)
        size = study.units.get(name, ShownUnit("")).size
        given[name.removeprefix("scene.")] = value if isinstance(value, str) else value * size
    try:
        scene = Scene.model_validate(with_values(study.scene.given(), given))
    except ValueError:
        return math.nan
    if scene.normal_load_variation is not None:
        return math.nan
    si = scene.dimensional
    unit = 1.0 if si is None else si.scales.velocity / study.units.get(BELT_SPEEDS[1], ShownUnit("")).size
    return unit * friction_free_velocity(scene)


BAND = "mean_friction", "mean_low", "mean_high"


def normalized(family: Family) -> Family | None:
    """Return the same curves against belt speed over V_lin, mean friction over that of steady sliding.

    None where belt speed is not the axis, or a curve with a number has no V_lin.
    """
    if family.abscissa == SPEED_RATIO or not family.along_speed:
        return None
    with_numbers = [curve for curve in family.curves if curve.rows["mean_friction"].notna().any()]
    wanted = [SPEED_RATIO, "normalized_friction"]
    if any(set(wanted) - set(curve.rows) or curve.rows[wanted].isna().all().any() for curve in with_numbers):
        return None
    scaled = [
        replace(
            curve,
            rows=_in_shares(curve, family.abscissa),
            kinks=tuple(float(np.sign(kink)) for kink in curve.kinks),
        )
        for curve in with_numbers
    ]
    return replace(family, abscissa=SPEED_RATIO, curves=scaled)


def _in_shares(curve: CurveData, abscissa: str) -> pd.DataFrame:
    """Its rows; V_lin and steady sliding friction are carried on to points that have no number of their own."""
    rows, speed = curve.rows, curve.column(abscissa)
    ratio = (rows[SPEED_RATIO] / speed).replace([np.inf, -np.inf], np.nan).median()
    steady = curve.column("mean_friction") / curve.column("normalized_friction")
    known = np.isfinite(steady)
    share = 1.0 / np.interp(speed, speed[known], steady[known])
    columns = {name: rows[name] * share for name in BAND if name in rows}
    return rows.assign(**columns, error=rows["error"] * np.abs(share), **{SPEED_RATIO: ratio * speed})


def reference_law(family: Family, against: str | None = None) -> str | None:
    """Return the label of the law that others are held against; None where there is only one.

    That is the one asked for, else that of Coulomb friction, else the first.
    """
    laws = {curve.law: str(curve.rows["kind"].iloc[0]) for curve in family.curves}
    if len(laws) < 2 or (against is not None and against not in laws):
        return None
    return against or next((law for law, kind in laws.items() if kind == "coulomb"), next(iter(laws)))


def differences(family: Family, law: str) -> Family | None:
    """Mean friction less that of a law at the same points, with the sum of both errors; None where nothing is left.

    A curve is compared by its own method where that has one of the law, else by the first that has.
    """
    found = []
    for curve in family.curves:
        fit = [
            other for other in family.curves if other.law == law != curve.law and _comparable(curve, other)
        ]
        if not fit:
            continue
        of = next((other for other in fit if other.method == curve.method), fit[0])
        less = of.column("mean_friction")
        columns = {name: curve.rows[name] - less for name in BAND if name in curve.rows}
        both = curve.column("error") + of.column("error")
        found.append(replace(curve, rows=curve.rows.assign(**columns, error=both)))
    known = any(curve.rows["mean_friction"].notna().any() for curve in found)
    return replace(family, curves=found) if known else None


def _comparable(one: CurveData, other: CurveData) -> bool:
    """Check whether the other has numbers at the same points of the same picture and swept value."""
    member = other.member is None or other.member.value is None or other.member == one.member
    if one.panel != other.panel or not member or other.rows["mean_friction"].isna().all():
        return False
    names = [name for name in one.rows if name.startswith("scene.") and name in other.rows]
    numbers = [each.rows[names].select_dtypes("number").to_numpy(dtype=float) for each in (one, other)]
    return bool(np.array_equal(numbers[0], numbers[1], equal_nan=True))
