"""Keys and numbers of a study as people write them: paths without a unit behind them, texts with one.

Plain values as YAML text that every YAML reader reads back to the same values.
"""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from pydantic import BaseModel

from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.dimensional import AsWritten, in_si
from frictionlab.scene.scene import Scene
from frictionlab.study import registry
from frictionlab.study.axes import SCENE
from frictionlab.values.notes import Unfit
from frictionlab.values.printable import printable
from frictionlab.values.quantities import Written, dimensions
from frictionlab.values.units import in_units_of_law, unit_of_dimension
from frictionlab.values.validation import field_name, field_path, number_paths, record_at


def column_of(path: str) -> str:
    """Return the path under which the table has what a study calls so: with the unit of a number in SI units."""
    return f"{SCENE}{field_path(Scene, path.removeprefix(SCENE))}" if path.startswith(SCENE) else path


def scene_is_in_si(tree: Mapping[str, Any]) -> bool:
    """Check whether the scene of a study is given in SI units, rightly or wrongly."""
    given = tree.get("scene")
    return isinstance(given, Mapping) and "dimensional" in given


def units_of_law(law: type[FrictionLaw]) -> dict[str, str]:
    """Return the unit of every parameter of a law that is a number or several, in a scene in SI units."""
    plain = dict.fromkeys(number_paths(law), "")
    return plain | {name: unit_of_dimension(each) for name, each in dimensions(law).items()}


def number_written(record: type[BaseModel], key: str, name: str, value: Any) -> Any:
    """Return the value of a field of a scene or of a law in SI units: a text with a unit as a number."""
    if issubclass(record, AsWritten):
        return in_si(key, name, value)
    units = units_of_law(record) if issubclass(record, FrictionLaw) else {}
    if name not in units:
        return value
    if isinstance(value, list):
        return [number_written(record, key, name, each) for each in value]
    return in_units_of_law(value, name, units) if isinstance(value, str) else value


def number_of(name: str, value: Any, laws: Iterable[type[FrictionLaw]], in_units_of_si: bool) -> Any:
    """Return a number of a law by name, or of a scene by path, that may be written as text with a unit."""
    if not isinstance(value, str):
        return value
    key = name.rpartition(".")[2].partition("[")[0]
    *steps, field = column_of(name).removeprefix(SCENE).split(".")
    owner = next((law for law in laws if key in law.model_fields), None)
    record = record_at(Scene, tuple(steps)) if name.startswith(SCENE) else owner
    if not in_units_of_si or record is None:
        return Unfit(value, "must be a number")
    return number_written(record, key, field if name.startswith(SCENE) else key, value)


def read_law_numbers(tree: Mapping[str, Any], laws: registry.Laws) -> None:
    """Put numbers in the place of texts with units in the laws of a study whose scene is in SI units.

    In another study they are marked as what is no number.
    """
    given, in_units_of_si = tree.get("laws"), scene_is_in_si(tree)
    for law in given if isinstance(given, list) else ():
        if isinstance(law, dict) and law.get("kind") in laws.usable():
            kind = laws.named(law["kind"])
            for key in [key for key in law if field_name(kind, key) in units_of_law(kind)]:
                if in_units_of_si:
                    law[key] = number_written(kind, key, field_name(kind, key), law[key])
                elif isinstance(law[key], str | Written):
                    law[key] = Unfit(getattr(law[key], "text", law[key]), "must be a number")


WIDTH = 110
_PLAIN = re.compile(r"[A-Za-z][\w.()/-]*(?: [\w.()/-]+)*")
_WITH_UNIT = re.compile(r"[\d.e+-]+ [\w/^* -]+")
_RESERVED = {"true", "false", "yes", "no", "on", "off", "y", "n", "null", "nan", "inf"}


def yaml_text(tree: dict[str, Any]) -> str:
    """A mapping of numbers, words, lists and mappings as block YAML; what is short stays on one line."""
    return "\n".join(_mapping(tree, "")) + "\n"


def _mapping(tree: dict[str, Any], indent: str) -> Iterator[str]:
    for key, value in tree.items():
        yield from _entry(f"{indent}{_scalar(key)}:", value, indent)


def _entry(head: str, value: Any, indent: str) -> Iterator[str]:
    """A key or a dash, and its value on the same line where it fits, else below."""
    line = f"{head} {_flow(value)}"
    if len(line) <= WIDTH or not isinstance(value, dict | list) or not value:
        yield line
    elif isinstance(value, dict):
        yield head
        yield from _mapping(value, indent + "  ")
    elif any(isinstance(item, dict | list) or "  " in str(item) for item in value):  # a wrap loses spaces
        yield head
        for item in value:
            yield from _item(item, indent + "  ")
    else:
        yield from textwrap.wrap(
            line, WIDTH, subsequent_indent=indent + "  ", break_long_words=False, break_on_hyphens=False
        )


def _item(value: Any, indent: str) -> Iterator[str]:
    """A list's entry; what does not fit a line opens with the dash in place of its first indentation."""
    if len(line := f"{indent}- {_flow(value)}") <= WIDTH or not isinstance(value, dict):
        yield line
        return
    first, *others = _mapping(value, indent + "  ")
    yield f"{indent}- {first.lstrip()}"
    yield from others


def _flow(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_scalar(key)}: {_flow(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_flow, value)) + "]"
    return _scalar(value)


def _scalar(value: Any) -> str:
    if isinstance(value, Written):
        return value.text if _WITH_UNIT.fullmatch(value.text) else json.dumps(value.text, ensure_ascii=False)
    if isinstance(value, float):
        return _number(value)
    if isinstance(value, str) and _PLAIN.fullmatch(value) and value.lower() not in _RESERVED:
        return value
    return printable(json.dumps(value, ensure_ascii=False))  # YAML reads \\x7f, too


def _number(value: float) -> str:
    """Return the shortest form that reads back the same; YAML 1.1 reads 1e-08 without a point as text."""
    mantissa, e, exponent = repr(value).partition("e")
    return f"{mantissa}{'' if '.' in mantissa else '.0'}{e}{exponent}"
