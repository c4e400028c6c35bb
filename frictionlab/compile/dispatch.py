"""Laws as kernels see them: compiled, it is a named tuple of its numbers whose type leads numba to its methods.

A kernel takes a law as its first argument and calls its methods, ``law.sliding_vector(v)``. Interpreted, that is
the law itself. A kernel with several bodies is chosen here too, by dimension or by the kind of law.

A law as machine code sees it: a record of its numbers, and a class whose methods they lead to.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Sequence
from functools import cache
from types import FunctionType
from typing import Any, NamedTuple

import numba
import numba.core.typing.templates
import numba.extending

from frictionlab.compile.addresses import (
    INDEX,
    NUMBER,
    NUMBERS,
    TRUTH,
    VECTOR,
    VECTORS,
    Interface,
    call_on_line_or_plane,
)
from frictionlab.compile.decorators import INNER, fast, names_used
from frictionlab.compile.lanes import LaneType
from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw


class KernelLaw(NamedTuple):
    """A law, the class of its methods and their structure, its numbers; held: what the addresses among them need."""

    law: FrictionLaw
    kind: KnownLaw
    numbers: dict[str, Any]
    held: tuple[Any, ...] = ()


def by_itself(law: FrictionLaw) -> KernelLaw:
    """Return the law with its own methods: a kernel is compiled for it alone."""
    return KernelLaw(law, KnownLaw(type(law), law.structure()), dict(law.numbers()))


_extending: Any = numba.extending  # its published types lag behind what it accepts
_templates: Any = numba.core.typing.templates


class KnownLaw(NamedTuple):
    """Facts that the type of a law's numbers holds: the class whose methods kernels call, and its structure.

    by_address: whether the numbers hold the addresses of the methods, and the class is only their interface.
    """

    kind: type[FrictionLaw]
    structure: tuple[str, ...]
    by_address: bool = False


law_of_numbers: dict[type, KnownLaw] = {}


class KernelMethod(NamedTuple):
    """A method that kernels call on a law of an interface: what it takes and returns.

    One letter for each: x, a number; v, a number along a line or a vector in the plane; s, several numbers; m,
    several of what v is; k, which of them; t, a truth. By address, what takes nothing is a number of the law.
    """

    interface: Any
    name: str
    takes: str
    returns: str
    kind: str = ""  # of memory, where the interface serves two

    @property
    def planar(self) -> bool:
        """Check whether it is another function in the plane."""
        return bool({"v", "m"} & {*self.takes, self.returns})

    def types(self, planar: bool) -> Interface:
        """numba's types of arguments and result."""
        of_letters = {"x": NUMBER, "v": NUMBER, "s": NUMBERS, "m": NUMBERS, "k": INDEX, "t": TRUTH}
        if planar:
            of_letters |= {"v": VECTOR, "m": VECTORS}
        return Interface(tuple(of_letters[letter] for letter in self.takes), of_letters[self.returns])

    def by_address(self) -> Any:
        """Return what kernels call where the law's numbers hold the address."""
        parameters = ", ".join(inspect.signature(getattr(self.interface, self.name)).parameters)
        law, _, given = parameters.partition(", ")
        if not self.takes:
            value = f"{law}.own_{self.name}"
            text = (
                f"{value} != 0.0"
                if self.returns == "t"
                else f"int({value})"
                if self.returns == "k"
                else value
            )
        else:
            text = f"call({law}.line_{self.name}, {law}.plane_{self.name}, {law}.place, ({given},))"
        scope = {"call": call_on_line_or_plane(self.types(False), self.types(True))}
        exec(f"def by_address({parameters}):\n    return {text}\n", scope)
        return scope["by_address"]


KERNEL_METHODS = (
    KernelMethod(FrictionLaw, "sliding_friction", "x", "x"),
    KernelMethod(FrictionLaw, "sliding_vector", "v", "v"),
    KernelMethod(SlidingLaw, "static_friction", "", "x"),
    KernelMethod(BristleLaw, "rate", "vv", "v"),
    KernelMethod(BristleLaw, "friction", "vvv", "v"),
    KernelMethod(BristleLaw, "deflected", "vv", "v"),
    KernelMethod(BristleLaw, "saturation_path", "xx", "x"),
    KernelMethod(BristleLaw, "exact_path", "", "t"),
    KernelMethod(BristleLaw, "largest_deflection", "", "x"),
    KernelMethod(BristleLaw, "elastic_unloading", "", "t"),
    KernelMethod(BristleLaw, "yield_deflection", "", "x"),
    KernelMethod(MemoryLaw, "count", "", "k"),
    KernelMethod(MemoryLaw, "elastic_unloading", "", "t"),
    KernelMethod(MemoryLaw, "remembers_stick", "", "t"),
    KernelMethod(MemoryLaw, "yield_deflection", "k", "x"),
    KernelMethod(MemoryLaw, "breakaway", "vk", "x"),
    KernelMethod(MemoryLaw, "rate", "vmk", "v", "deflections"),
    KernelMethod(MemoryLaw, "friction", "vmm", "v", "deflections"),
    KernelMethod(MemoryLaw, "steady", "vk", "v", "deflections"),
    KernelMethod(MemoryLaw, "within", "m", "t", "deflections"),
    KernelMethod(MemoryLaw, "rate", "vsk", "x", "scalars"),
    KernelMethod(MemoryLaw, "friction", "vss", "v", "scalars"),
    KernelMethod(MemoryLaw, "steady", "vk", "x", "scalars"),
    KernelMethod(MemoryLaw, "within", "s", "t", "scalars"),
)
"""Every method of a law that kernels call."""


def _open_door(interface: Any, name: str) -> None:
    """Let kernels call this method of an interface on a law's numbers."""
    by_address = {
        each.kind: each.by_address()
        for each in KERNEL_METHODS
        if (each.interface, each.name) == (interface, name)
    }

    def resolve(self: Any, *_: Any) -> Any:
        known = law_of_numbers.get(self.instance_class)
        if known is None:
            return None
        # by address, a method that a law of its structure does not have is that of the interface
        absent = f"line_{name}" not in self.fields and f"own_{name}" not in self.fields
        if not known.by_address or absent:
            return compilable(getattr(known.kind, name))
        return by_address[next((kind for kind in by_address if kind in known.structure), "")]

    resolve.__signature__ = inspect.signature(getattr(interface, name))  # type: ignore[attr-defined]  # numba compares
    for kind in (numba.types.NamedTuple, numba.types.NamedUniTuple):
        door = _templates.make_overload_method_template(kind, name, resolve, inline="never", strict=False)
        _templates.infer_getattr(type(name, (_OfLaws, door), {"interface": interface}))
    _extending.overload(resolve, jit_options=INNER, strict=False)(resolve)


class _OfLaws:
    """Opens a door for the numbers of an interface's laws alone.

    Other records may have a field of the method's name, and other laws a method of that name with more arguments:
    numba knows what it compiles by name, so the interface is made a part of it.
    """

    interface: Any
    _attr: str

    def _init_once(self) -> None:
        own = self._attr
        self._attr = self._full(own)
        super()._init_once()  # type: ignore[misc]  # the other base has it
        self._attr = own

    def _resolve(self, typ: Any, attribute: str) -> Any:
        known = law_of_numbers.get(typ.instance_class)
        of_interface = known is not None and issubclass(known.kind, self.interface)
        bound = super()._resolve(typ, attribute) if of_interface else None  # type: ignore[misc]
        if bound is None:
            return None
        bound.template.key = bound.template.key[0], self._full(attribute)
        return bound.copy(bound.this)  # which knows itself by the new key

    def _full(self, method: str) -> str:
        return f"{self.interface.__name__}.{method}"


for _interface, _name in dict.fromkeys((each.interface, each.name) for each in KERNEL_METHODS):
    _open_door(_interface, _name)


def _overloaded(chosen: Any, resolve: Any, bodies: Sequence[Any], **options: Any) -> Any:
    """``chosen``, which kernels may call: numba compiles the body that resolve gives for the types of arguments."""
    chosen.bodies = tuple(bodies)  # for the fingerprint to find
    resolve.__signature__ = inspect.signature(bodies[0])  # numba compares them
    _extending.overload(chosen, jit_options=options or INNER, strict=False)(resolve)
    return chosen


def by_dimension(on_the_line: Any, in_the_plane: Any, in_lanes: Any = None) -> Any:
    """A kernel function with two bodies, chosen by the type of its last argument: ``float`` or ``complex``.

    numba types a branch it never takes; this keeps the other dimension's code out. All bodies are plain functions of
    the same signature. in_lanes: for planar numbers in lanes; that of the plane where left out.
    """

    def chosen(*arguments: Any) -> Any:
        return (in_the_plane if isinstance(arguments[-1], complex) else on_the_line)(*arguments)

    of_lanes = in_lanes or in_the_plane

    def resolve(*types: Any) -> Any:
        if isinstance(types[-1], LaneType) and types[-1].planar:
            return of_lanes
        return in_the_plane if isinstance(types[-1], numba.types.Complex) else on_the_line

    chosen.of_lanes = of_lanes  # type: ignore[attr-defined]  # for Python to run on arrays
    bodies = [each for each in (on_the_line, in_the_plane, in_lanes) if each is not None]
    return _overloaded(chosen, resolve, bodies, **INNER, fastmath=True)


def by_nearness(of_near: Any, of_noted: Any = None, of_any: Any = None) -> Any:
    """A kernel function with two or three bodies, chosen by the time that its second argument is.

    of_near: of an instant ``Near`` the anchor of a step. of_noted: of a stage that was ``Noted``. of_any: of others.
    """

    def body_for(fields: Any) -> Any:
        return of_noted if "swing" in fields else of_near if "part" in fields else of_any

    def chosen(*arguments: Any) -> Any:
        return body_for(arguments[1]._fields)(*arguments)

    def resolve(*types: Any) -> Any:
        return body_for(getattr(types[1], "fields", ()))

    bodies = [each for each in (of_near, of_noted, of_any) if each is not None]
    return _overloaded(chosen, resolve, bodies, **EMBEDDED)


EMBEDDED = INNER | {"forceinline": True, "fastmath": True}


def by_variation(of_one_sine: Any, of_varying: Any, **options: Any) -> Any:
    """A kernel function with two bodies, chosen by the field ``varying`` of its first argument.

    of_one_sine: for a record whose field is empty, as lanes have it: one sine is all that changes in time in it.
    """

    def chosen(*arguments: Any) -> Any:
        return (of_varying if _varies(arguments[0]) else of_one_sine)(*arguments)

    def resolve(*types: Any) -> Any:
        return of_varying if _varies(types[0]) else of_one_sine

    of_one_sine, of_varying = (getattr(body, "py_func", body) for body in (of_one_sine, of_varying))
    return _overloaded(chosen, resolve, (of_one_sine, of_varying), **options)


def _varies(record: Any) -> bool:
    """Check that the field ``varying`` of a record, or of the body it holds, is filled; record: it, or its type."""
    varying, body = _part(record, "varying"), _part(record, "body")
    return len(varying) > 0 if varying is not None else body is not None and _varies(body)


def _part(record: Any, name: str) -> Any:
    """A field of a named tuple, or of numba's type of one; None where it has none of that name."""
    fields = getattr(record, "fields", ())
    return record.types[fields.index(name)] if name in fields else getattr(record, name, None)


def as_argument(function: Any) -> Any:
    """A kernel function that others may be handed: numba caches no code that is handed a compiled function."""
    body = getattr(function, "py_func", function)

    def handed(*arguments: Any) -> Any:
        return body(*arguments)

    def resolve(*types: Any) -> Any:
        return body

    return _overloaded(handed, resolve, (body,), **getattr(function, "targetoptions", INNER))


def by_stepper(bodies: dict[type, Any]) -> Any:
    """A kernel function with several bodies, chosen by the type of the field ``stepper`` of its first argument."""
    plain = {kind: getattr(body, "py_func", body) for kind, body in bodies.items()}

    def chosen(*arguments: Any) -> Any:
        return plain[type(arguments[0].stepper)](*arguments)

    def resolve(*types: Any) -> Any:
        return plain[types[0].types[types[0].fields.index("stepper")].instance_class]

    return _overloaded(chosen, resolve, list(plain.values()))


def by_law(of_sliding: Any, of_bristle: Any, of_deflections: Any = None, of_scalars: Any = None) -> Any:
    """A kernel function with several bodies of one signature, chosen by the law its first argument is or holds.

    The first argument is a law, or a record with a law in the field ``law``.

    of_deflections is for memory laws, of_scalars for those whose memories have no direction; the choice is made when
    kernels are compiled, so that what a law does not need is never compiled for it.
    """
    deflections = of_deflections or of_sliding
    choices = of_sliding, of_bristle, deflections, of_scalars or deflections
    bodies = [getattr(body, "py_func", body) for body in choices]

    def chosen(*arguments: Any) -> Any:
        law = getattr(arguments[0], "law", arguments[0])
        return bodies[_which(type(law), law.structure())](*arguments)

    def resolve(*types: Any) -> Any:
        law, structure, _ = law_of_numbers[_numbers_in(types[0]).instance_class]
        return bodies[_which(law, structure)]

    return _overloaded(chosen, resolve, bodies)


def by_scalars(of_others: Any, of_scalars: Any) -> Any:
    """Return the same, chosen by whether what the law remembers has no direction."""
    return by_law(of_others, of_others, of_others, of_scalars)


def _numbers_in(first: Any) -> Any:
    """Return the type of a law's numbers: that of the argument, or of its field ``law``."""
    if first.instance_class in law_of_numbers:
        return first
    return first.types[first.fields.index("law")]


def _which(law: type[FrictionLaw], structure: tuple[str, ...]) -> int:
    if issubclass(law, MemoryLaw):
        return 3 if "scalars" in structure else 2
    return int(issubclass(law, BristleLaw))


length = by_dimension(lambda v: math.fabs(v), lambda v: math.sqrt(v.real * v.real + v.imag * v.imag))
"""``abs`` for kernels: no kernel meets slip near 1e-150, and without that guard it takes a third of the time."""


@cache
def compilable(function: FunctionType) -> FunctionType:
    """Return the function with the plain helpers it names compiled too, and ``abs`` quick: laws do not know numba."""
    names = {
        name
        for name in names_used(function.__code__)
        if isinstance(function.__globals__.get(name), FunctionType)
    }
    helpers = {name: fast(compilable(function.__globals__[name])) for name in names - {function.__name__}}
    scope = {**function.__globals__, **helpers, "abs": length}
    twin = FunctionType(
        function.__code__, scope, function.__name__, function.__defaults__, function.__closure__
    )
    twin.__annotations__ = {}
    return twin
