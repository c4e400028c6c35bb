"""Five-stage Radau IIA collocation of a deflection under a prescribed slip, one step (order 9, L-stable).

The unknowns are the increments of the deflection at the stages, so that small changes of a soft contact keep
their digits. The last stage is the end of the step, so that rounding of a stiff contact does not grow (Hairer
& Wanner, Solving Ordinary Differential Equations II, 1996, sections IV.5 and IV.8).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension
from frictionlab.motion.contact import resistance
from frictionlab.motion.linalg import eliminate
from frictionlab.values.quantities import Floats

STAGES = 5
MOST_ITERATIONS = 12


def _radau() -> tuple[Floats, Floats]:
    """Return nodes in (0, 1] and the matrix that integrates the polynomial through them from 0 to each."""
    legendre = np.polynomial.legendre.Legendre.basis
    # The nodes of Radau IIA are the zeros of P_s - P_(s-1), the right end 1 among them: it is divided out.
    inside = (legendre(STAGES) - legendre(STAGES - 1)) // np.polynomial.Polynomial([-1.0, 1.0]).convert(
        kind=np.polynomial.Legendre
    )
    nodes = np.concatenate((0.5 * (1.0 + np.sort(inside.roots().real)), [1.0]))
    # Row i integrates every monomial up to node i; the inverse turns values at the nodes into monomials.
    powers = np.arange(STAGES)
    values = nodes[:, None] ** powers
    sums = nodes[:, None] ** (powers + 1) / (powers + 1)
    return nodes, sums @ np.linalg.inv(values)


NODES, MATRIX = _radau()
WEIGHTS: Floats = MATRIX[-1].copy()


class Oscillation(NamedTuple):
    """Prescribed oscillation, with velocities Im(phasor exp(i angle))."""

    along: complex
    across: complex
    frequency: float


class Place(NamedTuple):
    """Start of a stretch of the period: its angle, and the slip velocity there."""

    angle: float
    slip: complex


class Scale(NamedTuple):
    """Units of numbers: deflection [length] for differences, and for changes; friction coefficient.

    circle: > 0 for a yielding deflection that moves along its circle, 0 for one that follows the slip, < 0
    for the rate of the law.
    """

    reach: float
    change: float
    friction: float
    circle: float


class Bristle(NamedTuple):
    """Bristle under a prescribed slip: its law, the slip, and the units of its numbers."""

    law: Any
    slip: Oscillation
    scale: Scale


class PanelRoom(NamedTuple):
    """Arrays for one panel: increments, slips, rates and frictions of the stages, and the linear system."""

    gain: Any
    slip: Any
    rate: Any
    friction: Any
    slope: Any
    matrix: Any
    right: Any
    carry: Any


@inner
def slip_in_the_plane(slip: Oscillation, place: Place, angle: float) -> complex:
    """Return the slip velocity this angle after a place, accurate to rounding of the change since there."""
    # A difference of sines as a product: near rest the slip keeps its digits.
    turn = place.angle + 0.5 * angle
    swing = complex(math.cos(turn), math.sin(turn)) * (2.0 * math.sin(0.5 * angle))
    return place.slip + complex((slip.along * swing).real, (slip.across * swing).real)


def _slip_on_the_line(slip: Oscillation, place: Place, angle: float, z: float) -> float:
    return slip_in_the_plane(slip, place, angle).real


def _slip_in_the_plane(slip: Oscillation, place: Place, angle: float, z: complex) -> complex:
    return slip_in_the_plane(slip, place, angle)


def _parts_on_the_line(z: float) -> int:
    return 1


def _parts_in_the_plane(z: complex) -> int:
    return 2


def _part_on_the_line(which: int, z: float) -> float:
    return z


def _part_in_the_plane(which: int, z: complex) -> float:
    return z.real if which == 0 else z.imag


def _made_on_the_line(first: float, second: float, z: float) -> float:
    return first


def _made_in_the_plane(first: float, second: float, z: complex) -> complex:
    return complex(first, second)


def _bound_on_the_line(law: Any, v: float, circle: float, z: float) -> Any:
    return resistance(law, v, z)


def _bound_in_the_plane(law: Any, v: complex, circle: float, z: complex) -> Any:
    if circle < 0.0:
        return resistance(law, v, z)
    dz = v
    if circle > 0.0:
        # along the circle, and back to it from wherever rounding has put the deflection
        dz = v - ((v.real * z.real + v.imag * z.imag) / (circle * circle)) * z
    return dz, law.friction(v, z, dz)


slip_at = by_dimension(_slip_on_the_line, _slip_in_the_plane)
"""slip_at(slip, place, angle, z): slip velocity as the law takes it, at this angle after the place; z gives
the type."""
parts = by_dimension(_parts_on_the_line, _parts_in_the_plane)
part = by_dimension(_part_on_the_line, _part_in_the_plane)
made = by_dimension(_made_on_the_line, _made_in_the_plane)
bound = by_dimension(_bound_on_the_line, _bound_in_the_plane)
"""bound(law, v, circle, z): rate of deflection and friction. circle: negative for the law's own rate, 0 for a
deflection that follows the slip, positive for one that moves along a circle."""


@inner
def work_for(z: Any) -> PanelRoom:
    """Return arrays for panels of this kind of deflection."""
    n = parts(z)
    size = STAGES * n
    kind = np.full(STAGES, z)
    return PanelRoom(
        kind,
        kind.copy(),
        kind.copy(),
        kind.copy(),
        np.empty((STAGES, n, n)),
        np.empty((size, size)),
        np.empty((size, n + 1)),
        np.eye(n),
    )


@inner
def _evaluate(bristle: Bristle, z: Any, work: PanelRoom) -> None:
    """Write rates and frictions at the stages, and slopes of the rates by differences.

    Differences are taken towards more load: the rate of bristles that unload elastically jumps where
    unloading begins.
    """
    law, scale = bristle.law, bristle.scale
    n, small = parts(z), 1e-7 * scale.reach
    for stage in range(STAGES):
        v, here = work.slip[stage], z + work.gain[stage]
        rate, friction = bound(law, v, scale.circle, here)
        work.rate[stage], work.friction[stage] = rate, friction
        # The step of the difference is a share of the reach, so that soft and stiff contacts keep as many digits.
        for column in range(n):
            loads = -small if part(column, v) < 0.0 else small
            nudge = made(loads, 0.0, z) if column == 0 else made(0.0, loads, z)
            moved, _ = bound(law, v, scale.circle, here + nudge)
            for row in range(n):
                work.slope[stage, row, column] = part(row, moved - rate) / loads


@inner
def _assemble(width: float, n: int, work: PanelRoom) -> None:
    """Write identity - width * (integration matrix) x (slopes) to the matrix of the linear system."""
    for i in range(STAGES):
        for j in range(STAGES):
            for row in range(n):
                for column in range(n):
                    same = 1.0 if i == j and row == column else 0.0
                    slope = work.slope[j, row, column]
                    work.matrix[i * n + row, j * n + column] = same - width * MATRIX[i, j] * slope


@inner
def solve_panel(bristle: Bristle, place: Place, span: Any, z: Any, work: PanelRoom) -> bool:
    """Fill ``work`` with the step over span = (angle after the place, width) from ``z``.

    Return False if it fails. ``carry`` becomes the derivative of the deflection at the end with respect to
    that at the start.
    """
    slip, scale = bristle.slip, bristle.scale
    n, width = parts(z), span[1] / slip.frequency
    for stage in range(STAGES):
        work.slip[stage] = slip_at(slip, place, span[0] + NODES[stage] * span[1], z)
        work.gain[stage] = 0.0 * z
    # Newton's method with new slopes each time: rates bend within a layer of yield.
    for turn in range(MOST_ITERATIONS):
        _evaluate(bristle, z, work)
        _assemble(width, n, work)
        _residuals(width, n, work)
        eliminate(work.matrix, work.right)
        change, size = 0.0, 0.0
        for stage in range(STAGES):
            first = work.right[stage * n, 0]
            second = work.right[stage * n + n - 1, 0]
            step = made(first, second, z)
            # The unknowns are gains, not deflections: small changes of a soft contact keep their digits.
            work.gain[stage] = work.gain[stage] + step
            change, size = max(change, abs(step)), max(size, abs(work.gain[stage]))
        # A singular matrix gives an infinite or undefined correction.
        if not change < 1e300:
            return False
        # Converged; after three iterations corrections of rounding size are accepted more readily.
        rounding = (4e-15 if turn < 3 else 5e-14) * scale.change
        if change <= max(1e-8 * size, rounding):
            # Rates and frictions once more at the solution, and its derivative from the last system.
            _evaluate(bristle, z, work)
            _derivative(n, work)
            return True
    return False


@inner
def _residuals(width: float, n: int, work: PanelRoom) -> None:
    """Write the right sides: residuals of the stages, and the effect of the start."""
    for i in range(STAGES):
        lack = -work.gain[i]
        for j in range(STAGES):
            lack = lack + width * MATRIX[i, j] * work.rate[j]
        # First column: what the stages lack. The others: how the start moves each of them.
        for row in range(n):
            work.right[i * n + row, 0] = part(row, lack)
            for column in range(n):
                total = 0.0
                for j in range(STAGES):
                    total += width * MATRIX[i, j] * work.slope[j, row, column]
                work.right[i * n + row, 1 + column] = total


@inner
def _derivative(n: int, work: PanelRoom) -> None:
    """Write ``carry``, from the solution for the effect of the start on the last stage."""
    for row in range(n):
        for column in range(n):
            same = 1.0 if row == column else 0.0
            work.carry[row, column] = same + work.right[(STAGES - 1) * n + row, 1 + column]


@inner
def euler_panel(bristle: Bristle, place: Place, span: Any, z: Any, work: PanelRoom) -> None:
    """Fill ``work`` with an explicit Euler step, for a negligibly short step across a jump of the rate."""
    slip = bristle.slip
    n, width = parts(z), span[1] / slip.frequency
    rate, friction = bound(bristle.law, slip_at(slip, place, span[0], z), bristle.scale.circle, z)
    for stage in range(STAGES):
        work.slip[stage] = slip_at(slip, place, span[0] + NODES[stage] * span[1], z)
        work.gain[stage] = NODES[stage] * width * rate
        work.rate[stage], work.friction[stage] = rate, friction
    for row in range(n):
        for column in range(n):
            work.carry[row, column] = 1.0 if row == column else 0.0
