"""Real-linear maps of one direction or two: a number on the line, a pair of complex numbers in the plane.

In the plane a map takes x to a x + b conj(x): every real 2 x 2 matrix is one such pair, and the pairs multiply,
invert and act by a few products of complex numbers. What a function returns on the line is a float, in the plane the
pair (a, b). An array of maps keeps each in two places, the second unused on the line.
"""

from __future__ import annotations

from typing import Any

from frictionlab.compile.dispatch import by_dimension

Block = tuple[complex, complex]


block = by_dimension(
    lambda blocks, place, like: blocks[2 * place],
    lambda blocks, place, like: (blocks[2 * place], blocks[2 * place + 1]),
)
"""block(blocks, place, like): the map kept at a place of an array."""


def _keep_on_the_line(blocks: Any, place: int, matrix: float, like: float) -> None:
    blocks[2 * place] = matrix


def _keep_in_the_plane(blocks: Any, place: int, matrix: Block, like: complex) -> None:
    blocks[2 * place], blocks[2 * place + 1] = matrix


keep = by_dimension(_keep_on_the_line, _keep_in_the_plane)
"""keep(blocks, place, matrix, like): put a map into an array."""


def _applied_in_the_plane(matrix: Block, x: complex) -> complex:
    a, b = matrix
    return a * x + b * x.conjugate()


apply = by_dimension(lambda matrix, x: matrix * x, _applied_in_the_plane)
"""apply(matrix, x): the image of a vector."""


def _product_in_the_plane(left: Block, right: Block, like: complex) -> Block:
    a, b = left
    c, d = right
    return a * c + b * d.conjugate(), a * d + b * c.conjugate()


product = by_dimension(lambda left, right, like: left * right, _product_in_the_plane)
"""product(left, right, like): the map that applies the right one first."""

add = by_dimension(
    lambda left, right, like: left + right, lambda left, right, like: (left[0] + right[0], left[1] + right[1])
)
"""add(left, right, like): the sum of two maps."""

scale = by_dimension(
    lambda factor, matrix, like: factor * matrix,
    lambda factor, matrix, like: (factor * matrix[0], factor * matrix[1]),
)
"""scale(factor, matrix, like): a multiple of a map."""


def _inverse_in_the_plane(matrix: Block, like: complex) -> Block:
    a, b = matrix
    determinant = a.real * a.real + a.imag * a.imag - b.real * b.real - b.imag * b.imag
    share = 1.0 / determinant
    return share * a.conjugate(), -share * b


inverse = by_dimension(lambda matrix, like: 1.0 / matrix, _inverse_in_the_plane)
"""inverse(matrix, like): not finite where the map is singular."""

diagonal = by_dimension(
    lambda mean, split, like: mean + split,
    lambda mean, split, like: (complex(mean, 0.0), complex(split, 0.0)),
)
"""diagonal(mean, split, like): x1 times mean + split, x2 times mean - split."""

multiple = by_dimension(lambda x, like: x, lambda x, like: (complex(x.real, x.imag), complex(0.0, 0.0)))
"""multiple(x, like): the map that multiplies by a number."""


def _from_columns_in_the_plane(first: complex, second: complex) -> Block:
    turned = complex(-second.imag, second.real)  # i times the second
    return 0.5 * (first - turned), 0.5 * (first + turned)


from_columns = by_dimension(lambda first, second: first, _from_columns_in_the_plane)
"""from_columns(first, second): the map that takes 1 to the first and i to the second, which the line leaves out."""
