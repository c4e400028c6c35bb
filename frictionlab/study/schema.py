"""The JSON Schema of a study file, built from the installed laws and methods."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, TypeAdapter

from frictionlab import columns, registry
from frictionlab.scene.scene import Scene
from frictionlab.scene.waveforms import SINE, Waveform
from frictionlab.study import reader
from frictionlab.study.grid import LARGEST_GRID
from frictionlab.study.study import LIMIT_KEY, SCHEMA, SECONDS_PER_POINT

_NUMBER = {"type": "number"}
_WORD_OR_NUMBER: dict[str, Any] = {
    "anyOf": [_NUMBER, {"type": "string"}, TypeAdapter(Waveform).json_schema()]
}
"""What a sweep of a scene runs over, and what selects rows of its table."""
_TEXT = {"type": "string"}
_TIME = {"type": "number", "exclusiveMinimum": 0, "default": SECONDS_PER_POINT}
# Behind a validator defined here a bound keeps pydantic's name.
_BOUNDS = {"gt": "exclusiveMinimum", "ge": "minimum", "lt": "exclusiveMaximum", "le": "maximum"}


def schema(laws: registry.Laws = registry.INSTALLED_LAWS) -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of a study; rules on several keys at once are left to ``check``."""
    definitions: dict[str, Any] = {}
    scene = _record(Scene, definitions)
    properties = {
        "schema": {"const": SCHEMA},
        "title": _TEXT,
        "source": _TEXT,
        "scene": scene,
        "plugins": {"type": "array", "items": _TEXT, "uniqueItems": True},
        "laws": {"type": "array", "minItems": 1, "items": {"oneOf": _laws(laws, definitions)}},
        "methods": {
            "type": "array",
            "minItems": 1,
            "items": {"oneOf": _methods(definitions)},
            "default": list(reader.DEFAULT_METHODS),
        },
        "tolerance": {"type": "number", "exclusiveMinimum": 0, "default": reader.DEFAULT_TOLERANCE},
        "sweep": _sweep(),
        "expect": {"type": "array", "items": {"oneOf": _expectations()}},
        "columns": {"type": "array", "minItems": 1, "items": {"enum": [*columns.RESULTS, *columns.SI]}},
        "limit": _closed_object({LIMIT_KEY: _TIME}, []),
        "keep": _closed_object(
            {name: {"type": "integer", "minimum": least} for name, least in reader.KEPT.items()}, []
        ),
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A frictionlab study",
        **_closed_object(properties, list(reader.REQUIRED)),
        "$defs": definitions,
    }


def _closed_object(properties: dict[str, Any], required: list[str]) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": False}


def _record(record: type[BaseModel], definitions: dict[str, Any]) -> dict[str, Any]:
    """The schema of a record; those of the records inside it are added to the definitions."""
    made: dict[str, Any] = _study_schema(record.model_json_schema(ref_template="#/$defs/{model}"))
    definitions.update(made.pop("$defs", {}))
    return made


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
        if key != "required" and not (key == "default" and item is None)
    }
    choices = [item for item in kept.pop("anyOf", []) if item != {"type": "null"}]
    return kept | (choices[0] if len(choices) == 1 else {"anyOf": choices} if choices else {})


def _laws(laws: registry.Laws, definitions: dict[str, Any]) -> list[dict[str, Any]]:
    return [_kind(name, _record(laws.named(name), definitions)) for name in laws.usable()]


def _methods(definitions: dict[str, Any]) -> list[dict[str, Any]]:
    names = registry.method_names()
    records = [_kind(name, _record(registry.method_class(name), definitions)) for name in names]
    return [{"enum": names}, *records]


def _kind(name: str, record: dict[str, Any]) -> dict[str, Any]:
    """A law or method: its parameters, its registered name and a label."""
    own = {"kind": {"const": name}, "label": _TEXT}
    closed = _closed_object({**own, **record.get("properties", {})}, ["kind"])
    return {"title": name, "description": record.get("description", ""), **closed}


def _sweep() -> dict[str, Any]:
    listed = {"type": "array", "minItems": 1, "uniqueItems": True, "items": _WORD_OR_NUMBER}
    ranged = _closed_object(
        {
            "start": _NUMBER,
            "stop": _NUMBER,
            "num": {"type": "integer", "minimum": 2, "maximum": LARGEST_GRID},
            "spacing": {"enum": ["linear", "log"], "default": "linear"},
        },
        ["start", "stop", "num"],
    )
    names = {"pattern": r"^(scene\..+|laws\..+\..+)$"}
    return {"type": "object", "propertyNames": names, "additionalProperties": {"oneOf": [listed, ranged]}}


def _expectations() -> list[dict[str, Any]]:
    """A column against a number, a status, the difference of two methods, or the shape of a curve."""
    where = {"type": "object", "additionalProperties": _WORD_OR_NUMBER}
    shared: dict[str, Any] = {"where": where, "because": _TEXT}
    numeric = [name for name in (*columns.RESULTS, *columns.SI) if name not in columns.TEXT]
    positive = {"type": "number", "exclusiveMinimum": 0}
    column = {"column": {"enum": numeric}, "within": positive}
    statuses = [status for status in columns.STATUSES if status != "killed"]
    pair = {"type": "array", "minItems": 2, "maxItems": 2, "uniqueItems": True, "items": _TEXT}
    return [
        _closed_object({**shared, **column, "equals": _NUMBER}, ["column", "equals", "within"]),
        _closed_object({**shared, **column, "below": _NUMBER}, ["column", "below"]),
        _closed_object({**shared, **column, "above": _NUMBER}, ["column", "above"]),
        _closed_object({**shared, "status": {"enum": statuses}}, ["status"]),
        _closed_object({**shared, "max_difference": pair, "below": positive}, ["max_difference", "below"]),
        *(_shape(shared, measure) for measure in columns.SHAPES),
    ]


def _shape(shared: dict[str, Any], measure: str) -> dict[str, Any]:
    """A verdict on curves by one measure; ``measure`` is optional for area."""
    required = ["shape"] if measure == "area" else ["shape", "measure"]
    own = {"shape": {"enum": list(columns.SHAPES[measure])}, "measure": {"const": measure}}
    return _closed_object({**shared, **own}, required)
