"""Random scenes of every kind that the contract names, as the plain keys of a study, with a law.

Drawn from numpy's generator by the thousands (``Numpy``) or by Hypothesis, which shrinks them (``driven``,
``convergent``, ``creeping``): one description for both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
from hypothesis import strategies as st

Keys = dict[str, Any]
RATIOS = (1, 2, 3, 0.5, "3/2", "2/3")
MOST_NORMAL = 0.9
"""Of the normal load's mean, the most that it changes by."""


NAMED = "sine", "square", "triangle", "sawtooth", "harmonics"
OF_LINES = "duty", "width", "points"
"""Waveforms, and those that came later: seeds of numpy's generator keep what they draw."""


class Source(Protocol):
    """Where numbers come from."""

    waves: Sequence[str]

    def uniform(self, low: float, high: float) -> float: ...

    def among(self, things: Sequence[Any]) -> Any: ...


class Numpy:
    """Numpy's generator."""

    waves: Sequence[str] = NAMED

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng

    def uniform(self, low: float, high: float) -> float:
        return float(self.rng.uniform(low, high))

    def among(self, things: Sequence[Any]) -> Any:
        return things[int(self.rng.integers(len(things)))]


class _Hypothesis:
    waves: Sequence[str] = (*NAMED, *OF_LINES)

    def __init__(self, draw: Any) -> None:
        self.draw = draw

    def uniform(self, low: float, high: float) -> float:
        return float(self.draw(st.floats(low, high)))

    def among(self, things: Sequence[Any]) -> Any:
        return self.draw(st.sampled_from(things))


def log(source: Source, low: float, high: float) -> float:
    """Log-uniform."""
    return math.exp(source.uniform(math.log(low), math.log(high)))


def waveform(source: Source) -> Any:
    """Any; harmonics of up to three orders, the largest of amplitude 1."""
    kind = source.among(source.waves)
    if kind in ("duty", "width"):
        return {"square" if kind == "duty" else "sawtooth": {kind: source.uniform(0.1, 0.9)}}
    if kind == "points":
        shares = sorted({source.among(range(21)) for _ in range(5)} | {3, 11})
        return {"points": [[at / 20, (-1) ** k * source.uniform(0.1, 1.0)] for k, at in enumerate(shares)]}
    if kind != "harmonics":
        return kind
    orders = source.among(((1, 2), (1, 3), (2, 3), (1, 2, 5), (3,)))
    sizes = [1.0] + [source.uniform(0.1, 1.0) for _ in orders[1:]]
    return {
        "harmonics": [
            {"order": order, "amplitude": size, "phase": source.uniform(-180.0, 180.0)}
            for order, size in zip(orders, sizes, strict=True)
        ]
    }


def oscillation(source: Source, ratio: bool) -> Keys:
    """A waveform in any phase, at the frequency of the scene or a ratio of it."""
    keys = {"waveform": waveform(source), "phase": source.uniform(0.0, 360.0)}
    if ratio and source.among((True, False)):
        keys["frequency_ratio"] = source.among(RATIOS)
    return keys


def peak(keys: Keys) -> float:
    """At least the largest absolute value of a waveform."""
    shape = keys["waveform"]
    if isinstance(shape, dict) and "harmonics" in shape:
        return sum(term["amplitude"] for term in shape["harmonics"])
    return 2.0 if isinstance(shape, dict) else 1.0  # without its mean


def body(source: Source, planar: bool, mu: float) -> Keys:
    """A mass that is driven, on a vibrating belt, under a changing load: at least one of them; belt speed not 0."""
    push, frequency = log(source, 0.1, 100.0), log(source, 0.3, 4.0)
    damping, natural = log(source, 0.03, 1.5), log(source, 0.4, 4.0)
    shakes = source.among(
        ("drive", "drive", "drive", "drive belt", "drive load", "belt", "load", "drive belt load")
    )
    swing = push * frequency / math.hypot(1.0 - frequency**2, 2.0 * damping * frequency)
    keys: Keys = {"damping_ratio": damping, "normal_load": push * log(source, 0.02, 3.0) / mu}
    if planar:
        keys["transverse"] = {"natural_frequency": natural, "damping_ratio": log(source, 0.05, 1.0)}
    if "drive" in shakes:
        keys["drive"] = {"amplitude": push, "frequency": frequency} | oscillation(source, False)
        if not planar and source.among((True, False, False)):
            keys["drive"]["offset"] = source.uniform(-2.0, 2.0) * push
        if planar and source.among((True, False)):
            keys["drive"]["direction"] = source.uniform(-180.0, 180.0)
        elif planar:
            keys["transverse"]["load"] = {"amplitude": push * log(source, 0.3, 3.0)} | oscillation(
                source, True
            )
    alone = {} if "drive" in shakes else {"frequency": frequency}
    if "belt" in shakes:
        amplitude = swing * log(source, 0.05, 2.0)
        keys["belt_vibration"] = {"velocity_amplitude": amplitude} | oscillation(source, not alone) | alone
        if planar:
            keys["belt_vibration"]["direction"] = source.uniform(-180.0, 180.0)
    if "load" in shakes:
        changing = oscillation(source, not alone)
        changing["amplitude"] = source.uniform(0.05, MOST_NORMAL) / peak(changing)
        keys["normal_load_variation"] = changing | alone
    return keys | {"belt_speed": source.among((-1.0, 1.0, 1.0)) * swing * log(source, 0.02, 1.3)}


def prescribed(source: Source) -> Keys:
    """A slip that is given, along the belt or at an angle, under a constant or a changing load."""
    moved = oscillation(source, False)
    keys: Keys = {
        "slip": {"velocity_amplitude": log(source, 0.1, 10.0), "frequency": log(source, 0.3, 4.0)} | moved
    }
    if source.among((True, False)):
        keys["slip"]["direction"] = source.uniform(-180.0, 180.0)
    if source.among((True, False)):
        changing = oscillation(source, True)
        changing["amplitude"] = source.uniform(0.05, MOST_NORMAL) / peak(changing)
        keys["normal_load_variation"] = changing
    fastest = keys["slip"]["velocity_amplitude"] * peak(moved)
    return keys | {"belt_speed": source.among((-1.0, 1.0, 1.0)) * fastest * log(source, 0.02, 1.3)}


LAWS = "coulomb", "coulomb", "static", "stribeck", "dahl", "lugre", "falling lugre", "dupont"


def law(source: Source, mu: float, speed: float, length: float, kinds: Sequence[str] = ()) -> Keys:
    """Any law that the tests' own integration knows; speed, length: of the motion, which its parameters go with."""
    kind = source.among(tuple(kinds) or LAWS)
    presliding = {"presliding_length": length * log(source, 3e-3, 10.0)}
    falls = {"mu_static": mu * source.uniform(1.0, 1.6), "stribeck_speed": speed * log(source, 0.1, 2.0)}
    damped = presliding | {"damping": source.among((0.0, 0.01, 0.1)) * mu / speed}
    return {
        "coulomb": {"kind": "coulomb", "mu": mu},
        "static": {"kind": "coulomb", "mu": mu, "mu_static": falls["mu_static"]},
        "stribeck": {"kind": "stribeck", "mu_kinetic": mu, "viscosity": 0.1 * mu / speed} | falls,
        "dahl": {"kind": "dahl", "mu": mu} | presliding,
        "lugre": {"kind": "lugre", "mu_kinetic": mu} | damped,
        "falling lugre": {"kind": "lugre", "mu_kinetic": mu, "viscosity": 0.1 * mu / speed} | falls | damped,
        "dupont": {"kind": "elasto-plastic", "mu_kinetic": mu, "breakaway_ratio": source.uniform(0.2, 0.9)}
        | damped,
    }[kind]


def convergent_scene(source: Source) -> tuple[Keys, Keys]:
    """One that theorem T1 holds for: Coulomb friction, positive damping, a belt that moves; a fifth in the plane."""
    mu = log(source, 0.1, 1.0)
    return body(source, source.among((True, False, False, False, False)), mu), {"kind": "coulomb", "mu": mu}


DRIVEN = "line", "line", "plane", "prescribed"


def scene_of_every_kind(
    source: Source, kinds: Sequence[str] = DRIVEN, laws: Sequence[str] = ()
) -> tuple[Keys, Keys]:
    """Any scene that is driven or moved, and any law; bristles under a changing load with either contact."""
    mu, kind = log(source, 0.1, 1.0), source.among(tuple(kinds))
    scene = prescribed(source) if kind == "prescribed" else body(source, kind == "plane", mu)
    speed = abs(scene["belt_speed"])
    part = next(
        scene[name] for name in ("drive", "slip", "belt_vibration", "normal_load_variation") if name in scene
    )
    own = law(source, mu, speed, speed / part["frequency"], laws)
    if "presliding_length" in own and "normal_load_variation" in scene:
        scene["normal_load_variation"]["contact"] = source.among(("per_load", "constant"))
    return scene, own


def undriven(source: Source) -> Keys:
    """A mass that nothing drives, set off at rest on the belt or elsewhere."""
    scene: Keys = {
        "damping_ratio": log(source, 1e-3, 1.0),
        "normal_load": log(source, 0.1, 10.0),
        "belt_speed": source.among((-1.0, 1.0)) * log(source, 1e-2, 3.0),
    }
    if source.among((True, False, False)):
        far = scene["normal_load"]
        scene["initial"] = {
            "x": source.uniform(-2.0, 2.0) * far,
            "velocity": source.uniform(-2.0, 2.0) * scene["belt_speed"],
        }
    return scene


CREEPING = "line", "line", "plane", "prescribed", "undriven"


def creeping_scene(source: Source, kinds: Sequence[str] = CREEPING) -> tuple[Keys, Keys]:
    """Any scene, driven or not, under rate-and-state friction, which creeps where others stick."""
    mu, kind = log(source, 0.1, 1.0), source.among(kinds)
    if kind == "undriven":
        scene = undriven(source)
    else:
        scene = prescribed(source) if kind == "prescribed" else body(source, kind == "plane", mu)
    speed, a = abs(scene["belt_speed"]), mu * log(source, 0.01, 0.1)
    parts = ("drive", "slip", "belt_vibration", "normal_load_variation")
    frequency = next((scene[name]["frequency"] for name in parts if name in scene), 0.0)
    length = speed / frequency if frequency else scene["normal_load"] * a
    return scene, {
        "kind": "rate-and-state",
        "mu": mu,
        "a": a,
        "b": a * source.among((0.0, source.uniform(0.2, 1.0), source.uniform(0.2, 1.5))),
        "slip_length": length * log(source, 0.03, 30.0 if frequency else 3.0),
        "reference_speed": speed * log(source, 0.01, 100.0),
        "state_law": source.among(("ageing", "slip")),
    }


@st.composite
def convergent(draw: Any) -> tuple[Keys, Keys]:
    """``convergent_scene`` for Hypothesis."""
    return convergent_scene(_Hypothesis(draw))


@st.composite
def driven(draw: Any, kind: str, laws: Sequence[str] = ()) -> tuple[Keys, Keys]:
    """``scene_of_every_kind`` for Hypothesis: on the line, in the plane or under a prescribed slip."""
    return scene_of_every_kind(_Hypothesis(draw), (kind,), laws)


@st.composite
def undriven_of_any_law(draw: Any, laws: Sequence[str] = ()) -> tuple[Keys, Keys]:
    """``undriven`` for Hypothesis, and a law whose lengths go with the stretch of the spring."""
    source = _Hypothesis(draw)
    scene, mu = undriven(source), log(source, 0.1, 1.0)
    return scene, law(source, mu, abs(scene["belt_speed"]), mu * scene["normal_load"], laws)


@st.composite
def creeping(draw: Any, kinds: Sequence[str] = CREEPING) -> tuple[Keys, Keys]:
    """``creeping_scene`` for Hypothesis."""
    return creeping_scene(_Hypothesis(draw), kinds)
