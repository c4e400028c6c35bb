"""Undriven contacts with memory: against stiff steps of scipy, linear stability, and rest that holds."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from maxwell_slip import MaxwellSlip
from profiles import deep
from rate_and_state import RateAndState
from strategies import sizes
from truth import ROWS, law_of

import frictionlab as fl
from frictionlab.methods.shooting import undriven_path
from frictionlab.methods.shooting.method import Shooting
from frictionlab.methods.shooting.undriven_path import UndrivenPath
from frictionlab.theory.sliding_stability import SteadySliding

compiling = deep("more kernels to compile")
CANUDAS = ROWS["undriven canudas"]
CYCLE = CANUDAS.also["period"][0]
"""Of its stick-slip."""
FALLING = fl.LuGre(mu_kinetic=0.3, mu_static=0.5, stribeck_speed=0.2, presliding_length=0.01, damping=0.5)


def block(belt_speed: float, **changes: Any) -> fl.Scene:
    """A lightly damped mass on a belt."""
    return fl.Scene(**({"damping_ratio": 0.02, "normal_load": 2.0, "belt_speed": belt_speed} | changes))


def test_the_slider_of_canudas_de_wit_in_si_units_is_that_without() -> None:
    table = {"mass_kg": 1.0, "stiffness_N_per_m": 2.0, "damping_N_s_per_m": 0.0, "length_m": 1.0}
    scene = fl.Scene(dimensional=table | {"gravity_m_per_s2": 9.81, "belt_speed_m_per_s": 0.1})
    load = 9.81
    law = fl.LuGre(
        mu_kinetic=1.0 / load,
        mu_static=1.5 / load,
        stribeck_speed=1e-3,
        stiffness=1e5 / load,
        damping=math.sqrt(1e5) / load,
        viscosity=0.4 / load,
    )

    found = fl.steady_state(scene, law, tolerance=1e-8)

    # the reference's friction is per 1/2 of the load in the scale of the spring
    assert found.mean_friction * load / 2.0 == pytest.approx(CANUDAS.mean, abs=1e-8)
    assert found.period == pytest.approx(CYCLE, abs=1e-7)


STAGE = fl.LuGre(mu_kinetic=0.3, mu_static=0.4, stribeck_speed=0.01, presliding_length=1e-3, damping=1.0)
ROCK = RateAndState(mu=0.6, a=0.005, b=0.01, slip_length=1e-3, reference_speed=1e-9)


@deep("seconds of maps a decade")
def test_means_of_slow_belts_are_smooth_over_nine_decades() -> None:
    """A slider whose friction falls by a logarithm: neither its mean nor its period knows how slow the belt is."""
    states = [
        fl.steady_state(fl.Scene(damping_ratio=0.0, normal_load=1, belt_speed=10.0**power), ROCK)
        for power in np.arange(-8.5, 0.6, 0.5)
    ]
    means, periods = (
        np.array([getattr(each, name) for each in states]) for name in ("mean_friction", "period")
    )

    assert [each.status for each in states] == ["ok"] * len(states)
    assert np.abs(np.diff(means, n=3)).max() < 1e-3
    assert (np.diff(np.log(periods), n=2) > -0.01).all()


def test_the_orbit_of_a_cycle_closes_and_feeds_the_columns() -> None:
    scene, law = fl.Scene(**CANUDAS.scene), law_of(CANUDAS.law)

    found = fl.steady_state(scene, law, tolerance=1e-8)
    orbit = found.orbit(400)

    assert found.velocity_amplitude == pytest.approx(0.5 * np.ptp(orbit.v1), rel=1e-2)
    assert found.energy_input == 0.0
    assert abs(found.energy_viscous + found.energy_friction) <= 1e-6
    assert float(orbit.x1.max()) == pytest.approx(0.7539939167767236, rel=1e-3)
    # the mean balance: the spring carries what friction does
    assert float(orbit.x1.mean()) == pytest.approx(found.mean_friction, rel=1e-2)
    assert "undriven stick-slip" in found.model


def test_where_sliding_and_a_cycle_both_attract_the_start_decides() -> None:
    law = fl.LuGre(mu_kinetic=0.3, mu_static=0.5, stribeck_speed=0.1, presliding_length=0.01, damping=0.5)
    sliding = {"x": 2.0 * law.sliding_friction(0.35), "velocity": 0.0}

    from_rest = fl.steady_state(block(0.35), law)
    from_sliding = fl.steady_state(block(0.35, initial=sliding), law)

    assert "stick-slip" in from_rest.model
    assert "undriven sliding" in from_sliding.model
    assert from_sliding.mean_friction == law.sliding_friction(0.35)
    assert math.isnan(from_sliding.period)
    assert from_rest.mean_friction != pytest.approx(from_sliding.mean_friction, abs=1e-4)


@settings(max_examples=8)
@given(speed=sizes(0.05, 1.0), damping=sizes(0.005, 0.3), bristle=sizes(0.1, 5.0), length=sizes(0.003, 0.1))
def test_a_mass_set_off_beside_steady_sliding_stays_there_where_that_is_stable(
    speed: float, damping: float, bristle: float, length: float
) -> None:
    law = fl.LuGre(
        mu_kinetic=0.3, mu_static=0.5, stribeck_speed=0.2, presliding_length=length, damping=bristle
    )
    g, stiffness = law.sliding_friction(speed), 0.3 / length
    slope = (law.sliding_friction(speed + 1e-6) - law.sliding_friction(speed - 1e-6)) / 2e-6
    contact = SteadySliding(slope=2.0 * slope, lag=g / (stiffness * speed), lead=bristle / stiffness)
    scene = block(speed, damping_ratio=damping, initial={"x": 2.0 * g, "velocity": 1e-6})

    growth = UndrivenPath(scene, law).growth

    if abs(growth) > 1e-4:  # else neither is sure
        assert contact.stable(damping=2.0 * damping, stiffness=1.0) == (growth < 0.0)


@compiling
@pytest.mark.parametrize("softness", [0.8, 1.25])
def test_ageing_contacts_slide_steadily_on_springs_stiffer_than_the_critical_one(softness: float) -> None:
    # Rice & Ruina (1983): k_c = N (b - a)/D_c (1 + m V^2/(N a D_c))
    a, b, load, speed = 0.03, 0.05, 1.0, 0.01
    length = load * (b - a) * softness
    law = RateAndState(mu=0.4, a=a, b=b, slip_length=length, reference_speed=speed)
    critical = load * (b - a) / length * (1.0 + speed**2 / (load * a * length))
    start = {"x": 1.001 * load * law.sliding_friction(speed), "velocity": 0.0}
    scene = block(speed, damping_ratio=0.0, normal_load=load, initial=start)

    found = fl.steady_state(scene, law, tolerance=1e-6)

    assert found.status == "ok", found.reason
    assert ("undriven sliding" in found.model) == (critical < 1.0)


@pytest.mark.parametrize(
    "law",
    [
        FALLING,
        pytest.param(fl.Dahl(mu=0.4, presliding_length=0.01), marks=compiling),
        pytest.param(fl.Jenkins(mu=0.4, presliding_length=0.01), marks=compiling),
        pytest.param(
            fl.ElastoPlastic(
                mu_kinetic=0.3, mu_static=0.5, stribeck_speed=0.2, presliding_length=0.01, damping=0.5
            ),
            marks=compiling,
        ),
        pytest.param(MaxwellSlip(mu=[0.2, 0.2], stiffness=[20.0, 60.0]), marks=compiling),
    ],
    ids=lambda law: type(law).__name__,
)
@pytest.mark.parametrize("x", [0.02, 3.0])
def test_on_a_belt_at_rest_the_mass_holds_below_the_limit_and_does_not_drift(law: Any, x: float) -> None:
    scene = block(0.0, damping_ratio=0.1, initial={"x": x, "velocity": 0.0})

    found = fl.steady_state(scene, law, tolerance=1e-6)
    orbit = found.orbit(50)

    assert found.status == "ok", found.reason
    assert "undriven rest" in found.model
    assert np.ptp(orbit.x1) <= 4e-6
    assert found.mean_friction == pytest.approx(float(orbit.x1[0]) / 2.0, abs=found.error)
    assert abs(found.mean_friction) <= 0.5
    # a bristle that the spring bends gives way by that much at the start, and no more
    if x == 0.02:
        assert 0.005 < found.mean_friction < 0.01


def test_a_motion_beyond_the_bound_on_work_fails_and_says_how_far_it_came(monkeypatch: Any) -> None:
    monkeypatch.setattr(undriven_path, "MOST_WORK", 3000)

    answers = Shooting().solve([block(0.15)], FALLING, 1e-8)

    assert answers.status == ["failed"]
    assert answers.reason[0].startswith("no steady state within 3,000 steps: after ")
    assert "of the free mass it is at x = " in answers.reason[0]


def test_a_body_that_could_move_across_the_belt_is_answered_as_along_it() -> None:
    across = fl.Transverse(natural_frequency=1.0, damping_ratio=0.1)

    found = fl.steady_state(block(0.15, transverse=across), FALLING)

    assert found.mean_friction == fl.steady_state(block(0.15), FALLING).mean_friction


def test_at_rest_in_an_unstretched_spring_there_is_no_friction_under_any_law() -> None:
    ages = RateAndState(mu=0.4, a=0.03, b=0.05, slip_length=0.01)
    for law in (FALLING, ages):
        answers = Shooting().solve([block(0.0)], law, 1e-8)
        orbit = answers.orbit(0)

        assert answers.status == ["ok"]
        assert answers.mean[0] == 0.0
        assert orbit is not None
        assert orbit.stick.all()
        assert not orbit.v.any()


@deep("seconds of maps")
def test_bristles_on_a_belt_at_rest_do_not_creep_on_the_errors_of_steps() -> None:
    law = fl.LuGre(
        mu_kinetic=0.2556, mu_static=0.2996, stribeck_speed=0.0381, presliding_length=1.504e-4, damping=0.0301
    )
    start = {"x": -0.1588, "velocity": -0.2835}
    scene = block(0.0, damping_ratio=0.0553, initial=start).model_copy(update={"normal_load": 1.3843})

    states = [fl.steady_state(scene, law, tolerance=tolerance) for tolerance in (1e-6, 1e-8)]

    assert [state.status for state in states] == ["ok", "ok"]
    assert abs(states[0].mean_friction - states[1].mean_friction) <= states[0].error + states[1].error
    assert (states[1].stick_fraction, states[1].reversals) == (1.0, 0.0)
