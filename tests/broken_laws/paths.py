"""Mistakes of bristles along a path, and of where steady sliding leads."""

from __future__ import annotations

import math
from typing import Any

from broken_laws.case import Case
from broken_laws.twins import BreakingAway, Bristles, broken, curve
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.jenkins import Jenkins


class OtherCurve(Bristles):
    """Bristles tend to another curve than the one told: its exponent is one less."""

    def rate(self, v: Any, z: Any) -> Any:
        """exp(-u) in place of exp(-u^2)."""
        curve = self.mu + self.drop * math.exp(-abs(v) / self.speed)
        return v - (self.stiffness * abs(v) / curve) * z


class TwiceAsFar(Dahl):
    """An exact update of half the saturation."""

    def deflected(self, z: Any, path: Any) -> Any:
        """As after twice the path."""
        return super().deflected(z, 2.0 * path)


class Straightened(Dahl):
    """A step of Euler's for an exact update."""

    def deflected(self, z: Any, path: Any) -> Any:
        """Along the slope at the start."""
        if path == 0.0:
            return z
        gone = min(abs(path) / self.saturation, 1.0)
        end = path / abs(path) * self.saturation
        return z + (end - z) * gone


class SaturatesEarly(Dahl):
    """The path to the limit, half of what it is."""

    exponent: float = 0.5

    def saturation_path(self, z: float, side: float) -> float:
        """Half."""
        return 0.5 * super().saturation_path(z, side)


class ElasticTooFar(BreakingAway):
    """Bristles that break away sooner than told."""

    def elastic_deflection(self) -> float:
        """That of quick slip."""
        return self.mu / self.stiffness


class SlipsBack(BreakingAway):
    """Elasto-plastic friction without its branch of unloading."""

    def rate(self, v: Any, z: Any) -> Any:
        """Broken away whichever way it slips."""
        most = curve(self, abs(v)) / self.stiffness
        return v - (broken(abs(z), 0.5 * self.mu / self.stiffness, most) * abs(v) / most) * z


class YieldsEarly(Jenkins):
    """A spring that slips before its reach."""

    def rate(self, v: Any, z: Any) -> Any:
        """At nine tenths of it."""
        along = (z * v.conjugate()).real
        if along <= 0.0 or abs(z) < 0.9 * self.reach:
            return v
        return v - (along / (z * z.conjugate()).real) * z


CASES = (
    Case(OtherCurve, Bristles, "steady_sliding"),
    Case(TwiceAsFar, Dahl, "exact_path"),
    Case(Straightened, Dahl, "path_splitting"),
    Case(SaturatesEarly, Dahl, "saturation_path"),
    Case(ElasticTooFar, BreakingAway, "elastic_deflection"),
    Case(SlipsBack, BreakingAway, "elastic_unloading"),
    Case(YieldsEarly, Jenkins, "yield_deflection"),
)
