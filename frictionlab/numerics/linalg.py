"""Vectors and matrices of a few numbers, inside kernels."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frictionlab.compile.decorators import inner


@inner
def norm(z: Any) -> float:
    """The Euclidean norm."""
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
def add_product(factor: float, left: Any, right: Any, out: Any) -> None:
    """Add so many times the product of two square matrices to ``out``, another one."""
    n = left.shape[0]
    for row in range(n):
        for k in range(n):
            for column in range(n):
                out[row, column] = out[row, column] + factor * left[row, k] * right[k, column]


@inner
def invert(matrix: Any, inverse: Any) -> bool:
    """Gauss-Jordan elimination with row pivots; False where the matrix is singular to rounding."""
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
    """Gaussian elimination with row pivots, in place of both; the result is not finite for a singular matrix."""
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
    """Gaussian elimination with partial pivoting: ``right`` [n, columns] becomes the solution, in place."""
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
"""Of a matrix, for the bound on its spectral radius: the 64th root of its 64th power's norm is at most a few percent
too large."""


@inner
def radius_bound(matrix: Any) -> float:
    """A number no smaller than the largest modulus of the eigenvalues (Gelfand's formula); infinite or NaN where
    powers overflow."""
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
