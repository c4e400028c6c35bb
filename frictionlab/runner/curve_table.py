"""Table of curves: one row per set of inputs other than belt speed, with the shape of its mean friction."""

from __future__ import annotations

import cmath
import math
from collections.abc import Container, Iterable, Mapping, Sequence
from typing import Any, cast

import numpy as np
import pandas as pd

from frictionlab.curves.ends import (
    Loads,
    Rows,
    Shakedown,
    Value,
    end_of_reversal,
    shakedown_of_body,
    shakedown_of_slip,
    start_friction,
)
from frictionlab.curves.verdict import Estimate, FrictionCurve, Shape, UnreadableCurve, reduction, shape_of
from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.memory import BristleLaw
from frictionlab.runner.curve_loads import ONE_SIDED, loads_of, varies
from frictionlab.runner.packing import WORDS
from frictionlab.runner.pairs import OWN_ERROR_OF_MODELS
from frictionlab.runner.part import beside_in_si
from frictionlab.runner.table import value_in
from frictionlab.runner.words import column_in_si_words
from frictionlab.study import registry
from frictionlab.values.columns import BELT_SPEEDS, CURVES, INPUTS, OF_SHAPE, SCALED
from frictionlab.values.quantities import Floats

NOT_ASKED_FOR = f"the table lacks columns that curves are read from: {', '.join(OF_SHAPE)}"
CURVE_TEXT = frozenset({"shape", "shape_by_initial", "reason"})
WHERE_NOT_UNIQUE = "not_unique_from", "not_unique_to"
"""Columns left out of the table if no curve has a value in them."""
_NEEDED = [name if name != "belt_speed" else "scene.belt_speed" for name in Rows._fields]


def curve_table(
    table: pd.DataFrame,
    laws: registry.Laws = registry.INSTALLED_LAWS,
    reduced: Container[str] = (),
) -> pd.DataFrame:
    """Return one row per curve of a result table, in its order; no rows if no curve has two belt speeds.

    Points without a number are left out. A measure that cannot be determined is empty, with the reason.
    reduced: labels of methods that solve a simpler model. Measures of such a method are read from its own
    curve; ``model_distance`` is the largest distance of that curve to the full answers.
    """
    keys = curve_inputs(table.columns)
    groups = table.groupby(keys, sort=False, dropna=False).indices if len(table) else {}
    if all(len(places) < 2 for places in groups.values()):
        return pd.DataFrame(columns=[*keys, *(name for name in CURVES if name not in WHERE_NOT_UNIQUE)])
    places = sorted((np.sort(found) for found in groups.values()), key=lambda found: int(found[0]))
    heads = table.loc[:, keys].iloc[[found[0] for found in places]].reset_index(drop=True)
    # without velocity_ratio the end of reversal is still bracketed by the reversals counted
    if any(name not in table for name in OF_SHAPE if name != "velocity_ratio"):
        return pd.concat([heads, _frame([{"reason": NOT_ASKED_FOR}] * len(heads))], axis=1)
    numbers = table.reindex(columns=_NEEDED).to_numpy(dtype=float)
    usable = (table["status"] == "ok").to_numpy() & (numbers[:, 0] > 0.0)
    several = (table["status"] == "not_unique").to_numpy()
    inputs = [dict(zip(keys, row, strict=True)) for row in heads.itertuples(index=False, name=None)]
    read = [
        measures(_rows(numbers[found[usable[found]]]), loads(given, laws), given.get("method") in reduced)
        | _not_unique(numbers[found[several[found]], 0])
        for found, given in zip(places, inputs, strict=True)
    ]
    own, scales = _frame(read), _speed_scales(table, places)
    own = own.drop(columns=[name for name in WHERE_NOT_UNIQUE if own[name].isna().all()])
    if scales:
        told = column_in_si_words(own["reason"], scales)
        own["reason"] = pd.Series(told, own.index, own["reason"].dtype)
    return pd.concat([heads, own, pd.DataFrame(beside_in_si(own, scales))], axis=1)


def _speed_scales(table: pd.DataFrame, places: Sequence[Floats]) -> dict[str, Floats]:
    """Return the velocity unit of each curve: its largest belt speed in m/s over the nondimensional one.

    Empty if scenes are not given in SI units.
    """
    if BELT_SPEEDS[1] not in table:
        return {}
    plain, given = (table[name].to_numpy(dtype=float) for name in BELT_SPEEDS)
    fastest = [found[np.abs(plain[found]).argmax()] for found in places]
    with np.errstate(invalid="ignore"):
        return {"velocity": given[fastest] / plain[fastest]}


def curve_inputs(columns: Iterable[str]) -> list[str]:
    """Return the names of the inputs that are equal along a curve."""
    return [
        name
        for name in columns
        if (name in INPUTS or name.startswith(("scene.", "law."))) and name not in BELT_SPEEDS
    ]


def _frame(read: list[dict[str, Any]]) -> pd.DataFrame:
    columns = {name: [found.get(name) for found in read] for name in CURVES}
    types = {name: WORDS if name in CURVE_TEXT else "float" for name in CURVES}
    return pd.DataFrame(columns, dtype=object).astype(types)


def _rows(numbers: Floats) -> Rows:
    rising = numbers[np.argsort(numbers[:, 0], kind="stable")]
    return Rows(*(np.ascontiguousarray(column) for column in rising.T))


def loads(given: Mapping[str, Any], laws: registry.Laws) -> Loads:
    """Return the loads on the body, from the inputs of a curve."""

    def value(name: str) -> float:
        found = given.get(name)
        return 0.0 if found is None or found != found else float(found)

    if varies(given):
        return loads_of(given, _law(given, laws))
    frequency = value("scene.drive.frequency")

    def force(path: str) -> complex:
        size = value(f"{path}.unbalance") * frequency**2 + value(f"{path}.amplitude")
        return cmath.rect(size, math.radians(value(f"{path}.phase")))

    static = value("law.mu_static") * value("scene.normal_load")
    slips = [value(f"scene.{slip}.velocity_amplitude") for slip in ("slip", "transverse_slip")]
    forces = force("scene.drive"), force("scene.transverse.load")
    bristles, law = _bristle_law(given, laws), _law(given, laws)
    shakedown = None if bristles is None else _shakedown(bristles, value, forces, any(slips))
    return Loads(
        *forces,
        slips[1],
        static or math.nan,
        any(slips),
        shakedown,
        _unknown_start(given, laws),
        start=0.0 if law is not None and _never_sticks(law) else math.nan,
        normal_load=value("scene.normal_load"),
        varying=law is not None and not law.constant_sliding_friction(),
    )


def _never_sticks(law: FrictionLaw) -> bool:
    """Check whether friction vanishes at rest, where a body then creeps."""
    return isinstance(law, SlidingLaw) and law.vanishes_at_rest()


def _unknown_start(given: Mapping[str, Any], laws: registry.Laws) -> str:
    """Return why the limit of friction at vanishing belt speed is not known; '' if it is known."""
    law = laws.named(given["kind"]) if given.get("kind") in laws.names() else None
    if law is not None and "oddness" in law.expected_failures:
        return ONE_SIDED
    if law is None or law.memory_kind != "deflections":
        return ""
    return "the body may stick elastically to a slow belt: the start of the curve is known for one deflection only"


def _shakedown(
    law: BristleLaw, value: Value, forces: tuple[complex, complex], prescribed: bool
) -> Shakedown | None:
    """Return the shakedown of the bristles of a curve's law."""
    return shakedown_of_slip(law, value) if prescribed else shakedown_of_body(law, value, *forces)


def _bristle_law(given: Mapping[str, Any], laws: registry.Laws) -> BristleLaw | None:
    """Return the law of a row; None if it is no known bristle law."""
    law = laws.named(given["kind"]) if given.get("kind") in laws.names() else None
    known = law is not None and law.memory_kind == "bristle"
    return cast("BristleLaw", _law(given, laws)) if known else None


def _law(given: Mapping[str, Any], laws: registry.Laws) -> FrictionLaw | None:
    """Rebuild the law of a row from its inputs, per unit normal load as methods use it.

    Return None if it is no known law.
    """
    law = laws.named(given["kind"]) if given.get("kind") in laws.names() else None
    if law is None:
        return None
    written = {name: value_in(given, f"law.{name}") for name in law.model_fields}
    scaled = {name: value_in(given, f"{SCALED}{name}") for name in written}
    values = {name: value for name, value in written.items() if value is not None}
    values |= {name: value for name, value in scaled.items() if value is not None}
    return law.model_validate(values).under_load(float(given["scene.normal_load"]))


def measures(rows: Rows, loads: Loads, of_model: bool, even: bool = False) -> dict[str, Any]:
    """Return the measures of a curve that can be determined, and why others cannot.

    of_model: True for the curve of a reduced model. even: True if points are evenly spaced in the angle of
    the interpolant.
    """
    found: dict[str, Any] = {}
    if of_model and rows.error.size:
        found["model_distance"] = float(rows.error.max())
        rows = rows._replace(error=np.minimum(rows.error, OWN_ERROR_OF_MODELS))
    found |= _reduction(rows)
    try:
        if not rows.belt_speed.size:
            raise UnreadableCurve("no point at a belt speed > 0 has a number")
        end, kinked = end_of_reversal(rows, loads)
        found |= _entry("reversal_end", end)
        start = start_friction(rows, loads)
        found |= _entry("shape_start", start)
        read = FrictionCurve(rows.belt_speed, rows.mean_friction, rows.error, start, end, kinked)
        shape = shape_of(read, even)
    except UnreadableCurve as problem:
        return found | {"reason": str(problem)}
    return found | _shape(shape)


def _not_unique(belt_speeds: Floats) -> dict[str, float]:
    """Return the lowest and the highest of these belt speeds, at which the steady state is not unique.

    Empty if there are none.
    """
    return (
        dict(zip(WHERE_NOT_UNIQUE, (belt_speeds.min(), belt_speeds.max()), strict=True))
        if belt_speeds.size
        else {}
    )


def _reduction(rows: Rows) -> dict[str, float]:
    known = np.isfinite(rows.normalized_friction)
    if not known.any():
        return {}
    size = rows.normalized_friction[known]
    return _entry("reduction", reduction(size, rows.error[known] / np.abs(rows.steady[known])))


def _shape(shape: Shape) -> dict[str, Any]:
    found: dict[str, Any] = _entry("shape_area", shape.area) | _entry("shape_half", shape.half)
    found["shape"] = shape.by_area
    if shape.initial is None:
        return found | {"reason": "the curvature at rest needs two points below a tenth of the range"}
    return found | _entry("shape_initial", shape.initial) | {"shape_by_initial": shape.by_initial}


def _entry(name: str, measured: Estimate) -> dict[str, float]:
    return {name: measured.value, f"{name}_error": measured.error}
