"""Rodas5P: a Rosenbrock method of order 5 for stiff systems, L-stable and stiffly accurate, in eight stages.

Steinebach (2023), BIT Numer. Math. 63, 27. In the form of Hairer & Wanner (1996), Sec. IV.7, without products of the
Jacobian: W k_i = f(t + c_i h, y + sum a_ij k_j) + h d_i f_t + sum c_ij k_j / h with W = 1/(gamma h) - f_y; the
eighth increment is the difference to the embedded method of order 4.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from frictionlab.compile.decorators import inner

STAGES = 8
GAMMA = 0.21193756319429014
TIMES = np.array(
    [0.0, 0.6358126895828704, 0.4095798393397535, 0.9769306725060716, 0.4288403609558664, 1.0, 1.0, 1.0]
)
SLOPES = np.array(
    [GAMMA, -0.42387512638858027, -0.3384627126235924, 1.8046452872882734, 2.325825639765069, 0.0, 0.0, 0.0]
)
"""d_i, of the derivative with respect to time."""
_SIXTH = [
    -7.502846399306121,
    2.561846144803919,
    -11.627539656261098,
    -0.18268767659942256,
    0.030198172008377946,
]
INCREMENTS = np.array(
    [
        [0.0] * 8,
        [3.0, *[0.0] * 7],
        [2.849394379747939, 0.45842242204463923, *[0.0] * 6],
        [-6.954028509809101, 2.489845061869568, -10.358996098473584, *[0.0] * 5],
        [2.8029986275628964, 0.5072464736228206, -0.3988312541770524, -0.04721187230404641, *[0.0] * 4],
        [*_SIXTH, 0.0, 0.0, 0.0],
        [*_SIXTH, 1.0, 0.0, 0.0],
        [*_SIXTH, 1.0, 1.0, 0.0],
    ]
)
"""a_ij; the step ends at the eighth argument plus the eighth increment."""
_COUPLINGS = [
    [],
    [-14.155112264123755],
    [-17.97296035885952, -2.859693295451294],
    [147.12150275711716, -1.41221402718213, 71.68940251302358],
    [165.43517024871676, -0.4592823456491126, 42.90938336958603, -5.961986721573306],
    [24.854864614690072, -3.0009227002832186, 47.4931110020768, 5.5814197821558125, -0.6610691825249471],
    [
        *(30.91273214028599, -3.1208243349937974, 77.79954646070892),
        *(34.28646028294783, -19.097331116725623, -28.087943162872662),
    ],
    [
        *(37.80277123390563, -3.2571969029072276, 112.26918849496327),
        *(66.9347231244047, -40.06618937091002, -54.66780262877968, -9.48861652309627),
    ],
]
COUPLINGS = np.array([[*row, *[0.0] * (STAGES - len(row))] for row in _COUPLINGS])
"""c_ij."""


@inner
def factored(matrix: Any, rows: Any) -> None:
    """Replace a small matrix by its LU factors, with row pivots in ``rows``."""
    n = rows.size
    for pivot in range(n):
        best = pivot
        for row in range(pivot + 1, n):
            if abs(matrix[row, pivot]) > abs(matrix[best, pivot]):
                best = row
        # Rows are swapped in full, so the factors and the pivots recorded so far stay consistent.
        rows[pivot] = best
        if best != pivot:
            for column in range(n):
                matrix[pivot, column], matrix[best, column] = matrix[best, column], matrix[pivot, column]
        for row in range(pivot + 1, n):
            factor = matrix[row, pivot] / matrix[pivot, pivot]
            matrix[row, pivot] = factor
            for column in range(pivot + 1, n):
                matrix[row, column] = matrix[row, column] - factor * matrix[pivot, column]


@inner
def solved(matrix: Any, rows: Any, right: Any) -> None:
    """Solve with the factors, in place of the right-hand side."""
    n = rows.size
    # The row swaps of the factorization, then forward and back substitution.
    for pivot in range(n):
        best = rows[pivot]
        if best != pivot:
            right[pivot], right[best] = right[best], right[pivot]
    for row in range(n):
        for column in range(row):
            right[row] = right[row] - matrix[row, column] * right[column]
    for row in range(n - 1, -1, -1):
        for column in range(row + 1, n):
            right[row] = right[row] - matrix[row, column] * right[column]
        right[row] = right[row] / matrix[row, row]
