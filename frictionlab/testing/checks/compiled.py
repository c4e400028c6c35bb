"""Checks of a law as numba compiles it: the same physics, in the same lines, on the line and in the plane."""

from __future__ import annotations

from typing import Any

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import njit
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.faults import CannotCompile
from frictionlab.laws.memory import BristleLaw, MemoryLaw
from frictionlab.motion.contact import resistance
from frictionlab.testing.contact import ContactMemory, Response, response
from frictionlab.testing.example import Given, law_check


@njit
def without_memory(law: Any, v: Any, memory: Any, out: Any) -> None:
    """out: friction."""
    out[0] = law.sliding_vector(v[0])


@njit
def with_a_bristle(law: Any, v: Any, memory: Any, out: Any) -> None:
    """out: friction, rate, the deflection."""
    out[1], out[0] = resistance(law, v[0], memory[0])
    out[2] = memory[0]


@njit
def with_an_exact_path(law: Any, v: Any, memory: Any, out: Any) -> None:
    """out: friction, rate, deflection after slip for a unit of time."""
    out[1], out[0] = resistance(law, v[0], memory[0])
    out[2] = law.deflected(memory[0], v[0])


@njit
def with_memory(law: Any, v: Any, memory: Any, out: Any) -> None:
    """out: friction, rates."""
    rates = np.empty_like(memory)
    for k in range(memory.size):
        rates[k] = law.rate(v[0], memory, k)
        out[1 + k] = rates[k]
    out[0] = law.friction(v[0], memory, rates)


def machine_response(one: Given, law: FrictionLaw, v: Any, memory: ContactMemory) -> tuple[Response, Any]:
    """Return what the compiled law answers, and its deflection after the path ``v``."""
    kernel = without_memory
    if isinstance(law, BristleLaw):
        kernel = with_an_exact_path if law.exact_path() else with_a_bristle
    elif isinstance(law, MemoryLaw):
        kernel = with_memory
    out = np.zeros(len(memory) + 2, type(v))
    try:
        KernelCall(kernel, law)(np.array([v]), np.array(memory or (0.0 * v,)), out)
    except CannotCompile as problem:
        one.require(False, str(problem))
    answer = out.tolist()
    return Response(tuple(answer[1 : 1 + len(memory)]), answer[0]), answer[-1]


@law_check(
    change="use plain arithmetic, abs, if, for and the math module in methods; parameters and properties for numbers",
    patience=10.0,
    share=0.5,
)
def compiled_on_the_line(one: Given) -> None:
    """Compiled by numba and run by Python a law answers the same to rounding, along a line."""
    law = one.law()
    v = one.slip()
    _agree(one, law, v, one.memory(law))


@law_check(
    change="use plain arithmetic, abs, if, for and the math module in methods; no float of a complex number",
    patience=10.0,
    share=0.5,
    seldom="no parameters drawn have a form in the plane",
)
def compiled_in_the_plane(one: Given) -> None:
    """Compiled by numba and run by Python a law answers the same to rounding, in the plane."""
    law = one.planar_law()
    v = one.planar_slip()
    _agree(one, law, v, one.memory(law, planar=True))


def _agree(one: Given, law: FrictionLaw, v: Any, memory: ContactMemory) -> None:
    got, slid = machine_response(one, law, v, memory)
    one.require_same(law, (v, memory), got, response(law, v, memory), "compiled and interpreted")
    in_one_direction = isinstance(v, complex) and getattr(law, "planar", "") != "vectorial"
    if isinstance(law, BristleLaw) and law.exact_path() and not in_one_direction:
        should = law.deflected(memory[0], v)
        size = abs(should) + abs(memory[0]) + law.presliding()
        one.require(
            abs(slid - should) <= 1e-11 * size,
            "deflected, compiled and interpreted",
            got=slid,
            expected=should,
        )
