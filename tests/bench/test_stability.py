"""Stability maps: limits of the step against known numbers, regions, and steppers that keep silent when wrong."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from bench_lists import loaded, texts
from profiles import deep, some

from frictionlab.bench import stability_solvers as steppers
from frictionlab.bench.page import draw, write_table
from frictionlab.bench.result import SectionResult
from frictionlab.bench.stability import StabilitySection
from frictionlab.bench.stability_problems import PROBLEMS
from frictionlab.bench.stability_solvers import MAPPED_PEERS, MAPPED_STEPPERS, MapPoint
from frictionlab.bench.step_limits import measured_limit, peer_limit, predicted_limit, stepper_limit


def mapped(name: str, problem: str, grid: int) -> SectionResult:
    """A small map of a stepper or peer."""
    solver = {**MAPPED_STEPPERS, **MAPPED_PEERS}[name]
    return StabilitySection(solver, (PROBLEMS[problem],), grid).measure(lambda line: None)


def points(name: str, problem: str, grid: int) -> pd.DataFrame:
    """Those of a small map, and how far each step is beyond the limit of a stable one."""
    table = mapped(name, problem, grid).table
    return table.assign(beyond=table["step_times_rate"] / table["measured_limit"])


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
    theory = predicted_limit("dop853" if stepper == "smoothed" else stepper, theta)
    assert theory == pytest.approx(found, rel=0.01)


# --- regions ------------------------------------------------------------------------------------------------------

RIGHT = MapPoint(64.0, 10.0, 0.1, "ok", error=1e-5, stated=1e-4, reason="")


def test_a_point_is_right_wrong_and_said_or_wrong_and_silent() -> None:
    assert RIGHT.region == "right"
    assert RIGHT._replace(error=0.1, stated=0.2).region == "wrong_and_said"
    assert RIGHT._replace(status="refused", error=math.nan, stated=math.nan).region == "wrong_and_said"
    assert RIGHT._replace(stated=1e-6).region == "wrong_and_silent"
    assert RIGHT._replace(error=math.nan).region == "wrong_and_silent"


@deep("seconds of steps")
def test_an_explicit_stepper_is_refused_beyond_its_limit_and_right_before_it() -> None:
    found = points("rk4", "bristle", 6)
    # the method allows for the motion without friction, which is quicker by some percents
    beyond, before = found["beyond"] > 1.1, (found["beyond"] < 0.5) & (found["value"] > 100.0)

    assert "wrong_and_silent" not in set(found["region"])
    assert {*found.loc[beyond, "region"]} == {"wrong_and_said"}
    assert {*found.loc[before, "region"]} == {"right"}


@deep("more kernels to compile")
def test_implicit_steps_are_right_wherever_they_are_short_enough_for_the_motion() -> None:
    found = points("sdirk2", "bristle", 4)

    assert {*found.loc[found["value"] > 100.0, "region"]} == {"right"}
    assert found["step_times_rate"].max() > 100.0


@deep("more kernels to compile")
def test_a_theta_that_march_does_not_offer_is_seen_to_fail_beyond_its_own_limit() -> None:
    found = points("moreau_0.25", "plane", 8)
    errors = found["error"].fillna(math.inf)  # overflown

    assert {*found["status"]} == {"refused"}
    assert errors[found["beyond"] > 1.5].median() > 10.0 * errors[found["beyond"] < 0.7].median()


@deep("more kernels to compile")
def test_a_method_that_states_too_little_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    def boasting(*given: Any) -> Any:
        found = solve(*given)
        return found.assign(error=1e-6 * found["error"])

    solve = steppers.solve_points
    monkeypatch.setattr(steppers, "solve_points", boasting)

    assert (points("sdirk2", "bristle", 4)["region"] == "wrong_and_silent").sum() > 4


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
    found = points("LSODA", problem, 3)

    fine = found[found["value"] < 1e-8]
    assert fine["status"].tolist() == ["ok"] * 3
    assert fine["error"].max() < 2e-7


ASKED = {"{steppers: [rk4]}": ["rk4"], "{peers: [RK45]}": ["RK45"], "true": [*MAPPED_STEPPERS, *MAPPED_PEERS]}


@pytest.mark.parametrize("asked", ASKED)
def test_a_list_that_names_steppers_alone_asks_for_no_peers(asked: str, tmp_path: Path) -> None:
    names = loaded(f"schema: 1\nstability: {asked}\n", tmp_path).names

    assert names == [f"stability_{name}" for name in ASKED[asked]]


# --- tables and pictures ------------------------------------------------------------------------------------------


@deep("more kernels to compile")
def test_the_table_holds_every_point_with_the_limits(tmp_path: Path) -> None:
    result = mapped("rk4", "bristle", 4)
    assert write_table(result, tmp_path) == ["stability_rk4.csv"]

    table = texts(tmp_path / "stability_rk4.csv")
    assert len(table) == 16
    assert {*table["region"]} <= {"right", "wrong_and_said", "wrong_and_silent"}
    assert float(table["measured_limit"][0]) == pytest.approx(2.785, rel=0.01)
    assert float(table["predicted_limit"][0]) == 2.785
    assert "0 wrong and silent; step*rate at most 2.785" in result.summary


@deep("seconds of maps")
def test_the_picture_is_drawn_and_says_how_to_read_it(tmp_path: Path) -> None:
    (picture,) = draw(mapped("sdirk2", "bristle", 4), tmp_path)

    assert picture["file_stem"] == "stability_sdirk2"
    assert "Colour is the true error" in picture["caption"]
    assert (tmp_path / "stability_sdirk2.svg").stat().st_size < 250_000


@deep("minutes")
@pytest.mark.parametrize("name", MAPPED_STEPPERS)
def test_no_stepper_is_wrong_without_a_word(name: str) -> None:
    for problem in MAPPED_STEPPERS[name].problems:
        assert "wrong_and_silent" not in set(points(name, problem, 40)["region"])
