"""Average-friction curves of vibrated sliding bodies, every point with a true error."""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import version
from typing import Any

__version__ = version("frictionlab")

_HOMES = {
    "Auto": "frictionlab.methods.auto",
    "BristleLaw": "frictionlab.laws.bristle",
    "CompliantLaw": "frictionlab.laws.bristle",
    "Coulomb": "frictionlab.laws.coulomb",
    "Dahl": "frictionlab.laws.dahl",
    "DampedLaw": "frictionlab.laws.bristle",
    "Dimension": "frictionlab.laws.base",
    "Dimensional": "frictionlab.dimensional",
    "DimensionalDrive": "frictionlab.dimensional",
    "DimensionalInitial": "frictionlab.dimensional",
    "DimensionalLoad": "frictionlab.dimensional",
    "DimensionalTransverse": "frictionlab.dimensional",
    "Drive": "frictionlab.scene",
    "ElastoPlastic": "frictionlab.laws.elasto_plastic",
    "Exact": "frictionlab.methods.exact",
    "Finite": "frictionlab.laws.base",
    "FrictionLaw": "frictionlab.laws.base",
    "HarmonicBalance": "frictionlab.methods.harmonic_balance",
    "Initial": "frictionlab.scene",
    "Jenkins": "frictionlab.laws.jenkins",
    "Length": "frictionlab.laws.bristle",
    "Load": "frictionlab.scene",
    "LuGre": "frictionlab.laws.lugre",
    "March": "frictionlab.methods.march",
    "Mdsm": "frictionlab.methods.mdsm",
    "MemoryLaw": "frictionlab.laws.memory",
    "NonNegative": "frictionlab.laws.base",
    "PerSpeed": "frictionlab.laws.base",
    "Positive": "frictionlab.laws.base",
    "Scene": "frictionlab.scene",
    "Shooting": "frictionlab.methods.shooting",
    "SlidingLaw": "frictionlab.laws.base",
    "Slip": "frictionlab.scene",
    "Speed": "frictionlab.laws.base",
    "SteadyState": "frictionlab.runner",
    "Stiffness": "frictionlab.laws.bristle",
    "Stribeck": "frictionlab.laws.stribeck",
    "Transverse": "frictionlab.scene",
    "TransverseSlip": "frictionlab.scene",
    "curve": "frictionlab.runner",
    "run": "frictionlab.runner",
    "steady_state": "frictionlab.runner",
}

__all__ = ["__version__", *sorted(_HOMES)]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for: ``import frictionlab`` itself stays quick."""
    if name not in _HOMES:
        raise AttributeError(f"module 'frictionlab' has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
