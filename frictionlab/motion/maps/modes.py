"""Modes of deflections and the guards at which they change: a yield surface is met or left, slip reverses.

Most laws read the modes from the state; a law that remembers stick carries them on.

A guard is positive as long as a mode holds. It is measured as a velocity or a deflection in the norm of
energy, and has a rate, so that Newton's method finds its zero. Guards are numbered: one for each deflection
and, last, on the line, that of the slip itself, where a law's own rate may have a corner.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import fast, inner
from frictionlab.compile.dispatch import by_dimension, by_law, by_scalars, length
from frictionlab.compile.stack import count_of
from frictionlab.motion.equation import Flow, deviation_slip_rate, instant_near, swing_of
from frictionlab.motion.maps.rates import (
    FOLLOWS,
    MEMORY,
    SMOOTH,
    YIELDS,
    Work,
    fill_rates,
    on_circle,
    remembers_stick,
    rows_of,
    slip_rate_to_yield,
    slip_to_yield,
)
from frictionlab.motion.maps.step import step

OPEN = 1e300
"""Value of a guard of a number without a corner."""
SLACK = 1e-12
"""Relative excess over a yield surface below which it is rounding."""
CLOSE = 1e-3
"""Largest excess of a guard beyond its zero at the end of a step, as a share of the accuracy."""

along = by_dimension(lambda z, w: z * w, lambda z, w: z.real * w.real + z.imag * w.imag)
"""along(z, w): inner product."""


class Guard(NamedTuple):
    """Guard: its number, value and rate."""

    number: int
    value: float
    rate: float


_reversal = by_dimension(
    lambda flow, a, w: Guard(-1, flow.side * w, flow.side * a),
    # in the plane slip turns round without coming to rest
    lambda flow, a, w: Guard(-1, OPEN, 0.0),
)


@inner
def _unloaded(k: int, a: Any, work: Work, w: Any) -> Guard:
    """Return the guard of unloading.

    It is positive until slip begins to unload a deflection that gives way, or to load one that follows the
    slip.
    """
    z, share = work.memory[k], work.mode[k] / work.size[k]
    return Guard(k, share * along(z, w), share * (along(z, a) + along(work.moving[k], w)))


_unloading = by_dimension(
    # on the line it is the slip's reversal that unloads; in a contact that keeps its stiffness a growing load may
    # unload a yielding deflection before that
    lambda k, a, work, w: _unloaded(k, a, work, w) if len(work.keeps_stiffness) > 0 else Guard(k, OPEN, 0.0),
    lambda k, a, work, w: _unloaded(k, a, work, w),
)


def _no_breakaway(flow: Flow, number: int, w: Any, a: Any, work: Work) -> Guard:
    return Guard(number, OPEN, 0.0)


def _breakaway(flow: Flow, number: int, w: Any, a: Any, work: Work) -> Guard:
    """Return the guard of a loaded deflection that sticks.

        It is positive until the deflection reaches its limit, where it begins to slip. The limit may depend
    on slip.
    """
    z = work.memory[number]
    far, loading = length(z), along(z, w)
    if loading <= 0.0:
        return Guard(number, OPEN, 0.0)
    limit = flow.law.breakaway(w, number)
    # rate of the limit, by a difference quotient in time over a small change of slip
    ahead = 1e-6 * (length(w) + 1e-3 * swing_of(flow.body)) / (length(a) + 1e-300)
    falls = (limit - flow.law.breakaway(w + ahead * a, number)) / ahead
    unit = work.unit[number]
    return Guard(number, unit * (limit * (1.0 + SLACK) - far), -unit * (loading / far + falls))


breakaway = by_law(_no_breakaway, _no_breakaway, _breakaway, _no_breakaway)
"""breakaway(flow, number, w, a, work): guard of a deflection that sticks, zero where it begins to slip; open
where no law remembers stick."""


@inner
def _guard_of_deflections(flow: Flow, number: int, w: Any, a: Any, work: Work) -> Guard:
    """Return one guard at ``work.memory``, which moves at ``work.moving``; slip w has the rate a."""
    if number == count_of(flow.law):
        return _reversal(flow, a, w)
    if remembers_stick(flow.law) and work.mode[number] == FOLLOWS:
        return breakaway(flow, number, w, a, work)
    z, radius = work.memory[number], work.radius[number]
    if radius > 0.0:
        w, a = slip_to_yield(work, number, w), slip_rate_to_yield(work, number, a)
    if work.mode[number] == YIELDS or (work.mode[number] == FOLLOWS and radius == 0.0):
        return _unloading(number, a, work, w)
    if work.mode[number] == FOLLOWS and radius > 0.0:
        far = length(z)
        outward = along(z, w) / far if far > 0.0 else length(w)
        unit = work.unit[number]
        return Guard(number, unit * (radius * (1.0 + SLACK) - far), -unit * outward)
    return Guard(number, OPEN, 0.0)


guard_of = by_scalars(
    lambda flow, number, w, a, work: _guard_of_deflections(flow, number, w, a, work),
    # friction by scalars is steepest where slip reverses: no step should end exactly there
    lambda flow, number, w, a, work: Guard(number, OPEN, 0.0),
)
"""guard_of(flow, number, w, a, work): one guard at ``work.memory``, which moves at ``work.moving``; slip w
has the rate a."""


@inner
def lowest(flow: Flow, w: Any, a: Any, work: Work) -> Guard:
    """Return the lowest of all guards at ``work.memory``."""
    found = Guard(0, OPEN, 0.0)
    for number in range(count_of(flow.law) + 1):
        guard = guard_of(flow, number, w, a, work)
        if guard.value < found.value:
            found = Guard(number, guard.value, guard.rate)
    return found


@inner
def rates_at_end(flow: Flow, tau: float, work: Work, zero: Any) -> Any:
    """Return slip and its rate at ``work.end``, the time tau; leave the memory there in ``work.memory``."""
    for row in range(rows_of(flow)):
        work.stage[row] = work.end[row]
    now = instant_near(flow, tau)
    w, a = fill_rates(flow, now, work, zero)
    return w, deviation_slip_rate(flow, now, a)


def _begin_smoothly(flow: Flow, a: Any, w: Any, work: Work) -> None:
    for k in range(count_of(flow.law)):
        work.mode[k] = SMOOTH


@inner
def _begin_by_state(flow: Flow, a: Any, w: Any, work: Work) -> None:
    for k in range(count_of(flow.law)):
        radius, z = work.radius[k], work.start[MEMORY + k]
        work.mode[k] = SMOOTH
        if radius > 0.0 or work.unloads[k] > 0.0:
            work.memory[k] = z
            against = slip_to_yield(work, k, w) if radius > 0.0 else w
            loaded = along(z, against) > 0.0 or (along(z, against) == 0.0 and along(z, a) >= 0.0)
            work.mode[k] = YIELDS if loaded and length(z) >= radius * (1.0 - 1e-13) else FOLLOWS


@inner
def _begin_by_memory(flow: Flow, a: Any, w: Any, work: Work) -> None:
    """Keep the modes of the state, but let unloaded deflections stick and those beyond their reach slip."""
    for k in range(count_of(flow.law)):
        z = work.start[MEMORY + k]
        work.memory[k] = z
        # by rounding, a state may have just passed the end of its mode
        if work.mode[k] == YIELDS and along(z, w) < 0.0:
            work.mode[k] = FOLLOWS
        if work.mode[k] == FOLLOWS and breakaway(flow, k, w, a, work).value <= 0.0:
            work.mode[k] = YIELDS


def _begin_deflections(flow: Flow, a: Any, w: Any, work: Work) -> None:
    if remembers_stick(flow.law):
        _begin_by_memory(flow, a, w, work)
    else:
        _begin_by_state(flow, a, w, work)


begin = by_scalars(_begin_deflections, _begin_smoothly)
"""begin(flow, a, w, work): set the modes at ``work.start``; slip w has the rate a."""


@inner
def restore(flow: Flow, work: Work) -> None:
    """Put the deflections of ``work.start`` that yield, or are beyond their limits, back on their surfaces."""
    for k in range(count_of(flow.law)):
        radius, z = work.radius[k], work.start[MEMORY + k]
        if radius > 0.0 and (work.mode[k] == YIELDS or length(z) > radius):
            work.start[MEMORY + k] = on_circle(radius, z)


@inner
def locate(flow: Flow, tau: float, high: float, accuracy: float, work: Work, zero: Any) -> float:
    """Find the step that ends just beyond the first guard that passes zero, within a step of ``high``.

    The state there is left in ``work.end``. Newton's method on the lowest guard is kept between a step in
    which no guard passes zero and one in which a guard does.
    """
    low, h, within = 0.0, high, CLOSE * accuracy
    for turn in range(60):
        # a step was taken to h: on which side of the event does it end?
        w, a = rates_at_end(flow, tau + h, work, zero)
        guard = lowest(flow, w, a, work)
        if guard.value <= 0.0:
            high = h
        else:
            low = h
        # just beyond the event, never before it: the next step starts in the new mode
        if -within <= guard.value <= 0.0 or high - low <= 4e-16 * (tau + high):
            break
        # aim half the tolerance beyond zero, since steps that stay in front of the event do not end the search
        trial = h - (guard.value + 0.5 * within) / guard.rate if guard.rate < 0.0 else low
        # on a curved guard Newton's steps may creep towards one end: halve now and then
        h = trial if low < trial < high and turn % 4 < 3 else 0.5 * (low + high)
        step(flow, tau, h, work, zero)
    # the last step tried need not be the one that ends just beyond
    if h != high:
        step(flow, tau, high, work, zero)
    return high


@inner
def change(flow: Flow, w: Any, a: Any, work: Work) -> float:
    """Change every mode whose guard has been passed at ``work.memory``, and return the side of slip."""
    n = count_of(flow.law)
    reverses = guard_of(flow, n, w, a, work).value <= 0.0
    # slip that reverses on the line unloads every deflection at once, that meets its limit just now, too; under a
    # falling load one of constant stiffness may go on yielding
    unloads = reverses and len(work.keeps_stiffness) == 0
    for k in range(n):
        passed = guard_of(flow, k, w, a, work).value <= 0.0
        if work.mode[k] == YIELDS and (passed or unloads):
            work.mode[k] = FOLLOWS
        elif work.mode[k] == FOLLOWS and passed and not unloads:
            work.mode[k] = YIELDS
    return -flow.side if reverses else flow.side


@inner
def note_guards(flow: Flow, w: Any, a: Any, work: Work) -> None:
    """Keep every guard at ``work.memory`` and its rate, for comparison with those at the end of a step."""
    n = count_of(flow.law)
    for number in range(n + 1):
        guard = guard_of(flow, number, w, a, work)
        work.guards[2 * number], work.guards[2 * number + 1] = guard.value, guard.rate


@fast
def _lowest_between(h: float, value0: float, rate0: float, value1: float, rate1: float) -> Any:
    """Return where the cubic through two values and rates is lowest between them, and how low it is."""
    # its derivative is rate0 + 2 b s + 3 c s^2 with s from 0 to 1, negative at 0 and positive at 1
    c = h * (rate0 + rate1) - 2.0 * (value1 - value0)
    b = 3.0 * (value1 - value0) - h * (2.0 * rate0 + rate1)
    root = math.sqrt(max(b * b - 3.0 * c * h * rate0, 0.0))
    s = -h * rate0 / (b + root) if b + root > 0.0 else 0.5
    s = min(max(s, 0.0), 1.0)
    return s, value0 + s * (h * rate0 + s * (b + s * c))


@inner
def hidden(flow: Flow, h: float, w: Any, a: Any, work: Work) -> float:
    """Return a shorter step if a guard may come close to zero, or pass it twice, in this step; else h.

    Guards at the start are those noted, at the end those of ``work.memory``.
    """
    for number in range(count_of(flow.law) + 1):
        value0, rate0 = work.guards[2 * number], work.guards[2 * number + 1]
        guard = guard_of(flow, number, w, a, work)
        # a guard that falls first and rises last may have been zero in between
        if rate0 < 0.0 < guard.rate:
            share, least = _lowest_between(h, value0, rate0, guard.value, guard.rate)
            if least < 0.0625 * min(value0, guard.value) and 0.01 < share < 0.99:
                return share * h
    return h
