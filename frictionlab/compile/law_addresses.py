"""Laws behind addresses: one kernel serves all laws of a kind of memory, and calls their methods where they lie.

A kernel that is compiled for one law has its methods inside; that takes 10 to 20 s, and gains a fifth of its run time
where a bristle is followed along a line, next to nothing elsewhere. Here the methods of a law are compiled alone
[1 s], in an entry that writes the law's numbers to a place and gives the addresses of its methods. Kernels see a law
whose numbers are these; what it says of itself without arguments is a number, too.
"""

from __future__ import annotations

from functools import cache, lru_cache, partial
from typing import Any

import numpy as np

from frictionlab.compile.addresses import Addressed, addresses_of, bytes_of, written_to
from frictionlab.compile.cache import compiled
from frictionlab.compile.decorators import njit
from frictionlab.compile.dispatch import (
    KERNEL_METHODS,
    KernelLaw,
    KernelMethod,
    KnownLaw,
    by_itself,
    compilable,
    law_of_numbers,
)
from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw

INTERFACES: Any = SlidingLaw, BristleLaw, MemoryLaw
ONLY_WITH = {"breakaway": "stick"}
"""Methods that kernels call on laws of this structure alone."""


@lru_cache(maxsize=256)
def by_address(law: FrictionLaw, planar: bool) -> KernelLaw:
    """Return the law as kernels for all laws of its kind see it. Raises CannotCompile.

    planar: whether its methods are called in the plane as well as on the line.
    """
    own, empty, methods = by_itself(law), without_addresses(law), _called(law)
    entry = compiled(_on_the_line(methods), own)
    room, place, line = entry()
    numbers = empty.numbers | {"place": place} | _named("line", methods, line)
    if planar:
        numbers |= _named("plane", _planar(methods), compiled(_in_the_plane(_planar(methods)), own)())
    return empty._replace(numbers=numbers, held=(room, entry))  # which has the arrays that the room points to


def without_addresses(law: FrictionLaw) -> KernelLaw:
    """Return the same with numbers of the same types, and nothing compiled."""
    interface = _interface(law)
    numbers: dict[str, Any] = {"place": 0} | {
        f"{part}_{each.name}": 0 for each in _called(law) for part in ("line", "plane")
    }
    numbers |= {
        f"own_{each.name}": _number(getattr(law, each.name)()) for each in _methods(law) if not each.takes
    }
    numbers |= {name: getattr(law, name) for name in _properties(interface)}
    return KernelLaw(law, KnownLaw(interface, law.structure(), by_address=True), numbers)


def _named(part: str, methods: tuple[KernelMethod, ...], addresses: Any) -> dict[str, int]:
    return {f"{part}_{each.name}": at for each, at in zip(methods, addresses, strict=True)}


def _interface(law: FrictionLaw) -> type[FrictionLaw]:
    return next(kind for kind in INTERFACES if isinstance(law, kind))


def _methods(law: FrictionLaw) -> tuple[KernelMethod, ...]:
    """Return the methods that kernels call on a law of this structure."""
    interface, structure = _interface(law), law.structure()
    return tuple(
        each
        for each in KERNEL_METHODS
        if issubclass(interface, each.interface)
        and (not each.kind or each.kind in structure)
        and ONLY_WITH.get(each.name, "") in ("", *structure)
    )


def _called(law: FrictionLaw) -> tuple[KernelMethod, ...]:
    """Return those of its methods that are called by address."""
    return tuple(each for each in _methods(law) if each.takes)


def _planar(methods: tuple[KernelMethod, ...]) -> tuple[KernelMethod, ...]:
    return tuple(each for each in methods if each.planar)


def _properties(interface: type[FrictionLaw]) -> list[str]:
    return [name for name, value in vars(interface).items() if isinstance(value, property)]


def _number(value: Any) -> float | int:
    return value if isinstance(value, int) and not isinstance(value, bool) else float(value)


# --- the entries of a law -------------------------------------------------------------------------------------------


def _body(name: str, numbers: Any) -> Any:
    """Return the method of the law whose numbers are of this type."""
    return compilable(getattr(law_of_numbers[numbers.instance_class].kind, name))


def _addresses(methods: tuple[KernelMethod, ...], planar: bool) -> Any:
    return addresses_of(
        [Addressed(partial(_body, each.name), each.types(planar), of_type=True) for each in methods]
    )


@cache
def _on_the_line(methods: tuple[KernelMethod, ...]) -> Any:
    addresses = _addresses(methods, False)

    @njit
    def methods_on_the_line(law: Any) -> Any:
        room = np.empty(bytes_of(law), np.uint8)
        return room, written_to(law, room), addresses(law)

    return methods_on_the_line


@cache
def _in_the_plane(methods: tuple[KernelMethod, ...]) -> Any:
    addresses = _addresses(methods, True)

    @njit
    def methods_in_the_plane(law: Any) -> Any:
        return addresses(law)

    return methods_in_the_plane
