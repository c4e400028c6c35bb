"""A study as one would type it in Python."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from frictionlab.mistakes.as_typed import typed
from frictionlab.study.grid import StudyGrid
from frictionlab.study.reader import DEFAULT_TOLERANCE


def study_as_typed(study: StudyGrid, told: Mapping[str, Any]) -> str:
    """What one would type to make a study again, but for long lists, of which the ends are shown.

    told: its entries as in a study file.
    """
    laws = _as_given({choice.label: (choice.kind, choice.law()) for choice in study.laws})
    methods = _as_given(
        {one.label: (one.name, one.method if one.parameters else one.name) for one in study.methods}
    )
    parts = [repr(study.scene), laws, *([] if methods == "'auto'" else [f"methods={methods}"])]
    usual = {*_OBJECTS, *(["tolerance"] if told["tolerance"] == DEFAULT_TOLERANCE else [])}
    parts += [f"{key}={_typed(value)}" for key, value in told.items() if key not in usual]
    return f"Study.of({', '.join(parts)})"


_OBJECTS = {"schema", "scene", "plugins", "laws", "methods"}
_MOST_TYPED = 8
"""Values of a list that are shown."""


def _as_given(named: Mapping[str, tuple[str, Any]]) -> str:
    """One as it is, several as a list, those with a label of their own by it."""
    if any(label != kind for label, (kind, _) in named.items()):
        return repr({label: each for label, (_, each) in named.items()})
    each = [one for _, one in named.values()]
    return repr(each[0] if len(each) == 1 else each)


def _typed(value: Any) -> str:
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{key!r}: {_typed(item)}' for key, item in value.items())}}}"
    if isinstance(value, list):
        shown = [_typed(item) for item in value]
        return f"[{', '.join([*shown[:2], '...', shown[-1]] if len(shown) > _MOST_TYPED else shown)}]"
    return typed(value)
