"""Stability maps: limits of the step against known numbers, regions, and steppers that keep silent when wrong."""

from __future__ import annotations

import csv
import math
from dataclasses import replace
from pathlib import Path
from statistics import median
from typing import Any

import pytest
from profiles import deep, some

from frictionlab import bench
from frictionlab.bench import stability_solvers as steppers
from frictionlab.bench.account import draw
from frictionlab.bench.stability import StabilityResult, StabilitySection
from frictionlab.bench.stability_grid import PROBLEMS, MapPoint
from frictionlab.bench.stability_solvers import (
    MAPPED_PEERS,
    MAPPED_STEPPERS,
    measured_limit,
    peer_limit,
    predicted_limit,
    stepper_limit,
)


def mapped(name: str, problem: str, grid: int) -> StabilityResult:
    """A small map of a stepper."""
    return StabilitySection(MAPPED_STEPPERS[name], (PROBLEMS[problem],), grid).measure(lambda line: None)


# --- limits -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("limit", [2.0, 6.394, 300.0])
def test_the_limit_is_where_a_perturbation_begins_to_grow(limit: float) -> None:
    assert measured_limit(lambda z: (z / limit) ** 3) == pytest.approx(limit, rel=1e-3)


def test_what_never_grows_has_no_limit_and_what_always_grows_no_stable_step() -> None:
    assert measured_limit(lambda z: 1.0 / (1.0 + z)) == math.inf
    assert measured_limit(lambda z: 1.0 + z) == 0.0


@some(2, "a stepper each")
@pytest.mark.parametrize(
    ("stepper", "theta", "memory", "limit"),
    [
        ("rk4", 0.5, "bristle", 2.7853),
        ("moreau", 0.25, "none", 4.0),
        ("moreau", 0.5, "none", math.inf),
        pytest.param("sdirk2", 0.5, "bristle", math.inf, marks=deep("more kernels to compile")),
        ("smoothed", 0.5, "none", 6.394),
    ],
)
def test_the_step_of_a_stepper_may_be_as_long_as_theory_says(
    stepper: str, theta: float, memory: str, limit: float
) -> None:
    found = stepper_limit(stepper, theta, memory)

    assert found == pytest.approx(limit, rel=0.01)
    assert predicted_limit("dop853" if stepper == "smoothed" else stepper, theta) == pytest.approx(
        found, rel=0.01
    )


# --- regions ------------------------------------------------------------------------------------------------------

RIGHT = MapPoint(64.0, 10.0, 0.1, "ok", "", error=1e-5, stated=1e-4)


def test_a_point_is_right_wrong_and_said_or_wrong_and_silent() -> None:
    assert RIGHT.region == "right"
    assert RIGHT._replace(error=0.1, stated=0.2).region == "wrong_and_said"
    assert RIGHT._replace(status="refused", error=math.nan, stated=math.nan).region == "wrong_and_said"
    assert RIGHT._replace(stated=1e-6).region == "wrong_and_silent"
    assert RIGHT._replace(error=math.nan).region == "wrong_and_silent"


@deep("seconds of steps")
def test_an_explicit_stepper_is_refused_beyond_its_limit_and_right_before_it() -> None:
    (drawn,) = mapped("rk4", "bristle", 6).maps

    assert drawn.counts()["wrong_and_silent"] == 0
    for point in drawn.points:
        # the method allows for the motion without friction, which is quicker by some percents
        if point.step * point.rate > 1.1 * drawn.limit.measured:
            assert point.region == "wrong_and_said"
        if point.step * point.rate < 0.5 * drawn.limit.measured and point.value > 100.0:
            assert point.region == "right"


@deep("more kernels to compile")
def test_implicit_steps_are_right_wherever_they_are_short_enough_for_the_motion() -> None:
    (drawn,) = mapped("sdirk2", "bristle", 4).maps

    assert all(point.region == "right" for point in drawn.points if point.value > 100.0)
    assert any(point.step * point.rate > 100.0 for point in drawn.points)


@deep("more kernels to compile")
def test_a_theta_that_march_does_not_offer_is_seen_to_fail_beyond_its_own_limit() -> None:
    (drawn,) = mapped("moreau_0.25", "plane", 8).maps

    assert {point.status for point in drawn.points} == {"refused"}
    stable = [point.error for point in drawn.points if point.step * point.rate < 0.7 * drawn.limit.measured]
    beyond = [point.error for point in drawn.points if point.step * point.rate > 1.5 * drawn.limit.measured]
    overflown = [math.inf if math.isnan(error) else error for error in beyond]
    assert median(overflown) > 10.0 * median(stable)


@deep("more kernels to compile")
def test_a_method_that_states_too_little_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    def boasting(*given: Any) -> Any:
        found = solve(*given)
        return replace(found, errors=1e-6 * found.errors)

    solve = steppers.solve_points
    monkeypatch.setattr(steppers, "solve_points", boasting)
    (drawn,) = mapped("sdirk2", "bristle", 4).maps

    assert drawn.counts()["wrong_and_silent"] > 4


# --- peers --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("peer", "limit"),
    [("RK23", 2.513), ("RK45", 3.307), ("DOP853", 6.394), ("Radau", math.inf), ("LSODA", math.inf)],
)
def test_the_step_of_a_peer_may_be_as_long_as_theory_says(peer: str, limit: float) -> None:
    assert peer_limit(peer) == pytest.approx(limit, rel=0.01)
    assert predicted_limit(peer) == limit


@deep("more kernels to compile")
@pytest.mark.parametrize(
    "problem", ["bristle", "smoothing", pytest.param("plane", marks=deep("more kernels to compile"))]
)
def test_a_peer_finds_the_mean_over_one_period_of_a_known_orbit(problem: str) -> None:
    section = StabilitySection(MAPPED_PEERS["LSODA"], (PROBLEMS[problem],), 3)
    (drawn,) = section.measure(lambda line: None).maps

    fine = [point for point in drawn.points if point.value < 1e-8]
    assert [point.status for point in fine] == ["ok"] * 3
    assert max(point.error for point in fine) < 2e-7


def test_a_list_that_names_steppers_alone_asks_for_no_peers(tmp_path: Path) -> None:
    (tmp_path / "ours.yaml").write_text("schema: 1\nstability: {steppers: [rk4]}\n")
    (tmp_path / "theirs.yaml").write_text("schema: 1\nstability: {peers: [RK45]}\n")
    (tmp_path / "all.yaml").write_text("schema: 1\nstability: true\n")

    assert bench.load_bench(tmp_path / "ours.yaml").names == ["stability_rk4"]
    assert bench.load_bench(tmp_path / "theirs.yaml").names == ["stability_RK45"]
    assert len(bench.load_bench(tmp_path / "all.yaml").names) == len(MAPPED_STEPPERS) + len(MAPPED_PEERS)


# --- tables and pictures ------------------------------------------------------------------------------------------


@deep("more kernels to compile")
def test_the_table_holds_every_point_with_the_limits(tmp_path: Path) -> None:
    result = mapped("rk4", "bristle", 4)
    (path,) = result.write(tmp_path)

    with path.open() as file:
        rows = list(csv.DictReader(file))
    assert path.name == "stability_rk4.csv"
    assert len(rows) == 16
    assert {row["region"] for row in rows} <= {"right", "wrong_and_said", "wrong_and_silent"}
    assert float(rows[0]["measured_limit"]) == pytest.approx(2.785, rel=0.01)
    assert float(rows[0]["predicted_limit"]) == 2.785
    assert "0 wrong and silent; step*rate at most 2.785" in result.summary()


@deep("seconds of maps")
def test_the_picture_is_drawn_and_says_how_to_read_it(tmp_path: Path) -> None:
    (picture,) = draw(mapped("sdirk2", "bristle", 4), tmp_path)

    assert picture.file_stem == "stability_sdirk2"
    assert "Colour is the true error" in picture.caption
    assert (tmp_path / "stability_sdirk2.svg").stat().st_size < 250_000


@deep("minutes")
@pytest.mark.parametrize("name", MAPPED_STEPPERS)
def test_no_stepper_is_wrong_without_a_word(name: str) -> None:
    for problem in MAPPED_STEPPERS[name].problems:
        (drawn,) = mapped(name, problem, 40).maps
        assert [point for point in drawn.points if point.region == "wrong_and_silent"] == []
