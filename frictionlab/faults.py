"""Whose fault an error is: the author's own file, line and source line, where code from outside is to blame."""

from __future__ import annotations

import linecache
import re
import sys
import traceback
from collections.abc import Collection, Iterator
from types import CodeType

from frictionlab.laws.base import FrictionLaw

LAW_FILE = "frictionlab_law_"
"""How the module of a law from a file is called, before the file's name."""
_HOUSE = __file__.removesuffix("faults.py")
MARK = "broken plugin: "
"""How the reason of a point begins that a law from outside has spoilt."""


class BrokenPlugin(Exception):
    """A law or method from outside that cannot be used; the message names it and says what to do."""


class CannotCompile(Exception):
    """A law that runs interpreted but not compiled; the message names the law, the line and the remedy."""


def from_outside(law: type) -> bool:
    """Whether a class is no part of frictionlab."""
    return law.__module__.partition(".")[0] != "frictionlab"


def files_of(law: type) -> set[str]:
    """The files in which a law from outside, and what it is derived from, are written."""
    modules = {
        kind.__module__ for kind in law.__mro__ if issubclass(kind, FrictionLaw) and from_outside(kind)
    }
    files = (getattr(sys.modules.get(name), "__file__", None) for name in modules)
    return {file for file in files if file is not None}


def in_words(problem: BaseException, files: Collection[str]) -> str:
    """An error by its kind and message, and the innermost line of these files that it went through."""
    if isinstance(problem, SyntaxError) and problem.filename:
        return f"SyntaxError: {problem.msg}{shown(problem.filename, problem.lineno or 1)}"
    text = f"{type(problem).__name__}: {problem}" if str(problem) else type(problem).__name__
    return text + (place_in(problem, files) or "")


def place_in(problem: BaseException, files: Collection[str]) -> str | None:
    """The innermost line of these files that an error went through, as ``shown``; None for none."""
    frames = [frame for frame in traceback.extract_tb(problem.__traceback__) if frame.filename in files]
    return shown(frames[-1].filename, frames[-1].lineno or 1) if frames else None


def shown(file: str, line: int) -> str:
    """A line of a file, below what is said of it: where it is, and what it says."""
    return f"\n  {file}:{line}: {linecache.getline(file, line).strip()}"


def first_line(code: CodeType) -> str:
    """Where a function begins, as ``shown``; at its ``def`` where decorators stand before it."""
    lines = range(code.co_firstlineno, code.co_firstlineno + 20)
    found = (line for line in lines if "def " in linecache.getline(code.co_filename, line))
    return shown(code.co_filename, next(found, code.co_firstlineno))


def cannot_compile(law: type[FrictionLaw], said: str) -> CannotCompile:
    """What numba said of a law, in a line; and the author's own line that it said it of."""
    spots = [spot for spot in _SPOT.finditer(said) if _own(spot["file"], law)]
    where = shown(_own(spots[0]["file"], law), int(spots[0]["line"] or spots[0]["number"])) if spots else ""
    why = _why(said[: spots[0].start()], law) if spots else said.strip().partition("\n")[0]
    return CannotCompile(
        f"law {law.__name__} ({home_of_law(law)}) cannot be compiled by numba: {why}{where}\n{_REMEDY}"
    )


_SPOT = re.compile(
    r'(?:File "|at |from )(?P<file>[^"\n()]+?\.py)(?:", line (?P<line>\d+)| \((?P<number>\d+)\))'
)
_REMEDY = (
    "Use only float and complex arithmetic and the math module in its methods, and plain functions of such; "
    "what a method needs beside its arguments is a parameter or a property of the law."
)


def _why(before: str, law: type[FrictionLaw]) -> str:
    """The sentence that numba says before it names a line; in other words where those would not help."""
    lines = [line.strip() for line in before.splitlines() if line.strip()]
    said = re.sub(r"(, defined|Raised)$", "", lines[-1] if lines else "").strip()
    unknown = re.match(r"Unknown attribute '(\w+)' of type Numbers", said)
    if unknown and callable(getattr(law, unknown[1], None)):
        return f"a method cannot call the law's own method '{unknown[1]}': make that a function of the module"
    if unknown:
        return f"the law has no parameter or property '{unknown[1]}' that is a number"
    return "it cannot tell what this line means" if said.startswith(("During:", "^")) else said


def home_of_law(law: type[FrictionLaw]) -> str:
    """The module of a law, as its author knows it: one that a study brings along has but a file."""
    return law.__module__ if not law.__module__.startswith(LAW_FILE) else ", ".join(sorted(files_of(law)))


def _own(file: str, law: type[FrictionLaw]) -> str:
    """The law's file that numba means, which tells paths from where the command runs; nothing for another's."""
    name = re.split(r"[\\/]", file)[-1]
    return next((own for own in files_of(law) if re.split(r"[\\/]", own)[-1] == name), "")


def blamed(problem: BaseException) -> str | None:
    """The law from outside whose lines an error went through last, and what went wrong there; None for none."""
    for law in _laws(FrictionLaw):  # type: ignore[type-abstract]  # its concrete ones are met
        files = files_of(law)
        if place_in(problem, files):
            return f"a law of {', '.join(sorted(files))} fails: {in_words(problem, files)}\nmend that line"
    return None


def outside_files(problem: BaseException) -> set[str]:
    """The files an error went through that are neither frictionlab's nor Python's machinery of imports."""
    names = {frame.filename for frame in traceback.extract_tb(problem.__traceback__)}
    return {name for name in names if not name.startswith(("<", _HOUSE)) and "importlib" not in name}


def _laws(kind: type[FrictionLaw]) -> Iterator[type[FrictionLaw]]:
    for law in kind.__subclasses__():
        yield law
        yield from _laws(law)
