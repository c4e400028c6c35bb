"""What a bench list measures beside curves: sections, each with tables, pictures and a summary of its own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path as FilePath
from typing import Any, NamedTuple, Protocol

from frictionlab.mistakes.notes import Notes, Path
from frictionlab.study import Study


class BenchPicture(NamedTuple):
    """A chart, written as SVG and PNG under this stem; the caption is one sentence on how to read it."""

    file_stem: str
    caption: str


class SectionResult(Protocol):
    """What a section came to."""

    @property
    def name(self) -> str:
        """That of its section."""

    @property
    def title(self) -> str:
        """What was measured."""

    def write(self, folder: FilePath) -> list[FilePath]:
        """The CSV tables, written; the folder is there. Raises OSError."""

    def draw(self, folder: FilePath) -> list[BenchPicture]:
        """The charts, written as SVG and PNG. Raises OSError."""

    def summary(self) -> str:
        """What stdout prints."""


class Section(Protocol):
    """One part of a bench list, measured as a whole: what is finished when the user interrupts is kept."""

    @property
    def name(self) -> str:
        """Names its files and answers ``--only``."""

    def measure(self, tell: Callable[[str], None]) -> SectionResult:
        """Measure it, telling what is under way."""


class SectionSource(NamedTuple):
    """The value of a section's key in a bench list, where it stands, and who is told of mistakes.

    study: the scene, laws and sweep of a block as a study; None, noted, where there is a mistake.
    """

    value: Any
    path: Path
    notes: Notes
    study: Callable[[dict[str, Any], Path], Study | None]


SectionReader = Callable[[SectionSource], tuple[Section, ...]]
"""The sections of a key; empty, noted, where there is a mistake."""
