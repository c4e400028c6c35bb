"""Mistakes in what is given, by YAML or in Python: noted by path, located, told with a caret and a suggestion.

Reading of a file of text: a study, a law.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import islice
from numbers import Real
from pathlib import Path
from typing import Any, NamedTuple

from frictionlab.values.printable import one_line, printable

KeyPath = tuple[str | int, ...]

MOST_MISTAKES_SHOWN = 50
_WIDTH = 100
_MOST_SHOWN = 50
_MOST_NAMES = 100
"""Names beyond these are not searched for what was meant."""


class TextPosition(NamedTuple):
    """A position in a text, both counted from 1."""

    line: int
    column: int


@dataclass(frozen=True)
class Note:
    """A mistake by its path, not yet located.

    on_key: the mistake is the key itself, not its value. place: its position, where the path does not determine it.
    origin: the ``--set`` that is the mistake, if not a value.
    """

    path: KeyPath
    what: str
    hint: str = ""
    on_key: bool = False
    place: TextPosition | None = None
    origin: str = ""

    @property
    def settles_its_path(self) -> bool:
        """Check whether no other mistake at the same path needs to be told."""
        return self.place is None and not self.origin


@dataclass(frozen=True)
class Mistake:
    """A located mistake. origin: the file, the ``--set`` or the Python name that has it; place: in a file alone."""

    origin: str
    place: TextPosition | None
    path: str
    what: str
    hint: str = ""
    line: str = ""

    def __str__(self) -> str:
        """Position, mistake, source line with a caret, and a suggestion."""
        origin = one_line(self.origin)
        where = f"{origin}:{self.place.line}:{self.place.column}" if self.place else origin
        said = (where, one_line(self.path), one_line(self.what))
        shown = [": ".join(part for part in said if part)]
        if self.place:
            shown += _with_caret(self.line, self.place.column)
        if self.hint:
            shown.append(f"    {one_line(self.hint)}")
        return "\n".join(shown)


class _Mistaken(Exception):
    """Error of what cannot be used; ``mistakes`` holds every reason."""

    def __init__(self, mistakes: Sequence[Mistake]) -> None:
        self.mistakes = tuple(mistakes)
        super().__init__(self.mistakes)

    def __str__(self) -> str:
        """Return the first mistakes, and how many more there are, as printed by the command line."""
        shown = [str(mistake) for mistake in self.mistakes[:MOST_MISTAKES_SHOWN]]
        if more := len(self.mistakes) - len(shown):
            shown.append(f"and {more} more: correct these first")
        return "\n".join(shown)


class StudyError(_Mistaken):
    """A study that cannot be run; its mistakes are in the order of the file."""


class WrongValues(_Mistaken, ValueError):
    """Values of which no scene, law or method can be made."""


def _with_caret(line: str, column: int) -> list[str]:
    """Return the line, cut to a readable width around the column, and a caret below the column."""
    start = max(0, min(column - 1 - _WIDTH // 2, len(line) - _WIDTH))
    shown = line[start : start + _WIDTH]
    before = "".join("\t" if letter == "\t" else " " for letter in printable(shown[: column - 1 - start]))
    return [f"    {printable(shown)}".rstrip(), f"    {before}^"]


def dotted(path: KeyPath) -> str:
    """A path as text: ``laws[0].mu``."""
    text = ""
    for step in path:
        text += f"[{step}]" if isinstance(step, int) else f".{step}"
    return text.removeprefix(".")


def closest(name: str, among: Iterable[str], missing: Iterable[str] = ()) -> str | None:
    """Return the most similar name, if any is close; else the only name that begins with this one and a unit.

    missing: required names that were not given. One that differs by words at its end is taken first: mu, mu_kinetic.
    """
    names = list(islice(among, _MOST_NAMES))
    if (known := _of_the_literature(name, names)) is not None:
        return known
    for wanted in missing:
        if wanted.startswith(f"{name}_") or name.startswith(f"{wanted}_"):
            return wanted
    found = difflib.get_close_matches(name.lower(), [n.lower() for n in names], n=1, cutoff=0.6)
    begun = [n for n in names if n.lower().startswith(f"{name.lower()}_")]
    return next((n for n in names if found and n.lower() == found[0]), begun[0] if len(begun) == 1 else None)


def _of_the_literature(name: str, among: Sequence[str]) -> str | None:
    """Return the name here of what papers call so, if it is one of these."""
    plain = name.lower().replace("_", "")
    for wanted in (ours for theirs, ours in LITERATURE if plain in theirs.split()):
        exact = [each for each in among if each == wanted]
        begun = [each for each in among if each.startswith(f"{wanted}_")]
        if exact or begun:
            return [*exact, *begun][0]
    return None


LITERATURE = (
    ("sigma0 k0 kb", "stiffness"),
    ("sigma1", "damping"),
    ("sigma2 fv bv", "viscosity"),
    ("mus mustat mubreak fs ts", "mu_static"),
    ("mu muk mud mudyn muc fc fk tc", "mu_kinetic"),
    ("muk mud mudyn muc fc fk tc", "mu"),
    ("vs vstribeck vst stribeckvelocity", "stribeck_speed"),
    ("deltas deltast", "stribeck_exponent"),
    ("kt kcontact", "contact_stiffness"),
    ("ct", "contact_damping"),
    ("zba", "breakaway_ratio"),
    ("hz frequencyhz freqhz freq f omega w", "frequency"),
    ("m", "mass"),
    ("k", "stiffness"),
    ("c d", "damping"),
    ("zeta xi beta", "damping_ratio"),
    ("omega0 omegan f0 fn wn", "natural_frequency"),
    ("n fn load weight preload normalforce", "normal_load"),
    ("v vb v0 velocity speed beltvelocity", "belt_speed"),
    ("g", "gravity"),
    ("amplitude x", "displacement_amplitude"),
    ("step points n count steps", "num"),
    ("from first begin", "start"),
    ("to last end until", "stop"),
    ("si units", "dimensional"),
)
"""Names of papers without underscores, and what they are here; the first that a record has is meant."""


def did_you_mean(name: str, among: Iterable[str], missing: Iterable[str] = ()) -> str:
    """``did you mean 'x'?``, or nothing where no name is close. missing: as for ``closest``."""
    found = closest(name, among, missing)
    return f"did you mean '{found}'?" if found is not None else ""


def unknown_name(
    what: str, given: str, installed: Sequence[str], told: Iterable[str] | None = None
) -> tuple[str, str]:
    """Return the sentence for the name of a law or method that is not installed, and a suggestion.

    told: how the installed ones are listed, where not by all their names.
    """
    listed = ", ".join(installed if told is None else told)
    return f"unknown {what} '{given}'; installed: {listed}", did_you_mean(given, installed)


def number_text(value: float) -> str:
    """A number in the notation of a study: 5, 0.1, 1e-08, .nan."""
    if value != value:
        return ".nan"
    if value in (float("inf"), float("-inf")):
        return ".inf" if value > 0 else "-.inf"
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e16:
        return str(int(value))
    return repr(value)


@dataclass(frozen=True)
class Unfit:
    """A value of which no number can be made, and why."""

    given: Any
    what: str


def value_text(value: Any) -> str:
    """Return the text for a value in ``got ...``; with advice where a text is almost a number."""
    if isinstance(value, Unfit):
        return value_text(value.given)
    if value is None:
        return "null"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (int, float)):  # of one with a unit what was written
        return str(getattr(value, "text", number_text(value)))
    if isinstance(value, str):
        return f"the text {_short(value)!r}{_advice(value)}"
    if isinstance(value, (dict, list, tuple)):
        return "a mapping" if isinstance(value, dict) else "a list"
    return _short(str(value))


class Notation(NamedTuple):
    """Notation of a value in ``got ...``, and of what a part may be given as."""

    text_of: Callable[[Any], str]
    part: str


YAML = Notation(value_text, "a mapping (key: value)")


def python_text(value: Any) -> str:
    """Return the text for a value given in Python."""
    if isinstance(value, Unfit):
        return python_text(value.given)
    if isinstance(value, type):
        return f"the class {value.__name__}"
    shape = getattr(value, "shape", None)
    if isinstance(shape, tuple) and not isinstance(value, Real):  # of numpy, pandas, xarray
        return f"{type(value).__name__} of shape {shape}".replace("ndarray", "an array")
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if isinstance(value, (str, dict, list, tuple)) or (number and math.isfinite(value)):
        return value_text(value)
    return _short(" ".join(repr(value).split()))


PYTHON = Notation(python_text, "{0}(...) or a mapping")


def _short(text: str, most: int = 40) -> str:
    return text if len(text) <= most else f"{text[: most - 3]}..."


def _advice(text: str) -> str:
    for candidate, advice in ((text, "remove the quotes"), (text.replace(",", "."), "use a decimal point")):
        try:
            value = float(candidate)
        except ValueError:
            continue
        return f" ({advice})" if abs(value) < float("inf") else ""
    return ""


OTHER_WORDS = {
    "period": ("frequency", "frequency is 2 pi over the period; with a unit, such as Hz, one over it"),
    "contact_viscosity": (
        "viscosity",
        "viscosity is per unit of normal load: divide by the load, which gives s/m",
    ),
}
"""Words that people write for a number that is given another way: the key of that, and how."""


class Notes:
    """Mistakes by path; of several at the same path only the first is kept."""

    def __init__(self, notes: Iterable[Note] = (), notation: Notation | None = None) -> None:
        self.all: list[Note] = list(notes)
        self.notation = notation or YAML
        self._settled: set[KeyPath] = {note.path for note in self.all if note.settles_its_path}
        self._misspelt: set[KeyPath] = set()
        self._above: set[KeyPath] = set()
        for path in self._settled:
            self._mark(path)

    def _mark(self, path: KeyPath) -> None:
        """Remember that this path and those above it have a mistake."""
        self._above.update(path[:length] for length in range(len(path) + 1))

    def add(self, path: KeyPath, what: str, hint: str = "", on_key: bool = False) -> None:
        """A mistake in the value at this path, or in its key."""
        if path not in self._settled:
            self._settled.add(path)
            self._mark(path)
            self.all.append(Note(path, what, hint, on_key))

    def on_key(self, path: KeyPath, what: str, hint: str = "") -> None:
        """A mistake in the key itself."""
        self.add(path, what, hint, on_key=True)

    def unknown_key(
        self,
        path: KeyPath,
        allowed: Iterable[str],
        given: Iterable[str] = (),
        required: Iterable[str] = (),
        in_units: Iterable[str] = (),
    ) -> None:
        """An unknown key beside those given; one of the others is more likely to be meant.

        in_units: keys that are allowed too, of the same numbers without a unit behind them.
        """
        if path not in self._misspelt:
            self._misspelt.add(path)
            self._mark(path)
            told, longer = list(allowed), list(in_units)
            names = [*told, *longer]
            left = [name for name in names if name not in (*given,)]
            missing = [name for name in required if name in left]
            key, instead = OTHER_WORDS.get(str(path[-1]), ("", ""))
            hint = instead if key in names else did_you_mean(str(path[-1]), left, missing)
            hint = hint or did_you_mean(str(path[-1]), names)
            if not hint and str(path[-1]).isdecimal():  # 0,4 in braces is 0, and a key 4
                hint = f"numbers are written with a point, such as 0.{path[-1]}"
            what = f"unknown key; allowed: {', '.join(told) or 'none'}"
            what += f"; of a number without a unit its key has one, such as {longer[0]}" if longer else ""
            self.all.append(Note(path, what, hint, on_key=True))

    def below(self, path: KeyPath) -> bool:
        """Check whether a mistake is noted at this path or under it."""
        return path in self._above

    def mapping(
        self, value: Any, path: KeyPath, allowed: Iterable[str] | None = None
    ) -> dict[str, Any] | None:
        """Return the value if it is a mapping, unknown keys noted; None, noted, if it is not."""
        if not isinstance(value, dict):
            self.add(path, f"must be {YAML.part}, got {value_text(value)}")
            return None
        for key in value if allowed is not None else ():
            if key not in (names := list(allowed or ())):
                self.unknown_key((*path, key), names)
        return value

    def head(self, tree: dict[str, Any], required: Iterable[str], schema: int) -> None:
        """Note the required keys that a file lacks, and a schema that is not this one."""
        for key in required:
            if key not in tree:
                hint = f"write schema: {schema}" if key == "schema" else ""
                self.add((key,), "required key is missing", hint)
        given = tree.get("schema", schema)
        if isinstance(given, bool) or given != schema:
            self.add(("schema",), f"must be {schema}, got {value_text(given)}")

    def number(self, value: Any, path: KeyPath) -> float | None:
        """Return the value as a finite number; None, noted, if it is not one."""
        if isinstance(value, Unfit):
            got = f", got {value_text(value)}" if value.what.startswith("must be ") else ""
            self.add(path, f"{value.what}{got}")
        elif isinstance(value, bool) or not isinstance(value, (int, float)):
            self.add(path, f"must be a number, got {value_text(value)}")
        elif not math.isfinite(value):
            self.add(path, f"must be a finite number, got {value_text(value)}")
        else:
            return value if isinstance(value, float) else float(value)  # one with a unit keeps it
        return None

    def positive(self, value: Any, path: KeyPath) -> float | None:
        """Return the value as a finite number; None where it is none, and noted, too, where it is not > 0."""
        number = self.number(value, path)
        if number is not None and number <= 0.0:
            self.add(path, f"must be > 0, got {value_text(value)}")
        return number

    def text(self, value: Any, path: KeyPath) -> str:
        """Return the value as text; empty, noted, if it is not text."""
        if isinstance(value, str):
            return value
        kind = "" if isinstance(value, (dict, list)) or value is None else " (put it in quotes)"
        self.add(path, f"must be text, got {value_text(value)}{kind}")
        return ""

    def one_of(self, value: Any, path: KeyPath, names: Iterable[str], meaning: str = "") -> str | None:
        """Value if it is one of these names; None, noted, if it is not. meaning: what the names stand for."""
        allowed = list(names)
        if isinstance(value, str) and value in allowed:
            return value
        hint = did_you_mean(value, allowed) if isinstance(value, str) else ""
        shown = [*allowed[:_MOST_SHOWN], *(["..."] if len(allowed) > _MOST_SHOWN else [])]
        self.add(path, f"must be one of {', '.join(shown)}; got {value_text(value)}", hint or meaning)
        return None


class Unreadable(Exception):
    """A file that cannot be read as text; the message says why."""


def text_of(path: Path) -> str:
    """Return the text of a file. Raises Unreadable."""
    try:
        return path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise Unreadable("no such file") from None
    except IsADirectoryError:
        raise Unreadable("is a folder") from None
    except UnicodeDecodeError as problem:
        raise Unreadable(f"is not UTF-8 text (byte {problem.start + 1}); save it as UTF-8") from None
    except (OSError, ValueError) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else str(problem)
        raise Unreadable(f"cannot be read: {reason}") from None
