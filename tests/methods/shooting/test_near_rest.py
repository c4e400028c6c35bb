"""Plane friction next to rest: the mass sticks for most of a period and a slow belt carries it on."""

from __future__ import annotations

import json

import numpy as np
import pytest
from profiles import DEEP
from random_scenes import draw_near_rest

import frictionlab as fl
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.theory.rest import can_hold, resting_range

HARD = fl.Scene(
    damping_ratio=0.1,
    normal_load=170,
    belt_speed=0.00265,
    drive=fl.Drive(amplitude=3.26, frequency=1),
    transverse=fl.Transverse(natural_frequency=9.95, damping_ratio=0.1, load=fl.Load(unbalance=0.104)),
)
LAW = fl.Coulomb(mu=1.36)


def answered(scene, law=LAW):
    return fl.steady_state(scene, law, method="shooting", tolerance=1e-8)


def test_a_mass_that_friction_holds_for_most_of_a_period_is_answered():
    state = answered(HARD)

    assert state.status == "ok"
    assert state.error <= 1e-8
    # Runge-Kutta steps of half the time in which slip turns, from the orbit's state at tau = 0
    assert abs(state.mean_friction - 1.3414591586661) <= state.error + 2e-10
    assert "polar" in state.model


def test_on_an_ever_slower_belt_the_mean_tends_to_the_most_that_friction_holds():
    most = resting_range(HARD, LAW)
    gaps = [
        answered(HARD.model_copy(update={"belt_speed": speed})).mean_friction - most
        for speed in (1e-4, 1e-6, 1e-8)
    ]

    # the force beyond the limit that slip needs grows with the root of the belt's way in a period
    assert gaps[0] > gaps[1] > gaps[2] > 0.0
    assert gaps[1] / gaps[2] == pytest.approx(10.0, rel=0.1)


def test_energies_of_an_orbit_next_to_rest_close():
    state = answered(HARD)

    assert state.energy_input == pytest.approx(state.energy_viscous + state.energy_friction, rel=1e-6)
    assert 0.8 < state.stick_fraction < 0.9
    assert 0.0 < state.floquet < 1.0


def test_explicit_and_implicit_steps_find_the_same_orbit():
    scene = HARD.model_copy(update={"normal_load": 2.0, "belt_speed": 0.3})
    assert not can_hold(scene, LAW)
    problem = PeriodicProblem(scene, LAW, 1e-9)
    implicit = problem.by_implicit_steps
    (one, _), (other, _) = problem.close([scene]), implicit.close([scene])

    gap = abs(one.closed.mean[0] - other.closed.mean[0])
    assert gap <= one.closed.error[0] + other.closed.error[0]
    assert one.matrices[0] == pytest.approx(other.matrices[0], abs=1e-4)  # a difference quotient
    assert other.states[0] == pytest.approx(one.states[0], abs=1e-7)
    first, second = problem.orbits([scene], [one.states[0]]), implicit.orbits([scene], [other.states[0]])
    for part in ("x", "v"):
        ends = [getattr(orbits, part)[-1, -1] for orbits in (first, second)]
        assert abs(ends[0] - ends[1]) < 1e-6


@pytest.mark.parametrize("seed", range(40 if DEEP else 1))
def test_no_hard_scene_fails(seed):
    rng = np.random.default_rng(seed)
    failed = []
    for _ in range(125 if DEEP else 25):
        keys, mu = draw_near_rest(rng)
        state = answered(fl.Scene(**keys), fl.Coulomb(mu=mu))
        if state.status != "ok" or (state.error > 1e-8 and "rounding" not in state.reason):
            failed.append((json.dumps(keys), mu, state.status, state.error, state.reason))

    assert failed == []
