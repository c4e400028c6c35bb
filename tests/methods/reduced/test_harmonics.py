"""Harmonic balance in H harmonics: against Eqs. 8 and 9, its own equations, the exact means, and its orders."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import frictionlab as fl
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.stribeck import Stribeck
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.reduced.coulomb_harmonics import Balancing, balanced
from frictionlab.methods.reduced.harmonic_balance import HarmonicBalance
from frictionlab.methods.reduced.sliding_harmonics import balanced_sliding, sliding_balance
from frictionlab.methods.shooting.method import Shooting
from frictionlab.mistakes.notes import WrongValues
from frictionlab.orbit.harmonics import harmonic_parts
from frictionlab.orbit.panels import WEIGHTS
from frictionlab.orbit.read import read_columns
from frictionlab.scene.scene import Drive, Load, Scene, Transverse
from frictionlab.theory import friction_free_velocity

LAW = Coulomb(mu=0.4)
KNOWN = 0.0980719340744308784958
"""Proved mean of FIG_4B (docs/proofs.md)."""


def scene(belt_speed, frequency=1.0, normal_load=10.0, damping=0.1, phase=0.0, **drive):
    """Paper, Fig. 4, but for the changes."""
    load = {"unbalance": 10.0} | drive if "amplitude" not in drive else drive
    return Scene(
        damping_ratio=damping,
        normal_load=normal_load,
        belt_speed=belt_speed,
        drive=Drive(frequency=frequency, phase=phase, **load),
    )


FIG_4B = scene(10.0)
STICKS = scene(0.5, frequency=0.5, amplitude=2.5)


def mean(one, harmonics, tail=None):
    """Of one scene, without its error."""
    return float(HarmonicBalance(harmonics=harmonics, tail=tail).model_means([one], LAW)[0])


# --- what it balances -----------------------------------------------------------------------------------------------


def test_one_harmonic_without_a_tail_is_that_of_eqs_8_and_9() -> None:
    speeds = np.linspace(0.0, 60.0, 25)
    scenes = [scene(speed) for speed in speeds.tolist()]

    explicit = HarmonicBalance().model_means(scenes, LAW)
    searched = balanced(Balancing(scenes[0], LAW.mu, 1, False), LAW, speeds)

    np.testing.assert_allclose(LAW.mu * searched.mean, explicit, atol=1e-14)


@pytest.mark.parametrize("tail", [False, True])
@pytest.mark.parametrize("belt_speed", [10.0, -31.0])
def test_every_harmonic_obeys_its_own_equation(belt_speed, tail) -> None:
    one = scene(belt_speed, phase=40.0)
    mass, method = one.mass(), HarmonicBalance(harmonics=7, tail=tail)
    orbit = method.solve([one], LAW, 1e-3).orbit(0)
    found = harmonic_parts(one, orbit, 9)
    frequency = found.harmonic[1:] * mass.frequency

    velocity = found.velocity_amplitude * np.exp(1j * np.radians(np.nan_to_num(found.velocity_phase)))
    friction = found.friction_amplitude * np.exp(1j * np.radians(np.nan_to_num(found.friction_phase)))
    spring = np.where(frequency > 7.5 * mass.frequency, 0.0, 1.0)
    impedance = spring * (mass.damping - 1j / frequency) + 1j * frequency
    load = np.where(frequency == mass.frequency, abs(mass.force), 0.0)
    missing = impedance * velocity[1:] + mass.normal_load * friction[1:] - load

    assert np.abs(missing[:7]).max() < 1e-9
    assert (np.abs(velocity[8:]).max() < 1e-9) == (not tail)
    assert not tail or np.abs(missing[7:]).max() < 1e-9  # beyond them a free mass


def test_a_mass_at_rest_on_the_belt_obeys_them_too() -> None:
    one = STICKS
    mass, method = one.mass(), HarmonicBalance(harmonics=6)
    orbit = method.solve([one], LAW, 1e-3).orbit(0)
    found = harmonic_parts(one, orbit, 6)
    frequency = found.harmonic[1:] * mass.frequency

    velocity = found.velocity_amplitude * np.exp(1j * np.radians(np.nan_to_num(found.velocity_phase)))
    friction = found.friction_amplitude * np.exp(1j * np.radians(np.nan_to_num(found.friction_phase)))
    impedance = mass.damping + 1j * (frequency - 1.0 / frequency)
    load = np.where(frequency == mass.frequency, abs(mass.force), 0.0)

    assert orbit.stick.any()
    np.testing.assert_allclose(orbit.v[orbit.stick].real, one.belt_speed, atol=1e-9)
    assert np.abs(orbit.friction).max() <= LAW.mu * (1.0 + 1e-6)
    assert np.abs(impedance * velocity[1:] + mass.normal_load * friction[1:] - load).max() < 1e-8


@pytest.mark.parametrize("tail", [False, True])
def test_means_are_odd_in_the_belt_speed_and_even_harmonics_vanish_at_rest(tail) -> None:
    method = HarmonicBalance(harmonics=6, tail=tail)
    scenes = [scene(speed, phase=10.0) for speed in (-20.0, 0.0, 20.0)]

    answers = method.solve(scenes, LAW, 1e-3)
    parts = harmonic_parts(scenes[1], answers.orbit(1), 6)

    np.testing.assert_allclose(answers.mean, [-answers.mean[2], 0.0, answers.mean[2]], atol=1e-14)
    assert max(parts.velocity_amplitude[2::2]) < 1e-11 < parts.velocity_amplitude[3]
    assert max(parts.friction_amplitude[2::2]) < 1e-11


@pytest.mark.parametrize("one", [FIG_4B, scene(-10.0, phase=70.0), STICKS])
def test_the_spring_bears_the_mean_friction_and_energy_balances_in_the_harmonics_kept(one) -> None:
    answers = HarmonicBalance(harmonics=9).solve([one], LAW, 1e-3)
    columns, orbit = read_columns([one], answers.orbit), answers.orbit(0)
    half = 0.5 * np.ptp(orbit.tau, axis=1)[:, None] * WEIGHTS
    position = (half * orbit.x.real).sum() / half.sum()

    assert position == pytest.approx(one.normal_load * answers.mean[0], abs=1e-10)
    assert columns["velocity_harmonic"][0] > 0.0
    parts = harmonic_parts(one, orbit, 9)
    by_friction = np.nansum(parts.velocity_amplitude * parts.friction_in_phase)
    power = (
        abs(one.mass().force) * parts.velocity_amplitude[1] * math.cos(math.radians(parts.velocity_phase[1]))
    )
    damped = one.mass().damping * (parts.velocity_amplitude[1:] ** 2).sum()
    assert power == pytest.approx(damped + one.normal_load * by_friction, rel=1e-9)


# --- how close it comes ---------------------------------------------------------------------------------------------


def test_without_the_tail_the_mean_is_of_first_order() -> None:
    errors = [abs(mean(FIG_4B, harmonics, tail=False) - KNOWN) for harmonics in (16, 32, 64)]

    assert errors == pytest.approx([2.1e-5, 1.1e-5, 5.5e-6], rel=0.05)


@pytest.mark.parametrize("one", [FIG_4B, STICKS], ids=["slip", "stick"])
def test_with_the_tail_it_is_of_third_order(one) -> None:
    known = float(Exact().solve([one], LAW, 1e-10).mean[0].real)
    orders = np.array([8, 16, 32, 64, 128])

    errors = np.array([abs(mean(one, harmonics) - known) for harmonics in orders.tolist()])

    assert -3.6 < np.polyfit(np.log(orders), np.log(errors), 1)[0] < -2.4
    assert (errors * orders**3.0).max() < 0.2


@given(
    frequency=st.floats(-0.5, 0.7).map(lambda e: 10.0**e),
    damping=st.floats(-2.0, 0.5).map(lambda e: 10.0**e),
    ratio=st.floats(-2.0, 0.6).map(lambda e: 10.0**e),
    share=st.floats(-1.1, 1.1),
    harmonics=st.integers(2, 40),
    tail=st.booleans(),
)
def test_errors_cover(frequency, damping, ratio, share, harmonics, tail) -> None:
    still = scene(0.0, frequency, ratio / LAW.mu, damping, amplitude=1.0)
    one = still.model_copy(update={"belt_speed": share * friction_free_velocity(still)})
    found = HarmonicBalance(harmonics=harmonics, tail=tail).solve([one], LAW, 1e-8)
    assume(found.status[0] == "ok")
    exact = Exact().solve([one], LAW, 1e-10)

    assert abs(found.mean[0] - exact.mean[0]) <= found.error[0] + exact.error[0]


# --- in the plane, on samples ---------------------------------------------------------------------------------------


def planar(belt_speed, natural=0.5, **transverse):
    """Paper, Fig. 9, but for the changes."""
    across = Transverse(natural_frequency=natural, damping_ratio=0.1, load=Load(unbalance=10.0, **transverse))
    return FIG_4B.model_copy(update={"belt_speed": belt_speed, "transverse": across})


STRIBECK = Stribeck(mu_kinetic=0.3, mu_static=0.4, stribeck_speed=30.0)


@pytest.mark.parametrize("law", [LAW, STRIBECK], ids=["coulomb", "stribeck"])
def test_in_the_plane_every_harmonic_obeys_its_own_equation(law) -> None:
    one = planar(-8.0, phase=70.0)
    mass = one.mass()
    found = HarmonicBalance(harmonics=6).solve([one], law, 1.0)
    rate = mass.frequency * np.arange(1.0, 7.0)
    sides = (
        (False, mass.damping, mass.stiffness, mass.force),
        (True, mass.transverse_damping, mass.transverse_stiffness, mass.transverse_force),
    )

    for across, damping, stiffness, force in sides:
        parts = harmonic_parts(one, found.orbit(0), 6, across=across)
        velocity, friction = (
            size[1:] * np.exp(1j * np.radians(phase[1:]))
            for size, phase in (
                (parts.velocity_amplitude, parts.velocity_phase),
                (parts.friction_amplitude, parts.friction_phase),
            )
        )
        load = np.where(rate == mass.frequency, force, 0.0)
        missing = (damping + 1j * (rate - stiffness / rate)) * velocity + mass.normal_load * friction - load
        assert np.abs(missing).max() < 1e-3  # samples: 16 a wave of the highest
        mean = found.mean[0].imag if across else found.mean[0].real
        assert parts.friction_amplitude[0] == pytest.approx(-mean, abs=1e-4)


def test_in_the_plane_smooth_friction_converges_exponentially_and_errors_tell_how_far() -> None:
    one = planar(10.0)
    found = [HarmonicBalance(harmonics=count).solve([one], LAW, 1e-8) for count in (2, 8, 32)]
    means = [float(each.mean[0].real) for each in found]
    exact = Shooting().solve([one], LAW, 1e-9)
    far = [abs(value - float(exact.mean[0].real)) for value in means]

    assert far[0] > 50.0 * far[1] > 1e5 * far[2]
    assert far[2] < 1e-9
    assert all(distance <= each.error[0] + exact.error[0] for distance, each in zip(far, found, strict=True))
    odd = HarmonicBalance(harmonics=8).model_means([planar(-10.0), planar(0.0)], LAW)
    assert odd[0].real == pytest.approx(-means[1], abs=1e-11)
    assert odd[1] == 0.0


# --- along the belt, friction that varies with the slip speed -------------------------------------------------------


@pytest.mark.parametrize("belt_speed", [10.0, -40.0])
def test_friction_on_legs_balances_coulomb_friction_as_its_switches_do(belt_speed) -> None:
    one = scene(belt_speed, phase=70.0)
    for harmonics in (1, 4, 16):
        what = sliding_balance(one.mass(), LAW, harmonics)
        motion = balanced_sliding(what, belt_speed, what.friction_free())
        expected = HarmonicBalance(harmonics=harmonics, tail=False if harmonics > 1 else None)
        assert -motion.friction.mean == pytest.approx(expected.model_means([one], LAW)[0], abs=1e-11)


def test_friction_that_varies_with_speed_converges_on_the_full_mean_and_errors_tell_how_far() -> None:
    scenes = [scene(speed) for speed in (10.0, 40.0, 70.0)]
    full = Shooting().solve(scenes, STRIBECK, 1e-9)

    first = sliding_balance(scenes[0].mass(), STRIBECK, 1)
    alone = [balanced_sliding(first, one.belt_speed, first.friction_free()) for one in scenes]
    far = [np.abs([-each.friction.mean for each in alone] - full.mean.real)]
    for harmonics in (4, 16):
        found = HarmonicBalance(harmonics=harmonics).solve(scenes, STRIBECK, 1.0)
        far.append(np.abs(found.mean - full.mean.real))
        assert found.status == ["ok"] * 3
        assert np.all(far[-1] <= found.error + full.error)
    assert far[0][0] > 3e-4 > 4e-5 > far[2][0]
    assert far[0][1] > 3.0 * far[2][1]


def test_every_harmonic_of_friction_that_varies_with_speed_obeys_its_own_equation() -> None:
    one = scene(-10.0, phase=70.0)
    mass = one.mass()
    found = HarmonicBalance(harmonics=6).solve([one], STRIBECK, 1.0)
    parts = harmonic_parts(one, found.orbit(0), 6)
    velocity, friction = (
        size[1:] * np.exp(1j * np.radians(phase[1:]))
        for size, phase in (
            (parts.velocity_amplitude, parts.velocity_phase),
            (parts.friction_amplitude, parts.friction_phase),
        )
    )
    rate = mass.frequency * np.arange(1.0, 7.0)
    load = np.where(rate == mass.frequency, abs(mass.force), 0.0)

    missing = (mass.damping + 1j * (rate - 1.0 / rate)) * velocity + mass.normal_load * friction - load
    assert np.abs(missing).max() < 1e-8


def test_where_slip_of_few_harmonics_cannot_rest_the_point_is_refused() -> None:
    falls = Stribeck(mu_kinetic=0.39, mu_static=0.4, stribeck_speed=3.0)
    falls_fast = Stribeck(mu_kinetic=0.1, mu_static=0.4, stribeck_speed=1.0)
    found = HarmonicBalance(harmonics=12).solve([STICKS], falls, 1.0)

    assert found.status == ["refused"]
    assert "does not settle on a motion of 12 harmonics" in found.reason[0]
    assert "no tail in closed form" in HarmonicBalance(harmonics=2, tail=True).refusal(FIG_4B, STRIBECK)
    assert "outweighs the fall" in HarmonicBalance(harmonics=2).refusal(FIG_4B, falls_fast)


# --- what it refuses ------------------------------------------------------------------------------------------------


def test_a_tail_of_one_harmonic_is_refused_by_name() -> None:
    with pytest.raises(WrongValues, match=r"tail.*one harmonic has no tail"):
        HarmonicBalance(tail=True)
    assert "no tail in closed form" in HarmonicBalance(harmonics=2, tail=True).refusal(planar(10.0), LAW)
    assert HarmonicBalance(harmonics=2, tail=True).refusal(FIG_4B, LAW) is None
    assert mean(FIG_4B, 6) == mean(FIG_4B, 6, tail=True) != mean(FIG_4B, 6, tail=False)


@pytest.mark.parametrize("harmonics", [0, 1001, 2.5, True, "3"])
def test_harmonics_are_whole_numbers_in_range(harmonics) -> None:
    with pytest.raises(WrongValues, match="harmonics"):
        HarmonicBalance(harmonics=harmonics)


def test_what_no_balance_of_harmonics_can_do_is_refused_with_its_reason() -> None:
    plain = HarmonicBalance(harmonics=20, tail=False).solve([STICKS], LAW, 1e-3)
    undamped = scene(1.0, frequency=0.5, damping=0.0)

    assert plain.status == ["refused"]
    assert "crosses zero more than twice" in plain.reason[0]
    assert "one harmonic alone" in HarmonicBalance(harmonics=3).refusal(FIG_4B, Dahl(mu=0.4, stiffness=40.0))
    assert "harmonic 2 of friction" in HarmonicBalance(harmonics=3).refusal(undamped, LAW)
    assert HarmonicBalance(harmonics=3).refusal(FIG_4B, LAW) is None


def test_a_study_may_ask_for_it() -> None:
    state = fl.steady_state(FIG_4B, LAW, HarmonicBalance(harmonics=20))

    assert state.mean_friction == pytest.approx(KNOWN, abs=1e-7)
    assert "20 harmonics" in state.model
    assert "free one" in state.model
