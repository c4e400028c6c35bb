"""When a mass may stay on its belt for good, and when all motions converge: with waveforms, belts, normal loads."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.stribeck import Stribeck
from frictionlab.runner.steady_state import steady_state
from frictionlab.scene.scene import Scene
from frictionlab.theory.rest import (
    can_hold,
    falls_slowly,
    is_convergent,
    is_unique,
    largest_normal_load,
    resting_range,
    stays_at_rest,
)

LAW = Coulomb(mu=0.5)
PULSATING = {"amplitude": 0.5, "phase": 90.0}  # normal load 2 (1 + .5 cos)
waveforms = st.sampled_from(["sine", "square", "triangle", "sawtooth"])
angles = st.floats(0.0, 360.0)


def scene(**keys: Any) -> Scene:
    given = {"damping_ratio": 0.1, "normal_load": 2.0, "belt_speed": 0.0}
    return Scene(**{**given, "drive": {"amplitude": 0.7, "frequency": 1.0}, **keys})


def test_a_normal_load_that_sinks_holds_less() -> None:
    assert resting_range(scene(), LAW) == pytest.approx(0.15, abs=1e-9)  # (1 - .7)/2
    # |.7 sin - k| <= 1 + .5 cos: k between -m and m, m the least of 1 + .5 cos - .7 sin
    left = 1.0 - math.hypot(0.5, 0.7)
    pulsating = scene(normal_load_variation=PULSATING)
    assert resting_range(pulsating, LAW) == pytest.approx(0.5 * left, abs=1e-5)
    assert stays_at_rest(pulsating, LAW)
    lighter = scene(normal_load_variation={**PULSATING, "amplitude": 0.8})
    assert not stays_at_rest(lighter, LAW)
    assert not can_hold(lighter, LAW)


@pytest.mark.parametrize("law", [LAW, Coulomb(mu=0.4, mu_static=0.5)])
def test_the_mean_of_a_load_is_carried_by_the_spring_and_moves_no_range(law: Coulomb) -> None:
    """A square of amplitude .3, up for .3 of the period, is .42 above and .18 below its mean."""
    for load, above, below in (
        ({"offset": 0.8}, 0.3, 0.3),
        ({"waveform": {"square": {"duty": 0.3}}}, 0.42, 0.18),
    ):
        held = scene(drive={"amplitude": 0.3, "frequency": 1.0, **load})
        state = steady_state(held, law)
        assert resting_range(held, law) == pytest.approx((1.0 - below) / 2.0, abs=1e-9)
        assert (state.mean_low, state.mean_high) == pytest.approx(
            (above / 2 - 0.5, 0.5 - below / 2), abs=1e-9
        )


def test_a_range_of_rest_need_not_be_about_zero() -> None:
    heavy_forward = scene(normal_load_variation={"amplitude": 0.5})  # pressed where the load pushes forward
    low, high = -resting_range(heavy_forward, LAW, -1.0), resting_range(heavy_forward, LAW)
    # .7 sin - k <= 1 + .5 sin and k - .7 sin <= 1 + .5 sin: k in [-.8, -.2] about -.5
    assert 2 * low == pytest.approx(-0.8, abs=1e-5)
    assert 2 * high == pytest.approx(-0.2, abs=1e-5)
    assert stays_at_rest(heavy_forward, LAW)
    assert not can_hold(heavy_forward.model_copy(update={"normal_load": 0.9}), LAW)


def test_a_mass_may_ride_on_a_belt_that_swings_but_not_on_one_that_jumps() -> None:
    def shaken(waveform: str, amplitude: float, frequency: float) -> Scene:
        vibration = {"velocity_amplitude": amplitude, "waveform": waveform, "frequency": frequency}
        return scene(drive=None, belt_vibration=vibration)

    force = abs(1j * 2.0 + 0.2 + 1 / 2j)  # of inertia, dashpot and spring per velocity
    assert resting_range(shaken("sine", 0.4, 2.0), LAW) == pytest.approx(0.5 * (1 - 0.4 * force), abs=1e-5)
    assert stays_at_rest(shaken("triangle", 0.2, 2.0), LAW)
    assert not stays_at_rest(shaken("sine", 1.01 / force, 2.0), LAW)
    assert not stays_at_rest(shaken("square", 1e-3, 2.0), LAW)
    assert not stays_at_rest(shaken("sine", 0.1, 2.0), Dahl(mu=0.5, stiffness=1e3))


def test_loads_along_and_across_are_held_together() -> None:
    def pushed(size: float, waveform: str = "sine", ratio: float = 2.0) -> Scene:
        load = {"amplitude": size, "waveform": waveform, "frequency_ratio": ratio}
        return scene(transverse={"natural_frequency": 1.0, "damping_ratio": 0.1, "load": load})

    # of a square across, the room along is always sqrt(1 - .6^2) = .8 less the load along
    assert resting_range(pushed(0.6, "square"), LAW) == pytest.approx(0.5 * (0.8 - 0.7), abs=1e-6)
    assert not stays_at_rest(pushed(0.8, "square"), LAW)


def shaken(belt_speed: float, form: str, phases: tuple[float, float, float], **keys: Any) -> Scene:
    drive = {"amplitude": 1.5, "frequency": 1.1, "waveform": form, "phase": phases[0]}
    vibration = {"velocity_amplitude": 0.8, "waveform": form, "phase": phases[1], "frequency_ratio": 0.5}
    normal = {"amplitude": 0.4, "waveform": form, "phase": phases[2], "frequency_ratio": 2}
    parts = {"drive": drive, "belt_vibration": vibration, "normal_load_variation": normal}
    return scene(belt_speed=belt_speed, **{**parts, **keys})


def followed(where: Scene, fall: float, periods: int, steps: int = 400) -> np.ndarray:
    """x and v of three starts over time, by implicit Euler; friction .5 - fall*|w|, up to where it is .1.

    Such steps keep what the theorem says of the flow: two motions do not part where it holds.
    """
    signals = where.signals()
    h = signals.period / steps
    stiffness, damping = 1.0, where.mass().damping
    x, v = np.array([0.0, 3.0, -5.0]), np.array([0.5, -2.0, 4.0])
    left = 1.0 + damping * h + stiffness * h * h
    knee = 0.4 / fall if fall else 0.0
    path = []
    for step in range(periods * steps):
        tau = np.array((step % steps + 1) * h * (1 - 1e-12))
        belt = where.belt_speed + float(signals.belt[0](tau))
        pressed = h * (where.normal_load + float(signals.normal_load(tau)))
        free = (v + h * (float(signals.load[0](tau)) - stiffness * x)) / left - belt  # slip without friction
        push, side = pressed / left, np.sign(free)
        slow = (np.abs(free) - 0.5 * push) / (1.0 - fall * push)
        fast = np.abs(free) - 0.1 * push
        slip = np.maximum(np.where(slow < knee, slow, fast), 0.0) if fall else np.abs(free) - 0.5 * push
        v = belt + side * np.maximum(slip, 0.0)
        x = x + h * v
        path.append((x, v))
    return np.array(path)


def energies(path: np.ndarray) -> np.ndarray:
    """Of the differences of the first start's motion and the others'."""
    return ((path[:, :, :1] - path[:, :, 1:]) ** 2).sum(axis=1)


@given(speed=st.floats(0.1, 4.0), form=waveforms, phases=st.tuples(angles, angles, angles))
@settings(max_examples=5)
def test_motions_converge_wherever_the_theorem_says_so(
    speed: float, form: str, phases: tuple[float, float, float]
) -> None:
    where = shaken(speed, form, phases)
    assert is_unique(where, LAW)
    apart = energies(followed(where, 0.0, 12))

    assert np.all(np.diff(apart, axis=0) <= 1e-12 * apart[0])  # they never part
    assert apart[-1].max() <= 1e-3 * apart[0].min()


@given(form=waveforms, phases=st.tuples(angles, angles, angles))
@settings(max_examples=3)
def test_falling_friction_is_measured_under_the_largest_normal_load(
    form: str, phases: tuple[float, float, float]
) -> None:
    where = shaken(2.0, form, phases, damping_ratio=0.15)  # damping .3, normal load up to 2.8
    assert largest_normal_load(where) == pytest.approx(2.8, rel=1e-12)
    never = energies(followed(where, 0.3 / 2.8, 4))
    assert np.all(np.diff(never, axis=0) <= 1e-12 * never[0])


def test_the_theorem_says_when_it_does_not_hold() -> None:
    where = shaken(2.0, "square", (0.0, 0.0, 0.0), damping_ratio=0.15)
    falls = Stribeck(mu_kinetic=0.4, mu_static=0.5, stribeck_speed=1.0, curve="hyperbolic")
    limit = 0.3 / falls.steepest_fall()

    def pressed(least_room: float) -> Scene:
        return where.model_copy(update={"normal_load": least_room * limit / 1.4})

    assert is_unique(pressed(0.99), falls)
    assert not falls_slowly(pressed(1.01), falls)  # under the mean load alone it would
    assert not is_unique(pressed(1.01), falls)
    held = where.at(0.0).model_copy(update={"normal_load": 500.0, "belt_vibration": None})
    assert not is_unique(held, LAW)
    assert is_convergent(where.at(0.0), LAW)
    assert not is_unique(where.model_copy(update={"damping_ratio": 0.0}), LAW)
    assert not is_unique(where, Dahl(mu=0.5, stiffness=10.0))
    assert not is_unique(Scene(belt_speed=1.0, slip={"velocity_amplitude": 1.0, "frequency": 1.0}), LAW)


def test_a_mass_that_rides_on_its_belt_has_more_than_one_motion() -> None:
    still = scene(drive=None, belt_vibration={"velocity_amplitude": 0.1, "frequency": 1.0})
    path = followed(still, 0.0, 30)

    assert not is_unique(still, LAW)
    assert np.ptp(path[-1, 0]) > 0.1  # three starts, three places
    assert energies(path)[-1].max() == pytest.approx(energies(path)[-400].max(), rel=1e-6)


@pytest.mark.parametrize("phase", [0.0, 17.3, 45.0, 90.06])
def test_a_range_of_rest_does_not_hang_on_the_phase(phase: float) -> None:
    """A belt that vibrates by .6 sin(tau/2) takes the mass along: spring and inertia take .45, the dashpot .06."""
    vibration = {"velocity_amplitude": 0.3, "frequency": 0.5, "phase": phase}
    shaken = scene(drive={"amplitude": 0.7, "frequency": 0.5, "phase": phase})
    taken = scene(drive=None, belt_vibration=vibration)

    assert resting_range(shaken, LAW) == pytest.approx(0.15, abs=1e-11)
    assert resting_range(taken, LAW) == pytest.approx(0.5 - math.hypot(0.45, 0.06) / 2.0, abs=1e-11)
