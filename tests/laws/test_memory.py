"""Laws with several memories, or with scalars: the same interpreted and compiled, on the line and in the plane."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
import pytest
from memory_laws import AGEING, elements
from profiles import some

from frictionlab.compile.cache import compiled
from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import njit
from frictionlab.compile.dispatch import by_law
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.memory import MemoryLaw

THREE = elements(stiffness=(5.0, 3.0, 1.0), reach=(0.02, 0.05, 0.2))


@njit
def read(law: Any, v: Any, memory: Any, rates: Any) -> Any:
    """Friction, and in ``rates`` the rates, of every memory; the last in steady sliding, whether they are within."""
    for k in range(law.count()):
        rates[k] = law.rate(v, memory, k)
    inside = 1.0 if law.within(memory) else 0.0
    rub = law.friction(v, memory, rates)
    return rub, law.steady(v, law.count() - 1), inside


@some(1, "kernels of its own")
@pytest.mark.parametrize(
    ("law", "v", "memory"),
    [
        (THREE, 0.7, np.array([0.02, -0.01, 0.15])),
        (THREE, 0.7 - 0.2j, np.array([0.02 + 0j, -0.03 + 0.04j, 0.1j])),
        (AGEING, -1e-9, np.array([40.0])),
        (AGEING, 0.3 + 0.4j, np.array([0.02])),
    ],
)
def test_a_law_with_memory_is_the_same_interpreted_and_compiled(law: MemoryLaw, v: Any, memory: Any) -> None:
    rates, compiled_rates = np.empty_like(memory), np.empty_like(memory)

    known = read.py_func(law, v, memory, rates)
    for own in (compiled(read, law), KernelCall(read, law)):
        assert own(v, memory, compiled_rates) == pytest.approx(known, rel=1e-13)
        assert compiled_rates == pytest.approx(rates, rel=1e-13)


class Dwelling(MemoryLaw):
    """A scalar that slip renews, of which nothing is told but its rate."""

    memory_kind: ClassVar[Literal["deflections", "scalars"]] = "scalars"

    def sliding_friction(self, speed: float) -> float:
        """At every speed."""
        return 0.3

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """Return 1, less what slip renews."""
        return 1.0 - abs(v) * memory[k]

    def friction(self, v: Any, memory: Any, rates: Any) -> Any:
        """More after a dwell."""
        return (0.3 + 0.1 * memory[0]) * v


class Drawn(Dwelling):
    """A deflection of which no more is told."""

    memory_kind: ClassVar[Literal["deflections", "scalars"]] = "deflections"


@some(1, "kernels of its own")
@pytest.mark.parametrize(
    ("law", "memory"),
    [(Drawn(), np.array([0.02 + 0.01j])), (Dwelling(), np.array([0.02]))],
    ids=["deflection", "scalar"],
)
def test_a_memory_whose_steady_value_is_not_told_is_compiled_in_the_plane(
    law: MemoryLaw, memory: Any
) -> None:
    v, rates, compiled_rates = 0.3 + 0.4j, np.empty_like(memory), np.empty_like(memory)

    known = read.py_func(law, v, memory, rates)

    assert KernelCall(read, law)(v, memory, compiled_rates) == pytest.approx(known, rel=1e-13)
    assert compiled_rates == pytest.approx(rates, rel=1e-13)


def test_elements_of_every_number_run_in_a_kernel_of_their_own() -> None:
    two = elements(stiffness=(1.0, 2.0), reach=(0.1, 0.2))
    read_two, read_three = compiled(read, two), compiled(read, THREE)

    assert read_two(0.5, np.zeros(2), np.zeros(2))[0] == 0.0
    assert read_three(0.5, np.full(3, 0.01), np.zeros(3))[0] == pytest.approx(0.09)
    assert read_two.entry is not read_three.entry


def _of_sliding(law: Any, zero: Any) -> float:
    return 0.0


def _of_bristle(law: Any, zero: Any) -> float:
    return 1.0


def _of_deflections(law: Any, zero: Any) -> float:
    return 2.0


def _of_scalars(law: Any, zero: Any) -> float:
    return 3.0


_body = by_law(_of_sliding, _of_bristle, _of_deflections, _of_scalars)


@njit
def which(law: Any, zero: Any) -> Any:
    """Which body a kernel takes."""
    return _body(law, zero)


def test_kernels_take_the_body_made_for_the_kind_of_deflections() -> None:
    cases = [(Coulomb(mu=0.4), 0j), (THREE, 0.0), (THREE, 0j), (AGEING, 0.0), (AGEING, 0j)]

    assert [compiled(which, law)(zero) for law, zero in cases] == [0.0, 2.0, 2.0, 3.0, 3.0]
    assert [which.py_func(law, zero) for law, zero in cases] == [0.0, 2.0, 2.0, 3.0, 3.0]
