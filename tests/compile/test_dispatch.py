"""What kernels may be handed: other kernel functions, records that choose a body, bare pointers."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest

from frictionlab.compile.cache import compiled
from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import as_argument, by_stepper
from frictionlab.compile.stack import count_of, items_of
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl


class Once(NamedTuple):
    """A stepper."""

    share: float


class Twice(NamedTuple):
    """Another with a field of the same name and type."""

    share: float


class Stepped(NamedTuple):
    """What a stepper sees."""

    stepper: Any


@as_argument
@inner
def square(x: float) -> float:
    """A function to be handed on."""
    return x * x


@inner
def applied(function: Any, x: float) -> float:
    """One that is handed a function."""
    return function(function(x))


@inner
def fourth_power(x: float) -> float:
    """Of a number, by a function handed on."""
    return applied(square, x)


def _once(problem: Stepped, x: float) -> float:
    return problem.stepper.share * x


def _twice(problem: Stepped, x: float) -> float:
    return 2.0 * problem.stepper.share * x


step = by_stepper({Once: _once, Twice: _twice})


@inner
def stepped(stepper: Any, x: float) -> float:
    """A step of whatever stepper."""
    return step(Stepped(stepper), x)


@inner
def sum_of(values: Any) -> float:
    """Of three numbers, by a bare pointer."""
    items, total = items_of(values), 0.0
    for k in range(3):
        total += items[k]
    return total + 0.0 * values[0]


@inner
def count(law: Any) -> int:
    """How many numbers a law remembers."""
    return count_of(law)


def test_a_kernel_that_hands_on_a_function_is_kept_on_disk() -> None:
    """numba would warn that it keeps none that is handed a compiled function; warnings are errors."""
    assert compiled(fourth_power)(3.0) == 81.0


@pytest.mark.parametrize(("stepper", "value"), [(Once(0.5), 2.0), (Twice(0.5), 4.0)])
def test_the_type_of_a_stepper_chooses_the_body(stepper: Any, value: float) -> None:
    assert compiled(stepped)(stepper, 4.0) == value
    assert step(Stepped(stepper), 4.0) == value


def test_items_of_an_array_are_its_numbers() -> None:
    assert compiled(sum_of)(np.array([1.0, 2.0, 4.0])) == 7.0


@pytest.mark.parametrize(("law", "numbers"), [(Coulomb(mu=0.4), 0), (Dahl(mu=0.4, presliding_length=1.0), 1)])
def test_kernels_know_how_many_numbers_a_law_remembers(law: Any, numbers: int) -> None:
    assert compiled(count, law)() == numbers == count_of(law)
