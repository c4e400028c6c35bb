"""Steady states on Dahl bristles: balances of any law, and how they tend to those of Coulomb friction."""

from __future__ import annotations

import math

import numpy as np
import pytest

import frictionlab as fl
from frictionlab.laws.dahl import Dahl

DAMPING, LOAD, MU, UNBALANCE, FREQUENCY, BELT = 0.1, 10.0, 0.4, 10.0, 1.5, 15.0
SCENE = fl.Scene(
    damping_ratio=DAMPING,
    normal_load=LOAD,
    belt_speed=BELT,
    drive=fl.Drive(unbalance=UNBALANCE, frequency=FREQUENCY),
)


def dahl_mean(presliding: float) -> float:
    law = Dahl(mu=MU, presliding_length=presliding)
    return fl.steady_state(SCENE, law, method="shooting", tolerance=1e-9).mean_friction


def test_means_tend_to_coulombs_as_the_root_of_the_presliding_length_by_the_kicks_of_the_reversals() -> None:
    rigid = fl.steady_state(SCENE, fl.Coulomb(mu=MU), tolerance=1e-10).mean_friction
    lengths = np.array([1e-2, 1e-3, 1e-4, 1e-6])
    gaps = np.array([rigid - dahl_mean(length) for length in lengths.tolist()])
    slopes = np.diff(np.log(gaps)) / np.diff(np.log(lengths))

    assert np.all((slopes[:2] > 0.46) & (slopes[:2] < 0.5))  # not one
    # Coulomb friction at two reversals a period, each kicked by that root, the motion between them in closed form
    assert rigid == pytest.approx(0.16853270337949, abs=1e-9)
    assert gaps[-1] / math.sqrt(lengths[-1]) == pytest.approx(0.01484177, rel=3e-3)


@pytest.mark.parametrize("presliding", [1.0, 1e-3])
def test_the_mean_position_carries_the_mean_friction_and_the_energies_close(presliding: float) -> None:
    state = fl.steady_state(
        SCENE, Dahl(mu=MU, presliding_length=presliding), method="shooting", tolerance=1e-9
    )
    orbit, period = state.orbit(4000), 2 * math.pi / FREQUENCY

    assert orbit.x1.mean() == pytest.approx(LOAD * state.mean_friction, abs=1e-6)
    assert state.energy_input == pytest.approx(state.energy_viscous + state.energy_friction, rel=1e-7)
    belt = BELT * LOAD * state.mean_friction * period
    assert state.energy_contact == pytest.approx(state.energy_friction + belt, rel=1e-7)
    assert state.energy_contact > 0
