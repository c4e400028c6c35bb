"""Derivative of the period map by difference quotients."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.methods.periodic.period_map import size_of_deviation
from frictionlab.methods.periodic.setting import (
    Setting,
    SpanImage,
    kept_map,
    period_map,
    repeated_map,
    scales_of,
)
from frictionlab.motion.equation import mean_friction
from frictionlab.motion.linalg import invert
from frictionlab.motion.maps.case import MOST_KEPT, Pace, pace_of

OF_LOGARITHM = 1e-3
"""Largest shift of the logarithm of a scalar."""


@inner
def _shift(setting: Setting, z: Any, relative: float, column: int) -> float:
    """Choose a shift below the way the belt moves in a period: that much slip ends a period that was all stick."""
    carried = abs(setting.belt_speed) * scales_of(setting).period
    # Large against the error of the maps, small against the way of the belt, on which the pattern of events hangs.
    shift, scalars = relative * size_of_deviation(setting.maps.per_drive.normal_load, z), setting.maps.scalars
    if scalars.first <= column < scalars.end:
        return min(shift, OF_LOGARITHM * scalars.unit)
    return min(shift, max(0.01 * carried, 1e-3 * shift)) if carried > 0.0 else shift


@inner
def _by_central_quotients(setting: Setting, z: Any, asked: float, matrix: Any, gradient: Any) -> None:
    """2 n maps, at least as accurate as asked, and always much finer than the shift."""
    n, relative = z.size, setting.maps.orders.shift
    ahead, behind, trial = np.empty(n), np.empty(n), np.empty(n)
    for column in range(n):
        shift = _shift(setting, z, relative, column)
        accuracy = min(asked, relative * shift)
        for row in range(n):
            trial[row] = z[row] + (shift if row == column else 0.0)
        # Central differences: the map bends where the mass sticks, and one-sided ones would be of first order.
        above = period_map(setting, trial, ahead, accuracy)
        trial[column] = z[column] - shift
        below = period_map(setting, trial, behind, accuracy)
        gradient[column] = mean_friction(
            above.friction_impulse - below.friction_impulse, scales_of(setting).period
        ) / (2.0 * shift)
        for row in range(n):
            matrix[row, column] = (ahead[row] - behind[row]) / (2.0 * shift) + (1.0 if row == column else 0.0)


class PacedMap(NamedTuple):
    """A map whose steps are kept: its accuracy, the residual it left."""

    image: SpanImage
    residual: Any
    pace: Pace
    accuracy: float


@inner
def _accuracy_over_steps(setting: Setting, z: Any) -> float:
    return setting.maps.orders.kept_accuracy * size_of_deviation(setting.maps.per_drive.normal_load, z)


@inner
def _over_its_steps(setting: Setting, z: Any, base: PacedMap, matrix: Any, gradient: Any) -> bool:
    """n maps; False where the shift changes the events."""
    ahead, trial = np.empty(z.size), z.copy()
    if base.image.steps < 0 or base.pace.taken[0] > MOST_KEPT:
        return False
    for column in range(z.size):
        shift = _shift(setting, z, setting.maps.orders.kept_shift, column)
        trial[column] = z[column] + shift
        moved = repeated_map(setting, trial, ahead, base.accuracy, base.pace)
        trial[column] = z[column]
        if moved.steps < 0:
            return False
        gradient[column] = (
            mean_friction(moved.friction_impulse - base.image.friction_impulse, scales_of(setting).period)
            / shift
        )
        for row in range(z.size):
            same = 1.0 if row == column else 0.0
            matrix[row, column] = (ahead[row] - base.residual[row]) / shift + same
    return True


@inner
def _over_the_same_steps(setting: Setting, z: Any, accuracy: float, matrix: Any, gradient: Any) -> None:
    """n + 1 maps, or 2 n more where a shift changes the events."""
    residual, pace, accuracy = (
        np.empty(z.size),
        pace_of(MOST_KEPT),
        min(accuracy, _accuracy_over_steps(setting, z)),
    )
    base = PacedMap(kept_map(setting, z, residual, accuracy, pace), residual, pace, accuracy)
    if not _over_its_steps(setting, z, base, matrix, gradient):
        _by_central_quotients(setting, z, accuracy, matrix, gradient)


@inner
def monodromy(setting: Setting, z: Any, accuracy: float, matrix: Any, gradient: Any) -> None:
    """Write the derivatives of the period map [n, n] and of the mean friction [n] by difference quotients."""
    if setting.maps.remembers:
        _over_the_same_steps(setting, z, accuracy, matrix, gradient)
    else:
        _by_central_quotients(setting, z, accuracy, matrix, gradient)


@inner
def monodromy_of(setting: Setting, z: Any, base: PacedMap, matrix: Any, gradient: Any) -> int:
    """Return the same for a law with memory and a state whose map is known; the maps it took."""
    n, enough = z.size, _accuracy_over_steps(setting, z)
    # one map less, where steps are not many more than they need be
    suits = 0.1 * enough <= base.accuracy <= enough
    if suits and _over_its_steps(setting, z, base, matrix, gradient):
        return n
    monodromy(setting, z, 1.0, matrix, gradient)
    return n + 1


@inner
def newton_inverse(setting: Setting, z: Any, accuracy: float, inverse: Any) -> bool:
    """Leave the inverse of (monodromy - identity) in inverse; False where the matrix is singular."""
    matrix, gradient = np.empty((z.size, z.size)), np.empty(z.size, np.complex128)
    monodromy(setting, z, accuracy, matrix, gradient)
    return inverse_of(matrix, inverse)


@inner
def inverse_of(matrix: Any, inverse: Any) -> bool:
    """Leave the inverse of (matrix - identity) in inverse; False where that is singular."""
    # Newton solves (M - I) step = state - image.
    shifted = matrix.copy()
    for row in range(matrix.shape[0]):
        shifted[row, row] = shifted[row, row] - 1.0
    return invert(shifted, inverse)
