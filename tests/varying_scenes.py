"""Random scenes on the line with waveforms, vibrating belts and changing normal loads."""

from __future__ import annotations

from typing import Any

import numpy as np

from frictionlab.laws.coulomb import Coulomb
from frictionlab.scene.scene import Scene

SHAPES = "sine", "square", "triangle", "sawtooth", "harmonics"
RATIOS = 1, 1, 1, 2, 3, 0.5, 1.5, 2 / 3


def waveform(rng: np.random.Generator) -> Any:
    """A shape, or a sum of up to four harmonics."""
    shape = str(rng.choice(SHAPES))
    if shape != "harmonics":
        return shape
    orders = rng.choice(np.arange(1, 8), rng.integers(1, 5), replace=False)
    terms = [
        {"order": int(n), "amplitude": float(rng.normal() / n), "phase": float(rng.uniform(0, 360))}
        for n in orders
    ]
    return {"harmonics": terms}


def draw_varying(rng: np.random.Generator, decades: float = 1.0) -> tuple[Scene, Coulomb]:
    """One scene with positive damping and its law; decades: of the spread of frequency and friction."""
    frequency = float(10.0 ** rng.uniform(-0.7 * decades, 0.7 * decades))
    damping = float(10.0 ** rng.uniform(-2.0, 0.5))
    amplitude = float(10.0 ** rng.uniform(-1.0, 1.0))
    friction = amplitude * float(10.0 ** rng.uniform(-1.0 * decades, 0.7))
    mu = float(10.0 ** rng.uniform(-1.0, 0.0))
    swing = amplitude * frequency / np.hypot(1.0 - frequency**2, 2.0 * damping * frequency)
    keys: dict[str, Any] = {
        "damping_ratio": damping,
        "normal_load": friction / mu,
        "belt_speed": float(rng.choice([-1.0, 1.0]) * swing * 10.0 ** rng.uniform(-2.5, 0.4)),
        "drive": {
            "amplitude": amplitude,
            "frequency": frequency,
            "phase": _phase(rng),
            "waveform": waveform(rng),
        },
    }
    vibrates, pulsates = rng.random() < 0.5, rng.random() < 0.5
    if vibrates:
        keys["belt_vibration"] = {
            "velocity_amplitude": float(swing * 10.0 ** rng.uniform(-1.5, 0.5)),
            "phase": _phase(rng),
            "waveform": waveform(rng),
            "frequency_ratio": float(rng.choice(RATIOS)),
        }
    if pulsates:
        keys["normal_load_variation"] = {
            "amplitude": float(rng.uniform(0.0, 0.95)),
            "phase": _phase(rng),
            "waveform": waveform(rng),
            "frequency_ratio": float(rng.choice(RATIOS)),
        }
    if (vibrates or pulsates) and rng.random() < 0.2:
        del keys["drive"]
        keys["belt_vibration" if vibrates else "normal_load_variation"] |= {"frequency": frequency}
        first = keys["belt_vibration" if vibrates else "normal_load_variation"]
        del first["frequency_ratio"]
    if rng.random() < 0.05:
        keys["belt_speed"] = 0.0
    try:
        return Scene(**keys), Coulomb(mu=mu)
    except ValueError:  # a sum of harmonics may take the normal load below zero
        return draw_varying(rng, decades)


def _phase(rng: np.random.Generator) -> float:
    return float(rng.choice([0.0, 90.0, rng.uniform(0.0, 360.0)]))
