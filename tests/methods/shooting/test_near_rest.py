"""Plane friction next to rest: the mass sticks for most of a period and a slow belt carries it on."""

from __future__ import annotations

import json

import numpy as np
import pytest
from profiles import DEEP, deep, some
from random_scenes import draw_near_rest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

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
    assert "near rest" in state.model


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


SLIPS_ONCE = {
    "above the loads": (
        (0.0922065680913537, 835.1217934593183, 6.974960525337201, 0.09660071779776515),
        (26.750056583440145, 2.347329580809108, 180.64012871624996),
        (0.030452532823193105, 10.706593713552271),
        0.08837986087399,
    ),
    "a slow belt": (
        (0.15097598620253785, 8.728305407702468, 0.01903905590882756, 0.3593238887251828),
        (0.9424795899078532, 3.1669477433218405, 150.32230789437781),
        (0.16965377810197865, 0.8005110413467925),
        0.27880008719946,
    ),
}
"""Damping, normal load, belt speed, mu; amplitude, frequency, phase; damping and amplitude across, at resonance.

Last the mean of the closed orbit by ``one_period``, closed by Newton's method: at rtol 1e-10 and 1e-12 it is the same
to 4e-14. Fixed small steps are off by 2e-9 and 1e-8: by the square of the first step.
"""


def one_period(scene, mu, tau, x):
    """From rest at x, to where it rests again: slip in polar coordinates by scipy's Radau, from release to capture.

    Returns the position a period later and the mean friction: that of x1 over the normal load.
    """
    mass, omega, across = scene.mass(), scene.frequency, scene.transverse
    sizes, phases = [scene.drive.amplitude, across.load.amplitude], [scene.drive.phase, across.load.phase]
    stiffness = np.array([1.0, across.natural_frequency**2])
    damping = np.array([mass.damping, mass.transverse_damping])
    belt, limit, tiny = np.array([scene.belt_speed, 0.0]), mu * scene.normal_load, 1e-9

    def force(at, place, velocity):
        return sizes * np.sin(omega * at + np.radians(phases)) - damping * velocity - stiffness * place

    def held(at):
        return force(at, x + belt * (at - tau), belt)

    def rates(at, state):
        radius, along = state[0], np.array([np.cos(state[1]), np.sin(state[1])])
        push = force(at, state[2:4], belt + radius * along)
        turn = (along[0] * push[1] - along[1] * push[0]) / radius
        return [along @ push - limit, turn, *(belt + radius * along), state[2]]

    def caught(at, state):
        return state[0] - tiny

    caught.terminal, caught.direction = True, -1.0
    end = tau + 2.0 * np.pi / omega
    times = np.linspace(tau, end, 400)
    over = np.flatnonzero([np.hypot(*held(at)) > limit for at in times])[0]
    left = brentq(lambda at: np.hypot(*held(at)) - limit, times[over - 1], times[over], xtol=1e-15)
    grows = (np.hypot(*held(left + 1e-6)) - np.hypot(*held(left - 1e-6))) / 2e-6
    begun = left + np.sqrt(2.0 * tiny / grows)  # slip grows as half of that times the square of the time
    first = x + belt * (begun - tau)
    ahead = held(begun)
    state = [1.0001 * tiny, np.arctan2(ahead[1], ahead[0]), *first, 0.5 * (x[0] + first[0]) * (begun - tau)]
    way = solve_ivp(rates, (begun, end), state, "Radau", events=caught, rtol=1e-10, atol=1e-14)
    assert way.status == 1
    back, last = end - way.t[-1], way.y[2:4, -1]
    integral = way.y[4, -1] + last[0] * back + 0.5 * belt[0] * back**2
    return last + belt * back, integral / (end - tau) / scene.normal_load


@some(1, "seconds of steps")
@pytest.mark.parametrize("name", SLIPS_ONCE)
def test_an_orbit_that_slips_once_a_period_is_that_of_steps_from_release_to_capture(name):
    (damping, load, belt, mu), drive, across, known = SLIPS_ONCE[name]
    pushed = fl.Drive(**dict(zip(("amplitude", "frequency", "phase"), drive, strict=True)))
    beside = fl.Load(amplitude=across[1], phase=90)
    second = fl.Transverse(natural_frequency=drive[1], damping_ratio=across[0], load=beside)
    scene = fl.Scene(
        damping_ratio=damping, normal_load=load, belt_speed=belt, drive=pushed, transverse=second
    )
    state = answered(scene, fl.Coulomb(mu=mu))
    orbit = state.orbit(400)
    rests = orbit[(orbit.v1 - belt).abs() + orbit.v2.abs() < 1e-12 * abs(belt)]
    tau, x1, x2 = rests.iloc[-1][["tau", "x1", "x2"]]
    after, mean = one_period(scene, mu, tau, np.array([x1, x2]))

    assert state.status == "ok"
    assert state.error < 1e-9
    assert after == pytest.approx([x1, x2], rel=1e-8)
    assert max(abs(mean - known), abs(state.mean_friction - known)) <= state.error + 1e-13


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
