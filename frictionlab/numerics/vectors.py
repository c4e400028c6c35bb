"""A vector as one number on the line and as two in the plane: how arrays of real numbers keep them.

The last argument, or the number itself, is a float on the line and a complex number in the plane.
"""

from __future__ import annotations

from typing import Any

from frictionlab.compile.dispatch import by_dimension

dimension = by_dimension(lambda like: 1, lambda like: 2)

taken = by_dimension(
    lambda values, place, like: values[place],
    lambda values, place, like: complex(values[2 * place], values[2 * place + 1]),
)


def _put_on_the_line(values: Any, place: int, number: float) -> None:
    values[place] = number


def _put_in_the_plane(values: Any, place: int, number: complex) -> None:
    values[2 * place], values[2 * place + 1] = number.real, number.imag


put = by_dimension(_put_on_the_line, _put_in_the_plane)

unit = by_dimension(
    lambda column, like: 1.0, lambda column, like: complex(1.0, 0.0) if column == 0 else complex(0.0, 1.0)
)
