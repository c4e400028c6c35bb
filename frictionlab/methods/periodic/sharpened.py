"""The largest multipliers of motions, by central differences of fine maps along their directions, and their error.

A monodromy by one-sided quotients knows a multiplier to 1e-6 or 1e-5 (its shift, times the bend of the map), and
where maps are coarse to 1e-3. With its eigenvectors w and v, w v = 1, the multiplier of the exact derivative P' is
w P' v but for the square of that error: two fine maps, of states shifted along v and against it, or four for a
complex pair. What changes by that is the error of the first, and more than that of the second. Where the map has a
kink within the shift, quotients over different shifts differ by a part of its jump: no number is then the multiplier.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.compile.interpret import interpreted
from frictionlab.methods.periodic.period_map import size_of_deviation
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.values.quantities import Floats

_SHIFT = 1e-5
"""Of the size of a state."""
_SAFETY = 2.0
_LEAST = 1e-8
"""Of rounding and the maps' own error, over the shift."""
_WORST_ANGLE = 1e3
"""Product of the lengths of the eigenvectors above which the first-order change of their multiplier says nothing."""
_KINK = 1e-3
"""Change, of the multiplier and at least a hundredth, that only a map without a derivative explains."""


class ClosedMotion(NamedTuple):
    """A closed orbit: its belt speed, its state and its monodromy by quotients."""

    belt_speed: float
    state: Floats
    matrix: Floats


class Multiplier(NamedTuple):
    """The largest modulus and the bound on its error; reason: why both are NaN, '' where they are not."""

    modulus: float
    error: float
    reason: str = ""


class _Direction(NamedTuple):
    """The largest multiplier by quotients, and its eigenvectors; left: None where that is too long."""

    rough: float
    right: NDArray[np.complex128]
    left: NDArray[np.complex128] | None


def sharpened(problem: PeriodicProblem, motions: Sequence[ClosedMotion]) -> list[Multiplier]:
    """The largest multiplier of each, over one period of all that changes in time."""
    if not motions:
        return []
    directions = [_direction_of(each.matrix) for each in motions]
    # the two parts of a complex direction, each ahead and behind
    ways = np.array([[each.right.real, each.right.imag] for each in directions])
    sizes = np.linalg.norm(ways, axis=2)
    shifts = np.array([_shift_along(problem, each) for each in motions])[:, None] / np.where(
        sizes > 0.0, sizes, 1.0
    )
    asked = [(i, k, side) for i, k in np.argwhere(sizes > 0.0).tolist() for side in (1.0, -1.0)]
    starts = np.array([motions[i].state + side * shifts[i, k] * ways[i, k] for i, k, side in asked])
    ends = problem.mapped(np.array([motions[i].belt_speed for i, _, _ in asked]), starts)
    moved = np.zeros(ways.shape)
    for (i, k, side), end in zip(asked, ends, strict=True):
        moved[i, k] += side * end / (2.0 * shifts[i, k])
    return [_judged(each, parts[0] + 1j * parts[1]) for each, parts in zip(directions, moved, strict=True)]


def _direction_of(matrix: Floats) -> _Direction:
    values, vectors = np.linalg.eig(matrix)
    k = int(np.abs(values).argmax())
    rough, right = float(abs(values[k])), vectors[:, k].astype(np.complex128)
    try:
        left = np.linalg.inv(vectors)[k].astype(np.complex128)
    except np.linalg.LinAlgError:
        return _Direction(rough, right, None)
    return _Direction(rough, right, left if np.linalg.norm(left) < _WORST_ANGLE else None)


def _judged(direction: _Direction, moved: NDArray[np.complex128]) -> Multiplier:
    """moved: the derivative of the map along the direction."""
    rough = direction.rough
    if direction.left is None:
        return Multiplier(
            math.nan, math.nan, f"no multiplier: two of modulus {rough:.3g} are hardly told apart"
        )
    fine = float(abs(direction.left @ moved))
    change = abs(fine - rough)
    if not change <= _KINK * max(fine, 1e-2):
        why = f"over two shifts its quotients give {rough:.4g} and {fine:.4g}"
        return Multiplier(math.nan, math.nan, f"no multiplier: the period map has no derivative here; {why}")
    return Multiplier(fine, _SAFETY * change + _LEAST)


def _shift_along(problem: PeriodicProblem, motion: ClosedMotion) -> float:
    """Below the way the belt moves in a period, on which the pattern of events hangs."""
    usual = _SHIFT * float(interpreted(size_of_deviation)(problem.mass.normal_load, motion.state))
    way = abs(motion.belt_speed) * 2.0 * math.pi / problem.mass.frequency
    return min(usual, max(0.01 * way, 1e-3 * usual))
