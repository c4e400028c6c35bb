"""Compiled functions called where they lie: a kernel compiled once serves all functions of one interface.

A thing, such as the numbers of a law, is written to a place in memory. An entry gives that place and the addresses
of functions whose first argument is the thing; kernels that are handed these call the functions there, whatever the
thing is. Addresses belong to one process; the code behind them is kept with the entry that gives them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import llvmlite.ir
import numba
import numba.core.cgutils
import numba.core.types
import numba.extending
import numba.np.arrayobj

from frictionlab.compile.decorators import INNER
from frictionlab.compile.interpret import interpreted, run_as

_ir: Any = llvmlite.ir
_cgutils: Any = numba.core.cgutils  # internals of numba, untyped
_types: Any = numba.core.types
_extending: Any = numba.extending
_arrays: Any = numba.np.arrayobj
_config: Any = numba.config

NUMBER, VECTOR, INDEX, TRUTH = _types.float64, _types.complex128, _types.int64, _types.boolean
NUMBERS, VECTORS = _types.CPointer(NUMBER), _types.CPointer(VECTOR)
"""Types that functions take and return: on the line a number, in the plane a vector; pointers to several of them."""
_BYTES = _ir.IntType(8).as_pointer()
_ADDRESS = _ir.IntType(64)


def _intrinsic(body: Any, in_python: Any = None) -> Any:
    """An intrinsic of numba; in_python: what Python runs in its place."""
    if _config.DISABLE_JIT:
        return in_python
    made = _extending.intrinsic(body)
    return made if in_python is None else run_as(made, in_python)


# --- a thing and its place ------------------------------------------------------------------------------------------


def _written_to(typing: Any, thing: Any, room: Any) -> Any:
    def codegen(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        data = _arrays.make_array(room)(context, builder, given[1]).data
        written = _unowned(context, builder, thing, given[0])
        builder.store(written, builder.bitcast(data, context.get_value_type(thing).as_pointer()))
        return builder.ptrtoint(data, _ADDRESS)

    return INDEX(thing, room), codegen


def _unowned(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    """Value, its arrays without the count of their users: numba drops that when the call ends, arrays stay."""
    if isinstance(kind, _types.Array):
        array = _arrays.make_array(kind)(context, builder, value)
        array.meminfo = _cgutils.get_null_value(array.meminfo.type)
        array.parent = _cgutils.get_null_value(array.parent.type)
        return array._getvalue()
    if isinstance(kind, _types.BaseTuple):
        parts = zip(kind.types, _cgutils.unpack_tuple(builder, value), strict=True)
        return context.make_tuple(builder, kind, [_unowned(context, builder, *part) for part in parts])
    return value


def _bytes_of(typing: Any, thing: Any) -> Any:
    def codegen(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        return context.get_constant(INDEX, context.get_abi_sizeof(context.get_value_type(thing)))

    return INDEX(thing), codegen


written_to = _intrinsic(_written_to, lambda thing, room: thing)
"""written_to(thing, room): write a thing to an array of bytes; where that lies. Its arrays have to outlive it."""
bytes_of = _intrinsic(_bytes_of, lambda thing: 0)
"""bytes_of(thing): how many bytes it takes."""


# --- functions and their addresses ----------------------------------------------------------------------------------


def machine_type(value: Any) -> Any:
    """numba's type of what is like this value."""
    return numba.typeof(value)  # type: ignore[no-untyped-call]  # numba has no types


class Interface(NamedTuple):
    """numba's types of what a function takes beside its thing, and of what it returns."""

    takes: tuple[Any, ...]
    returns: Any


class Addressed(NamedTuple):
    """A function ``body(thing, *arguments)``, and its interface; of_type: whether the body is one of several.

    It is then a function from numba's type of the thing to the text.
    """

    body: Any
    interface: Interface
    of_type: bool = False

    def compiled(self, thing: Any) -> Any:
        """For a thing of this type."""
        body = self.body(thing) if self.of_type else getattr(self.body, "py_func", self.body)
        found, given = numba.njit(**INNER)(body), (thing, *self.interface.takes)
        found.compile(given)
        return found.overloads[given]


def addresses_of(functions: Sequence[Addressed]) -> Any:
    """An intrinsic ``addresses(thing)``: of these functions compiled for such a thing.

    An error of a function is lost, and its result is then not a number.
    """

    def addresses(typing: Any, thing: Any) -> Any:
        compiled = [each.compiled(thing) for each in functions]

        def codegen(context: Any, builder: Any, signature: Any, _values: Any) -> Any:
            context.add_linking_libs([each.library for each in compiled])
            made = [
                builder.ptrtoint(_unpacking(context, builder, each, function.interface.returns), _ADDRESS)
                for each, function in zip(compiled, functions, strict=True)
            ]
            return context.make_tuple(builder, signature.return_type, made)

        return _types.UniTuple(INDEX, len(functions))(thing), codegen

    return _intrinsic(addresses, lambda thing: tuple(interpreted(each.body) for each in functions))


def _unpacking(context: Any, builder: Any, compiled: Any, returns: Any) -> Any:
    """A function of the machine that takes the arguments and the place of the thing, and calls a compiled one."""
    thing, *takes = compiled.signature.args
    name = f"{builder.function.name}.{compiled.fndesc.mangled_name}.at"
    function = _ir.Function(builder.module, _shape(context, Interface(tuple(takes), returns)), name=name)
    function.linkage = "internal"
    function.attributes.add("nounwind")
    inside = _ir.IRBuilder(function.append_basic_block("entry"))
    held = inside.load(inside.bitcast(function.args[-1], context.get_value_type(thing).as_pointer()))
    status, value = context.call_internal_no_propagate(
        inside, compiled.fndesc, compiled.signature, [held, *function.args[:-1]]
    )
    value = context.cast(inside, value, compiled.signature.return_type, returns)
    inside.ret(inside.select(status.is_ok, value, _no_result(context, returns)))
    return function


def _shape(context: Any, interface: Interface) -> Any:
    """Return the machine's signature: the arguments, then the place of the thing."""
    kinds = [context.get_value_type(kind) for kind in interface.takes]
    return _ir.FunctionType(context.get_value_type(interface.returns), [*kinds, _BYTES])


def _no_result(context: Any, returns: Any) -> Any:
    """NaN, or zeros of what is no number."""
    nan = _ir.Constant(_ir.DoubleType(), float("nan"))
    if returns == NUMBER:
        return nan
    if returns == VECTOR:
        return _ir.Constant.literal_struct([nan, nan])
    return _ir.Constant(context.get_value_type(returns), None)


# --- calls at an address --------------------------------------------------------------------------------------------


def call_at(interface: Interface) -> Any:
    """An intrinsic ``call(address, place, arguments)``: what the function at the address returns."""

    def call(typing: Any, address: Any, place: Any, arguments: Any) -> Any:
        def codegen(context: Any, builder: Any, signature: Any, given: Any) -> Any:
            values = _as_taken(context, builder, interface, arguments, given[2])
            return _called(context, builder, interface, given[0], given[1], values)

        return interface.returns(address, place, arguments), codegen

    return _intrinsic(call, lambda address, place, arguments: address(place, *arguments))


def call_on_line_or_plane(line: Interface, plane: Interface) -> Any:
    """An intrinsic ``call(on_the_line, in_the_plane, place, arguments)`` of the function at one of two addresses.

    In the plane where one of the arguments is planar. line, plane: the interfaces.
    """

    def call(typing: Any, on_the_line: Any, in_the_plane: Any, place: Any, arguments: Any) -> Any:
        planar = any(getattr(kind, "dtype", kind) == VECTOR for kind in arguments)
        interface = plane if planar else line

        def codegen(context: Any, builder: Any, signature: Any, given: Any) -> Any:
            values = _as_taken(context, builder, interface, arguments, given[3])
            return _called(context, builder, interface, given[1 if planar else 0], given[2], values)

        return interface.returns(on_the_line, in_the_plane, place, arguments), codegen

    return _intrinsic(call)


def _called(context: Any, builder: Any, interface: Interface, address: Any, place: Any, values: Any) -> Any:
    function = builder.inttoptr(address, _shape(context, interface).as_pointer())
    made = builder.call(function, [*values, builder.inttoptr(place, _BYTES)])
    made.attributes.add("nounwind")
    return made


def _as_taken(context: Any, builder: Any, interface: Interface, kinds: Any, given: Any) -> list[Any]:
    """Return the values of a tuple as a function takes them; of an array its items, where it takes a pointer."""
    values = []
    for value, kind, taken in zip(_cgutils.unpack_tuple(builder, given), kinds, interface.takes, strict=True):
        if isinstance(kind, _types.Array) and isinstance(taken, _types.CPointer):
            values.append(_arrays.make_array(kind)(context, builder, value).data)
        else:
            values.append(context.cast(builder, value, kind, taken))
    return values
