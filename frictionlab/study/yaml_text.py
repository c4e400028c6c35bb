"""Plain values as YAML text that every YAML reader reads back to the same values."""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Iterator
from typing import Any

from frictionlab.printable import printable
from frictionlab.quantities import Written

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
    """The shortest form that reads back the same; YAML 1.1 reads 1e-08 without a point as text."""
    mantissa, e, exponent = repr(value).partition("e")
    return f"{mantissa}{'' if '.' in mantissa else '.0'}{e}{exponent}"
