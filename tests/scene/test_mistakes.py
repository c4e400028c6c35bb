"""Mistakes in scenes, one table, told four ways: of a study file, of --set, of Python and of a scene in SI units."""

from __future__ import annotations

import io
import math
from functools import reduce
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

from frictionlab.scene.dimensional import without_unit
from frictionlab.scene.scene import Scene
from frictionlab.scene.units import FREQUENCY
from frictionlab.study.load import load_study, parse_study
from frictionlab.values.notes import Mistake, StudyError, WrongValues
from frictionlab.values.quantities import dimensions
from frictionlab.values.units import unit_of_dimension
from frictionlab.values.validation import nested

LINE: dict[str, Any] = {
    "damping_ratio": 0.1,
    "normal_load": 10,
    "belt_speed": 5,
    "drive": {"unbalance": 10, "frequency": 1.5, "phase": 0},
}
ACROSS = {"natural_frequency": 2, "damping_ratio": 0.2, "load": {"amplitude": 3, "phase": 30}}
PLANE = LINE | {"transverse": ACROSS, "initial": {"x": 0}}
SLIP = {"belt_speed": 5, "slip": {"velocity_amplitude": 3, "frequency": 2, "phase": 0}}
BELT = {key: LINE[key] for key in ("damping_ratio", "normal_load", "belt_speed")}

MISSING, NUMBER, POSITIVE = "required key is missing", "must be a number, got", "must be > 0, got"
ONE_OF = "give exactly one of unbalance"
NUMBERS = {
    "damping_ratio": 0, "normal_load": 1, "belt_speed": -9, "drive.unbalance": 0, "drive.frequency": 1,
    "drive.phase": -9, "transverse.natural_frequency": 1, "transverse.damping_ratio": 0,
    "transverse.load.amplitude": 0, "transverse.load.phase": -9,
}  # fmt: skip
"""Numbers of a scene: 1 where they must be > 0, 0 where >= 0."""
Row = tuple[dict[str, Any], dict[str, Any], str, str]
ROWS: list[Row] = [
    *((PLANE, {path: value}, path, "must be a finite number, got")
      for path in NUMBERS for value in (math.nan, math.inf)),
    *((PLANE, {path: value}, path, "must be a number") for path in NUMBERS for value in ("5", True, [5.0])),
    *((PLANE, {path: -1}, path, f"must be >{'=' * (1 - least)} 0, got -1")
      for path, least in NUMBERS.items() if least >= 0),
    *((PLANE, {path: 0}, path, f"{POSITIVE} 0") for path, least in NUMBERS.items() if least > 0),
    *((SLIP, {f"slip.{name}": math.nan}, f"slip.{name}", "must be a finite")
      for name in ("velocity_amplitude", "frequency", "phase")),
    (SLIP, {"slip.velocity_amplitude": -1}, "slip.velocity_amplitude", "must be >= 0, got -1"),
    (SLIP, {"slip.frequency": -1}, "slip.frequency", f"{POSITIVE} -1"),
    *((PLANE, {f"{part}wobble": 1}, f"{part}wobble", "unknown key")
      for part in ("", "drive.", "transverse.", "transverse.load.", "initial.")),
    *((PLANE, {f"{part}.unbalance": 1, f"{part}.amplitude": 1}, part, ONE_OF)
      for part in ("drive", "transverse.load")),
    (LINE, {"drive": {"frequency": 1}}, "drive", ONE_OF),
    (PLANE, {"transverse.load": {}}, "transverse.load", ONE_OF),
    (PLANE, {"transverse.load.frequency": 2}, "transverse.load.frequency", "unknown key"),
    (LINE, {"drive.period": 6}, "drive.period", "unknown key"),
    (LINE, {"drive": 5}, "drive", "must be "),
    (LINE, {"drive.waveform": "sinus"}, "drive.waveform", "must be 'sine', 'square', 'triangle'"),
    (LINE, {"drive.waveform": {"square": {"duty": 1}}}, "drive.waveform.square.duty", "must be > 0 and < 1"),
    (BELT | {"transverse": ACROSS}, {"belt_speed": 4}, "transverse.load", "needs drive for its frequency"),
    (LINE, {"damping_ratio": None}, "damping_ratio", MISSING),
    (LINE, {"normal_load": None}, "normal_load", MISSING),
    (LINE, {"belt_speed": None}, "belt_speed", MISSING),
    (LINE, {"drive.frequency": None}, "drive.frequency", MISSING),
    *((SLIP, {name: {**PLANE, **LINE}[name]}, name, "leave it out with a prescribed slip")
      for name in ("damping_ratio", "drive", "transverse", "initial")),
    (SLIP, {"transverse_slip": {"velocity_amplitude": 1, "frequency": 2}}, "transverse_slip.frequency",
     "leave it out, slip.frequency"),
    ({"belt_speed": 1}, {"transverse_slip": {"velocity_amplitude": 1}}, "transverse_slip.frequency",
     f"{MISSING} where slip is left out"),
    *((LINE, {f"initial.{name}": 1}, f"initial.{name}", "needs transverse") for name in ("x2", "velocity2")),
]  # fmt: skip
"""A sound scene, what is put into it by path (None: left out), where that is a mistake and what is said."""


def put(tree: dict[str, Any], path: str, value: Any) -> dict[str, Any]:
    """The mapping with a value put at a dotted path; None removes it."""
    head, _, rest = path.partition(".")
    new = put(tree.get(head, {}), rest, value) if rest else value
    return {key: one for key, one in (tree | {head: new}).items() if one is not None}


def study(scene: dict[str, Any]) -> dict[str, Any]:
    return {"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}]}


def text(value: Any, flow: bool = False) -> str:
    """The value as YAML; flow: on one line."""
    out, yaml = io.StringIO(), YAML(typ="safe")
    yaml.default_flow_style = flow
    yaml.dump([value] if flow else value, out)
    return out.getvalue().strip()[1:-1] if flow else out.getvalue()


def told(read: Any) -> list[Mistake]:
    with pytest.raises((StudyError, WrongValues)) as caught:
        read()
    return list(caught.value.mistakes)


def in_si(tree: dict[str, Any], record: Any = Scene) -> dict[str, Any]:
    """The same scene in SI units: of 1 kg on 1 N/m its numbers are the same, with a unit where they have one."""

    def one(key: str, value: Any) -> Any:
        if isinstance(value, dict) and key in record.model_fields and (part := nested(record, key)):
            return in_si(value, part)
        if key not in dimensions(record) or type(value) is bool or not isinstance(value, int | float):
            return value
        kind = dimensions(record)[key]
        return f"{value} {'rad/s' if kind == FREQUENCY else unit_of_dimension(kind)}"

    return {key: one(key, value) for key, value in tree.items()}


@pytest.mark.parametrize(("sound", "changes", "where", "what"), ROWS)
def test_a_mistake_is_told_alike_wherever_it_is_made(
    sound: dict[str, Any], changes: dict[str, Any], where: str, what: str, tmp_path: Path
) -> None:
    scene = reduce(lambda tree, change: put(tree, *change), changes.items(), sound)
    (in_python,) = told(lambda: Scene(**scene))
    assert (in_python.path, in_python.what[: len(what)]) == (where, what)

    file = tmp_path / "study.yaml"
    file.write_text(text(study(scene)))
    (in_file,) = told(lambda: load_study(file))
    assert (in_file.path, in_file.what[: len(what)]) == (f"scene.{where}", what)
    assert in_file.place is not None
    steps = f"scene.{where}".split(".")
    assert any(step in in_file.line for step in (steps if what.startswith(MISSING) else steps[-1:]))

    if None not in changes.values():
        file.write_text(text(study(sound)))
        sets = [f"scene.{path}={text(value, flow=True)}" for path, value in changes.items()]
        (in_set,) = told(lambda: load_study(file, sets))
        assert (in_set.path, in_set.what[: len(what)]) == (f"scene.{where}", what)
        if where in changes:
            assert in_set.origin == f"--set {sets[-1]}"

    if where in ("damping_ratio", "normal_load") and what == MISSING:
        return  # in SI units they may be left out
    body = {"mass": "1 kg", "stiffness": "1 N/m", "length": "1 m"} if sound["belt_speed"] in (4, 5) else {}
    body = {} if "slip" in sound else body
    (found,) = told(lambda: parse_study(study({"dimensional": body | in_si(scene)})))

    assert ".".join(map(without_unit, found.path.split("."))) == f"scene.dimensional.{where}"
    if "finite" not in what:  # nan N is no number with a unit
        assert found.what.startswith(what[: what.find(" got")] if " got" in what else what[:20])
