"""Ends and shapes of curves whose loads, belt or normal load change in time in another way than as one sine."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pandas as pd
import pytest

import frictionlab as fl
from frictionlab.charts.curves import family_of
from frictionlab.runner.curve_loads import repeats_mirrored, scene_of, varies
from frictionlab.runner.curve_table import curve_table
from frictionlab.scene.scene import Scene
from frictionlab.theory import friction_free_velocity

LAW = fl.Coulomb(mu=0.4)
SPEEDS = np.linspace(0.0, 1.4, 50)[1:]


def slip(waveform: Any = "sine", **keys: Any) -> Scene:
    own = {"velocity_amplitude": 1.0, "frequency": 1.0, "waveform": waveform}
    return Scene(belt_speed=1.0, slip={**own, **keys.pop("slip", {})}, **keys)


def mass(**keys: Any) -> Scene:
    return Scene(**{"damping_ratio": 0.1, "normal_load": 4.0, "belt_speed": 1.0, **keys})


def row(one: Scene, law: Any = LAW, speeds: Any = SPEEDS) -> pd.Series:
    return curve_table(fl.curve(one, law, speeds)).iloc[0]


@pytest.mark.parametrize("waveform", ["triangle", "sawtooth"])
def test_curves_of_prescribed_waveforms_have_the_area_of_their_closed_form(waveform: str) -> None:
    found = row(slip(waveform))

    assert found["reversal_end"] == pytest.approx(1.0, rel=1e-13)
    assert abs(found["shape_area"]) <= found["shape_area_error"]
    assert found["shape"] == "undecided"


def test_a_curve_that_a_pulsating_load_lifts_starts_where_its_closed_form_says() -> None:
    found = row(slip(normal_load_variation={"amplitude": 0.3, "phase": 180.0}))
    # m = (2/pi) [asin u + .3 sqrt(1 - u^2)], against the chord from .6/pi to 1
    start = 0.6 / math.pi
    area = 2 * ((2 / math.pi) * (math.pi / 2 - 1 + 0.3 * math.pi / 4) - start) / (1 - start) - 1

    assert found["reversal_end"] == pytest.approx(1.0, rel=1e-13)
    assert abs(found["shape_area"] - area) <= found["shape_area_error"]


@pytest.mark.parametrize(
    "keys",
    [
        {"drive": {"unbalance": 10.0, "frequency": 1.0, "waveform": "square"}},
        {"belt_vibration": {"velocity_amplitude": 40.0, "frequency": 1.5}},
        {
            "drive": {"unbalance": 10.0, "frequency": 1.0},
            "normal_load_variation": {"amplitude": 0.3, "frequency_ratio": 2},
        },
    ],
    ids=["square", "belt", "normal load"],
)
def test_the_end_of_reversal_of_a_mass_is_v_lin(keys: Any) -> None:
    one = mass(**keys)
    end = friction_free_velocity(one, LAW)
    table = fl.curve(one, LAW, end * np.linspace(0.02, 1.2, 50))
    found = curve_table(table).iloc[0]

    assert found["reversal_end"] == pytest.approx(end, rel=1e-12)
    assert found["shape"] in ("concave", "convex", "mixed", "undecided")
    beyond = table[table["scene.belt_speed"] > end]
    assert beyond["mean_friction"].to_numpy() == pytest.approx(0.4, abs=1e-12)
    assert (beyond["velocity_ratio"] > 1.0).all()
    below = table[table["scene.belt_speed"] < 0.999 * end]
    assert ((below["mean_friction"] < 0.4) & (below["reversals"] > 0)).all()
    family = family_of(table)
    assert family is not None
    assert list(family.curves[0].kinks) == pytest.approx([end], rel=1e-12)


def test_a_square_slip_has_an_end_of_reversal_and_no_shape() -> None:
    found = row(slip("square"))

    assert found["reversal_end"] == pytest.approx(1.0, rel=1e-13)
    assert np.isnan(found["shape_area"])
    assert "jumps" in found["reason"]


def test_what_is_not_known_of_a_curve_is_empty_with_the_reason() -> None:
    lopsided = mass(drive={"unbalance": 10.0, "frequency": 1.0, "waveform": "sawtooth"})
    held = mass(drive={"amplitude": 0.2, "frequency": 1.0, "waveform": "square"})
    falling = fl.Stribeck(mu_kinetic=0.4, mu_static=0.5, stribeck_speed=0.1)
    for one, law, reason in ((lopsided, LAW, "mirrored"), (held, falling, "sticks")):
        found = row(one, law, speeds=friction_free_velocity(one) * np.linspace(0.05, 3.0, 30))
        assert reason in found["reason"]
        assert np.isnan(found["shape_area"])
        assert law is falling or found["reversal_end"] == pytest.approx(
            friction_free_velocity(one), rel=1e-12
        )


def test_a_belt_that_shakes_the_body_gives_the_curve_of_the_equal_load() -> None:
    omega, shaken = 1.5, cmath.rect(0.7, 0.3)
    force = (
        (1 - omega**2 + 0.2j * omega) * shaken * 1j / omega
    )  # spring, dashpot and inertia at the belt's motion
    size, turn = abs(force), math.degrees(cmath.phase(force))
    load = mass(normal_load=3.0, drive={"amplitude": size, "frequency": omega, "phase": turn})
    belt = mass(
        normal_load=3.0,
        belt_vibration={"velocity_amplitude": 0.7, "frequency": omega, "phase": math.degrees(0.3)},
    )
    speeds = friction_free_velocity(load) * np.geomspace(0.01, 1.2, 40)
    one, other = row(load, speeds=speeds), row(belt, speeds=speeds)

    assert one["shape_start"] == pytest.approx(0.4 - size / 3.0, abs=1e-12)
    for name in ("reversal_end", "shape_start", "shape_area", "shape_half"):
        room = one[f"{name}_error"] + other[f"{name}_error"] + 1e-8
        assert one[name] == pytest.approx(other[name], abs=room), name
    assert one["shape"] == other["shape"]


def test_a_body_held_at_rest_starts_at_the_largest_friction_without_slip() -> None:
    """Slow belts leave less and less beside it, where the load is long at its peak as much as they are slow."""
    one = mass(
        normal_load=3.0, drive={"amplitude": 0.5, "frequency": 0.6, "waveform": {"square": {"duty": 0.3}}}
    )
    found = row(one, speeds=friction_free_velocity(one) * np.geomspace(1e-4, 1.2, 40))
    slow = fl.curve(one, LAW, [1e-5, 1e-4])["mean_friction"] - found["shape_start"]

    assert (slow > 0.0).all()
    assert slow[1] < 1e-4
    assert slow[0] == pytest.approx(0.1 * slow[1], rel=0.02)


def test_what_repeats_mirrored() -> None:
    def shaken(waveform: Any, **keys: Any) -> Scene:
        return mass(drive={"amplitude": 3.0, "frequency": 1.3, "waveform": waveform, "phase": 33.0}, **keys)

    odd = {"harmonics": [{"order": 1, "amplitude": 1.0}, {"order": 3, "amplitude": 0.4, "phase": 10.0}]}
    even = {"harmonics": [{"order": 1, "amplitude": 1.0}, {"order": 2, "amplitude": 0.4}]}
    pulsating = {"amplitude": 0.3, "phase": 10.0}
    assert all(repeats_mirrored(shaken(each)) for each in ("square", "triangle", odd))
    assert not any(repeats_mirrored(shaken(each)) for each in ("sawtooth", even))
    assert not repeats_mirrored(shaken("square", normal_load_variation=pulsating))
    assert repeats_mirrored(shaken("square", normal_load_variation={**pulsating, "frequency_ratio": 2}))
    halved = {"velocity_amplitude": 1.0, "frequency_ratio": 0.5}
    assert not repeats_mirrored(shaken("sine", belt_vibration=halved))


def test_the_scene_of_a_row_is_read_back() -> None:
    one = mass(
        drive={"amplitude": 3.0, "frequency": 1.3, "waveform": "square"},
        belt_vibration={"velocity_amplitude": 1.0, "frequency_ratio": "3/2"},
    ).at(0.0)
    given = {f"scene.{name}": value for name, value in one.values().items()}

    assert varies(given)
    assert scene_of(given) == one
    terms = [{"order": 1, "amplitude": 1.0, "phase": 0.1 + 0.2}, {"order": 3, "amplitude": -1 / 3}]
    other = one.with_(**{"drive.waveform": {"harmonics": terms}})
    assert scene_of({f"scene.{name}": value for name, value in other.values().items()}) == other
    plain = mass(drive={"amplitude": 3.0, "frequency": 1.3})
    assert not varies({f"scene.{name}": value for name, value in plain.values().items()})
