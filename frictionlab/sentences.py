"""Sentences that differ in their numbers alone say the same thing, and are told once."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

_NUMBER = re.compile(r"[-+]?\d+(?:\.\d*)?(?:e[-+]?\d+)?", re.IGNORECASE)


def pattern(sentence: Any) -> str:
    """A sentence without its numbers; nothing for what is no sentence."""
    return _NUMBER.sub("#", sentence) if isinstance(sentence, str) else ""


def alike(sentences: Iterable[str]) -> str:
    """The first of sentences that differ in their numbers at most, and how many others there are."""
    first, *others = dict.fromkeys(sentences)
    return f"{first} (and {len(others)} more that differ in the numbers)" if others else first
