"""A prescribed slip in SI units: no mass, no spring, one conversion."""

from __future__ import annotations

import math
from typing import Any

import pytest

import frictionlab as fl
from frictionlab.study.load import parse_study
from frictionlab.values.notes import WrongValues

SLIP = {"displacement_amplitude": "5 um", "frequency": "60 Hz"}
AMPLITUDE = 5e-6 * 2 * math.pi * 60
LAWS = [
    fl.Coulomb(mu=0.3),
    fl.Dahl(mu=0.3, presliding_length=1e-6),
    fl.LuGre(mu_kinetic=0.3, stiffness=3e5, damping=2),
]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
@pytest.mark.parametrize(
    "across", [{}, {"transverse_slip": {"velocity_amplitude": "1 mm/s", "phase": "90 deg"}}]
)
def test_it_has_the_friction_of_the_same_slip_in_metres_and_seconds(law: Any, across: Any) -> None:
    """A nondimensional slip may be given in any consistent units."""
    told = fl.Scene(dimensional={"belt_speed": "1 mm/s", "normal_load": "20 N", "slip": SLIP, **across})
    aside = {"transverse_slip": {"velocity_amplitude": 1e-3, "phase": 90}} if across else {}
    slip = {"velocity_amplitude": AMPLITUDE, "frequency": 120 * math.pi}
    plain = fl.Scene(belt_speed=1e-3, slip=slip, **aside)

    found, wanted = fl.steady_state(told, law), fl.steady_state(plain, law)
    assert found.mean_friction == pytest.approx(wanted.mean_friction, abs=2e-8)
    assert found.si["mean_friction_N"] == pytest.approx(20 * found.mean_friction)
    length = 5e-6
    if across:
        assert told.dimensional is not None
        assert told.dimensional.length_m is not None
        length = told.dimensional.length_m
    assert told.slip is not None
    assert told.slip.velocity_amplitude == pytest.approx(5e-6 / length)


def test_a_sweep_over_frequency_at_constant_acceleration_needs_nothing_linked() -> None:
    scene = {"belt_speed": "1 mm/s", "slip": {"acceleration_amplitude": "1 m/s^2"}}
    study = parse_study(
        {
            "schema": 1,
            "scene": {"dimensional": scene},
            "laws": [{"kind": "jenkins", "mu": 0.3, "contact_stiffness": "1 N/um"}],
            "sweep": {"scene.dimensional.slip.frequency": ["100 rad/s", "200 rad/s"]},
        }
    )
    run = fl.run(study)

    assert [*run.table["scene.slip.velocity_amplitude"] * [0.0001 * 100, 0.0001 * 200]] == pytest.approx(
        [0.01, 0.005]
    )
    assert [*run.table["scene.dimensional.normal_load_N"]] == [1, 1]
    assert [*run.table["status"]] == ["ok", "ok"]


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"mass": "1 kg"}, "mass: leave it out with a prescribed slip"),
        (
            {"transverse_slip": {"velocity_amplitude": "1 mm/s", "frequency": "1 Hz"}},
            "transverse_slip.frequency: leave it out, slip.frequency_rad_per_s holds for both",
        ),
        ({"slip": {**SLIP, "waveform": "square"}}, "slip.displacement_amplitude: of a sine alone"),
    ],
)
def test_a_body_does_not_go_with_it(changes: Any, said: str) -> None:
    with pytest.raises(WrongValues) as caught:
        fl.Scene.si(**{"belt_speed": "1 mm/s", "slip": SLIP} | changes)

    assert str(caught.value).startswith(f"Scene.si: {said}")
