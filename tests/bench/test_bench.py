"""Work against precision: who is measured against whom, what keeps its place, and what a wrong list is told."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest
from answered import with_columns
from bench_lists import changed, measured, mistake, texts
from fake_methods import Another, Fake, breaks_down, register
from profiles import deep

from frictionlab import bench, cli
from frictionlab.bench.contenders import PEERS
from frictionlab.bench.curve import chosen, times_of
from frictionlab.bench.page import write_table
from frictionlab.bench.peers import base
from frictionlab.bench.peers.equations import ScipySteps
from frictionlab.bench.result import SectionResult
from frictionlab.bench.solve import solve_points, time_task
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
METHODS = LIST[LIST.index("      - {kind: off") :]
KNOWN = "{values: known.csv, error: 1.0e-15}"


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


def curve(text: str = LIST, **asked: Any) -> SectionResult:
    """The first curve of a list."""
    return measured(text, **asked)[0]


def errors(text: str = LIST) -> list[float]:
    """The largest errors on the first curve of a list."""
    return curve(text).table["largest_error"].tolist()


@deep("seconds of a bench")
def test_a_first_run_is_timed_of_methods_that_answer() -> None:
    plain = """      - {kind: exact, tolerance: [1.0e-6, 1.0e-9]}
    peers: [{kind: scipy, points: 1, tolerance: 1.0e-2}]
"""
    found = curve(changed(LIST, METHODS, plain), first_runs=True)

    first = found.table["first_run_s"]
    assert (
        1e6 * first[0] > 10.0 * (found.table["points"] * found.table["all_us"])[0]
    )  # most of it are imports
    assert first[1:].isna().tolist() == [True, True]
    assert f"| {first[0]:.4g} |" in written(found).with_suffix(".md").read_text()


def written(found: SectionResult) -> Path:
    """The table of a curve, in a folder of its own, with the same as Markdown."""
    Path("out").mkdir(exist_ok=True)
    (name,) = write_table(found, Path("out"))
    return Path("out", name)


# --- errors -------------------------------------------------------------------------------------------------------


def test_an_error_is_the_distance_from_the_reference() -> None:
    table = curve().table

    assert table["value"].tolist() == [1e-3, 1e-6]
    assert table["largest_error"].tolist() == pytest.approx([1e-3, 1e-6])
    assert table["median_error"][0] == pytest.approx(1e-3)


def test_a_stated_error_that_does_not_cover_is_counted() -> None:
    short, covering = curve().table, curve(changed(LIST, "error: 1.0e-15", "error: 1.0e-3")).table

    assert short["stated_error"][0] == pytest.approx(0.5e-3)
    assert (short["covered"][0], covering["covered"][0]) == (0, 4)


def test_a_method_is_never_measured_against_its_own_kind() -> None:
    own, other = "{kind: 'off', by: 0.1, tolerance: 1.0e-9}", "{kind: another, tolerance: 1.0e-9}"

    with_another = curve(changed(LIST, KNOWN, f"{own}, {other}")).table
    alone = curve(changed(LIST, KNOWN, own)).table

    assert {*with_another["reference"]} == {"another at 1e-09"}
    assert with_another["largest_error"][0] == pytest.approx(1e-3)
    assert alone[["reference", "reason"]].to_numpy().tolist() == [["", "no independent reference"]] * 2
    assert alone[["covered", "largest_error"]].isna().all(axis=None)


def test_the_reference_and_its_own_error_are_in_the_tables() -> None:
    file = written(curve())

    assert texts(file)[["reference", "reference_error"]].iloc[0].tolist() == ["known.csv", "1e-15"]
    assert "Reference of off: known.csv, known to 1.0e-15." in file.with_suffix(".md").read_text()


def test_a_peer_may_be_the_reference_known_to_what_a_looser_tolerance_changes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def solve(peer: ScipySteps, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Any:
        return np.array([0.4 * math.tanh(scene.belt_speed) / 3.0 + 2.0 * tolerance for scene in scenes])

    monkeypatch.setattr(ScipySteps, "solve", solve)
    own = changed(LIST, KNOWN, "{kind: scipy, tolerance: 1.0e-9, label: steps}")
    table = curve(own + "    peers: [{kind: scipy, tolerance: 1.0e-6}]\n").table

    assert table["reference"].tolist() == ["steps at 1e-09"] * 2 + [""]
    assert table["largest_error"][0] == pytest.approx(1e-3, rel=1e-5)
    assert table["reference_error"][0] == pytest.approx(10.0 * (2.0 * 99e-9 + 1e-9))
    assert table["reason"][2] == "no independent reference"


def test_exact_is_measured_against_shooting_and_shooting_against_exact() -> None:
    both = changed(LIST, KNOWN, "{kind: exact, tolerance: 1.0e-11}, {kind: shooting, tolerance: 1.0e-11}")
    both = changed(both, "repeats: 2", "repeats: 20")
    table = curve(changed(both, "{kind: off, by: [1.0e-3, 1.0e-6]}", "exact\n      - shooting")).table

    assert table["reference"].tolist() == ["shooting at 1e-11", "exact at 1e-11"]
    assert table["largest_error"][0] < 1e-10
    assert table["covered"].tolist() == [4, 4]
    assert table["mean_us"][0] < table["all_us"][0]  # which needs no orbits


# --- places kept --------------------------------------------------------------------------------------------------


def test_a_method_that_refuses_points_keeps_its_place_with_the_reason() -> None:
    trouble = changed(LIST, "[1, 2, 4, 8]", "[1, 13, 2, 4, 8]") + "      - {kind: another, label: good}\n"
    found = curve(trouble)

    assert found.table[["points", "ok", "refused"]].iloc[0].tolist() == [5, 4, 1]
    assert found.table["largest_error"][0] == pytest.approx(1e-3)
    for told in (written(found).with_suffix(".md").read_text(), bench.bench_summary([found])):
        assert "1 refused: thirteen, of all numbers" in told


def legend(found: SectionResult) -> list[str]:
    """What the legend of a figure says."""
    figure: Any = found.figure()
    return [text.get_text().replace("\n", " ") for text in figure.legends[0].get_texts()]


def test_a_method_that_fails_keeps_its_place_in_tables_and_chart(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Off, "troubles", dict.fromkeys(SPEEDS, breaks_down))
    found = curve(LIST + "      - another\n")

    assert found.table["solver"].tolist() == ["off", "off", "another"]
    assert found.table["failed"].tolist() == [4, 4, 0]
    assert found.table["ok"][2] == 4
    assert written(found).with_suffix(".md").read_text().count("float division by zero") == 2
    assert legend(found) == ["off; 4 failed: ZeroDivisionError: float division by zero", "another"]


def test_peers_that_are_not_installed_are_one_line_and_no_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(base, "find_spec", lambda name: None)
    peers = "".join(f"      - {{kind: {name}, tolerance: [1.0e-3, 1.0e-6]}}\n" for name in PEERS)

    found = curve(f"{LIST}    peers:\n{peers}")

    assert {*found.table["solver"]} == {"off"}
    assert found.left_out == {name: f"not installed: {peer.remedy}" for name, peer in PEERS.items()}
    for told in (bench.bench_summary([found]), written(found).with_suffix(".md").read_text()):
        (line,) = (line for line in told.splitlines() if "not installed" in line)
        assert line.removeprefix("- ").startswith(f"Peers left out: {', '.join(PEERS)} (not installed: ")
    assert legend(found) == ["off"]


def test_a_curve_of_peers_that_are_all_missing_has_no_table(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(base, "find_spec", lambda name: None)

    found = curve(changed(LIST, f"methods:\n{METHODS}", "peers: [heyoka]"))

    assert found.table.empty
    assert "A: us per point" in found.summary
    assert found.left_out.keys() == {"heyoka"}
    assert legend(found) == []


def test_few_points_of_a_curve_are_spread_over_it() -> None:
    assert chosen(64, None) == list(range(64))
    assert chosen(64, 4) == [0, 21, 42, 63]
    assert chosen(3, 8) == [0, 1, 2]
    assert curve(changed(LIST, "1.0e-6]", "1.0e-6], points: 2")).table["points"][0] == 2


# --- time ---------------------------------------------------------------------------------------------------------


def test_the_time_of_a_task_is_the_least_of_its_repeats(monkeypatch: pytest.MonkeyPatch) -> None:
    ticks = iter([tick for spent in (4.0, 2.0, 3.0, 9.0) for tick in (0.0, spent)])
    monkeypatch.setattr(time, "perf_counter", lambda: next(ticks))

    spent = time_task(lambda: None, repeats=4, seconds=100.0)

    assert times_of("mean", spent, 2) == {
        **{"mean_us": 1e6, "mean_us_q1": 1.375e6, "mean_us_q2": 1.75e6, "mean_us_q3": 2.625e6},
        "mean_repeats": 4,
    }


def test_the_summary_takes_the_cheapest_setting_that_is_good_enough() -> None:
    told = curve(LIST + "      - {kind: another, label: good}\n").summary.splitlines()

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


@deep("more kernels to compile")
def test_a_section_is_chosen_by_name_beside_curves(capsys: pytest.CaptureFixture[str]) -> None:
    Path("list.yaml").write_text(f"{LIST}stability: {{steppers: [sdirk2], problems: [bristle], grid: 2}}\n")

    assert cli.main(["bench", "list.yaml", "--only", "stability_sdirk2", "-o", "out"]) == 0
    assert capsys.readouterr().out.startswith("stability_sdirk2, bristle: 4 points")
    assert cli.main(["bench", "list.yaml", "--only", "three"]) == 2
    assert "no curve or section 'three' in the list; there are A, stability_sdirk2" in capsys.readouterr().err


MISTAKES = [
    ("title: Fakes", "orders: {motions: [smoth]}", "list.yaml:2:", "did you mean 'smooth'"),
    ("title: Fakes", "orders: false", "list.yaml:2:", "orders: must be a mapping"),
    ("  - name: A", "  - 5\n  - name: A", "list.yaml:5:", "scenes[0]: must be a mapping, got 5"),
    ("[{values", "[{kind: exact}, {values", "list.yaml:9:", "references[0].tolerance: give the one"),
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
    Path("list.yaml").write_text(changed(LIST, old, new))

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
    text = f"{changed(LIST, 'name: A', 'name: B_x_y')}  - name: B\n{second}"

    assert mistake(text).what.startswith("'B_x_y' and 'B x y' would be written to files of one name")


def test_what_is_no_list_is_told_as_a_list(tmp_path: Path) -> None:
    assert "the bench list is empty" in mistake("").what
    with pytest.raises(StudyError, match="is a folder"):
        bench.load_bench(tmp_path)


def test_the_lists_of_the_documents_have_no_mistakes_and_values_at_their_belt_speeds() -> None:
    curves = [
        each for name in ("standard", "bristle") for each in bench.load_bench(LISTS / f"{name}.yaml").curves
    ]

    assert [each.name for each in curves][:8] == ["W1", "W1g", "W2", "W5", "W3_0.5", "W3_4", "W3_10", "W4a"]
    for work in (each.work for each in curves):
        for values in (each.values for each in work.references if each.values is not None):
            assert all(np.isclose(work.speeds, at, rtol=1e-13, atol=0.0).any() for at in values)
            assert len(values) >= 0.5 * len(work.speeds)


# --- peers --------------------------------------------------------------------------------------------------------

LAW = Coulomb(mu=0.4)
LINE = Scene(damping_ratio=0.1, normal_load=10, belt_speed=20, drive=Drive(unbalance=10, frequency=1))
STICKING = LINE.model_copy(update={"belt_speed": 0.5, "drive": Drive(amplitude=2.5, frequency=0.5)})
ACROSS = Transverse(natural_frequency=4, damping_ratio=0.1, load=Load(unbalance=10))
UNBALANCE = Drive(unbalance=10, frequency=4)
PLANE = Scene(damping_ratio=0.1, normal_load=1, belt_speed=0.5, drive=UNBALANCE, transverse=ACROSS)
BRISTLES = LuGre(mu_kinetic=0.4, presliding_length=5e-2, damping=4e-4)
IN_THE_PLANE = ElastoPlastic(mu_kinetic=0.4, presliding_length=1.0)
ON_THE_LINE = [(name, LAW, scene, 1e-9) for name in ("scipy_events", "heyoka") for scene in (LINE, STICKING)]
MEANS = [
    *((*case, None, 1e-7) for case in ON_THE_LINE),
    *((name, LAW, PLANE, 1e-6, 0.001269402004447, 1e-4) for name in ("scipy", "heyoka")),  # by collocation
    ("scipy_bristle", BRISTLES, LINE.at(27.0), 1e-6, 0.23164774756257994, 1e-5),  # W4a of truth.csv
    ("scipy_bristle", IN_THE_PLANE, PLANE.at(5.0), 1e-5, 0.012659382313928562, 1e-4),  # plane of truth.csv
]


@pytest.mark.parametrize(("name", "law", "scene", "tolerance", "mean", "off"), MEANS)
def test_a_peer_finds_the_mean_friction(
    name: str, law: FrictionLaw, scene: Scene, tolerance: float, mean: float | None, off: float
) -> None:
    """That of the method exact where no mean is given."""
    peer = PEERS[name]()
    pytest.importorskip(peer.package)
    expected = with_columns(Exact(), [scene], law, 1e-11).columns["mean_friction"] if mean is None else [mean]

    assert peer.solve([scene], law, tolerance) == pytest.approx(expected, abs=off)


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

    found = solve_points(PEERS[name](), [LINE.at(speed) for speed in SPEEDS], LAW, 1e-6)

    assert found["status"].tolist() == ["ok", "failed", "ok", "ok"]
    assert found["reason"][1] == "gave up"


@pytest.mark.parametrize("name", ["scipy", "scipy_events", "heyoka"])
def test_a_peer_refuses_what_it_is_not_set_up_for(name: str) -> None:
    peer = PEERS[name]()
    pytest.importorskip(peer.package)

    assert "Coulomb" in (peer.refusal(LINE, Coulomb(mu=0.4, mu_static=0.5)) or "")
    assert "Coulomb" in (peer.refusal(LINE, BRISTLES) or "")
    assert (peer.refusal(PLANE, LAW) is None) == (name != "scipy_events")
