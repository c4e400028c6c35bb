"""The label of a law: the name of its rows in a table, beside its parameters and no part of its physics."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

from frictionlab.quantities import Record

_LABEL = "_label"
"""Where a law holds it: no field and no private attribute of pydantic, so that equal laws are equal and every law is
made as it was."""


class Labelled(Record):
    """A record that may have a ``label``, one line of text, beside its values. Raises ValueError for another."""

    if TYPE_CHECKING:  # type checkers take the signature from the fields
        label: str = ""
    else:

        def __init__(self, /, *without_names: Any, label: str = "", **values: Any) -> None:
            super().__init__(*without_names, **values)
            if not isinstance(label, str) or not label.isprintable() or (label and not label.strip()):
                name = type(self).__name__
                raise ValueError(f"{name}: label must be one line of visible text, got {label!r}")
            vars(self)[_LABEL] = label

        _own, _values = inspect.signature(Record.__init__).parameters.values()
        _label_of = inspect.Parameter("label", inspect.Parameter.KEYWORD_ONLY, default="", annotation=str)
        __init__.__signature__ = inspect.Signature([_own, _label_of, _values])
        __init__.__pydantic_base_init__ = True  # as for Record
        del _own, _label_of, _values

        @property
        def label(self) -> str:
            """The name of its rows; '' where none was given: its registered name then."""
            return vars(self).get(_LABEL, "")

    def __repr_args__(self) -> Any:
        """The values, and the label where there is one."""
        yield from super().__repr_args__()
        if self.label:
            yield "label", self.label
