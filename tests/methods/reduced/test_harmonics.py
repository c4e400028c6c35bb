"""Harmonic balance in H harmonics: against Eqs. 8 and 9, its own equations, the exact means, and its orders."""

from __future__ import annotations

import math

import numpy as np
import pytest
from resonance import in_the_plane

import frictionlab as fl
from frictionlab.laws.base import Positive, SlidingLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.stribeck import Stribeck
from frictionlab.methods.reduced.harmonic_balance import HarmonicBalance
from frictionlab.methods.reduced.sampled import Equations, _switches, balanced, sampled
from frictionlab.methods.shooting.method import Shooting
from frictionlab.motion.orbit.sample import harmonic_parts
from frictionlab.scene.scene import Drive, Scene
from frictionlab.values.notes import WrongValues

LAW = Coulomb(mu=0.4)
STRIBECK = Stribeck(mu_kinetic=0.3, mu_static=0.4, stribeck_speed=30.0)
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


def planar(belt_speed, omega_r=0.5, **load):
    """Paper, Fig. 9, but for the changes."""
    return in_the_plane(belt_speed, 1.0, 10.0, omega_r, **load)


FIG_4B = scene(10.0)
STICKS = scene(0.5, frequency=0.5, amplitude=2.5)


def mean(one, harmonics):
    """Of one scene, without its error."""
    return float(HarmonicBalance(harmonics=harmonics).model_means([one], LAW)[0])


def lacking(one, orbit, harmonics, across=False):
    """The force that every harmonic of an orbit lacks, and the velocities."""
    mass, parts = one.mass(), harmonic_parts(one, orbit, harmonics, across=across)
    damping, stiffness, load = mass.damping, mass.stiffness, mass.force
    if across:
        damping, stiffness, load = mass.transverse_damping, mass.transverse_stiffness, mass.transverse_force
    velocity, friction = (
        size[1:] * np.exp(1j * np.radians(np.nan_to_num(phase[1:])))
        for size, phase in (
            (parts.velocity_amplitude, parts.velocity_phase),
            (parts.friction_amplitude, parts.friction_phase),
        )
    )
    rate = mass.frequency * parts.harmonic[1:]
    lead = np.exp(-1j * np.angle(mass.force))  # phases are those against the load along the belt
    force = np.where(rate == mass.frequency, load * lead, 0.0)
    impedance = damping + 1j * (rate - stiffness / rate)
    return impedance * velocity + mass.normal_load * friction - force, velocity


# --- what it balances -----------------------------------------------------------------------------------------------


def test_one_harmonic_on_samples_is_that_of_eqs_8_and_9() -> None:
    scenes = [scene(speed) for speed in np.linspace(-60.0, 60.0, 25).tolist()]

    searched, explicit = sampled(scenes, LAW, 1).mean, HarmonicBalance().model_means(scenes, LAW)

    np.testing.assert_allclose(searched, explicit, atol=1e-11)


@pytest.mark.parametrize("belt_speed", [10.0, -31.0])
def test_every_harmonic_obeys_its_own_equation_and_there_are_none_beyond(belt_speed) -> None:
    one = scene(belt_speed, phase=40.0)
    orbit = HarmonicBalance(harmonics=7).solve([one], LAW, 1e-3).orbit(0)

    missing, velocity = lacking(one, orbit, 9)

    assert np.abs(missing[:7]).max() < 1e-9
    assert np.abs(velocity[7:]).max() < 1e-9


@pytest.mark.parametrize("law", [LAW, STRIBECK], ids=["coulomb", "stribeck"])
def test_in_the_plane_and_with_friction_that_varies_with_speed_they_obey_them_too(law) -> None:
    plane = planar(-8.0, phase=70.0)
    found = HarmonicBalance(harmonics=6).solve([plane], law, 1.0)
    for across in (False, True):
        assert np.abs(lacking(plane, found.orbit(0), 6, across)[0]).max() < 1e-7
        parts = harmonic_parts(plane, found.orbit(0), 6, across=across)
        own = found.mean[0].imag if across else found.mean[0].real
        assert parts.friction_amplitude[0] == pytest.approx(-own, abs=1e-8)

    line = scene(-10.0, phase=70.0)
    orbit = HarmonicBalance(harmonics=6).solve([line], law, 1.0).orbit(0)
    assert np.abs(lacking(line, orbit, 6)[0]).max() < 1e-8


def test_even_harmonics_vanish_on_a_belt_at_rest() -> None:
    one = scene(0.0, phase=10.0)
    answers = HarmonicBalance(harmonics=6).solve([one], LAW, 1e-3)
    parts = harmonic_parts(one, answers.orbit(0), 6)

    assert abs(answers.mean[0]) < 1e-14
    assert max(parts.velocity_amplitude[2::2]) < 1e-11 < parts.velocity_amplitude[3]
    assert max(parts.friction_amplitude[2::2]) < 1e-11


# --- how close it comes ---------------------------------------------------------------------------------------------


def test_where_friction_jumps_the_mean_is_of_first_order() -> None:
    errors = [abs(mean(FIG_4B, harmonics) - KNOWN) for harmonics in (16, 32, 64)]

    assert errors == pytest.approx([2.1e-5, 1.1e-5, 5.5e-6], rel=0.05)


@pytest.mark.parametrize("law", [LAW, STRIBECK], ids=["coulomb", "stribeck"])
def test_harmonics_that_cannot_rest_balance_beside_a_mass_that_does_and_come_nearer(law) -> None:
    full, far = Shooting().solve([STICKS], law, 1e-9), []
    for harmonics in (2, 4, 8):
        found = HarmonicBalance(harmonics=harmonics).solve([STICKS], law, 1.0)
        far.append(abs(found.mean[0] - full.mean[0].real))
        assert far[-1] <= found.error[0] + full.error[0]
        assert np.abs(lacking(STICKS, found.orbit(0), harmonics)[0]).max() < 1e-8

    assert far[0] > far[1] > far[2]


def test_in_the_plane_smooth_friction_converges_exponentially_and_errors_tell_how_far() -> None:
    one = planar(10.0)
    found = [HarmonicBalance(harmonics=count).solve([one], LAW, 1e-8) for count in (2, 8, 32)]
    means = [float(each.mean[0].real) for each in found]
    exact = Shooting().solve([one], LAW, 1e-11)
    far = [abs(value - float(exact.mean[0].real)) for value in means]

    assert far[0] > 50.0 * far[1] > 1e5 * far[2]
    assert far[2] < 1e-9
    assert all(distance <= each.error[0] + exact.error[0] for distance, each in zip(far, found, strict=True))
    assert HarmonicBalance(harmonics=8).model_means([planar(0.0)], LAW)[0] == 0.0


def test_slip_that_reverses_twice_between_two_samples_is_seen_to() -> None:
    angle, half = math.tau / 128 * np.arange(128), 0.01
    slip = np.cos(angle - 0.02) - math.cos(half)

    signs, _ = _switches(np.array([np.exp(-0.02j)]), slip, math.cos(half))

    assert np.all(slip < 0.0)
    assert signs[0] == pytest.approx(-1.0 + 2.0 * half / math.pi, abs=1e-13)
    assert abs(signs[1]) == pytest.approx(2.0 / math.pi * math.sin(half), abs=1e-13)


class Steep(SlidingLaw):
    """Coulomb friction on a scale of slip speeds, with no jump to tell reversals by."""

    mu: Positive
    scale: Positive

    def sliding_friction(self, speed):
        return self.mu * math.tanh(speed / self.scale)


def test_samples_resolve_friction_that_is_steep_at_rest_and_slip_that_passes_near_it() -> None:
    steep, scenes = Steep(mu=0.4, scale=0.02), [FIG_4B.at(v) for v in (2.0, 10.0)]
    coulomb = [mean(one, 8) for one in scenes]
    assert HarmonicBalance(harmonics=8).model_means(scenes, steep) == pytest.approx(coulomb, abs=2e-6)

    what = Equations.of(planar(3.0, omega_r=10.0), LAW, 4)
    motion = balanced(what, 3.0, what.force / what.impedance)
    angle = np.linspace(0.0, math.tau, 2**18, endpoint=False)
    slip = np.exp(1j * np.multiply.outer(angle, np.arange(1.0, 5.0))) @ motion.velocity.T
    slip = slip.real - [3.0, 0.0]
    friction = LAW.mu * slip / np.hypot(*slip.T)[:, None]
    assert motion.mean == pytest.approx(friction.mean(axis=0), abs=1e-7)


def test_friction_that_varies_with_speed_converges_on_the_full_mean_and_errors_tell_how_far() -> None:
    scenes = [scene(speed) for speed in (10.0, 40.0, 70.0)]
    full = Shooting().solve(scenes, STRIBECK, 1e-9)

    first = Equations.of(scenes[0], STRIBECK, 1)
    alone = [balanced(first, one.belt_speed, first.force / first.impedance) for one in scenes]
    far = [np.abs([-each.mean[0] for each in alone] - full.mean.real)]
    for harmonics in (4, 16):
        found = HarmonicBalance(harmonics=harmonics).solve(scenes, STRIBECK, 1.0)
        far.append(np.abs(found.mean - full.mean.real))
        assert found.status == ["ok"] * 3
        assert np.all(far[-1] <= found.error + full.error)
    assert far[0][0] > 3e-4 > 4e-5 > far[2][0]
    assert far[0][1] > 3.0 * far[2][1]


# --- what it refuses ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("harmonics", [0, 1001, 2.5, True, "3"])
def test_harmonics_are_whole_numbers_in_range(harmonics) -> None:
    with pytest.raises(WrongValues, match="harmonics"):
        HarmonicBalance(harmonics=harmonics)


def test_a_study_may_ask_for_it() -> None:
    state = fl.steady_state(FIG_4B, LAW, HarmonicBalance(harmonics=20, tail=False))

    assert abs(state.mean_friction - KNOWN) <= state.error < 2e-5
    assert state.model == "20 harmonics by samples"
