"""Failure maps: what a method says at every point of a grid, how far that is from the truth, and where it lies."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest
from bench_lists import changed, loaded, measured, mistake, texts
from fake_methods import Another, Fake, register
from profiles import deep

from frictionlab import cli
from frictionlab.bench.failure_maps import FailureMap
from frictionlab.bench.failures import FailureSection
from frictionlab.bench.peers.equations import ScipySteps
from frictionlab.bench.result import SectionResult
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers
from frictionlab.scene.scene import Scene
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


def outcomes(result: SectionResult) -> list[list[str]]:
    """What each point of the first map came to, a row for each value."""
    grid = result.table[result.table["point"] == ""]
    return grid["outcome"].to_numpy().reshape(3, 4).tolist()


# --- what a point comes to ----------------------------------------------------------------------------------------

LIES = LIST.replace("METHODS", "liar")


def test_a_method_that_lies_is_counted_as_wrong_without_a_word() -> None:
    (result,) = measured(LIES)

    assert outcomes(result) == [["ok", "silent", "not_unique", "refused"]] * 3
    counts = result.table["outcome"].value_counts().to_dict()  # S2 is at belt speed .5
    assert counts == {"ok": 4, "silent": 3, "not_unique": 3, "refused": 3}
    assert result.table[["true_error", "stated_error"]].iloc[1].tolist() == pytest.approx([1e-3, 5e-4])


def test_the_reference_s_own_error_is_granted() -> None:
    (result,) = measured(changed(LIES, "tolerance: 1.0e-9", "tolerance: 6.0e-4"))

    assert outcomes(result) == [["ok", "ok", "not_unique", "refused"]] * 3
    assert (result.table["stated_error"] < result.table["true_error"]).tolist()[:4] == [
        False,
        True,
        False,
        False,
    ]
    assert "known to\nload" in result.summary
    assert "6e-04" in result.summary


def test_a_peer_is_silently_wrong_above_ten_times_the_tolerance_asked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def off(peer: ScipySteps, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Floats:
        by = {1.0: 1e-7, 2.0: 0.9e-5, 4.0: 1.1e-5, 13.0: np.nan, 0.5: 0.0}
        return np.array([0.4 * math.tanh(scene.belt_speed) / 3.0 + by[scene.belt_speed] for scene in scenes])

    monkeypatch.setattr(ScipySteps, "solve", off)
    (result,) = measured(changed(LIST, "methods: [METHODS]", "peers: [{kind: scipy, tolerance: 1.0e-6}]"))

    assert outcomes(result) == [["ok", "ok", "silent", "failed"]] * 3
    assert result.table["stated_error"].isna().all()


REVERSING = changed(LIST, "13]", "60]")


def test_the_methods_here_are_never_silently_wrong_on_a_small_map() -> None:
    references = "[{kind: shooting, tolerance: 1.0e-10}, {kind: exact, tolerance: 1.0e-11}]"
    text = changed(REVERSING, "[{kind: another, tolerance: 1.0e-9}]", references)
    names = ["exact", "shooting", "mdsm", "harmonic_balance"]
    found = measured(changed(text, "METHODS", ", ".join(names)))

    assert [result.name.removeprefix("failures_") for result in found] == names
    for result in found:
        assert "silent" not in set(result.table["outcome"])
        assert (result.table["outcome"] == "ok").sum() >= 7
    assert found[0].table["true_error"].max() < 1e-9
    assert found[2].table["true_error"].max() > 1e-3  # what friction does to the motion


# --- what theory draws in -----------------------------------------------------------------------------------------


def drawn(text: str = LIST) -> FailureMap:
    """The map of a list."""
    (section,) = loaded(text.replace("METHODS", "fake")).sections
    assert isinstance(section, FailureSection)
    return section.maps[0][0]


PROVED, HELD = "one steady state proved: edge", "friction holds the load: edge"


def test_friction_holds_the_load_from_equal_sizes_on_and_the_axis_says_so() -> None:
    found = drawn()

    assert [found.ordinate(row) for row in found.grid_rows] == pytest.approx([0.1, 1.0, 10.0])
    assert found.edges()[HELD] == pytest.approx([1.0])


def test_the_free_velocity_is_the_load_over_the_damping_at_resonance() -> None:
    assert drawn().free_velocities() == pytest.approx([50.0] * 3)


def test_one_steady_state_is_proved_where_damping_outweighs_the_fall() -> None:
    fall = changed(
        LIST, "scene.normal_load: {start: 2.5, stop: 250", "scene.damping_ratio: {start: 0.01, stop: 3"
    )
    fall = changed(fall, "damping_ratio: 0.1, belt", "normal_load: 10, belt")
    fall = changed(fall, "normal_load: 10}]", "damping_ratio: 1}]")
    law = "{kind: stribeck, mu_kinetic: 0.2, mu_static: 0.4, stribeck_speed: 1, stribeck_exponent: 1}"
    edge = drawn(changed(fall, "{kind: coulomb, mu: 0.4}", law)).edges()[PROVED]

    assert edge == pytest.approx([1.0])  # 10 * 0.2 = 2 damping_ratio
    assert drawn().edges()[PROVED] == []


def test_where_the_mass_sticks_and_reverses_is_read_from_the_first_reference() -> None:
    motions = drawn(changed(REVERSING, "kind: another", "kind: exact")).motions()
    turning, sticking = (motions[name].reshape(3, 4) for name in ("end of reversal", "stick window"))

    assert turning.tolist() == [[1, 1, 1, 0]] * 3
    assert sticking[2].tolist() == [1, 1, 1, 0]
    assert sticking[0, 0] == 0


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
    table = texts(Path("out/failures_a_liar.csv"))
    assert len(table) == 13
    assert [name for name in table["point"] if name] == ["S2"]
    assert {*table["map"]} == {"load"}
    silent = table.loc[table["outcome"] == "silent", ["belt_speed", "true_error", "stated_error"]].astype(
        float
    )
    assert silent["belt_speed"].tolist() == [2.0] * 3
    assert (silent["true_error"] > silent["stated_error"]).all()
    picture = Path("out/failures_a_liar.svg").read_text()
    assert len(picture) < 250_000
    assert Path("out/failures_fake.svg").read_text() != picture


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
    found = mistake(changed(LIST, old, new).replace("METHODS", "fake"))

    assert told in f"{found.path}: {found.what}"
