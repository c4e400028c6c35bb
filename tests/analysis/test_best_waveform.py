"""The best waveform: no better than closed forms allow, as strong as the sine, never worse than it, bad questions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from profiles import deep

import frictionlab as fl
from frictionlab.analysis.fit.best_waveform import evolve

pytestmark = deep("seconds of search")

SCENE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
QUICK = fl.Scene(
    damping_ratio=0.05, normal_load=0.1, belt_speed=0.5, drive=fl.Drive(amplitude=30, frequency=30)
)
SLIP = fl.Scene(belt_speed=0.5, slip=fl.Slip(velocity_amplitude=1, frequency=1))
LAW = fl.Coulomb(mu=0.4)
AGAINST = SCENE.with_(
    {"drive.unbalance": 0.1, "drive.phase": 180}, belt_vibration=fl.BeltVibration(velocity_amplitude=20)
)
"""The drive brakes a body that the belt shakes."""


def test_evolution_finds_where_a_function_has_a_cusp() -> None:
    place = np.array([0.7, -0.2, 0.4])
    found, value = evolve(lambda x: math.sqrt(float(np.abs(x - place).sum())), np.zeros(3), 0, 1e-5)
    assert found == pytest.approx(place, abs=1e-3)
    assert value < 0.05


def test_no_slip_does_better_than_one_that_creeps_ahead_of_the_belt() -> None:
    """Just above belt speed for a share p of the period, quickly back for the rest: mean friction mu (1 - 2 p).

    It does not drift, hence p/(1 - p) = rms^2/v_b^2, here 2.
    """
    found = fl.best_waveform(SLIP, fl.Coulomb(mu=1), harmonics=2, equal="rms", starts=1)
    assert -1.0 / 3.0 < found.mean_friction < 0.9 * found.sine_mean_friction
    assert found.sine_mean_friction == pytest.approx(2.0 / math.pi * math.asin(0.5))


def test_no_quick_force_does_better_than_one_that_rests_for_long() -> None:
    """A body that only its inertia holds: its velocity stays at the belt's but for one parabola back.

    That takes a share q of the period, at equal rms q^3 = 12 v_b^2/(rms^2 T^2); mean friction mu (2 q - 1).
    """
    found = fl.best_waveform(QUICK, fl.Coulomb(mu=1), harmonics=2, equal="rms", starts=1)
    share = (12.0 * 0.5**2 / (0.5 * 30.0**2 * (2.0 * math.pi / 30.0) ** 2)) ** (1.0 / 3.0)
    assert 2.0 * share - 1.0 < found.mean_friction < found.table["mean_friction"].iloc[:4].min()


def test_at_equal_largest_value_a_square_wave_does_better_than_a_sine() -> None:
    """As in Michaux, Ferri & Cunefare: v_b/(pi/2) and (2/pi) arcsin(v_b)."""
    found = fl.best_waveform(QUICK, fl.Coulomb(mu=1), harmonics=1, equal="amplitude", starts=1)
    told = found.table.set_index("waveform")["mean_friction"]
    assert told["square"] == pytest.approx(1.0 / math.pi, abs=1e-3)
    assert told["sine"] == pytest.approx(1.0 / 3.0, abs=1e-3)


@pytest.mark.parametrize("equal", ["power", "amplitude", "rms"])
def test_every_waveform_is_as_strong_as_the_sine_and_the_best_is_lower(equal: Any) -> None:
    found = fl.best_waveform(SCENE, LAW, harmonics=2, equal=equal, starts=1)
    assert found.table[equal].to_numpy() == pytest.approx(1.0, abs=1e-8)
    assert found.mean_friction < found.sine_mean_friction - found.error
    there = fl.steady_state(SCENE.with_(drive=found.drive), LAW)
    assert there.mean_friction == pytest.approx(found.mean_friction, abs=1e-9)
    sine = fl.steady_state(SCENE, LAW)
    assert found.sine_mean_friction == pytest.approx(sine.mean_friction, abs=1e-12)
    if equal == "power":
        assert there.energy_input == pytest.approx(sine.energy_input, rel=1e-7)


@pytest.mark.parametrize("equal", ["power", "rms"])
def test_of_one_harmonic_the_sine_is_the_best(equal: Any) -> None:
    found = fl.best_waveform(SCENE, LAW, harmonics=1, equal=equal, starts=2)
    assert found.mean_friction == pytest.approx(found.sine_mean_friction, abs=1e-12)
    assert found.agreeing == found.starts == 2


def test_the_highest_is_above_the_sine_and_below_steady_sliding() -> None:
    found = fl.best_waveform(SCENE, LAW, harmonics=2, equal="rms", goal="highest", starts=1)
    assert found.sine_mean_friction + 0.05 < found.mean_friction <= 0.4


def test_a_drive_turns_across_a_quick_belt() -> None:
    """Slip along a belt quicker than itself never reverses: friction falls by slip across it alone."""
    scene = SLIP.with_(belt_speed=1.2)
    found = fl.best_waveform(scene, LAW, harmonics=1, direction=True, equal="rms", starts=1)
    across = fl.steady_state(scene.with_({"slip.direction": 90.0}), LAW)
    assert found.mean_friction == pytest.approx(across.mean_friction, abs=1e-4)
    assert abs(found.drive.direction) == pytest.approx(90.0, abs=3.0)


def test_a_scene_in_si_units_gets_a_drive_in_them() -> None:
    body = {"mass": "1 kg", "stiffness": "400 N/m", "damping": "4 N s/m", "normal_load_N": 4.0}
    drive = {"amplitude": "4 N", "frequency_rad_per_s": 20}
    scene = fl.Scene.si(**body, belt_speed="100 mm/s", drive=drive)
    found = fl.best_waveform(scene, LAW, harmonics=2, equal="rms", starts=1)
    there = fl.steady_state(scene.with_({"dimensional.drive": found.drive}), LAW)
    assert there.mean_friction == pytest.approx(found.mean_friction, abs=1e-8)
    assert found.mean_friction < 0.9 * found.sine_mean_friction
    soft = fl.Dahl(mu=0.4, presliding_length="0.1 mm")
    sine = fl.best_waveform(scene, soft, harmonics=1, equal="rms", starts=1).sine_mean_friction
    assert sine == pytest.approx(fl.steady_state(scene, soft).mean_friction, abs=1e-8)


def test_the_figure_shows_drive_and_motion() -> None:
    found = fl.best_waveform(SCENE, LAW, harmonics=1, equal="rms", starts=1)
    drive, velocity = found.plot().axes
    assert (len(drive.lines), len(velocity.lines)) == (2, 3)
    slip = fl.best_waveform(SLIP, LAW, harmonics=1, equal="rms", starts=1)
    assert len(slip.plot().axes) == 1


@pytest.mark.parametrize(
    ("scene", "asked", "said"),
    [
        (SCENE, {"equal": "force"}, "equal must be 'power' or 'amplitude' or 'rms', got 'force'"),
        (SCENE, {"goal": "least"}, "goal must be 'lowest' or 'highest', got 'least'"),
        (SCENE, {"harmonics": 0}, "harmonics"),
        (SCENE, {"harmonics": 65}, "harmonics must be at most 64, got 65"),
        (SCENE, {"direction": True}, "transverse"),
        (SLIP, {}, "a prescribed slip has no body to put power into"),
        (fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5), {}, "has no drive and no slip"),
        (AGAINST, {}, "the sine puts no power into the body"),
    ],
)
def test_bad_questions_are_told(scene: fl.Scene, asked: dict[str, Any], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        fl.best_waveform(scene, LAW, **asked)
