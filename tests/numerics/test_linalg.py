"""Small linear systems inside kernels, against numpy."""

from __future__ import annotations

import numpy as np
import pytest

from frictionlab.compile.cache import compiled
from frictionlab.numerics.linalg import solve_linear


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
