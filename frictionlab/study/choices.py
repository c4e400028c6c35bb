"""The laws and methods of a study, each under a unique label."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from frictionlab import registry
from frictionlab.mistakes.notes import Notes, Path, unknown_name, value_text
from frictionlab.mistakes.validation import build_record
from frictionlab.study.parts import LawChoice, MethodChoice

REMEDIES = {"law": "; install the package that provides it, or list its file under plugins"}


def items(given: Any, path: Path, example: str, notes: Notes) -> list[Any]:
    """The items of a list that must not be empty."""
    if not isinstance(given, list):
        notes.add(path, f"must be a list such as {example}, got {value_text(given)}")
        return []
    if not given:
        notes.add(path, f"the list is empty; give at least one, such as {example}")
    return given


def law_choice(given: Any, path: Path, laws: registry.Laws, notes: Notes) -> LawChoice | None:
    """One law; None, noted, where there is a mistake."""
    if not isinstance(given, dict):
        notes.add(path, f"must be a mapping such as {{kind: coulomb, mu: 0.4}}, got {value_text(given)}")
        return None
    if _named_by_its_key(given, laws.names(), path, notes):
        return None
    if given.get("kind") not in laws.names() and notes.below(("plugins",)):
        return None  # an unreadable law file may define it
    kind = _kind(given, path, _name_reader("law", laws.names(), notes), notes)
    label = _label(given, kind, path, notes)
    if kind is None or notes.mapping(given, path) is None:
        return None
    parameters = {key: value for key, value in given.items() if key not in ("kind", "label")}
    law = build_record(laws.named(kind), parameters, path, notes)
    if law is None:
        return None
    laws.check(kind, law)
    return LawChoice(label, kind, law.model_dump(exclude_none=True, mode="json"), type(law))


def method_choice(given: Any, path: Path, notes: Notes) -> MethodChoice | None:
    """One method, by its name or with parameters; None, noted, where there is a mistake."""
    named = _name_reader("method", registry.method_names(), notes)
    if not isinstance(given, dict):
        name = named(given, path)
        return None if name is None else MethodChoice(name, name, {})
    if _named_by_its_key(given, registry.method_names(), path, notes):
        return None
    name = _kind(given, path, named, notes)
    label = _label(given, name, path, notes)
    parameters = {key: value for key, value in given.items() if key not in ("kind", "label")}
    if name is None:
        return None
    if not parameters:
        return MethodChoice(label, name, {})
    method = build_record(registry.method_class(name), parameters, path, notes)
    return None if method is None else MethodChoice(label, name, method.model_dump(exclude_unset=True))


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
            path: Path = (head, index, "label") if own else (head, index)
            notes.add(path, f"{head}[{first[label]}] has the label '{label}' too; give each its own label")


def _name_reader(what: str, installed: Iterable[str], notes: Notes) -> Callable[[Any, Path], str | None]:
    """A reader of a registered name."""
    names = list(installed)

    def name(given: Any, path: Path) -> str | None:
        if isinstance(given, str) and given in names:
            return given
        if isinstance(given, str):
            said, hint = unknown_name(what, given, names)
            notes.add(path, f"{said}{REMEDIES.get(what, '')}", hint)
        else:
            notes.add(path, f"must be the name of a {what}, got {value_text(given)}")
        return None

    return name


def _named_by_its_key(given: dict[str, Any], installed: Iterable[str], path: Path, notes: Notes) -> bool:
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


def _kind(
    given: dict[str, Any], path: Path, named: Callable[[Any, Path], str | None], notes: Notes
) -> str | None:
    if "kind" not in given:
        notes.add((*path, "kind"), "required key is missing")
        return None
    return named(given["kind"], (*path, "kind"))


def _label(given: dict[str, Any], kind: str | None, path: Path, notes: Notes) -> str:
    if "label" not in given:
        return kind or ""
    label = notes.text(given["label"], (*path, "label"))
    if isinstance(given["label"], str) and (not label.strip() or not label.isprintable()):
        notes.add((*path, "label"), "must be one line of visible text")
    return label
