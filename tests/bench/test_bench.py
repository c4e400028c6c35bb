"""Work against precision: who is measured against whom, what keeps its place, and what a wrong list is told."""

from __future__ import annotations

import csv
import math
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest
from answered import with_columns
from fake_methods import Another, Fake, breaks_down, register
from profiles import deep

from frictionlab import bench, cli
from frictionlab.bench import account as pictures
from frictionlab.bench.curve import CurveResult
from frictionlab.bench.listed import PEERS
from frictionlab.bench.measure import chosen, solve_points, time_task
from frictionlab.bench.peers import base
from frictionlab.bench.peers.equations import ScipySteps
from frictionlab.bench.record import Row, Times
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.lugre import LuGre
from frictionlab.methods.base import Answers
from frictionlab.methods.exact.method import Exact
from frictionlab.scene.scene import Drive, Load, Scene, Transverse
from frictionlab.values.notes import StudyError
from frictionlab.values.quantities import Finite

LISTS = Path(__file__).parents[1] / "benchmarks"
SPEEDS = [1.0, 2.0, 4.0, 8.0]

LIST = """\
schema: 1
title: Fakes
repeats: 2
scenes:
  - name: A
    scene: {damping_ratio: 0.1, normal_load: 10, drive: {unbalance: 10, frequency: 1}}
    laws: [{kind: coulomb, mu: 0.4}]
    sweep: {scene.belt_speed: [1, 2, 4, 8]}
    references: [{values: known.csv, error: 1.0e-15}]
    methods:
      - {kind: off, by: [1.0e-3, 1.0e-6]}
"""


class Off(Fake):
    """The fake, off by so much and saying half of it."""

    name: ClassVar[str] = "off"

    by: Finite = 0.0

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        answers = super().solve(scenes, law, tolerance)
        return replace(answers, mean=answers.mean + self.by, error=np.full(len(scenes), 0.5 * self.by))


@pytest.fixture(autouse=True)
def _fakes_and_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    register(monkeypatch, fake=Fake, another=Another, off=Off)
    monkeypatch.chdir(tmp_path)
    means = [f"{speed},{0.4 * math.tanh(speed) / 3.0!r}" for speed in SPEEDS]
    Path("known.csv").write_text("\n".join(["belt_speed,mean_friction", *means]))


def measured(text: str = LIST) -> CurveResult:
    """The first curve of a list."""
    Path("list.yaml").write_text(text)
    (first, *_) = bench.measure(bench.load_bench(Path("list.yaml")), lambda line: None)
    return first


@deep("seconds of a bench")
def test_a_first_run_is_timed_of_methods_that_answer() -> None:
    methods = LIST[LIST.index("      - {kind: off") :]
    plain = """      - {kind: exact, tolerance: [1.0e-6, 1.0e-9]}
    peers: [{kind: scipy, points: 1, tolerance: 1.0e-2}]
"""
    Path("list.yaml").write_text(LIST.replace(methods, plain))
    (found,) = bench.measure(bench.load_bench(Path("list.yaml")), lambda line: None, first_runs=True)

    first, second, peer = found.rows
    assert first.first > 10.0 * first.points * first.whole.least  # most of it are imports
    assert math.isnan(second.first)
    assert math.isnan(peer.first)
    assert f"| {first.first:.4g} |" in found.markdown()


def written(found: CurveResult) -> None:
    Path("out").mkdir()
    found.write(Path("out"))


def rows_of(found: CurveResult, label: str) -> list[Row]:
    return [row for row in found.rows if row.contender.label == label]


# --- errors -------------------------------------------------------------------------------------------------------


def test_an_error_is_the_distance_from_the_reference() -> None:
    coarse, fine = measured().rows

    assert (coarse.setting.value, fine.setting.value) == (1e-3, 1e-6)
    assert coarse.largest == pytest.approx(1e-3)
    assert coarse.median == pytest.approx(1e-3)
    assert fine.largest == pytest.approx(1e-6)


def test_a_stated_error_that_does_not_cover_is_counted() -> None:
    short = measured().rows[0]
    covering = measured(LIST.replace("error: 1.0e-15", "error: 1.0e-3")).rows[0]

    assert short.stated == pytest.approx(0.5e-3)
    assert (short.covered, covering.covered) == (0, 4)


def test_a_method_is_never_measured_against_its_own_kind() -> None:
    own = "[{kind: 'off', by: 0.1, tolerance: 1.0e-9}, {kind: another, tolerance: 1.0e-9}]"

    with_another = measured(LIST.replace("[{values: known.csv, error: 1.0e-15}]", own))
    alone = measured(
        LIST.replace("[{values: known.csv, error: 1.0e-15}]", own.partition(", {kind: an")[0] + "]")
    )

    assert {row.reference.kind for row in with_another.rows if row.reference} == {"another"}
    assert with_another.rows[0].largest == pytest.approx(1e-3)
    assert [(row.reference, row.reason) for row in alone.rows] == [(None, "no independent reference")] * 2
    assert [row.covered for row in alone.rows] == [None] * 2
    assert all(math.isnan(row.largest) for row in alone.rows)


def test_the_reference_and_its_own_error_are_in_the_tables() -> None:
    found = measured()

    written(found)

    (record, _) = csv.DictReader(Path("out/A.csv").read_text().splitlines())
    assert (record["reference"], record["reference_error"]) == ("known.csv", "1e-15")
    assert "Reference of off: known.csv, known to 1.0e-15." in Path("out/A.md").read_text()


def test_a_peer_may_be_the_reference_known_to_what_a_looser_tolerance_changes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def solve(peer: ScipySteps, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Any:
        return np.array([0.4 * math.tanh(scene.belt_speed) / 3.0 + 2.0 * tolerance for scene in scenes])

    monkeypatch.setattr(ScipySteps, "solve", solve)
    own = LIST.replace(
        "{values: known.csv, error: 1.0e-15}", "{kind: scipy, tolerance: 1.0e-9, label: steps}"
    )
    found = measured(own + "    peers: [{kind: scipy, tolerance: 1.0e-6}]\n")

    coarse, _, peer = found.rows
    assert coarse.reference is not None
    assert coarse.reference.label == "steps at 1e-09"
    assert coarse.largest == pytest.approx(1e-3, rel=1e-5)
    assert coarse.reference.errors == pytest.approx(10.0 * (2.0 * 99e-9 + 1e-9))
    assert (peer.reference, peer.reason) == (None, "no independent reference")


def test_exact_is_measured_against_shooting_and_shooting_against_exact() -> None:
    both = LIST.replace("{values: known.csv, error: 1.0e-15}", "{kind: exact, tolerance: 1.0e-11}, SHOOTING")
    both = both.replace("SHOOTING", "{kind: shooting, tolerance: 1.0e-11}")
    both = both.replace("repeats: 2", "repeats: 20")
    found = measured(both.replace("{kind: off, by: [1.0e-3, 1.0e-6]}", "exact\n      - shooting"))

    exact, shooting = found.rows
    assert exact.reference is not None
    assert shooting.reference is not None
    assert (exact.reference.kind, shooting.reference.kind) == ("shooting", "exact")
    assert exact.largest < 1e-10
    assert (exact.covered, shooting.covered) == (4, 4)
    assert exact.mean.least < exact.whole.least  # which needs no orbits


# --- places kept --------------------------------------------------------------------------------------------------

WITH_TROUBLE = LIST.replace("[1, 2, 4, 8]", "[1, 13, 2, 4, 8]") + "      - {kind: another, label: good}\n"


def test_a_method_that_refuses_points_keeps_its_place_with_the_reason() -> None:
    found = measured(WITH_TROUBLE)
    row = found.rows[0]

    written(found)

    assert (row.points, row.counts["ok"], row.counts["refused"]) == (5, 4, 1)
    assert row.largest == pytest.approx(1e-3)
    assert "1 refused: thirteen, of all numbers" in Path("out/A.md").read_text()
    assert "1 refused: thirteen, of all numbers" in bench.bench_summary([found])


def test_a_method_that_fails_keeps_its_place_in_tables_and_chart(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Off, "troubles", dict.fromkeys(SPEEDS, breaks_down))
    found = measured(LIST + "      - another\n")

    written(found)
    drawn = pictures.curve_figure(found)

    failed, good = rows_of(found, "off"), rows_of(found, "another")
    assert [row.counts["failed"] for row in failed] == [4, 4]
    assert good[0].counts["ok"] == 4
    assert Path("out/A.md").read_text().count("float division by zero") == 2
    (legend,) = drawn.legends
    said = [text.get_text().replace("\n", " ") for text in legend.get_texts()]
    assert said == ["off; 4 failed: ZeroDivisionError: float division by zero", "another"]


def test_peers_that_are_not_installed_are_one_line_and_no_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(base, "find_spec", lambda name: None)
    peers = "".join(f"      - {{kind: {name}, tolerance: [1.0e-3, 1.0e-6]}}\n" for name in PEERS)

    found = measured(f"{LIST}    peers:\n{peers}")

    assert {row.contender.label for row in found.rows} == {"off"}
    assert found.left_out == {name: f"not installed: {peer.remedy}" for name, peer in PEERS.items()}
    for told in (bench.bench_summary([found]), found.markdown()):
        (line,) = (line for line in told.splitlines() if "not installed" in line)
        assert line.removeprefix("- ").startswith(f"Peers left out: {', '.join(PEERS)} (not installed: ")
    assert {text.get_text() for text in pictures.curve_figure(found).legends[0].get_texts()} == {"off"}


def test_few_points_of_a_curve_are_spread_over_it() -> None:
    assert chosen(64, None) == list(range(64))
    assert chosen(64, 4) == [0, 21, 42, 63]
    assert chosen(3, 8) == [0, 1, 2]
    assert measured(LIST.replace("1.0e-6]", "1.0e-6], points: 2")).rows[0].points == 2


# --- time ---------------------------------------------------------------------------------------------------------


def clock(monkeypatch: pytest.MonkeyPatch, spent: Sequence[float]) -> None:
    """A clock on which a task takes these times, one after the other."""
    ticks = iter([tick for each in spent for tick in (0.0, each)])
    monkeypatch.setattr(time, "perf_counter", lambda: next(ticks))


def test_the_time_of_a_task_is_the_least_of_its_repeats(monkeypatch: pytest.MonkeyPatch) -> None:
    clock(monkeypatch, [4.0, 2.0, 3.0, 9.0])

    times = time_task(lambda: None, repeats=4, seconds=100.0)

    assert times == Times(2.0, (2.75, 3.5, 5.25), 4)
    assert times.each_of(2).least == 1.0


def test_the_summary_takes_the_cheapest_setting_that_is_good_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    found = measured(LIST + "      - {kind: another, label: good}\n")
    told = bench.bench_summary([found]).splitlines()

    off, good = (line.split() for line in told[2:])
    assert off[-1] == off[-2] == "-"  # 1e-9 and 1e-12: off by 1e-6 at best
    assert "-" not in good
    assert any("(1)" in word for word in good)


# --- the command and the list -------------------------------------------------------------------------------------


def test_the_command_writes_a_chart_and_tables_per_curve(capsys: pytest.CaptureFixture[str]) -> None:
    Path("list.yaml").write_text(LIST)

    assert cli.main(["bench", "list.yaml"]) == 0

    out, err = capsys.readouterr()
    assert out.startswith("A: us per point")
    assert "A: off, by 0.001" in err
    written = sorted(path.name for path in Path("runs/bench-list").iterdir())
    assert written == ["A.csv", "A.md", "A.png", "A.svg", "bench.json", "index.html"]


@deep("seconds of a bench")
def test_an_interrupted_bench_keeps_the_curves_that_are_done(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupt() -> None:
        raise KeyboardInterrupt

    second = LIST.partition("  - name: A\n")[2].replace("[1, 2, 4, 8]", "[1, 3]")
    Path("list.yaml").write_text(f"{LIST}  - name: B\n{second}")
    monkeypatch.setattr(Off, "troubles", {3.0: interrupt})

    assert cli.main(["bench", "list.yaml", "-o", "out"]) == 130

    assert "interrupted: 1 of 2 curves done" in capsys.readouterr().err
    assert Path("out/A.csv").exists()
    assert not Path("out/B.csv").exists()


# --- sections -----------------------------------------------------------------------------------------------------


@deep("seconds of a bench")
def test_a_list_may_have_sections_alone(capsys: pytest.CaptureFixture[str]) -> None:
    stability = "{steppers: [sdirk2, rk4], problems: [bristle], grid: 3}"
    orders = "{motions: [smooth], steppers: [moreau_1]}"
    Path("list.yaml").write_text(f"schema: 1\norders: {orders}\nstability: {stability}\n")

    assert cli.main(["bench", "list.yaml", "-o", "out", "--only", "orders", "--only", "stability_rk4"]) == 0

    told = capsys.readouterr().out
    assert told.startswith("orders: 1 of 1 asymptotic, 1 of them within 0.1 of theory\n")
    assert "\n\nstability_rk4, bristle: 9 points" in told
    written = [f"{name}.{kind}" for name in ("orders", "stability_rk4") for kind in ("csv", "png", "svg")]
    assert sorted(path.name for path in Path("out").iterdir()) == ["bench.json", "index.html", *written]


@pytest.mark.parametrize(
    ("section", "told"),
    [
        ("orders: {motions: [smoth]}", "did you mean 'smooth'"),
        ("orders: false", "must be a mapping"),
    ],
)
def test_a_wrong_request_of_a_section_is_told(section: str, told: str) -> None:
    Path("list.yaml").write_text(f"schema: 1\n{section}\n")

    with pytest.raises(StudyError, match=told):
        bench.load_bench(Path("list.yaml"))


@deep("more kernels to compile")
def test_a_section_is_chosen_by_name_beside_curves(capsys: pytest.CaptureFixture[str]) -> None:
    Path("list.yaml").write_text(f"{LIST}stability: {{steppers: [sdirk2], problems: [bristle], grid: 2}}\n")

    assert cli.main(["bench", "list.yaml", "--only", "stability_sdirk2", "-o", "out"]) == 0
    assert capsys.readouterr().out.startswith("stability_sdirk2, bristle: 4 points")
    assert cli.main(["bench", "list.yaml", "--only", "three"]) == 2
    assert "no curve or section 'three' in the list; there are A, stability_sdirk2" in capsys.readouterr().err


MISTAKES = [
    ("mu: 0.4", "mu: -1", "list.yaml:7:", "scenes[0].laws[0].mu: must be > 0, got -1"),
    ("name: A", "name: a/b", "list.yaml:5:", "scenes[0].name: names a file"),
    ("sweep: {", "sweep: {scene.normal_load: [1, 2], ", "list.yaml:8:", "sweeps the belt speed alone"),
    ("kind: off", "kind: auto", "list.yaml:11:", "auto only chooses"),
    ("by: [", "says: [4], by: [", "list.yaml:11:", "only one value may be a list"),
    ("known.csv", "unknown.csv", "list.yaml:9:", "scenes[0].references[0].values: must be a CSV file"),
    ("known.csv", "list.yaml", "list.yaml:9:", "must be a CSV file of numbers with the columns belt_speed"),
    ("    references: [{values: known.csv, error: 1.0e-15}]\n", "", "list.yaml:5:", "no references"),
    ("methods:", "peers:", "list.yaml:11:", "must be one of scipy, scipy_events, scipy_bristle, heyoka"),
]


@pytest.mark.parametrize(("old", "new", "where", "what"), MISTAKES, ids=[what for *_, what in MISTAKES])
def test_a_wrong_list_is_told_where_and_what(
    old: str, new: str, where: str, what: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert LIST.count(old) >= 1
    Path("list.yaml").write_text(LIST.replace(old, new))

    assert cli.main(["bench", "list.yaml"]) == 2

    out, err = capsys.readouterr()
    assert out == ""
    assert where in err
    assert what in err
    assert "Traceback" not in err
    assert not Path("runs").exists()


def test_two_curves_whose_files_would_be_one_are_refused() -> None:
    second = LIST.partition("  - name: A\n")[2].replace(
        "mu: 0.4}", "mu: 0.4}, {kind: coulomb, mu: 0.3, label: x y}"
    )
    Path("list.yaml").write_text(f"{LIST.replace('name: A', 'name: B_x_y')}  - name: B\n{second}")

    with pytest.raises(StudyError, match="'B_x_y' and 'B x y' would be written to files of one name"):
        bench.load_bench(Path("list.yaml"))


def test_what_is_no_list_is_told_as_a_list(tmp_path: Path) -> None:
    (tmp_path / "empty.yaml").write_text("")

    with pytest.raises(StudyError, match="the bench list is empty"):
        bench.load_bench(tmp_path / "empty.yaml")
    with pytest.raises(StudyError, match="is a folder"):
        bench.load_bench(tmp_path)


def test_the_lists_of_the_documents_have_no_mistakes_and_values_at_their_belt_speeds() -> None:
    curves = [
        curve for name in ("standard", "bristle") for curve in bench.load_bench(LISTS / f"{name}.yaml").curves
    ]

    assert [curve.name for curve in curves][:8] == ["W1", "W1g", "W2", "W5", "W3_0.5", "W3_4", "W3_10", "W4a"]
    for work in (curve.work for curve in curves):
        speeds = np.array(work.speeds())
        for trusted in (each for each in work.references if each.values):
            assert all(np.isclose(speeds, speed, rtol=1e-13, atol=0.0).any() for speed in trusted.values)
            assert len(trusted.values) >= 0.5 * len(speeds)


# --- peers --------------------------------------------------------------------------------------------------------

LAW = Coulomb(mu=0.4)
SLIDING = Scene(
    damping_ratio=0.1, normal_load=10.0, belt_speed=20.0, drive=Drive(unbalance=10.0, frequency=1.0)
)
STICKING = Scene(
    damping_ratio=0.1, normal_load=10.0, belt_speed=0.5, drive=Drive(amplitude=2.5, frequency=0.5)
)
PLANAR = Scene(
    damping_ratio=0.1,
    normal_load=1.0,
    belt_speed=0.5,
    drive=Drive(unbalance=10.0, frequency=4.0),
    transverse=Transverse(natural_frequency=4.0, damping_ratio=0.1, load=Load(unbalance=10.0)),
)
PLANAR_MEAN = 0.001269402004447  # by collocation


@pytest.mark.parametrize("name", ["scipy_events", "heyoka"])
@pytest.mark.parametrize("scene", [SLIDING, STICKING], ids=["sliding", "sticking"])
def test_a_peer_with_events_finds_the_mean_friction(name: str, scene: Scene) -> None:
    peer = PEERS[name]()
    pytest.importorskip(peer.package)
    expected = with_columns(Exact(), [scene], LAW, 1e-11).columns["mean_friction"]

    assert peer.solve([scene], LAW, 1e-9) == pytest.approx(expected, abs=1e-7)


@pytest.mark.parametrize("name", ["scipy", "heyoka"])
def test_a_peer_in_the_plane_finds_the_mean_friction(name: str) -> None:
    peer = PEERS[name]()
    pytest.importorskip(peer.package)

    assert peer.solve([PLANAR], LAW, 1e-6) == pytest.approx([PLANAR_MEAN], abs=1e-4)


@pytest.mark.parametrize("name", ["scipy", "heyoka"])
def test_a_scene_that_a_peer_gives_up_leaves_the_others_their_answers(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def solve(peer: Any, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Any:
        if any(scene.belt_speed == 2.0 for scene in scenes):
            raise ArithmeticError("gave up")
        return np.array([0.1 for _ in scenes])

    monkeypatch.setattr(PEERS[name], "solve", solve)
    monkeypatch.setattr(base, "find_spec", lambda name: True)

    found = solve_points(PEERS[name](), [SLIDING.at(speed) for speed in SPEEDS], LAW, 1e-6)

    assert found.status == ["ok", "failed", "ok", "ok"]
    assert found.reason[1] == "gave up"


@pytest.mark.parametrize("name", ["scipy", "scipy_events", "heyoka"])
def test_a_peer_refuses_what_it_is_not_set_up_for(name: str) -> None:
    peer = PEERS[name]()
    pytest.importorskip(peer.package)

    assert "Coulomb" in (peer.refusal(SLIDING, Coulomb(mu=0.4, mu_static=0.5)) or "")
    assert "Coulomb" in (peer.refusal(SLIDING, BRISTLES) or "")
    assert (peer.refusal(PLANAR, LAW) is None) == (name != "scipy_events")


# --- peers of bristle laws ----------------------------------------------------------------------------------------

BRISTLES = LuGre(mu_kinetic=0.4, presliding_length=5e-2, damping=4e-4)
BRISTLES_MEAN = 0.23164774756257994  # bristles W4a of truth.csv
IN_THE_PLANE = ElastoPlastic(mu_kinetic=0.4, presliding_length=1.0)
MEAN_IN_THE_PLANE = 0.012659382313928562  # bristles plane of truth.csv


def test_a_peer_of_bristle_laws_finds_the_mean_friction() -> None:
    peer = PEERS["scipy_bristle"]()
    planar = PLANAR.model_copy(update={"belt_speed": 5.0})

    assert peer.solve([SLIDING.at(27.0)], BRISTLES, 1e-6) == pytest.approx([BRISTLES_MEAN], abs=1e-5)
    assert peer.solve([planar], IN_THE_PLANE, 1e-5) == pytest.approx([MEAN_IN_THE_PLANE], abs=1e-4)
