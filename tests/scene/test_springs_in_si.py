"""Springs, dashpots, vibrations and the length of a body in SI units, by whichever of their numbers are given."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from strategies import sizes

import frictionlab as fl
from frictionlab.scene.dimensional import Dimensional
from frictionlab.values.notes import WrongValues

BODY: dict[str, Any] = {
    "mass": "0.5 kg",
    "stiffness": "5 kN/m",
    "damping": "5 N s/m",
    "normal_load": "20 N",
    "belt_speed": "2 mm/s",
}


def body(*without: str, **changes: Any) -> Dimensional:
    return Dimensional(**{key: value for key, value in BODY.items() if key not in without}, **changes)


@given(sizes(1e-3, 1e4), sizes(1e-2, 1e5), sizes(1e-4, 10.0), sizes(1e-2, 1e5), sizes(1e-4, 10.0))
def test_a_natural_frequency_and_a_damping_ratio_are_a_spring_and_a_dashpot(
    mass: float, omega: float, ratio: float, across: float, its_ratio: float
) -> None:
    shared = {"mass_kg": mass, "length_m": 1e-3, "belt_speed_m_per_s": 0.1}
    told = Dimensional(
        **shared,
        natural_frequency_rad_per_s=omega,
        damping_ratio=ratio,
        transverse={"natural_frequency_rad_per_s": across, "damping_ratio": its_ratio},
    )
    springs = Dimensional(
        **shared,
        stiffness_N_per_m=mass * omega**2,
        damping_N_s_per_m=2 * ratio * mass * omega,
        transverse={
            "stiffness_N_per_m": mass * across**2,
            "damping_N_s_per_m": 2 * its_ratio * mass * across,
        },
    )

    one, other = (fl.Scene(dimensional=each).mass() for each in (told, springs))
    np.testing.assert_allclose(np.array(one[:8]), np.array(other[:8]), rtol=1e-13)


@given(sizes(1.0, 1e5), sizes(1e-8, 1e-2))
def test_a_displacement_and_an_acceleration_are_the_velocity_times_and_over_the_frequency(
    omega: float, size: float
) -> None:
    told = [{"displacement_amplitude_m": size}, {"velocity_amplitude_m_per_s": size * 2 * omega}]
    told += [{"acceleration_amplitude_m_per_s2": size * (2 * omega) ** 2}]
    drive = {"amplitude_N": 1, "frequency_rad_per_s": omega}
    found = [
        fl.Scene(dimensional=body(length="1 mm", drive=drive, belt_vibration={**each, "frequency_ratio": 2}))
        for each in told
    ]

    speeds = [scene.belt_vibration.velocity_amplitude for scene in found if scene.belt_vibration is not None]
    assert speeds == pytest.approx([speeds[1]] * 3, rel=1e-14)


def test_a_sweep_over_frequency_keeps_the_displacement() -> None:
    scene = fl.Scene(
        dimensional=body(belt_vibration={"displacement_amplitude": "5 um", "frequency": "60 Hz"})
    )
    path = "scene.dimensional.belt_vibration.frequency"
    study = fl.Study.of(scene, fl.Coulomb(mu=0.3), sweep={path: ["60 Hz", "120 Hz"]})

    sizes = [
        case.scene.belt_vibration.velocity_amplitude * case.scene.dimensional.scales.velocity
        for case in study.cases()
        if case.scene.belt_vibration is not None and case.scene.dimensional is not None
    ]
    assert sizes == pytest.approx([5e-6 * 120 * math.pi, 5e-6 * 240 * math.pi])


@pytest.mark.parametrize(
    ("without", "changes", "said"),
    [
        (["stiffness"], {}, "stiffness_N_per_m: required key is missing (or natural_frequency)"),
        ([], {"natural_frequency": "5 Hz"}, "natural_frequency: leave it out where stiffness is given"),
        ([], {"damping_ratio": 1}, "damping_ratio: leave it out where damping is given"),
        (["damping"], {"damping_ratio": -1}, "damping_ratio: must be >= 0, got -1"),
        (
            [],
            {"belt_vibration": {"frequency": "5 Hz"}},
            "belt_vibration.velocity_amplitude_m_per_s: required key is missing (or displacement_amplitude or acc",
        ),
        (
            [],
            {"belt_vibration": {"displacement_amplitude": "5 um", "waveform": "square", "frequency": "5 Hz"}},
            "belt_vibration.displacement_amplitude: of a sine alone: give velocity_amplitude with this waveform",
        ),
    ],
)
def test_one_of_the_numbers_is_asked_for(without: list[str], changes: dict[str, Any], said: str) -> None:
    with pytest.raises(WrongValues) as caught:
        body(*without, **changes)

    assert str(caught.value).startswith(f"Scene.si: {said}")
    assert len(caught.value.mistakes) == 1


@pytest.mark.parametrize(
    ("shaken", "length"),
    [
        ({"drive": {"amplitude": "2 N", "frequency": "1e-9 rad/s"}}, 2 / 5000),
        ({"drive": {"unbalance": "1e-3 kg m", "frequency": "1e9 rad/s"}}, 1e-3 / 0.5),
        ({"drive": {"amplitude": "2 N", "frequency": "100 rad/s"}}, 2 / (5 * 100)),
        ({"damping_ratio": 0, "drive": {"amplitude": "2 N", "frequency": "100 rad/s"}}, 2 / 5000),
        ({"belt_vibration": {"acceleration_amplitude": "3 m/s^2", "frequency": "10 rad/s"}}, 0.03),
        (
            {
                "drive": {"amplitude": "2 N", "frequency": "1e-6 rad/s"},
                "transverse": {"stiffness": "1 N/m", "damping_ratio": 1, "load": {"amplitude": "3 N"}},
            },
            3.0,
        ),
        ({}, 20 / 5000),
    ],
)
def test_a_length_left_out_is_the_largest_amplitude_without_friction(
    shaken: dict[str, Any], length: float
) -> None:
    made = body(*(["damping"] if "damping_ratio" in shaken else []), **shaken)

    assert made.length_m == pytest.approx(length)
    assert "length" not in repr(made)


def test_no_result_in_si_units_depends_on_the_length() -> None:
    drive = {"amplitude": "20 N", "frequency": "20 Hz"}
    found = [
        fl.steady_state(fl.Scene(dimensional=body(drive=drive, **length)), fl.Coulomb(mu=0.3)).si
        for length in ({}, {"length": "7 mm"})
    ]

    assert found[0]["mean_friction_N"] == pytest.approx(found[1]["mean_friction_N"], rel=1e-9)
    assert found[0]["velocity_amplitude_m_per_s"] == pytest.approx(found[1]["velocity_amplitude_m_per_s"])
