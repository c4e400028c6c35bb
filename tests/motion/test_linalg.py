"""Small linear systems inside kernels, against numpy."""

from __future__ import annotations

import numpy as np
import pytest

from frictionlab.compile.cache import compiled
from frictionlab.motion.linalg import radius_bound, solve_linear


@pytest.mark.parametrize("n", [1, 2, 4, 7])
def test_elimination_solves_what_numpy_solves(n: int) -> None:
    numbers = np.random.default_rng(n)
    for _ in range(20):
        matrix, right = numbers.normal(size=(n, n)), numbers.normal(size=n)
        expected = np.linalg.solve(matrix, right)
        compiled(solve_linear)(matrix, right)
        assert right == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_a_pivot_of_zero_is_swapped_away() -> None:
    right = np.array([3.0, 5.0])
    compiled(solve_linear)(np.array([[0.0, 1.0], [2.0, 0.0]]), right)
    assert right.tolist() == [2.5, 3.0]


@pytest.mark.parametrize("n", [2, 3, 6])
def test_the_bound_on_multipliers_is_no_smaller_and_hardly_larger(n: int) -> None:
    numbers = np.random.default_rng(n)
    for _ in range(20):
        matrix = numbers.normal(size=(n, n)) / np.sqrt(n)
        largest = np.abs(np.linalg.eigvals(matrix)).max()
        bound = compiled(radius_bound)(matrix)
        assert largest <= bound * (1.0 + 1e-12)
        assert bound < 1.15 * largest


def test_a_matrix_whose_powers_vanish_has_no_radius() -> None:
    assert compiled(radius_bound)(np.array([[0.0, 5.0], [0.0, 0.0]])) == 0.0
