"""Bounds on the mean friction along a line from any trial of the friction's signs, against the exact mean."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.reduced.friction_free_gap import closed_bound, largest_fault
from frictionlab.methods.reduced.gap import COARSE, _bounds, _Mesh, line_bounds
from frictionlab.methods.reduced.harmonic_balance import HarmonicBalance
from frictionlab.methods.reduced.mdsm import Mdsm
from frictionlab.methods.reduced.reversals import Driven, Switched, one_wave, settled
from frictionlab.methods.reduced.switching import Jumps
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Drive, Scene
from frictionlab.theory import friction_free_velocity

LAW = Coulomb(mu=0.4)
FREQUENCIES = st.floats(-0.7, 0.8).map(lambda exponent: 10.0**exponent)
DAMPING = st.floats(-3.0, 0.5).map(lambda exponent: 10.0**exponent)
RATIOS = st.floats(-4.0, 0.2).map(lambda exponent: 10.0**exponent)


def driven(frequency: float, damping: float, ratio: float, share: float) -> Scene:
    """Unit load; friction over load, and belt speed over V_lin."""
    drive = Drive(amplitude=1.0, frequency=frequency)
    still = Scene(damping_ratio=damping, normal_load=ratio / LAW.mu, belt_speed=0.0, drive=drive)
    return still.at(share * friction_free_velocity(still))


def body_of(one: Scene) -> Driven:
    """Its friction-free velocity begins at 0."""
    assert one.normal_load is not None
    free = np.array([friction_free_velocity(one) + 0j])
    return Driven(one.damping_ratio, one.frequency, LAW.mu * one.normal_load, free)


def exact_mean(scenes: list[Scene]) -> tuple[Floats, Floats]:
    """Relative to mu, and its error."""
    found = Exact().solve(scenes, LAW, 1e-10)
    return found.mean / LAW.mu, found.error / LAW.mu


@settings(derandomize=True, max_examples=40)
@given(FREQUENCIES, DAMPING, RATIOS, st.floats(1e-3, 1.0 - 1e-9), st.floats(-1.0, 1.0), st.floats(0.05, 0.95))
def test_any_signs_of_friction_bound_the_mean(frequency, damping, ratio, share, start, length) -> None:
    """Stick of the true motion included, moved to where slip vanishes or not."""
    one = driven(frequency, damping, ratio, share)
    body, speeds, period = body_of(one), np.array([one.belt_speed]), 2.0 * math.pi / frequency
    any_trial = Switched(np.array([[start, start + length]]) * period, np.array([[1.0, -1.0]]))
    (true,), (own,) = exact_mean([one])

    for low, high in (
        _bounds(body, any_trial, speeds, COARSE),
        line_bounds(body, any_trial, speeds),
        line_bounds(body, one_wave(body.free, frequency, speeds), speeds),
    ):
        assert low[0] - own <= true <= high[0] + own


@pytest.mark.parametrize("frequency", [0.7, 1.0, 1.5, 4.0])
def test_where_the_mass_never_rests_both_bounds_are_the_exact_mean(frequency: float) -> None:
    scenes = [driven(frequency, 0.1, 0.04, share) for share in np.linspace(0.3, 0.95, 14)]
    body, speeds = body_of(scenes[0]), np.array([one.belt_speed for one in scenes])
    true, _ = exact_mean(scenes)

    low, high = line_bounds(body, one_wave(np.repeat(body.free, 14), frequency, speeds), speeds)

    np.testing.assert_allclose(low, true, rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(high, true, rtol=0.0, atol=1e-10)


def test_more_switches_that_change_nothing_leave_the_bounds_as_they_are() -> None:
    scenes = [driven(1.3, 0.1, 0.5, share) for share in (0.3, 0.6, 0.9)]
    body, speeds = body_of(scenes[0]), np.array([one.belt_speed for one in scenes])
    trial = one_wave(np.repeat(body.free, 3), 1.3, speeds)
    more = Switched(np.repeat(trial.switches, 2, axis=1), np.repeat(trial.signs, 2, axis=1))
    twice = Switched(
        np.concatenate([trial.switches, trial.switches + 2.0 * math.pi / 1.3], axis=1),
        np.tile(trial.signs, 2),
    )
    slower = body._replace(frequency=0.65, free=np.array([0.0, body.free[0]]))

    fine = _Mesh(1e-4, 300, 600)
    plain = _bounds(body, trial, speeds, fine)

    np.testing.assert_allclose(_bounds(body, more, speeds, fine), plain, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(_bounds(slower, twice, speeds, fine), plain, rtol=0.0, atol=1e-4)


@pytest.mark.parametrize(("start", "length"), [(0.05, 0.35), (0.1, 0.5), (-0.1, 0.2)])
def test_the_bounds_are_the_largest_and_least_mean_that_the_gap_allows(start: float, length: float) -> None:
    """Friction turned round where slip of the linear response is smallest, by its Fourier series, up to the gap."""
    one = driven(1.3, 0.1, 0.2, 0.5)
    body, speeds, period = body_of(one), np.array([one.belt_speed]), 2.0 * math.pi / 1.3
    trial = Switched(np.array([[start, start + length]]) * period, np.array([[1.0, -1.0]]))
    at = (np.arange(20_000) + 0.5) / 20_000
    signs = np.where(np.mod(at - start, 1.0) < length, 1.0, -1.0)
    orders = np.arange(1, 4_000)
    ends = np.exp(-2j * np.pi * orders * start), np.exp(-2j * np.pi * orders * (start + length))
    rates = 1.3 * orders
    waves = np.zeros(10_001, np.complex128)
    waves[orders] = (ends[0] - ends[1]) / (1j * np.pi * orders) / (0.2 + 1j * (rates - 1.0 / rates))
    turned = waves * np.exp(1j * np.pi * np.arange(10_001) / 20_000)
    slip = body.free_velocity(at * period)[0] - 20_000 * body.friction * np.fft.irfft(turned) - speeds[0]
    gap = np.mean(np.abs(slip) - signs * slip)

    wanted = []
    for side in (1.0, -1.0):
        against = np.sort(np.abs(slip[side * slip < 0.0]))
        count = np.searchsorted(np.cumsum(2.0 * against) / 20_000, gap)
        wanted.append(-side * np.mean(np.sign(slip)) - 2.0 * count / 20_000)

    low, high = _bounds(body, trial, speeds, _Mesh(1e-4, 300, 600))
    assert wanted[0] - 3e-3 <= low[0] <= wanted[0] + 3e-4  # the samples tell a mean to 1e-4
    assert -wanted[1] - 3e-4 <= high[0] <= -wanted[1] + 3e-3


def test_the_gap_of_a_trial_falls_with_its_fault_squared_and_the_bounds_with_its_fault() -> None:
    one = driven(1.3, 0.1, 0.1, 0.5)
    body, speeds = body_of(one), np.array([one.belt_speed])
    true = settled(body, one_wave(body.free, 1.3, speeds), speeds)

    widths = []
    for late in (0.1, 0.05, 0.025):
        low, high = _bounds(body, Switched(true.switches + late, true.signs), speeds, COARSE)
        widths.append(high[0] - low[0])

    np.testing.assert_allclose(np.divide(widths[:-1], widths[1:]), 2.0, rtol=0.1)


@settings(derandomize=True, max_examples=40)
@given(FREQUENCIES, DAMPING, st.floats(-9.0, 0.0).map(lambda e: 10.0**e), st.floats(1e-3, 1.0 - 1e-9))
def test_the_closed_form_covers_what_the_friction_free_motion_leaves_out(
    frequency, damping, ratio, share
) -> None:
    one = driven(frequency, damping, ratio, share)
    (true,), (own,) = exact_mean([one])
    closed = 2.0 / math.pi * math.asin(one.belt_speed / friction_free_velocity(one))

    assert abs(closed - true) <= closed_bound(body_of(one), np.array([one.belt_speed]))[0] + own


def test_the_closed_form_is_of_the_order_of_the_error() -> None:
    scenes = [driven(1.0, 0.1, 0.001, share) for share in (0.2, 0.5, 0.9)]
    body, speeds = body_of(scenes[0]), np.array([one.belt_speed for one in scenes])
    left_out = np.abs(2.0 / np.pi * np.arcsin(speeds / body.free[0].real) - exact_mean(scenes)[0])

    assert np.all(closed_bound(body, speeds) < 12.0 * left_out)
    weaker = body._replace(friction=0.5 * body.friction)
    np.testing.assert_allclose(closed_bound(body, speeds) / closed_bound(weaker, speeds), 2.0, rtol=0.02)


@given(FREQUENCIES, st.sampled_from([0.0, 0.03, 0.5, 1.0, 1.2, 6.0]), st.floats(0.02, 1.5))
def test_no_two_switches_move_the_velocity_by_more_than_the_largest_fault(
    frequency, damping, reversal
) -> None:
    period, apart = 2.0 * math.pi / frequency, 2.0 * reversal / frequency
    assume(damping > 0.0 or abs(math.sin(0.5 * period)) > 0.05)
    jumps = Jumps.of(damping, frequency)
    at = np.linspace(0.0, period, 400)

    answer = 2.0 * (jumps.rise(at) - jumps.rise(np.mod(at - apart, period)))

    most = largest_fault(Driven(damping, frequency, 1.0, np.array([1.0 + 0j])), np.array([reversal]))[0]
    assert np.abs(answer).max() <= most * (1.0 + 1e-6)


def test_a_tolerance_above_the_closed_form_is_met_with_a_guaranteed_error() -> None:
    scenes = [driven(1.5, 0.1, 1e-4, share) for share in (0.2, 0.8, 1.2)]
    loose, tight = (Mdsm().solve(scenes, LAW, tolerance) for tolerance in (1e-3, 1e-9))
    true, own = exact_mean(scenes)

    assert loose.error_kind == ["guaranteed"] * 3
    assert tight.error_kind == ["estimated", "estimated", "guaranteed"]
    for found in (loose, tight):
        assert np.all(np.abs(found.mean / LAW.mu - true) <= found.error / LAW.mu + own)
    assert loose.error.max() <= 1e-3
    assert np.all(tight.error[:2] < loose.error[:2])


@pytest.mark.parametrize("method", [Mdsm(), HarmonicBalance()])
def test_no_useful_bound_is_refused_and_the_remedy_works(method: Mdsm | HarmonicBalance) -> None:
    one = driven(0.5, 0.05, 0.9, 0.5)
    told = type(method)(error="distance")

    refused, found = method.solve([one], LAW, 1e-8), told.solve([one], LAW, 1e-8)

    assert refused.status == ["refused"]
    assert "error: distance" in refused.reason[0]
    assert found.status == ["ok"]
    assert abs(found.mean[0] / LAW.mu - exact_mean([one])[0][0]) <= found.error[0] / LAW.mu
