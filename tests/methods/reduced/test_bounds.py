"""Bounds from motions that reverse twice a period, against exact references and their own limits."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from answered import with_columns
from hypothesis import given
from hypothesis import strategies as st

from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.reduced.bounds import Line, _free, bounds, consistent, motions
from frictionlab.numerics.roots import monotone_root
from frictionlab.scene.scene import Drive, Scene
from frictionlab.theory import friction_free_velocity

REFERENCE = Path(__file__).parents[2] / "reference"
FILES = sorted(REFERENCE.glob("sdof_fig*.csv"))


def line(frequency=1.0, friction=0.4, damping=0.1):
    """A load of 10 Omega^2."""
    stiffness = abs(1 - frequency**2 + 2j * damping * frequency)
    free = 10 * frequency**3 / stiffness if stiffness else math.inf
    return Line(damping, frequency, friction, free)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_where_the_mass_never_sticks_both_bounds_are_the_exact_mean(file: Path) -> None:
    with file.open() as lines:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(lines)]
    frequency, load = file.stem.split("_Om")[1].split("_g")
    speeds, exact, stuck = (
        np.array([row[name] for row in rows]) for name in ("v_b", "mu_bar_exact", "stick_fraction")
    )

    low, high = bounds(line(float(frequency), 0.4 * float(load)), speeds)

    np.testing.assert_allclose(low[stuck == 0.0], exact[stuck == 0.0] / 0.4, rtol=0, atol=2e-11)
    np.testing.assert_array_equal((high > low)[stuck == 0.0], False)
    assert np.all(low[stuck > 0.0] <= exact[stuck > 0.0] / 0.4 + 1e-11)
    assert np.all(high[stuck > 0.0] >= exact[stuck > 0.0] / 0.4 - 1e-11)
    assert np.all((high - low)[stuck > 0.0] < 0.15)


@pytest.mark.parametrize(
    ("damping", "frequency", "friction", "load", "peak"),
    [
        (0.1, 1.0, 4.0, 10.0, 24.50073798),
        (0.02, 2.0, 0.25, 1.0, 0.30605922),
        (0.05, 0.8, 0.3, 1.0, 2.34687197),
    ],
)
def test_with_the_belt_at_rest_the_motion_is_den_hartogs(damping, frequency, friction, load, peak) -> None:
    free = load * frequency / abs(1 - frequency**2 + 2j * damping * frequency)
    body, half = Line(damping, frequency, friction, free), math.pi / frequency
    found, green = motions(body, np.array([0.5])), _free(body)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    since = 0.5 * half * (1.0 + nodes)
    drive = free * np.sin(found.middle[0] - 0.5 * math.pi + frequency * since)
    velocity = drive - 2 * friction * (green.rise(since) - green.rise(since + half))

    assert found.belt_speed[0] == pytest.approx(0.0, abs=1e-12)
    assert consistent(body, found)[0]
    assert 0.25 * half * (weights @ velocity) == pytest.approx(peak, rel=1e-7)  # from -peak to peak: twice


@pytest.mark.parametrize("ratio", [0.1, 0.2])
def test_a_slow_drive_makes_the_free_oscillation_reverse_the_slip_once_more(ratio: float) -> None:
    one = Scene(
        damping_ratio=0.05,
        normal_load=ratio / 0.4,
        belt_speed=0.0,
        drive=Drive(amplitude=1.0, frequency=0.5),
    )
    free = friction_free_velocity(one)
    speed = (0.7 if ratio == 0.1 else 0.5) * free
    exact = with_columns(
        Exact(), [one.model_copy(update={"belt_speed": speed})], Coulomb(mu=0.4), 1e-9
    ).columns
    body = Line(0.05, 0.5, ratio, free)
    shares = np.linspace(0.01, 0.5, 2000)
    found = motions(body, shares)
    nearest = np.nanargmin(np.abs(found.belt_speed - speed))

    low, high = bounds(body, np.array([speed]))

    assert abs(1 - 2 * shares[nearest] - exact["mean_friction"][0] / 0.4) > 0.01
    assert low[0] <= exact["mean_friction"][0] / 0.4 <= high[0]
    assert low[0] < high[0]


@pytest.mark.parametrize("damping", [0.999999, 1.0, 1.000001])
def test_critical_damping_is_no_exception(damping: float) -> None:
    at_one = bounds(line(1.5, 2.0, 1.0), np.array([1.0, 4.0]))
    near = bounds(line(1.5, 2.0, damping), np.array([1.0, 4.0]))

    np.testing.assert_allclose(near, at_one, atol=1e-5)


def test_bounds_end_at_rest_and_at_v_lin() -> None:
    low, high = bounds(line(friction=4.0), np.array([0.0, 50.0, 70.0]))

    np.testing.assert_array_equal(low, [0.0, 1.0, 1.0])
    np.testing.assert_array_equal(high, [0.0, 1.0, 1.0])


def test_friction_above_the_load_leaves_everything_open() -> None:
    low, high = bounds(line(friction=30.0), np.array([1.0, 20.0]))

    np.testing.assert_array_equal(low, 0.0)
    np.testing.assert_array_equal(high, 1.0)


@given(st.floats(-0.5, 1.0), st.floats(-3.0, 0.5), st.floats(-3.0, 0.0))
def test_bounds_never_fall_as_the_belt_speeds_up(frequency: float, damping: float, friction: float) -> None:
    body = line(10.0**frequency, 10.0**friction * 10 * 100.0**frequency, 10.0**damping)

    low, high = bounds(body, body.friction_free * np.linspace(0.0, 1.1, 45))

    assert np.all(np.diff(low) >= -1e-9)
    assert np.all(np.diff(high) >= -1e-9)
    assert np.all((low >= 0.0) & (low <= high + 1e-12) & (high <= 1.0))


@given(st.lists(st.floats(-0.99, 0.99), min_size=1, max_size=9))
def test_roots_of_monotone_functions_are_found_to_rounding(targets: list[float]) -> None:
    wanted = np.array(targets)

    found = monotone_root(
        lambda x, at: np.tanh(3 * (x - at)), np.full(len(wanted), -1.0), np.full(len(wanted), 1.0), wanted
    )

    np.testing.assert_allclose(found, wanted, rtol=1e-15, atol=1e-15)


def test_without_a_crossing_the_nearer_end_is_given() -> None:
    found = monotone_root(
        lambda x, at: x + at, np.full(3, -1.0), np.full(3, 1.0), np.array([3.0, -3.0, -1.0])
    )

    np.testing.assert_array_equal(found, [-1.0, 1.0, 1.0])
