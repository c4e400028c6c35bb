"""Bristles by axis: beside LSODA on the equations of motion, which does not know of them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from answered import with_columns

import frictionlab as fl
from frictionlab.bench.peers.equations import OnBristles, one_period
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.shooting.method import Shooting

BY_AXIS = fl.Dahl(mu=0.4, presliding_length=0.3, planar="per-axis")


def scene(belt_speed: float, across: float = 8.0) -> fl.Scene:
    return fl.Scene(
        damping_ratio=0.1,
        normal_load=4.0,
        belt_speed=belt_speed,
        drive=fl.Drive(amplitude=10.0, frequency=1.3, phase=30.0),
        transverse=fl.Transverse(
            natural_frequency=2.1, damping_ratio=0.05, load=fl.Load(amplitude=across, phase=100.0)
        ),
    )


def solved(scene: fl.Scene, law: BristleLaw, tolerance: float = 1e-8) -> tuple[dict[str, float], fl.Orbit]:
    answers = with_columns(Shooting(), [scene], law, tolerance)
    orbit = answers.orbit(0)
    assert answers.status == ["ok"]
    assert orbit is not None
    return {name: float(values[0]) for name, values in answers.columns.items()}, orbit


def followed(scene: fl.Scene, law: BristleLaw, state: list[float]) -> np.ndarray:
    """The state after a period, and the integral of friction."""
    return one_period(OnBristles(scene, law, 1_000_000), np.array([*state, 0.0]), "odeint", 1e-12)


def start_of(orbit: fl.Orbit, deflection: complex) -> list[float]:
    x, v = complex(orbit.x[0, 0]), complex(orbit.v[0, 0])
    return [x.real, v.real, x.imag, v.imag, deflection.real, deflection.imag]


@pytest.mark.parametrize("belt_speed", [0.7, 4.0])
def test_bristles_by_axis_repeat_in_the_coupled_equations_of_motion(belt_speed: float) -> None:
    here = scene(belt_speed)
    row, orbit = solved(here, BY_AXIS)
    state = start_of(orbit, complex(orbit.friction[0, 0]) / BY_AXIS.bristle_stiffness)
    end = followed(here, BY_AXIS, state)
    assert end[:-1] == pytest.approx(state, abs=1e-6)
    mean = -end[-1] * here.mass().frequency / (2.0 * math.pi)
    assert abs(mean - row["mean_friction"]) <= row["error"] + 1e-9


def test_a_mass_held_elastically_across_the_belt_has_a_mean_along_it() -> None:
    law = fl.Jenkins(mu=0.4, presliding_length=2.0, planar="per-axis")
    here = scene(2.0, across=0.5)
    answers = with_columns(Shooting(), [here], law, 1e-8)
    assert answers.status == ["ok"]
    assert "elastic under this load: the mean there depends on the start" in answers.reason[0]
    assert math.isnan(answers.columns["mean_friction_transverse"][0])
    mass = here.mass()
    spring = mass.transverse_stiffness + mass.normal_load * law.bristle_stiffness
    dynamic = complex(spring - mass.frequency**2, mass.frequency * mass.transverse_damping)
    moved = mass.frequency * abs(mass.transverse_force / dynamic)
    assert answers.columns["transverse_velocity_amplitude"][0] == pytest.approx(moved, rel=1e-6)
    assert answers.columns["floquet"][0] == pytest.approx(1.0, abs=1e-6)
    alone = with_columns(Shooting(), [here.model_copy(update={"transverse": None})], law, 1e-8)
    assert answers.columns["mean_friction"][0] == alone.columns["mean_friction"][0]


def test_corners_that_the_planar_map_does_not_locate_do_not_stop_an_answer() -> None:
    """Yield by axis that took the planar map minutes, and no answer."""
    across = fl.Transverse(
        natural_frequency=2.0667, damping_ratio=0.0239, load=fl.Load(amplitude=8.9327, phase=133.32)
    )
    here = fl.Scene(
        damping_ratio=0.06465,
        normal_load=0.76581,
        belt_speed=4.10308,
        drive=fl.Drive(amplitude=14.30244, frequency=1.24511, phase=199.6852),
        transverse=across,
    )
    law = fl.Jenkins(mu=0.66428, presliding_length=0.08527, planar="per-axis")
    row, _ = solved(here, law, 1e-6)
    assert row["error"] <= 1e-6
    assert abs(row["mean_friction"] - 0.056673515) <= 2.1e-6 + row["error"]  # march, 2.0e-6
