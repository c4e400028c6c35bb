"""JSON Schema of a study file, built from the installed laws and methods."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from pydantic import BaseModel, TypeAdapter

from frictionlab.scene.dimensional import AsWritten, unit_of
from frictionlab.scene.scene import Scene
from frictionlab.scene.waveforms import SINE, Waveform
from frictionlab.study import reader, registry
from frictionlab.study.axes import ENDS, FRICTION, LINKED, SpeedRange, SweepRange
from frictionlab.study.figure_options import EVERY
from frictionlab.study.keys import STUDY_KEYS, StudyKeys
from frictionlab.study.parts import SCHEMA
from frictionlab.study.records import description, meaning
from frictionlab.values import columns
from frictionlab.values.units import quantity_in
from frictionlab.values.validation import number_paths, record_at

_KEYS = {
    "schema": "version of the rules that the study is written by",
    "plugins": "Python files with laws of your own, by their paths from the study; their code is run",
    "laws": "the friction laws, one set of rows each; frictionlab laws lists them",
    "methods": "how steady states are found, one set of rows each; frictionlab methods lists them",
    "sweep": "values to vary, by dotted path: scene.<value>, laws.<label>.<parameter> or friction; "
    "all combinations are solved",
    "kind": "registered name",
    "label": "name of its rows; kind where left out",
    FRICTION: "friction coefficients: mu or mu_kinetic of every law, mu_static keeping its ratio",
    LINKED: "lists that advance together, by dotted path; entries and other sweeps make the grid",
}
"""Meanings of the keys of a study, apart from those of records, whose docstrings tell them."""
_NUMBER = {"type": "number"}
_WORD_OR_NUMBER: dict[str, Any] = {
    "anyOf": [_NUMBER, {"type": "string"}, TypeAdapter(Waveform).json_schema()]
}
"""Values of a sweep of a scene, and of what selects rows of its table."""
_TEXT = {"type": "string"}
_WITH_UNIT = _TEXT | {"pattern": r"^\s*[-+]?[0-9.]"}
"""A number and its unit, in a scene in SI units."""
_SPEEDS = (
    "belt speeds: a list, a range, or start, stop and within, between which they are chosen as the run goes"
)
# Behind a validator defined here a bound keeps pydantic's name.
_BOUNDS = {"gt": "exclusiveMinimum", "ge": "minimum", "lt": "exclusiveMaximum", "le": "maximum"}


def schema(laws: registry.Laws = registry.INSTALLED_LAWS) -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of a study; rules on several keys at once are left to ``check``."""
    definitions: dict[str, Any] = {}
    keys = _record(StudyKeys, definitions)["properties"]
    figures, pair = keys["figures"], {"type": "array", "items": _NUMBER, "minItems": 2, "maxItems": 2}
    keys["figures"] = {"description": figures.pop("description"), "oneOf": [{"const": EVERY}, figures]}
    keys["free"]["additionalProperties"] = {"oneOf": [pair, keys["free"]["additionalProperties"]]}
    keys["boundaries"]["propertyNames"] = {"enum": list(columns.CURVE_MEASURES)}
    parts = {
        "schema": {"const": SCHEMA},
        "scene": _record(Scene, definitions),
        "plugins": {"type": "array", "items": _TEXT, "uniqueItems": True},
        "laws": {"type": "array", "minItems": 1, "items": {"oneOf": _laws(laws, definitions)}},
        "methods": {
            "type": "array",
            "minItems": 1,
            "items": {"oneOf": _methods(definitions)},
            "default": list(reader.DEFAULT_METHODS),
        },
        "sweep": _sweep(),
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A frictionlab study",
        **_closed_object({key: (parts | keys)[key] for key in STUDY_KEYS}, list(reader.REQUIRED)),
        "$defs": definitions,
    }


def schema_text(laws: registry.Laws = registry.INSTALLED_LAWS) -> str:
    """Return the JSON Schema as the text of a file."""
    return json.dumps(schema(laws), indent=2)


def _closed_object(properties: dict[str, Any], required: list[str]) -> dict[str, Any]:
    described = {
        key: {"description": _KEYS[key], **value} if key in _KEYS and "description" not in value else value
        for key, value in properties.items()
    }
    return {"type": "object", "properties": described, "required": required, "additionalProperties": False}


def _record(record: type[BaseModel], definitions: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of a record; those of the records inside it are added to the definitions."""
    made: dict[str, Any] = _study_schema(record.model_json_schema(ref_template="#/$defs/{model}"))
    inside = made.pop("$defs", {})
    _describe(record, made, inside)
    definitions.update(inside)
    return made


def _describe(record: type[BaseModel], made: dict[str, Any], inside: dict[str, Any]) -> None:
    """Put into the schema of a record, and of those inside it, what docstrings say of it and of every field."""
    made["description"] = description(record)
    _allow_texts(record, made.get("properties", {}))
    for key, field in made.get("properties", {}).items():
        if key in getattr(record, "other_names", {}):
            continue
        part = record_at(record, (key,)) or record_at(record, (key, 0))
        if told := meaning(record, key) or (part and _first_paragraph(part)):
            field.setdefault("description", told)
        if part is not None:
            _describe(part, inside[part.__name__], inside)


def _allow_texts(record: type[BaseModel], fields: dict[str, Any]) -> None:
    """Let the numbers of a part in SI units be texts with units, under keys without a unit, too."""
    if not issubclass(record, AsWritten):
        return
    _or_text(fields, [name for name in fields if unit_of(name) is not None])
    for key, name in record.other_names.items():
        example = quantity_in(unit_of(name) or "").example
        fields[key] = _WITH_UNIT | {
            "description": f"{meaning(record, name)}; text with a unit such as {example}"
        }


def _or_text(fields: dict[str, Any], names: Iterable[str]) -> None:
    """Let the numbers of these names be texts with units, too."""
    for name in names:
        number = {key: value for key, value in fields[name].items() if key not in ("description", "default")}
        beside = {key: fields[name][key] for key in ("description", "default") if key in fields[name]}
        fields[name] = {**beside, "anyOf": [number, _WITH_UNIT]}


def _first_paragraph(record: type[BaseModel]) -> str:
    return " ".join(description(record).partition("\n\n")[0].split())


def _study_schema(schema: Any) -> Any:
    """A record's schema for a study: a key may be left out (a sweep can give it), but not be null."""
    if isinstance(schema, list):
        return [_study_schema(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    if "oneOf" in schema:  # a waveform, which a sweep gives whole
        return schema | ({"default": SINE.plain()} if schema.get("default") else {})
    kept = {
        _BOUNDS.get(key, key) if isinstance(item, (int, float)) else key: _study_schema(item)
        for key, item in schema.items()
        if key != "required" and not (key == "default" and (item is None or isinstance(item, dict)))
    }
    choices = [item for item in kept.pop("anyOf", []) if item != {"type": "null"}]
    return kept | (choices[0] if len(choices) == 1 else {"anyOf": choices} if choices else {})


def _laws(laws: registry.Laws, definitions: dict[str, Any]) -> list[dict[str, Any]]:
    made = {name: _record(laws.named(name), definitions) for name in laws.usable()}
    for name, record in made.items():
        _or_text(record.get("properties", {}), number_paths(laws.named(name)))
    return [_kind(name, record) for name, record in made.items()]


def _methods(definitions: dict[str, Any]) -> list[dict[str, Any]]:
    names = registry.method_names()
    records = [_kind(name, _record(registry.method_class(name), definitions)) for name in names]
    return [{"enum": names}, *records]


def _kind(name: str, record: dict[str, Any]) -> dict[str, Any]:
    """A law or method: its parameters, its registered name and a label."""
    own = {
        "kind": {"const": name, "description": _KEYS["kind"]},
        "label": _TEXT | {"description": _KEYS["label"]},
    }
    closed = _closed_object({**own, **record.get("properties", {})}, ["kind"])
    return {"title": name, "description": record.get("description", ""), **closed}


def _sweep() -> dict[str, Any]:
    listed = {"type": "array", "minItems": 1, "uniqueItems": True, "items": _WORD_OR_NUMBER}
    ranged = _record(SweepRange, {}) | {"required": ["start", "stop", "num"]}
    chosen = _record(SpeedRange, {}) | {"required": ["start", "stop", "within"]}
    for each in (ranged, chosen):
        _or_text(each["properties"], ENDS)
    values = {"oneOf": [listed, ranged]}
    together = {"type": "array", "minItems": 1, "items": _WORD_OR_NUMBER}
    entry = {
        "type": "object",
        "minProperties": 2,
        "propertyNames": {"pattern": r"^(scene\..+|laws\..+\..+|friction)$"},
        "additionalProperties": {"oneOf": [together, ranged]},
    }
    speeds = {"oneOf": [listed, ranged, chosen]}
    return {
        "type": "object",
        "properties": {
            **{path: {"description": _SPEEDS, **speeds} for path in columns.BELT_SPEEDS},
            FRICTION: {"description": _KEYS[FRICTION], **values},
            LINKED: {"description": _KEYS[LINKED], "type": "array", "items": entry},
        },
        "propertyNames": {"pattern": r"^(scene\..+|laws\..+\..+|friction|linked)$"},
        "additionalProperties": values,
    }
