"""Checks of the record itself: how it is found, told about, kept from being misused, and answers at all."""

from __future__ import annotations

import math
import re
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from hypothesis import assume
from pydantic import ValidationError

from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw
from frictionlab.study import registry
from frictionlab.study.records import law_record
from frictionlab.testing.contact import ContactMemory, no_plane, response
from frictionlab.testing.example import Given, law_check
from frictionlab.testing.strategies import fullest_laws, loaded_laws, words

YEAR = re.compile(r"\(?\b1[5-9]\d\d\b|\b20\d\d\b")
DECADES_OF_SPEED = (1e-4, 1e-2, 0.1, 0.5, 1.0, 3.0, 10.0, 1e2, 1e4)
EXTREMES = (1e-150, 1e-30, 1e-12, 1e12, 1e30)


def not_registered(law: type[FrictionLaw]) -> str:
    """Why no name leads to the law, or ''."""
    return "" if any(_leads_to(name, law) for name in registry.law_names()) else "entered under no name"


def _leads_to(name: str, law: type[FrictionLaw]) -> bool:
    try:
        return registry.law_class(name) is law
    except registry.BrokenPlugin:
        return False


@law_check(
    change="enter the class under [project.entry-points.'frictionlab.laws'] of pyproject.toml",
    skips=not_registered,
    share=0.0,
)
def loads_by_name(one: Given) -> None:
    """Laws are found by their names, and can be listed."""
    one.require(
        law_record("law", one.kind)["class"].endswith(one.kind.__qualname__), "listed as another class"
    )


@law_check(
    change="write into the docstring of the class what each parameter is, as in `mu [-], > 0: ...`, and its source",
    share=0.0,
)
def documented(one: Given) -> None:
    """Docstring names a source with its year, and every parameter with its unit in brackets."""
    record = law_record("law", one.kind)
    text = record["description"]
    one.require(bool(YEAR.search(text)), "the docstring names no source: write Sources: Author (year)")
    for given in record["parameters"]:
        name = given["name"]
        one.require(
            bool(given["meaning"]), f"the docstring does not tell of {name}: start a line with its name"
        )
        worded = bool(given["limits"]) and "|" in given["limits"]
        one.require(
            worded or "[" in given["meaning"] or given["meaning"].startswith("how"),
            f"{name}: no unit in brackets, [-] for none",
        )


@law_check(change="leave model_config as it is, and make defaults numbers or tuples", share=0.1)
def frozen(one: Given) -> None:
    """A law cannot be changed once made, and no default of it can."""
    law = one.law()
    for name, field in one.kind.model_fields.items():
        default = None if field.is_required() else field.get_default(call_default_factory=True)
        mutable = isinstance(default, list | dict | set | bytearray) or hasattr(default, "__setitem__")
        one.require(not mutable, f"the default of {name} can be changed: use a tuple", default=default)
        try:
            setattr(law, name, getattr(law, name))
        except AttributeError:
            continue
        one.require(False, f"{name} can be set on a law that is made: keep model_config frozen")
    hash(law)


@law_check(change="leave model_config as it is", share=0.1)
def unknown_parameters_refused(one: Given) -> None:
    """A parameter the law does not have is refused."""
    law = one.law()
    one.require(
        _refused(one.kind, {**law.model_dump(exclude_none=True), "no_such_parameter": 1.0}),
        "an unknown parameter is taken",
    )


@law_check(change="annotate the parameter as fl.Positive, fl.NonNegative or fl.Finite", share=0.1)
def limits_kept(one: Given) -> None:
    """Words, truth values, NaN and infinity are no numbers of a law."""
    law = one.law()
    given = law.model_dump(exclude_none=True)
    for name, value in given.items():
        if isinstance(value, float):
            for wrong in ("0.4", True, math.nan, math.inf):
                changed = {**given, name: wrong}
                one.require(_refused(one.kind, changed), f"{name} takes {wrong!r}")


@law_check(change="change the default, or the bound of the parameter", share=0.1)
def defaults_valid(one: Given) -> None:
    """Defaults of parameters lie within the law's own limits."""
    given = one.law().model_dump(exclude_none=True)
    for name, field in one.kind.model_fields.items():
        default = None if field.is_required() else field.get_default(call_default_factory=True)
        if default is not None:
            try:
                one.kind.model_validate({**given, name: default})
            except ValidationError as problem:
                wrong = [error["msg"] for error in problem.errors() if error["loc"][:1] == (name,)]
                one.require(
                    not wrong, f"the default of {name} is refused: {'; '.join(wrong)}", default=default
                )


def _refused(law: type[FrictionLaw], given: dict[str, Any]) -> bool:
    try:
        law.model_validate(given)
    except ValidationError:
        return True
    return False


@law_check(
    change="return a finite number from that method, or bound the parameters: Annotated[fl.Positive, Field(le=10)]",
)
def answers(one: Given) -> None:
    """Every method answers with a finite number: a float on the line, a complex number in the plane."""
    law = one.law()
    v, memory = one.motion(law)
    sliding = law.sliding_friction(abs(v))
    _number(one, float, sliding, "sliding_friction")
    one.require(
        sliding >= 0.0, "sliding_friction must be at least 0: end its fall, as by max(0.0, ...)", got=sliding
    )
    _numbers(one, law, v, memory)
    if not no_plane(law):
        _numbers(one, law, *one.motion(law, planar=True))


def _numbers(one: Given, law: FrictionLaw, v: Any, memory: ContactMemory) -> None:
    got = response(law, v, memory)
    _number(one, type(v), got.friction, "friction")
    for rate in got.rates:
        _number(one, float if _scalars(law) else type(v), rate, "rate")


def _number(one: Given, kind: type, value: Any, whose: str) -> None:
    one.require(isinstance(value, kind), f"{whose} must be a {kind.__name__}, got {type(value).__name__}")
    one.require(math.isfinite(abs(value)), f"{whose} must be finite", got=value)


@law_check(
    change="write the formula so that it holds at rest and at any speed, or bound the parameters",
    share=0.3,
)
def extremes(one: Given) -> None:
    """At rest and at speeds of any size nothing divides by zero and nothing overflows."""
    law = one.law()
    _, memory = one.motion(law)
    for speed in (0.0, *EXTREMES):
        _number(one, float, law.sliding_friction(speed), f"sliding_friction at speed {speed:g}")
    # Without memory friction at rest is set-valued: nobody asks for it.
    for v in EXTREMES if isinstance(law, SlidingLaw) else (0.0, *EXTREMES):
        _numbers(one, law, v, memory)
        if not no_plane(law) and memory:
            _numbers(one, law, complex(v), memory if _scalars(law) else tuple(map(complex, memory)))


@law_check(change="let the method depend on its arguments and the parameters alone", share=0.2)
def repeatable(one: Given) -> None:
    """Asked the same again, later, a law answers the same: no chance, no clock, nothing kept between calls."""
    law = one.law()
    v, memory = one.motion(law)
    first = asked(law, v, memory)
    time.sleep(0.002)
    asked(law, -0.7 * v, tuple(0.3 * each for each in memory))
    if memory:
        again = _friction_alone(law, v, memory, first[1].rates)
        one.require(again == first[1].friction, "friction depends on what rate was asked last")
    one.require(asked(law, v, memory) == first, "asked the same again the law answers otherwise")


def _friction_alone(law: Any, v: float, memory: ContactMemory, rates: ContactMemory) -> Any:
    """Without asking for the rates first."""
    if isinstance(law, BristleLaw):
        return law.friction(v, memory[0], rates[0])
    return law.friction(v, np.array(memory), np.array(rates))


@law_check(
    change="let the method depend on its arguments and the parameters alone, without a cache of its own",
    share=0.2,
)
def instances_apart(one: Given) -> None:
    """Calls of one law change nothing for another of the same parameters."""
    law = one.law()
    v, memory = one.motion(law)
    twin = type(law)(**law.model_dump(exclude_none=True))
    first = asked(law, v, memory)
    asked(one.draw("other law", loaded_laws(one.kind)), -2.0 * v, tuple(0.5 * each for each in memory))
    one.require(asked(twin, v, memory) == first, "a law of the same parameters answers otherwise")


def _all_mattered(one: Given) -> None:
    """After all examples: what was changed and never changed an answer does nothing."""
    for name in one.kind.model_fields:
        idle = f"{name} changed" in one.notes and name not in one.notes
        one.require(not idle, f"{name} changes no answer of the law")


@law_check(
    change="use the parameter in a method, or take it out",
    share=0.5,
    after=_all_mattered,
)
def parameters_matter(one: Given) -> None:
    """Every parameter changes what the law answers, for some values of the others."""
    law = one.draw("law", fullest_laws(one.kind))
    v, planar = one.slip(), one.planar_slip()
    here = law.under_load(2.0)
    memory = one.memory(here)
    assume(any(memory) or not memory)
    for name in set(one.kind.model_fields) - one.notes:
        for changed in _with_another(name, law):
            one.notes.add(f"{name} changed")
            there = changed.under_load(2.0)
            slips = [times * v for times in DECADES_OF_SPEED]
            differ = any(_apart(asked(here, w, memory), asked(there, w, memory)) for w in slips)
            if differ or _differ_in_the_plane(here, there, planar, memory):
                one.notes.add(name)


def _with_another(name: str, law: FrictionLaw) -> Iterator[FrictionLaw]:
    """Yield the law with another value of one parameter, where it has one and that makes a law."""
    value = getattr(law, name)
    for change in _changes(value, words(type(law), name)):
        if change != value:
            with suppress(ValidationError):
                yield law.model_validate(law.model_dump(exclude_none=True) | {name: change})


def _changes(value: Any, words: Sequence[str]) -> Sequence[Any]:
    """Other values near this one."""
    if isinstance(value, float):
        return 0.7 * value, 1.4 * value, value + 0.1
    if isinstance(value, int):
        return value + 1, value - 1
    if isinstance(value, tuple):
        first_alone = (1.4 * value[0], *value[1:]) if value else value  # where shares alone matter
        return tuple(0.7 * each for each in value), tuple(1.4 * each for each in value), first_alone
    return words if value is not None else ()


def _apart(one: tuple[Any, ...], other: tuple[Any, ...]) -> bool:
    """Check whether answers differ by more than rounding."""
    if len(one) != len(other):
        return True
    return any(
        _apart(a, b) if isinstance(a, tuple) else abs(a - b) > 1e-10 * (abs(a) + abs(b))
        for a, b in zip(one, other, strict=True)
    )


def _differ_in_the_plane(law: FrictionLaw, other: FrictionLaw, v: complex, memory: ContactMemory) -> bool:
    if no_plane(law) or no_plane(other):
        return bool(no_plane(law)) != bool(no_plane(other))
    across = memory if _scalars(law) else tuple(0.6 * each - 0.5j * each for each in memory)
    return _apart(response(law, v, across), response(other, v, across))


def asked(law: FrictionLaw, v: float, memory: ContactMemory) -> tuple[Any, ...]:
    """Return what a law says about one slip velocity, by every method that has an answer."""
    if isinstance(law, MemoryLaw):  # another law may remember more, or less
        memory = tuple(memory[k] if k < len(memory) else law.steady(v, k) for k in range(law.count()))
    exact = isinstance(law, BristleLaw) and law.exact_path()
    path = (law.deflected(memory[0], v),) if exact and isinstance(law, BristleLaw) else ()
    held = (law.static_friction(),) if isinstance(law, SlidingLaw) else ()
    return (law.sliding_friction(abs(v)), response(law, v, memory), *path, *held)


def _scalars(law: FrictionLaw) -> bool:
    return isinstance(law, MemoryLaw) and law.memory_kind == "scalars"
