"""Scenes of every kind that the contract names, as the plain keys of a study."""

from __future__ import annotations

from typing import Any

Keys = dict[str, Any]

BEATS = {"harmonics": [{"order": 1, "amplitude": 1.0}, {"order": 3, "amplitude": 0.5, "phase": 70.0}]}


def line(belt_speed: float, drive: Keys | None = None, **more: Any) -> Keys:
    """One degree of freedom at resonance, friction comparable to the load; drive: what is not as usual of it."""
    usual = {"damping_ratio": 0.1, "normal_load": 10.0, "belt_speed": belt_speed}
    driven = {} if drive is None else {"drive": {"amplitude": 10.0, "frequency": 1.5} | drive}
    return usual | driven | more


def plane(belt_speed: float, drive: Keys | None, load: Keys | None, across: float = 1.7, **more: Any) -> Keys:
    """Two degrees of freedom; across: natural frequency of the second."""
    second: Keys = {"natural_frequency": across, "damping_ratio": 0.15}
    if load is not None:
        second["load"] = {"amplitude": 12.0} | load
    return line(belt_speed, drive, transverse=second, **more)


def slip(belt_speed: float, oscillation: Keys, **more: Any) -> Keys:
    """Prescribed slip of velocity amplitude 1."""
    return {
        "belt_speed": belt_speed,
        "slip": {"velocity_amplitude": 1.0, "frequency": 1.3} | oscillation,
    } | more


def belt(amplitude: float, **more: Any) -> Keys:
    """A vibrating belt."""
    return {"belt_vibration": {"velocity_amplitude": amplitude, **more}}


def load(amplitude: float, **more: Any) -> Keys:
    """A changing normal load."""
    return {"normal_load_variation": {"amplitude": amplitude, **more}}
