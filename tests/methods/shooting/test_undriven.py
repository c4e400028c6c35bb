"""Undriven scenes: limit cycles against closed forms and published numbers, and the states that do not move."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from answered import with_columns
from hypothesis import given
from hypothesis import strategies as st
from profiles import deep, some
from strategies import sizes

from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.stribeck import Stribeck
from frictionlab.methods.march.method import March
from frictionlab.methods.shooting import undriven, undriven_path
from frictionlab.methods.shooting.method import Shooting
from frictionlab.methods.shooting.undriven_path import UndrivenPath
from frictionlab.scene.scene import Initial, Scene, Transverse
from frictionlab.theory.sliding_stability import loses_energy

TURN = 2.0 * math.pi
LEINE = Stribeck(mu_static=1.0, mu_kinetic=0.0, stribeck_speed=1.0 / 3.0, curve="hyperbolic")
CUBIC = Stribeck(mu_static=0.4, mu_kinetic=0.25, stribeck_speed=0.5, curve="cubic")


def solve(law, belt_speed, tolerance=1e-8, **scene):
    """Answers of one undriven scene: its row, its largest deflection, its status."""
    values = {"damping_ratio": 0.0, "normal_load": 1.0, **scene}
    answers = with_columns(Shooting(), Scene(belt_speed=belt_speed, **values), law, tolerance)
    row = {name: float(column[0]) for name, column in answers.columns.items()}
    orbit = answers.orbit(0)
    deflection = float(orbit.x.real.max()) if orbit is not None else math.nan
    return answers.status[0], row, deflection, answers.model[0]


def test_leines_block_has_its_published_period_and_deflection():
    # x'' + x = friction 1/(1 + 3|v|) on a belt of speed 0.2 (Leine, van Campen, de Kraker & van den Steen, 1998);
    # the digits are of an event-driven integration at 1e-13
    status, row, deflection, _ = solve(LEINE, 0.2)

    assert status == "ok"
    assert row["period"] * TURN == pytest.approx(12.001031294830, abs=1e-8)
    assert deflection == pytest.approx(1.133944676441, abs=1e-5)  # the highest node of the orbit's record
    assert row["floquet"] == 0.0


@given(
    mu=sizes(0.05, 2.0), jump=sizes(0.02, 2.0), load=sizes(0.1, 10.0), belt_speed=sizes(0.02, 5.0),
    side=st.sampled_from([-1.0, 1.0]),
)  # fmt: skip
def test_two_level_friction_without_damping_sticks_and_slips_as_in_closed_form(
    mu, jump, load, belt_speed, side
):
    # amplitude sqrt(v_b^2 + D^2) about x = f and period 2 D/v_b + 2 pi - 2 atan(D/v_b), D = (mu_s - mu) N
    law = Coulomb(mu=mu, mu_static=mu * (1.0 + jump))
    status, row, _, _ = solve(law, side * belt_speed, normal_load=load)
    drop = mu * jump * load

    assert status == "ok"
    expected = 2.0 * drop / belt_speed + TURN - 2.0 * math.atan(drop / belt_speed)
    assert row["period"] * TURN == pytest.approx(expected, rel=1e-8)
    assert row["mean_friction"] == pytest.approx(side * mu, rel=1e-8, abs=row["error"])
    assert row["velocity_amplitude"] == pytest.approx(
        0.5 * (belt_speed + math.hypot(belt_speed, drop)), rel=1e-6
    )
    assert row["energy_input"] == 0.0
    assert row["energy_friction"] == pytest.approx(0.0, abs=1e-6 * (drop + belt_speed) ** 2)


@some(1, "seconds of maps")
@pytest.mark.parametrize("below", [0.999, 0.95, 0.92])
def test_just_below_the_critical_belt_speed_a_cycle_of_slip_has_the_published_amplitude(below):
    # Thomsen & Fidlin (2003), to leading order: A = 2 sqrt(v_b1^2 - v_b^2) below v_b1 as here
    critical = 0.5 * math.sqrt(1.0 - 4.0 * 0.01 * 0.5 / (3.0 * 0.15))
    status, row, _, model = solve(CUBIC, below * critical, damping_ratio=0.01)
    amplitude = 2.0 * critical * math.sqrt(1.0 - below**2)

    assert status == "ok"
    assert model == "undriven slip"
    assert row["velocity_amplitude"] == pytest.approx(amplitude, rel=0.3 * (1.0 - below) + 1e-3)
    assert row["stick_fraction"] == 0.0
    assert 0.0 < row["floquet"] < 1.0


def test_above_the_critical_belt_speed_sliding_is_steady():
    critical = 0.5 * math.sqrt(1.0 - 4.0 * 0.01 * 0.5 / (3.0 * 0.15))
    status, row, deflection, model = solve(CUBIC, 1.01 * critical, damping_ratio=0.01)

    assert status == "ok"
    assert "undriven sliding" in model
    assert row["mean_friction"] == pytest.approx(CUBIC.sliding_friction(1.01 * critical), rel=1e-14)
    assert deflection == pytest.approx(row["mean_friction"], rel=1e-12)
    assert math.isnan(row["period"])
    assert row["velocity_amplitude"] == pytest.approx(0.0, abs=1e-12)


@given(damping=sizes(1e-3, 5.0), belt_speed=sizes(1e-3, 10.0), side=st.sampled_from([-1.0, 1.0]))
def test_plain_coulomb_friction_on_a_damped_mass_always_ends_in_steady_sliding(damping, belt_speed, side):
    status, row, _, model = solve(Coulomb(mu=0.4), side * belt_speed, damping_ratio=damping)

    assert status == "ok"
    assert "undriven sliding" in model
    assert row["mean_friction"] == side * 0.4


def test_the_state_is_the_one_reached_from_the_start():
    # Two states attract here: steady sliding, and stick-slip around it.
    law = Stribeck(mu_static=0.8, mu_kinetic=0.2, stribeck_speed=0.1, viscosity=0.01)
    *_, from_rest = solve(law, 0.4, damping_ratio=0.001)
    sliding = Initial(x=law.sliding_friction(0.4), velocity=0.0)
    *_, from_sliding = solve(law, 0.4, damping_ratio=0.001, initial=sliding)

    assert from_rest == "undriven stick-slip"
    assert "undriven sliding" in from_sliding


def test_a_free_oscillation_that_never_dies_has_a_multiplier_of_one():
    status, row, _, model = solve(Coulomb(mu=0.4), 0.5)

    assert status == "ok"
    assert model == "undriven oscillation"
    assert row["mean_friction"] == 0.4
    assert row["floquet"] == 1.0


@deep("seconds of maps")
def test_a_motion_that_creeps_for_thousands_of_periods_is_known_to_end_in_steady_sliding():
    # friction that rises steeply with slip makes the mass creep towards it, by steps of a ten-thousandth
    law = Stribeck(mu_kinetic=1.58, mu_static=3.16, stribeck_speed=1.56, curve="cubic")
    status, row, _, model = solve(law, 7.3, damping_ratio=0.03, normal_load=684.0)

    assert status == "ok"
    assert model == "undriven sliding"
    assert row["mean_friction"] == pytest.approx(law.sliding_friction(7.3), rel=1e-14)


def test_a_motion_beyond_the_bound_on_work_fails_and_says_how_far_it_came(monkeypatch):
    monkeypatch.setattr(undriven_path, "MOST_WORK", 30)
    one = Scene(damping_ratio=0.0, normal_load=1.0, belt_speed=0.2)
    answers = Shooting().solve([one], LEINE, 1e-8)

    assert answers.status == ["failed"]
    assert answers.reason[0].startswith("no steady state within 30 steps: after ")
    assert "of the free mass it is at x = " in answers.reason[0]


@deep("seconds of steps")
def test_a_motion_that_may_grow_across_the_belt_has_no_long_mean(monkeypatch):
    """Friction is taken to feed a motion across at the speed of slip, not at that of the belt."""
    monkeypatch.setattr(undriven, "AVERAGED", (128,))
    monkeypatch.setattr(LuGre, "damps_across", lambda _law, speed: speed < 0.02)
    law = LuGre(mu_kinetic=0.3, presliding_length=2.5e-4, mu_static=0.4, stribeck_speed=2.5e-3)
    across = Transverse(natural_frequency=1.3, damping_ratio=0.05)
    one = Scene(damping_ratio=0.05, normal_load=1.0, belt_speed=0.0125, transverse=across)
    answers = with_columns(Shooting(), [one], law, 1e-6)
    assert (answers.status, answers.reason) == (["failed"], [undriven.ACROSS])


@deep("seconds of steps")
def test_a_chaotic_motion_has_a_mean_over_a_long_time():
    """Elasto-plastic friction that falls with speed: largest deflections of 4.10 to 4.15 in no order."""
    law = ElastoPlastic(
        mu_kinetic=0.2204466741226047,
        presliding_length=0.057009254278563806,
        mu_static=0.3296398650084521,
        stribeck_speed=0.7492177440507438,
        breakaway_ratio=0.7795848154749089,
    )
    one = Scene(damping_ratio=0.205363, normal_load=12.397955087610109, belt_speed=0.2219503420784626)
    found = with_columns(Shooting(), [one], law, 1e-3)
    marched = with_columns(March(stepper="rk4", steps=200), [one], law, 1e-3)
    assert (found.status, found.error_kind) == (["ok"], ["statistical"])
    assert "does not repeat (chaotic): its mean over " in found.reason[0]
    assert found.columns["error"][0] < 2e-3
    assert marched.columns["error"][0] < 1e-2  # steps that last hundreds of periods come as near as that


def test_a_motion_that_hardly_leaves_steady_sliding_stays_there():
    status, row, deflection, _ = solve(Coulomb(mu=0.5), 1.0, initial=Initial(x=0.5, velocity=1e-300))

    assert status == "ok"
    assert row["mean_friction"] == 0.5
    assert deflection == pytest.approx(0.5, abs=1e-15)


@deep("seconds of maps")
@given(load=sizes(0.3, 3.0), belt_speed=sizes(0.02, 2.0), damping=sizes(0.01, 1.0), reach=sizes(0.1, 10.0))
def test_a_motion_said_to_settle_has_settled_when_it_is_followed(load, belt_speed, damping, reach):
    path = UndrivenPath(Scene(damping_ratio=damping, normal_load=load, belt_speed=belt_speed), CUBIC)
    state = path.sliding + np.array([reach, 0.0])
    settles = loses_energy(path.mass, CUBIC, belt_speed, reach)
    energies = []
    for _ in range(int(40.0 / damping) if settles else 0):
        state = path.follow(state, 0.5, 1e-10).end
        energies.append(path.from_sliding(state))

    assert all(later <= before + 1e-9 for before, later in pairwise(energies))
