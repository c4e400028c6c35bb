"""Motions that reverse twice a period, against exact references."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.reduced.switching import Jumps
from frictionlab.methods.reduced.two_reversals import Line, consistent, motions, motions_at
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
def test_where_the_mass_never_sticks_theirs_is_the_exact_mean(file: Path) -> None:
    with file.open() as lines:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(lines)]
    frequency, load = file.stem.split("_Om")[1].split("_g")
    body = line(float(frequency), 0.4 * float(load))
    slips = [row for row in rows if row["stick_fraction"] == 0.0 and 0.0 < row["v_b"] < body.friction_free]
    speeds, exact = (np.array([row[name] for row in slips]) for name in ("v_b", "mu_bar_exact"))

    found = motions_at(body, speeds)

    np.testing.assert_allclose(1.0 - 2.0 * found.share, exact / 0.4, rtol=0, atol=2e-11)
    assert consistent(body, found).all()


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
    found, green = motions(body, np.array([0.5])), Jumps.of(damping, frequency)
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
    exact = Exact().solve([one.model_copy(update={"belt_speed": speed})], Coulomb(mu=0.4), 1e-9).mean[0]
    body = Line(0.05, 0.5, ratio, free)
    found = motions_at(body, np.array([speed]))

    assert abs(1.0 - 2.0 * found.share[0] - exact / 0.4) > 0.01
    assert not consistent(body, found)[0]


@pytest.mark.parametrize("damping", [0.999999, 1.0, 1.000001])
def test_critical_damping_is_no_exception(damping: float) -> None:
    at_one = motions_at(line(1.5, 2.0, 1.0), np.array([1.0, 4.0]))
    near = motions_at(line(1.5, 2.0, damping), np.array([1.0, 4.0]))

    np.testing.assert_allclose(near.share, at_one.share, atol=1e-5)


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
