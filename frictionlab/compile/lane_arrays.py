"""Read and write lanes of a row, select between two values lane by lane, call functions lane by lane.

If Python runs a kernel, lanes are numpy arrays of any length; a single number has no dimension.

``friction_by_lane`` computes the friction of a law without memory at several slip speeds at once.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import llvmlite.ir
import numba.core.types
import numba.extending
import numba.np.arrayobj
import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.interpret import interpreted_on_arrays, run_as, run_on_arrays_as
from frictionlab.compile.lanes import (
    LANE_COUNT,
    LANES,
    MASK,
    VECTOR,
    LaneType,
    MaskType,
    Parts,
    put_together,
    taken_apart,
)
from frictionlab.laws.base import FrictionLaw

_ir: Any = llvmlite.ir
_types: Any = numba.core.types  # internals of numba, untyped
_extending: Any = numba.extending
_arrays: Any = numba.np.arrayobj
_config: Any = numba.config

ALIGNED = 8
"""Alignment of arrays of floats [bytes]; numba promises no more."""


def _pointer(context: Any, builder: Any, kind: Any, array: Any) -> Any:
    data = _arrays.make_array(kind)(context, builder, array).data
    return builder.bitcast(data, VECTOR.as_pointer())


def _is_row(kind: Any) -> bool:
    return isinstance(kind, _types.Array) and kind.ndim == 1 and kind.dtype == _types.float64


def _load(typing: Any, row: Any) -> Any:
    if not _is_row(row):
        return None

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        return builder.load(_pointer(context, builder, row, values[0]), align=ALIGNED)

    return LANES(row), code


def _read_row(row: Any) -> Any:
    return row.copy()


def _store(typing: Any, row: Any, lanes: Any) -> Any:
    if not _is_row(row) or lanes != LANES:
        return None

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        builder.store(values[1], _pointer(context, builder, row, values[0]), align=ALIGNED)
        return context.get_dummy_value()

    return _types.none(row, lanes), code


def _write_row(row: Any, lanes: Any) -> None:
    row[:] = lanes


def _choose(typing: Any, mask: Any, first: Any, second: Any) -> Any:
    if mask == _types.boolean:
        kind = typing.unify_types(first, second)

        def of_one(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            cast = [context.cast(builder, values[i], signature.args[i], kind) for i in (1, 2)]
            return builder.select(values[0], *cast)

        return kind(mask, first, second), of_one
    if mask != MASK:
        return None
    planar = any(
        isinstance(kind, _types.Complex) or getattr(kind, "planar", False) for kind in (first, second)
    )

    def of_lanes(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        a, b = (taken_apart(context, builder, signature.args[i], values[i]) for i in (1, 2))
        re = builder.select(values[0], a.re, b.re)
        zero = _ir.Constant(VECTOR, [0.0] * LANE_COUNT)
        im = builder.select(values[0], a.im or zero, b.im or zero) if planar else None
        return put_together(builder, Parts(re, im))

    return (LaneType("PlanarLanes", True) if planar else LANES)(mask, first, second), of_lanes


def _chosen_in_python(mask: bool, first: Any, second: Any) -> Any:
    return first if mask else second


def _any_of_one(mask: bool) -> bool:
    return mask


def _some(typing: Any, mask: Any) -> Any:
    if not isinstance(mask, MaskType):
        return None

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        bits = builder.bitcast(values[0], _ir.IntType(LANE_COUNT))
        return builder.icmp_unsigned("!=", bits, _ir.Constant(_ir.IntType(LANE_COUNT), 0))

    return _types.boolean(mask), code


def _lane(typing: Any, lanes: Any, place: Any) -> Any:
    if lanes not in (LANES, _types.float64):
        return None

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        return builder.extract_element(values[0], values[1]) if lanes == LANES else values[0]

    return _types.float64(lanes, place), code


def _item(lanes: Any, place: int) -> float:
    return lanes if np.ndim(lanes) == 0 else lanes[place]


def _with_lane(typing: Any, lanes: Any, place: Any, number: Any) -> Any:
    if lanes not in (LANES, _types.float64):
        return None

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        return builder.insert_element(values[0], values[2], values[1]) if lanes == LANES else values[2]

    return lanes(lanes, place, _types.float64), code


def _with_item(lanes: Any, place: int, number: float) -> Any:
    if np.ndim(lanes) == 0:
        return number
    changed = lanes.copy()
    changed[place] = number
    return changed


def _least(typing: Any, lanes: Any) -> Any:
    if lanes != LANES:
        return None

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        least = values[0]
        for apart in (1, 2, 4):  # compare neighbouring lanes, then pairs, then fours
            places = [k ^ apart for k in range(LANE_COUNT)]
            order = _ir.Constant(_ir.VectorType(_ir.IntType(32), LANE_COUNT), places)
            other = builder.shuffle_vector(least, least, order)
            least = builder.select(builder.fcmp_ordered("<", other, least), other, least)
        return least

    return LANES(lanes), code


def _least_in_python(lanes: Any) -> Any:
    eights = lanes.reshape(-1, LANE_COUNT).min(axis=1)
    return np.repeat(eights, LANE_COUNT)


def _room_for(typing: Any, count: Any) -> Any:
    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        return context.get_constant(_types.intp, LANE_COUNT)

    return _types.intp(count), code


def _room_in_python(count: int) -> int:
    return -(-count // LANE_COUNT) * LANE_COUNT


def _made(intrinsic: Any, in_python: Any, on_arrays: Any = None) -> Any:
    """Return an intrinsic for which Python runs ``in_python``, and ``on_arrays`` on arrays if it is given."""
    made = in_python if _config.DISABLE_JIT else run_as(_extending.intrinsic(intrinsic), in_python)
    return made if on_arrays is None else run_on_arrays_as(made, on_arrays)


read_lanes = _made(_load, _read_row, _read_row)
"""read_lanes(row): return the lanes in a row of an array."""
write_lanes = _made(_store, _write_row, _write_row)
"""write_lanes(row, lanes): write lanes to a row of an array."""
select = _made(_choose, _chosen_in_python, np.where)
"""select(mask, first, second): return first if the mask is true, else second; of lanes lane by lane."""
any_lane = _made(_some, _any_of_one, np.any)
"""any_lane(mask): check whether a mask is true in any lane."""
lane = _made(_lane, _item, _item)
"""lane(lanes, place): return the number in one lane; a single number as it is."""
with_lane = _made(_with_lane, _with_item, _with_item)
"""with_lane(lanes, place, number): replace the number in one lane; a single number is replaced whole."""
least_of_eight = _made(_least, _least_in_python, _least_in_python)
"""least_of_eight(lanes): write the smallest number of each group of eight neighbouring lanes to all eight."""
room_for = _made(_room_for, _room_in_python)
"""room_for(count): return the number of lanes of one pass over so many numbers.

These are eight in a kernel, and ``count`` rounded up to a multiple of eight in Python."""


PROBES = 1e-12, 1e-3, 0.3, 1.0, 10.0, 3e3
"""Speeds at which a law's source, run on an array, is compared with the law called speed by speed."""


def takes_lanes(law: FrictionLaw) -> bool:
    """Check that friction is along the slip and depends on its speed alone."""
    return law.memory_kind == "none" and type(law).sliding_vector is FrictionLaw.sliding_vector


@inner
def friction_by_lane(law: Any, speeds: Any) -> Any:
    """Compute the friction coefficient at each of these speeds.

    The law is called lane by lane, because laws branch on speed.
    """
    found = speeds
    for k in range(LANE_COUNT):
        found = with_lane(found, k, law.sliding_friction(lane(speeds, k)))
    return found


def _friction_of_array(law: FrictionLaw, speeds: np.ndarray) -> Any:
    text = interpreted_on_arrays(type(law).sliding_friction)
    return text(law, speeds) if _serves(law) else _one_by_one(law, speeds)


run_on_arrays_as(friction_by_lane, _friction_of_array)


def _one_by_one(law: FrictionLaw, speeds: np.ndarray) -> np.ndarray:
    return np.array([law.sliding_friction(speed) for speed in speeds.tolist()])


@lru_cache(maxsize=64)
def _serves(law: FrictionLaw) -> bool:
    """Check that the law's source gives on an array the friction that it gives speed by speed."""
    speeds = np.array(PROBES)
    try:
        found = interpreted_on_arrays(type(law).sliding_friction)(law, speeds)
        return bool(np.allclose(found + 0.0 * speeds, _one_by_one(law, speeds), rtol=1e-13, atol=0.0))
    except (TypeError, ValueError, ArithmeticError, AttributeError, LookupError):  # it takes one number alone
        return False
