"""What is read from an orbit: closed-form motions give closed-form numbers, samples give the columns."""

from __future__ import annotations

import math

import numpy as np
import pytest
from answered import with_columns
from hypothesis import given
from hypothesis import strategies as st
from strategies import MU, scenes_on_the_line

from frictionlab.compile.cache import compiled
from frictionlab.compile.decorators import njit
from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.exact.method import Exact
from frictionlab.motion.orbit.read import READ, OrbitPanels, read
from frictionlab.motion.orbit.record import Orbit
from frictionlab.motion.orbit.recorder import DERIVATIVE, NODES, PER_PANEL, WEIGHTS
from frictionlab.motion.orbit.sample import sample
from frictionlab.scene.body import Mass, for_kernels
from frictionlab.scene.scene import Drive, Load, Scene, Transverse

LAW = Coulomb(mu=MU)


@njit
def columns_of(panels, mass, belt_speed):
    return read(panels, mass, belt_speed)


def read_from(orbit, mass, belt_speed):
    """READ by name."""
    panels = OrbitPanels(orbit.tau, orbit.x, orbit.v, orbit.friction, orbit.stick)
    numbers = compiled(columns_of)(panels, for_kernels(mass), belt_speed)
    return dict(zip(READ, numbers, strict=True))


def motion(frequency, panels, position, stick=(), friction=None):
    """One period of x(tau) = position(tau) in equal panels; the velocity by finite steps in the complex plane."""
    edges = np.linspace(0.0, 2.0 * math.pi / frequency, panels + 1)
    half = 0.5 * np.diff(edges)[:, None]
    tau = edges[:-1, None] + half * (1.0 + NODES)
    x, v = position(tau)
    rub = friction(tau) if friction is not None else np.zeros_like(x)
    marks = np.isin(np.arange(panels), stick)
    return Orbit(tau, x.astype(complex), v.astype(complex), rub.astype(complex), marks)


def harmonic(frequency, along, across=0j):
    """x1 = Im(along e^(i frequency tau)), x2 likewise."""

    def position(tau):
        turn = np.exp(1j * frequency * tau)
        x = (along * turn).imag + 1j * (across * turn).imag
        v = (1j * frequency * along * turn).imag + 1j * (1j * frequency * across * turn).imag
        return x, v

    return position


MASS = Mass(0.2, 1.0, 0.8, 4.0, 10.0, 1.5, 3.0 + 0j, 0.5j)


# --- the nodes ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("degree", range(2 * PER_PANEL - 2))
def test_the_weights_integrate_polynomials_up_to_twice_the_nodes_less_three(degree):
    expected = 2.0 / (degree + 1) if degree % 2 == 0 else 0.0

    assert (WEIGHTS * NODES**degree).sum() == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize("degree", range(1, PER_PANEL))
def test_the_derivative_is_that_of_every_polynomial_through_the_nodes(degree):
    np.testing.assert_allclose(DERIVATIVE @ NODES**degree, degree * NODES ** (degree - 1), atol=1e-12)


# --- closed-form motions ------------------------------------------------------------------------------------------


@given(
    along=st.complex_numbers(min_magnitude=0.1, max_magnitude=10.0),
    across=st.complex_numbers(min_magnitude=0.1, max_magnitude=10.0),
    panels=st.integers(6, 30),
)
def test_a_harmonic_motion_has_its_own_amplitudes_phases_and_energies(along, across, panels):
    omega, period = MASS.frequency, 2.0 * math.pi / MASS.frequency
    found = read_from(motion(omega, panels, harmonic(omega, along, across)), MASS, 0.0)

    for name, phasor in (("velocity", 1j * omega * along), ("transverse_velocity", 1j * omega * across)):
        assert found[f"{name}_amplitude"] == pytest.approx(abs(phasor), rel=1e-8)
        assert found[f"{name}_harmonic"] == pytest.approx(abs(phasor), rel=1e-9)
        lead = math.degrees(np.angle(phasor / MASS.force))
        turned = (found[f"{name}_phase"] - lead + 180.0) % 360.0 - 180.0
        assert turned == pytest.approx(0.0, abs=1e-6)
    viscous = 0.5 * period * omega**2 * (0.2 * abs(along) ** 2 + 0.8 * abs(across) ** 2)
    pushed = MASS.force * (1j * omega * along).conjugate()
    pushed += MASS.transverse_force * (1j * omega * across).conjugate()
    put_in = 0.5 * period * pushed.real
    assert found["energy_viscous"] == pytest.approx(viscous, rel=1e-9)
    assert found["energy_input"] == pytest.approx(put_in, rel=1e-9, abs=1e-8)
    assert found["mean_position"] == pytest.approx(0.0, abs=1e-9)
    assert found["energy_friction"] == 0.0
    assert found["reversals"] == 2.0


def test_means_and_friction_energies_are_integrals_over_the_period():
    omega, period = 1.5, 2.0 * math.pi / 1.5

    def position(tau):
        x, v = harmonic(omega, 2.0 + 0j, 1.0 + 0j)(tau)
        return x + (0.7 - 0.3j), v

    def friction(tau):
        return -0.25 + 0.1 * np.cos(omega * tau) + 1j * (0.05 + 0.2 * np.cos(omega * tau))

    found = read_from(motion(omega, 12, position, friction=friction), MASS, 4.0)
    taken = 10.0 * 0.5 * period * (0.1 * 2.0 * omega + 0.2 * 1.0 * omega)

    assert found["mean_friction"] == pytest.approx(0.25, rel=1e-12)
    assert found["mean_friction_transverse"] == pytest.approx(-0.05, rel=1e-12)
    assert found["mean_position"] == pytest.approx(0.7, rel=1e-12)
    assert found["mean_position_transverse"] == pytest.approx(-0.3, rel=1e-12)
    assert found["energy_friction"] == pytest.approx(taken, rel=1e-12)
    assert found["energy_contact"] == pytest.approx(taken + 4.0 * 10.0 * 0.25 * period, rel=1e-12)
    assert found["force_reversals"] == 0.0


@pytest.mark.parametrize(
    ("belt_speed", "turns"), [(0.0, 2.0), (2.9, 2.0), (-2.9, 2.0), (3.1, 0.0), (-3.1, 0.0)]
)
def test_slip_reverses_where_the_mass_overtakes_the_belt(belt_speed, turns):
    orbit = motion(1.5, 12, harmonic(1.5, 2.0 + 0j))

    assert read_from(orbit, MASS, belt_speed)["reversals"] == turns


def test_force_reversals_are_counted_by_the_friction_and_stick_is_left_out_of_slip_reversals():
    def friction(tau):
        return np.where(np.sin(4.5 * tau) > 0.0, 0.4, -0.4)

    orbit = motion(1.5, 12, harmonic(1.5, 2.0 + 0j), stick=(2, 3, 4), friction=friction)
    found = read_from(orbit, MASS, 0.0)

    assert found["force_reversals"] == 6.0
    assert found["reversals"] == 2.0
    assert found["stick_fraction"] == pytest.approx(0.25, rel=1e-12)


def test_the_amplitude_is_half_of_peak_to_peak_between_nodes_too():
    omega = 1.5

    def position(tau):
        x = 2.0 * np.sin(omega * tau) + 0.5 * np.sin(2.0 * omega * tau + 0.3)
        return x, omega * (2.0 * np.cos(omega * tau) + np.cos(2.0 * omega * tau + 0.3))

    fine = position(np.linspace(0.0, 2.0 * math.pi / omega, 400_001))[1]
    found = read_from(motion(omega, 16, position), MASS, 0.0)

    assert found["velocity_amplitude"] == pytest.approx(0.5 * np.ptp(fine), rel=1e-9)
    assert found["velocity_harmonic"] == pytest.approx(3.0, rel=1e-9)


# --- samples ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("n", [1, 2, 7, 48, 1000])
def test_samples_are_the_motion_at_equally_spaced_times(n):
    across = Transverse(natural_frequency=2.0, damping_ratio=0.2, load=Load(amplitude=0.5, phase=90.0))
    drive = Drive(amplitude=3.0, frequency=1.5, phase=30.0)
    scene = Scene(damping_ratio=0.1, normal_load=10.0, belt_speed=5.0, drive=drive, transverse=across)
    at = sample(motion(1.5, 12, harmonic(1.5, 2.0 + 0j, 1j)), scene, LAW, n)
    angle = 2.0 * math.pi * np.arange(n) / n

    np.testing.assert_allclose(at.tau, angle / 1.5, rtol=1e-13)
    np.testing.assert_allclose(at.x1, 2.0 * np.sin(angle), atol=1e-9)
    np.testing.assert_allclose(at.v1, 3.0 * np.cos(angle), atol=1e-9)
    np.testing.assert_allclose(at.x2, np.cos(angle), atol=1e-9)
    np.testing.assert_allclose(at.v2, -1.5 * np.sin(angle), atol=1e-9)
    np.testing.assert_allclose(at.load, 3.0 * np.sin(angle + math.pi / 6.0), atol=1e-12)
    np.testing.assert_allclose(at.load_transverse, 0.5 * np.cos(angle), atol=1e-12)
    assert not at.friction.any()


def test_the_samples_of_loads_are_their_waveforms_and_at_a_jump_the_value_after_it():
    load = Load(amplitude=0.5, waveform="triangle", frequency_ratio=2)
    across = Transverse(natural_frequency=2.0, damping_ratio=0.2, load=load)
    drive = Drive(amplitude=3.0, frequency=1.0, waveform="square")
    scene = Scene(damping_ratio=0.1, normal_load=10.0, belt_speed=5.0, drive=drive, transverse=across)
    turned = scene.with_(
        **{"drive.direction": 60, "drive.waveform": None, "transverse.load": None, "drive.phase": 90}
    )
    orbit = motion(1.0, 12, harmonic(1.0, 2.0 + 0j, 1j))
    at, aslant = (sample(orbit, shaken, LAW, 8) for shaken in (scene, turned))

    np.testing.assert_allclose(at.load, [3, 3, 3, 3, -3, -3, -3, -3], atol=1e-12)
    np.testing.assert_allclose(at.load_transverse, [0, 0.5, 0, -0.5] * 2, atol=1e-12)
    np.testing.assert_allclose(aslant.load, 1.5 * np.cos(at.tau), atol=1e-12)
    aside = 3.0 * math.sin(math.pi / 3) * np.cos(at.tau)
    np.testing.assert_allclose(aslant.load_transverse, aside, atol=1e-12)


def test_an_orbit_under_a_changing_load_has_the_force_over_the_mean_load():
    scene = Scene(
        damping_ratio=0.1,
        normal_load=2.0,
        belt_speed=9.0,
        drive=Drive(amplitude=1.0, frequency=2.0),
        normal_load_variation={"amplitude": 0.5, "frequency_ratio": "3/2"},
    )
    at = sample(with_columns(Exact(), [scene], LAW, 1e-9).orbit(0), scene, LAW, 16)

    np.testing.assert_allclose(at.tau[1:], 2.0 * math.pi * np.arange(1, 16) / 16, rtol=1e-12)
    np.testing.assert_allclose(at.friction, -MU * (1.0 + 0.5 * np.sin(3.0 * at.tau)), atol=1e-9)


def agree_with_samples(scene, answers):
    """Columns against sums over 8,192 samples: first order where friction jumps, so to a thousandth."""
    columns = {name: float(values[0]) for name, values in answers.columns.items()}
    at = sample(answers.orbit(0), scene, LAW, 8192)
    period, mass = 2.0 * math.pi / scene.frequency, scene.mass()
    swing = np.abs(at.v1).max() + np.abs(at.v2).max()

    assert np.mean(-at.friction) == pytest.approx(columns["mean_friction"], abs=2e-3 * MU)
    assert np.mean(at.x1) == pytest.approx(
        scene.normal_load * columns["mean_friction"], abs=1e-4 * (1.0 + swing)
    )
    assert 0.5 * np.ptp(at.v1) == pytest.approx(columns["velocity_amplitude"], rel=2e-3)
    put_in = period * np.mean(at.load * at.v1 + at.load_transverse * at.v2)
    viscous = period * np.mean(mass.damping * at.v1**2 + mass.transverse_damping * at.v2**2)
    taken = period * mass.normal_load * np.mean(at.friction * at.v1 + at.friction_transverse * at.v2)
    scale = period * (abs(mass.force) + abs(mass.transverse_force) + MU * mass.normal_load) * swing
    assert put_in == pytest.approx(columns["energy_input"], abs=1e-3 * scale)
    assert viscous == pytest.approx(columns["energy_viscous"], rel=2e-3)
    assert taken == pytest.approx(columns["energy_friction"], abs=1e-3 * scale)
    at_rest = np.hypot(at.v1 - scene.belt_speed, at.v2) <= 1e-9 * (swing + abs(scene.belt_speed))
    assert np.mean(at_rest) == pytest.approx(columns["stick_fraction"], abs=2e-3)


@given(scene=scenes_on_the_line(speed=(0.01, 1.2)))
def test_columns_on_the_line_are_what_the_samples_of_the_orbit_say(scene):
    answers = with_columns(Exact(), [scene], LAW, 1e-11)

    assert answers.status == ["ok"]
    agree_with_samples(scene, answers)
