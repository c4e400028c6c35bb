"""Values and counts in words, for reading."""

from __future__ import annotations


def in_words(value: object) -> str:
    """A number to six digits; anything else as it is."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def counted(count: int, noun: str) -> str:
    """A count with its noun: ``1 row``, ``3 rows``."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"
