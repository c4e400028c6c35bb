"""Installed laws and methods as plain records, for output as text or JSON."""

from __future__ import annotations

import inspect
import re
from collections.abc import Sequence
from typing import Annotated, Any, Literal, get_args, get_origin

from pydantic import BaseModel

from frictionlab.laws.base import Dimension, FrictionLaw, Record
from frictionlab.laws.faults import home_of_law
from frictionlab.methods.base import Method
from frictionlab.study import registry
from frictionlab.study.bibliography import publications

_LIMITS = {"gt": ">", "ge": ">=", "lt": "<", "le": "<="}


def law_record(name: str, law: type[FrictionLaw], aliases: Sequence[str] = ()) -> dict[str, Any]:
    """A law under this name: its other names, description, parameters and declarations."""
    return {
        "name": name,
        "aliases": list(aliases),
        "description": description(law),
        "parameters": _parameters(law),
        "declares": _declared(law),
        "sources": _sources(law),
        "class": _class(law),
    }


def method_record(name: str) -> dict[str, Any]:
    """A method: its name, description, the cases it refuses, its parameters. Raises KeyError, BrokenPlugin."""
    method = registry.method_class(name)
    return {
        "name": name,
        "description": description(method),
        "refuses": inspect.getdoc(method.refusal) or "",
        "parameters": _parameters(method),
        "sources": _sources(method),
        "class": f"{method.__module__}.{method.__qualname__}",
    }


def _class(law: type[FrictionLaw]) -> str:
    """``module.Class`` of a law, or ``file.py:Class`` of a law from a file."""
    home = home_of_law(law)
    return f"{home}:{law.__qualname__}" if home.endswith(".py") else f"{home}.{law.__qualname__}"


def description(kind: type) -> str:
    """Return the docstring of a class without its examples, which are for Python."""
    text = re.sub(r"(?m)^Examples\n-{8}\n", "", inspect.getdoc(kind) or "")
    return "\n\n".join(each for each in text.split("\n\n") if not each.startswith(">>> ")).rstrip()


def _sources(kind: type[FrictionLaw] | type[Method]) -> list[str]:
    return [each.text for each in publications(description(kind), kind.bibtex)]


def _declared(law: type[FrictionLaw]) -> dict[str, str]:
    """Return the predicates that a law overrides, each with its docstring up to the numpydoc sections."""
    first: dict[str, Any] = {}
    for kind in reversed(law.__mro__):
        if issubclass(kind, FrictionLaw):
            first = {
                name: method for name, method in vars(kind).items() if _returns_a_truth_value(method)
            } | first
    own = [name for name, method in first.items() if getattr(law, name) is not method]
    texts = {name: inspect.getdoc(getattr(law, name)) or "" for name in own}
    return {name: re.split(r"\n\n(?:Parameters|Returns)\n---", text)[0] for name, text in texts.items()}


def _returns_a_truth_value(method: Any) -> bool:
    return inspect.isfunction(method) and method.__annotations__.get("return") in (bool, "bool")


def _parameters(record: type[Record]) -> list[dict[str, Any]]:
    return [_parameter(name, field, meaning(record, name)) for name, field in record.model_fields.items()]


def _owner(record: type[BaseModel], name: str) -> type[BaseModel]:
    """Return the class that defines a parameter and documents it."""
    return next((kind for kind in record.__mro__ if name in inspect.get_annotations(kind)), record)


def _unit(field: Any) -> str:
    """In SI, such as N s/m; empty for what has no dimension."""
    dimension = next((rule for rule in _rules(field) if isinstance(rule, Dimension)), None)
    if dimension is None:
        return ""
    powers = [("N", dimension.force), ("s", dimension.time), ("m", dimension.length)]
    above = " ".join(_power(unit, power) for unit, power in powers if power > 0) or "1"
    below = [_power(unit, -power) for unit, power in powers if power < 0]
    return "/".join([above, *below])


def _power(unit: str, power: int) -> str:
    return unit if power == 1 else f"{unit}^{power}"


def _parameter(name: str, field: Any, meant: str) -> dict[str, Any]:
    limits = [
        f"{sign} {bound:g}"
        for rule in _rules(field)
        for key, sign in _LIMITS.items()
        if (bound := getattr(rule, key, None)) is not None
    ]
    each = "a list, each " if get_origin(field.annotation) is tuple else ""
    words = get_args(field.annotation) if get_origin(field.annotation) is Literal else ()
    return {
        "name": name,
        "required": field.is_required(),
        "default": None if field.is_required() else field.default,
        "limits": each + " and ".join(limits) or " | ".join(map(str, words)),
        "unit": _unit(field),
        "meaning": meant,
    }


def _rules(field: Any) -> list[Any]:
    """Return the limits on the values of a field, those inside an optional type included."""
    inside = [kind.__metadata__ for kind in get_args(field.annotation) if get_origin(kind) is Annotated]
    rules = [rule for metadata in [field.metadata, *inside] for rule in metadata]
    return [each for rule in rules for each in (rule, *getattr(rule, "metadata", ()))]


def meaning(record: type[BaseModel], name: str) -> str:
    """Return what the docstring of a class says of a field; '' if it says nothing.

    In a numpydoc section ``Parameters`` that is the indented text below the field. Elsewhere it goes from the name at
    the start of a line to a blank line, the sources, or a line that begins with another field.
    """
    owner, wanted = description(_owner(record, name)), re.escape(name)
    for text in (description(record), owner):
        if found := re.search(rf"^{wanted} : .*((?:\n+ +\S.*)+)", text, re.MULTILINE):
            return " ".join(found[1].split()).removesuffix(".")
    fields = "|".join(re.escape(field.alias or each) for each, field in record.model_fields.items())
    found = re.search(
        rf"^{wanted}\b([ :,].*(?:\n(?!\s*$|Sources?:|\w+ \[|(?:{fields})\b ?[:,>(]).*)*)",
        owner,
        re.MULTILINE,
    )
    said = " ".join(found[1].split()).lstrip(":, ") if found else ""
    return re.sub("[,;] or instead$", "", said)  # the next line goes on


def one_line_each(records: Sequence[dict[str, Any]]) -> str:
    """Laws or methods by name and the first line of their docstring."""
    names = [", ".join([record["name"], *record.get("aliases", ())]) for record in records]
    width = max(map(len, names))
    return "\n".join(
        f"{name:{width}}  {record['description'].partition(chr(10))[0]}"
        for name, record in zip(names, records, strict=True)
    )


def details(record: dict[str, Any]) -> str:
    """A law or method on a page: its docstring, then its parameters."""
    lines = [f"{record['name']}  ({record['class']})", "", str(record["description"])]
    for name, words in record.get("declares", {}).items():
        lines.append(f"\n{name}: {words}")
    lines += ["", *(_parameter_line(given) for given in record["parameters"])]
    return "\n".join([*lines, "", *record.get("sources", [])]).rstrip()


def _parameter_line(given: dict[str, Any]) -> str:
    default = "may be left out" if given["default"] is None else f"default {given['default']}"
    unit = f"{given['unit']} in SI" if given["unit"] else ""
    told = given["limits"], "required" if given["required"] else default, unit
    return f"{given['name']}: {', '.join(part for part in told if part)}"
