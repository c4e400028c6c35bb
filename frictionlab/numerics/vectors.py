"""A vector as one number on the line and as two in the plane: how arrays of real numbers keep them.

The last argument, or the number itself, is a float on the line and a complex number in the plane.
"""

from __future__ import annotations

from typing import Any

from frictionlab.compile.dispatch import by_dimension


def _dimension_of_the_line(like: float) -> int:
    return 1


def _dimension_of_the_plane(like: complex) -> int:
    return 2


dimension = by_dimension(_dimension_of_the_line, _dimension_of_the_plane)


def _taken_on_the_line(values: Any, place: int, like: float) -> float:
    return values[place]


def _taken_in_the_plane(values: Any, place: int, like: complex) -> complex:
    return complex(values[2 * place], values[2 * place + 1])


taken = by_dimension(_taken_on_the_line, _taken_in_the_plane)


def _put_on_the_line(values: Any, place: int, number: float) -> None:
    values[place] = number


def _put_in_the_plane(values: Any, place: int, number: complex) -> None:
    values[2 * place], values[2 * place + 1] = number.real, number.imag


put = by_dimension(_put_on_the_line, _put_in_the_plane)


def _unit_on_the_line(column: int, like: float) -> float:
    return 1.0


def _unit_in_the_plane(column: int, like: complex) -> complex:
    return complex(1.0, 0.0) if column == 0 else complex(0.0, 1.0)


unit = by_dimension(_unit_on_the_line, _unit_in_the_plane)
