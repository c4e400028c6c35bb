"""Units of length, the phase of time and the direction of the belt never change an answer; weak friction has one."""

from __future__ import annotations

import copy
from collections.abc import Iterator

import numpy as np
import pytest
from draws_of_every_kind import Keys, Numpy, law, log, scene_of_every_kind, undriven
from hypothesis import example, given, settings
from hypothesis import strategies as st
from profiles import DEEP

import frictionlab as fl

KINDS = {
    "coulomb": fl.Coulomb,
    "stribeck": fl.Stribeck,
    "dahl": fl.Dahl,
    "lugre": fl.LuGre,
    "elasto-plastic": fl.ElastoPlastic,
}
PARTS = "drive", "slip", "belt_vibration", "normal_load_variation"
POWERS = {
    **dict.fromkeys(("belt_speed", "normal_load", "velocity_amplitude", "x", "velocity", "offset"), 1),
    **dict.fromkeys(("presliding_length", "stribeck_speed"), 1),
    **dict.fromkeys(("viscosity", "damping"), -1),
}
"""Of length, in numbers of scenes and laws."""


def solved(scene: Keys, told: Keys) -> fl.SteadyState:
    numbers = {name: value for name, value in told.items() if name != "kind"}
    return fl.steady_state(fl.Scene(**scene), KINDS[told["kind"]](**numbers))


def shaken(scene: Keys) -> Iterator[Keys]:
    """Yield what changes in time."""
    yield from (scene[name] for name in PARTS if name in scene)
    if "load" in scene.get("transverse", {}):
        yield scene["transverse"]["load"]


def longer(keys: Keys, factor: float) -> Keys:
    """Return a scene or a law with all lengths this many times as long."""
    found: Keys = {}
    for name, value in keys.items():
        power = POWERS.get(name, 0) or (name == "amplitude" and "waveform" in keys)
        inside = isinstance(value, dict) and name not in ("normal_load_variation", "waveform")
        found[name] = longer(value, factor) if inside else value * factor**power if power else value
    return found


def later(scene: Keys, angle: float) -> Keys:
    """Return the scene that begins at another phase of its drive [degrees]."""
    found = copy.deepcopy(scene)
    for part in shaken(found):
        over, _, under = str(part.get("frequency_ratio", 1)).partition("/")
        part["phase"] += angle * float(over) / float(under or 1)
    return found


def turned_round(scene: Keys) -> Keys | None:
    """Return the scene seen from the other side, x1 and x2 with the other sign; None if no phase can say it."""
    found = copy.deepcopy(scene)
    found["belt_speed"] *= -1.0
    if "initial" in found:
        found["initial"] = {name: -value for name, value in found["initial"].items()}
    for part in shaken(found):
        wave, kept = part["waveform"], part is found.get("normal_load_variation")
        if wave == "sawtooth" and not kept and "direction" not in part:
            return None
        if "direction" in part:
            part["direction"] += 180.0
            continue
        if "offset" in part:
            part["offset"] *= -1.0
        if isinstance(wave, dict) and not kept:
            for each in wave["harmonics"]:
                each["phase"] += 180.0
        elif not kept:
            part["phase"] += 180.0
    return found


@given(seed=st.integers(0, 2**32 - 1))
@example(seed=237)
@settings(max_examples=300 if DEEP else 3)
def test_units_phases_and_direction_never_change_an_answer(seed: int) -> None:
    rng = np.random.default_rng(seed)
    source, factor, angle = Numpy(rng), 10.0 ** rng.uniform(-12.0, 12.0), rng.uniform(0.0, 360.0)
    scene, told = scene_of_every_kind(source)
    if rng.random() < 0.2:
        scene, mu = undriven(source), log(source, 0.1, 1.0)
        told = law(source, mu, abs(scene["belt_speed"]), mu * scene["normal_load"])
    moved, sign = later(scene, angle), 1.0
    if rng.random() < 0.5 and (other := turned_round(moved)) is not None:
        moved, sign = other, -1.0
    here, there = solved(scene, told), solved(longer(moved, factor), longer(told, factor))

    if {here.status, there.status} == {
        "ok",
        "not_unique",
    }:  # the phase decides which of several motions a start reaches
        one, other = (here, there) if here.status == "ok" else (there, here)
        low, high = sorted(sign * end for end in (other.mean_low, other.mean_high))
        assert low - one.error <= one.mean_friction <= high + one.error
        return
    assert here.status == there.status
    if here.status == "ok":
        assert abs(here.mean_friction - sign * there.mean_friction) <= here.error + there.error


def test_lengths_in_orbits_and_reasons_are_those_of_the_scene() -> None:
    scene, told = {"damping_ratio": 0.1, "normal_load": 10.0, "belt_speed": 5.0}, {"kind": "dahl", "mu": 0.4}
    scene["drive"] = {"amplitude": 10.0, "frequency": 1.1, "waveform": "sine"}
    told["presliding_length"] = 0.5
    factor = 2.0**-40
    here, there = solved(scene, told), solved(longer(scene, factor), longer(told, factor))

    assert there.velocity_amplitude == pytest.approx(factor * here.velocity_amplitude, rel=1e-6)
    assert there.energy_friction == pytest.approx(factor**2 * here.energy_friction, rel=1e-6)
    told_here, told_there = (float(each.reason.split(" up to ")[1].split()[0]) for each in (here, there))
    assert told_there == pytest.approx(factor * told_here, rel=1e-2)
