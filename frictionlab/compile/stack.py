"""Small arrays on the stack, sized while compiling by how many numbers a law remembers.

A loop over a length known to the compiler is unrolled, an array on the stack costs no allocation, and one source
serves every count: for one deflection a step takes a quarter of the time it takes with lengths known at run time.
"""

from __future__ import annotations

from typing import Any

import numba.core.cgutils
import numba.core.types
import numba.extending
import numba.np.arrayobj
import numpy as np

from frictionlab.compile.dispatch import law_of_numbers
from frictionlab.compile.interpret import run_as
from frictionlab.laws.memory import MemoryLaw

_cgutils: Any = numba.core.cgutils  # internals of numba, untyped
_types: Any = numba.core.types
_extending: Any = numba.extending
_config: Any = numba.config
_arrays: Any = numba.np.arrayobj


def count_known(numbers: Any) -> int:
    """Return the count of a law as the compiler knows it, from numba's type of the law's numbers."""
    law, structure, _ = law_of_numbers[numbers.instance_class]
    if not issubclass(law, MemoryLaw):
        return int(law.memory_kind != "none")
    return next(int(word.split()[0]) for word in structure if word.endswith("numbers"))


def count_of(law: Any) -> int:
    """Return how many numbers a law remembers: a constant to the compiler."""
    return int(law.count())


def _count(law: Any) -> Any:
    known = count_known(law)
    return lambda law: known


_extending.overload(
    count_of, jit_options={"no_cpython_wrapper": True, "no_cfunc_wrapper": True}, strict=False
)(_count)


def _room(typing: Any, law: Any, each: Any, more: Any, item: Any) -> Any:
    """room(law, each, more, item): zeros, ``each`` for every number the law remembers and ``more``, all like item.

    A bare pointer, to be indexed from 0: it has no length and no owner, and no references are counted, which in an
    array of numba's takes most of the time of a step. It lives as long as the function that asks for it: hand it
    down, never return it. ``each`` and ``more`` are written as numbers.
    """
    if not isinstance(each, _types.IntegerLiteral) or not isinstance(more, _types.IntegerLiteral):
        return None
    number = _types.complex128 if isinstance(item, _types.Complex) else _types.float64
    count = count_known(law)

    def codegen(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        value = context.get_value_type(number)
        size = context.get_constant(_types.intp, max(1, each.literal_value * count + more.literal_value))
        place = _cgutils.alloca_once(builder, value, size=size, name="room")
        bytes_ = builder.mul(size, context.get_constant(_types.intp, context.get_abi_sizeof(value)))
        _cgutils.memset(builder, place, bytes_, 0)
        return place

    return _types.CPointer(number)(law, each, more, item), codegen


def _interpreted_room(law: Any, each: int, more: int, item: Any) -> Any:
    """Return the same where Python runs the kernels."""
    return np.zeros(max(1, each * count_of(law) + more), complex if isinstance(item, complex) else float)


room: Any = _interpreted_room
if not _config.DISABLE_JIT:
    room = run_as(_extending.intrinsic(prefer_literal=True)(_room), _interpreted_room)
"""room(law, each, more, item): see ``_room``."""


def _items(typing: Any, array: Any) -> Any:
    """items_of(array): a bare pointer to the items of a one-dimensional array, which must outlive it.

    numba lets go of an array after its last use by name: use it once more where the pointer is needed no longer.
    """
    if not isinstance(array, _types.Array) or array.ndim != 1:
        return None

    def codegen(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return _arrays.make_array(array)(context, builder, arguments[0]).data

    return _types.CPointer(array.dtype)(array), codegen


def _interpreted_items(array: Any) -> Any:
    return array


items_of: Any = _interpreted_items
if not _config.DISABLE_JIT:
    items_of = run_as(_extending.intrinsic(_items), _interpreted_items)
"""items_of(array): see ``_items``."""
