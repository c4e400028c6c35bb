"""Laws from one Python file: read, imported as a module, its law classes by name."""

from __future__ import annotations

import copyreg
import hashlib
import linecache
import re
import sys
from dataclasses import dataclass, field
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import Any

from frictionlab.faults import LAW_FILE
from frictionlab.laws.base import FrictionLaw
from frictionlab.mistakes.text_file import Unreadable, text_of
from frictionlab.registry.entry_points import Home, unloadable

_TEXTS: dict[str, str] = {}
"""The text of every law file read, by the name of its module."""


def home_of_file(path: Path) -> Home:
    """The origin for errors in a file as a whole."""
    return Home(f"file {path}", "correct the file")


@dataclass(frozen=True)
class LawFile:
    """A file of laws. text: what it holds; laws: its concrete law classes by the names studies give them."""

    path: Path = field(compare=False)
    text: str = field(repr=False)
    laws: dict[str, type[FrictionLaw]] = field(compare=False)

    def home(self, name: str) -> Home:
        """The origin of one of its laws."""
        return Home(
            f"law '{name}' (class {self.laws[name].__name__}) of file {self.path}", "correct the file"
        )

    @property
    def code(self) -> str:
        """SHA-256 of the text."""
        return _sha256(self.text)


def read_law_file(path: Path) -> LawFile:
    """The laws of this file. Raises Unreadable, BrokenPlugin."""
    if path.suffix != ".py":
        raise Unreadable("must be a Python file, *.py")
    text = text_of(path)
    name = re.sub(r"\W", "_", path.stem)
    module = _module(f"{LAW_FILE}{name}_{_sha256(text)[:12]}", path, text)
    return LawFile(path, text, _laws(module, path))


def law_name(name: str) -> str:
    """The law of a class of this name as studies write it: ``MyLaw`` is ``my-law``."""
    parts = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "-", name)
    return parts.replace("_", "-").strip("-").lower()


@cache
def code_of(law: type[FrictionLaw]) -> str:
    """SHA-256 of the Python files of the package of a law; '' for a law of frictionlab."""
    return code_around(law.__module__)


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
    """The module of this text, run once. Compiled here: Python's own cache misses an edit within a second."""
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
    """The laws defined in the module itself, without the base classes of others among them."""
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
    """What another process makes the law from: the file's text is in it, since no module of this name is there."""
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
