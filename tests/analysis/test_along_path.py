"""Friction along a measured path: closed forms, limits, and the path cut into more samples."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from profiles import deep

import frictionlab as fl
from frictionlab.analysis.fit.along_path import friction_along

TIMES = np.linspace(0.0, 4.0 * math.pi, 801)
SLIPS = np.sin(TIMES)
LAWS: list[Any] = [
    fl.Coulomb(mu=0.4),
    fl.Dahl(mu=0.4, stiffness=4.0),
    fl.Dahl(mu=0.4, stiffness=4.0, exponent=0.5),
    fl.Jenkins(mu=0.4, stiffness=4.0),
    fl.ElastoPlastic(mu_kinetic=0.4, stiffness=4.0, breakaway_ratio=0.7),
    fl.LuGre(mu_kinetic=0.4, mu_static=0.5, stribeck_speed=0.5, stiffness=4.0),
]


class SpringsInParallel(fl.MemoryLaw):
    """Dahl friction in two equal halves."""

    mu: fl.Positive
    stiffness: fl.Stiffness

    def count(self) -> int:
        return 2

    def sliding_friction(self, speed: float) -> float:
        return self.mu

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        return v - abs(v) * memory[k] * self.stiffness / self.mu

    def friction(self, v: Any, memory: Any, rates: Any) -> Any:
        return 0.5 * self.stiffness * (memory[0] + memory[1])

    def steady(self, v: Any, k: int) -> Any:
        return self.mu / self.stiffness * v / abs(v)


def test_the_first_loading_of_dahl_is_its_exponential() -> None:
    slips = np.linspace(0.0, 1.0, 50)
    found = friction_along(fl.Dahl(mu=0.4, stiffness=4.0), slips, slips, 0.0)
    assert found == pytest.approx(0.4 * (1.0 - np.exp(-10.0 * slips)), abs=1e-14)


def test_jenkins_is_a_spring_up_to_its_limit() -> None:
    slips = np.linspace(0.0, 1.0, 50)
    found = friction_along(fl.Jenkins(mu=0.4, stiffness=4.0), slips, slips, 0.0)
    assert found == pytest.approx(np.minimum(4.0 * slips, 0.4), abs=1e-14)


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_friction_is_odd_in_the_slip(law: Any) -> None:
    there, back = (friction_along(law, TIMES, side * SLIPS, 0.0) for side in (1.0, -1.0))
    assert there == pytest.approx(-back, abs=1e-14)


@pytest.mark.parametrize("law", LAWS[1:4], ids=repr)
@given(speed=st.floats(0.01, 100.0))
def test_what_depends_on_the_path_alone_does_not_on_its_speed(law: Any, speed: float) -> None:
    slow, fast = (friction_along(law, TIMES / pace, SLIPS, 0.0) for pace in (1.0, speed))
    assert fast == pytest.approx(slow, abs=1e-12)


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_samples_between_samples_change_little(law: Any) -> None:
    fine = np.linspace(TIMES[0], TIMES[-1], 4 * (len(TIMES) - 1) + 1)
    few = friction_along(law, TIMES, np.interp(TIMES, fine, np.interp(fine, TIMES, SLIPS)), 0.0)
    many = friction_along(law, fine, np.interp(fine, TIMES, SLIPS), 0.0)
    assert few == pytest.approx(many[::4], abs=2e-4)


@deep("more kernels to compile")
def test_numbers_of_a_memory_law_are_those_of_the_bristle_that_they_make() -> None:
    one = friction_along(fl.Dahl(mu=0.4, stiffness=4.0), TIMES, SLIPS, 0.1)
    two = friction_along(SpringsInParallel(mu=0.4, stiffness=4.0), TIMES, SLIPS, 0.1)
    assert two == pytest.approx(one, abs=1e-7)


class SlidersInParallel(SpringsInParallel):
    """Jenkins friction in two equal halves."""

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        if memory[k] * v <= 0.0 or abs(memory[k]) < self.mu / self.stiffness:
            return v
        return 0.0 * v

    def yield_deflection(self, k: int) -> float:
        return self.mu / self.stiffness


def test_deflections_that_yield_are_the_slider_that_they_make() -> None:
    one = friction_along(fl.Jenkins(mu=0.4, stiffness=4.0), TIMES, SLIPS, 0.1)
    two = friction_along(SlidersInParallel(mu=0.4, stiffness=4.0), TIMES, SLIPS, 0.1)
    assert two == pytest.approx(one, abs=1e-12)


def test_the_first_sample_tells_how_far_the_bristle_is_bent() -> None:
    found = friction_along(fl.Jenkins(mu=0.4, stiffness=4.0), TIMES[:2], np.array([0.0, 1e-3]), 0.2)
    assert found[1] == pytest.approx(0.204, abs=1e-12)


@pytest.mark.parametrize("seed", [0, 2, 6])
def test_laws_with_other_blocks_are_ranked_on_the_same_rows(seed: int) -> None:
    """A short record, whose residuals are correlated over other lengths for each law."""
    draw, times = np.random.default_rng(seed), np.arange(200.0)
    slip = 3.0 * np.sin(2.0 * np.pi * times / 170) + 0.3 * np.sin(2.0 * np.pi * times / 37)
    bent, noise, friction = 0.0, 0.0, []
    for step in np.diff(slip, prepend=0.0):
        bent, noise = float(np.clip(bent + step, -1.0, 1.0)), 0.95 * noise + 0.02 * draw.normal()
        friction.append(0.5 * bent + noise)
    laws = [fl.Jenkins(mu=0.5, stiffness=0.5), fl.Dahl(mu=0.5, stiffness=0.5)]
    data = {"time": times, "slip": slip, "friction": np.array(friction)}
    found = fl.fit(data, laws, free={"mu": (0.1, 2.0), "stiffness": (0.1, 5.0)})

    assert found.sentences[0].startswith("Jenkins fits with an rms of ")
    assert len({len(each.left_out.squares) for each in found.fitted}) == 1
