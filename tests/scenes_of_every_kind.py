"""Sixty scenes of every kind that the contract names, and random ones, as the plain keys of a study.

Waveforms, two frequencies, changing loads, vibrating belts, directions; on the line, in the plane, prescribed slip;
Coulomb friction, falling friction and bristles. ``SCENES``: name -> scene, law.
"""

from __future__ import annotations

from typing import Any

Keys = dict[str, Any]

COULOMB = {"kind": "coulomb", "mu": 0.4}
STICKY = {"kind": "coulomb", "mu": 0.4, "mu_static": 0.55}
STRIBECK = {
    "kind": "stribeck",
    "mu_kinetic": 0.3,
    "mu_static": 0.4,
    "stribeck_speed": 8.0,
    "viscosity": 0.004,
}
DAHL = {"kind": "dahl", "mu": 0.4, "presliding_length": 0.4}
LUGRE = {"kind": "lugre", "mu_kinetic": 0.4, "presliding_length": 0.3, "damping": 0.01}
FALLING_LUGRE = LUGRE | {"mu_static": 0.5, "stribeck_speed": 4.0, "viscosity": 0.005}
DUPONT = {"kind": "elasto-plastic", "mu_kinetic": 0.4, "presliding_length": 0.5, "breakaway_ratio": 0.6}
BEATS = {"harmonics": [{"order": 1, "amplitude": 1.0}, {"order": 3, "amplitude": 0.5, "phase": 70.0}]}
TWO_TONES = {"harmonics": [{"order": 2, "amplitude": 0.7, "phase": -20.0}, {"order": 5, "amplitude": 0.4}]}


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


ON_THE_LINE: dict[str, tuple[Keys, Keys]] = {
    "square drive": (line(3.0, {"waveform": "square"}), COULOMB),
    "square drive that sticks": (
        line(0.2, {"waveform": "square", "amplitude": 4.5, "frequency": 0.5}),
        COULOMB,
    ),
    "square drive, phase": (line(2.0, {"waveform": "square", "phase": 40.0, "frequency": 0.7}), COULOMB),
    "triangle drive": (line(3.0, {"waveform": "triangle"}), COULOMB),
    "triangle drive that sticks": (line(0.5, {"waveform": "triangle", "amplitude": 6.0}), COULOMB),
    "sawtooth drive": (line(2.0, {"waveform": "sawtooth", "phase": 25.0}), COULOMB),
    "sawtooth drive, belt backwards": (line(-2.0, {"waveform": "sawtooth", "frequency": 0.8}), COULOMB),
    "harmonics": (line(3.0, {"waveform": BEATS}), COULOMB),
    "harmonics without the first": (line(1.0, {"waveform": TWO_TONES, "amplitude": 8.0}), COULOMB),
    "square drive, static friction": (
        line(0.6, {"waveform": "square", "amplitude": 5.0, "frequency": 0.6}),
        STICKY,
    ),
    "triangle drive, Stribeck": (line(4.0, {"waveform": "triangle", "amplitude": 14.0}), STRIBECK),
    "square drive, little damping": (
        line(1.5, {"waveform": "square", "frequency": 2.3}) | {"damping_ratio": 0.02},
        COULOMB,
    ),
    "square drive, overdamped": (line(1.0, {"waveform": "square"}) | {"damping_ratio": 1.4}, COULOMB),
    "belt vibrates": (line(2.0, {}, **belt(4.0, phase=50.0)), COULOMB),
    "belt vibrates twice as fast": (line(2.0, {}, **belt(3.0, frequency_ratio=2)), COULOMB),
    "belt vibrates in three halves": (line(1.0, {}, **belt(3.0, frequency_ratio="3/2", phase=10.0)), COULOMB),
    "belt in a square": (line(2.0, {}, **belt(3.0, waveform="square", phase=20.0)), COULOMB),
    "belt in a triangle": (line(1.0, {"amplitude": 5.0}, **belt(1.0, waveform="triangle")), COULOMB),
    "belt in a sawtooth": (line(1.0, {"amplitude": 5.0}, **belt(1.5, waveform="sawtooth")), COULOMB),
    "belt alone": (line(1.5, **belt(6.0, frequency=1.2)), COULOMB),
    "belt alone, square": (line(1.0, **belt(3.0, frequency=2.0, waveform="square")), COULOMB),
    "belt alone, square, static friction": (line(1.0, **belt(2.0, frequency=0.6, waveform="square")), STICKY),
    "load in phase": (line(3.0, {}, **load(0.5)), COULOMB),
    "load in quadrature, twice as fast": (line(3.0, {}, **load(0.6, phase=90.0, frequency_ratio=2)), COULOMB),
    "load half as fast": (line(2.0, {}, **load(0.5, frequency_ratio=0.5)), COULOMB),
    "load in a square": (line(1.0, {"amplitude": 6.0}, **load(0.5, waveform="square", phase=70.0)), COULOMB),
    "load in a triangle that sticks": (
        line(0.3, {"amplitude": 6.0}, **load(0.8, waveform="triangle")),
        COULOMB,
    ),
    "load alone": (line(2.0, **load(0.7, frequency=1.1)), COULOMB),
    "load and belt": (
        line(1.0, **belt(3.0, frequency=1.3), **load(0.4, frequency_ratio="3/2", waveform="sawtooth")),
        COULOMB,
    ),
    "everything at once": (
        line(
            1.5,
            {"waveform": "square"},
            **belt(2.0, waveform="triangle", frequency_ratio=2),
            **load(0.4, waveform=BEATS, frequency_ratio=0.5, phase=130.0),
        ),
        COULOMB,
    ),
    "everything, falling friction": (
        line(2.0, {"waveform": "triangle"}, **belt(2.0, phase=60.0), **load(0.3, phase=-90.0)),
        STRIBECK,
    ),
    "square drive, Dahl": (line(2.0, {"waveform": "square"}), DAHL),
    "triangle drive, LuGre": (line(3.0, {"waveform": "triangle", "amplitude": 14.0}), FALLING_LUGRE),
    "sawtooth drive, elasto-plastic": (line(1.0, {"waveform": "sawtooth", "amplitude": 12.0}), DUPONT),
    "belt vibrates, Dahl": (line(2.0, {}, **belt(3.0, frequency_ratio=2, phase=15.0)), DAHL),
    "belt in a square, LuGre": (line(2.0, {}, **belt(3.0, waveform="square")), LUGRE),
    "load per contact, LuGre": (line(2.0, {}, **load(0.5, phase=30.0)), LUGRE),
    "constant contact, LuGre": (line(2.0, {}, **load(0.5, phase=30.0, contact="constant")), FALLING_LUGRE),
    "constant contact, square load, Dahl": (
        line(1.5, {}, **load(0.4, waveform="square", contact="constant", frequency_ratio=2)),
        DAHL,
    ),
    "constant contact, elasto-plastic": (
        line(1.0, {"amplitude": 12.0}, **load(0.4, phase=60.0, contact="constant")),
        DUPONT,
    ),
}

IN_THE_PLANE: dict[str, tuple[Keys, Keys]] = {
    "direction": (plane(3.0, {"direction": 35.0}, None), COULOMB),
    "direction, square": (plane(3.0, {"direction": -50.0, "waveform": "square"}, None), COULOMB),
    "square across": (plane(4.0, {}, {"waveform": "square", "phase": 30.0}), COULOMB),
    "across, twice as fast": (plane(4.0, {}, {"frequency_ratio": 2, "phase": 20.0}), COULOMB),
    "across, three halves": (plane(4.0, {"waveform": "triangle"}, {"frequency_ratio": "3/2"}), COULOMB),
    "belt vibrates across": (plane(3.0, {}, None, **belt(4.0, direction=90.0)), COULOMB),
    "belt vibrates askew, alone": (
        plane(2.0, None, None, **belt(5.0, direction=40.0, frequency=1.4)),
        COULOMB,
    ),
    "belt in a square, askew, that sticks": (
        plane(3.0, {}, {}, **belt(2.0, direction=60.0, waveform="square")) | {"normal_load": 40.0},
        COULOMB,
    ),
    "load in the plane, static friction": (
        plane(1.0, {}, {"phase": 90.0}, **load(0.5, phase=45.0)) | {"normal_load": 30.0},
        STICKY,
    ),
    "direction, Dahl": (plane(3.0, {"direction": 60.0}, None), DAHL),
    "square across, LuGre": (plane(3.0, {}, {"waveform": "square"}, **belt(2.0, direction=90.0)), LUGRE),
    "constant contact in the plane, elasto-plastic": (
        plane(3.0, {}, {"phase": 70.0}, **load(0.4, contact="constant", phase=20.0)),
        DUPONT,
    ),
}

PRESCRIBED: dict[str, tuple[Keys, Keys]] = {
    "slip in a triangle": (slip(0.3, {"waveform": "triangle", "phase": 10.0}), COULOMB),
    "slip in harmonics": (slip(0.3, {"waveform": BEATS}), COULOMB),
    "slip under a changing load": (slip(0.4, {}, **load(0.5, phase=70.0)), COULOMB),
    "slip in a sawtooth, load in a square": (
        slip(0.2, {"waveform": "sawtooth"}, **load(0.5, waveform="square", frequency_ratio=2)),
        COULOMB,
    ),
    "slip askew": (slip(0.5, {"direction": 30.0, "waveform": "triangle"}), COULOMB),
    "slip in a square, Dahl": (slip(0.3, {"waveform": "square"}), DAHL),
    "slip askew, LuGre": (slip(0.5, {"direction": 70.0}, **load(0.3)), LUGRE),
    "slip under a changing load, constant contact": (
        slip(0.4, {}, **load(0.5, phase=30.0, contact="constant")),
        DUPONT | {"damping": 0.01},
    ),
}

SCENES = ON_THE_LINE | IN_THE_PLANE | PRESCRIBED
