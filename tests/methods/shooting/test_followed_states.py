"""Starts under friction that falls steeply: states that few of them reach, and every state along a belt speed."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import count

import numpy as np
import pytest
from outside_state import period_map
from profiles import deep, some
from truth import law_of

import frictionlab as fl
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.methods.shooting import attractors
from frictionlab.methods.shooting.driven import SteadyStates
from frictionlab.methods.shooting.followed_states import FROM_ABOVE, follow_states
from frictionlab.methods.shooting.method import Shooting

FALLS_STEEPLY = {
    "kind": "stribeck", "mu_static": 0.4, "mu_kinetic": 0.2, "stribeck_speed": 1.0, "stribeck_exponent": 1.0
}  # fmt: skip
STEEP = law_of(FALLS_STEEPLY)
DRIVEN = {"unbalance": 0.2, "frequency": 1.3}
KEYS = {"damping_ratio": 0.01, "normal_load": 10.0, "belt_speed": 0.4, "drive": DRIVEN}
SCENE = fl.Scene(**KEYS)
STICKS = fl.Scene(
    damping_ratio=0.0107, normal_load=0.1366, belt_speed=0.1105,
    drive=fl.Drive(amplitude=0.6194, frequency=0.3485, phase=34.8),
)  # fmt: skip
SHARP = fl.Stribeck(mu_static=0.4, mu_kinetic=0.1265, stribeck_speed=0.0181)
SLIPS = fl.Scene(
    damping_ratio=0.0138253, normal_load=0.172613, belt_speed=-0.109512,
    drive=fl.Drive(amplitude=1.31086, frequency=0.501718, phase=76.2182),
)  # fmt: skip
WIDE = fl.Stribeck(mu_static=0.4, mu_kinetic=0.175801, stribeck_speed=0.427633, stribeck_exponent=1.0)


def at(scene: fl.Scene, speed: float) -> fl.Scene:
    return scene.model_copy(update={"belt_speed": speed})


@some(1, "seconds of maps")
@pytest.mark.parametrize(
    ("scene", "law", "means", "finds"),
    [
        (STICKS, SHARP, (0.00866, 0.0652), "resting_starts"),
        (SLIPS, WIDE, (0.003789, -0.002665), "thrown_starts"),
    ],
)
def test_states_that_the_first_starts_miss_are_found(scene, law, means, finds, monkeypatch):
    answer = Shooting().solve([scene], law, 1e-8)

    assert answer.status == ["not_unique"]
    assert (answer.mean_low[0], answer.mean_high[0]) == pytest.approx(sorted(means), abs=1e-4)
    for name in ("resting_starts", "thrown_starts"):
        monkeypatch.setattr(attractors, name, lambda *_: [])
    assert Shooting().solve([scene], law, 1e-8).status == ["ok"], f"{finds} are not what finds it"


@deep("more kernels to compile")
@pytest.mark.parametrize(("phase", "direction"), [(65.5, 85.2), (125.5, -85.2)])
def test_beside_a_motion_that_does_not_repeat_is_an_orbit_that_starts_along_the_belt_miss(phase, direction):
    """An unrelated integration by fixed steps ends on it from three of eight starts, at a damping ratio of .002."""
    scene = fl.Scene(
        damping_ratio=0.0443, normal_load=1.545, belt_speed=0.15415,
        belt_vibration=fl.BeltVibration(
            velocity_amplitude=0.2246, frequency=1.00336, phase=phase, direction=direction
        ),
        transverse=fl.Transverse(natural_frequency=0.60346, damping_ratio=0.02),
    )  # fmt: skip
    answer = Shooting().solve([scene], fl.Coulomb(mu=0.5173, mu_static=0.6806), 1e-8)
    found = {one.period: one for one in answer.states(0)}

    assert answer.status == ["not_unique"]
    assert (found[0].mean, found[1].mean) == pytest.approx((0.52334, 0.51323), abs=2e-5)
    assert found[0].share + found[1].share == pytest.approx(1.0)


@deep("more kernels to compile")
def test_beside_stick_and_slip_that_do_not_repeat_the_mass_may_slide_on():
    """An unrelated integration by fixed steps slides on from one of eight starts, at .32936; none of ours does."""
    vibration = fl.BeltVibration(velocity_amplitude=0.434095, frequency=1.10073464, phase=48.6)
    scene = fl.Scene(damping_ratio=0.040774, normal_load=10.1503, belt_speed=0.7886, belt_vibration=vibration)
    law = fl.Stribeck(mu_kinetic=0.32936265, mu_static=0.46706881, stribeck_speed=0.10251888)
    answer = Shooting().solve([scene], law, 1e-8)
    found = {one.period: one.mean for one in answer.states(0)}

    assert answer.status == ["not_unique"]
    assert found == pytest.approx({0: 0.33841, 1: 0.32936}, abs=2e-5)


def test_an_orbit_of_a_neighbour_is_carried_on(monkeypatch):
    """One start at each belt speed: the neighbour alone says that there is another state."""
    monkeypatch.setattr(attractors, "all_starts", lambda *_: ([None], []))
    slow, fast = at(STICKS, 0.1105), at(STICKS, 0.1165)
    alone = [Shooting().solve([one], SHARP, 1e-8) for one in (slow, fast)]
    curve = Shooting().solve([slow, fast], SHARP, 1e-8)

    assert [one.status[0] for one in alone] == ["ok", "ok"]
    assert alone[1].mean[0] > 5.0 * alone[0].mean[0]
    assert curve.status[0] == "not_unique"
    assert curve.mean_high[0] > 5.0 * curve.mean_low[0]


@pytest.fixture(scope="module")
def states():
    speeds = [0.4, 0.45, 0.5]
    return follow_states([at(SCENE, speed) for speed in speeds], STEEP, 1e-8, 2)


def test_orbits_of_two_and_three_periods_live_side_by_side(states):
    found = {(one.place, one.period): one for one in states}

    assert set(found) == {(0, 3), (0, 2), (1, 3), (1, 2), (2, 2)}
    assert found[0, 2].found_from == FROM_ABOVE
    assert found[0, 3].mean == pytest.approx(0.22298, abs=1e-4)
    assert all(len(one.x) == len(one.velocity) == one.period for one in states)
    assert all(one.low < one.mean < one.high for one in states)


def test_their_points_follow_each_other_in_an_unrelated_integration(states):
    for one in states[:2]:
        path = np.column_stack([one.x, one.velocity])
        here = [period_map(KEYS, FALLS_STEEPLY, tuple(point)) for point in path.tolist()]
        assert np.array(here) == pytest.approx(np.roll(path, -1, axis=0), abs=2e-5)


def test_python_gets_them_as_a_table():
    table = fl.attractors(SCENE, STEEP, [0.5, 0.4, 0.45], starts=2)

    assert table["belt_speed"].is_monotonic_increasing
    assert table.groupby(["belt_speed", "state"]).size().tolist() == [3, 2, 3, 2, 2]
    assert (
        table.groupby(["belt_speed", "state"]).size() == table[table["point"] == 1]["period"].tolist()
    ).all()
    alone = fl.attractors(SCENE, fl.Coulomb(mu=0.4), [0.4])
    mean = fl.steady_state(SCENE, fl.Coulomb(mu=0.4)).mean_friction
    assert alone["period"].tolist() == [1]
    assert alone["mean_friction"][0] == pytest.approx(mean, abs=1e-8)
    with pytest.raises(ValueError, match="starts"):
        fl.attractors(SCENE, STEEP, [0.4], starts=0)


SWUNG = fl.Scene(
    damping_ratio=0.1, normal_load=10.0, belt_speed=5.0, drive=fl.Drive(unbalance=10.0, frequency=1.0)
)
FALLS = fl.Stribeck(mu_kinetic=0.3, mu_static=0.4)


def stop_some(monkeypatch, which) -> None:
    """As for too many steps, after three periods, those of these places among the starts that are followed."""
    follow, places = attractors.PeriodicProblem.carried, count()

    def stopped(problem, speed, state, patience, known):
        stop = which(next(places))
        return follow(problem, speed, state, 3 if stop else patience, None if stop else known)

    monkeypatch.setattr(attractors.PeriodicProblem, "carried", stopped)


@pytest.mark.parametrize("given", [None, fl.Initial(x=0.1)])
def test_a_start_that_was_stopped_says_nothing_of_where_it_leads(given, monkeypatch):
    scene = SWUNG.model_copy(update={"initial": given})
    whole = Shooting().solve([scene], FALLS, 1e-8)
    stop_some(monkeypatch, lambda place: place == 0)
    answer = Shooting().solve([scene], FALLS, 1e-8)

    assert (whole.status, whole.unique) == (["ok"], ["tested"])
    assert answer.status == ["ok"]
    assert answer.mean[0] == pytest.approx(whole.mean[0], abs=1e-9)
    assert answer.unique == [""]
    assert re.search(r"1 of \d+ starts were followed for 3 drive periods only", answer.reason[0])


def test_starts_that_were_all_stopped_find_nothing(monkeypatch):
    stop_some(monkeypatch, lambda place: True)
    answer = Shooting().solve([SWUNG], FALLS, 1e-8)

    assert answer.status == ["failed"]
    assert "2 of 2 starts were followed for 3 drive periods only" in answer.reason[0]


def test_states_that_differ_but_in_their_mean_have_that_mean():
    """As next to a period doubling: one orbit entered as if it took two periods."""
    states = SteadyStates([SWUNG], PeriodicProblem(SWUNG, FALLS, 1e-8))
    states.close_all([0])
    states.check_attraction(0)
    before = states.mean[0], states.unique[0]
    reached = states.followed[0].reached
    reached[-1] = replace(reached[-1], period=2)
    states._judge_starts(0)

    assert (states.status[0], states.unique[0]) == ("ok", "no")
    assert states.mean[0].real == before[0].real
    assert "states that differ have this mean: an orbit of one drive period" in states.reason[0]
