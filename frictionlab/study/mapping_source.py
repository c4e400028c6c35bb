"""Reading of a Python mapping to the plain values that YAML text gives."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from frictionlab.mistakes.notes import Note, StudyError
from frictionlab.study.yaml_source import (
    DEEPEST,
    LARGEST_YAML_FILE,
    TOO_DEEP,
    Source,
    UnsupportedValue,
    plain_number,
)

MOST_VALUES = 300_000
"""Values of a mapping: as a study file they can still be read."""


def read_mapping(mapping: Mapping[str, Any], name: str) -> Source:
    """The values of a mapping. Raises StudyError for one that no study file can hold."""
    source = Source(name)
    source.tree = _ValueReader(source).value(mapping, 0)
    return source


class _ValueReader:
    """One pass over nested values; counts them and their letters."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._values = 0
        self._letters = 0

    def value(self, value: Any, depth: int) -> Any:
        """The value in the types that YAML text gives."""
        self._count(value, depth)
        if isinstance(value, Mapping):
            return {str(key): self.value(item, depth + 1) for key, item in value.items()}
        if hasattr(value, "tolist"):  # of numpy and pandas
            return self.value(value.tolist(), depth)
        if isinstance(value, (list, tuple, range)):
            return [self.value(item, depth + 1) for item in value]
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            return plain_number(value)
        known = value is None or isinstance(value, (str, bool))
        return value if known else UnsupportedValue(f"a {type(value).__name__}")

    def _count(self, value: Any, depth: int) -> None:
        size = value.size if hasattr(value, "tolist") else 0  # before its numbers become objects
        self._values += 1
        self._letters += len(value) if isinstance(value, str) else 0
        if depth > DEEPEST:
            raise self._refused(TOO_DEEP)
        if self._values + size > MOST_VALUES:
            raise self._refused(
                f"has more than {MOST_VALUES} values; write those of a sweep as {{start, stop, num}}"
            )
        if self._letters > LARGEST_YAML_FILE:
            raise self._refused(f"holds more than {LARGEST_YAML_FILE} letters")

    def _refused(self, what: str) -> StudyError:
        return StudyError(self._source.located([Note((), what)]))
