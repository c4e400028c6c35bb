"""Reading of a Python mapping to the plain values that YAML text gives."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from frictionlab.study.yaml_source import TOO_DEEP, Source, UnsupportedValue, plain_number, unreadable


def read_mapping(mapping: Mapping[str, Any], name: str) -> Source:
    """The values of a mapping. Raises StudyError for one that no study file can hold."""
    source = Source(name)
    try:
        source.tree = _plain(mapping)
    except RecursionError:
        raise unreadable(source, TOO_DEEP) from None
    return source


def _plain(value: Any) -> Any:
    """The value in the types that YAML text gives."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if hasattr(value, "tolist"):  # of numpy and pandas
        return _plain(value.tolist())
    if isinstance(value, (list, tuple, range)):
        return [_plain(item) for item in value]
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return plain_number(value)
    known = value is None or isinstance(value, (str, bool))
    return value if known else UnsupportedValue(f"a {type(value).__name__}")
