"""The deflection over one period of a prescribed slip, at any stiffness: collocation with adaptive steps.

Each step is computed whole and in two halves, and shortened until both agree on the deflection and on the integral of
friction; steps therefore become short where the rate of the law jumps. Towards slow slip they are graded, since the
layers there may be too short to be detected by the error of a long step.

Licence (tests/benchmarks/specialists.py): those of the closed loops on the line and in the plane, which this serves.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner, njit
from frictionlab.dynamics.contact import resistance
from frictionlab.dynamics.radau_panel import (
    NODES,
    STAGES,
    WEIGHTS,
    Place,
    Scale,
    Slip,
    bound,
    crawl,
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


class Panels(NamedTuple):
    """Panels of a period: starts, widths [n]; slip velocity (as the law takes it), deflection and friction at
    the start and the stages [n, 1 + stages].
    """

    start: Any
    width: Any
    slip: Any
    deflection: Any
    friction: Any


@inner
def _room(z: Any) -> Panels:
    kind = np.full((1, STAGES + 1), z)
    shape = (ROOM, STAGES + 1)
    return Panels(
        np.empty(ROOM),
        np.empty(ROOM),
        np.empty(shape, kind.dtype),
        np.empty(shape, kind.dtype),
        np.empty(shape, kind.dtype),
    )


@inner
def _note(law: Any, slip: Slip, stretch: Stretch, span: Any, z: Any, work: Any, out: Panels, n: int) -> None:
    """Write a panel to the output."""
    out.start[n], out.width[n] = stretch.place.angle + span[0], span[1]
    v = slip_at(slip, stretch.place, span[0], z)
    out.slip[n, 0], out.deflection[n, 0] = v, z
    _, friction = resistance(law, v, z)
    out.friction[n, 0] = friction
    for stage in range(STAGES):
        out.slip[n, stage + 1] = work.slip[stage]
        out.deflection[n, stage + 1] = z + work.gain[stage]
        out.friction[n, stage + 1] = work.friction[stage]


@inner
def _rubbed(span: Any, work: Any) -> Any:
    """The integral of friction over a panel."""
    total = 0.0 * work.friction[0]
    for stage in range(STAGES):
        total = total + WEIGHTS[stage] * work.friction[stage]
    return span[1] * total


@inner
def _times(first: Any, second: Any) -> None:
    """second becomes first times second."""
    n = first.shape[0]
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
    left = stretch.length - at
    ahead = left if left <= 0.5 * stretch.near_end else max(left / 3.0, 0.5 * stretch.near_end)
    return min(min(math.pi / 8.0, ahead), min(0.5 * max(at, stretch.near_start), left))


@inner
def _tried(law: Any, slip: Slip, place: Place, scale: Scale, span: Any, z: Any, work: Any) -> float:
    """Difference of a whole step and its two halves in deflection and friction integral; ``FAILED`` if one fails."""
    whole, first, second = work
    at, step = span
    half = 0.5 * step
    if not solve_panel(law, slip, place, scale, (at, step), z, whole):
        return FAILED
    if not solve_panel(law, slip, place, scale, (at, half), z, first):
        return FAILED
    middle = z + first.gain[STAGES - 1]
    if not solve_panel(law, slip, place, scale, (at + half, step - half), middle, second):
        return FAILED
    gain = first.gain[STAGES - 1] + second.gain[STAGES - 1]
    error = abs(gain - whole.gain[STAGES - 1]) / scale.change
    rubbed = _rubbed((at, half), first) + _rubbed((at + half, step - half), second)
    size = max(scale.friction, abs(rubbed) / step)
    return max(error, abs(rubbed - _rubbed((at, step), whole)) / size)


@inner
def _outward(v: Any, z: Any) -> bool:
    return v.real * z.real + v.imag * z.imag > 0.0


@inner
def _turned(mode: float, radius: float, v: Any, z: Any) -> bool:
    """Whether an elastic deflection (mode 0) has begun to yield, or a yielding one to unload."""
    if mode != 0.0:
        return not _outward(v, z)
    return _outward(v, z) and abs(z) > radius * (1.0 + 1e-14)


@inner
def _bend(slip: Slip, angle: float) -> complex:
    """The slip's rate of change."""
    turn = complex(math.cos(angle), math.sin(angle)) * slip.frequency
    return complex((slip.along * turn).real, (slip.across * turn).real)


@inner
def _margin(mode: float, radius: float, v: Any, bend: complex, z: Any, rate: Any) -> Any:
    """How far a deflection is from turning, and how fast that grows."""
    load = v.real * z.real + v.imag * z.imag
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
    square = 3.0 * (to - at) - 2.0 * slope - slope_to
    cube = slope + slope_to - 2.0 * (to - at)
    lowest = -slope / (square + math.sqrt(max(square * square - 3.0 * cube * slope, 0.0)))
    return at + lowest * (slope + lowest * (square + lowest * cube)) < 0.0


@inner
def _seen(
    law: Any, slip: Slip, place: Place, scale: Scale, radius: float, span: Any, z: Any, work: Any
) -> bool:
    """Whether that is so at any stage of a step, or between two of them."""
    turned, mode = False, scale.circle
    v, before = slip_at(slip, place, span[0], z), 0.0
    rate, _ = bound(law, v, mode, z)
    margin, growth = _margin(mode, radius, v, _bend(slip, place.angle + span[0]), z, rate)
    for stage in range(STAGES):
        v, here, node = work.slip[stage], z + work.gain[stage], NODES[stage]
        turned = turned or _turned(mode, radius, v, here)
        bend = _bend(slip, place.angle + span[0] + node * span[1])
        following, following_growth = _margin(mode, radius, v, bend, here, work.rate[stage])
        time = (node - before) * span[1] / slip.frequency
        turned = turned or _dips(margin, following, time * growth, time * following_growth)
        margin, growth, before = following, following_growth, node
    return turned


@inner
def _until(
    law: Any, slip: Slip, place: Place, scale: Scale, span: Any, z: Any, work: Any, radius: float
) -> Any:
    """The longest part of a step before it turns, by bisection, and whether it does turn there.

    It does not where it ends because nothing solves a longer one.
    """
    at, high = span
    low, turns = 0.0, True
    for _ in range(60):
        middle = 0.5 * (low + high)
        smooth = solve_panel(law, slip, place, scale, (at, middle), z, work)
        if smooth and not _seen(law, slip, place, scale, radius, (at, middle), z, work):
            low = middle
        else:
            high, turns = middle, smooth
        if high - low <= 1e-16 * max(abs(at), high):
            break
    return low, turns


@inner
def _pressed(z: Any, carry: Any) -> None:
    """At the onset of yield the radial part of the derivative vanishes: the deflection then stays on its circle."""
    n, size = carry.shape[0], abs(z)
    for column in range(n):
        along = 0.0
        for row in range(n):
            along += part(row, z) / size * carry[row, column]
        for row in range(n):
            carry[row, column] -= along * part(row, z) / size


@inner
def _jumped(law: Any, slip: Slip, v: Any, angle: float, z: Any, mode: float, carry: Any) -> None:
    """What a jump of the rate where slip turns across the deflection does to the derivative (saltation)."""
    elastic, _ = bound(law, v, 0.0, z)
    breaking, _ = bound(law, v, -1.0, (1.0 + 1e-9) * z + 1e-9 * abs(z) / max(abs(v), 1e-300) * v)
    jump = breaking - elastic if mode == 0.0 else elastic - breaking
    bend = _bend(slip, angle)
    speed = v.real * v.real + v.imag * v.imag + z.real * bend.real + z.imag * bend.imag
    if abs(speed) <= 1e-9 * (v.real * v.real + v.imag * v.imag):
        return
    for column in range(carry.shape[0]):
        across = 0.0
        for row in range(carry.shape[0]):
            across += part(row, v) * carry[row, column]
        for row in range(carry.shape[0]):
            carry[row, column] += part(row, jump) * across / speed


@inner
def _bounded(scale: Scale, circle: float) -> Scale:
    return Scale(scale.reach, scale.change, scale.friction, circle)


@inner
def _switched(
    law: Any, slip: Slip, place: Place, at: float, scale: Scale, radius: float, z: Any, carry: Any
) -> Scale:
    """The scale with the other mode; the derivative is updated for the change of mode."""
    v = slip_at(slip, place, at, z)
    if radius == 0.0:
        _jumped(law, slip, v, place.angle + at, z, scale.circle, carry)
        return _bounded(scale, -1.0 if scale.circle == 0.0 else 0.0)
    if scale.circle == 0.0:
        _pressed(z, carry)
        return _bounded(scale, radius)
    return _bounded(scale, 0.0)


@inner
def _started(slip: Slip, stretches: Any, scale: Scale, z: Any, carry: Any) -> Scale:
    """The mode, elastic or yielding, at the start of the period."""
    radius = scale.circle
    begin = Place(stretches[0, 0], complex(stretches[0, 1], stretches[0, 2]))
    outward = _outward(slip_at(slip, begin, stretches[0, 3] + 1e-9, z), z)
    if not outward or abs(z) < radius * (1.0 - 1e-12):
        return _bounded(scale, 0.0)
    if radius == 0.0:
        return _bounded(scale, -1.0)
    _pressed(z, carry)
    return _bounded(scale, radius)


@njit
def follow_period(law: Any, slip: Slip, stretches: Any, scale: Scale, accuracy: float, z: Any) -> Any:
    """Follow the deflection once around from ``z``, over stretches [n, 7]: those of ``Stretch``.

    scale.circle: negative where the law's rate is all there is; 0 where it follows the slip as long as slip unloads
    it, and radius > 0 where it does so within that circle. Returns what the deflection gained, the derivative of
    the end by the start, and the panels; none where it got stuck.
    """
    out, n, gained = _room(z), 0, 0.0 * z
    work = (work_for(z), work_for(z), work_for(z))
    carry = np.eye(parts(z))
    radius, step, row, at, idle = scale.circle, 0.1, 0, 0.0, 0
    longest = math.pi / 8.0 if radius < 0.0 else math.pi / 48.0
    if radius >= 0.0:
        scale = _started(slip, stretches, scale, z, carry)
    while row < stretches.shape[0] and n + 2 < ROOM:
        here = stretches[row]
        place = Place(here[0], complex(here[1], here[2]))
        stretch, begin = Stretch(place, here[3], here[4], here[5], here[6]), here[3]
        step, now = min(min(step, longest), _allowed(stretch, at)), z + gained
        error, turns = _tried(law, slip, place, scale, (begin + at, step), now, work), False
        # The rate jumps where the contact begins to yield or to unload: the step is cut at the change of mode, so
        # that panels are smooth. After three changes without progress the jump is left to the step control.
        if radius >= 0.0 and idle < 3:
            first, half, middle = begin + at, 0.5 * step, now + work[1].gain[STAGES - 1]
            turns = _seen(law, slip, place, scale, radius, (first, step), now, work[0])
            turns = turns or _seen(law, slip, place, scale, radius, (first, half), now, work[1])
            turns = turns or _seen(
                law, slip, place, scale, radius, (first + half, step - half), middle, work[2]
            )
            if turns:
                step, turns = _until(law, slip, place, scale, (first, step), now, work[0], radius)
                if step <= SHORTEST:
                    scale = _switched(law, slip, place, begin + at, scale, radius, now, carry)
                    step, idle = 1e-3, idle + 1
                    continue
                error = _tried(law, slip, place, scale, (begin + at, step), now, work)
        # Too large an error: a shorter step, at least a tenth of it.
        if error > accuracy and step > SHORTEST:
            step = step * min(0.5, max(0.1, 0.8 * (accuracy / error) ** (1.0 / 7.0)))
            continue
        # Newton's method fails even in the shortest step, as across a jump: explicit steps pass it.
        if error >= FAILED:
            crawl(law, slip, place, scale, (begin + at, 0.5 * step), now, work[1])
            middle = begin + at + 0.5 * step
            crawl(law, slip, place, scale, (middle, 0.5 * step), now + work[1].gain[STAGES - 1], work[2])
            error = accuracy
        idle = 0
        # The two halves are more accurate than the whole step and become the panels.
        for half in range(2):
            piece = work[1 + half]
            _note(law, slip, stretch, (begin + at + 0.5 * half * step, 0.5 * step), z + gained, piece, out, n)
            gained = gained + piece.gain[STAGES - 1]
            _times(piece.carry, carry)
            n += 1
        at += step
        if turns:
            scale = _switched(law, slip, place, begin + at, scale, radius, z + gained, carry)
        if stretch.length - at <= 1e-15 * stretch.length:
            row, at = row + 1, 0.0
        step = step * min(3.0, 0.8 * (accuracy / max(error, 1e-300)) ** (1.0 / 7.0)) if not turns else 1e-2
    n = n if row == stretches.shape[0] else 0
    return gained, carry, out.start[:n], out.width[:n], out.slip[:n], out.deflection[:n], out.friction[:n]
