"""The result columns asked for: only they are found, and each is what it is in the whole row."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fig_4b import GIVEN, LAW, SCENE, over_speeds
from profiles import deep

import frictionlab as fl
from frictionlab import cli
from frictionlab.methods.exact.method import _Curve
from frictionlab.methods.periodic import continuation
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.runner.folder import FolderError
from frictionlab.study.load import load_study, parse_study
from frictionlab.study.schema import schema
from frictionlab.study.written import yaml_text
from frictionlab.values.columns import ALWAYS, FROM_ORBITS, GROUPS, RESULTS, TEXT, columns_of
from frictionlab.values.notes import StudyError

SPEEDS = [5.0, 20.0]
ACROSS = {"natural_frequency": 4.0, "damping_ratio": 0.1, "load": {"unbalance": 10, "phase": 90}}
WAYS = [{"scene": GIVEN}, {"scene": GIVEN | {"transverse": ACROSS}, "methods": ["shooting"]}]
study = partial(over_speeds, SPEEDS, tolerance=1e-7)


def found(table: Any) -> list[str]:
    """The result columns of a table."""
    return [name for name in table if name in RESULTS]


def with_usual(*names: str) -> list[str]:
    """These columns and those of every table, in their order."""
    return [name for name in RESULTS if name in {*ALWAYS, *names}]


def test_a_table_has_the_columns_asked_for_and_those_of_every_table() -> None:
    by_key = fl.run(study(columns=["floquet", "reversals"])).table
    by_argument = fl.run(study(), columns=["floquet", "reversals"]).table
    curve = fl.curve(SCENE, LAW, SPEEDS, columns=["floquet"])

    assert found(by_key) == found(by_argument) == with_usual("floquet", "reversals")
    assert found(curve) == with_usual("floquet")
    np.testing.assert_array_equal(by_key["floquet"], curve["floquet"])


def test_a_group_asks_for_its_columns_and_all_for_every_one() -> None:
    energies = fl.run(study(columns=["energies", "floquet"])).table
    every = fl.run(study(columns="all"))

    assert found(energies) == with_usual(*columns_of("energies"), "floquet")
    assert found(every.table) == found(fl.run(study(), columns="all").table) == [*columns_of("all")]
    assert every.study.resolved()["columns"] == ["all"]


@deep("all columns each")
@pytest.mark.parametrize("way", WAYS)
def test_a_column_alone_is_the_one_of_the_whole_row(way: dict[str, Any]) -> None:
    whole = fl.run(study(**way, columns="all")).table

    for name in columns_of("all"):
        alone = fl.run(study(**way, columns=[name])).table
        if name in TEXT:
            assert alone[name].fillna("").tolist() == whole[name].fillna("").tolist()
        elif name != "seconds":
            np.testing.assert_array_equal(alone[name], whole[name], name)


def calls(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """Counts the orbits and multipliers that are asked for from here on."""
    counted: Counter[str] = Counter()

    def watched(owner: type, name: str, count: Callable[..., dict[str, int]]) -> None:
        plain = getattr(owner, name)

        def call(*given: Any, **named: Any) -> Any:
            counted.update(count(*given))
            return plain(*given, **named)

        monkeypatch.setattr(owner, name, call)

    def wanted(*given: Any) -> dict[str, int]:
        asked = next(each for each in given if isinstance(each, continuation.Wanted))
        return {"recorded": asked.orbits, "differentiated": asked.matrices}

    watched(PeriodicProblem, "orbits", lambda *_: {"orbits": 1})
    watched(PeriodicProblem, "multipliers", lambda *_: {"multipliers": 1})
    watched(_Curve, "_orbits", lambda *_: {"orbits": 1})
    watched(PeriodicProblem, "called", wanted)
    return counted


@pytest.mark.parametrize("way", WAYS)
def test_the_mean_alone_makes_no_orbit_and_no_multiplier(way: dict[str, Any], monkeypatch: Any) -> None:
    counted = calls(monkeypatch)

    fl.run(study(**way, columns=["mean_friction", "mean_friction_transverse"]))
    assert not +counted

    fl.run(study(**way, columns=["velocity_phase"]))
    assert (counted["orbits"], counted["multipliers"]) == (1, 0)

    fl.run(study(**WAYS[1], columns=["floquet"]))
    assert [counted[each] for each in ("orbits", "multipliers", "differentiated")] == [1, 1, 1]


def test_what_a_study_expects_is_in_its_table() -> None:
    expect = [{"column": "stick_fraction", "below": 0.5}, {"shape": "concave", "where": {"law": "coulomb"}}]
    speeds = {"scene.belt_speed": {"start": 1, "stop": 60, "num": 30}}
    ready = parse_study(study(columns=["floquet"], expect=expect, sweep=speeds))

    done = fl.run(ready)

    assert {"stick_fraction", "velocity_ratio", "floquet"} <= set(found(done.table))
    assert done.verdicts[0].passed
    assert parse_study(ready.resolved()) == ready


def test_curves_without_their_columns_say_so() -> None:
    done = fl.run(study(columns=["floquet"]))

    assert done.curves["shape"].isna().all()
    assert "velocity_amplitude" in done.curves["reason"][0]


def test_in_si_units_a_column_comes_in_both_scales() -> None:
    si = {"mass_kg": 1.0, "stiffness_N_per_m": 100.0, "damping_N_s_per_m": 2.0, "length_m": 0.01}
    scene = {"dimensional": si | {"normal_load_N": 10.0, "belt_speed_m_per_s": 0.1}}
    scene["dimensional"]["drive"] = {"amplitude_N": 10.0, "frequency_rad_per_s": 10.0}
    table = fl.run(study(scene=scene, sweep={}), columns=["energy_input_J"]).table

    assert {"energy_input", "energy_input_J", "mean_friction_N", "error_N"} <= set(table)
    assert "energy_viscous_J" not in table
    with pytest.raises(ValueError, match="no result column or group 'energy_input_J'"):
        fl.run(study(), columns=["energy_input_J"])


# --- mistakes -----------------------------------------------------------------------------------------------------


def test_a_name_that_is_no_column_is_a_mistake_at_its_place(tmp_path: Path, capsys: Any) -> None:
    file = tmp_path / "study.yaml"
    file.write_text(yaml_text(study()) + "columns: [floquet, flouqet]\n")
    line = len(file.read_text().splitlines())

    assert cli.main(["run", str(file), "-o", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    assert f"study.yaml:{line}:20: columns[1]: must be a result column or a group of them" in told
    assert "got the text 'flouqet'" in told
    assert "did you mean 'floquet'?" in told


@pytest.mark.parametrize(
    ("columns", "told"),
    [
        ([], "must be a list of at least 1, got 0"),
        ([1], r"columns\[0\]: must be text, got 1"),
        (["drift"], "is of a body that no spring holds: give spring: false"),
        ("flokuet", r"columns\[0\]: must be a result column or a group"),
        (["enrgies"], "did you mean 'energies'"),
    ],
)
def test_columns_are_a_list_of_names(columns: Any, told: str) -> None:
    with pytest.raises(StudyError, match=told):
        parse_study(study(columns=columns))


def test_python_is_told_what_was_perhaps_meant() -> None:
    with pytest.raises(ValueError, match="no result column or group 'flouqet'; did you mean 'floquet'"):
        fl.run(study(), columns=["flouqet"])
    with pytest.raises(ValueError, match="must be a list of names"):
        fl.curve(SCENE, LAW, SPEEDS, columns="floquet")


def test_the_schema_knows_the_columns() -> None:
    one, several = schema()["properties"]["columns"]["anyOf"]
    assert {"all", *FROM_ORBITS, *GROUPS} < {*one["enum"]} == {*several["items"]["enum"]}


# --- folders and the command --------------------------------------------------------------------------------------


@deep("seconds of runs")
def test_a_folder_may_be_used_for_other_columns(tmp_path: Path) -> None:
    asked = [["floquet"], ["floquet"], ["floquet", "reversals"], ["reversals"], "all"]
    done = [fl.run(study(columns=each), tmp_path) for each in asked]

    assert [each.computed for each in done] == [2, 0, 2, 2, 2]
    assert done[2].table["reversals"].notna().all()
    assert found(done[3].table) == with_usual("reversals")
    assert found(done[4].table) == with_usual(*columns_of("all"))
    with pytest.raises(FolderError, match="another study"):
        fl.run(study(tolerance=1e-6), tmp_path)


@deep("seconds of runs")
def test_the_command_finds_the_columns_of_its_option(tmp_path: Path, capsys: Any) -> None:
    file, out = tmp_path / "study.yaml", tmp_path / "out"
    file.write_text(yaml_text(study()))

    assert cli.main(["run", str(file), "-o", str(out), "--columns", "floquet,reversals", "--json"]) == 0
    assert found(json.loads(capsys.readouterr().out)[0]) == with_usual("floquet", "reversals")
    assert load_study(out / "study.yaml").columns == ("floquet", "reversals")
    assert (out / "report.html").exists()
    assert cli.main(["report", str(out)]) == 0
    assert cli.main(["run", str(file), "-o", str(out), "--columns", "flouqet"]) == 2
    assert "did you mean 'floquet'?" in capsys.readouterr().err


def test_a_column_that_raises_at_one_point_leaves_the_others_their_numbers(monkeypatch):
    from frictionlab.motion.orbit import read

    whole = read.read_columns

    def read_columns(scenes, *rest):
        if any(scene.belt_speed == 20.0 for scene in scenes):
            raise np.linalg.LinAlgError("Array must not contain infs or NaNs")
        return whole(scenes, *rest)

    monkeypatch.setattr(read, "read_columns", read_columns)
    table = fl.curve(SCENE, LAW, belt_speed=[5.0, 20.0, 30.0], columns=["energies"])

    assert list(table["status"]) == ["ok", "failed", "ok"]
    assert "LinAlgError" in table["reason"][1]
    assert np.isfinite(table["energy_friction"][[0, 2]]).all()


def test_a_motion_without_a_derivative_has_its_other_columns():
    """Elasto-plastic bristles that yield nearly at their limit, at V_lin: no finite monodromy."""
    law = fl.ElastoPlastic(mu_kinetic=0.4, stiffness=40, damping=0.0, breakaway_ratio=0.991609)
    table = fl.curve(SCENE.with_(normal_load=1), law, [40.0, 49.999999, 50.0, 60.0], columns="all")

    assert set(table["status"]) == {"ok"}
    assert table["mean_friction"].to_numpy()[1:] == pytest.approx(0.4, abs=1e-9)
