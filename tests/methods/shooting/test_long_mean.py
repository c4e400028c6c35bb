"""The long mean of motions that do not repeat: it covers chaos, and converges fast where it is quasi-periodic."""

from __future__ import annotations

import math

import numpy as np
import pytest
from profiles import deep, some

import frictionlab as fl
from frictionlab.methods.periodic.follow import Attractor
from frictionlab.methods.periodic.long_mean import LongMean, birkhoff_mean, long_mean
from frictionlab.methods.periodic.problem import PeriodicProblem, Transient
from frictionlab.methods.shooting.attractors import FollowedStarts
from frictionlab.methods.shooting.long_motions import (
    LongMotion,
    average_unrepeated,
    drifts,
    late_period,
    means_of_attractors,
    with_errors_of_maps,
)

RANDOM = np.random.default_rng(20261126)
START = RANDOM.bit_generator.state


@pytest.fixture(autouse=True)
def own_draws():
    """Give every test the same draws, whichever tests ran before it."""
    RANDOM.bit_generator.state = START


def logistic(n: int, start: float) -> np.ndarray:
    """x -> 4 x (1 - x), chaotic for almost every start, with a mean of 1/2 (Ulam & von Neumann 1947)."""
    values = np.empty(n + 50)
    for k in range(n + 50):
        # rounding ends every motion of this map at 0: a little noise keeps it going
        start = min(max(4.0 * start * (1.0 - start) + 1e-12 * RANDOM.standard_normal(), 0.0), 1.0)
        values[k] = start
    return values[50:]


def forgetting(n: int, keeps: float) -> np.ndarray:
    """Gaussian noise that keeps so much of itself from value to value, with a mean of 0."""
    noise, values = RANDOM.standard_normal(n + 1000), np.zeros(n + 1000)
    for k in range(1, n + 1000):
        values[k] = keeps * values[k - 1] + noise[k]
    return values[1000:]


@some(2, "seconds of maps")
@pytest.mark.parametrize("name", ["logistic", "forgets at once", "forgets in 10", "forgets in 100"])
def test_two_standard_errors_cover_the_mean_of_chaos(name):
    keeps = {"forgets at once": 0.0, "forgets in 10": 0.9, "forgets in 100": 0.99}

    def motion() -> np.ndarray:
        return logistic(512, RANDOM.uniform(0.1, 0.9)) if name == "logistic" else forgetting(512, keeps[name])

    true = 0.5 if name == "logistic" else 0.0
    found = [long_mean([motion() for _ in range(4)]) for _ in range(150)]
    off = np.array([abs(one.mean - true) / one.error for one in found])

    assert not any(one.quasi_periodic for one in found)
    assert (off <= 1.0).mean() >= 0.92  # 95.4 % are meant; 150 draws leave 2 % of doubt
    assert (off > 2.5).mean() == 0.0
    assert (off > 0.3).mean() > 0.1  # not by errors that are far too large: a quarter, where memory is long


def test_quasi_periodic_means_converge_faster_than_any_power():
    turns = (math.sqrt(5.0) - 1.0) / 2.0
    errors = []
    for n in (128, 512, 2048):
        phases = 2.0 * math.pi * turns * np.arange(n)
        motions = [np.exp(np.sin(phases + start)) for start in (0.0, 1.0, 2.5)]
        found = long_mean(motions)
        errors.append(abs(found.mean - 1.2660658777520084))  # I_0(1)
        assert errors[-1] <= found.error + 1e-14
    assert found.quasi_periodic
    assert errors[1] < 1e-4 * errors[0]
    assert errors[2] < 1e-13
    assert abs(motions[0].mean() - 1.2660658777520084) > 1e-5  # a plain mean


def test_weighted_means_keep_constants():
    assert birkhoff_mean(np.full(100, 0.3)) == pytest.approx(0.3, abs=1e-14)
    assert long_mean([np.full(512, 0.3)] * 2).mean == pytest.approx(0.3, abs=1e-14)


def test_a_period_longer_than_any_that_is_looked_for_before_is_found_late():
    angles = 2.0 * math.pi * 5.0 / 13.0 * np.arange(200)
    locked = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    angles = 2.0 * math.pi * (math.sqrt(5.0) - 1.0) / 2.0 * np.arange(200)
    unlocked = np.stack([np.cos(angles), np.sin(angles)], axis=1)

    assert late_period(locked) == 13
    assert late_period(unlocked) == 0


@deep("seconds of maps")
def test_a_slider_shaken_in_si_units_has_its_long_mean():
    """LuGre at 60 Hz and 2 mm/s: 20 N on 0.5 kg, 5,000 N/m and 5 N s/m, a belt shaken by 5 um."""
    shaken = 2.0 * math.pi * 60.0
    scene = fl.Scene(
        dimensional={
            "mass_kg": 0.5,
            "stiffness_N_per_m": 5000.0,
            "damping_N_s_per_m": 5.0,
            "length_m": 1e-6,
            "normal_load_N": 20.0,
            "belt_speed_m_per_s": 2e-3,
            "belt_vibration": {"velocity_amplitude_m_per_s": 5e-6 * shaken, "frequency_rad_per_s": shaken},
        }
    )
    law = fl.LuGre(mu_kinetic=0.3, mu_static=0.4, stribeck_speed=1e-3, presliding_length=1e-6, damping=0.0)
    state = fl.steady_state(scene, law)

    assert (state.status, state.error_kind, state.unique) == ("ok", "statistical", "tested")
    assert "does not repeat (chaotic)" in state.reason
    assert state.error < 5e-4
    assert abs(state.mean_friction - 0.30565) < 1e-4 + state.error  # .3056 to .3057 by another integration


@deep("seconds of maps")
@pytest.mark.parametrize(
    "law", [fl.Stribeck(mu_kinetic=0.3, mu_static=0.4), fl.Dahl(mu=0.4, presliding_length=0.01)]
)
def test_a_motion_that_grows_for_ever_has_no_mean(law):
    """Undamped resonance: friction below pi/4 of the load does not bound the amplitude."""
    scene = fl.Scene(
        damping_ratio=0.0, normal_load=10.0, belt_speed=5.0, drive=fl.Drive(amplitude=10.0, frequency=1.0)
    )
    state = fl.steady_state(scene, law, tolerance=1e-6)

    assert state.status == "failed"
    assert "at undamped resonance the amplitude may grow without bound" in state.reason


def test_what_grows_or_dies_out_in_every_part_drifts():
    rising = np.linspace(100.0, 101.0, 512)
    wobble = np.sin(np.arange(512.0))

    assert drifts(rising + wobble)
    assert drifts(-rising + wobble)
    assert not drifts(wobble)


def test_a_motion_that_beats_too_slowly_to_tell_from_one_that_grows_shares_the_mean_of_another():
    scene = fl.Scene(
        damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1)
    )
    problem = PeriodicProblem(scene, fl.Stribeck(mu_kinetic=0.3, mu_static=0.4), 1e-8)
    start = Attractor(0, 0, 0.0, 0.0, None, problem.state_at(5.0, None)[None, :])
    phases = 2.0 * math.pi * (math.sqrt(5.0) - 1.0) / 2.0 * np.arange(512)

    def motion(around: float, phase: float, grows: float) -> LongMotion:
        made = LongMotion(problem, scene, start)
        made.means = around + np.sin(phases + phase)
        made.sizes = 100.0 + np.sin(phases + phase) + grows * np.arange(512)
        return made

    steady, beating, other = motion(0.2, 0.0, 0.0), motion(0.2, 1.0, 0.1), motion(0.3, 2.0, 0.1)
    assert steady.stays
    assert not beating.stays
    found = means_of_attractors({0: steady, 1: beating, 2: other})

    assert found.keys() == {0, 1}
    assert found[1] is found[0]


@pytest.mark.parametrize(("a_go", "has_mean"), [(130, True), (90, False)])
def test_a_motion_of_many_steps_is_averaged_where_three_goes_are_enough(a_go, has_mean):
    scene = fl.Scene(
        damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1)
    )
    problem = PeriodicProblem(scene, fl.Stribeck(mu_kinetic=0.3, mu_static=0.4), 1e-8)
    followed = FollowedStarts(problem, scene, None)
    state = problem.state_at(5.0, None)
    followed.reached.append(Attractor(500, 0, 0.0, 1.0, None, state[None, :]))

    def few(speed, state, periods, accuracy):
        means = RANDOM.uniform(0.2, 0.4, min(a_go, periods))
        states = RANDOM.uniform(-1.0, 1.0, (len(means), len(state)))
        return Transient(0, means, states, states[-1], 0.0)

    problem.followed_on = few
    average_unrepeated(problem, scene, followed)

    assert (followed.reached[0].average is not None) is has_mean
    assert followed.reached[0].followed == (3 * a_go if has_mean else 500)


def test_chaos_that_lingers_elsewhere_for_hundreds_of_periods_counts_for_what_it_joins():
    """Of many steps, so that three goes end before it joins."""
    scene = fl.Scene(
        damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1)
    )
    problem = PeriodicProblem(scene, fl.Stribeck(mu_kinetic=0.3, mu_static=0.4), 1e-8)
    states = np.repeat(problem.state_at(5.0, None)[None, :], 4, axis=0)
    states[:, 0] = 0.0, 0.0, -700e-9, -1.0  # a clock: where it is negative, the motion has not joined yet

    def many_steps(speed, state, periods, accuracy):
        count = min(214, periods)
        path = RANDOM.uniform(-1.0, 1.0, (count, len(state)))
        path[:, 0] = state[0] + 1e-9 * np.arange(1, count + 1)
        around = np.where(path[:, 0] < 0.0, 0.35, 0.37)
        return Transient(0, around + RANDOM.uniform(-0.01, 0.01, count), path, path[-1], 0.0)

    problem.followed_on = many_steps
    means = {}
    for other in (2, 3):
        followed = FollowedStarts(problem, scene, None)
        followed.reached += [Attractor(500, 0, 0.0, 1.0, None, states[k : k + 1]) for k in (0, 1, other)]
        average_unrepeated(problem, scene, followed)
        means[other] = [one.average for one in followed.reached]

    assert len(set(means[2])) == 1
    assert abs(means[2][0].mean - 0.37) < means[2][0].error + 1e-3
    assert len(set(means[3])) == 2


def test_a_quasi_periodic_mean_is_not_told_closer_than_its_maps():
    """A weighted mean repeats to rounding; finer maps move it by more than that."""
    scene = fl.Scene(
        damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1)
    )
    problem = PeriodicProblem(scene, fl.Stribeck(mu_kinetic=0.3, mu_static=0.4), 1e-8)
    start = Attractor(0, 0, 0.0, 0.0, None, problem.state_at(5.0, None)[None, :])
    motion = LongMotion(problem, scene, start)
    motion.follow(512)
    steady, wild = LongMean(0.3, 1e-15, True), LongMean(0.2, 1e-3, False)
    found = with_errors_of_maps({0: motion, 1: motion}, {0: steady, 1: steady, 2: wild})

    assert found[0] is found[1]
    assert found[0].mean == 0.3
    assert found[0].error == pytest.approx(1e-15 + 2.0 * motion.off_by_maps())
    assert 1e-14 < motion.off_by_maps() < 1e-5
    assert found[2] is wild


@deep("chaos of a stiff bristle takes many steps")
def test_a_start_that_passes_by_an_orbit_which_repels_is_followed_on_to_its_long_mean():
    tip = fl.Scene.si(
        mass="1e-11 kg",
        stiffness="1 N/m",
        damping_ratio=0.01,
        normal_load="10 nN",
        belt_speed="1 um/s",
        normal_load_variation={"amplitude": 0.5, "frequency": "40 kHz", "contact": "constant"},
    )
    state = fl.steady_state(tip, fl.Dahl(mu=0.1, presliding_length=0.3e-9))

    assert state.status == "ok"
    assert "chaotic" in state.reason
    assert 0.05 < state.mean_friction < 0.055


@deep("seconds of steps")
def test_where_an_orbit_repels_motions_that_never_repeat_have_a_long_mean():
    """Bristles of constant contact under a square normal load: the orbit of one period has a multiplier of 1.6."""
    scene = fl.Scene(
        damping_ratio=0.17521587733291477,
        normal_load=0.27365081285124804,
        normal_load_variation={
            "waveform": "square",
            "phase": 193.24079948189194,
            "amplitude": 0.23361105079360167,
            "frequency": 2.165853915667782,
            "contact": "constant",
        },
        belt_speed=0.031018767596622785,
    )
    state = fl.steady_state(scene, fl.Dahl(mu=0.8690975812796703, presliding_length=0.039844205871870646))

    assert (state.status, state.error_kind) == ("ok", "statistical")
    assert "does not repeat (chaotic)" in state.reason
    assert state.error < 3e-4
    assert abs(state.mean_friction - 0.87033) < state.error + 3e-4
