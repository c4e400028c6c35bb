"""Laws and methods by name, through entry points: built-ins are registered in the same way as plugins.

Laws from one Python file: read, imported as a module, its law classes by name.
"""

from __future__ import annotations

import copyreg
import hashlib
import linecache
import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import metadata
from importlib.metadata import EntryPoint
from importlib.util import find_spec
from pathlib import Path
from types import FunctionType, MappingProxyType, ModuleType
from typing import Any

from frictionlab.laws.base import FrictionLaw, as_written
from frictionlab.laws.faults import LAW_FILE, BrokenPlugin, from_outside
from frictionlab.methods.base import FOR_MEMORY, Method
from frictionlab.study.entry_points import (
    Home,
    check_class,
    describe_clash,
    faults_of_methods,
    home_of,
    is_own,
    open_entry_point,
    unloadable,
)
from frictionlab.values.notes import Unreadable, text_of, unknown_name

_TEXTS: dict[str, str] = {}
"""Text of every law file read, by the name of its module."""


def home_of_file(path: Path) -> Home:
    """Return the origin for errors in a file as a whole."""
    return Home(f"file {path}", "correct the file")


@dataclass(frozen=True)
class LawFile:
    """A file of laws. text: what it holds; laws: its concrete law classes by the names studies give them."""

    path: Path = field(compare=False)
    text: str = field(repr=False)
    laws: dict[str, type[FrictionLaw]] = field(compare=False)

    def home(self, name: str) -> Home:
        """Return the origin of one of its laws."""
        return Home(
            f"law '{name}' (class {self.laws[name].__name__}) of file {self.path}", "correct the file"
        )

    @property
    def code(self) -> str:
        """SHA-256 of the text."""
        return _sha256(self.text)


def read_law_file(path: Path) -> LawFile:
    """Return the laws of this file. Raises Unreadable, BrokenPlugin."""
    if path.suffix != ".py":
        raise Unreadable("must be a Python file, *.py")
    text = text_of(path)
    name = re.sub(r"\W", "_", path.stem)
    module = _module(f"{LAW_FILE}{name}_{_sha256(text)[:12]}", path, text)
    return LawFile(path, text, _laws(module, path))


def law_name(name: str) -> str:
    """Return the law of a class of this name as studies write it: ``MyLaw`` is ``my-law``."""
    parts = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "-", name)
    return parts.replace("_", "-").strip("-").lower()


@cache
def code_of(law: type[FrictionLaw]) -> str:
    """SHA-256 of the Python files of the package of a law, and of what its class holds of the function around it.

    '' for a law of frictionlab.
    """
    code = code_around(law.__module__)
    functions = [one for one in map(as_written, vars(law).values()) if isinstance(one, FunctionType)]
    own = [one for one in functions if one.__module__ == law.__module__]
    held = [cell.cell_contents for one in own for cell in one.__closure__ or ()]
    told = [_told(each) for each in held if each is not law]  # other classes have the same text
    return _sha256(code + repr(told)) if code and told else code


def _told(held: Any) -> Any:
    """A value, or the place and code of a function, whose text is known."""
    function = getattr(held, "py_func", held)
    code = getattr(function, "__code__", None)
    return held if code is None else (function.__qualname__, code.co_firstlineno, code.co_code)


def code_around(module: str) -> str:
    """SHA-256 of the Python files of the package of a module, which is not imported; '' for one of frictionlab."""
    head, _, rest = module.partition(".")
    spec = None if head == "frictionlab" or head in sys.modules else find_spec(head)
    file = spec.origin if spec is not None else getattr(sys.modules.get(head), "__file__", None)
    if head == "frictionlab" or file is None:
        return ""
    files = sorted(Path(file).parent.rglob("*.py")) if rest or Path(file).stem == "__init__" else [Path(file)]
    return _sha256("\0".join(each.read_text(encoding="utf-8", errors="replace") for each in files))


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


@cache
def _module(name: str, path: Path, text: str) -> ModuleType:
    """Return the module of this text, run once. Compiled here: Python's own cache misses an edit within a second."""
    linecache.checkcache(str(path))
    if name in sys.modules:  # the same text from another folder
        return sys.modules[name]
    module = ModuleType(name)
    module.__file__, _TEXTS[name] = str(path), text
    sys.modules[name] = module
    try:
        exec(compile(text, str(path), "exec"), module.__dict__)
    except (Exception, SystemExit) as problem:
        del sys.modules[name]
        raise unloadable(home_of_file(path), problem) from problem
    return module


def _laws(module: ModuleType, path: Path) -> dict[str, type[FrictionLaw]]:
    """Return the laws defined in the module itself, without the base classes of others among them."""
    classes = dict.fromkeys(kind for kind in vars(module).values() if isinstance(kind, type))
    own = [kind for kind in classes if issubclass(kind, FrictionLaw) and kind.__module__ == module.__name__]
    bases = {base for kind in own for base in kind.__mro__[1:]}
    laws: dict[str, type[FrictionLaw]] = {}
    for kind in (kind for kind in own if kind not in bases):
        other = laws.setdefault(law_name(kind.__name__), kind)
        if other is not kind:
            names = f"{other.__name__} and {kind.__name__}"
            raise home_of_file(path).broken(
                f"its classes {names} are both the law '{law_name(kind.__name__)}'; rename one"
            )
    for kind in laws.values():
        copyreg.pickle(kind, _pickled)
    if not laws:
        raise home_of_file(path).broken(
            "defines no law: give it a class derived from frictionlab.SlidingLaw, BristleLaw or MemoryLaw"
        )
    return laws


def _pickled(law: FrictionLaw) -> tuple[Any, ...]:
    """Return what another process makes the law from: the file's text too, as no module of this name is there."""
    module = sys.modules[type(law).__module__]
    return (
        _blank,
        (module.__name__, module.__file__, _TEXTS[module.__name__], type(law).__name__),
        law.__getstate__(),
    )


def _blank(name: str, file: str, text: str, kind: str) -> FrictionLaw:
    """A law of this class without values, for pickle to fill."""
    path = Path(file)
    laws = {law.__name__: law for law in _laws(_module(name, path, text), path).values()}
    return laws[kind].__new__(laws[kind])


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
    """Return the names of every installed law, sorted."""
    return sorted(_entry_points(LAWS))


def method_names() -> list[str]:
    """Return the names of every installed method, sorted."""
    return sorted(_entry_points(METHODS))


def law_class(name: str) -> type[FrictionLaw]:
    """Return the law of this name. Raises KeyError for an unknown name, BrokenPlugin for one that cannot be used."""
    found: type[FrictionLaw] = _load(LAWS, name)
    return found


def method_class(name: str) -> type[Method]:
    """Return the method of this name. Raises KeyError for an unknown name, BrokenPlugin for one that is broken."""
    found: type[Method] = _load(METHODS, name)
    return found


@cache
def method_code(name: str) -> str:
    """SHA-256 of the Python files of the package of a method, which is not loaded; '' for one of frictionlab.

    That of ``auto`` is the code of the method from outside that it may take.
    """
    names = [name, FOR_MEMORY] if name == "auto" else [name]
    return "".join(
        code_around(door.module) for each in names for door in _entry_points(METHODS).get(each, ())
    )


class Laws:
    """Laws a study may name: those of its law files and the installed ones.

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
        """Return the names of laws that are not broken."""
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
        """Return the sentence for a name that no law has, and a suggestion."""
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
        """Law of this name. Raises KeyError for an unknown name, BrokenPlugin for one that cannot be used."""
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
"""Installed laws alone, without those of files."""


@cache
def _entry_points(group: str) -> dict[str, tuple[EntryPoint, ...]]:
    """Return the entry points of each name; duplicates, as from two copies of a package, are merged."""
    found: dict[str, dict[str, EntryPoint]] = {}
    for door in metadata.entry_points(group=group):
        found.setdefault(door.name, {}).setdefault(door.value, door)
    return {name: tuple(doors.values()) for name, doors in found.items()}


@cache
def _load(group: str, name: str) -> Any:
    """Return the class of this name. Raises KeyError, BrokenPlugin."""
    return open_entry_point(_entry_points(group)[name], FrictionLaw if group == LAWS else Method)


_checked = cache(check_class)
