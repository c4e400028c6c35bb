"""Names to laws and methods, through entry points: built-ins come in by the same door as plugins."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any

from frictionlab.bibliography import references
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method

LAWS = "frictionlab.laws"
METHODS = "frictionlab.methods"


class BrokenPlugin(Exception):
    """An installed law or method that cannot be used; the message names it and says what to do."""


def law_names() -> list[str]:
    """The names of every installed law, sorted."""
    return sorted(_doors(LAWS))


def method_names() -> list[str]:
    """The names of every installed method, sorted."""
    return sorted(_doors(METHODS))


def law_class(name: str) -> type[FrictionLaw]:
    """The law of this name. Raises KeyError for an unknown name, BrokenPlugin for one that cannot be used."""
    return _load(LAWS, name, FrictionLaw)


def method_class(name: str) -> type[Method]:
    """The method of this name. Raises KeyError for an unknown name, BrokenPlugin for one that is broken."""
    return _load(METHODS, name, Method)


class Laws:
    """The laws a study may name: those of its own files, and those installed."""

    def __init__(self, own: Mapping[str, type[FrictionLaw]] | None = None) -> None:
        self._own = dict(own or {})

    def names(self) -> list[str]:
        """The names of all of them, sorted."""
        return sorted({*law_names(), *self._own})

    def usable(self) -> list[str]:
        """The names of those that are not broken."""
        return [name for name in self.names() if not self._broken(name)]

    def _broken(self, name: str) -> bool:
        try:
            self.named(name)
        except BrokenPlugin:
            return True
        return False

    def named(self, name: str) -> type[FrictionLaw]:
        """The law of this name. Raises KeyError for an unknown name, BrokenPlugin for one that cannot be used."""
        return self._own[name] if name in self._own else law_class(name)


@cache
def _doors(group: str) -> dict[str, EntryPoint]:
    return {door.name: door for door in entry_points(group=group)}


@cache
def _load(group: str, name: str, kind: type[FrictionLaw] | type[Method]) -> Any:
    door = _doors(group)[name]
    try:
        loaded = door.load()
    except Exception as problem:
        raise BrokenPlugin(
            f"{group} entry point '{name}' = {door.value} cannot be loaded: {type(problem).__name__}: {problem}; "
            f"repair or uninstall the package that brings it"
        ) from problem
    if not (isinstance(loaded, type) and issubclass(loaded, kind)):
        raise BrokenPlugin(f"{group} entry point '{name}' = {door.value} is not a {kind.__name__} class")
    if missing := sorted(getattr(loaded, "__abstractmethods__", ())):
        raise BrokenPlugin(
            f"{group} entry point '{name}' = {door.value} does not define {', '.join(missing)}"
        )
    try:
        references(loaded.bibtex)
    except ValueError as problem:
        raise BrokenPlugin(f"{group} entry point '{name}' = {door.value}, its bibtex: {problem}") from problem
    return loaded
