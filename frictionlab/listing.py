"""What is installed, laws and methods, as plain records for people and programs."""

from __future__ import annotations

import inspect
import re
from collections.abc import Sequence
from typing import Annotated, Any, get_args, get_origin

from frictionlab import registry
from frictionlab.laws.base import FrictionLaw, Record

_LIMITS = {"gt": ">", "ge": ">=", "lt": "<", "le": "<="}


def law_record(name: str) -> dict[str, Any]:
    """A law: its name, what it is, its parameters, what it declares. Raises KeyError, BrokenPlugin."""
    law = registry.law_class(name)
    return {
        "name": name,
        "description": _text(law),
        "parameters": _parameters(law),
        "declares": _declared(law),
        "class": f"{law.__module__}.{law.__qualname__}",
    }


def method_record(name: str) -> dict[str, Any]:
    """A method: its name, what it is, what it accepts, its parameters. Raises KeyError, BrokenPlugin."""
    method = registry.method_class(name)
    return {
        "name": name,
        "description": _text(method),
        "refuses": inspect.getdoc(method.refusal) or "",
        "parameters": _parameters(method),
        "class": f"{method.__module__}.{method.__qualname__}",
    }


def _text(kind: type) -> str:
    return inspect.getdoc(kind) or ""


def _declared(law: type[FrictionLaw]) -> dict[str, str]:
    """The predicates a law declares for itself, each with the words of its docstring."""
    predicates = [name for name, method in vars(FrictionLaw).items() if _returns_a_truth_value(method)]
    own = [name for name in predicates if getattr(law, name) is not getattr(FrictionLaw, name)]
    return {name: inspect.getdoc(getattr(law, name)) or "" for name in own}


def _returns_a_truth_value(method: Any) -> bool:
    return inspect.isfunction(method) and method.__annotations__.get("return") in (bool, "bool")


def _parameters(record: type[Record]) -> list[dict[str, Any]]:
    return [_parameter(name, field, _text(record)) for name, field in record.model_fields.items()]


def _parameter(name: str, field: Any, text: str) -> dict[str, Any]:
    limits = [
        f"{sign} {bound:g}"
        for rule in _rules(field)
        for key, sign in _LIMITS.items()
        if (bound := getattr(rule, key, None)) is not None
    ]
    return {
        "name": name,
        "required": field.is_required(),
        "default": None if field.is_required() else field.default,
        "limits": " and ".join(limits),
        "meaning": _meaning(name, text),
    }


def _rules(field: Any) -> list[Any]:
    """What limits the values of a field; of one that may be left empty, what limits those that are given."""
    inside = [kind.__metadata__ for kind in get_args(field.annotation) if get_origin(kind) is Annotated]
    rules = [rule for metadata in [field.metadata, *inside] for rule in metadata]
    return [each for rule in rules for each in (rule, *getattr(rule, "metadata", ()))]


def _meaning(name: str, text: str) -> str:
    """The docstring's own words on a parameter: from its name at the start of a line to a blank line."""
    found = re.search(rf"^{re.escape(name)}\b(.*(?:\n(?!\s*$|\w+ \[).*)*)", text, re.MULTILINE)
    return " ".join(found[1].split()).lstrip(":, ") if found else ""


def one_line_each(records: Sequence[dict[str, Any]]) -> str:
    """Laws or methods by name and the first line of their docstring."""
    width = max(len(record["name"]) for record in records)
    return "\n".join(
        f"{record['name']:{width}}  {record['description'].partition(chr(10))[0]}" for record in records
    )


def details(record: dict[str, Any]) -> str:
    """A law or method on a page: its docstring, then its parameters."""
    lines = [f"{record['name']}  ({record['class']})", "", str(record["description"])]
    for name, words in record.get("declares", {}).items():
        lines.append(f"\n{name}: {words}")
    return "\n".join([*lines, "", *(_parameter_line(given) for given in record["parameters"])]).rstrip()


def _parameter_line(given: dict[str, Any]) -> str:
    default = "required" if given["required"] else f"default {given['default']}"
    return f"{given['name']}: {', '.join(part for part in (given['limits'], default) if part)}"
