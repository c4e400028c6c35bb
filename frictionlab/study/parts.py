"""Laws and methods of a study, each under a unique label."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

from frictionlab.laws.base import FrictionLaw, Record
from frictionlab.methods.base import REDUCED_MODELS, Method
from frictionlab.scene.waveforms import Form
from frictionlab.study import registry
from frictionlab.study.axes import STATIC, GridValue
from frictionlab.values.notes import KeyPath, Notes, number_text, unknown_name, value_text
from frictionlab.values.quantities import Written
from frictionlab.values.validation import build_record

SCHEMA = 1


@dataclass(frozen=True)
class LawChoice:
    """A law of the study under its label; parameters as given, with the law's defaults."""

    label: str
    kind: str
    parameters: dict[str, Any]
    law_class: type[FrictionLaw] = field(compare=False, repr=False)

    def law(self, values: Mapping[str, GridValue] | None = None) -> FrictionLaw:
        """Return the law, with some parameters replaced by these values."""
        return self.law_class.model_validate(self.parameters | dict(values or {}))

    def under_friction(self, coefficients: tuple[GridValue, ...]) -> dict[str, tuple[GridValue, ...]]:
        """Parameters of the law that has these friction coefficients, ``mu_static`` in the ratio it has."""
        name = coefficient_of(self.law_class)
        given, static = self.parameters[name], self.parameters.get(STATIC)
        if static is None:
            return {name: coefficients}
        numbers = [each for each in coefficients if isinstance(each, float)]
        ratio = static / given
        return {
            name: coefficients,
            STATIC: tuple(static if mu == given else mu * ratio for mu in numbers),
        }

    @property
    def in_words(self) -> str:
        """Return what figures call it: the label that the study gives it, else the law's own words."""
        return self.label if self.label != self.kind else self.law_class.in_words or self.label

    def resolved(self) -> dict[str, Any]:
        """Return the entry of a study file."""
        label = {} if self.label == self.kind else {"label": self.label}
        return {"kind": self.kind, **natural(self.parameters), **label}


def plain_values(law: FrictionLaw) -> dict[str, Any]:
    """Return the parameters of a law as a study gives them; texts with units stay such."""
    written = {name: value for name, value in law if isinstance(value, Written)}
    return law.model_dump(exclude_none=True, mode="json") | written


def coefficient_of(law: type[FrictionLaw]) -> str:
    """Name of the parameter that is the friction coefficient of sliding: mu or mu_kinetic; '' without one."""
    return next((name for name in ("mu", "mu_kinetic") if name in law.model_fields), "")


@dataclass(frozen=True)
class MethodChoice:
    """A method of the study under its label; its class is imported when ``method`` is first used."""

    label: str
    name: str
    parameters: dict[str, Any]

    @classmethod
    def of(cls, method: Method) -> MethodChoice:
        """Return the choice of a method that is there already."""
        choice = cls(method.name, method.name, {})
        vars(choice)["method"] = method
        return choice

    @cached_property
    def method(self) -> Method:
        """Return the method with its parameters."""
        return registry.method_class(self.name).model_validate(self.parameters)

    @property
    def is_reduced(self) -> bool:
        """Check whether it solves a simpler model: its errors are then the distance to the full answers."""
        return self.name in REDUCED_MODELS

    @property
    def in_words(self) -> str:
        """Return what figures call it: the label that the study gives it, else the method's own words."""
        try:
            words = registry.method_class(self.name).in_words
        except (KeyError, registry.BrokenPlugin):  # of a run made where it could be used
            words = ""
        return self.label if self.label != self.name else words or self.label

    def resolved(self) -> str | dict[str, Any]:
        """Return the entry of a study file: the name alone if it has neither parameters nor a label."""
        if self.label == self.name and not self.parameters:
            return self.name
        label = {} if self.label == self.name else {"label": self.label}
        return {"kind": self.name, **natural(self.parameters), **label}


def natural(value: Any) -> Any:
    """Value with whole floats as integers, as a person would write them (and -0.0 as 0), texts as they were."""
    if isinstance(value, Written):
        return value
    if isinstance(value, dict):
        return {key: natural(item) for key, item in value.items()}
    if isinstance(value, Form):
        return natural(value.plain())
    if isinstance(value, list):
        return [natural(item) for item in value]
    if isinstance(value, float) and "." not in (text := number_text(value)) and "e" not in text:
        return int(text)
    return value


class Registered(NamedTuple):
    """Laws or methods of which a study may name some: how a list of them is read."""

    what: str
    example: str
    names: Sequence[str]
    named: Callable[[str], type[Record]]
    unknown: Callable[[str], tuple[str, str]]


def law_choices(given: Any, laws: registry.Laws, notes: Notes) -> tuple[LawChoice, ...]:
    """Return the laws without a mistake; mistakes are noted."""

    def unknown(name: str) -> tuple[str, str]:
        said, hint = laws.unknown(name)
        return f"{said}; install the package that provides it, or list its file under plugins", hint

    kinds = Registered("law", "{kind: coulomb, mu: 0.4}", laws.names(), laws.named, unknown)
    read = [_choice(item, path, kinds, notes) for item, path in _items(given, ("laws",), kinds, notes)]
    found = []
    for label, kind, law in filter(None, read):
        laws.check(kind, law)
        found.append(LawChoice(label, kind, plain_values(law), type(law)))
    return tuple(found)


def method_choices(given: Any, notes: Notes) -> tuple[MethodChoice, ...]:
    """Return the methods without a mistake; mistakes are noted."""
    items = _items(given, ("methods",), _methods(), notes)
    return tuple(filter(None, (method_choice(item, path, notes) for item, path in items)))


def method_choice(given: Any, path: KeyPath, notes: Notes) -> MethodChoice | None:
    """One method, by its name or with parameters; None, noted, where there is a mistake."""
    if (read := _choice(given, path, _methods(), notes)) is None:
        return None
    label, kind, method = read
    return MethodChoice(label, kind, method.model_dump(exclude_unset=True) if method else {})


def _methods() -> Registered:
    def unknown(name: str) -> tuple[str, str]:
        said, hint = unknown_name("method", name, registry.method_names())
        return f"{said}; install the package that provides it", hint

    return Registered("method", "auto", registry.method_names(), registry.method_class, unknown)


def _items(given: Any, path: KeyPath, kinds: Registered, notes: Notes) -> Iterator[tuple[Any, KeyPath]]:
    """Yield the items of a list that must not be empty, each with its path; equal labels are noted."""
    if not isinstance(given, list):
        notes.add(path, f"must be a list such as [{kinds.example}], got {value_text(given)}")
        return
    if not given:
        notes.add(path, f"the list is empty; give at least one, such as [{kinds.example}]")
    first: dict[str, int] = {}
    for index, item in enumerate(given):
        label = label_of(item)
        if label is not None and first.setdefault(label, index) != index:
            at = (*path, index, "label") if isinstance(item, dict) and "label" in item else (*path, index)
            notes.add(at, f"{path[0]}[{first[label]}] has the label '{label}' too; give each its own label")
        yield item, (*path, index)


def _choice(given: Any, path: KeyPath, kinds: Registered, notes: Notes) -> tuple[str, str, Any] | None:
    """Label, kind and record of an item; the record of a method without parameters is None."""
    if (kind := _kind(given, path, kinds, notes)) is None:
        return None
    told = given if isinstance(given, dict) else {}
    label = notes.text(told["label"], (*path, "label")) if "label" in told else kind
    if not label.strip() or not label.isprintable():
        notes.add((*path, "label"), "must be one line of visible text")
    values = {key: value for key, value in told.items() if key not in ("kind", "label")}
    if not values and kinds.what == "method":
        return label, kind, None
    made = build_record(kinds.named(kind), values, path, notes)
    return None if made is None else (label, kind, made)


def _kind(given: Any, path: KeyPath, kinds: Registered, notes: Notes) -> str | None:
    """Return the registered name of an item; None, noted, where it is none."""
    if isinstance(given, dict) and "kind" not in given:
        if not _named_by_its_key(given, kinds.names, path, notes):
            notes.add((*path, "kind"), "required key is missing")
        return None
    name, at = (given["kind"], (*path, "kind")) if isinstance(given, dict) else (given, path)
    if kinds.what == "law" and not isinstance(given, dict):
        notes.add(path, f"must be a mapping such as {kinds.example}, got {value_text(given)}")
    elif not isinstance(name, str):
        notes.add(at, f"must be the name of a {kinds.what}, got {value_text(name)}")
    elif name in kinds.names:
        return name
    elif not notes.below(("plugins",)):  # an unreadable law file may define it
        said, hint = kinds.unknown(name)
        notes.add(at, said, hint)
    return None


def label_of(given: Any) -> str | None:
    """Return the label of an item, whatever other mistakes the item has."""
    label = given.get("label", given.get("kind")) if isinstance(given, dict) else given
    return label if isinstance(label, str) else None


def _named_by_its_key(given: dict[str, Any], installed: Sequence[str], path: KeyPath, notes: Notes) -> bool:
    """Check whether an item is written as ``name: {...}``, which is noted with the way to write it."""
    name = next((key for key in given if key in installed), None)
    if name is None:
        return False
    values = {key: value for key, value in given.items() if key != name}
    values |= given[name] if isinstance(given[name], dict) else {}
    plain = all(isinstance(value, int | float) for value in values.values())
    inside = [f"{key}: {value_text(value)}" for key, value in values.items()] if plain and values else ["..."]
    notes.on_key((*path, name), "a name goes after kind", f"write {{kind: {name}, {', '.join(inside)}}}")
    return True
