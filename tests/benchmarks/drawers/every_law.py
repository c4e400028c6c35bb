"""Random scenes of every law, method and tolerance, as plain numbers alone: the same for every checkout."""

from __future__ import annotations

import math
import random
from typing import Any

FAMILIES = (
    *("coulomb", "coulomb", "coulomb", "more at rest", "stribeck", "dahl", "exponent", "lugre"),
    *("falling lugre", "elasto-plastic", "jenkins", "maxwell-slip", "rate-and-state"),
)
NO_MEMORY = "coulomb", "more at rest", "stribeck"
PLUGINS = "maxwell-slip", "rate-and-state"


def draw(rng: random.Random) -> dict[str, Any]:
    """A scene, a law, a method and a tolerance, as plain values."""
    family, freedom = rng.choice(FAMILIES), rng.choice((0, 1, 1, 1, 2))
    if family in PLUGINS and freedom == 2:  # seconds a scene
        freedom = 1
    scene, speed = _prescribed(rng) if freedom == 0 else _free(rng, freedom)
    frequency = (scene.get("drive") or scene.get("slip") or scene.get("transverse_slip") or {}).get(
        "frequency", 1.0
    )
    made = law(rng, family, _log(rng, 1e-4, 1e2) * speed / frequency, speed)
    if freedom != 1 and "presliding_length" in made and rng.random() < 0.2:
        made["planar"] = "per-axis"
    one = {"family": family, "freedom": freedom, "scene": scene, "law": made}
    return one | {"method": _method(rng, family, freedom), "tolerance": rng.choice((1e-4, 1e-6, 1e-8))}


def _log(rng: random.Random, low: float, high: float) -> float:
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def _prescribed(rng: random.Random) -> tuple[dict[str, Any], float]:
    size, frequency = _log(rng, 0.1, 30.0), _log(rng, 0.2, 5.0)
    which = rng.choice(("along", "along", "across", "both"))
    scene: dict[str, Any] = {"belt_speed": _belt_speed(rng, size)}
    if which != "across":
        phase = rng.uniform(0.0, 360.0)
        scene["slip"] = {"velocity_amplitude": size, "frequency": frequency, "phase": phase}
    if which != "along":
        across = {"velocity_amplitude": size * _log(rng, 0.1, 5.0), "phase": rng.uniform(0.0, 360.0)}
        scene["transverse_slip"] = across | ({"frequency": frequency} if which == "across" else {})
    return scene, size


def _free(rng: random.Random, freedom: int) -> tuple[dict[str, Any], float]:
    """A body, driven but for one in twenty; friction is 0.01 ... 2 of the load."""
    frequency, damping, load = _log(rng, 0.3, 5.0), _log(rng, 0.02, 0.5), _log(rng, 0.1, 100.0)
    if rng.random() < 0.05:
        damping = rng.choice((0.0, 1.0))
    stiffness = math.hypot(1.0 - frequency**2, 2.0 * damping * frequency)
    speed = load * frequency / max(stiffness, 1e-3)
    pressed = load * _log(rng, 0.01, 2.0) / 0.4
    scene: dict[str, Any] = {"damping_ratio": damping, "normal_load": pressed}
    scene["belt_speed"] = _belt_speed(rng, speed)
    driven = rng.random() > 0.05
    if driven:
        scene["drive"] = {"amplitude": load, "frequency": frequency, "phase": rng.uniform(0.0, 360.0)}
    if freedom == 2:
        scene["transverse"] = {
            "natural_frequency": _log(rng, 0.3, 5.0),
            "damping_ratio": _log(rng, 0.02, 0.5),
        }
        if driven and rng.random() < 0.9:
            across = {
                "amplitude": load * _log(rng, 0.1, 10.0),
                "phase": rng.choice((0.0, rng.uniform(0.0, 360.0))),
            }
            scene["transverse"]["load"] = across
    if rng.random() < 0.1:
        scene["initial"] = {"x": rng.uniform(-1.0, 1.0) * speed, "velocity": rng.uniform(-1.0, 1.0) * speed}
    return scene, speed


def _belt_speed(rng: random.Random, speed: float) -> float:
    kind = rng.random()
    if kind < 0.05:
        return 0.0
    side = -1.0 if kind > 0.85 else 1.0
    grazing = 1.0 + rng.choice((-1.0, 1.0)) * 10.0 ** rng.uniform(-6.0, -2.0)
    return side * speed * (grazing if kind < 0.15 else _log(rng, 0.01, 1.5))


def law(rng: random.Random, family: str, length: float, speed: float) -> dict[str, Any]:
    """mu about 0.4; length: of presliding, or of slip that renews the contact; speed: of the motion."""
    mu = rng.uniform(0.2, 0.6)
    bristles: dict[str, Any] = {"presliding_length": length}
    damped = bristles | ({"damping": _log(rng, 1e-4, 0.3) * mu / speed} if rng.random() < 0.7 else {})
    higher = {"mu_static": mu * rng.uniform(1.0, 1.6), "stribeck_speed": _log(rng, 0.05, 2.0) * speed}
    higher["viscosity"] = rng.choice((0.0, _log(rng, 1e-3, 0.3) * mu / speed))
    if family == "stribeck":
        curve = rng.choice(("exponential", "hyperbolic", "hess-soom", "cubic"))
        return {"kind": "stribeck", "mu_kinetic": mu, "curve": curve, **higher}
    if family == "maxwell-slip":
        parts = [mu * share for share in (0.5, 0.3, 0.2)]
        return {"kind": family, "mu": parts, "stiffness": [mu / length * k for k in (1.0, 0.4, 0.1)]}
    if family == "rate-and-state":
        ages = {"a": 0.01, "b": rng.choice((0.008, 0.015)), "slip_length": length}
        return {"kind": family, "mu": mu, "reference_speed": speed, **ages}
    return {
        "coulomb": {"kind": "coulomb", "mu": mu},
        "more at rest": {"kind": "coulomb", "mu": mu, "mu_static": mu * rng.uniform(1.0, 1.6)},
        "dahl": {"kind": "dahl", "mu": mu, **bristles},
        "exponent": {"kind": "dahl", "mu": mu, "exponent": rng.uniform(0.5, 2.0), **bristles},
        "lugre": {"kind": "lugre", "mu_kinetic": mu, **damped},
        "falling lugre": {"kind": "lugre", "mu_kinetic": mu, **higher, **damped},
        "elasto-plastic": {
            "kind": "elasto-plastic", "mu_kinetic": mu, "breakaway_ratio": rng.uniform(0.1, 0.95), **damped,
        },
        "jenkins": {"kind": "jenkins", "mu": mu, **bristles},
    }[family]  # fmt: skip


def _method(rng: random.Random, family: str, freedom: int) -> dict[str, Any]:
    kind = rng.random()
    if kind < 0.4:
        return {"kind": "auto"}
    if kind < 0.65:
        return {"kind": "shooting"}
    if kind < 0.78:
        return {"kind": "exact" if family in NO_MEMORY or freedom == 0 else "shooting"}
    if kind < 0.95:
        return {"kind": rng.choice(("mdsm", "harmonic_balance"))}
    return {"kind": "march", "steps": 200}
