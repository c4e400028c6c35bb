"""Values and counts in words, for reading.

Sentences of methods, which know nondimensional scenes alone, with their lengths and speeds in SI units.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from frictionlab.values.quantities import Written
from frictionlab.values.units import handy_unit


def in_words(value: object) -> str:
    """A number to six digits, one written with a unit as it was; anything else as it is."""
    if isinstance(value, Written):
        return value.text
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def counted(count: int, noun: str) -> str:
    """A count with its noun: ``1 row``, ``3 rows``."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


_NUMBER = r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.])(?! [µmnkM]?m\b)"
TOLD: dict[str, tuple[str, str]] = {
    "up to (NUMBER) apart": ("length", "m"),
    "it is at x = (NUMBER) ": ("length", "m"),
    "with velocity (NUMBER)": ("velocity", "m/s"),
    "end of reversal, (NUMBER)": ("velocity", "m/s"),
    "highest belt speed that has a number, (NUMBER)": ("velocity", "m/s"),
    "ends at belt speed (NUMBER)": ("velocity", "m/s"),
    "between belt speeds (NUMBER) and": ("velocity", "m/s"),
    "between belt speeds .* and (NUMBER)": ("velocity", "m/s"),
    "; none at (NUMBER)": ("velocity", "m/s"),
    "at slip speed (NUMBER)": ("velocity", "m/s"),
}
"""Numbers with a dimension in sentences: their scale and SI unit."""
_PATTERNS = {re.compile(words.replace("NUMBER", _NUMBER)): scale for words, scale in TOLD.items()}


def in_si_words(sentence: str, scales: Mapping[str, float]) -> str:
    """Return the sentence with its lengths and speeds in SI units; as it is without scales."""
    for pattern, (scale, unit) in _PATTERNS.items():
        if scale in scales and (found := pattern.search(sentence)):
            value = float(found[1]) * scales[scale]
            shown = handy_unit(unit, abs(value))  # sentences have six digits, of which scaling leaves five
            told = f"{value / shown.size:.5g} {shown.unit}"
            sentence = f"{sentence[: found.start(1)]}{told}{sentence[found.end(1) :]}"
    return sentence


def column_in_si_words(column: Any, scales: Mapping[str, Any]) -> Any:
    """Return the same of a column of sentences, by columns of scales."""
    if not scales:
        return column
    used = [name for name in ("length", "velocity") if name in scales]
    units = list(zip(*(np.broadcast_to(scales[name], len(column)).tolist() for name in used), strict=True))
    known: dict[Any, str] = {}  # rows of a curve share most sentences and their scales
    for pair in zip(column, units, strict=True):
        if isinstance(pair[0], str) and pair not in known:
            known[pair] = in_si_words(pair[0], dict(zip(used, pair[1], strict=True)))
    return [known.get(pair, pair[0]) for pair in zip(column, units, strict=True)]
