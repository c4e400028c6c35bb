"""Mean friction of a vibrated body on a moving belt, and how far each number may be off."""

from __future__ import annotations

from importlib import import_module
from typing import Any

__version__: str

_HOMES = {
    "Answers": "frictionlab.methods.base",
    "Auto": "frictionlab.methods.auto",
    "BeltVibration": "frictionlab.scene.scene",
    "Body": "frictionlab.scene.scene",
    "BristleLaw": "frictionlab.laws.memory",
    "CompliantLaw": "frictionlab.laws.compliant",
    "Coulomb": "frictionlab.laws.coulomb",
    "Dahl": "frictionlab.laws.dahl",
    "DampedLaw": "frictionlab.laws.compliant",
    "Dimension": "frictionlab.laws.base",
    "Drive": "frictionlab.scene.scene",
    "Dupont": "frictionlab.laws.elasto_plastic",
    "ElastoPlastic": "frictionlab.laws.elasto_plastic",
    "Exact": "frictionlab.methods.exact.method",
    "Finite": "frictionlab.laws.base",
    "Fractional": "frictionlab.scene.scene",
    "FrictionLaw": "frictionlab.laws.base",
    "HarmonicBalance": "frictionlab.methods.reduced.harmonic_balance",
    "Initial": "frictionlab.scene.scene",
    "Jenkins": "frictionlab.laws.jenkins",
    "Ledger": "frictionlab.methods.base",
    "Length": "frictionlab.laws.compliant",
    "Load": "frictionlab.scene.scene",
    "LuGre": "frictionlab.laws.lugre",
    "March": "frictionlab.methods.march.method",
    "Mdsm": "frictionlab.methods.reduced.mdsm",
    "MemoryLaw": "frictionlab.laws.memory",
    "Method": "frictionlab.methods.base",
    "NonNegative": "frictionlab.laws.base",
    "NormalLoadVariation": "frictionlab.scene.scene",
    "Orbit": "frictionlab.motion.orbit.record",
    "PerSpeed": "frictionlab.laws.base",
    "Positive": "frictionlab.laws.base",
    "Receptance": "frictionlab.scene.scene",
    "Relaxation": "frictionlab.scene.scene",
    "Run": "frictionlab.report.run",
    "Scene": "frictionlab.scene.scene",
    "Shooting": "frictionlab.methods.shooting.method",
    "SlidingLaw": "frictionlab.laws.base",
    "Slip": "frictionlab.scene.scene",
    "Speed": "frictionlab.laws.base",
    "SteadyState": "frictionlab.runner.state",
    "Stiffness": "frictionlab.laws.compliant",
    "Stribeck": "frictionlab.laws.stribeck",
    "Study": "frictionlab.study.study",
    "Transverse": "frictionlab.scene.scene",
    "TransverseSlip": "frictionlab.scene.scene",
    "attractors": "frictionlab.runner.api",
    "compare": "frictionlab.report.run",
    "curve": "frictionlab.runner.api",
    "describing_function": "frictionlab.analysis.response",
    "drift_speed": "frictionlab.runner.steady_state",
    "equivalent": "frictionlab.analysis.fit.equivalent",
    "fit": "frictionlab.analysis.fit.api",
    "impedance": "frictionlab.analysis.response",
    "is_unique": "frictionlab.theory.rest",
    "load": "frictionlab.report.run",
    "needs": "frictionlab.analysis.needs.needs",
    "run": "frictionlab.report.run",
    "sensitivities": "frictionlab.analysis.sensitivities",
    "steady_state": "frictionlab.runner.steady_state",
    "sweep": "frictionlab.report.run",
    "trajectory": "frictionlab.runner.trajectory",
}

_OTHER_NAMES = {"Dupont": "ElastoPlastic"}
"""Second names of public classes."""

_RECIPE = "docs/fit.md has a recipe of a dozen lines"
_GONE = {
    "Dimensional": "write fl.Scene.si(mass=..., ...)",
    "discriminate": _RECIPE,
    "best_waveform": _RECIPE,
}
"""Names that were public, and what takes their place."""

__all__ = ["__version__", *sorted(_HOMES)]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for: ``import frictionlab`` itself stays quick."""
    if name == "__version__":
        from importlib.metadata import version  # with email and zipfile, half of the time of an import

        return version("frictionlab")
    if name in _GONE:
        raise AttributeError(f"fl.{name} is gone: {_GONE[name]}")
    if name not in _HOMES:
        what = f"module 'frictionlab' has no attribute {name!r}"
        raise AttributeError(what, name=name, obj=import_module(__name__))  # Python then says what was meant
    return getattr(import_module(_HOMES[name]), _OTHER_NAMES.get(name, name))


def __dir__() -> list[str]:
    return sorted(__all__)
