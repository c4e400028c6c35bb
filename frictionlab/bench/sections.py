"""What a bench list measures: curves and other sections, each with a table, a picture and a summary."""

from __future__ import annotations

import csv
import math
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, NamedTuple, Protocol


class BenchPicture(NamedTuple):
    """A chart, written as SVG and PNG under this stem; the caption is one sentence on how to read it."""

    file_stem: str
    caption: str


class SectionResult(ABC):
    """What a section came to."""

    kind: ClassVar[str] = "section"
    style: ClassVar[Mapping[str, Any]] = {}
    """Of its figure, beside that of all."""
    name: str
    title: str

    @property
    def caption(self) -> str:
        """How to read its figure."""
        return ""

    @property
    def notes(self) -> list[str]:
        """Sentences below its title."""
        return []

    @property
    def left_out(self) -> Mapping[str, str]:
        """What is not installed, with how to install it."""
        return {}

    @abstractmethod
    def records(self) -> Sequence[Mapping[str, Any]]:
        """The rows of its CSV file."""

    @abstractmethod
    def figure(self) -> Any:
        """Its chart, a figure of matplotlib; None where there is nothing to draw."""

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

    def draw(self, folder: Path) -> list[BenchPicture]:
        """The chart, written as SVG and PNG. Raises OSError."""
        from frictionlab.bench.drawing import save_in_style

        drawn = save_in_style(self.figure, self.style, folder, file_stem(self.name))
        return [BenchPicture(file_stem(self.name), self.caption)] if drawn else []


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
