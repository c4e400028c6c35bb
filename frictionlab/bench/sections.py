"""What a bench list measures: curves and other sections, each with a table and a summary."""

from __future__ import annotations

import csv
import math
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, ClassVar, Protocol

from pydantic import BeforeValidator, Field

AtLeastOne = Annotated[int, Field(strict=True, ge=1)]
FILLED: Any = Field(min_length=1)


def one_of(known: Mapping[str, Any]) -> BeforeValidator:
    """Reads a name in a list as what it stands for."""

    def named(name: Any) -> Any:
        if not isinstance(name, str) or name not in known:
            raise ValueError(f"must be one of {', '.join(map(repr, known))}")
        return known[name]

    return BeforeValidator(named)


class SectionResult(ABC):
    """What a section came to.

    caption: how to read its figure; style: of that, beside the style of all. left_out: what is not installed, with
    how to install it.
    """

    kind: ClassVar[str] = "section"
    style: ClassVar[Mapping[str, Any]] = {}
    name: str
    title: str
    caption: str
    left_out: Mapping[str, str] | None = None

    @property
    def notes(self) -> list[str]:
        """Sentences below its title."""
        return []

    @abstractmethod
    def records(self) -> Sequence[Mapping[str, Any]]:
        """The rows of its CSV file."""

    @abstractmethod
    def summary(self) -> str:
        """What stdout prints."""

    def write(self, folder: Path) -> list[Path]:
        """The CSV table, written where there are rows; the folder is there. Raises OSError."""
        path, records = folder / f"{file_stem(self.name)}.csv", self.records()
        if not records:
            return []
        with path.open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, list(records[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(records)
        return [path]


class Section(Protocol):
    """One part of a bench list, measured as a whole: what is finished when the user interrupts is kept."""

    @property
    def name(self) -> str:
        """Names its files and answers ``--only``."""

    def measure(self, tell: Callable[[str], None]) -> SectionResult:
        """Measure it, telling what is under way."""


def file_stem(name: str) -> str:
    """A name as a file may have it: runs of all but letters, digits, points, - and _ become one _.

    >>> file_stem("W4 soft lugre")
    'W4_soft_lugre'
    """
    return re.sub(r"[^\w.-]+", "_", name)


def cell(value: float) -> float | str:
    """A number as a CSV file holds it: empty where there is none."""
    return value if math.isfinite(value) else ""
