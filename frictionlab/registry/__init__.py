"""Laws and methods by name, through entry points: built-ins are registered in the same way as plugins."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib import metadata
from importlib.metadata import EntryPoint
from types import MappingProxyType
from typing import Any

from frictionlab.faults import BrokenPlugin, from_outside
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.mistakes.notes import unknown_name
from frictionlab.registry.entry_points import (
    Home,
    check_class,
    describe_clash,
    home_of,
    is_own,
    open_entry_point,
)
from frictionlab.registry.law_file import code_around
from frictionlab.registry.smoke_test import faults_of_methods

__all__ = [
    "INSTALLED_LAWS",
    "LAWS",
    "METHODS",
    "BrokenPlugin",
    "Laws",
    "law_class",
    "law_names",
    "method_class",
    "method_names",
]

LAWS = "frictionlab.laws"
METHODS = "frictionlab.methods"


def law_names() -> list[str]:
    """The names of every installed law, sorted."""
    return sorted(_entry_points(LAWS))


def method_names() -> list[str]:
    """The names of every installed method, sorted."""
    return sorted(_entry_points(METHODS))


def law_class(name: str) -> type[FrictionLaw]:
    """The law of this name. Raises KeyError for an unknown name, BrokenPlugin for one that cannot be used."""
    found: type[FrictionLaw] = _load(LAWS, name)
    return found


def method_class(name: str) -> type[Method]:
    """The method of this name. Raises KeyError for an unknown name, BrokenPlugin for one that is broken."""
    found: type[Method] = _load(METHODS, name)
    return found


@cache
def method_code(name: str) -> str:
    """SHA-256 of the Python files of the package of a method, which is not loaded; '' for one of frictionlab."""
    return "".join(code_around(door.module) for door in _entry_points(METHODS).get(name, ()))


class Laws:
    """The laws a study may name: those of its law files and the installed ones.

    homes: the origins of the laws of files; a law without one has been checked before.
    """

    def __init__(
        self,
        own: Mapping[str, type[FrictionLaw]] = MappingProxyType({}),
        homes: Mapping[str, Home] = MappingProxyType({}),
    ) -> None:
        self._own, self._homes = own, homes

    def names(self) -> list[str]:
        """All names, sorted."""
        return sorted({*law_names(), *self._own})

    def usable(self) -> list[str]:
        """The names of laws that are not broken."""
        return [name for name in self.names() if not self._wrong(name)]

    def aliases(self) -> dict[str, list[str]]:
        """Every usable law under the name most like that of its class, with its other names."""
        names: dict[type[FrictionLaw], list[str]] = {}
        for name in self.usable():
            names.setdefault(self.named(name), []).append(name)
        return {
            first: [name for name in own if name != first]
            for law, own in names.items()
            for first in [min(own, key=lambda name: name.replace("-", "") != law.__name__.lower())]
        }

    def unknown(self, name: str) -> tuple[str, str]:
        """The sentence for a name that no law has, and a suggestion."""
        aliases = self.aliases()
        others = {each for own in aliases.values() for each in own}
        told = (
            f"{each} (or {', '.join(aliases[each])})" if aliases.get(each) else each
            for each in self.names()
            if each not in others
        )
        return unknown_name("law", name, self.names(), told)

    def broken(self) -> list[str]:
        """A message for every broken law and for every plugin with the name of a law of frictionlab."""
        wrong = [self._wrong(name) for name in self.names()]
        return [
            *filter(None, wrong),
            *(
                f"{describe_clash(doors)}\nthat of frictionlab is used; rename the others"
                for doors in _entry_points(LAWS).values()
                if len(doors) > 1 and any(is_own(door) for door in doors)
            ),
        ]

    def _wrong(self, name: str) -> str:
        try:
            self.named(name)
        except BrokenPlugin as problem:
            return str(problem)
        return ""

    def named(self, name: str) -> type[FrictionLaw]:
        """The law of this name. Raises KeyError for an unknown name, BrokenPlugin for one that cannot be used."""
        if name not in self._own:
            return law_class(name)
        law = self._own[name]
        return _checked(law, self._homes[name]) if name in self._homes else law

    def check(self, name: str, law: FrictionLaw) -> None:
        """Raises BrokenPlugin where a law fails with its given parameters."""
        if from_outside(type(law)) and (wrong := next(faults_of_methods(law), "")):
            home = self._homes.get(name) or home_of(_entry_points(LAWS)[name][0])
            raise home.broken(wrong)


INSTALLED_LAWS = Laws()
"""The installed laws alone, without those of files."""


@cache
def _entry_points(group: str) -> dict[str, tuple[EntryPoint, ...]]:
    """The entry points of each name; duplicates, as from two copies of a package, are merged."""
    found: dict[str, dict[str, EntryPoint]] = {}
    for door in metadata.entry_points(group=group):
        found.setdefault(door.name, {}).setdefault(door.value, door)
    return {name: tuple(doors.values()) for name, doors in found.items()}


@cache
def _load(group: str, name: str) -> Any:
    """The class of this name. Raises KeyError, BrokenPlugin."""
    return open_entry_point(_entry_points(group)[name], FrictionLaw if group == LAWS else Method)


_checked = cache(check_class)
