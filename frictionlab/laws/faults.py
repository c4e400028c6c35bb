"""Errors in laws and methods of other packages: the file, the line and the source line that caused them."""

from __future__ import annotations

import linecache
import re
import sys
import sysconfig
import traceback
from collections.abc import Collection, Iterator
from pathlib import PurePath
from types import CodeType

from frictionlab.laws.base import FrictionLaw

LAW_FILE = "frictionlab_law_"
"""Beginning of the module name of a law from a file; the name of the file follows."""
_PACKAGE = __file__[: -len("laws/faults.py")]
MARK = "broken plugin: "
"""Beginning of the reason of a point that failed in a law of another package."""
INTERNAL = "internal error: "
"""Beginning of the reason of a point that failed by a defect of the program."""
LONGEST_TEXT = 500
"""Number of characters of a foreign message that are shown."""


class BrokenPlugin(Exception):
    """Error of a law or method of another package that cannot be used; it names law and remedy."""


class CannotCompile(Exception):
    """Error of a law that runs as Python but that numba cannot compile; it names law, line and remedy."""


def from_outside(law: type) -> bool:
    """Check whether a class is defined outside the package frictionlab."""
    return law.__module__.partition(".")[0] != "frictionlab"


def files_of(law: type) -> set[str]:
    """Return the source files of a law of another package and of its base classes outside frictionlab."""
    modules = {
        kind.__module__ for kind in law.__mro__ if issubclass(kind, FrictionLaw) and from_outside(kind)
    }
    files = (getattr(sys.modules.get(name), "__file__", None) for name in modules)
    return {file for file in files if file is not None}


def describe_error(problem: BaseException, files: Collection[str], asked: bool = False) -> str:
    """Return type and message of an error, and the innermost line of these files in its traceback.

    asked: whether the call of the function of that line is told.
    """
    if isinstance(problem, SyntaxError) and problem.filename:
        return f"SyntaxError: {problem.msg}{source_line(problem.filename, problem.lineno or 1)}"
    name, numbers = call_of(problem, files) if asked else ("", {})
    told = ", ".join(f"{each}={value:g}" for each, value in numbers.items())
    call = f" in {name}({told})" if told else ""
    return f"{text_of_error(problem)}{call}{innermost_line(problem, files) or ''}"


def call_of(problem: BaseException, files: Collection[str]) -> tuple[str, dict[str, complex]]:
    """Return the function of these files that raised an error, and the numbers it was called with, by name."""
    frames = [
        each for each, _ in traceback.walk_tb(problem.__traceback__) if each.f_code.co_filename in files
    ]
    if not frames:
        return "", {}
    code, held = frames[-1].f_code, frames[-1].f_locals
    given = {name: held.get(name) for name in code.co_varnames[: code.co_argcount]}
    return code.co_name, {name: value for name, value in given.items() if isinstance(value, float | complex)}


def text_of_error(problem: BaseException) -> str:
    """Return type and message of an error."""
    text = re.sub(r"\s*For further information visit \S+$", "", str(problem))  # pydantic's
    return _cut(f"{type(problem).__name__}: {text}" if text else type(problem).__name__)


def shown(value: object) -> str:
    """Return a value as Python writes it."""
    return _cut(repr(value))


def _cut(text: str) -> str:
    return text if len(text) <= LONGEST_TEXT else f"{text[:LONGEST_TEXT]}..."


def innermost_line(problem: BaseException, files: Collection[str]) -> str | None:
    """Return the innermost line of these files in an error's traceback, as ``source_line``; None if none."""
    frames = [frame for frame in traceback.extract_tb(problem.__traceback__) if frame.filename in files]
    return source_line(frames[-1].filename, frames[-1].lineno or 1) if frames else None


def source_line(file: str, line: int) -> str:
    """Return file, line number and text of a source line, indented on a line of its own below a message."""
    return f"\n  {file}:{line}: {_cut(linecache.getline(file, line).strip())}"


def definition_line(code: CodeType) -> str:
    """Return the line of a function's ``def``, below its decorators, as ``source_line``."""
    lines = range(code.co_firstlineno, code.co_firstlineno + 20)
    found = (line for line in lines if "def " in linecache.getline(code.co_filename, line))
    return source_line(code.co_filename, next(found, code.co_firstlineno))


def cannot_compile(law: type[FrictionLaw], message: str) -> CannotCompile:
    """Return the error for a law that numba rejects, with numba's reason and the law's line it is about."""
    spots = [spot for spot in _LOCATION.finditer(message) if _own_file(spot["file"], law)]
    spot = spots[0] if spots else None
    where = source_line(_own_file(spot["file"], law), int(spot["line"] or spot["number"])) if spot else ""
    why = _numba_reason(message[: spot.start()], law) if spot else message.strip().partition("\n")[0]
    return CannotCompile(
        f"law {law.__name__} ({home_of_law(law)}) cannot be compiled by numba: {why}{where}\n{_REMEDY}"
    )


_LOCATION = re.compile(
    r'(?:File "|at |from )(?P<file>[^"\n()]+?\.py)(?:", line (?P<line>\d+)| \((?P<number>\d+)\))'
)
_REMEDY = (
    "In its methods use only float and complex arithmetic, the math module and plain functions of these; make any "
    "number that a method needs beside its arguments a parameter or a property of the law."
)


def _numba_reason(before: str, law: type[FrictionLaw]) -> str:
    """Return the sentence before the line in numba's message; reworded if it would not help the author."""
    lines = [line.strip() for line in before.splitlines() if line.strip()]
    text = re.sub(r"(, defined|Raised)$", "", lines[-1] if lines else "").strip()
    unknown = re.match(r"Unknown attribute '(\w+)' of type Numbers", text)
    if unknown and callable(getattr(law, unknown[1], None)):
        return f"a method cannot call the law's own method '{unknown[1]}': make that a function of the module"
    if unknown:
        return f"the law has no parameter or property '{unknown[1]}' that is a number"
    return "numba does not support this line" if text.startswith(("During:", "^")) else text


def home_of_law(law: type[FrictionLaw]) -> str:
    """Return the module of a law, or its file if a study names the law by file."""
    return law.__module__ if not law.__module__.startswith(LAW_FILE) else ", ".join(sorted(files_of(law)))


def _own_file(file: str, law: type[FrictionLaw]) -> str:
    """Return the law's file of this name, '' if none: numba gives paths relative to the current directory."""
    name = re.split(r"[\\/]", file)[-1]
    return next((own for own in files_of(law) if re.split(r"[\\/]", own)[-1] == name), "")


def failing_law(problem: BaseException) -> str | None:
    """Return a sentence naming the law of another package whose lines raised an error; None if none did."""
    for law in _laws(FrictionLaw):  # type: ignore[type-abstract]  # only subclasses are read
        files = files_of(law)
        if innermost_line(problem, files):
            return f"a law of {', '.join(sorted(files))} fails: {describe_error(problem, files)}\ncorrect that line"
    return None


def lost_error(law: FrictionLaw) -> str | None:
    """Return, as ``failing_law``, the error that sliding friction raises at some slip speed of 1e-6 to 1e6.

    Machine code loses such an error.
    """
    for speed in (10.0 ** (tenth / 10.0) for tenth in range(-60, 61)):
        try:
            law.sliding_friction(speed)
        except Exception as problem:
            return failing_law(problem)
    return None


def outside_files(problem: BaseException) -> set[str]:
    """Return the files in an error's traceback without those of frictionlab, pydantic and Python itself."""
    names = {frame.filename for frame in traceback.extract_tb(problem.__traceback__)}
    return {name for name in names if not name.startswith(("<", _PACKAGE)) and not _is_pythons(name)}


def _is_pythons(file: str) -> bool:
    parts = PurePath(file).parts
    own = "site-packages" not in parts and file.startswith(sysconfig.get_path("stdlib"))
    return own or "pydantic" in parts


def _laws(kind: type[FrictionLaw]) -> Iterator[type[FrictionLaw]]:
    for law in kind.__subclasses__():
        yield law
        yield from _laws(law)
