"""When a motion followed from a far start is said to end on an orbit: it does what the monodromy says."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from frictionlab.compile.interpret import interpreted
from frictionlab.methods.periodic.attraction import KnownOrbit, obeys

SPIRAL = 0.9 * np.array([[0.0, -2.0], [0.5, 0.0]])
"""Multipliers of 0.9i and -0.9i: a distance that doubles in one period and falls to less than half in the next."""


def follows(matrix: Any, before: Any, after: Any) -> bool:
    largest = np.abs(np.linalg.eigvals(matrix)).max()
    orbit = KnownOrbit(np.zeros(len(before)), matrix, 1.0 - largest)
    return bool(interpreted(obeys)(orbit, before, after, np.empty(len(before))))


@pytest.mark.parametrize("matrix", [np.diag([0.94, 0.2]), SPIRAL], ids=["real", "complex"])
def test_a_motion_near_the_orbit_does(matrix: Any) -> None:
    before = np.array([0.3, 0.1])
    assert follows(matrix, before, matrix @ before + 1e-3 * np.array([1.0, -1.0]))


def test_another_orbit_does_not_though_its_distance_is_within_a_tenth_of_the_prediction() -> None:
    before = np.array([0.3, 0.0])
    assert not follows(np.diag([0.94, 0.2]), before, before)
    assert not follows(np.diag([0.999, 0.2]), before, before)


def test_a_distance_that_shrinks_as_predicted_in_another_direction_does_not() -> None:
    matrix, before = np.diag([0.6, 0.6]), np.array([0.3, 0.0])
    assert not follows(matrix, before, np.array([0.0, 0.18]))


def test_nothing_does_where_a_multiplier_is_one_or_unknown() -> None:
    before = np.array([0.3, 0.1])
    for matrix in (np.eye(2), np.diag([1.02, 0.5])):
        assert not follows(matrix, before, matrix @ before)
    orbit = KnownOrbit(np.zeros(2), np.full((2, 2), np.nan), np.nan)
    assert not interpreted(obeys)(orbit, before, before, np.empty(2))
