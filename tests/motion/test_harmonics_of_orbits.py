"""The harmonics of orbits: of closed forms, of square waves, and of energies that friction takes."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.exact.method import Exact
from frictionlab.motion.orbit.read import read_columns
from frictionlab.motion.orbit.record import Orbit
from frictionlab.motion.orbit.recorder import NODES
from frictionlab.motion.orbit.sample import harmonic_parts
from frictionlab.scene.scene import Drive, Load, Scene, Transverse

SCENE = Scene(
    damping_ratio=0.1, normal_load=10, belt_speed=10, drive=Drive(unbalance=10, frequency=1.0, phase=25.0)
)
LAW = Coulomb(mu=0.4)


def orbit(velocity, friction, edges):
    """Panels between these edges; at every edge the side that the panel lies on."""
    edges = np.asarray(edges)
    half = 0.5 * np.diff(edges)[:, None]
    tau = edges[:-1, None] + half * (1.0 + NODES)
    inside = edges[:-1, None] + half * (1.0 + NODES * (1.0 - 1e-15))
    v, rub = velocity(tau).astype(complex), friction(inside).astype(complex)
    return Orbit(tau, 0.0 * v, v, rub, None)


def test_of_sines_every_amplitude_and_phase() -> None:
    made = orbit(
        lambda t: 3.0 * np.sin(t + 0.5) + 0.2 * np.sin(3.0 * t - 1.0),
        lambda t: 0.1 + 0.4 * np.sin(t + 0.7) + 0.3 * np.sin(3.0 * t - 1.6),
        np.linspace(0.3, 0.3 + 2.0 * math.pi, 7),
    )
    lead = math.radians(25.0)

    found = harmonic_parts(SCENE, made, 4)

    np.testing.assert_allclose(found.velocity_amplitude, [0.0, 3.0, 0.0, 0.2, 0.0], atol=1e-10)
    np.testing.assert_allclose(found.friction_amplitude, [0.1, 0.4, 0.0, 0.3, 0.0], atol=1e-10)
    for k, velocity, friction, size in ((1, 0.5, 0.7, 0.4), (3, -1.0, -1.6, 0.3)):
        phase, gap = math.remainder(velocity - k * lead, math.tau), friction - velocity
        assert math.radians(found.velocity_phase[k]) == pytest.approx(phase, abs=1e-9)
        assert found.friction_in_phase[k] == pytest.approx(size * math.cos(gap), abs=1e-9)
        assert found.friction_in_quadrature[k] == pytest.approx(size * math.sin(gap), abs=1e-9)


def test_of_a_square_wave_hundreds_of_harmonics_on_two_panels() -> None:
    made = orbit(lambda t: np.ones_like(t), lambda t: np.sign(np.sin(t)), [0.0, math.pi, 2.0 * math.pi])
    plain = SCENE.model_copy(update={"drive": Drive(unbalance=10, frequency=1.0)})

    found = harmonic_parts(plain, made, 600)

    odd = found.harmonic % 2 == 1
    np.testing.assert_allclose(found.friction_amplitude[odd] * found.harmonic[odd], 4.0 / math.pi, rtol=1e-12)
    np.testing.assert_allclose(found.friction_amplitude[~odd], 0.0, atol=1e-14)
    np.testing.assert_allclose(found.friction_phase[odd], 0.0, atol=1e-10)
    assert np.isnan(found.friction_in_phase).all()  # there is no harmonic of the velocity to be in phase with
    assert found.velocity_amplitude[0] == pytest.approx(1.0)


def test_against_the_columns_of_the_table_and_parseval() -> None:
    scenes = [SCENE.model_copy(update={"belt_speed": speed}) for speed in (0.0, 10.0, 45.0)]
    answers = Exact().solve(scenes, LAW, 1e-8)
    columns = read_columns(scenes, answers.orbit)

    for i, scene in enumerate(scenes):
        found = harmonic_parts(scene, answers.orbit(i), 400)
        assert found.velocity_amplitude[1] == pytest.approx(columns["velocity_harmonic"][i], rel=1e-12)
        assert found.velocity_phase[1] == pytest.approx(columns["velocity_phase"][i], abs=1e-9)
        assert found.friction_amplitude[0] == pytest.approx(-answers.mean[i].real, abs=1e-12)
        # What friction takes from the mass in a period is the sum of what its parts in phase take.
        taken = np.nansum(found.velocity_amplitude * found.friction_in_phase) * 0.5 * 2.0 * math.pi * 10.0
        assert taken == pytest.approx(columns["energy_friction"][i], rel=1e-6)
        even = found.velocity_amplitude[2::2]
        assert (even.max() < 1e-9) == (scene.belt_speed == 0.0)


def test_across_the_belt_and_of_two_periods_recorded() -> None:
    across = Transverse(natural_frequency=0.5, damping_ratio=0.1, load=Load(unbalance=10))
    planar = SCENE.model_copy(update={"transverse": across})
    made = orbit(
        lambda t: 2.0 * np.sin(t + 0.1), lambda t: 0.3 * np.sin(t), np.linspace(0.0, 4.0 * math.pi, 15)
    )
    turned = replace(made, v=1j * made.v, friction=1j * made.friction, periods=2)

    along, aside = (harmonic_parts(planar, turned, 2, across=side) for side in (False, True))

    assert along.velocity_amplitude[1] == 0.0
    np.testing.assert_allclose(aside.velocity_amplitude, [0.0, 2.0, 0.0], atol=1e-9)
    assert aside.friction_in_quadrature[1] == pytest.approx(0.3 * math.sin(-0.1), abs=1e-9)
