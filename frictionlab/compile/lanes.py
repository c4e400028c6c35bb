"""Eight numbers that are computed with as one: values of kernels that hold one vector of the processor.

``Lanes`` is a vector of floats, ``PlanarLanes`` two of them, x1 + i x2, and ``Mask`` a vector of truths. Arithmetic,
comparisons, ``min``, ``max``, ``math.sqrt``, ``.real``, ``.imag``, ``.conjugate()`` are those of floats and complex
numbers, lane by lane, and mix with these: the text of a kernel for one belt speed serves eight. There is no ``if``
on a mask. What makes such values, and takes them apart, is in lane_arrays.py.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any, NamedTuple

import llvmlite.ir
import numba.core.cgutils
import numba.core.datamodel
import numba.core.types
import numba.core.typing.templates
import numba.extending

_ir: Any = llvmlite.ir
_cgutils: Any = numba.core.cgutils  # internals of numba, untyped
_types: Any = numba.core.types
_templates: Any = numba.core.typing.templates
_models: Any = numba.core.datamodel.models
_extending: Any = numba.extending

LANE_COUNT = 8
"""Lanes: a vector of AVX-512, two of AVX. Sixteen waste on short curves what they gain on long ones."""

VECTOR = _ir.VectorType(_ir.DoubleType(), LANE_COUNT)
TRUTHS = _ir.VectorType(_ir.IntType(1), LANE_COUNT)


class LaneType(_types.Type):  # type: ignore[misc]  # numba has no types
    """numba's type of numbers in lanes; planar: of x1 + i x2."""

    def __init__(self, name: str, planar: bool) -> None:
        self.planar = planar
        super().__init__(name)


class MaskType(_types.Type):  # type: ignore[misc]  # the same
    """numba's type of truths in lanes."""


LANES, PLANAR_LANES, MASK = LaneType("Lanes", False), LaneType("PlanarLanes", True), MaskType("Mask")


@_extending.register_model(LaneType)
class _LaneModel(_models.PrimitiveModel):  # type: ignore[misc]  # the same
    """A vector; in the plane one after another, along and across."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _ir.LiteralStructType([VECTOR, VECTOR]) if kind.planar else VECTOR)


@_extending.register_model(MaskType)
class _MaskModel(_models.PrimitiveModel):  # type: ignore[misc]  # the same
    """A vector of bits."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, TRUTHS)


class Parts(NamedTuple):
    """A number in lanes while code is made: its vectors along x1 and across; across is None for real numbers."""

    re: Any
    im: Any


# --- values as parts, and back --------------------------------------------------------------------------------------


def spread(builder: Any, number: Any) -> Any:
    """Return the vector with one float in every lane."""
    place = _ir.Constant(_ir.IntType(32), 0)
    first = builder.insert_element(_ir.Constant(VECTOR, _ir.Undefined), number, place)
    zeros = _ir.Constant(_ir.VectorType(_ir.IntType(32), LANE_COUNT), [0] * LANE_COUNT)
    return builder.shuffle_vector(first, _ir.Constant(VECTOR, _ir.Undefined), zeros)


def taken_apart(context: Any, builder: Any, kind: Any, value: Any) -> Parts:
    """Return the parts of a value of any kind of number."""
    if isinstance(kind, LaneType):
        if not kind.planar:
            return Parts(value, None)
        return Parts(builder.extract_value(value, 0), builder.extract_value(value, 1))
    if isinstance(kind, _types.Complex):
        pair = context.make_complex(builder, kind, value)
        return Parts(spread(builder, pair.real), spread(builder, pair.imag))
    return Parts(spread(builder, context.cast(builder, value, kind, _types.float64)), None)


def put_together(builder: Any, parts: Parts) -> Any:
    """Return the value with these parts."""
    if parts.im is None:
        return parts.re
    pair = _ir.Constant(_ir.LiteralStructType([VECTOR, VECTOR]), _ir.Undefined)
    return builder.insert_value(builder.insert_value(pair, parts.re, 0), parts.im, 1)


# --- what operators do ----------------------------------------------------------------------------------------------

Rule = Callable[[Any, Parts, Parts], Parts]


def _sum(builder: Any, a: Parts, b: Parts) -> Parts:
    im = builder.fadd(a.im, b.im) if a.im and b.im else a.im or b.im
    return Parts(builder.fadd(a.re, b.re), im)


def _difference(builder: Any, a: Parts, b: Parts) -> Parts:
    if b.im is None:
        return Parts(builder.fsub(a.re, b.re), a.im)
    return Parts(builder.fsub(a.re, b.re), builder.fsub(a.im, b.im) if a.im else builder.fneg(b.im))


def _product(builder: Any, a: Parts, b: Parts) -> Parts:
    if a.im is None and b.im is None:
        return Parts(builder.fmul(a.re, b.re), None)
    if a.im is None:
        return Parts(builder.fmul(a.re, b.re), builder.fmul(a.re, b.im))
    if b.im is None:
        return Parts(builder.fmul(a.re, b.re), builder.fmul(a.im, b.re))
    re = builder.fsub(builder.fmul(a.re, b.re), builder.fmul(a.im, b.im))
    return Parts(re, builder.fadd(builder.fmul(a.re, b.im), builder.fmul(a.im, b.re)))


def _quotient(builder: Any, a: Parts, b: Parts) -> Parts:
    if b.im is None:
        return Parts(builder.fdiv(a.re, b.re), builder.fdiv(a.im, b.re) if a.im else None)
    square = _sum(builder, Parts(builder.fmul(b.re, b.re), None), Parts(builder.fmul(b.im, b.im), None))
    conjugate = Parts(b.re, builder.fneg(b.im))
    return _quotient(builder, _product(builder, a, conjugate), square)


RULES: dict[Any, Rule] = {
    operator.add: _sum,
    operator.sub: _difference,
    operator.mul: _product,
    operator.truediv: _quotient,
}
COMPARISONS = {
    operator.lt: "<",
    operator.le: "<=",
    operator.gt: ">",
    operator.ge: ">=",
    operator.eq: "==",
    operator.ne: "!=",
}


def _is_number(kind: Any) -> bool:
    return isinstance(kind, LaneType | _types.Float | _types.Integer | _types.Complex)


def _in_lanes(kinds: Any) -> bool:
    return any(isinstance(kind, LaneType) for kind in kinds) and all(map(_is_number, kinds))


def _is_planar(kind: Any) -> bool:
    return kind.planar if isinstance(kind, LaneType) else isinstance(kind, _types.Complex)


def _define(function: Any, result_of: Callable[[Any], Any], code: Any) -> None:
    """A function of two numbers of which one at least is in lanes; result_of: its type, None where there is none."""

    @_templates.infer_global(function)
    class _Defined(_templates.AbstractTemplate):  # type: ignore[misc]  # the same
        def generic(self, kinds: Any, _keywords: Any) -> Any:
            result = result_of(kinds) if len(kinds) == 2 and _in_lanes(kinds) else None
            return None if result is None else _templates.signature(result, *kinds)

    for kinds in ((LaneType, LaneType), (LaneType, _types.Number), (_types.Number, LaneType)):
        _extending.lower_builtin(function, *kinds)(code)


def _define_operator(function: Any, rule: Rule) -> None:
    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        parts = [taken_apart(context, builder, *each) for each in zip(signature.args, values, strict=True)]
        return put_together(builder, rule(builder, *parts))

    _define(function, lambda kinds: PLANAR_LANES if any(map(_is_planar, kinds)) else LANES, code)


def _real_parts(context: Any, builder: Any, signature: Any, values: Any) -> list[Any]:
    return [taken_apart(context, builder, *each).re for each in zip(signature.args, values, strict=True)]


def _define_comparison(function: Any, sign: str) -> None:
    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        # as of floats: nothing compares with what is not a number, but that it differs from all
        compare = builder.fcmp_unordered if sign == "!=" else builder.fcmp_ordered
        return compare(sign, *_real_parts(context, builder, signature, values))

    _define(function, lambda kinds: None if any(map(_is_planar, kinds)) else MASK, code)


def _define_extreme(function: Any, sign: str) -> None:
    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        a, b = _real_parts(context, builder, signature, values)
        return builder.select(builder.fcmp_ordered(sign, b, a), b, a)  # as Python's: the first unless beaten

    _define(function, lambda kinds: None if any(map(_is_planar, kinds)) else LANES, code)


def _define_connective(function: Any, method: str) -> None:
    @_templates.infer_global(function)
    class _Connective(_templates.AbstractTemplate):  # type: ignore[misc]  # the same
        def generic(self, kinds: Any, _keywords: Any) -> Any:
            return _templates.signature(MASK, *kinds) if kinds == (MASK, MASK) else None

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        return getattr(builder, method)(*values)

    _extending.lower_builtin(function, MaskType, MaskType)(code)


for _function, _rule in RULES.items():
    _define_operator(_function, _rule)
for _function, _sign in COMPARISONS.items():
    _define_comparison(_function, _sign)
for _function, _sign in ((min, "<"), (max, ">")):
    _define_extreme(_function, _sign)
for _function, _method in ((operator.and_, "and_"), (operator.or_, "or_")):
    _define_connective(_function, _method)


# --- of one number --------------------------------------------------------------------------------------------------


@_templates.infer_global(operator.neg)
class _Negation(_templates.AbstractTemplate):  # type: ignore[misc]  # the same
    def generic(self, kinds: Any, _keywords: Any) -> Any:
        return _templates.signature(kinds[0], *kinds) if isinstance(kinds[0], LaneType) else None


def _negative(context: Any, builder: Any, signature: Any, values: Any) -> Any:
    parts = taken_apart(context, builder, signature.args[0], values[0])
    return put_together(builder, Parts(builder.fneg(parts.re), parts.im and builder.fneg(parts.im)))


_extending.lower_builtin(operator.neg, LaneType)(_negative)


@_templates.infer_global(math.sqrt)
class _Root(_templates.AbstractTemplate):  # type: ignore[misc]  # the same
    def generic(self, kinds: Any, _keywords: Any) -> Any:
        return _templates.signature(LANES, LANES) if kinds == (LANES,) else None


def _square_root(context: Any, builder: Any, signature: Any, values: Any) -> Any:
    kind = _ir.FunctionType(VECTOR, [VECTOR])
    root = _cgutils.get_or_insert_function(builder.module, kind, f"llvm.sqrt.v{LANE_COUNT}f64")
    return builder.call(root, values)


_extending.lower_builtin(math.sqrt, LaneType)(_square_root)


@_templates.infer_global(complex)
class _Joined(_templates.AbstractTemplate):  # type: ignore[misc]  # the same
    def generic(self, kinds: Any, _keywords: Any) -> Any:
        return _templates.signature(PLANAR_LANES, LANES, LANES) if kinds == (LANES, LANES) else None


def _joined(context: Any, builder: Any, signature: Any, values: Any) -> Any:
    return put_together(builder, Parts(*values))


_extending.lower_builtin(complex, LaneType, LaneType)(_joined)


@_templates.infer_getattr
class _LaneAttributes(_templates.AttributeTemplate):  # type: ignore[misc]  # the same
    key = LaneType

    def resolve_real(self, kind: Any) -> Any:
        return LANES

    def resolve_imag(self, kind: Any) -> Any:
        return LANES if kind.planar else None

    def _conjugate_of(self, kind: Any, _values: Any, _keywords: Any) -> Any:
        return _templates.signature(kind)

    resolve_conjugate = _templates.bound_function("lanes.conjugate")(_conjugate_of)


def _real_part(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    return taken_apart(context, builder, kind, value).re


_extending.lower_getattr(LaneType, "real")(_real_part)


def _imaginary_part(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    return taken_apart(context, builder, kind, value).im


_extending.lower_getattr(LaneType, "imag")(_imaginary_part)


def _conjugate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
    parts = taken_apart(context, builder, signature.return_type, values[0])
    return put_together(builder, Parts(parts.re, parts.im and builder.fneg(parts.im)))


_extending.lower_builtin("lanes.conjugate", LaneType)(_conjugate)
