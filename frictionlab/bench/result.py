"""Results of a bench: the table of a section, what is said of it and how it is drawn."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import pandas as pd

Tell = Callable[[str], None]
"""Says what is measured now."""


@dataclass(frozen=True)
class SectionResult:
    """A section that was measured.

    caption: how to read its figure, which is None where there is nothing to draw; style: of that, beside the style of
    all. kind: ``curve`` or ``section``. notes: sentences below its title. left_out: what is not installed, with how
    to install it.
    """

    name: str
    title: str
    table: pd.DataFrame
    summary: str
    figure: Callable[[], Any]
    caption: str
    kind: str = "section"
    notes: Sequence[str] = ()
    left_out: Mapping[str, str] = field(default_factory=dict)
    style: Mapping[str, Any] = field(default_factory=dict)


class Section(Protocol):
    """Part of a bench list, measured as a whole: what is finished when the user interrupts is kept."""

    @property
    def name(self) -> str:
        """Names its files and answers ``--only``."""

    def measure(self, tell: Tell) -> SectionResult:
        """Measure it, telling what is under way."""


def nothing_measured(name: str, title: str, why: str) -> SectionResult:
    """Return the result of a section of a solver that is left out."""
    return SectionResult(
        name, title, pd.DataFrame(), f"{name}: {why}", lambda: None, "", left_out={name: why}
    )


def file_stem(name: str) -> str:
    """A name as a file may have it: runs of all but letters, digits, points, - and _ become one _.

    >>> file_stem("W4 soft lugre")
    'W4_soft_lugre'
    """
    return re.sub(r"[^\w.-]+", "_", name)


def left_out_line(missing: Mapping[str, str]) -> str:
    """Tell in a line which peers are not installed, from the remedies by their labels."""
    return f"Peers left out: {', '.join(missing)} ({'; '.join(dict.fromkeys(missing.values()))})."
