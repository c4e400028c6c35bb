"""What laws claim by saying nothing: nothing that a method could lean on."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.compliant import CompliantLaw
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.decay import exp_power_decay, steepest_slope
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.memory import BristleLaw, MemoryLaw
from frictionlab.laws.stribeck import Stribeck


class Silent(FrictionLaw):
    """Friction of nothing."""

    def sliding_friction(self, speed: float) -> float:
        """One over the speed."""
        return 1.0 / (1.0 + speed)


class SilentSliding(Silent, SlidingLaw):
    """Without memory."""


class SilentBristles(Silent, BristleLaw):
    """With a bristle."""

    def rate(self, v: Any, z: Any) -> Any:
        return v - abs(v) * z

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        return 3.0 * z


class SilentCompliant(SilentBristles, CompliantLaw):
    """Of a stiffness."""


class SilentAge(Silent, MemoryLaw):
    """With a memory that knows no direction."""

    memory_kind = "scalars"

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        return 1.0

    def friction(self, v: Any, memory: Any, rates: Any) -> Any:
        return v * memory[0]


class SilentMemory(Silent, MemoryLaw):
    """With a memory."""

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        return v

    def friction(self, v: Any, memory: Any, rates: Any) -> Any:
        return memory[0]


def test_a_law_that_says_nothing_of_its_friction_over_speed_may_fall_and_jump() -> None:
    for law in (SilentSliding(), SilentBristles(), SilentMemory()):
        assert not law.constant_sliding_friction()
        assert not law.monotone()
        assert law.steepest_fall() == math.inf
    assert SilentSliding().static_friction() == 1.0


def test_bristles_that_say_nothing_store_what_a_spring_does() -> None:
    law = SilentBristles()

    assert law.stored(0.0) == law.stored(0j) == 0.0
    assert law.stored(2.0) == law.stored(2j) == 6.0
    assert SilentCompliant(stiffness=1).saturated_friction() == 1.0


@pytest.mark.parametrize(
    "pair",
    [
        ("stiffness", "presliding_length"),
        ("stiffness", "contact_stiffness"),
        ("presliding_length", "contact_stiffness"),
    ],
)
def test_a_stiffness_told_twice_is_refused_and_the_second_named(pair: tuple[str, str]) -> None:
    with pytest.raises(ValueError, match=f"{pair[1]}: leave it out where {pair[0]} is given"):
        SilentCompliant(**dict.fromkeys(pair, 1.0))


def test_a_memory_that_says_nothing_turns_with_the_slip_and_is_none_in_steady_sliding() -> None:
    assert SilentMemory().turning == 1.0
    assert SilentAge().turning == 0.0
    assert SilentMemory().steady(0.0, 0) == SilentMemory().steady(2.0, 0) == 0.0


@pytest.mark.parametrize(("curve", "steepest"), [("hyperbolic", 1.0), ("hess-soom", 0.375 * math.sqrt(3.0))])
def test_a_rational_fall_is_as_steep_as_at_its_inflection(curve: Any, steepest: float) -> None:
    law = Stribeck(mu_kinetic=0.3, mu_static=0.5, stribeck_speed=2, curve=curve)

    assert law.steepest_fall() == pytest.approx(0.1 * steepest, rel=1e-15)
    assert not law.constant_sliding_friction()
    assert not Stribeck(
        mu_kinetic=0.3, mu_static=0.3, stribeck_speed=2, viscosity=1
    ).constant_sliding_friction()


@pytest.mark.parametrize("power", [1.0, 1.05, 1.5, 2.0, 4.0, 30.0])
def test_an_exponential_fall_is_as_steep_as_its_largest_slope(power: float) -> None:
    u = np.linspace(0.0, 3.0, 300_001)
    falls = -np.diff([exp_power_decay(speed, power) for speed in u.tolist()]) / np.diff(u)

    assert exp_power_decay(0.0, power) == 1.0
    assert exp_power_decay(1e9, power) == 0.0
    assert steepest_slope(power) == pytest.approx(falls.max(), rel=1e-4)


class Even(Silent):
    """The same friction at every speed, and says no more."""

    def constant_sliding_friction(self) -> bool:
        return True


class Rising(SilentSliding):
    """Never falls, and says no more."""

    def monotone(self) -> bool:
        return True


def test_friction_that_does_not_fall_has_a_steepest_fall_of_zero_without_saying_so() -> None:
    assert Even().steepest_fall() == Rising().steepest_fall() == 0.0


def test_viscosity_helps_bristles_to_damp_motion_across_up_to_a_speed() -> None:
    law = LuGre(mu_kinetic=0.3, stiffness=5, damping=0.6, viscosity=0.15)

    assert law.damps_across(0.3 * 4.0 * 0.75 / 0.36 * (1.0 - 1e-12))
    assert not law.damps_across(0.3 * 4.0 * 0.75 / 0.36 * (1.0 + 1e-12))


def test_dahl_friction_has_a_vector_form_for_exponent_one_alone() -> None:
    assert Dahl(mu=0.4, stiffness=1).no_vector_form() == ""
    for exponent in (0.9, 1.1, 2.0):
        assert "exponent 1 alone" in Dahl(mu=0.4, stiffness=1, exponent=exponent).no_vector_form()


def test_bristles_that_say_nothing_are_unbounded_stiff_without_end_and_not_known_to_be_passive() -> None:
    law = SilentBristles()

    assert law.largest_deflection() == law.presliding() == law.yield_deflection() == math.inf
    assert law.largest_rate(1.0) == law.saturation_path(0.0, 1.0) == math.inf
    assert law.elastic_deflection() == 0.0
    assert not law.elastic_unloading()
    assert not law.rate_independent()
    assert not law.passive()
    assert not law.exact_path()
    assert law.no_vector_form() == ""
    assert law.stored(0.5 + 0.5j) == 0.75
    assert law.structure() == ()


def test_a_memory_that_says_nothing_is_one_number_of_any_size_that_stores_nothing() -> None:
    law = SilentMemory()

    assert (law.count(), law.steady(2.0, 0), law.stored([1.0])) == (1, 0.0, 0.0)
    assert law.within([1e300])
    assert law.largest_rate(1.0) == math.inf
    assert not law.rate_independent()
    assert not law.passive()


class Counting(SilentSliding):
    """Properties of every kind."""

    @property
    def elements(self) -> int:
        return 3

    @property
    def hardens(self) -> bool:
        return True

    @property
    def lengths(self) -> tuple[float, ...]:
        """Several numbers, told as whole ones."""
        return (1, 2)


def test_kernels_know_whole_numbers_as_such_and_truth_values_and_lists_as_numbers() -> None:
    numbers = Counting().numbers()

    assert numbers == {"elements": 3, "hardens": 1.0, "lengths": (1.0, 2.0)}
    assert [type(numbers[name]) for name in ("elements", "hardens")] == [int, float]
    assert {type(each) for each in numbers["lengths"]} == {float}  # type: ignore[union-attr]


def test_every_family_says_how_much_it_remembers_and_one_that_declares_no_memory_is_of_no_family() -> None:
    laws = SilentSliding(), SilentBristles(), SilentMemory(), SilentAge()

    assert Silent().memory_kind == "undeclared"
    assert [law.memory_kind for law in laws] == ["none", "bristle", "deflections", "scalars"]
    assert [law.count() for law in laws] == [0, 1, 1, 1]
