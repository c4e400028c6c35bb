"""Joints of sliders in parallel on a belt at rest: a range of means, and what does not depend on the start."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from maxwell_slip import MaxwellSlip
from profiles import deep

import frictionlab as fl
from frictionlab.compile.call import KernelCall
from frictionlab.methods.periodic.attraction import Follow, Trail, iterate_until_periodic, unknown_orbit
from frictionlab.methods.prescribed.memory import MemoryPoint

sliders = st.tuples(st.floats(0.1, 3.0), st.floats(0.2, 2.0))
"""Reach and stiffness."""


def joint(parts: list[tuple[float, float]]) -> MaxwellSlip:
    return MaxwellSlip(mu=[reach * k for reach, k in parts], stiffness=[k for _, k in parts])


def heat_of(law: MaxwellSlip, amplitude: float) -> float:
    """Per cycle: a slider slips by what the stroke is longer than both ways to its limits (Masing)."""
    pairs = zip(law.mu, law.reach, strict=True)
    return sum(4.0 * mu * max(0.0, amplitude - reach) for mu, reach in pairs)


def most_of(law: MaxwellSlip, amplitude: float) -> float:
    """Largest mean: sliders that never slip are pushed to where they do at one end of the stroke."""
    pairs = zip(law.stiffness, law.reach, strict=True)
    return sum(k * max(0.0, reach - amplitude) for k, reach in pairs)


@settings(max_examples=20, deadline=None)
@given(parts=st.lists(sliders, min_size=3, max_size=3), amplitude=st.floats(0.05, 3.5))
def test_a_prescribed_stroke_has_a_range_of_means_and_one_heat(
    parts: list[tuple[float, float]], amplitude: float
) -> None:
    law = joint(parts)
    most = most_of(law, amplitude)
    slip = fl.Slip(velocity_amplitude=amplitude, frequency=1)

    state = fl.steady_state(fl.Scene(belt_speed=0, slip=slip), law)

    assert abs(state.energy_contact - heat_of(law, amplitude)) <= state.energy_contact_error + 1e-12
    assert state.energy_contact_error < 1e-5
    assert state.velocity_amplitude == pytest.approx(amplitude, rel=1e-9)
    assert state.stick_fraction == 0.0
    if most > 1e-5:
        assert state.status == "not_unique"
        assert (state.mean_low, state.mean_high) == pytest.approx((-most, most), abs=1e-7)
    elif most == 0.0:
        assert state.status == "ok"


@deep("more kernels to compile")
@pytest.mark.parametrize(
    ("reaches", "load", "stroke", "swing"),
    # half of the stroke and amplitude of the velocity after 12 periods of 2,000 Runge-Kutta steps from rest
    [
        ((0.2, 1.0, 2.0), 0.3, 0.1090188, 0.0545094),
        ((0.2, 1.0, 2.0), 1.0, 0.5696744, 0.3557176),
        ((0.2, 1.0, 2.0), 1.7, 0.9834071, 0.6551932),
        ((0.2, 1.0, 2.0), 3.0, 2.0246856, 0.8082049),
        ((0.1, 0.15, 1.5), 0.3, 0.1163539, 0.0574515),
        ((0.1, 0.15, 1.5), 1.0, 0.7789688, 0.4095003),
        ((0.1, 0.15, 1.5), 1.7, 1.3426786, 0.6867824),
        ((0.1, 0.15, 1.5), 3.0, 2.7727012, 1.3465767),
    ],
)
def test_a_mass_held_by_a_joint_has_a_range_of_means_one_amplitude_and_one_heat(
    reaches: tuple[float, ...], load: float, stroke: float, swing: float
) -> None:
    law = joint(list(zip(reaches, (1.0, 0.5, 0.5), strict=True)))
    drive = fl.Drive(amplitude=load, frequency=0.5)
    scene = fl.Scene(damping_ratio=0.1, normal_load=1, belt_speed=0, drive=drive)
    most = most_of(law, stroke)

    state = fl.steady_state(scene, law)

    assert state.velocity_amplitude == pytest.approx(swing, rel=1e-5)
    assert state.energy_contact == pytest.approx(heat_of(law, stroke), abs=2e-5)
    assert state.stick_fraction == 0.0
    assert state.status == ("not_unique" if most > 0.0 else "ok")
    if most > 0.0:
        assert (state.mean_low, state.mean_high) == pytest.approx((-most, most), abs=2e-5)


def test_sliders_that_meet_their_limit_as_slip_reverses_are_unloaded() -> None:
    """A stroke that ends just beyond their limits moves them by what it is beyond.

    Where both events were located at once, one in 500 of these strokes took a slider along on its way back.
    """
    amplitude, accuracy, reach = 0.1083, 1e-4, np.array([0.9, 1.3, 1.8])
    slip = fl.Slip(velocity_amplitude=amplitude, frequency=1, phase=90)
    point = MemoryPoint(fl.Scene(belt_speed=0, slip=slip), joint([(each, 1.0) for each in reach]), 1e-6)
    follow = Follow(accuracy, constant=False, whole=True)
    for beyond in accuracy * 10.0 ** np.random.default_rng(3).uniform(-7.0, 1.0, (3000, 3)):
        states = np.zeros((2, point.reached[0].size))
        states[0, 2:] = amplitude - reach - beyond
        path = unknown_orbit(len(states[0])), Trail(np.empty(1), states)
        KernelCall(iterate_until_periodic)(point.problem.maps, 0.0, point.problem.common, follow, *path)
        assert np.abs(states[1] - states[0])[2:].max() < 20 * accuracy
