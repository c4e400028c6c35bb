"""The deflection over one period of a prescribed slip, at any stiffness: collocation with adaptive steps.

Each step is computed whole and in two halves, and shortened until both agree on the deflection and on the integral of
friction; steps therefore become short where the rate of the law jumps. Towards slow slip they are graded, since the
layers there may be too short to be detected by the error of a long step.

Licence: those of the closed loops on the line and in the plane, which this serves.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner, njit
from frictionlab.motion.contact import resistance
from frictionlab.motion.steppers.radau_panel import (
    NODES,
    STAGES,
    WEIGHTS,
    Bristle,
    Oscillation,
    Place,
    Scale,
    bound,
    euler_panel,
    part,
    parts,
    slip_at,
    solve_panel,
    work_for,
)

FAILED = 1e9
ROOM = 40000
"""Panels of a period."""
SHORTEST = 1e-14
"""Angle below which a step is accepted as it is: a jump of the rate inside it has a negligible effect."""


class Stretch(NamedTuple):
    """A part of the period without rest inside: its reference place, its begin relative to that, its length.

    near_start, near_end: angle around either end within which steps need not shorten further.
    """

    place: Place
    begin: float
    length: float
    near_start: float
    near_end: float


class LoopPanels(NamedTuple):
    """Panels of a period: starts, widths [n]; slip velocity (as the law takes it), deflection and friction at
    the start and the stages [n, 1 + stages]; the number of panels written [1].
    """

    start: Any
    width: Any
    slip: Any
    deflection: Any
    friction: Any
    filled: Any


@inner
def _panel_room(z: Any) -> LoopPanels:
    kind = np.full((1, STAGES + 1), z)
    shape = (ROOM, STAGES + 1)
    return LoopPanels(
        np.empty(ROOM),
        np.empty(ROOM),
        np.empty(shape, kind.dtype),
        np.empty(shape, kind.dtype),
        np.empty(shape, kind.dtype),
        np.zeros(1, np.int64),
    )


@inner
def _write_panel(bristle: Bristle, place: Place, span: Any, z: Any, work: Any, out: LoopPanels) -> None:
    """Append a panel to the output."""
    n = out.filled[0]
    out.start[n], out.width[n] = place.angle + span[0], span[1]
    v = slip_at(bristle.slip, place, span[0], z)
    out.slip[n, 0], out.deflection[n, 0] = v, z
    _, friction = resistance(bristle.law, v, z)
    out.friction[n, 0] = friction
    for stage in range(STAGES):
        out.slip[n, stage + 1] = work.slip[stage]
        out.deflection[n, stage + 1] = z + work.gain[stage]
        out.friction[n, stage + 1] = work.friction[stage]
    out.filled[0] = n + 1


@inner
def _impulse(span: Any, work: Any) -> Any:
    """The integral of friction over a panel."""
    total = 0.0 * work.friction[0]
    for stage in range(STAGES):
        total = total + WEIGHTS[stage] * work.friction[stage]
    return span[1] * total


@inner
def _times(first: Any, second: Any) -> None:
    """second becomes first times second."""
    n = first.shape[0]
    # The chain rule: the panel's derivative after that of all before.
    product = np.zeros((n, n))
    for i in range(n):
        for j in range(n):
            for k in range(n):
                product[i, j] += first[i, k] * second[k, j]
    for i in range(n):
        for j in range(n):
            second[i, j] = product[i, j]


@inner
def _allowed(stretch: Stretch, at: float) -> float:
    """The longest step from here, by the distance to both ends of the stretch."""
    # Towards the end a third of what is left, so that no sliver remains; near an end its layer is no further divided.
    left = stretch.length - at
    ahead = left if left <= 0.5 * stretch.near_end else max(left / 3.0, 0.5 * stretch.near_end)
    return min(min(math.pi / 8.0, ahead), min(0.5 * max(at, stretch.near_start), left))


@inner
def _step_error(bristle: Bristle, place: Place, span: Any, z: Any, work: Any) -> float:
    """Difference of a whole step and its two halves in deflection and friction integral; ``FAILED`` if one fails."""
    whole, first, second = work
    at, step = span
    half = 0.5 * step
    # The whole step, then its halves, which become the panels: the difference is the error of the whole one.
    if not solve_panel(bristle, place, (at, step), z, whole):
        return FAILED
    if not solve_panel(bristle, place, (at, half), z, first):
        return FAILED
    middle = z + first.gain[STAGES - 1]
    if not solve_panel(bristle, place, (at + half, step - half), middle, second):
        return FAILED
    gain = first.gain[STAGES - 1] + second.gain[STAGES - 1]
    error = abs(gain - whole.gain[STAGES - 1]) / bristle.scale.change
    impulse = _impulse((at, half), first) + _impulse((at + half, step - half), second)
    # Measured by friction met, or by the coefficient of the scale where that is nearly zero.
    size = max(bristle.scale.friction, abs(impulse) / step)
    return max(error, abs(impulse - _impulse((at, step), whole)) / size)


@inner
def _outward(v: Any, z: Any) -> bool:
    return v.real * z.real + v.imag * z.imag > 0.0


@inner
def _mode_ends(mode: float, radius: float, v: Any, z: Any) -> bool:
    """Whether an elastic deflection (mode 0) has begun to yield, or a yielding one to unload."""
    # Yield ends where slip turns back; elasticity ends on the yield surface while slip still pushes outward.
    if mode != 0.0:
        return not _outward(v, z)
    return _outward(v, z) and abs(z) > radius * (1.0 + 1e-14)


@inner
def _bend(slip: Oscillation, angle: float) -> complex:
    """The slip's rate of change."""
    turn = complex(math.cos(angle), math.sin(angle)) * slip.frequency
    return complex((slip.along * turn).real, (slip.across * turn).real)


@inner
def _mode_margin(mode: float, radius: float, v: Any, bend: complex, z: Any, rate: Any) -> Any:
    """How far a deflection is from turning, and how fast that grows."""
    load = v.real * z.real + v.imag * z.imag
    # Elastic within a circle: room to the yield surface. Else the load, whose sign tells loading from unloading.
    if mode == 0.0 and radius > 0.0:
        return radius * radius - (z.real * z.real + z.imag * z.imag), -2.0 * load
    growth = v.real * rate.real + v.imag * rate.imag + bend.real * z.real + bend.imag * z.imag
    return (-load, -growth) if mode == 0.0 else (load, growth)


@inner
def _dips(at: float, to: float, slope: float, slope_to: float) -> bool:
    """Whether the cubic between two positive values that falls first and rises then is negative in between.

    slope, slope_to: its change over the interval as each end tells it.
    """
    if not (at > 0.0 and to > 0.0 and slope < 0.0 and slope_to > 0.0):
        return False
    # The cubic through both values and slopes; its minimum without the cancellation of the textbook formula.
    square = 3.0 * (to - at) - 2.0 * slope - slope_to
    cube = slope + slope_to - 2.0 * (to - at)
    lowest = -slope / (square + math.sqrt(max(square * square - 3.0 * cube * slope, 0.0)))
    return at + lowest * (slope + lowest * (square + lowest * cube)) < 0.0


@inner
def _mode_ends_within(bristle: Bristle, radius: float, place: Place, span: Any, z: Any, work: Any) -> bool:
    """Whether the mode ends at any stage of a step, or between two of them."""
    slip, ended, mode = bristle.slip, False, bristle.scale.circle
    v, before = slip_at(slip, place, span[0], z), 0.0
    rate, _ = bound(bristle.law, v, mode, z)
    margin, growth = _mode_margin(mode, radius, v, _bend(slip, place.angle + span[0]), z, rate)
    for stage in range(STAGES):
        v, here, node = work.slip[stage], z + work.gain[stage], NODES[stage]
        ended = ended or _mode_ends(mode, radius, v, here)
        bend = _bend(slip, place.angle + span[0] + node * span[1])
        following, following_growth = _mode_margin(mode, radius, v, bend, here, work.rate[stage])
        # A mode may end and begin again between two stages, which neither of them shows.
        time = (node - before) * span[1] / slip.frequency
        ended = ended or _dips(margin, following, time * growth, time * following_growth)
        margin, growth, before = following, following_growth, node
    return ended


@inner
def _longest_in_mode(bristle: Bristle, radius: float, place: Place, span: Any, z: Any, work: Any) -> Any:
    """The longest part of a step before the mode ends, by bisection, and whether it does end there.

    It does not where the part ends because nothing solves a longer one.
    """
    at, high = span
    low, ends = 0.0, True
    for _ in range(60):
        # A part that nothing solves counts as too long, as does one in which the mode ends.
        middle = 0.5 * (low + high)
        smooth = solve_panel(bristle, place, (at, middle), z, work)
        if smooth and not _mode_ends_within(bristle, radius, place, (at, middle), z, work):
            low = middle
        else:
            high, ends = middle, smooth
        if high - low <= 1e-16 * max(abs(at), high):
            break
    return low, ends


@inner
def _mode_end(bristle: Bristle, radius: float, place: Place, span: Any, z: Any, work: Any) -> Any:
    """The part of a step after which the mode ends, and whether it ends inside the step at all."""
    first, step = span
    half, middle = 0.5 * step, z + work[1].gain[STAGES - 1]
    # The whole step and its halves are all asked: each may miss an end that another shows.
    ends = _mode_ends_within(bristle, radius, place, (first, step), z, work[0])
    ends = ends or _mode_ends_within(bristle, radius, place, (first, half), z, work[1])
    ends = ends or _mode_ends_within(bristle, radius, place, (first + half, step - half), middle, work[2])
    if not ends:
        return step, False, False
    # Only the part before the end is kept: the panel is then smooth, and its order what it should be.
    part, ends = _longest_in_mode(bristle, radius, place, (first, step), z, work[0])
    return part, ends, True


@inner
def _drop_radial(z: Any, carry: Any) -> None:
    """At the onset of yield the radial part of the derivative vanishes: the deflection then stays on its circle."""
    n, size = carry.shape[0], abs(z)
    for column in range(n):
        along = 0.0
        for row in range(n):
            along += part(row, z) / size * carry[row, column]
        for row in range(n):
            carry[row, column] -= along * part(row, z) / size


@inner
def _saltation(bristle: Bristle, v: Any, angle: float, z: Any, carry: Any) -> None:
    """What a jump of the rate where slip turns across the deflection does to the derivative (saltation)."""
    elastic, _ = bound(bristle.law, v, 0.0, z)
    # The rate of yield is that of a deflection a little further out: at z itself the law may still be elastic.
    beyond = (1.0 + 1e-9) * z + 1e-9 * abs(z) / max(abs(v), 1e-300) * v
    breaking, _ = bound(bristle.law, v, -1.0, beyond)
    jump = breaking - elastic if bristle.scale.circle == 0.0 else elastic - breaking
    bend = _bend(bristle.slip, angle)
    speed = v.real * v.real + v.imag * v.imag + z.real * bend.real + z.imag * bend.imag
    # A grazing end: every neighbour turns at another time, and none has a derivative to correct.
    if abs(speed) <= 1e-9 * (v.real * v.real + v.imag * v.imag):
        return
    for column in range(carry.shape[0]):
        across = 0.0
        for row in range(carry.shape[0]):
            across += part(row, v) * carry[row, column]
        for row in range(carry.shape[0]):
            carry[row, column] += part(row, jump) * across / speed


@inner
def _attempt(bristle: Bristle, radius: float, place: Place, span: Any, z: Any, work: Any) -> Any:
    """The step to take, its error, whether the mode ends with it, and whether it was cut for that.

    The rate jumps where the contact begins to yield or to unload: a step is cut at the change of mode, so that panels
    are smooth. Negative radius: the modes are not looked at.
    """
    first, step = span
    error = _step_error(bristle, place, span, z, work)
    if radius < 0.0:
        return step, error, False, False
    step, ends, cut = _mode_end(bristle, radius, place, span, z, work)
    if cut and step > SHORTEST:
        error = _step_error(bristle, place, (first, step), z, work)
    return step, error, ends, cut


@inner
def _in_mode(bristle: Bristle, circle: float) -> Bristle:
    """The bristle with its mode, as ``circle`` of its scale."""
    scale = bristle.scale
    return Bristle(bristle.law, bristle.slip, Scale(scale.reach, scale.change, scale.friction, circle))


@inner
def _other_mode(bristle: Bristle, radius: float, place: Place, at: float, z: Any, carry: Any) -> Bristle:
    """The bristle in its other mode; the derivative is updated for the change of mode."""
    elastic = bristle.scale.circle == 0.0
    # Without a yield surface the rate jumps where slip turns; with one the onset of yield drops a direction.
    if radius == 0.0:
        _saltation(bristle, slip_at(bristle.slip, place, at, z), place.angle + at, z, carry)
        return _in_mode(bristle, -1.0 if elastic else 0.0)
    if elastic:
        _drop_radial(z, carry)
        return _in_mode(bristle, radius)
    return _in_mode(bristle, 0.0)


@inner
def _first_mode(bristle: Bristle, radius: float, stretches: Any, z: Any, carry: Any) -> Bristle:
    """The bristle in its mode, elastic or yielding, at the start of the period; negative radius: it has no modes."""
    if radius < 0.0:
        return bristle
    begin = Place(stretches[0, 0], complex(stretches[0, 1], stretches[0, 2]))
    # A little after the start: slip may be zero there, and its sign is that of what follows.
    outward = _outward(slip_at(bristle.slip, begin, stretches[0, 3] + 1e-9, z), z)
    if not outward or abs(z) < radius * (1.0 - 1e-12):
        return _in_mode(bristle, 0.0)
    if radius == 0.0:
        return _in_mode(bristle, -1.0)
    _drop_radial(z, carry)
    return _in_mode(bristle, radius)


@inner
def _stretch_of(row: Any) -> Stretch:
    return Stretch(Place(row[0], complex(row[1], row[2])), row[3], row[4], row[5], row[6])


@inner
def _euler_halves(bristle: Bristle, place: Place, span: Any, z: Any, work: Any) -> None:
    """Both halves of a step by explicit steps, where Newton's method fails even in the shortest one."""
    first, half = span[0], 0.5 * span[1]
    euler_panel(bristle, place, (first, half), z, work[1])
    euler_panel(bristle, place, (first + half, half), z + work[1].gain[STAGES - 1], work[2])


@inner
def _write_halves(bristle: Bristle, place: Place, span: Any, state: Any, work: Any, out: LoopPanels) -> Any:
    """Append the two halves of a step, which are more accurate than the whole; return what is gained at its end.

    state: the deflection at the start of the period, and what it has gained, which keeps the digits of a soft
    contact's small changes. work: of the whole and both halves, and the derivative so far, which is carried on.
    """
    z, gained = state
    pieces, carry = work
    first, half = span[0], 0.5 * span[1]
    for k in range(2):
        piece = pieces[1 + k]
        _write_panel(bristle, place, (first + half * k, half), z + gained, piece, out)
        gained = gained + piece.gain[STAGES - 1]
        _times(piece.carry, carry)
    return gained


@njit
def follow_period(law: Any, slip: Oscillation, stretches: Any, scale: Scale, accuracy: float, z: Any) -> Any:
    """Follow the deflection once around from ``z``, over stretches [n, 7]: those of ``Stretch``.

    scale.circle: negative where the law's rate is all there is; 0 where it follows the slip as long as slip unloads
    it, and radius > 0 where it does so within that circle. Returns what the deflection gained, the derivative of
    the end by the start, and the panels; none where it got stuck.
    """
    bristle, radius = Bristle(law, slip, scale), scale.circle
    out, gained, carry = _panel_room(z), 0.0 * z, np.eye(parts(z))
    work, step, row, at, idle = (work_for(z), work_for(z), work_for(z)), 0.1, 0, 0.0, 0
    longest = math.pi / 8.0 if radius < 0.0 else math.pi / 48.0
    bristle = _first_mode(bristle, radius, stretches, z, carry)
    while row < stretches.shape[0] and out.filled[0] + 2 < ROOM:
        stretch, now = _stretch_of(stretches[row]), z + gained
        place, first = stretch.place, stretch.begin + at
        step = min(min(step, longest), _allowed(stretch, at))
        # After three changes of mode without progress the jump of the rate is left to the step control.
        edge = radius if idle < 3 else -1.0
        step, error, ends, cut = _attempt(bristle, edge, place, (first, step), now, work)
        if cut and step <= SHORTEST:
            bristle = _other_mode(bristle, radius, place, first, now, carry)
            step, idle = 1e-3, idle + 1
            continue
        # Too large an error: a shorter step, at least a tenth of it.
        if error > accuracy and step > SHORTEST:
            step = step * min(0.5, max(0.1, 0.8 * (accuracy / error) ** (1.0 / 7.0)))
            continue
        # Newton's method fails even in the shortest step, as across a jump: explicit steps pass it.
        if error >= FAILED:
            _euler_halves(bristle, place, (first, step), now, work)
            error = accuracy
        gained = _write_halves(bristle, place, (first, step), (z, gained), (work, carry), out)
        at, idle = at + step, 0
        if ends:
            bristle = _other_mode(bristle, radius, place, stretch.begin + at, z + gained, carry)
        if stretch.length - at <= 1e-15 * stretch.length:
            row, at = row + 1, 0.0
        step = step * min(3.0, 0.8 * (accuracy / max(error, 1e-300)) ** (1.0 / 7.0)) if not ends else 1e-2
    n = out.filled[0] if row == stretches.shape[0] else 0
    return gained, carry, out.start[:n], out.width[:n], out.slip[:n], out.deflection[:n], out.friction[:n]
