"""The derivative of the period map: without friction in closed form, with friction by difference quotients."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_law
from frictionlab.dynamics.motion import mean_friction, span
from frictionlab.methods.periodic.case import Case
from frictionlab.methods.periodic.maps.pace import MOST_KEPT, Pace, keeping, pace_of, repeating
from frictionlab.methods.periodic.maps.sliding import Mapped
from frictionlab.methods.periodic.period_map import image_of, paced_image
from frictionlab.numerics.linalg import invert, norm
from frictionlab.numerics.vectors import dimension
from frictionlab.scene.body import Body


@inner
def _free_block(damping: float, stiffness: float, period: float, jacobian: Any, at: int) -> None:
    """Monodromy minus identity of one friction-free direction, in the norm of energy."""
    s, half = math.sqrt(stiffness), 0.5 * damping
    square = stiffness - half * half
    root = math.sqrt(abs(square)) * period
    # cosh and sinh are kept from overflow: heavily overdamped, this is only a first guess of the inverse.
    if square > 0.0:
        c, sn = math.cos(root), period * (math.sin(root) / root if root > 0.0 else 1.0)
    else:
        c, sn = (
            math.cosh(min(root, 300.0)),
            period * (math.sinh(min(root, 300.0)) / root if root > 0.0 else 1.0),
        )
    decay = math.exp(-half * period)
    # In the norm of energy, where the map of an undamped mass is a rotation.
    jacobian[at, at] = decay * (c + sn * half) - 1.0
    jacobian[at, at + 1] = decay * sn * s
    jacobian[at + 1, at] = -decay * sn * s
    jacobian[at + 1, at + 1] = decay * (c - sn * half) - 1.0


@inner
def free_inverse(body: Body, rubbing: float, inverse: Any, like: Any) -> None:
    """Inverse of (monodromy - identity) of the body with friction as a dashpot of this coefficient."""
    n, d = inverse.shape[0], dimension(like)
    period = span(body)
    jacobian = np.zeros((n, n))
    damping, stiffness = body.damping_mean + body.damping_split, body.stiffness_mean + body.stiffness_split
    _free_block(damping + rubbing, stiffness, period, jacobian, 0)
    if d == 2:
        damping, stiffness = (
            body.damping_mean - body.damping_split,
            body.stiffness_mean - body.stiffness_split,
        )
        _free_block(damping + rubbing, stiffness, period, jacobian, 2)
    for row in range(2 * d, n):
        jacobian[row, row] = -1.0  # a bristle remembers nothing of a period ago
    invert(jacobian, inverse)


def _shift_without_memory(law: Any, n: int) -> float:
    return 1e-5


def _shift_with_a_bristle(law: Any, n: int) -> float:
    """Bristles never stick: their maps bend less, and cost more."""
    return 1e-4


shift_of = by_law(_shift_without_memory, _shift_with_a_bristle, None, _shift_with_a_bristle)
"""Relative shift of a state for a difference quotient, and accuracy of the maps relative to the shift."""


def _quotient_without_memory(law: Any, like: Any) -> Any:
    return 1e-6, 1e-8


def _quotient_with_memory(law: Any, like: Any) -> Any:
    """Steps of order 5 are many more for finer maps, and where events are found is less exact."""
    return 3e-6, 3e-8


_quotient = by_law(
    _quotient_without_memory, _quotient_with_memory, _quotient_without_memory, _quotient_with_memory
)
"""Over the same steps, where both maps are in error by nearly the same and one-sided quotients will do: the shift of
a state and the accuracy of the maps, relative to its size. What the maps have wrong is wrong in the quotient too."""


@inner
def _shift(case: Case, z: Any, relative: float) -> float:
    """It stays below the way the belt moves in a period: that much slip ends a period that was all stick."""
    carried = abs(case.belt_speed) * span(case.body)
    # Large against the error of the maps, small against the way of the belt, on which the pattern of events hangs.
    shift = relative * (1.0 + norm(z))
    return min(shift, max(0.01 * carried, 1e-3 * shift)) if carried > 0.0 else shift


@inner
def _by_central_quotients(case: Case, z: Any, accuracy: float, matrix: Any, gradient: Any) -> None:
    """2 n maps, at least as accurate as asked, and always much finer than the shift."""
    n, relative = z.size, shift_of(case.law, z.size)
    shift = _shift(case, z, relative)
    accuracy = min(accuracy, relative * shift)
    ahead, behind, trial = np.empty(n), np.empty(n), np.empty(n)
    for column in range(n):
        for row in range(n):
            trial[row] = z[row] + (shift if row == column else 0.0)
        # Central differences: the map bends where the mass sticks, and one-sided ones would be of first order.
        above = image_of(case, trial, ahead, accuracy)
        trial[column] = z[column] - shift
        below = image_of(case, trial, behind, accuracy)
        gradient[column] = mean_friction(above.friction_impulse - below.friction_impulse, span(case.body)) / (
            2.0 * shift
        )
        for row in range(n):
            matrix[row, column] = (ahead[row] - behind[row]) / (2.0 * shift) + (1.0 if row == column else 0.0)


def _central(case: Case, z: Any, accuracy: float, matrix: Any, gradient: Any) -> None:
    _by_central_quotients(case, z, accuracy, matrix, gradient)


class PacedMap(NamedTuple):
    """A map whose steps are kept: its accuracy, the residual it left."""

    image: Mapped
    residual: Any
    pace: Pace
    accuracy: float


@inner
def _accuracy_over_steps(case: Case, z: Any) -> float:
    _relative, fine = _quotient(case, case.like)
    return fine * (1.0 + norm(z))


@inner
def _over_its_steps(case: Case, z: Any, base: PacedMap, matrix: Any, gradient: Any) -> bool:
    """n maps; False where the shift changes the events."""
    (relative, _fine), ahead, trial = _quotient(case, case.like), np.empty(z.size), z.copy()
    shift = _shift(case, z, relative)
    if base.image.steps < 0 or base.pace.taken[0] > MOST_KEPT:
        return False
    for column in range(z.size):
        trial[column] = z[column] + shift
        moved = paced_image(case, trial, ahead, repeating(base.accuracy, base.pace))
        trial[column] = z[column]
        if moved.steps < 0:
            return False
        gradient[column] = (
            mean_friction(moved.friction_impulse - base.image.friction_impulse, span(case.body)) / shift
        )
        for row in range(z.size):
            same = 1.0 if row == column else 0.0
            matrix[row, column] = (ahead[row] - base.residual[row]) / shift + same
    return True


def _over_the_same_steps(case: Case, z: Any, accuracy: float, matrix: Any, gradient: Any) -> None:
    """n + 1 maps, or 2 n more where a shift changes the events."""
    residual, pace, accuracy = (
        np.empty(z.size),
        pace_of(MOST_KEPT),
        min(accuracy, _accuracy_over_steps(case, z)),
    )
    base = PacedMap(paced_image(case, z, residual, keeping(accuracy, pace)), residual, pace, accuracy)
    if not _over_its_steps(case, z, base, matrix, gradient):
        _by_central_quotients(case, z, accuracy, matrix, gradient)


monodromy = by_law(_central, _over_the_same_steps, None, _over_the_same_steps)
"""monodromy(case, z, accuracy, matrix, gradient): the derivatives of the period map [n, n] and of the mean friction
[n] by difference quotients."""


@inner
def monodromy_of(case: Case, z: Any, base: PacedMap, matrix: Any, gradient: Any) -> int:
    """The same for a law with memory and a state whose map is known; the maps it took."""
    n, enough = z.size, _accuracy_over_steps(case, z)
    # one map less, where steps are not many more than they need be
    suits = 0.1 * enough <= base.accuracy <= enough
    if suits and _over_its_steps(case, z, base, matrix, gradient):
        return n
    monodromy(case, z, 1.0, matrix, gradient)
    return n + 1


@inner
def newton_inverse(case: Case, z: Any, accuracy: float, inverse: Any) -> bool:
    """Leave the inverse of (monodromy - identity) in inverse; False where the matrix is singular."""
    matrix, gradient = np.empty((z.size, z.size)), np.empty(z.size, np.complex128)
    monodromy(case, z, accuracy, matrix, gradient)
    return inverse_of(matrix, inverse)


@inner
def inverse_of(matrix: Any, inverse: Any) -> bool:
    """Leave the inverse of (matrix - identity) in inverse; False where that is singular."""
    # Newton solves (M - I) step = state - image.
    shifted = matrix.copy()
    for row in range(matrix.shape[0]):
        shifted[row, row] = shifted[row, row] - 1.0
    return invert(shifted, inverse)
