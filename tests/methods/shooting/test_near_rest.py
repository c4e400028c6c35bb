"""Plane friction next to rest: the mass sticks for most of a period and a slow belt carries it on."""

from __future__ import annotations

import json

import numpy as np
import pytest
from profiles import DEEP, deep
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


@deep("more kernels to compile")
def test_an_orbit_under_a_square_load_is_closed_where_a_motion_ends():
    """The search from the friction-free orbit does not close it; marching finds the same mean."""
    load = fl.Load(amplitude=0.1414, phase=316.3, waveform="square")
    drive = fl.Drive(amplitude=0.0143, frequency=0.4054, phase=316.3, waveform="square")
    across = fl.Transverse(natural_frequency=1.2286, damping_ratio=0.2409, load=load)
    scene = fl.Scene(
        damping_ratio=0.1909, normal_load=1.6656, belt_speed=-0.0033, drive=drive, transverse=across
    )
    law = fl.Coulomb(mu=0.1568)
    state, marched = answered(scene, law), fl.steady_state(scene, law, method="march", tolerance=1e-5)

    assert (state.status, state.unique) == ("ok", "proved")
    assert state.error <= 1e-8
    assert abs(state.mean_friction - marched.mean_friction) <= state.error + marched.error
