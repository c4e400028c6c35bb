"""Values and parameters as one would type them in Python: 10 for 10.0, ``float | None`` for a checked number."""

from __future__ import annotations

import inspect
import math
import types
from collections.abc import Iterable
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic.fields import FieldInfo


def typed(value: Any) -> str:
    """A value as one would type it."""
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e16:
        return str(int(value)) if value or math.copysign(1.0, value) > 0.0 else "-0.0"
    return repr(value)


class _Type(str):
    """The name of a type; in a signature without quotes."""

    __slots__ = ()
    __repr__ = str.__str__


def keywords(
    fields: Iterable[tuple[str, FieldInfo]], others: Iterable[inspect.Parameter]
) -> inspect.Signature:
    """The signature of what takes these fields by name: plain types and defaults, without how each is checked.

    others: parameters of which those by name follow.
    """
    beside = [each for each in others if each.kind is inspect.Parameter.KEYWORD_ONLY]
    return inspect.Signature([*(_keyword(name, field) for name, field in fields), *beside])


def _keyword(name: str, field: FieldInfo) -> inspect.Parameter:
    default = inspect.Parameter.empty if field.is_required() else field.get_default(call_default_factory=True)
    kind = _Type(_type_text(field.annotation))
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=kind)


def _type_text(annotation: Any) -> str:
    """A type without the checks written beside it; what is made of text or mappings as these."""
    origin = get_origin(annotation)
    if origin is Annotated:
        return _type_text(get_args(annotation)[0])
    if origin in (Union, types.UnionType):
        return " | ".join(map(_type_text, get_args(annotation)))
    if origin is Literal:
        return f"Literal[{', '.join(map(repr, get_args(annotation)))}]"
    if annotation is types.NoneType:
        return "None"
    if isinstance(annotation, type) and origin is None:
        return str(annotation.given_as()) if hasattr(annotation, "given_as") else annotation.__name__
    return str(annotation).replace("typing.", "")
