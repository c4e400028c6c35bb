"""Mistakes of bristles along a path, and of where steady sliding leads."""

from __future__ import annotations

import math
from typing import Any

from broken_laws.case import Case, bug
from broken_laws.twins import BreakingAway, Bristles, broken, curve
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.jenkins import Jenkins


class TwiceAsFar(Dahl):
    """An exact update of half the saturation."""

    def deflected(self, z: Any, path: Any) -> Any:
        return super().deflected(z, 2.0 * path)


class SaturatesEarly(Dahl):
    """The path to the limit, half of what it is."""

    exponent: float = 0.5

    def saturation_path(self, z: float, side: float) -> float:
        return 0.5 * super().saturation_path(z, side)


def towards_another_curve(law: Any, v: Any, z: Any) -> Any:
    """exp(-u) in place of exp(-u^2)."""
    fallen = law.mu + law.drop * math.exp(-abs(v) / law.speed)
    return v - (law.stiffness * abs(v) / fallen) * z


def straightened(law: Any, z: Any, path: Any) -> Any:
    """A step of Euler's along the slope at the start."""
    if path == 0.0:
        return z
    gone = min(abs(path) / law.saturation, 1.0)
    end = path / abs(path) * law.saturation
    return z + (end - z) * gone


def slips_back(law: Any, v: Any, z: Any) -> Any:
    """Broken away whichever way it slips: without the branch of unloading."""
    most = curve(law, abs(v)) / law.stiffness
    return v - (broken(abs(z), 0.5 * law.mu / law.stiffness, most) * abs(v) / most) * z


def yields_early(law: Any, v: Any, z: Any) -> Any:
    """At nine tenths of the spring's reach."""
    along = (z * v.conjugate()).real
    if along <= 0.0 or abs(z) < 0.9 * law.reach:
        return v
    return v - (along / (z * z.conjugate()).real) * z


CASES = (
    bug("OtherCurve", Bristles, "steady_sliding", rate=towards_another_curve),
    Case(TwiceAsFar, Dahl, "exact_path"),
    bug("Straightened", Dahl, "path_splitting", deflected=straightened),
    Case(SaturatesEarly, Dahl, "saturation_path"),
    bug(  # that of quick slip
        "ElasticTooFar",
        BreakingAway,
        "elastic_deflection",
        elastic_deflection=lambda law: law.mu / law.stiffness,
    ),
    bug("SlipsBack", BreakingAway, "elastic_unloading", rate=slips_back),
    bug("YieldsEarly", Jenkins, "yield_deflection", rate=yields_early),
)
