"""Closed forms against quadrature, scipy's elliptic integrals, limits and numbers computed elsewhere."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.special import ellipe, ellipk

from frictionlab.scene.scene import Drive, Scene, Slip, TransverseSlip
from frictionlab.theory import (
    CONCAVE_BY_AREA,
    CONCAVE_BY_INITIAL_CURVATURE,
    Floats,
    chord_area_at_resonance,
    friction_free_velocity,
    initial_concavity,
    mean_prescribed_circular,
    mean_prescribed_longitudinal,
    mean_prescribed_transverse,
    one_harmonic_least_ratio,
    one_harmonic_velocity,
)

REFERENCE = Path(__file__).parents[1] / "reference"
MEANS = [mean_prescribed_longitudinal, mean_prescribed_transverse, mean_prescribed_circular]

slow_or_fast = st.floats(-5, 3).map(lambda exponent: 10.0**exponent)
below_one = st.floats(1e-6, 1 - 1e-6)


def _scene(frequency: float, **keys: object) -> Scene:
    drive = Drive(unbalance=10, frequency=frequency)
    return Scene(**{"damping_ratio": 0.1, "normal_load": 1, "belt_speed": 5, "drive": drive, **keys})


@pytest.mark.parametrize(
    ("file", "frequency"),
    [("sdof_fig2a_Om4_g1.csv", 4), ("sdof_fig4a_Om1.5_g10.csv", 1.5), ("sdof_fig4b_fig7a_Om1_g10.csv", 1)],
)
def test_v_lin_is_that_of_the_reference_curves(file: str, frequency: float) -> None:
    with (REFERENCE / file).open() as lines:
        expected = {float(row["V_closed_eq6"]) for row in csv.DictReader(lines)}

    assert list(expected) == pytest.approx([friction_free_velocity(_scene(frequency))], rel=1e-12)


def test_v_lin_is_infinite_at_undamped_resonance_and_zero_without_a_load() -> None:
    silent = Drive(amplitude=0, frequency=2)

    assert friction_free_velocity(_scene(1.0, damping_ratio=0)) == math.inf
    assert friction_free_velocity(_scene(2.0, drive=silent)) == 0.0


def test_v_lin_of_a_prescribed_slip_is_its_amplitude_along_the_belt() -> None:
    along = Scene(belt_speed=1, slip=Slip(velocity_amplitude=3, frequency=2, phase=40))
    across = Scene(belt_speed=1, transverse_slip=TransverseSlip(velocity_amplitude=3, frequency=2))

    assert friction_free_velocity(along) == pytest.approx(3, rel=1e-15)
    assert friction_free_velocity(across) == 0.0


@given(slow_or_fast)
def test_transverse_means_are_the_elliptic_integral(ratio: float) -> None:
    m = 1 / (1 + ratio**2)
    expected = 2 / np.pi * ratio * np.sqrt(m) * ellipk(m)

    # scipy takes m itself: where m is near 1 it has lost 1 - m to rounding, relatively 1e-16/ratio^2
    assert mean_prescribed_transverse(ratio) == pytest.approx(expected, rel=1e-13 + 1e-16 / ratio**2)


@given(below_one | st.floats(1.001, 1e3))
def test_circular_means_are_the_elliptic_integrals(ratio: float) -> None:
    m = 4 * ratio / (1 + ratio) ** 2
    expected = ((1 + ratio) * ellipe(m) - (1 - ratio) * ellipk(m)) / (np.pi * ratio)

    # this form subtracts two numbers near pi/2 and divides by the ratio; scipy has lost 1 - m near m = 1
    lost = 1e-14 * (1 + 1 / ratio) + 1e-15 / abs(1 - ratio)
    assert mean_prescribed_circular(ratio) == pytest.approx(expected, abs=lost)


def test_means_vanish_at_rest_and_follow_their_leading_terms() -> None:
    small = 1e-9
    logarithmic = 2 / np.pi * small * math.log(4 / small)

    assert [float(mean(0.0)) for mean in MEANS] == [0.0, 0.0, 0.0]
    assert mean_prescribed_longitudinal(small) == pytest.approx(2 / np.pi * small, rel=1e-12)
    assert mean_prescribed_transverse(small) == pytest.approx(logarithmic, rel=1e-12)
    assert mean_prescribed_circular(small) == pytest.approx(small / 2, rel=1e-12)


def _one_harmonic(scene: Scene, friction: float, ratio: Floats) -> tuple[Floats, Floats]:
    """Belt speed and mean friction of one harmonic, along the ratio of belt speed to velocity amplitude."""
    return ratio * one_harmonic_velocity(scene, friction, ratio), 2 / np.pi * np.arcsin(ratio)


@given(st.floats(0.01, 0.75), st.floats(0.02, 0.5))
def test_the_chord_area_at_resonance_is_the_integral_of_the_curve_of_one_harmonic(
    share: float, damping: float
) -> None:
    scene = _scene(1.0, damping_ratio=damping)
    angle = np.linspace(0, np.pi / 2, 2001)
    speed, mean = _one_harmonic(scene, 10 * share, np.sin(angle))
    u = speed / speed[-1]

    assert 2 * np.trapezoid(mean - u, u) == pytest.approx(float(chord_area_at_resonance(share)), abs=1e-6)


def test_at_resonance_curves_turn_concave_at_a_third_and_a_fifth_of_the_unbalance() -> None:
    assert pytest.approx(0.337, abs=5e-4) == CONCAVE_BY_AREA
    assert pytest.approx(0.196, abs=5e-4) == CONCAVE_BY_INITIAL_CURVATURE
    assert chord_area_at_resonance(CONCAVE_BY_AREA) == pytest.approx(0, abs=1e-15)
    assert chord_area_at_resonance(0) == pytest.approx(-0.2732, abs=5e-5)  # the arcsine
    for damping in (0.02, 0.1, 0.5):
        margin = initial_concavity(_scene(1.0, damping_ratio=damping), 10 * CONCAVE_BY_INITIAL_CURVATURE)
        assert margin == pytest.approx(0, abs=1e-14)


@given(st.floats(0.3, 3.0), st.floats(0.02, 0.5), st.floats(0.05, 0.75))
def test_a_curve_starts_concave_where_the_criterion_says_so(
    frequency: float, damping: float, share: float
) -> None:
    scene = _scene(frequency, damping_ratio=damping, drive=Drive(amplitude=3.0, frequency=frequency))
    margin = initial_concavity(scene, 3.0 * share)
    speed, mean = _one_harmonic(scene, 3.0 * share, np.array([0.0, 1e-3, 2e-3]))
    chords = np.diff(mean) / np.diff(speed)

    assume(abs(margin) > 0.02)
    assert np.sign(margin) == np.sign(chords[0] - chords[1])


def test_a_curve_that_starts_in_stick_or_without_a_drive_has_no_such_criterion() -> None:
    assert math.isnan(initial_concavity(_scene(1.0, drive=Drive(amplitude=1.0, frequency=1.0)), 0.8))
    with pytest.raises(ValueError, match="no"):
        initial_concavity(Scene(belt_speed=1, slip=Slip(velocity_amplitude=1, frequency=1)), 1.0)


def _held(damping: float, frequency: float) -> Scene:
    return _scene(
        frequency, damping_ratio=damping, belt_speed=0, drive=Drive(amplitude=1, frequency=frequency)
    )


@given(st.floats(0, 1), st.floats(0.1, 10), st.floats(0, 3), st.floats(0, 1))
def test_the_one_harmonic_velocity_solves_its_balance(damping, frequency, friction, ratio) -> None:  # type: ignore[no-untyped-def]
    scene = _held(damping, frequency)
    stiffness = math.hypot(1 - frequency**2, 2 * damping * frequency)
    assume(stiffness > 1e-6)
    held = 4 / math.pi * friction * math.sqrt(1 - ratio**2)

    velocity = float(one_harmonic_velocity(scene, friction, ratio))
    spring = (1 - frequency**2) * velocity / frequency
    damped = 2 * damping * velocity + held

    if held < 1:
        assert math.hypot(spring, damped) == pytest.approx(1, rel=1e-10)
    else:
        assert velocity == 0


def test_the_one_harmonic_velocity_loses_no_digits_where_friction_just_holds_the_load() -> None:
    scene, gap = _held(0.5, 3.0), 1e-12

    velocity = one_harmonic_velocity(scene, math.pi / 4 * (1 - gap), 0.0)

    assert velocity == pytest.approx(gap, rel=1e-3)  # P - c = gap, taken by the dashpot of 2 beta = 1 alone


def test_the_one_harmonic_curve_starts_above_zero_where_friction_holds_the_load() -> None:
    scene = _held(0.1, 0.5)

    assert one_harmonic_least_ratio(scene, math.pi / 4 * 0.999) == 0.0
    least = one_harmonic_least_ratio(scene, 1.6)  # load 2.5 against friction 4
    assert 2 / math.pi * math.asin(least) == pytest.approx(0.673, abs=5e-4)
    assert one_harmonic_velocity(scene, 1.6, least) == pytest.approx(0, abs=1e-12)
    assert one_harmonic_velocity(scene, 1.6, least + 1e-6) > 0


def test_the_circular_mean_is_continuous_where_the_slip_stops_for_an_instant() -> None:
    around = mean_prescribed_circular([1 - 1e-9, 1.0, 1 + 1e-9])

    assert around[1] == pytest.approx(2 / np.pi, rel=1e-15)
    np.testing.assert_allclose(around, around[1], rtol=1e-7)


@pytest.mark.parametrize("ratio", [0.0, 0.3, 1.0])
def test_load_and_friction_of_twice_the_size_move_the_mass_twice_as_fast(ratio: float) -> None:
    once, twice = (_scene(0.6, drive=Drive(amplitude=load, frequency=0.6)) for load in (1.5, 3.0))
    speed = one_harmonic_velocity(once, 1.0, ratio)

    assert one_harmonic_velocity(twice, 2.0, ratio) == pytest.approx(2.0 * speed, rel=1e-14)
    assert one_harmonic_least_ratio(twice, 6.0) == pytest.approx(one_harmonic_least_ratio(once, 3.0))
    assert one_harmonic_least_ratio(once, 3.0) == pytest.approx(math.sqrt(1 - (math.pi / 8) ** 2))
