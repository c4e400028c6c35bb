"""Real-linear maps as pairs of complex numbers: against matrices."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from frictionlab.motion import linalg as blocks

number = st.floats(-10.0, 10.0)
matrices = st.tuples(number, number, number, number).map(lambda four: np.array(four).reshape(2, 2))
vectors = st.tuples(number, number).map(lambda two: complex(*two))


def in_the_plane(function: Any) -> Any:
    return function.bodies[1]


def pair(matrix: Any) -> Any:
    """The pair of a matrix, by its columns."""
    return in_the_plane(blocks.from_columns)(complex(*matrix[:, 0]), complex(*matrix[:, 1]))


def vector(x: complex) -> Any:
    return np.array([x.real, x.imag])


def matrix_of(block: Any) -> Any:
    """The matrix of a pair: what it does to 1 and to i."""
    return np.column_stack([vector(in_the_plane(blocks.apply)(block, x)) for x in (1.0 + 0j, 1j)])


@given(matrix=matrices, x=vectors)
def test_a_pair_does_what_its_matrix_does(matrix: Any, x: complex) -> None:
    assert vector(in_the_plane(blocks.apply)(pair(matrix), x)) == pytest.approx(matrix @ vector(x), abs=1e-12)


@given(left=matrices, right=matrices, factor=number)
def test_products_sums_and_multiples_are_those_of_the_matrices(left: Any, right: Any, factor: float) -> None:
    a, b = pair(left), pair(right)

    assert matrix_of(in_the_plane(blocks.product)(a, b, 0j)) == pytest.approx(left @ right, abs=1e-12)
    assert matrix_of(in_the_plane(blocks.add)(a, b, 0j)) == pytest.approx(left + right, abs=1e-13)
    assert matrix_of(in_the_plane(blocks.scale)(factor, a, 0j)) == pytest.approx(factor * left, abs=1e-13)


@given(matrix=matrices)
def test_a_pair_times_its_inverse_is_the_identity(matrix: Any) -> None:
    assume(abs(np.linalg.det(matrix)) > 1e-3)
    a = pair(matrix)

    turned_back = in_the_plane(blocks.product)(in_the_plane(blocks.inverse)(a, 0j), a, 0j)

    assert matrix_of(turned_back) == pytest.approx(np.eye(2), abs=1e-9)


@given(matrix=matrices)
def test_an_array_keeps_a_map_on_the_line_and_in_the_plane(matrix: Any) -> None:
    vectors, numbers = np.zeros(4, complex), np.zeros(4)

    blocks.keep(vectors, 1, pair(matrix), 0j)
    blocks.keep(numbers, 1, matrix[0, 0], 0.0)

    assert matrix_of(blocks.block(vectors, 1, 0j)) == pytest.approx(matrix, abs=1e-14)
    assert blocks.block(numbers, 1, 0.0) == matrix[0, 0]
