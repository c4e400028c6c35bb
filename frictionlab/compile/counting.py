"""Users of arrays are counted in records that hold arrays alone.

numba looks for arrays in every number of every record each time that one is given a name or let go: of a record of
thirty numbers that is half of the text it hands to LLVM, which then drops it.
"""

from __future__ import annotations

from typing import Any

import numba.core.runtime.context

_Context: Any = numba.core.runtime.context.NRTContext  # internals of numba, untyped
_holds: dict[Any, bool] = {}
"""Of numba's types of values: whether there is an array inside."""


def _arrays_in(context: Any, builder: Any, kind: Any, value: Any) -> list[Any]:
    """The type and the address of what counts the users of each array inside a value."""
    models = context._context.data_model_manager
    model = models[kind]
    found = [(kind, model.get_nrt_meminfo(builder, value))] if model.has_nrt_meminfo() else []
    for inside, part in model.traverse(builder) if _hold_arrays(models, kind) else ():
        if _hold_arrays(models, inside):
            found += _arrays_in(context, builder, inside, part(value))
    return found


def _hold_arrays(models: Any, kind: Any) -> bool:
    if kind not in _holds:
        _holds[kind] = models[kind].contains_nrt_meminfo()
    return _holds[kind]


def count_in_arrays_alone() -> None:
    """From now on."""
    _Context.get_meminfos = _arrays_in
