"""Derivatives by difference quotients: what they are of known functions, and that their errors cover."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from frictionlab.analysis.quotients import CORNER, NO_VALUES, Derivative, derivative
from frictionlab.values.quantities import Floats


def _of(function: Callable[[float], float], low: float = -1e9, noise: float = 1e-15) -> Derivative:
    """By differences of a function that has no values below ``low``, each in error by a little."""
    rng = np.random.default_rng(1)

    def values(offsets: Floats) -> list[Floats | None]:
        return [
            np.array([function(at) + noise * rng.uniform(-1, 1)]) if at >= low else None for at in offsets
        ]

    return derivative(values, np.array([function(0.0)]), 0.05, np.array([noise]))


@pytest.mark.parametrize("noise", [1e-15, 1e-12, 1e-9])
@pytest.mark.parametrize(
    ("function", "slope"),
    [
        (np.exp, 1.0),
        (lambda at: 3.0 * at, 3.0),
        (lambda at: np.sin(40.0 * at), 40.0),
        (lambda at: 2.0 * at + np.sign(at) * at**2, 2.0),  # the second derivative jumps
        (lambda at: at + abs(at - 1e-3), 0.0),  # a corner near by
        (lambda at: at + max(at + 2e-3, 0.0) ** 1.5, 1.0 + 1.5 * 2e-3**0.5),  # as at a grazing near by
    ],
)
def test_the_error_covers(function: Callable[[float], float], slope: float, noise: float) -> None:
    found = _of(function, noise=noise)
    assert found.reason == ""
    assert abs(found.value[0] - slope) <= found.error[0] <= 1e-4 + 1e7 * noise


def test_smooth_functions_are_differentiated_almost_to_rounding() -> None:
    assert _of(np.exp).error[0] < 1e-9


def test_the_end_of_a_range_is_differentiated_from_one_side() -> None:
    found = _of(np.exp, low=0.0)
    assert abs(found.value[0] - 1.0) <= found.error[0] < 1e-8


def test_a_corner_has_no_derivative() -> None:
    found = _of(lambda at: np.exp(at) + 0.01 * abs(at))
    assert np.isnan(found.value[0])
    assert found.reason == CORNER


def test_without_values_there_is_none() -> None:
    assert _of(np.exp, low=1.0).reason == NO_VALUES
