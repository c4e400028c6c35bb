"""The sweep of a study: dotted paths and the values each runs over."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

from frictionlab.study.mistakes import Path, described, number_text
from frictionlab.study.notes import Notes

LARGEST_GRID = 1_000_000

_KEYS = ("start", "stop", "num", "spacing")
_SPACINGS = ("linear", "log")


def sweep_values(given: Any, path: Path, notes: Notes) -> tuple[float, ...]:
    """The values of one sweep, from a list or a range; empty, noted, where there is a mistake."""
    if isinstance(given, list):
        return _listed(given, path, notes)
    if isinstance(given, dict):
        return _ranged(given, path, notes)
    notes.add(path, f"must be a list or {{start, stop, num, spacing}}, got {described(given)}")
    return ()


def _listed(given: list[Any], path: Path, notes: Notes) -> tuple[float, ...]:
    if not given:
        notes.add(path, "the list is empty: there is nothing to run")
    values = [notes.number(item, (*path, index)) for index, item in enumerate(given)]
    seen: dict[float, int] = {}
    for index, value in enumerate(values):
        if value is not None and seen.setdefault(value, index) != index:
            notes.add((*path, index), f"{number_text(value)} is in the list twice")
    return tuple(value for value in values if value is not None)


def _ranged(given: dict[str, Any], path: Path, notes: Notes) -> tuple[float, ...]:
    notes.mapping(given, path, _KEYS)
    for key in ("start", "stop", "num"):
        if key not in given:
            notes.add((*path, key), "required key is missing")
    ends = [notes.number(given[key], (*path, key)) if key in given else None for key in ("start", "stop")]
    start, stop = ends
    num = notes.whole_number(given["num"], (*path, "num"), 2) if "num" in given else None
    spacing = notes.one_of(given.get("spacing", "linear"), (*path, "spacing"), _SPACINGS)
    if start is not None and spacing == "log" and start <= 0:
        notes.add((*path, "start"), f"must be > 0 for log spacing, got {number_text(start)}")
    if start is not None and stop is not None and stop <= start:
        notes.add((*path, "stop"), f"must be > start = {number_text(start)}, got {number_text(stop)}")
    if num is not None and num > LARGEST_GRID:
        notes.add((*path, "num"), f"must be <= {LARGEST_GRID}, got {num}")
    if notes.below(path) or start is None or stop is None or num is None:
        return ()
    values = _log(start, stop, num) if spacing == "log" else _linear(start, stop, num)
    if len(set(values)) < num:
        notes.add(path, f"there are no {num} different numbers between start and stop")
    return values


def _linear(start: float, stop: float, num: int) -> tuple[float, ...]:
    """Evenly spaced and correctly rounded: {0.1, 1, 10} holds 0.3, not 0.30000000000000004."""
    first, last = Fraction(repr(start)), Fraction(repr(stop))
    step = (last - first) / (num - 1)
    return tuple(float(first + index * step) for index in range(num))


def _log(start: float, stop: float, num: int) -> tuple[float, ...]:
    """Evenly spaced in the logarithm, both ends exact."""
    low, high = math.log(start), math.log(stop)
    inner = (math.exp(low + (high - low) * index / (num - 1)) for index in range(1, num - 1))
    return (start, *inner, stop)
