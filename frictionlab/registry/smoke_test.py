"""Trial calls of a law of another package before it is used, interpreted."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from numbers import Complex, Real
from typing import Any

from pydantic import ValidationError

from frictionlab.faults import (
    definition_line,
    describe_error,
    files_of,
    from_outside,
    shown,
)
from frictionlab.laws.arrays import as_written
from frictionlab.laws.base import FrictionLaw

SAMPLES = (1.0, 0.5, 2.0, 10.0)
"""Trial values for the parameters of a law."""

Fault = str
"""A sentence that says what is wrong with a law."""


def faults_of_samples(law: type[FrictionLaw]) -> Iterator[Fault]:
    """The faults of a law when it is built and called with sample parameters, one after the other."""
    for parameters in _samples(law):
        try:
            made = law.model_validate(parameters)
        except ValidationError as problem:
            if not law.model_fields or (not parameters and not _optional(law)):
                yield f"its own defaults are refused: {problem.errors(include_url=False)[0]['msg']}"
            continue
        except Exception as problem:
            given = ", ".join(f"{name}={value:g}" for name, value in parameters.items())
            yield f"{law.__name__}({given}) raises {describe_error(problem, files_of(law))}"
            return
        yield from faults_of_methods(made)
        return


def _samples(law: type[FrictionLaw]) -> Iterator[dict[str, float]]:
    """Parameters to build a law with: the required ones, then each optional one beside them."""
    required = [name for name, field in law.model_fields.items() if field.is_required()]
    for number in SAMPLES:
        given = dict.fromkeys(required, number)
        yield given
        yield from (given | {name: number} for name in _optional(law))


def _optional(law: type[FrictionLaw]) -> list[str]:
    return [name for name, field in law.model_fields.items() if field.default is None]


def faults_of_methods(given: FrictionLaw) -> Iterator[Fault]:
    """The faults of the interfaces' methods that the law's author wrote, on the line and in the plane."""
    law = given.under_load(1.0)
    if wrong := _fault_of_error(law, "its properties", law.numbers):
        yield wrong
        return
    for v in (1.0, complex(0.6, 0.8)) if _is_planar(law) else (1.0,):
        arguments = _arguments(law, v)
        for name, interface in overridden_methods(type(law)):
            if wrong := _fault_of_call(law, name, interface, arguments):
                yield wrong


def overridden_methods(law: type[FrictionLaw]) -> list[tuple[str, Any]]:
    """The public methods of the interfaces that a law overrides, each with the method of the interface."""
    interfaces = [kind for kind in law.__mro__ if issubclass(kind, FrictionLaw) and not from_outside(kind)]
    said: dict[str, Any] = {}
    for kind in reversed(interfaces):
        methods = ((name, as_written(member)) for name, member in vars(kind).items())
        said |= {name: method for name, method in methods if inspect.isfunction(method)}
    return [
        (name, method)
        for name, method in said.items()
        if name[0] != "_" and as_written(inspect.getattr_static(law, name)) is not method
    ]


def _is_planar(law: Any) -> bool:
    return law.memory_kind != "bristle" or (law.planar == "vectorial" and not law.no_vector_form())


def _arguments(law: Any, v: Any) -> dict[str, Any]:
    """Arguments for the methods, by the names in their interfaces."""
    told: dict[str, Any] = {
        "speed": 1.0,
        "normal_load": 1.0,
        "side": 1.0,
        "v": v,
        "path": v,
        "z": 0.0 * v,
        "k": 0,
    }
    if law.memory_kind == "bristle":
        told["dz"] = 0.0 * v
    if law.memory_kind in ("deflections", "scalars"):
        still = 0.0 * v if law.memory_kind == "deflections" else 0.0
        told |= {"memory": [still] * law.count(), "rates": [still] * law.count()}
    return told


def _fault_of_call(law: FrictionLaw, name: str, interface: Any, arguments: dict[str, Any]) -> Fault | None:
    names = list(inspect.signature(interface).parameters)[1:]
    if not set(names) <= set(arguments):
        return None
    answer: list[Any] = []
    values = [arguments[each] for each in names]
    call = f"{name}({', '.join(f'{each}={arguments[each]}' for each in names)})"
    if wrong := _fault_of_error(law, call, lambda: answer.append(getattr(law, name)(*values))):
        return wrong
    kind = str(inspect.signature(interface).return_annotation)
    if not answer or _is_a(answer[0], kind, any(isinstance(value, complex) for value in values)):
        return None
    hint = ": is its return missing?" if answer[0] is None else ""
    code = inspect.unwrap(getattr(type(law), name)).__code__
    return f"{call} returns {shown(answer[0])}, which is no {_KINDS[kind]}{hint}{definition_line(code)}"


def _fault_of_error(law: FrictionLaw, what: str, call: Callable[[], object]) -> Fault | None:
    """The fault of a call that raises; arithmetic errors, which may depend on the numbers, are no fault."""
    try:
        call()
    except (ArithmeticError, ValueError):
        return None
    except Exception as problem:
        return f"{what} raises {describe_error(problem, files_of(type(law)))}"
    return None


_KINDS = {"float": "number", "int": "whole number", "bool": "True or False", "str": "text", "Any": "number"}
_KINDS |= {"complex": "number", "Self": "law", "tuple[str, ...]": "tuple of words"}


def _is_a(answer: Any, kind: str, planar: bool) -> bool:
    if kind not in _KINDS:
        return True
    if kind == "bool":
        return isinstance(answer, bool) or type(answer).__name__ == "bool_"
    if kind == "Self":
        return isinstance(answer, FrictionLaw)
    if kind in ("str", "tuple[str, ...]"):
        return isinstance(answer, str if kind == "str" else tuple)
    if isinstance(answer, bool):
        return False
    return isinstance(answer, Complex if planar and kind in ("Any", "complex") else Real)
