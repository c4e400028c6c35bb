"""The driven body of Fig. 4b, whose mean friction many tests ask for, and studies of it."""

from __future__ import annotations

from typing import Any

import frictionlab as fl

GIVEN: dict[str, Any] = {"damping_ratio": 0.1, "normal_load": 10, "belt_speed": 5}
GIVEN |= {"drive": {"unbalance": 10, "frequency": 1}}
SCENE, LAW = fl.Scene(**GIVEN), fl.Coulomb(mu=0.4)
COULOMB = {"kind": "coulomb", "mu": 0.4}
STEADY = '''"""A law."""
import frictionlab as fl


class Steady(fl.SlidingLaw):
    """Friction of one strength. mu [-], > 0: friction coefficient. Source: Amontons (1699)."""

    mu: fl.Positive

    def sliding_friction(self, speed: float) -> float:
        """The coefficient."""
        return self.mu
'''
"""A file with a law of somebody's."""


def over_speeds(belt_speeds: Any, **changes: Any) -> dict[str, Any]:
    """Return a study at these belt speeds by the exact method, but for the changes."""
    given = {"schema": 1, "scene": GIVEN, "laws": [COULOMB], "methods": ["exact"]}
    return given | {"sweep": {"scene.belt_speed": belt_speeds}} | changes
