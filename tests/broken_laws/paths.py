"""Mistakes of bristles along a path, and of where steady sliding leads."""

from __future__ import annotations

from typing import Any

from broken_laws.case import Case, bug
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.elasto_plastic import ElastoPlastic, breakaway_share
from frictionlab.laws.jenkins import Jenkins
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.stribeck_bristle import stribeck_curve


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
    """Of twice the speed of the fall."""
    return v - (law.bristle_stiffness * abs(v) / stribeck_curve(law, 0.5 * abs(v))) * z


def straightened(law: Any, z: Any, path: Any) -> Any:
    """A step of Euler's along the slope at the start."""
    if path == 0.0:
        return z
    gone = min(abs(path) / law.saturation, 1.0)
    end = path / abs(path) * law.saturation
    return z + (end - z) * gone


def slips_back(law: Any, v: Any, z: Any) -> Any:
    """Broken away whichever way it slips: without the branch of unloading."""
    most = stribeck_curve(law, abs(v)) / law.bristle_stiffness
    return v - (breakaway_share(abs(z), law.elastic_deflection(), most) * abs(v) / most) * z


def yields_early(law: Any, v: Any, z: Any) -> Any:
    """At nine tenths of the spring's reach."""
    along = (z * v.conjugate()).real
    if along <= 0.0 or abs(z) < 0.9 * law.reach:
        return v
    return v - (along / (z * z.conjugate()).real) * z


CASES = (
    bug("OtherCurve", LuGre, "steady_sliding", rate=towards_another_curve),
    Case(TwiceAsFar, Dahl, "exact_path"),
    bug("Straightened", Dahl, "path_splitting", deflected=straightened),
    Case(SaturatesEarly, Dahl, "saturation_path"),
    bug(  # that of quick slip
        "ElasticTooFar",
        ElastoPlastic,
        "elastic_deflection",
        elastic_deflection=lambda law: law.mu_kinetic / law.bristle_stiffness,
    ),
    bug("SlipsBack", ElastoPlastic, "elastic_unloading", rate=slips_back),
    bug("YieldsEarly", Jenkins, "yield_deflection", rate=yields_early),
)
