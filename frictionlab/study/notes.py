"""The mistakes found so far, one per place: what is wrong twice over is told once."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from frictionlab.study.mistakes import Note, Path, described, did_you_mean


class Notes:
    """Collects mistakes; a second one at the same path is left out, for the first one is what to mend."""

    def __init__(self, notes: Iterable[Note] = ()) -> None:
        self.all: list[Note] = list(notes)
        self._settled: set[Path] = {note.path for note in self.all if note.place is None}
        self._misspelt: set[Path] = set()

    def add(self, path: Path, what: str, hint: str = "") -> None:
        """A mistake in the value at this path."""
        if path not in self._settled:
            self._settled.add(path)
            self.all.append(Note(path, what, hint))

    def unknown_key(self, path: Path, allowed: Iterable[str]) -> None:
        """A key nobody knows."""
        if path not in self._misspelt:
            self._misspelt.add(path)
            names = list(allowed)
            hint = did_you_mean(str(path[-1]), names)
            what = f"unknown key; allowed: {', '.join(names) or 'none'}"
            self.all.append(Note(path, what, hint, on_key=True))

    def on_key(self, path: Path, what: str, hint: str = "") -> None:
        """A mistake in the key itself."""
        if path not in self._settled:
            self._settled.add(path)
            self.all.append(Note(path, what, hint, on_key=True))

    def below(self, path: Path) -> bool:
        """Whether a mistake is noted at this path or under it."""
        return any(noted[: len(path)] == path for noted in self._settled | self._misspelt)

    def mapping(self, value: Any, path: Path, allowed: Iterable[str] | None = None) -> dict[str, Any] | None:
        """The value if it is a mapping, unknown keys noted; None, noted, if it is not."""
        if not isinstance(value, dict):
            self.add(path, f"must be a mapping (key: value), got {described(value)}")
            return None
        for key in value if allowed is not None else ():
            if key not in (names := list(allowed or ())):
                self.unknown_key((*path, key), names)
        return value

    def number(self, value: Any, path: Path) -> float | None:
        """The value as a finite number; None, noted, if it is not one."""
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            self.add(path, f"must be a number, got {described(value)}")
        elif not math.isfinite(value):
            self.add(path, f"must be a finite number, got {described(value)}")
        else:
            return float(value)
        return None

    def whole_number(self, value: Any, path: Path, least: int) -> int | None:
        """The value as a whole number of at least ``least``; None, noted, if it is not one."""
        if isinstance(value, bool) or not isinstance(value, int):
            self.add(path, f"must be a whole number >= {least}, got {described(value)}")
        elif value < least:
            self.add(path, f"must be >= {least}, got {value}")
        else:
            return value
        return None

    def text(self, value: Any, path: Path) -> str:
        """The value as text; empty, noted, if it is not text."""
        if isinstance(value, str):
            return value
        kind = "" if isinstance(value, (dict, list)) or value is None else " (put it in quotes)"
        self.add(path, f"must be text, got {described(value)}{kind}")
        return ""

    def one_of(self, value: Any, path: Path, names: Iterable[str]) -> str | None:
        """The value if it is one of these names; None, noted, if it is not."""
        allowed = list(names)
        if isinstance(value, str) and value in allowed:
            return value
        hint = did_you_mean(value, allowed) if isinstance(value, str) else ""
        self.add(path, f"must be one of {', '.join(allowed)}; got {described(value)}", hint)
        return None
