"""Keys and numbers of a study as people write them: paths without a unit behind them, texts with one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel

from frictionlab import registry
from frictionlab.laws.base import FrictionLaw
from frictionlab.mistakes.notes import Unfit
from frictionlab.mistakes.validation import field_path, number_paths
from frictionlab.quantities import Written, dimensions
from frictionlab.scene.as_written import AsWritten, in_si
from frictionlab.scene.scene import Scene
from frictionlab.study.axes import SCENE
from frictionlab.units.text import in_units_of_law, unit_of_dimension


def column_of(path: str) -> str:
    """The path under which the table has what a study calls so: with the unit of a number in SI units."""
    return f"{SCENE}{field_path(Scene, path.removeprefix(SCENE))}" if path.startswith(SCENE) else path


def scene_is_in_si(tree: Mapping[str, Any]) -> bool:
    """Whether the scene of a study is given in SI units, rightly or wrongly."""
    given = tree.get("scene")
    return isinstance(given, Mapping) and "dimensional" in given


def units_of_law(law: type[FrictionLaw]) -> dict[str, str]:
    """The unit of every parameter of a law that is a number or several, in a scene in SI units."""
    plain = dict.fromkeys(number_paths(law), "")
    return plain | {name: unit_of_dimension(each) for name, each in dimensions(law).items()}


def number_written(record: type[BaseModel], key: str, name: str, value: Any) -> Any:
    """The value of a field of a scene or of a law in SI units: a text with a unit as a number."""
    if issubclass(record, AsWritten):
        return in_si(key, name, value)
    units = units_of_law(record) if issubclass(record, FrictionLaw) else {}
    if name not in units:
        return value
    if isinstance(value, list):
        return [number_written(record, key, name, each) for each in value]
    return in_units_of_law(value, name, units) if isinstance(value, str) else value


def read_law_numbers(tree: Mapping[str, Any], laws: registry.Laws) -> None:
    """Put numbers in the place of texts with units in the laws of a study whose scene is in SI units.

    In another study they are marked as what is no number.
    """
    given, in_units_of_si = tree.get("laws"), scene_is_in_si(tree)
    for law in given if isinstance(given, list) else ():
        if isinstance(law, dict) and law.get("kind") in laws.usable():
            kind = laws.named(law["kind"])
            for name in law.keys() & units_of_law(kind):
                if in_units_of_si:
                    law[name] = number_written(kind, name, name, law[name])
                elif isinstance(law[name], str | Written):
                    law[name] = Unfit(getattr(law[name], "text", law[name]), "must be a number")
