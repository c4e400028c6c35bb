"""Vectors, matrices and real-linear maps of a few numbers, for kernels.

Arrays of real numbers hold a vector as one number on the line and as two in the plane. The last argument, or
the number itself, tells which: it is a float on the line and complex in the plane.

A real-linear map of x is a number on the line and a pair of complex numbers (a, b) in the plane, where it
takes x to a x + b conj(x). Every real 2 x 2 matrix is one such pair, and pairs multiply, invert and act by a
few products of complex numbers. An array of maps holds each in two places, the second unused on the line.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension

dimension = by_dimension(lambda zero: 1, lambda zero: 2)

taken = by_dimension(
    lambda values, place, zero: values[place],
    lambda values, place, zero: complex(values[2 * place], values[2 * place + 1]),
)


def _put_on_the_line(values: Any, place: int, number: float) -> None:
    values[place] = number


def _put_in_the_plane(values: Any, place: int, number: complex) -> None:
    values[2 * place], values[2 * place + 1] = number.real, number.imag


put = by_dimension(_put_on_the_line, _put_in_the_plane)

unit = by_dimension(
    lambda column, zero: 1.0, lambda column, zero: complex(1.0, 0.0) if column == 0 else complex(0.0, 1.0)
)


@inner
def norm(z: Any) -> float:
    """Return the Euclidean norm."""
    total = 0.0
    for value in z:
        total += value * value
    return math.sqrt(total)


@inner
def multiply(matrix: Any, z: Any, out: Any) -> None:
    """Write the product of a matrix and a vector to ``out``."""
    for row in range(z.size):
        total = 0.0
        for column in range(z.size):
            total += matrix[row, column] * z[column]
        out[row] = total


@inner
def invert(matrix: Any, inverse: Any) -> bool:
    """Write the inverse by Gauss-Jordan elimination with row pivots.

    Return False for a matrix that is singular to rounding.
    """
    n = matrix.shape[0]
    work = matrix.copy()
    for row in range(n):
        for column in range(n):
            inverse[row, column] = 1.0 if row == column else 0.0
    for pivot in range(n):
        # Row pivoting: the largest element of the column, below 1e-9 only for a matrix singular to rounding.
        best = pivot
        for row in range(pivot + 1, n):
            if abs(work[row, pivot]) > abs(work[best, pivot]):
                best = row
        if not abs(work[best, pivot]) > 1e-9:
            return False
        for column in range(n):
            work[pivot, column], work[best, column] = work[best, column], work[pivot, column]
            inverse[pivot, column], inverse[best, column] = inverse[best, column], inverse[pivot, column]
        scale = 1.0 / work[pivot, pivot]
        for column in range(n):
            work[pivot, column] = work[pivot, column] * scale
            inverse[pivot, column] = inverse[pivot, column] * scale
        # Eliminate the column in all other rows, above the pivot too: no back substitution is needed.
        for row in range(n):
            if row != pivot:
                factor = work[row, pivot]
                for column in range(n):
                    work[row, column] = work[row, column] - factor * work[pivot, column]
                    inverse[row, column] = inverse[row, column] - factor * inverse[pivot, column]
    return True


@inner
def solve_linear(matrix: Any, right: Any) -> None:
    """Solve a linear system by Gaussian elimination with row pivots, in place of both arguments.

    The result is not finite for a singular matrix.
    """
    n = right.size
    for pivot in range(n):
        best = pivot
        for row in range(pivot + 1, n):
            if abs(matrix[row, pivot]) > abs(matrix[best, pivot]):
                best = row
        if best != pivot:
            right[pivot], right[best] = right[best], right[pivot]
            for column in range(n):
                matrix[pivot, column], matrix[best, column] = matrix[best, column], matrix[pivot, column]
        # Below the pivot alone: what is above it is left to back substitution.
        for row in range(pivot + 1, n):
            factor = matrix[row, pivot] / matrix[pivot, pivot]
            right[row] = right[row] - factor * right[pivot]
            for column in range(pivot + 1, n):
                matrix[row, column] = matrix[row, column] - factor * matrix[pivot, column]
    for row in range(n - 1, -1, -1):
        for column in range(row + 1, n):
            right[row] = right[row] - matrix[row, column] * right[column]
        right[row] = right[row] / matrix[row, row]


@inner
def eliminate(matrix: Any, right: Any) -> None:
    """Solve for ``right`` [n, columns] in place, by Gaussian elimination with partial pivoting."""
    n, columns = matrix.shape[0], right.shape[1]
    # Row pivots: an implicit step over a stiff layer has rows of very different size.
    for k in range(n):
        pivot = k
        for row in range(k + 1, n):
            if abs(matrix[row, k]) > abs(matrix[pivot, k]):
                pivot = row
        if pivot != k:
            for column in range(n):
                matrix[k, column], matrix[pivot, column] = matrix[pivot, column], matrix[k, column]
            for column in range(columns):
                right[k, column], right[pivot, column] = right[pivot, column], right[k, column]
        for row in range(k + 1, n):
            factor = matrix[row, k] / matrix[k, k]
            if factor != 0.0:
                for column in range(k + 1, n):
                    matrix[row, column] -= factor * matrix[k, column]
                for column in range(columns):
                    right[row, column] -= factor * right[k, column]
    # Back substitution, a right side at a time.
    for column in range(columns):
        for row in range(n - 1, -1, -1):
            total = right[row, column]
            for k in range(row + 1, n):
                total -= matrix[row, k] * right[k, column]
            right[row, column] = total / matrix[row, row]


SQUARINGS = 6
"""Squarings of a matrix for the bound on its spectral radius. The 64th root of the norm of its 64th power is
at most a few percent too large."""


@inner
def radius_bound(matrix: Any) -> float:
    """Return a number no smaller than the largest modulus of the eigenvalues (Gelfand's formula).

    It is infinite or NaN where powers overflow.
    """
    n = matrix.shape[0]
    power, square = matrix.copy(), np.empty((n, n))
    for _ in range(SQUARINGS):
        for row in range(n):
            for column in range(n):
                total = 0.0
                for k in range(n):
                    total += power[row, k] * power[k, column]
                square[row, column] = total
        power, square = square, power
    largest = 0.0
    for row in range(n):
        largest = math.hypot(largest, norm(power[row]))
    return largest ** (1.0 / 2.0**SQUARINGS)


@inner
def subtract(z: Any, step: Any, out: Any) -> None:
    """Write z - step to ``out``."""
    for i in range(z.size):
        out[i] = z[i] - step[i]


@inner
def copy(source: Any, out: Any) -> None:
    """Write a vector to ``out``; a slice assignment would take seconds to compile."""
    for i in range(source.size):
        out[i] = source[i]


Block = tuple[complex, complex]


block = by_dimension(
    lambda blocks, place, zero: blocks[2 * place],
    lambda blocks, place, zero: (blocks[2 * place], blocks[2 * place + 1]),
)
"""block(blocks, place, zero): map at a place of an array."""


def _keep_on_the_line(blocks: Any, place: int, matrix: float, zero: float) -> None:
    blocks[2 * place] = matrix


def _keep_in_the_plane(blocks: Any, place: int, matrix: Block, zero: complex) -> None:
    blocks[2 * place], blocks[2 * place + 1] = matrix


keep = by_dimension(_keep_on_the_line, _keep_in_the_plane)
"""keep(blocks, place, matrix, zero): write a map to a place of an array."""


def _applied_in_the_plane(matrix: Block, x: complex) -> complex:
    a, b = matrix
    return a * x + b * x.conjugate()


apply = by_dimension(lambda matrix, x: matrix * x, _applied_in_the_plane)
"""apply(matrix, x): image of a vector."""


def _product_in_the_plane(left: Block, right: Block, zero: complex) -> Block:
    a, b = left
    c, d = right
    return a * c + b * d.conjugate(), a * d + b * c.conjugate()


product = by_dimension(lambda left, right, zero: left * right, _product_in_the_plane)
"""product(left, right, zero): map that applies the right one first."""

add = by_dimension(
    lambda left, right, zero: left + right, lambda left, right, zero: (left[0] + right[0], left[1] + right[1])
)
"""add(left, right, zero): sum of two maps."""

scale = by_dimension(
    lambda factor, matrix, zero: factor * matrix,
    lambda factor, matrix, zero: (factor * matrix[0], factor * matrix[1]),
)
"""scale(factor, matrix, zero): multiple of a map."""


def _inverse_in_the_plane(matrix: Block, zero: complex) -> Block:
    a, b = matrix
    determinant = a.real * a.real + a.imag * a.imag - b.real * b.real - b.imag * b.imag
    share = 1.0 / determinant
    return share * a.conjugate(), -share * b


inverse = by_dimension(lambda matrix, zero: 1.0 / matrix, _inverse_in_the_plane)
"""inverse(matrix, zero): inverse map; not finite where the map is singular."""

diagonal = by_dimension(
    lambda mean, split, zero: mean + split,
    lambda mean, split, zero: (complex(mean, 0.0), complex(split, 0.0)),
)
"""diagonal(mean, split, zero): map that multiplies x1 by mean + split and x2 by mean - split."""

multiple = by_dimension(lambda x, zero: x, lambda x, zero: (complex(x.real, x.imag), complex(0.0, 0.0)))
"""multiple(x, zero): map that multiplies by a number."""


def _from_columns_in_the_plane(first: complex, second: complex) -> Block:
    turned = complex(-second.imag, second.real)  # i times the second
    return 0.5 * (first - turned), 0.5 * (first + turned)


from_columns = by_dimension(lambda first, second: first, _from_columns_in_the_plane)
"""from_columns(first, second): map that takes 1 to the first and i to the second, which the line leaves
out."""
