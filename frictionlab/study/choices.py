"""The laws and methods of a study, each under a unique label."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from frictionlab import registry
from frictionlab.mistakes.notes import Notes, Path, unknown_name, value_text
from frictionlab.mistakes.validation import build_record
from frictionlab.study.parts import LawChoice, MethodChoice, plain_values


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


def method_choice(given: Any, path: Path, notes: Notes) -> MethodChoice | None:
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
    given: dict[str, Any], what: str, installed: Sequence[str], path: Path, notes: Notes
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
            path: Path = (head, index, "label") if own else (head, index)
            notes.add(path, f"{head}[{first[label]}] has the label '{label}' too; give each its own label")


def _name(given: Any, what: str, installed: Sequence[str], path: Path, notes: Notes) -> str | None:
    """A registered name."""
    if isinstance(given, str) and given in installed:
        return given
    if isinstance(given, str):
        notes.add(path, *unknown_name(what, given, installed))
    else:
        notes.add(path, f"must be the name of a {what}, got {value_text(given)}")
    return None


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


def _label(given: Any, path: Path, notes: Notes) -> str:
    label = notes.text(given, path)
    if isinstance(given, str) and (not label.strip() or not label.isprintable()):
        notes.add(path, "must be one line of visible text")
    return label
