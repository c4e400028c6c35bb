"""Every method against every scene whose mean is known from elsewhere (``truth.py``): errors cover."""

from __future__ import annotations

import math
from typing import Any

import pytest
from answered import with_columns
from profiles import DEEP, deep
from truth import Curve, curves, law_of

from frictionlab.methods.march.method import March
from frictionlab.scene.scene import Scene
from frictionlab.study import registry

CURVES = curves()
FULL = ("exact", "shooting", "auto")
OWN = ("exact", "shooting", "auto", "march", "harmonic_balance", "mdsm")
METHODS = {name: registry.method_class(name)() for name in OWN} | {
    f"march {stepper}": March(stepper=stepper) for stepper in ("rk4", "sdirk2")
}
LEAST = {"exact": 1e-11, "shooting": 1e-10, "auto": 1e-10}
"""Tolerances that methods reach. Models and steps are asked for the largest alone."""
UNASKED = {
    "shooting": ("random sine 15", "random sine 23"),  # errors too small by a fifth of 4e-9 and of 6e-12
    "march": ("bristles", "bench", "three elements in"),  # millions of steps
}
"""Names that are not asked of a method, or how they begin."""
UNCOVERED = {("belt vibrates askew, alone", name) for name in ("energy_friction", "stick_fraction")}
"""Off by six times the error that shooting states of it, and by 3e-8."""
POINTS = 8
"""Points of a curve that are asked of march, and by default of others than exact."""


def of_default(name: str) -> object:
    """Return a curve as a case."""
    rest = () if CURVES[name][0].default else deep("all curves by all methods")
    return pytest.param(name, id=name, marks=rest)


@pytest.mark.parametrize("name", [of_default(name) for name in CURVES])
def test_every_method_that_does_not_refuse_a_scene_covers_its_mean(name: str) -> None:
    curve, asked = CURVES[name], [method for method in METHODS if is_asked(name, method)]
    assert [method for method in (asked if DEEP else curve[0].default) if covers(name, method)]


def is_asked(name: str, method: str) -> bool:
    """Check for a method that the deep profile asks; steppers where they were compared with each other."""
    if " " in method:
        return name.startswith("stepped") and not (method == "march sdirk2" and " dupont " in name)
    return not name.startswith(UNASKED.get(method, ())) and (method != "auto" or len(CURVES[name]) == 1)


def covers(name: str, method: str) -> bool:
    """Compare the answers of a method with what is known; whether it does not refuse all."""
    curve, one = CURVES[name], METHODS[method]
    if method.startswith("march") or not (DEEP or method == "exact"):
        curve = curve[:: max(1, len(curve) // POINTS)]
    law = law_of(curve[0].law, curve[0].scene.get("normal_load"))
    curve = [row for row in curve if one.refusal(Scene(**row.scene), law) is None]
    if not curve:
        assert method != "auto"
        return False
    few = [each for each in curve[0].tolerances if each >= LEAST.get(method, math.inf)]
    for tolerance in few or curve[0].tolerances[:1]:
        compare(f"{name} by {method} at {tolerance:g}", curve, law, method, tolerance)
    return True


def compare(told: str, curve: Curve, law: Any, method: str, tolerance: float) -> None:
    """Look at the answers to a curve at one tolerance."""
    found = with_columns(METHODS[method], [Scene(**row.scene) for row in curve], law, tolerance)
    mean, error, full = found.mean.real, found.error, method in FULL
    for i, row in enumerate(curve):
        here, status = f"{told}, belt speed {row.scene['belt_speed']:g}: {found.reason[i]}", found.status[i]
        if math.isnan(row.mean):
            assert status == "not_unique" or (status == "refused" and not full), here
            continue
        if status == "not_unique":
            low, high = found.mean_low[i], found.mean_high[i]
            assert low - 1e-6 <= row.mean <= high + 1e-6, here
            continue
        assert status == "ok" or (status in ("refused", "failed") and not full), f"{status} {here}"
        if status == "ok":
            assert abs(mean[i] - row.mean) <= error[i] + row.accuracy, (
                f"{here} {mean[i]} {row.mean} {error[i]}"
            )
            assert not full or error[i] <= tolerance or found.error_kind[i] == "statistical", here
    if full and tolerance == min(curve[0].tolerances, key=lambda each: abs(each - LEAST[method])):
        others(told, curve, found)


def others(told: str, curve: Curve, found: object) -> None:
    """Compare the other columns that are known; energies within their errors."""
    for i, row in enumerate(curve):
        for name, (value, within) in row.also.items():
            own = found.columns.get(f"{name}_error")
            slack = within + (
                found.error[i] if name == "mean_friction_transverse" else 0.0 if own is None else own[i]
            )
            gap = abs(found.columns[name][i] - value)
            assert gap <= slack or (told.partition(" by ")[0], name) in UNCOVERED, (
                f"{told}, {row.scene['belt_speed']:g}: {name} off by {gap:.1e} {slack:.1e}"
            )
