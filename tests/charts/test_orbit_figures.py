"""Figures of kept orbits and harmonics: which points, which lines, where the Poincaré points lie."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd
import pytest
from drawn_figures import NOTHING, drawn, legend_of, names_of, titles_of
from matplotlib.figure import Figure

from frictionlab.charts.figures import FigureData, Kept, figures_of
from frictionlab.charts.kept_figures import with_jumps

SPEEDS = np.arange(1.0, 13.0)
OMEGA, SAMPLES = 2.0, 40


def curve(law: str, reversals: float = 2.0) -> pd.DataFrame:
    inputs = {"law": law, "kind": law, "method": "auto"}
    inputs |= {"scene.belt_speed": SPEEDS, "scene.drive.frequency": OMEGA}
    found = {"mean_friction": 0.01 * SPEEDS, "error": 1e-9, "status": "ok"}
    turning = {"reversals": np.where(SPEEDS < 8.0, reversals, 0.0)}
    return pd.DataFrame(NOTHING | inputs | found | turning)


TABLE = pd.concat([curve("coulomb"), curve("dahl")], ignore_index=True)


def orbits_of(rows: Sequence[int], periods: int = 2) -> pd.DataFrame:
    """Circles of so many drive periods, of a size that tells the row."""
    tau = np.linspace(0.0, periods * 2.0 * np.pi / OMEGA, SAMPLES, endpoint=False)
    size = 1.0 + 0.5 * np.sin(0.5 * OMEGA * tau)
    circle = pd.DataFrame({"tau": tau, "x1": size * np.cos(OMEGA * tau), "v1": size * np.sin(OMEGA * tau)})
    rest = {"v2": 0.0, "load": 0.0, "friction": 0.4}
    return pd.concat([circle.mul([1.0, row + 1, row + 1]).assign(row=row, **rest) for row in rows])


def of_orbits(
    name: str,
    table: pd.DataFrame = TABLE,
    harmonics: pd.DataFrame | None = None,
    orbits: Callable[[Sequence[int]], pd.DataFrame] = orbits_of,
) -> Figure:
    return drawn(table, name, kept=Kept(orbits, harmonics))


def test_orbits_are_of_points_at_which_slip_reverses_each_law_a_line() -> None:
    figure = of_orbits("hysteresis")

    assert titles_of(figure) == ["belt speed $v_b$ = 3", "$v_b$ = 4", "$v_b$ = 5"]
    for axes, speed in zip(figure.axes, (3.0, 4.0, 5.0), strict=True):
        for line, row in zip(axes.lines, (speed - 1.0, speed + 11.0), strict=True):
            orbit = orbits_of([int(row)])
            np.testing.assert_array_equal(line.get_xdata()[:-1], orbit["x1"])
            assert line.get_xdata()[-1] == line.get_xdata()[0]
    assert legend_of(figure) == ["coulomb", "dahl", "3 of 12 points"]


def test_a_motion_that_does_not_repeat_is_not_closed() -> None:
    wild = TABLE.assign(error_kind=np.where(TABLE["scene.belt_speed"] == 4.0, "statistical", "estimated"))
    lines = [axes.lines[0] for axes in of_orbits("hysteresis", wild).axes]

    ends_meet = [line.get_xdata()[0] == line.get_xdata()[-1] for line in lines]
    assert ends_meet == [True, False, True]
    assert [len(line.get_xdata()) for line in lines] == [SAMPLES + 1, SAMPLES, SAMPLES + 1]


def test_a_point_at_which_the_body_sticks_is_among_them() -> None:
    sticks = TABLE.assign(stick_fraction=np.where(TABLE["scene.belt_speed"] == 7.0, 0.1, 0.0))

    assert [title[-1] for title in titles_of(of_orbits("phase", sticks))] == ["3", "4", "7"]


def test_panels_stand_beside_each_other() -> None:
    higher = TABLE.assign(**{"scene.drive.frequency": 3.0})
    both = pd.concat([TABLE, higher], ignore_index=True)

    titles = titles_of(of_orbits("hysteresis", both))
    assert [title.split(",")[0][-1] for title in titles] == ["2", "3", "2", "3", "2", "3"]


def test_poincare_points_lie_at_every_start_of_a_drive_period() -> None:
    figure = of_orbits("phase")

    points = [line for line in figure.axes[0].lines if line.get_linestyle() == "None"]
    assert len(points) == 2
    orbit = orbits_of([2])
    np.testing.assert_allclose(points[0].get_xdata(), orbit["x1"].iloc[[0, SAMPLES // 2]])
    belts = [line for line in figure.axes[0].lines if list(line.get_ydata()) == [3.0, 3.0]]
    assert len(belts) == 1


def test_time_runs_in_drive_periods_and_constant_friction_is_level() -> None:
    velocity, friction, *_ = of_orbits("time_series").axes

    assert velocity.lines[0].get_xdata()[-1] == pytest.approx(2.0)
    assert np.ptp(friction.lines[0].get_ydata()) == 0.0


def test_time_in_seconds_ends_after_the_last_sample() -> None:
    def in_si(rows: Sequence[int]) -> pd.DataFrame:
        found = orbits_of(rows).assign(tau_s=lambda each: 2.0 * each["tau"])
        return found.assign(x1_m=found["x1"], v1_m_per_s=found["v1"], v2_m_per_s=0.0, load_N=0.0)

    undriven = TABLE.drop(columns="scene.drive.frequency")
    velocity, *_ = of_orbits("time_series", undriven, orbits=in_si).axes

    time = velocity.lines[0].get_xdata()
    np.testing.assert_allclose(np.diff(time), 8.0 * np.pi / OMEGA / SAMPLES)


def test_beside_the_velocity_are_that_across_the_belt_and_the_load() -> None:
    def planar(rows: Sequence[int]) -> pd.DataFrame:
        found = orbits_of(rows)
        found = found[
            (found["row"] < len(SPEEDS)) | (found["tau"] < found["tau"].max())
        ]  # each law its own times
        return found.assign(v2=-0.5 * found["v1"], load=7.0 * found["v1"])

    figure = of_orbits("time_series", orbits=planar)
    along, across, *_, load = figure.axes[0].lines

    np.testing.assert_allclose(across.get_ydata(), -0.5 * np.asarray(along.get_ydata()))
    highest = max(np.abs(line.get_ydata()).max() for line in figure.axes[0].lines[:-1])
    assert np.abs(load.get_ydata()).max() == pytest.approx(0.9 * highest)
    assert {"velocity across the belt", "load along the belt, not to scale"} <= set(legend_of(figure))
    assert len(of_orbits("time_series").axes[0].lines) == 2  # of two laws, where neither is


def test_of_few_points_all_are_drawn() -> None:
    three = TABLE[TABLE["scene.belt_speed"].isin([2.0, 3.0, 4.0])].reset_index(drop=True)

    assert len(titles_of(of_orbits("hysteresis", three))) == 3


def test_without_orbits_there_are_no_such_figures() -> None:
    names = figures_of(FigureData(TABLE, kept=Kept(lambda rows: None, None)))

    assert {"hysteresis", "phase", "time_series"}.isdisjoint(names)


def harmonics_of(most: int) -> pd.DataFrame:
    inputs = TABLE[["law", "kind", "method"]].assign(belt_speed=TABLE["scene.belt_speed"])
    rows = [
        inputs.assign(harmonic=k, velocity_amplitude=1.0 / (k + 1), friction_amplitude=0.1 * k + inputs.index)
        for k in range(most + 1)
    ]
    return pd.concat(rows, ignore_index=True)


def test_every_harmonic_is_a_picture_and_every_law_a_line() -> None:
    figure = of_orbits("friction_harmonics", harmonics=harmonics_of(3))

    assert titles_of(figure) == [f"harmonic = {k}" for k in (1, 2, 3)]
    assert names_of(figure) == ["coulomb", "dahl"]
    for k, axes in enumerate(figure.axes, start=1):
        for first, line in zip((0, 12), axes.lines, strict=True):
            np.testing.assert_allclose(line.get_ydata(), 0.1 * k + first + np.arange(12))


def test_of_many_harmonics_the_first_are_drawn_and_the_rest_are_told() -> None:
    figure = of_orbits("velocity_harmonics", harmonics=harmonics_of(20))

    assert len(figure.axes) == 12
    assert legend_of(figure)[-1] == "12 of 20 harmonics"


def slides(friction_of: Callable[[np.ndarray], np.ndarray]) -> pd.DataFrame:
    """A sine of slip whose friction follows from it."""
    tau = np.linspace(0.0, 2.0 * np.pi, SAMPLES)
    slip = np.sin(tau + 0.1)
    return pd.DataFrame({"tau": tau, "x1": -np.cos(tau + 0.1), "slip": slip, "friction": friction_of(slip)})


def test_friction_jumps_at_the_instant_at_which_slip_reverses() -> None:
    found = with_jumps(slides(lambda slip: 0.4 * np.sign(slip)))

    upright = np.flatnonzero(np.diff(found["tau"]) == 0.0)
    np.testing.assert_allclose(found["tau"].iloc[upright], [np.pi - 0.1, 2.0 * np.pi - 0.1], atol=5e-3)
    assert found["friction"].iloc[upright].tolist() == [0.4, -0.4]
    assert found["friction"].iloc[upright + 1].tolist() == [-0.4, 0.4]
    assert found["tau"].is_monotonic_increasing


def test_friction_that_does_not_jump_stays_as_sampled() -> None:
    smooth = slides(lambda slip: 0.4 * np.tanh(3.0 * slip))
    bristle = slides(lambda slip: 0.4 * np.sign(slip)).assign(memory_0=0.1)

    for samples in (smooth, bristle):
        pd.testing.assert_frame_equal(with_jumps(samples), samples)


def test_a_jump_into_stick_ends_where_the_friction_of_the_stick_begins() -> None:
    samples = slides(lambda slip: 0.4 * np.sign(slip))
    stuck = (samples["tau"] > np.pi - 0.1) & (samples["tau"] < np.pi + 0.7)
    late = samples["tau"] > np.pi + 0.7
    held = 0.1 - 0.5 * (samples["tau"] - np.pi + 0.1)
    friction = samples["friction"].mask(stuck, held).mask(late, held.clip(lower=-0.4))

    found = with_jumps(samples.assign(slip=samples["slip"].mask(stuck, 0.0), friction=friction))

    (upright,) = np.flatnonzero(np.diff(found["tau"]) == 0.0)[:1]
    assert found["friction"].iloc[upright] == 0.4
    assert found["friction"].iloc[upright + 1] == pytest.approx(0.1, abs=2e-3)
