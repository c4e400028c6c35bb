"""The laws and methods of a study, each under a unique label."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

from frictionlab.laws.base import FrictionLaw
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
        """The law, with some parameters replaced by these values."""
        return self.law_class.model_validate(self.parameters | dict(values or {}))

    def under_friction(self, coefficients: tuple[GridValue, ...]) -> dict[str, tuple[GridValue, ...]]:
        """The parameters of the law that has these friction coefficients, ``mu_static`` in the ratio it has."""
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
        """What figures call it: the label that the study gives it, else the law's own words."""
        return self.label if self.label != self.kind else self.law_class.in_words or self.label

    def resolved(self) -> dict[str, Any]:
        """The entry of a study file."""
        label = {} if self.label == self.kind else {"label": self.label}
        return {"kind": self.kind, **natural(self.parameters), **label}


def plain_values(law: FrictionLaw) -> dict[str, Any]:
    """The parameters of a law as a study gives them; texts with units stay such."""
    written = {name: value for name, value in law if isinstance(value, Written)}
    return law.model_dump(exclude_none=True, mode="json") | written


def coefficient_of(law: type[FrictionLaw]) -> str:
    """The name of the parameter that is the friction coefficient of sliding: mu or mu_kinetic; '' without one."""
    return next((name for name in ("mu", "mu_kinetic") if name in law.model_fields), "")


@dataclass(frozen=True)
class MethodChoice:
    """A method of the study under its label; its class is imported when ``method`` is first used."""

    label: str
    name: str
    parameters: dict[str, Any]

    @classmethod
    def of(cls, method: Method) -> MethodChoice:
        """The choice of a method that is there already."""
        choice = cls(method.name, method.name, {})
        vars(choice)["method"] = method
        return choice

    @cached_property
    def method(self) -> Method:
        """The method with its parameters."""
        return registry.method_class(self.name).model_validate(self.parameters)

    @property
    def is_reduced(self) -> bool:
        """Whether it solves a simpler model: its errors are then the distance to the full answers."""
        return self.name in REDUCED_MODELS

    @property
    def in_words(self) -> str:
        """What figures call it: the label that the study gives it, else the method's own words."""
        try:
            words = registry.method_class(self.name).in_words
        except (KeyError, registry.BrokenPlugin):  # of a run made where it could be used
            words = ""
        return self.label if self.label != self.name else words or self.label

    def resolved(self) -> str | dict[str, Any]:
        """The entry of a study file: the name alone if it has neither parameters nor a label."""
        if self.label == self.name and not self.parameters:
            return self.name
        label = {} if self.label == self.name else {"label": self.label}
        return {"kind": self.name, **natural(self.parameters), **label}


def natural(value: Any) -> Any:
    """The value with whole floats as integers, as a person would write them (and -0.0 as 0), texts as they were."""
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


def items(given: Any, path: KeyPath, example: str, notes: Notes) -> list[Any]:
    """The items of a list that must not be empty."""
    if not isinstance(given, list):
        notes.add(path, f"must be a list such as {example}, got {value_text(given)}")
        return []
    if not given:
        notes.add(path, f"the list is empty; give at least one, such as {example}")
    return given


def law_choice(given: Any, path: KeyPath, laws: registry.Laws, notes: Notes) -> LawChoice | None:
    """One law; None, noted, where there is a mistake."""
    if not isinstance(given, dict):
        notes.add(path, f"must be a mapping such as {{kind: coulomb, mu: 0.4}}, got {value_text(given)}")
        return None
    if isinstance(kind := given.get("kind"), str) and kind not in laws.names():
        if not notes.below(("plugins",)):  # an unreadable law file may define it
            said, hint = laws.unknown(kind)
            remedy = "install the package that provides it, or list its file under plugins"
            notes.add((*path, "kind"), f"{said}; {remedy}", hint)
        return None
    if (item := _item(given, "law", laws.names(), path, notes)) is None:
        return None
    law = build_record(laws.named(item.kind), item.parameters, path, notes)
    if law is None:
        return None
    laws.check(item.kind, law)
    return LawChoice(item.label, item.kind, plain_values(law), type(law))


def method_choice(given: Any, path: KeyPath, notes: Notes) -> MethodChoice | None:
    """One method, by its name or with parameters; None, noted, where there is a mistake."""
    names = registry.method_names()
    if not isinstance(given, dict):
        name = _name(given, "method", names, path, notes)
        return None if name is None else MethodChoice(name, name, {})
    item = _item(given, "method", names, path, notes)
    if item is None:
        return None
    if not item.parameters:
        return MethodChoice(item.label, item.kind, {})
    method = build_record(registry.method_class(item.kind), item.parameters, path, notes)
    return (
        None if method is None else MethodChoice(item.label, item.kind, method.model_dump(exclude_unset=True))
    )


class _Item(NamedTuple):
    """A law or method as it is given."""

    label: str
    kind: str
    parameters: dict[str, Any]


def _item(
    given: dict[str, Any], what: str, installed: Sequence[str], path: KeyPath, notes: Notes
) -> _Item | None:
    """A law or method of one of these names; None, noted, where its name is wrong."""
    if _named_by_its_key(given, installed, path, notes):
        return None
    kind = None
    if "kind" in given:
        kind = _name(given["kind"], what, installed, (*path, "kind"), notes)
    else:
        notes.add((*path, "kind"), "required key is missing")
    label = _label(given["label"], (*path, "label"), notes) if "label" in given else kind or ""
    parameters = {key: value for key, value in given.items() if key not in ("kind", "label")}
    return None if kind is None else _Item(label, kind, parameters)


def label_of(given: Any) -> str | None:
    """The label of an item, whatever other mistakes the item has."""
    label = given.get("label", given.get("kind")) if isinstance(given, dict) else given
    return label if isinstance(label, str) else None


def note_equal_labels(given: Sequence[Any], head: str, notes: Notes) -> None:
    """Note every item with the same label as an earlier one."""
    first: dict[str, int] = {}
    for index, item in enumerate(given):
        label = label_of(item)
        if label is not None and first.setdefault(label, index) != index:
            own = isinstance(item, dict) and "label" in item
            path: KeyPath = (head, index, "label") if own else (head, index)
            notes.add(path, f"{head}[{first[label]}] has the label '{label}' too; give each its own label")


def _name(given: Any, what: str, installed: Sequence[str], path: KeyPath, notes: Notes) -> str | None:
    """A registered name."""
    if isinstance(given, str) and given in installed:
        return given
    if isinstance(given, str):
        said, hint = unknown_name(what, given, installed)
        notes.add(path, f"{said}; install the package that provides it", hint)
    else:
        notes.add(path, f"must be the name of a {what}, got {value_text(given)}")
    return None


def _named_by_its_key(given: dict[str, Any], installed: Iterable[str], path: KeyPath, notes: Notes) -> bool:
    """Whether an item is written as ``name: {...}``, which is noted with the way to write it."""
    name = next((key for key in given if key in installed), None)
    if name is None or "kind" in given:
        return False
    values = {key: value for key, value in given.items() if key != name}
    values |= given[name] if isinstance(given[name], dict) else {}
    plain = all(isinstance(value, int | float) for value in values.values())
    inside = [f"{key}: {value_text(value)}" for key, value in values.items()] if plain and values else ["..."]
    notes.on_key((*path, name), "a name goes after kind", f"write {{kind: {name}, {', '.join(inside)}}}")
    return True


def _label(given: Any, path: KeyPath, notes: Notes) -> str:
    label = notes.text(given, path)
    if isinstance(given, str) and (not label.strip() or not label.isprintable()):
        notes.add(path, "must be one line of visible text")
    return label
