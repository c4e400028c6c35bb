"""The exact method where forces are not one sine: waveforms, vibrating belts, changing normal loads."""

from __future__ import annotations

import math

import numpy as np
import pytest
from outside_forcing import BELT1, LOAD1, NORMAL, forcing

from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.exact.method import Exact
from frictionlab.motion.orbit.recorder import DERIVATIVE, WEIGHTS
from frictionlab.scene.scene import Scene

LAW = Coulomb(mu=0.4)
SPEEDS = [-30.0, -3.0, 0.7, 12.0, 40.0]
DRIVE = {"unbalance": 10.0, "frequency": 1.0}
SAW = {"amplitude": 0.6, "phase": 70.0, "waveform": "sawtooth"}
SHAKE = {"velocity_amplitude": 6.0, "phase": 20.0, "waveform": "square"}


def scene(belt_speed, drive=DRIVE, **changes):
    """Workload W1 at this belt speed, but for the changes."""
    given = {"damping_ratio": 0.1, "normal_load": 10.0, **changes}
    return Scene(belt_speed=belt_speed, **given, **({"drive": drive} if drive else {}))


def shaped(waveform, **changes):
    """The drive in this waveform."""
    return {"drive": {**DRIVE, "waveform": waveform}, **changes}


def harmonics(*terms):
    return {"harmonics": [{"order": n, "amplitude": a, "phase": p} for n, a, p in terms]}


def solve(scenes, tolerance=1e-11, law=LAW):
    assert all(Exact().refusal(one, law) is None for one in scenes)
    return Exact().solve(scenes, law, tolerance)


def means(speeds=SPEEDS, **changes):
    """Mean friction at these belt speeds, each to 1e-11."""
    answers = solve([scene(v, **changes) for v in speeds])
    assert answers.status == ["ok"] * len(speeds)
    assert np.all(answers.error <= 1e-11)
    return answers.mean.real


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (shaped(harmonics((1, 1.0, 0.0))), {}),
        (
            {"drive": {**DRIVE, "phase": 10.0, "waveform": harmonics((1, 1.0, 25.0), (3, 0.2, 0.0))}},
            {"drive": {**DRIVE, "phase": 35.0, "waveform": harmonics((1, 1.0, 0.0), (3, 0.2, -75.0))}},
        ),
        (shaped("triangle", normal_load_variation={**SAW, "amplitude": 0.0}), shaped("triangle")),
        (
            shaped("triangle", normal_load_variation={"amplitude": 0.0, "frequency_ratio": 0.5}),
            shaped("triangle"),
        ),
        (
            {"normal_load_variation": {**SAW, "frequency_ratio": 1.0}, "belt_vibration": SHAKE},
            {"normal_load_variation": SAW, "belt_vibration": {**SHAKE, "frequency_ratio": 1.0}},
        ),
        (
            {"belt_vibration": {**SHAKE, "frequency_ratio": 2.0}, "drive": {**DRIVE, "unbalance": 0.0}},
            {"belt_vibration": {**SHAKE, "frequency": 2.0}, "drive": None},
        ),
        (
            {"belt_vibration": SHAKE, "transverse": {"natural_frequency": 0.5, "damping_ratio": 0.1}},
            {"belt_vibration": SHAKE},
        ),
    ],
    ids=["order one", "phases", "no variation", "in two periods", "ratio one", "twice", "plane"],
)
def test_two_ways_to_say_a_scene_have_one_mean(one, other):
    np.testing.assert_allclose(means(**one), means(**other), atol=2e-13)


def test_a_square_is_what_its_harmonics_tend_to():
    exact = means(**shaped("square"))
    steepest = 0.4 / 30.0  # of the mean against the belt speed
    for count in (2, 8, 32):
        terms = [(n, 4.0 / (math.pi * n), 0.0) for n in range(1, 2 * count, 2)]
        lost = 40.0 / math.pi * sum(1.0 / n**2 for n in range(2 * count + 1, 10_000, 2))  # of the velocity
        gap = np.abs(means(**shaped(harmonics(*terms))) - exact).max()
        assert 1e-2 * steepest * lost < gap < steepest * lost


def v_lin_of_a_square(load, b, half):
    """Half a period of free motion about the load leads from (x, v) to (-x, -v); the largest speed on the way."""
    rate = math.sqrt(1.0 - b * b)
    e, c, s = math.exp(-b * half), math.cos(rate * half), math.sin(rate * half) / rate
    flow = e * np.array([[c + b * s, s], [-s, c - b * s]])
    x, v = np.linalg.solve(np.eye(2) + flow, flow @ [load, 0.0] - [load, 0.0])
    tau = np.linspace(0.0, half, 100_001)
    turned = np.exp(-b * tau) * (v * np.cos(rate * tau) - (x - load + b * v) * np.sin(rate * tau) / rate)
    return np.abs(turned).max()


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_above_v_lin_of_a_square_drive_the_mean_is_the_coefficient(sign):
    v_lin = v_lin_of_a_square(10.0, 0.1, math.pi)
    above, below = (solve([scene(sign * k * v_lin, **shaped("square"))]) for k in (1.0 + 1e-8, 1.0 - 1e-4))
    assert above.mean[0] == sign * 0.4
    assert above.error_kind == ["guaranteed"]
    assert "no reversal" in above.model[0]
    assert 0.0 < 0.4 - sign * below.mean[0].real < 1e-3
    assert below.error_kind == ["estimated"]


@pytest.mark.parametrize("belt_speed", [0.3, 30.0])
def test_a_square_in_undamped_resonance_is_bounded_where_friction_reaches_the_load(belt_speed):
    drive = {"amplitude": 1.0, "frequency": 1.0, "waveform": "square"}
    below, above = (
        solve([scene(belt_speed, drive, damping_ratio=0.0, normal_load=friction / 0.4)])
        for friction in (0.99, 1.01)
    )
    assert below.status == ["failed"]
    assert "without bound" in below.reason[0]
    assert above.status == ["ok"]
    assert above.error[0] <= 1e-10


STILL = {
    "drive": {"amplitude": 1.0, "frequency": 0.7, "waveform": "square"},
    "normal_load_variation": {"amplitude": 0.5, "waveform": "square"},
}


def test_a_mass_that_loads_leave_at_rest_stays_where_it_starts():
    # Held where the load is 1 and the limit 6 from -5 to 7, where they are -1 and 2 from -3 to 1.
    answers = solve([scene(0.0, **STILL)])
    assert answers.status == ["not_unique"]
    assert answers.mean_low[0] == pytest.approx(-0.3)
    assert answers.mean_high[0] == pytest.approx(0.1)
    for x in (-3.0, -1.7, 1.0):
        told = solve([scene(0.0, initial={"x": x}, **STILL)])
        assert told.status == ["ok"]
        assert abs(told.mean[0].real - x / 10.0) <= told.error[0] <= 1e-11


def test_a_slow_belt_draws_the_mass_to_the_end_of_where_it_may_rest():
    speeds = [-1e-3, -1e-4, -1e-5, 1e-5, 1e-4, 1e-3]
    answers = solve([scene(v, **STILL) for v in speeds])
    assert answers.status == ["ok"] * len(speeds)
    gap = np.abs(answers.mean.real - np.where(np.array(speeds) < 0.0, -0.3, 0.1))
    assert np.all(gap <= 3.0 * np.abs(speeds))


VARIED = {
    "square": scene(3.0, **shaped("square")),
    "belt jumps": scene(0.5, None, normal_load=100.0, belt_vibration={**SHAKE, "frequency": 0.6}),
    "three periods": scene(
        4.0,
        belt_vibration={**SHAKE, "frequency_ratio": 1.5, "waveform": "sawtooth"},
        normal_load_variation={**SAW, "frequency_ratio": 2.0 / 3.0},
    ),
    "lines and waves": scene(
        -2.0,
        belt_vibration={**SHAKE, "waveform": "triangle"},
        normal_load_variation={**SAW, "waveform": "sine"},
    ),
    "overdamped": scene(1.0, damping_ratio=2.5, belt_vibration=SHAKE, normal_load_variation=SAW),
    "pulsating alone": scene(
        3.0, None, normal_load_variation={**SAW, "waveform": "triangle", "frequency": 0.8}
    ),
    "one wave in resonance": scene(3.0, damping_ratio=1e-4, belt_vibration=SHAKE),
    "all waves in resonance, undamped": scene(
        0.3,
        damping_ratio=0.0,
        normal_load=30.0,
        normal_load_variation={"amplitude": 0.5, "phase": 20.0},
        belt_vibration={**SHAKE, "waveform": "sine"},
    ),
    "in resonance, seven periods": scene(
        0.3, damping_ratio=2e-4, normal_load=30.0, normal_load_variation={**SAW, "frequency_ratio": 2.0 / 7.0}
    ),
    "in resonance, faster than V_lin": scene(7e4, damping_ratio=1e-4),
}


@pytest.mark.parametrize("one", VARIED.values(), ids=VARIED)
def test_orbits_obey_the_equation_of_motion_and_close(one):
    answers = solve([one])
    orbit = answers.orbit(0)
    tau, x, v, friction = orbit.tau, orbit.x.real, orbit.v.real, orbit.friction.real
    half = 0.5 * (tau[:, -1:] - tau[:, :1])
    size, speed = 1.0 + np.abs(x).max(), 1.0 + np.abs(v).max()
    assert tau[-1, -1] == pytest.approx(2.0 * math.pi / one.frequency * one.periods)
    for values in (tau, x, v):
        np.testing.assert_allclose(values[1:, 0], values[:-1, -1], atol=1e-12 * (size + speed))
    assert abs(x[0, 0] - x[-1, -1]) + abs(v[0, 0] - v[-1, -1]) <= 1e-11 * (size + speed)
    load, v_belt, limit = forces(one, tau)
    a = v @ DERIVATIVE.T / half
    stick = orbit.stick[:, None] & np.ones(tau.shape, bool)
    np.testing.assert_allclose(x @ DERIVATIVE.T, v * half, atol=1e-9 * size)
    balance = a + 2.0 * one.damping_ratio * v + x + one.normal_load * friction - load
    assert np.abs(balance * half).max() <= 1e-9 * (size + speed)
    np.testing.assert_allclose(v[stick], v_belt[stick], atol=1e-12 * speed)
    assert np.all(np.abs(friction[stick]) <= limit[stick] + 1e-11)
    slip = np.where(np.abs(v - v_belt) > 1e-9, np.sign(v - v_belt), np.sign(friction))
    np.testing.assert_allclose(friction[~stick], (slip * limit)[~stick], atol=1e-12)
    mean = -(half * WEIGHTS * friction).sum() / tau[-1, -1]
    assert mean == pytest.approx(answers.mean[0].real, abs=1e-12)
    assert one.normal_load * mean == pytest.approx((half * WEIGHTS * x).sum() / tau[-1, -1], abs=1e-11 * size)


def forces(one, tau):
    """At the nodes of every panel: load, velocity of the belt, and limit of friction over normal_load."""
    known, found = forcing(one.given()), np.empty((5, *tau.shape))
    for panel, times in enumerate(tau):
        span = np.searchsorted(known.edges, 0.5 * (times[0] + times[-1])) - 1
        value, slope = known.pieces[span].T
        found[:, panel] = value[:, None] + slope[:, None] * (times - known.edges[span])
        for which, (rate, phase, size) in zip(known.which, known.sines, strict=True):
            found[which, panel] += size * np.sin(rate * times + phase)
    return found[LOAD1], found[BELT1], LAW.mu * found[NORMAL] / one.normal_load


@pytest.mark.parametrize(("damping_ratio", "normal_load"), [(0.1, 10.0), (1e-4, 30.0), (0.0, 30.0)])
def test_a_second_harmonic_of_1e_13_changes_nothing(damping_ratio, normal_load):
    speeds, more = [0.3, 3.0, 30.0], {"damping_ratio": damping_ratio, "normal_load": normal_load}
    with_it = means(speeds, **shaped(harmonics((1, 1.0, 0.0), (2, 1e-13, 50.0)), **more))
    np.testing.assert_allclose(with_it, means(speeds, **more), atol=1e-11)
