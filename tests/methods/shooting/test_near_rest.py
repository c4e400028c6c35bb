"""Plane friction next to rest: the mass sticks for most of a period and a slow belt carries it on."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from brute_force_plane import PlaneNumbers, mean_position
from profiles import DEEP, deep
from random_scenes import draw_near_rest

import frictionlab as fl
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.orbit.record import Orbits
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
    # tests/brute_force_plane.py from the orbit's state at tau = 0, steps of half the time in which slip turns
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


def test_the_other_direction_of_the_belt_changes_signs_alone():
    there, back = answered(HARD), answered(HARD.model_copy(update={"belt_speed": -HARD.belt_speed}))

    assert abs(there.mean_friction + back.mean_friction) <= there.error + back.error


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


def test_orbits_found_in_two_ways_stand_in_the_order_of_their_scenes():
    def orbits(panels):
        number = np.repeat(np.arange(len(panels)), panels).astype(float)
        nodes = np.tile(number[:, None], (1, 10))
        return Orbits(nodes, nodes + 0j, nodes + 0j, nodes + 0j, number > 0.0, np.cumsum(panels))

    joined = orbits([2, 0, 1, 0]).and_those_of(orbits([0, 3, 0, 1]))

    assert joined.ends.tolist() == [2, 5, 6, 7]
    assert joined.tau[:, 0].tolist() == [0, 0, 1, 1, 1, 2, 3]


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


@deep("minutes of short steps")
def test_brute_force_finds_the_same_means():
    rng, seen = np.random.default_rng(5), 0
    while seen < 30:
        keys, mu = draw_near_rest(rng)
        scene = fl.Scene(**keys)
        state = answered(scene, fl.Coulomb(mu=mu))
        if state.stick_fraction < 0.05:
            continue
        at = state.orbit(1)
        start = np.array([at.x1[0], at.x2[0], at.v1[0] - scene.belt_speed, at.v2[0]])
        if math.hypot(start[2], start[3]) < 1e-12 * (1.0 + abs(at.v1[0])):
            start[2:] = 0.0
        found = mean_position(_numbers(scene, mu), start)
        apart = abs(found.value / scene.normal_load - state.mean_friction)
        assert apart <= state.error + 2.0 * found.error / scene.normal_load, keys
        seen += 1


def _numbers(scene, mu):
    mass = scene.mass()
    return PlaneNumbers(
        (mass.damping, mass.transverse_damping),
        (mass.stiffness, mass.transverse_stiffness),
        (mass.force.real, mass.transverse_force.real),
        (mass.force.imag, mass.transverse_force.imag),
        mass.frequency,
        mass.normal_load * mu,
        scene.belt_speed,
    )
