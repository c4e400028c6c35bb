"""A law's parameter may be several numbers: in a study, in the table, in SI units, in lists of what is installed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd
import pytest

import frictionlab as fl
from frictionlab.study.load import parse_study
from frictionlab.study.records import law_record
from frictionlab.study.registry import law_class
from frictionlab.study.schema import schema
from frictionlab.values.notes import StudyError

LAW = {"kind": "maxwell-slip", "mu": [0.3, 0.1], "stiffness": [40, 5.5]}
SLIP = {"belt_speed": 5, "slip": {"velocity_amplitude": 10, "frequency": 1}}
BODY = {
    **{"mass_kg": 2, "stiffness_N_per_m": 800, "damping_N_s_per_m": 4, "length_m": 0.01, "belt_speed_m_per_s": 0.1},
    "drive": {"amplitude_N": 3, "frequency_rad_per_s": 15},
}  # fmt: skip


def study(law: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {"schema": 1, "scene": SLIP, "laws": [law], **more}


def mistakes(tree: dict[str, Any]) -> list[str]:
    with pytest.raises(StudyError) as problem:
        parse_study(tree)
    return [f"{mistake.path}: {mistake.what}" for mistake in problem.value.mistakes]


def test_a_study_with_a_list_loads_back_to_the_same_study() -> None:
    plan = parse_study(study(LAW))

    assert plan.resolved()["laws"] == [LAW]
    assert parse_study(plan.resolved()).resolved() == plan.resolved()
    assert parse_study(plan.resolved()).digest() == plan.digest()
    assert parse_study(study(LAW | {"stiffness": [40, 5.4]})).digest() != plan.digest()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"mu": 3}, "laws[0].mu: must be a list such as [1, 2], got 3"),
        ({"mu": []}, "laws[0].mu: must be a list of at least 1, got 0"),
        ({"mu": [1, "x"]}, "laws[0].mu[1]: must be a number, got the text 'x'"),
        ({"mu": [1, -1]}, "laws[0].mu[1]: must be > 0, got -1"),
        ({"mu": [1, 2, 3]}, "laws[0].stiffness: must have as many values as mu, 3, got 2"),
    ],
)
def test_a_mistake_in_a_list_is_told_at_its_place(change: dict[str, Any], said: str) -> None:
    assert said in mistakes(study(LAW | change))


def test_a_list_is_not_swept() -> None:
    assert mistakes(study(LAW, sweep={"laws.maxwell-slip.mu": [1, 2]})) == [
        "sweep.laws.maxwell-slip.mu: mu of the law 'maxwell-slip' is not one number: "
        "give a law of its own for each of its values"
    ]


def test_every_number_of_a_list_has_a_column_in_every_table_and_a_run_is_taken_over(tmp_path: Path) -> None:
    plan = study(LAW, methods=["mdsm"], columns=["seconds"])
    plan["laws"] += [{"kind": "jenkins", "mu": 0.4, "stiffness": 2}]
    first = fl.run(plan, out=tmp_path / "run").table
    again = fl.run(plan, out=tmp_path / "run").table

    for table in (
        again,
        pd.read_csv(tmp_path / "run" / "results.csv"),
        pd.read_parquet(tmp_path / "run" / "results.parquet"),
    ):
        assert table.loc[0, ["law.stiffness[0]", "law.stiffness[1]"]].tolist() == [40.0, 5.5]
        assert table["law.mu"].fillna(-1.0).tolist() == [-1.0, 0.4]
        assert table["law.mu[0]"].fillna(-1.0).tolist() == [0.3, -1.0]
        assert list(table["seconds"].fillna(-1.0)) == list(first["seconds"].fillna(-1.0))


def test_every_number_of_a_list_in_si_units_is_scaled() -> None:
    plan = study(LAW, methods=["mdsm"], columns=["seconds"]) | {"scene": {"dimensional": BODY}}
    table = fl.run(plan).table

    (law,) = parse_study(plan).laws_in_scenes(parse_study(plan).laws[0])
    assert law.numbers()["stiffness"] == pytest.approx((0.4, 0.055))  # times L = 0.01 m
    assert law.numbers()["mu"] == (0.3, 0.1)
    assert list(table["law.stiffness[1]"]) == [5.5]
    assert list(table["law.nondimensional.stiffness[1]"]) == pytest.approx([0.055])


def test_a_listing_and_the_schema_say_that_it_is_a_list() -> None:
    found = {
        parameter["name"]: parameter
        for parameter in law_record("maxwell-slip", law_class("maxwell-slip"))["parameters"]
    }
    kinds = {kind["title"]: kind for kind in schema()["properties"]["laws"]["items"]["oneOf"]}

    assert found["stiffness"]["limits"] == "a list, each > 0"
    assert found["stiffness"]["unit"] == "1/m"
    assert kinds["maxwell-slip"]["properties"]["mu"]["type"] == "array"
    assert kinds["maxwell-slip"]["properties"]["mu"]["items"] == {"exclusiveMinimum": 0, "type": "number"}
    assert kinds["maxwell-slip"]["properties"]["mu"]["minItems"] == 1


def test_the_curves_of_a_bristle_law_with_a_list_are_read(tmp_path: Path) -> None:
    (tmp_path / "two.py").write_text(
        "import frictionlab as fl\n"
        "class Two(fl.BristleLaw):\n"
        "    'Dahl friction of two limits that add up. Source: Dahl (1968).'\n"
        "    mu: tuple[fl.Positive, ...]\n"
        "    def sliding_friction(self, speed): return self.mu[0] + self.mu[1]\n"
        "    def rate(self, v, z): return v - abs(v) / (self.mu[0] + self.mu[1]) * z\n"
        "    def friction(self, v, z, dz): return z\n"
        "    def largest_deflection(self): return self.mu[0] + self.mu[1]\n"
    )
    (tmp_path / "study.yaml").write_text(
        "schema: 1\nplugins: [two.py]\nlaws: [{kind: two, mu: [0.3, 0.1]}]\nmethods: [mdsm]\n"
        "scene: {belt_speed: 1, slip: {velocity_amplitude: 10, frequency: 1}}\n"
        "sweep: {scene.belt_speed: {start: 1, stop: 9, num: 3}}\n"
    )

    fl.run(tmp_path / "study.yaml", out=tmp_path / "run")
    curves = pd.read_csv(tmp_path / "run" / "curves.csv")
    assert curves[["law.mu[0]", "law.mu[1]"]].values.tolist() == [[0.3, 0.1]]
