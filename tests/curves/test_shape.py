"""The shape of a curve: closed forms, the paper's curves, and verdicts that the choice of points does not change."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from numpy.typing import NDArray
from profiles import some
from strategies import scenes_on_the_line

import frictionlab as fl
from frictionlab.curves.interpolant import monotone_cubic
from frictionlab.curves.verdict import Estimate, FrictionCurve, UnreadableCurve, reduction, shape_of
from frictionlab.runner.curve_table import curve_table
from frictionlab.scene.scene import Scene
from frictionlab.theory import friction_free_velocity
from frictionlab.values.columns import CURVES

REFERENCE = Path(__file__).parents[1] / "reference"
LAW = fl.Coulomb(mu=0.4)
Floats = NDArray[np.float64]

# Mean friction over that at the end, u in [0, 1], with its area, half ratio and curvature at rest.
FORMS: dict[str, tuple[Callable[[Floats], Floats], float, float]] = {
    "arcsine": (lambda u: 2 / np.pi * np.arcsin(u), 1 - 4 / np.pi, 1 / 3),
    "parabola": (lambda u: 1 - (1 - u) ** 2, 1 / 3, 3 / 4),
    "cube": (lambda u: u**3, -1 / 2, 1 / 8),
    "root": (np.sqrt, 1 / 3, np.sqrt(1 / 2)),
    "quarter of a circle": (lambda u: np.sqrt(1 - (1 - u) ** 2), np.pi / 2 - 1, np.sqrt(3 / 4)),
}


def grids(end: float, points: int = 90) -> dict[str, Floats]:
    """Five ways to choose belt speeds up to a fifth above the end of reversal."""
    top = 1.2 * end
    nodes = np.arange(points) + 0.5
    uniform = np.linspace(0.0, top, points + 1)[1:]
    return {
        "uniform": uniform,
        "logarithmic": np.geomspace(0.01 * end, top, points),
        "Chebyshev": np.sort(0.5 * top * (1 - np.cos(np.pi * nodes / points))),
        "random": np.sort(np.append(np.random.default_rng(7).uniform(0, top, points), top)),
        "halved": uniform[1::2],
    }


def curve_of(
    form: Callable[[Floats], Floats], speed: Floats, end: float = 1.0, **changes: Any
) -> FrictionCurve:
    """A curve that keeps its last value from its end on, which is the end of reversal unless ``changes`` say else."""
    friction = form(np.minimum(speed / end, 1.0))
    exact = np.zeros_like(speed)
    whole = FrictionCurve(speed, friction, exact, Estimate(0.0, 0.0), Estimate(end, 0.0), kinked=True)
    return replace(whole, **changes)


def covers(measured: Estimate | None, truth: float) -> bool:
    assert measured is not None
    return abs(measured.value - truth) <= measured.error + 1e-12


# Interpolation


@given(st.lists(st.tuples(st.floats(1e-3, 1.0), st.floats(-1.0, 1.0)), min_size=2, max_size=30))
def test_the_interpolant_goes_through_its_points_and_never_beyond_its_neighbours(
    steps: list[tuple[float, float]],
) -> None:
    x, y = np.cumsum([width for width, _ in steps]), np.array([value for _, value in steps])
    path = monotone_cubic(x, y)
    between = np.linspace(x[:-1], x[1:], 9)

    np.testing.assert_allclose(path(x), y, rtol=0, atol=1e-12)
    assert np.all(path(between) <= np.maximum(y[:-1], y[1:]) + 1e-12)
    assert np.all(path(between) >= np.minimum(y[:-1], y[1:]) - 1e-12)


def test_the_interpolant_is_exact_on_lines_and_third_order_on_what_is_smooth_and_rising() -> None:
    at = np.linspace(0, 1, 301)
    grids = [np.linspace(0, 1, points) for points in (11, 21, 41, 81)]
    errors = [float(np.abs(monotone_cubic(x, np.exp(x))(at) - np.exp(at)).max()) for x in grids]
    line = monotone_cubic(np.array([0.0, 0.3, 1.0]), np.array([1.0, 1.6, 3.0]))

    np.testing.assert_allclose(line(at), 1 + 2 * at)
    assert np.all(np.log2(np.divide(errors[:-1], errors[1:])) > 2.7)


# Curves in closed form


@pytest.mark.parametrize("grid", grids(1.0))
@pytest.mark.parametrize("form", FORMS)
def test_measures_of_closed_forms_lie_within_their_errors_on_every_choice_of_points(
    form: str, grid: str
) -> None:
    course, area, half = FORMS[form]
    shape = shape_of(curve_of(course, 3.0 * grids(1.0)[grid], end=3.0))

    assert covers(shape.area, area)
    assert covers(shape.half, half)
    assert shape.area.error < 0.02
    assert shape.by_area == ("concave" if area > 0 else "convex")


def test_the_curvature_at_rest_is_that_of_the_curve() -> None:
    speed = 7.0 * grids(1.0)["uniform"]
    parabola, cube = (shape_of(curve_of(FORMS[name][0], speed, end=7.0)) for name in ("parabola", "cube"))

    assert covers(parabola.initial, -2.0)
    assert covers(cube.initial, 6 * 0.05)  # the second difference takes in the first tenth of the range
    assert (parabola.by_initial, cube.by_initial) == ("concave", "convex")


def test_a_straight_line_is_undecided() -> None:
    shape = shape_of(curve_of(lambda u: u, grids(1.0)["uniform"]))

    assert covers(shape.area, 0.0)
    assert covers(shape.half, 0.5)
    assert shape.by_area == "undecided"


def test_a_curve_on_both_sides_of_its_chord_is_mixed_and_one_whose_window_disagrees_undecided() -> None:
    bend = 0.3
    twice = shape_of(curve_of(lambda u: u + bend * u * (1 - u) * (0.8 - u), grids(1.0)["uniform"]))
    late = shape_of(curve_of(lambda u: u - bend * u * (1 - u) * (0.35 - u), grids(1.0)["uniform"]))

    assert twice.above.sign == twice.below.sign == 1
    assert twice.by_area == "mixed"
    assert late.area.sign == -late.window_area.sign == 1
    assert late.by_area == "undecided"


@pytest.mark.parametrize("scale", [1e-6, 1e3])
def test_a_shape_knows_no_units(scale: float) -> None:
    course, speed = FORMS["quarter of a circle"][0], grids(1.0)["random"]
    one = shape_of(curve_of(course, speed))
    other = shape_of(curve_of(lambda u: scale * course(u), scale * speed, end=scale))

    for name, measured in vars(one).items():
        np.testing.assert_allclose(getattr(other, name), measured, rtol=1e-9, atol=1e-12)


@given(st.integers(0, 2**32 - 1), st.floats(-4, -2))
def test_the_errors_of_points_are_covered(seed: int, exponent: float) -> None:
    noise, (course, area, half) = 10.0**exponent, FORMS["parabola"]
    speed = grids(1.0)["uniform"]
    shaken = course(np.minimum(speed, 1.0)) + np.random.default_rng(seed).uniform(-noise, noise, speed.size)
    shape = shape_of(curve_of(course, speed, friction=shaken, error=np.full(speed.size, noise)))

    assert covers(shape.area, area)
    assert covers(shape.half, half)
    assert covers(shape.initial, -2.0)
    assert covers(shape.above, 1 / 3)


@pytest.mark.parametrize("end", ["start", "end"])
def test_what_is_not_known_about_an_end_is_in_the_errors(end: str) -> None:
    course, speed = FORMS["quarter of a circle"][0], grids(1.0)["uniform"]
    place = Estimate(0.02, 0.02) if end == "start" else Estimate(0.97, 0.03)
    shape = shape_of(replace(curve_of(course, speed), **{end: place}))

    assert covers(shape.area, FORMS["quarter of a circle"][1])
    assert shape.area.error > 0.01


@pytest.mark.parametrize(
    ("speed", "reason"),
    [
        (np.linspace(0.01, 0.99, 50), "ends at belt speed 0.99, below the end of reversal, 1"),
        (np.linspace(0.15, 1.2, 8), "points below the end of reversal, 1: 6 of the 8 needed"),
        (np.append(np.linspace(0.01, 0.5, 30), [0.75, 1.0]), "no point between belt speeds 0.5 and 0.75"),
        (np.linspace(0.25, 1.2, 40), "no point between belt speeds 0 and 0.25"),
        (np.array([]), "the curve has no points below"),
    ],
)
def test_a_curve_that_cannot_be_read_says_why(speed: Floats, reason: str) -> None:
    with pytest.raises(UnreadableCurve, match=reason):
        shape_of(curve_of(np.sqrt, speed))


@given(st.lists(st.floats(-1.0, 1.0), min_size=12, max_size=40), st.booleans(), st.floats(0.0, 0.1))
@example([1.0, 1.1125369292536007e-308, *[0.0] * 7, 1.0, 0.0, 0.0], True, 0.0)
def test_whatever_the_points_a_shape_has_finite_numbers_or_a_reason(
    values: list[float], kinked: bool, error: float
) -> None:
    speed = np.linspace(0.0, 1.3, len(values) + 1)[1:]
    end, errors = Estimate(1.0, 0.0 if kinked else error), np.full(speed.size, error)
    try:
        shape = shape_of(FrictionCurve(speed, np.array(values), errors, Estimate(0.0, 0.0), end, kinked))
    except UnreadableCurve:
        return
    found = np.array([measured for measured in vars(shape).values() if measured is not None])

    assert np.all(np.isfinite(found))
    assert np.all(found[:, 1] >= 0.0)


def test_the_reduction_is_the_largest_fall_and_allows_for_a_dip_between_points() -> None:
    normalized = np.array([0.9, 0.5, 0.3, 0.5, 1.0])

    assert reduction(normalized, np.full(5, 1e-3)) == pytest.approx((0.7, 1e-3 + 0.05))
    assert reduction(normalized[2:], np.full(3, 1e-3)) == pytest.approx((0.7, 1e-3))


# Computed curves


def scene(frequency: float, normal_load: float, across: float | None = None) -> Scene:
    drive = fl.Drive(unbalance=10, frequency=frequency)
    line = Scene(damping_ratio=0.1, normal_load=normal_load, belt_speed=1, drive=drive)
    if across is None:
        return line
    return line.with_(
        transverse={"natural_frequency": across, "damping_ratio": 0.1, "load": {"unbalance": 10}}
    )


def curves(one: Scene, speed: Floats) -> pd.Series:
    """The row of the table of curves."""
    return curve_table(fl.curve(one, LAW, speed)).iloc[0]


def shaken(table: pd.DataFrame, seed: int) -> pd.DataFrame:
    """The same table with noise of 1e-6 on the mean friction, of which its errors know nothing."""
    noise = np.random.default_rng(seed).uniform(-1e-6, 1e-6, len(table))
    moved = table["mean_friction"] + noise
    return table.assign(mean_friction=moved, normalized_friction=moved / 0.4)


@cache
def dense_area(frequency: float, normal_load: float) -> float:
    """The area of a curve along the belt by the trapezoidal rule on a great many points."""
    one = scene(frequency, normal_load)
    end = friction_free_velocity(one)
    u = np.concatenate(([0.0], np.sin(np.linspace(0, np.pi / 2, 4001))[1:]))
    course = np.append(0.0, fl.curve(one, LAW, u[1:] * end)["mean_friction"] / 0.4)
    return float(2 * np.trapezoid(course - u, u))


ALONG = {
    (4.0, 1.0): "convex",
    (1.5, 10.0): "convex",
    (1.0, 10.0): "concave",
    (0.9, 10.0): "mixed",
    (1.1, 10.0): "undecided",
}
"""Omega, gamma^2 with longitudinal load alone: verdict by area."""

ACROSS = {
    (4.0, 1.0, 0.5): "concave",
    (4.0, 1.0, 4.0): "convex",
    (2.0, 1.0, 2.0): "convex",
    (2.0, 1.0, 3.0): "undecided",
    (1.0, 1.0, 1.0): "concave",
    (1.0, 10.0, 1.5): "concave",
}
"""Omega, gamma^2, omega_r with both loads, Figs. 8 and 9: verdict by area."""


def verdicts_on(one: Scene, points: int, wanted: str) -> list[pd.Series]:
    """The rows of a curve on every choice of points, with and without noise: all of them with this verdict."""
    rows = []
    for speed in grids(friction_free_velocity(one), points).values():
        table = fl.curve(one, LAW, speed)
        rows.append(curve_table(table).iloc[0])
        assert rows[-1]["shape"] == curve_table(shaken(table, len(table))).iloc[0]["shape"] == wanted
    return rows


@some(1, "whole curves")
@pytest.mark.parametrize("case", ALONG)
def test_verdicts_along_the_belt_do_not_change_with_the_points_or_with_noise(
    case: tuple[float, float],
) -> None:
    truth = dense_area(*case)
    for row in verdicts_on(scene(*case), 90, ALONG[case]):
        assert abs(row["shape_area"] - truth) <= row["shape_area_error"] < 0.02
        assert row["reversal_end"] == pytest.approx(friction_free_velocity(scene(*case)), rel=1e-12)


@some(1, "whole curves")
@pytest.mark.parametrize("case", ACROSS)
def test_verdicts_in_the_plane_do_not_change_with_the_points_or_with_noise(
    case: tuple[float, float, float],
) -> None:
    rows = verdicts_on(scene(*case), 60, ACROSS[case])
    for measure in ("reversal_end", "shape_area", "shape_half"):
        low = max(row[measure] - row[f"{measure}_error"] for row in rows)
        high = min(row[measure] + row[f"{measure}_error"] for row in rows)
        assert low <= high, f"{measure}: no value lies within the errors of all five"


@given(scenes_on_the_line(speed=(1.0, 1.2), friction=(0.01, 0.95)), st.integers(20, 60))
def test_areas_of_random_curves_lie_within_their_errors(one: Scene, points: int) -> None:
    end = friction_free_velocity(one)
    coarse, dense = (
        curve_table(fl.curve(one, LAW, np.linspace(0, 1.1 * end, n + 1)[1:])).iloc[0] for n in (points, 500)
    )

    assert abs(coarse["shape_area"] - dense["shape_area"]) <= coarse["shape_area_error"]
    assert dense["shape_area_error"] < 0.01
    assert {coarse["shape"], dense["shape"]} != {"concave", "convex"}


@pytest.mark.parametrize(
    ("file", "area", "half", "verdict"),
    [
        ("fig8a_Om4_g1_wr0.5", 0.164, 0.614, "concave"),
        ("fig8a_Om4_g1_wr4", -0.082, 0.445, "convex"),
        ("fig9a_Om1_g1_wr1", 0.177, 0.623, "concave"),
    ],
)
def test_reference_curves_in_the_plane_have_the_areas_they_are_known_by(
    file: str, area: float, half: float, verdict: str
) -> None:
    """Areas and half ratios of an independent reading of the same points, to three digits."""
    read = pd.read_csv(REFERENCE / f"planar_{file}.csv").iloc[1:]
    speed, highest = read["v_b"].to_numpy(), read["v1max"].to_numpy()
    last = int(np.flatnonzero(highest > speed)[-1])
    fall = highest - speed
    end = speed[last] + fall[last] / (fall[last] - fall[last + 1]) * (speed[last + 1] - speed[last])
    inputs = {"law": "coulomb", "scene.belt_speed": speed, "scene.normal_load": 1.0, "status": "ok"}
    inputs |= {"scene.drive.unbalance": 10.0, "scene.drive.frequency": 4.0}
    mean = read["mu_bar_dop853"]
    told = {"mean_friction": mean, "error": 1e-8, "normalized_friction": mean / 0.4, "stick_fraction": 0.0}
    told |= {"velocity_amplitude": read["V1"], "reversals": np.where(highest > speed, 2.0, 0.0)}
    rows = pd.DataFrame(inputs | {"scene.transverse.load.unbalance": 10.0} | told)
    row = curve_table(rows).iloc[0]

    assert abs(row["reversal_end"] - end) <= row["reversal_end_error"]
    assert row["reversal_end"] == pytest.approx(end, abs=0.07)
    assert row["shape_area"] == pytest.approx(area, abs=6e-4)
    assert row["shape_half"] == pytest.approx(half, abs=6e-4)
    assert row["shape"] == verdict


@pytest.mark.parametrize(
    ("frequency", "normal_load", "area", "half"),
    [
        (1.0, 1.0, -0.241, 0.350),
        (1.0, 10.0, 0.058, 0.545),
        (0.9, 10.0, 0.025, None),
        (1.1, 10.0, -0.040, None),
        (1.0, 3.0, -0.175, None),
    ],
)
def test_curves_along_the_belt_have_the_areas_they_are_known_by(
    frequency: float, normal_load: float, area: float, half: float | None
) -> None:
    row = curves(scene(frequency, normal_load), np.arange(1, 121) * 0.5)

    assert row["shape_area"] == pytest.approx(area, abs=6e-4)
    assert half is None or row["shape_half"] == pytest.approx(half, abs=6e-4)


# Both ends of a curve


def test_friction_above_the_load_starts_from_what_the_peak_of_the_load_leaves() -> None:
    """mu gamma^2 = 4 against a load of 2.5: 1 - 2.5/4 of mu as belt speed falls to zero, not 0."""
    one = scene(0.5, 10.0)
    slow = fl.curve(one, LAW, [2e-7, 1e-6, 1e-4])["mean_friction"] / 0.4
    end = friction_free_velocity(one)
    dense = curves(one, np.geomspace(1e-4, 1.2, 1500) * end)
    rows = [curves(one, speed) for speed in grids(end).values()]

    assert np.all(np.diff(slow - 0.375) > 0)
    assert slow.iloc[0] == pytest.approx(0.375, abs=1e-3)
    for row in rows:
        assert abs(row["shape_area"] - dense["shape_area"]) <= row["shape_area_error"] < 0.02
        assert row["shape"] == dense["shape"] == "undecided"
    assert dense["shape_area"] == pytest.approx(0.1489, abs=1e-4)  # from 0 it would be 0.46
    assert dense["reduction"] <= 0.625 + 1e-9


@pytest.mark.parametrize("offset", [0.0, 1.0])
def test_friction_that_falls_below_the_slowest_belt_speed_ends_no_reversal_at_v_lin(offset: float) -> None:
    drive = fl.Drive(unbalance=10, frequency=1.5, offset=offset)
    one, law = (
        scene(1.5, 10.0).with_(drive=drive),
        fl.Stribeck(mu_kinetic=0.3, mu_static=0.5, stribeck_speed=0.5),
    )
    speed = np.linspace(0.2, 1.2, 11) * friction_free_velocity(one)

    row = curve_table(fl.curve(one, law, speed)).iloc[0]

    assert {law.sliding_friction(each) for each in speed} == {0.3}
    assert row["reversal_end_error"] > 0.01


def test_friction_in_the_plane_above_both_loads_leaves_the_area_empty_and_says_why() -> None:
    row = curves(scene(0.5, 20.0, across=1.5), np.linspace(0.02, 2.5, 60))

    assert np.isfinite(row["reversal_end"])
    assert np.isnan(row["shape_area"])
    assert "the body sticks to a belt at rest" in row["reason"]


def test_a_prescribed_slip_ends_its_reversals_at_its_own_amplitude() -> None:
    slip = fl.Slip(velocity_amplitude=3, frequency=1)
    along, across = Scene(belt_speed=1, slip=slip), fl.TransverseSlip(velocity_amplitude=3, phase=90)
    turning = Scene(belt_speed=1, slip=slip, transverse_slip=across)
    speed = np.linspace(0.05, 4, 80)
    rows = [curves(one, speed) for one in (along, turning)]

    assert [row["reversal_end"] for row in rows] == pytest.approx([3, 3], rel=1e-12)
    assert rows[0]["shape_area"] == pytest.approx(1 - 4 / np.pi, abs=1e-5)
    assert rows[0]["shape"] == rows[1]["shape"] == "convex"


def test_a_curve_that_still_reverses_at_its_last_point_says_so() -> None:
    row = curves(scene(1.0, 1.0, across=1.0), np.linspace(1, 20, 20))

    assert row["reason"] == "slip still reverses at the highest belt speed that has a number, 20"
    assert np.isnan(row["reversal_end"])


# The table of curves


@pytest.fixture(scope="module")
def family() -> pd.DataFrame:
    parts = [fl.curve(scene(1.0, load), LAW, np.arange(1, 121) * 0.5) for load in (1.0, 10.0)]
    return pd.concat([*parts, parts[1].assign(method="second")], ignore_index=True)


def test_there_is_one_row_per_curve_inputs_first(family: pd.DataFrame) -> None:
    rows = curve_table(family)

    assert list(rows.columns[:3]) == ["law", "kind", "method"]
    assert [name for name in CURVES if name not in rows] == ["not_unique_from", "not_unique_to"]
    assert list(rows.columns[2 - len(CURVES) :]) == [name for name in CURVES if name in rows]
    assert "scene.belt_speed" not in rows
    assert list(zip(rows["method"], rows["scene.normal_load"], rows["shape"], strict=True)) == [
        ("auto", 1.0, "convex"),
        ("auto", 10.0, "concave"),
        ("second", 10.0, "concave"),
    ]


def test_a_curve_tells_between_which_belt_speeds_its_state_is_not_unique(family: pd.DataFrame) -> None:
    table = family.copy()
    light = (table["scene.normal_load"] == 1.0) & table["scene.belt_speed"].isin([2.5, 3.0, 7.0])
    table.loc[light, "status"] = "not_unique"
    rows = curve_table(table)

    assert rows["not_unique_from"].tolist()[:1] == [2.5]
    assert rows["not_unique_to"].tolist()[:1] == [7.0]
    assert rows[["not_unique_from", "not_unique_to"]].iloc[1:].isna().all(axis=None)


def test_points_without_a_number_are_left_out(family: pd.DataFrame) -> None:
    lost = family["scene.belt_speed"].isin([10.0, 25.0, 25.5])
    failed = family.copy()
    failed.loc[lost, ["status", "mean_friction"]] = ["failed", np.nan]
    whole, rest = curve_table(family), curve_table(failed)

    assert rest["shape"].tolist() == whole["shape"].tolist()
    assert np.all((rest["shape_area"] - whole["shape_area"]).abs() <= rest["shape_area_error"])
    pd.testing.assert_frame_equal(rest, curve_table(family[~lost]))


def test_belts_at_rest_and_running_backward_are_left_out(family: pd.DataFrame) -> None:
    odd = ["scene.belt_speed", "mean_friction", "velocity_ratio"]
    both = pd.concat([family, family.assign(**-family[odd])], ignore_index=True)

    pd.testing.assert_frame_equal(curve_table(both), curve_table(family))


def test_a_table_without_curves_gives_an_empty_table_with_its_columns(family: pd.DataFrame) -> None:
    for table in (family.iloc[:1], family.iloc[:0]):
        rows = curve_table(table)
        assert rows.empty
        assert list(rows.columns) == list(curve_table(family).columns)


@given(st.floats(0.1, 0.9), st.floats(0.02, 0.6))
def test_of_points_evenly_spaced_the_area_has_a_smaller_error_that_covers_kinks(
    kink: float, part: float
) -> None:
    speed = np.sin(0.5 * np.pi * np.array([0.125, 0.5, *range(1, 33)]) / 32)
    friction = (1.0 - part) * np.arcsin(speed) * 2.0 / np.pi + part * np.minimum(speed / kink, 1.0)
    curve = FrictionCurve(speed, friction, np.zeros(34), Estimate(0.0, 0.0), Estimate(1.0, 0.0), kinked=True)
    area = 2.0 * ((1.0 - part) * (1.0 - 2.0 / np.pi) + part * (1.0 - 0.5 * kink)) - 1.0
    even, usual = shape_of(curve, even=True).area, shape_of(curve).area

    assert even.value == usual.value
    assert abs(even.value - area) <= even.error < usual.error
