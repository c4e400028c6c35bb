"""Real-linear maps of one direction or two: a number on the line, a pair of complex numbers in the plane.

In the plane a map takes x to a x + b conj(x): every real 2 x 2 matrix is one such pair, and the pairs multiply,
invert and act by a few products of complex numbers. What a function returns on the line is a float, in the plane the
pair (a, b). An array of maps keeps each in two places, the second unused on the line.
"""

from __future__ import annotations

from typing import Any

from frictionlab.compile.dispatch import by_dimension

Block = tuple[complex, complex]


def _block_on_the_line(blocks: Any, place: int, like: float) -> float:
    return blocks[2 * place]


def _block_in_the_plane(blocks: Any, place: int, like: complex) -> Block:
    return blocks[2 * place], blocks[2 * place + 1]


block = by_dimension(_block_on_the_line, _block_in_the_plane)
"""block(blocks, place, like): the map kept at a place of an array."""


def _keep_on_the_line(blocks: Any, place: int, matrix: float, like: float) -> None:
    blocks[2 * place] = matrix


def _keep_in_the_plane(blocks: Any, place: int, matrix: Block, like: complex) -> None:
    blocks[2 * place], blocks[2 * place + 1] = matrix


keep = by_dimension(_keep_on_the_line, _keep_in_the_plane)
"""keep(blocks, place, matrix, like): put a map into an array."""


def _applied_on_the_line(matrix: float, x: float) -> float:
    return matrix * x


def _applied_in_the_plane(matrix: Block, x: complex) -> complex:
    a, b = matrix
    return a * x + b * x.conjugate()


apply = by_dimension(_applied_on_the_line, _applied_in_the_plane)
"""apply(matrix, x): the image of a vector."""


def _product_on_the_line(left: float, right: float, like: float) -> float:
    return left * right


def _product_in_the_plane(left: Block, right: Block, like: complex) -> Block:
    a, b = left
    c, d = right
    return a * c + b * d.conjugate(), a * d + b * c.conjugate()


product = by_dimension(_product_on_the_line, _product_in_the_plane)
"""product(left, right, like): the map that applies the right one first."""


def _sum_on_the_line(left: float, right: float, like: float) -> float:
    return left + right


def _sum_in_the_plane(left: Block, right: Block, like: complex) -> Block:
    return left[0] + right[0], left[1] + right[1]


add = by_dimension(_sum_on_the_line, _sum_in_the_plane)
"""add(left, right, like): the sum of two maps."""


def _scaled_on_the_line(factor: float, matrix: float, like: float) -> float:
    return factor * matrix


def _scaled_in_the_plane(factor: float, matrix: Block, like: complex) -> Block:
    return factor * matrix[0], factor * matrix[1]


scale = by_dimension(_scaled_on_the_line, _scaled_in_the_plane)
"""scale(factor, matrix, like): a multiple of a map."""


def _inverse_on_the_line(matrix: float, like: float) -> float:
    return 1.0 / matrix


def _inverse_in_the_plane(matrix: Block, like: complex) -> Block:
    a, b = matrix
    determinant = a.real * a.real + a.imag * a.imag - b.real * b.real - b.imag * b.imag
    share = 1.0 / determinant
    return share * a.conjugate(), -share * b


inverse = by_dimension(_inverse_on_the_line, _inverse_in_the_plane)
"""inverse(matrix, like): not finite where the map is singular."""


def _diagonal_on_the_line(mean: float, split: float, like: float) -> float:
    return mean + split


def _diagonal_in_the_plane(mean: float, split: float, like: complex) -> Block:
    return complex(mean, 0.0), complex(split, 0.0)


diagonal = by_dimension(_diagonal_on_the_line, _diagonal_in_the_plane)
"""diagonal(mean, split, like): x1 times mean + split, x2 times mean - split."""


def _multiple_on_the_line(x: float, like: float) -> float:
    return x


def _multiple_in_the_plane(x: Any, like: complex) -> Block:
    return complex(x.real, x.imag), complex(0.0, 0.0)


multiple = by_dimension(_multiple_on_the_line, _multiple_in_the_plane)
"""multiple(x, like): the map that multiplies by a number."""


def _from_columns_on_the_line(first: float, second: float) -> float:
    return first


def _from_columns_in_the_plane(first: complex, second: complex) -> Block:
    turned = complex(-second.imag, second.real)  # i times the second
    return 0.5 * (first - turned), 0.5 * (first + turned)


from_columns = by_dimension(_from_columns_on_the_line, _from_columns_in_the_plane)
"""from_columns(first, second): the map that takes 1 to the first and i to the second, which the line leaves out."""
