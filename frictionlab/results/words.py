"""Values and counts in words, for reading."""

from __future__ import annotations

from frictionlab.quantities import Written


def in_words(value: object) -> str:
    """A number to six digits, one written with a unit as it was; anything else as it is."""
    if isinstance(value, Written):
        return value.text
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def counted(count: int, noun: str) -> str:
    """A count with its noun: ``1 row``, ``3 rows``."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"
