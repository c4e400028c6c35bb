"""Belt speeds chosen as a run goes: near enough, no more than needed, the same again, and continued where stopped."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fig_4b import COULOMB, GIVEN, LAW, SCENE, over_speeds
from pandas.testing import assert_frame_equal
from profiles import deep

import frictionlab as fl
from frictionlab.runner import study_run
from frictionlab.runner.batch import plan
from frictionlab.runner.chosen_speeds import halves_to_add
from frictionlab.runner.saved import read_run as read_saved
from frictionlab.runner.solving import Solving, run_share
from frictionlab.runner.store import Store
from frictionlab.study.load import load_study, parse_study
from frictionlab.values.notes import StudyError
from frictionlab.values.quantities import Floats

WITHIN = 1e-3
SPEED, FREQUENCY = "scene.belt_speed", "scene.drive.frequency"
RANGE = {"start": 0.5, "stop": 60, "within": WITHIN}
LAWS = [COULOMB, {"kind": "coulomb", "mu": 0.2, "label": "smooth"}]
STUDY = over_speeds(RANGE, laws=LAWS, methods=["auto"], sweep={SPEED: RANGE, FREQUENCY: [1.0, 1.5]})
NO_BREAKS = np.empty(0)


@pytest.fixture(scope="module")
def chosen() -> fl.Run:
    return fl.run(STUDY)


def chosen_of(curve: Callable[[Floats], Floats], speeds: Floats, *how: Any) -> Floats:
    """Return the speeds that are asked for until none is."""
    while len(more := halves_to_add(speeds, curve(speeds), 0.0 * speeds, *how)):
        speeds = np.union1d(speeds, more)
    return speeds


@pytest.mark.parametrize("within", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize(
    ("curve", "kink", "most", "off"),
    [
        (lambda v: 0.4 * np.arcsin(np.minimum(v / 50.0, 1.0)), 50.0, 4.0, 1.0),
        (lambda v: 0.4 * np.arcsin(np.minimum(v / 50.0, 1.0)), np.nan, 4.0, 3.0),
        (lambda v: 0.01 * np.abs(v - 23.456), np.nan, 0.4, 1.0),
        (lambda v: 0.4 * np.sin(v / 5.0), np.nan, 11.0, 1.0),
        (lambda v: 0.05 * np.sqrt(v - 0.5), np.nan, 3.0, 1.0),
        (lambda v: 0.4 * np.tanh(v), np.nan, 3.0, 1.0),
        (lambda v: 0.4 - 0.3 * np.exp(-((v - 20.0) ** 2)), np.nan, 6.0, 1.0),
    ],
)
def test_chords_come_near_with_few_points(
    curve: Any, kink: float, most: float, off: float, within: float
) -> None:
    """Within what is asked, or three times that at a kink that nobody foresaw."""
    first = np.union1d(np.linspace(0.5, 60.0, 17), [kink] if kink == kink else [])
    speeds = chosen_of(curve, first, np.array([kink]), within, 1e-5)

    dense = np.linspace(0.5, 60.0, 100_001)
    assert np.abs(np.interp(dense, speeds, curve(speeds)) - curve(dense)).max() < off * within
    assert len(speeds) < 20 + most * 0.4 / np.sqrt(within)


def test_a_jump_is_halved_to_the_smallest_spacing_and_nothing_beside_a_gap() -> None:
    even = np.linspace(0.0, 16.0, 17)
    speeds = chosen_of(lambda v: 0.1 * (v > np.pi), even, NO_BREAKS, 1e-3, 2.0**-10)
    assert np.diff(speeds).min() == 2.0**-10
    assert len(speeds) < 17 + 2 * 10

    means = np.where(even == 8.0, np.nan, even**2)
    more = halves_to_add(even, means, 0.0 * means, NO_BREAKS, 1e-3, 1e-3)
    assert not ((more > 7.0) & (more < 9.0)).any()
    assert len(more) == 14


def test_points_are_not_asked_for_by_their_own_errors() -> None:
    speeds = np.arange(9.0)
    for error, asks in ((0.0, True), (1e-3, False)):
        more = halves_to_add(speeds, 1e-3 * (speeds % 2), 0.0 * speeds + error, NO_BREAKS, 5e-4, 1e-3)
        assert bool(len(more)) == asks


def test_a_run_is_near_its_curves_everywhere(chosen: fl.Run) -> None:
    table = chosen.table
    assert len(table) == sum(map(len, chosen.study.chosen)) * 2
    assert len(table) < 2 * (25 + 50)
    dense = np.linspace(0.5, 60.0, 700)
    for (mu, frequency), rows in table.groupby(["law.mu", FREQUENCY]):
        scene, speeds = SCENE.with_(**{"drive.frequency": frequency}), rows[SPEED].to_numpy()
        exact = fl.curve(scene, fl.Coulomb(mu=mu), dense)["mean_friction"]
        assert (np.diff(speeds) > 0.0).all()
        assert set(speeds[[0, -1]]) == {0.5, 60.0}
        assert (rows["velocity_ratio"] - 1.0).abs().min() < 1e-12
        assert np.abs(np.interp(dense, speeds, rows["mean_friction"]) - exact).max() < WITHIN
    one, other = (table[table["law"] == label][SPEED].tolist() for label in ("coulomb", "smooth"))
    assert one == other


@deep("seconds of runs")
def test_the_same_run_again_computes_nothing(tmp_path: Path) -> None:
    first = fl.run(STUDY, out=tmp_path / "run")
    assert first.computed == len(first.table)
    again = fl.run(load_study(tmp_path / "run" / "study.yaml"), out=tmp_path / "run")
    assert again.computed == 0
    assert_frame_equal(again.table, first.table)
    assert fl.run(STUDY, out=tmp_path / "other").computed == 0

    shutil.rmtree(tmp_path / ".cache")
    assert fl.run(STUDY, out=tmp_path / "run").computed == 0
    saved = read_saved(tmp_path / "run")
    assert saved.study.chosen == first.study.chosen
    assert len(saved.table) == sum(len(curve.rows) for curve in saved.study.curves())
    assert "within: 0.001" in (tmp_path / "run" / "study.yaml").read_text()


@deep("seconds of runs")
def test_an_interrupted_run_keeps_its_rounds(chosen: fl.Run, tmp_path: Path, monkeypatch: Any) -> None:
    whole, calls, solve = chosen.table, [0], Solving.solve

    def interrupted(*given: Any) -> None:
        calls[0] += 1
        if calls[0] == 3:
            raise KeyboardInterrupt
        solve(*given)

    monkeypatch.setattr(Solving, "solve", interrupted)
    with pytest.raises(study_run.Interrupted) as problem:
        fl.run(STUDY, out=tmp_path / "run")
    table = problem.value.run.table
    assert set(table["status"]) == {"ok", "killed"}
    assert read_saved(tmp_path / "run").size == len(table)

    monkeypatch.undo()
    on = fl.run(STUDY, out=tmp_path / "run")
    assert on.computed == len(whole) - (table["status"] == "ok").sum()
    assert_frame_equal(on.table, whole)


@deep("seconds of runs")
def test_what_is_kept_of_orbits_belongs_to_its_row(tmp_path: Path) -> None:
    kept = STUDY | {"keep": {"orbit": 4, "harmonics": 2}, "laws": LAWS[:1]}
    done = fl.run(kept, out=tmp_path / "run")
    assert sorted(set(done.orbits["row"])) == list(range(len(done.table)))
    assert len(done.harmonics) == 3 * len(done.table)
    for row in (0, len(done.table) - 1):
        given = done.table.iloc[row]
        scene = SCENE.with_(belt_speed=given[SPEED], **{"drive.frequency": given[FREQUENCY]})
        orbit = fl.steady_state(scene, LAW).orbit(4)
        own, names = done.orbits[done.orbits["row"] == row], ["tau", "x1", "v1", "friction"]
        np.testing.assert_allclose(own[names], orbit[names], atol=1e-9)
    assert fl.run(kept, out=tmp_path / "run").computed == 0


def test_belt_speeds_that_are_expected_of_are_points() -> None:
    expect = [{"where": {SPEED: 7, "law": "coulomb"}, "column": "mean_friction", "above": 0}]
    done = fl.run(STUDY | {"expect": expect})
    assert all(verdict.passed for verdict in done.verdicts)
    assert 7.0 in set(done.table[SPEED])


def test_v_lin_of_a_body_that_remembers_is_among_them_and_ends_reversal() -> None:
    scene = GIVEN | {"body": {"fractional": {"coefficient": 0.2, "order": 0.5}}}
    over, rough = {"methods": ["auto"], "columns": ["shape", "all"]}, RANGE | {"within": 1e-2}
    done = fl.run(over_speeds(rough, scene=scene, **over))
    v_lin = 10.0 / abs(0.2j + 0.2 * 1j**0.5)

    assert done.curves["reversal_end"].tolist() == pytest.approx([v_lin], rel=1e-12)
    assert (done.table["velocity_ratio"] - 1.0).abs().min() < 1e-12
    beyond = done.table["velocity_ratio"] >= 1.0
    assert (done.table["mean_friction"][beyond] == 0.4).all()
    assert (done.table["mean_friction"][~beyond] < 0.4).all()


def test_metres_per_second_are_chosen_as_well() -> None:
    si = {"mass_kg": 2.0, "stiffness_N_per_m": 800.0, "damping_N_s_per_m": 8.0, "length_m": 1e-3}
    si["drive"] = {"amplitude_N": 4.0, "frequency_rad_per_s": 30.0}
    over = {"scene.dimensional.belt_speed_m_per_s": {"start": 0.01, "stop": 0.5, "within": 1e-2}}
    done = fl.run(STUDY | {"scene": {"dimensional": si}, "laws": LAWS[:1], "sweep": over})
    assert done.counts == {"ok": len(done.table)}
    assert (done.table["velocity_ratio"] - 1.0).abs().min() < 1e-12


def test_the_plan_says_about_how_many(chosen: fl.Run) -> None:
    entry = plan(parse_study(STUDY))[0]
    assert entry.about
    assert entry.points == pytest.approx(sum(map(len, chosen.study.chosen)), rel=0.5)


def test_a_part_cannot_know_them(tmp_path: Path) -> None:
    told = r"belt speeds within 0\.001 are chosen as a run goes, and a part of it"
    with pytest.raises(StudyError, match=told):
        run_share(parse_study(STUDY), (1, 2), Store(tmp_path))


UP = {"start": 1, "stop": 2}


@pytest.mark.parametrize(
    ("speeds", "loads", "said"),
    [
        ({"start": 2, "stop": 1}, {}, "belt_speed.stop: must be > start = 2"),
        ({"stop": 1}, {}, "belt_speed.start: required key is missing"),
        (UP, [1, 2], "within: belt speeds alone are chosen so, where no others are linked"),
        (UP, UP | {"num": 4000}, "chosen for 100000 at most: give num"),
    ],
)
def test_mistakes_are_told(speeds: dict[str, Any], loads: Any, said: str) -> None:
    sweep = {SPEED: speeds | {"within": WITHIN}} | ({"scene.normal_load": loads} if loads else {})
    with pytest.raises(StudyError) as problem:
        parse_study(STUDY | {"sweep": {"linked": [sweep]} if isinstance(loads, list) else sweep})
    assert said in str(problem.value)
    assert len(problem.value.mistakes) == 1


def test_a_curve_that_ends_within_a_sixteenth_of_the_range_has_a_shape() -> None:
    scene = SCENE.with_(normal_load=0.1, drive=fl.Drive(amplitude=1, frequency=4))  # V_lin = 0.27
    sweep = {SPEED: {"start": 0.001, "stop": 10, "within": 1e-2}}
    curves = fl.run(fl.Study.of(scene, LAW, sweep=sweep, columns=["shape"])).curves

    assert curves[["shape", "shape_by_initial"]].to_numpy().tolist() == [["convex", "convex"]]
