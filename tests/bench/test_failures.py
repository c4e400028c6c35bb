"""Failure maps: what a method says at every point of a grid, how far that is from the truth, and where it lies."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest
from fake_methods import Another, Fake, register
from profiles import deep

from frictionlab import bench, cli
from frictionlab.bench.failure_maps import MapTruth, edges, free_velocities
from frictionlab.bench.failures import FailureResult
from frictionlab.bench.peers.equations import ScipySteps
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers
from frictionlab.scene.scene import Scene
from frictionlab.values.notes import StudyError
from frictionlab.values.quantities import Finite, Floats

LIST = """\
schema: 1
failures:
  - name: load
    title: Coulomb friction
    scene: {damping_ratio: 0.1, belt_speed: 1, drive: {amplitude: 10, frequency: 1}}
    laws: [{kind: coulomb, mu: 0.4}]
    sweep:
      scene.belt_speed: [1, 2, 4, 13]
      scene.normal_load: {start: 2.5, stop: 250, num: 3, spacing: log}
    points: [{name: S2, scene.belt_speed: 0.5, scene.normal_load: 10}]
    references: [{kind: another, tolerance: 1.0e-9}]
    methods: [METHODS]
"""


class Liar(Fake):
    """The fake, off by so much above belt speed 1 and saying half of it; without one state above belt speed 3."""

    name: ClassVar[str] = "liar"

    by: Finite = 1e-3
    says: Finite = 5e-4

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        answers = super().solve(scenes, law, tolerance)
        speeds = np.array([scene.belt_speed for scene in scenes])
        status: list[Any] = ["not_unique" if speed > 3.0 else "ok" for speed in speeds]
        return replace(
            answers,
            status=status,
            mean=answers.mean + np.where(speeds > 1.0, self.by, 0.0),
            error=np.full(len(scenes), self.says),
        )


@pytest.fixture(autouse=True)
def _fakes_and_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    register(monkeypatch, fake=Fake, another=Another, liar=Liar)
    monkeypatch.chdir(tmp_path)


def measured(methods: str = "liar", text: str = LIST) -> list[Any]:
    """The failure maps of every method of a list."""
    Path("list.yaml").write_text(text.replace("METHODS", methods))
    return list(bench.measure(bench.load_bench(Path("list.yaml")), lambda line: None))


def outcomes(result: FailureResult) -> list[list[str]]:
    """What each point of the first map came to, a row for each value."""
    return [[point.outcome for point in row] for row in result.outcomes[0].grid]


# --- what a point comes to ----------------------------------------------------------------------------------------


def test_a_method_that_lies_is_counted_as_wrong_without_a_word() -> None:
    (result,) = measured()

    assert outcomes(result) == [["ok", "silent", "not_unique", "refused"]] * 3
    assert result.counts() == {"ok": 4, "silent": 3, "not_unique": 3, "refused": 3}  # S2 is at belt speed .5
    assert result.outcomes[0].grid[0][1].true == pytest.approx(1e-3)
    assert result.outcomes[0].grid[0][1].stated == 5e-4


def test_the_reference_s_own_error_is_granted() -> None:
    (result,) = measured(text=LIST.replace("tolerance: 1.0e-9", "tolerance: 6.0e-4"))

    assert result.counts()["silent"] == 0
    assert [point.undecided for point in result.outcomes[0].grid[0]] == [False, True, False, False]
    assert "known to\nload" in result.summary()
    assert "6e-04" in result.summary()


def test_a_peer_is_silently_wrong_above_ten_times_the_tolerance_asked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def off(peer: ScipySteps, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Floats:
        by = {1.0: 1e-7, 2.0: 0.9e-5, 4.0: 1.1e-5, 13.0: np.nan, 0.5: 0.0}
        return np.array([0.4 * math.tanh(scene.belt_speed) / 3.0 + by[scene.belt_speed] for scene in scenes])

    monkeypatch.setattr(ScipySteps, "solve", off)
    (result,) = measured(text=LIST.replace("methods: [METHODS]", "peers: [{kind: scipy, tolerance: 1.0e-6}]"))

    assert outcomes(result) == [["ok", "ok", "silent", "failed"]] * 3
    assert all(math.isnan(point.stated) for point in result.outcomes[0].points)


def test_the_methods_here_are_never_silently_wrong_on_a_small_map() -> None:
    references = "[{kind: shooting, tolerance: 1.0e-10}, {kind: exact, tolerance: 1.0e-11}]"
    text = LIST.replace("[{kind: another, tolerance: 1.0e-9}]", references).replace("13]", "60]")
    found = measured("exact, shooting, mdsm, harmonic_balance", text)

    names = [result.name.removeprefix("failures_") for result in found]
    assert names == ["exact", "shooting", "mdsm", "harmonic_balance"]
    for result in found:
        assert result.counts()["silent"] == 0
        assert result.counts()["ok"] >= 7
    assert max(point.true for point in found[0].outcomes[0].points) < 1e-9
    assert max(point.true for point in found[2].outcomes[0].points) > 1e-3  # what friction does to the motion


# --- what theory draws in -----------------------------------------------------------------------------------------


def truth_of(text: str) -> MapTruth:
    Path("list.yaml").write_text(text.replace("METHODS", "fake"))
    (section,) = bench.load_bench(Path("list.yaml")).sections
    truth: MapTruth = section.maps[0][0]  # type: ignore[attr-defined]  # of this kind of section
    return truth


def test_friction_holds_the_load_from_equal_sizes_on_and_the_axis_says_so() -> None:
    drawn = truth_of(LIST).drawn

    assert [drawn.ordinate(row) for row in drawn.rows] == pytest.approx([0.1, 1.0, 10.0])
    assert edges(drawn)["rest"] == pytest.approx([1.0])


def test_the_free_velocity_is_the_load_over_the_damping_at_resonance() -> None:
    speeds, _ = free_velocities(truth_of(LIST).drawn)

    assert speeds == pytest.approx([50.0] * 3)


def test_one_steady_state_is_proved_where_damping_outweighs_the_fall() -> None:
    fall = LIST.replace(
        "scene.normal_load: {start: 2.5, stop: 250", "scene.damping_ratio: {start: 0.01, stop: 3"
    )
    fall = fall.replace("damping_ratio: 0.1, belt", "normal_load: 10, belt").replace(
        "normal_load: 10}]", "damping_ratio: 1}]"
    )
    law = "{kind: stribeck, mu_kinetic: 0.2, mu_static: 0.4, stribeck_speed: 1, stribeck_exponent: 1}"
    edge = edges(truth_of(fall.replace("{kind: coulomb, mu: 0.4}", law)).drawn)["unique"]

    assert edge == pytest.approx([1.0])  # 10 * 0.2 = 2 damping_ratio
    assert edges(truth_of(LIST).drawn)["unique"] == ()


def test_where_the_mass_sticks_and_reverses_is_read_from_the_first_reference() -> None:
    text = LIST.replace("kind: another", "kind: exact").replace("13]", "60]")
    motions = truth_of(text).motions()

    assert motions["reverses"].tolist() == [[1, 1, 1, 0]] * 3
    assert motions["sticks"][2].tolist() == [1, 1, 1, 0]
    assert motions["sticks"][0, 0] == 0


# --- files --------------------------------------------------------------------------------------------------------


@deep("seconds of steps")
def test_the_command_writes_a_table_and_a_figure_for_each_method(capsys: pytest.CaptureFixture[str]) -> None:
    methods = "{kind: liar, label: a liar, by: 0.01}, fake"
    Path("list.yaml").write_text(LIST.replace("METHODS", methods))

    assert cli.main(["bench", "list.yaml", "-o", "out"]) == 0

    out, err = capsys.readouterr()
    assert out.startswith("Failure maps of a liar: points")
    assert "failures_a_liar: load\n" in err
    names = {path.name for path in Path("out").iterdir()}
    assert {
        f"failures_{name}.{kind}" for name in ("a_liar", "fake") for kind in ("csv", "svg", "png")
    } <= names
    rows = list(csv.DictReader(Path("out/failures_a_liar.csv").read_text().splitlines()))
    assert len(rows) == 13
    assert [row["point"] for row in rows if row["point"]] == ["S2"]
    assert {row["map"] for row in rows} == {"load"}
    silent = [row for row in rows if row["outcome"] == "silent"]
    assert [float(row["belt_speed"]) for row in silent] == [2.0] * 3
    assert all(float(row["true_error"]) > float(row["stated_error"]) for row in silent)
    drawn = Path("out/failures_a_liar.svg").read_text()
    assert len(drawn) < 250_000
    assert Path("out/failures_fake.svg").read_text() != drawn


SWEPT_TWICE = ", 13]\n      scene.damping_ratio: [0.1, 0.2]\n"
TWO_LAWS = "[{kind: coulomb, mu: 0.4}, {kind: dahl, mu: 0.4, stiffness: 4}]"
MISTAKES = [
    (", 13]\n", SWEPT_TWICE, "a map sweeps the belt speed and one other number"),
    ("[{kind: coulomb, mu: 0.4}]", TWO_LAWS, "one law, got 2"),
    ("[METHODS]", "[{kind: exact, tolerance: [1.0e-6, 1.0e-9]}]", "a map takes one setting"),
    ("scene.normal_load: 10}", "scene.damping: 10}", "failures[0].points[0]: give name, scene.belt"),
    ("    methods: [METHODS]\n", "", "failures[0]: no methods and no peers"),
]


@pytest.mark.parametrize(("old", "new", "told"), MISTAKES, ids=[told for *_, told in MISTAKES])
def test_a_wrong_map_is_told_where_and_what(old: str, new: str, told: str) -> None:
    assert LIST.count(old) >= 1
    Path("list.yaml").write_text(LIST.replace(old, new, 1).replace("METHODS", "fake"))

    with pytest.raises(StudyError) as caught:
        bench.load_bench(Path("list.yaml"))

    (mistake,) = caught.value.mistakes
    assert told in f"{mistake.path}: {mistake.what}"
