"""Return map of a mass under Coulomb friction over the period of its forces, its derivative and its fixed point.

State (x, w) of the canonical scene at a whole number of periods, after a corner there; w = x' - belt_speed. In the
energy norm sqrt(x^2 + w^2) the distance of two orbits of one scene never grows (Leine & van de Wouw, 2008), so an
iteration of the map never increases the residual: Newton's method falls back to it. Derivatives through events:
saltation (Leine & Nijmeijer, 2004, ch. 7).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.methods.exact.forcing import HIGHEST, LOWEST
from frictionlab.methods.exact.legs import STICK, cross_corner, slip_leg, starting_mode, stick_leg
from frictionlab.methods.exact.oscillator import (
    at_piece,
    impulse_of_limit,
    impulse_of_load,
    largest_swing,
    next_corner,
    response_at,
)
from frictionlab.values.quantities import EPSILON

MOST_LEGS = 1_000_000
"""Most legs in a period; a period with more is not solved, since its motion is below the rounding of its position."""
LEGS_IN_ALL = 20_000_000
"""Legs of all maps, some ten seconds, after which a periodic state is no longer looked for."""
SHORTEST = 1e-6


class Passage(NamedTuple):
    """End of a stretch of motion.

    xx .. ww: derivative of the end by the start; friction: integral of the friction force (it resists); by_x,
    by_w: its derivative by the start; legs: their number; stick: time at rest on the belt; alike: 1.0 where all legs
    are slip of one sign.
    """

    x: float
    w: float
    xx: float
    xw: float
    wx: float
    ww: float
    friction: float
    by_x: float
    by_w: float
    legs: int
    stick: float
    alike: float


@inner
def passage(body: Any, x: float, w: float, start: float, end: float) -> Passage:
    """Follow the motion from (x, w) at ``start`` to ``end``, both within one period.

    What has corners starts at 0, in its first piece.
    """
    tau, mode = start, starting_mode(body, start, x, w)
    first, alike = mode, 1.0
    xx, xw, wx, ww = 1.0, 0.0, 0.0, 1.0
    friction, by_x, by_w, stick, legs = 0.0, 0.0, 0.0, 0.0, 0
    while tau < end and legs < MOST_LEGS:
        stop = next_corner(body, end)
        left = stop - tau
        leg = stick_leg(body, tau, x, left) if mode == STICK else slip_leg(body, tau, x, w, mode, left)
        alike = alike if mode == first and mode != STICK else 0.0
        # The derivative of the free motion. In stick keep is 1 and the rest 0: a change of x stays, one of w is gone.
        xx, wx = leg.keep * xx + leg.turn * wx, leg.damp * wx - leg.turn * xx
        xw, ww = leg.keep * xw + leg.turn * ww, leg.damp * ww - leg.turn * xw
        if mode == STICK:
            friction = friction + stuck_impulse(body, tau, x, leg.duration)
            by_x, by_w = by_x - leg.duration * xx, by_w - leg.duration * xw
            stick = stick + leg.duration
        else:
            # The force of slip is a function of time: only the time of the event at its end depends on the state.
            friction = friction + mode * impulse_of_limit(body, tau, leg.duration)
            if leg.event != 0.0:
                kept, jump = saltation(leg.net, leg.limit, mode, leg.following)
                by_x, by_w = by_x + jump * wx, by_w + jump * ww
                wx, ww = kept * wx, kept * ww
        x, w, mode = leg.x, leg.w, leg.following
        tau = tau + leg.duration if leg.event != 0.0 else stop
        legs = legs + 1
        if tau >= stop:
            body, w, mode, kept = cross_corner(body, x, w, mode)
            by_x, by_w = by_x + (1.0 - kept) * wx, by_w + (1.0 - kept) * ww
            wx, ww = kept * wx, kept * ww
    return Passage(x, w, xx, xw, wx, ww, friction, by_x, by_w, legs, stick, alike)


@inner
def saltation(net: float, limit: float, before: float, after: float) -> tuple[float, float]:
    """Return derivatives at the end of slip of sign ``before``.

    The first is that of the slip velocity after it by that before it, the second that of the friction impulse by the
    slip velocity.
    """
    # Stick: every velocity near zero becomes zero. Its friction balances the net force from the event on, so that a
    # velocity difference is taken by friction in full.
    if after == STICK:
        return 0.0, 1.0
    # Reversal: orbits that differ by dw arrive |dw/fall| apart, a time in which only one of them has reversed.
    fall = net - limit * before
    return (net - limit * after) / fall, limit * (after - before) / fall


@inner
def stuck_impulse(body: Any, tau: float, x: float, r: float) -> float:
    """Integrate the net force over a time r of stick that starts at tau."""
    pushed = impulse_of_load(body, tau, r)
    return pushed - r * (2.0 * body.damping * body.belt_speed + x + 0.5 * body.belt_speed * r)


class Fixed(NamedTuple):
    """Fixed point, the map from it, its residual |map - state|, and the number of maps computed."""

    x: float
    w: float
    map: Passage
    residual: float
    maps: int


@inner
def periodic_state(body: Any, x: float, w: float, most: int) -> Fixed:
    """Find the periodic state near (x, w).

    Damped Newton's method, with iterations of the map where it does not converge.

    Where the map is smooth the residual decreases along a Newton step, so a step that is too long is shortened first:
    the onset of stick or of slip changes the derivative abruptly.
    """
    x_next, w_next, here, size, maps, stalled = x, w, unknown(x, w), math.inf, 0, 0
    share, picard, work = 1.0, True, 0
    while True:
        # The trial state and its image: a Newton step or an iteration of the map, whichever was proposed.
        trial = passage(body, x_next, w_next, 0.0, body.period)
        trial_size = math.hypot(trial.x - x_next, trial.w - w_next)
        maps, work = maps + 1, work + trial.legs
        # A Newton step counts if the residual falls in proportion to it. An iteration of the map always counts: it
        # never increases the distance to the fixed point. Four in a row without gain near rounding end the search.
        if picard or trial_size < (1.0 - 0.25 * share) * size:
            stuck = picard and trial_size >= size and size < 1e3 * rounding(body, x, w)
            stalled = stalled + 1 if stuck else 0
            share = 1.0 if picard else min(1.0, 4.0 * share)
            x, w, here, size = x_next, w_next, trial, trial_size
        else:
            share = 0.25 * share
        if trial.legs >= MOST_LEGS or work > LEGS_IN_ALL or not trial_size < math.inf:
            return Fixed(x, w, here, math.inf, maps)
        if size <= rounding(body, x, w) or maps >= most or stalled >= 4:
            return Fixed(x, w, here, size, maps)
        dx, dw = newton_correction(here, x, w)
        # Without a usable Newton step: one iteration of the map, or of many periods at once for a mass in stick.
        picard = share < SHORTEST or not abs(dx) + abs(dw) < math.inf
        x_next, w_next = x + share * dx, w + share * dw
        if picard:
            x_next, w_next = here.x + whole_periods_of_stick(body, here), here.w


@inner
def unknown(x: float, w: float) -> Passage:
    """Return a passage of no time: the state before the first map."""
    return Passage(x, w, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0, 0.0, 0.0)


@inner
def newton_correction(here: Passage, x: float, w: float) -> tuple[float, float]:
    """Solve (I - M) step = map - state; infinite where M has the eigenvalue 1."""
    a, b, c, d = 1.0 - here.xx, -here.xw, -here.wx, 1.0 - here.ww
    determinant = a * d - b * c
    if abs(determinant) < 1e-14:
        return math.inf, math.inf
    rx, rw = here.x - x, here.w - w
    return (d * rx - b * rw) / determinant, (a * rw - c * rx) / determinant


@inner
def room_to_stick(body: Any, x: float) -> float:
    """Return how far the belt may still draw the spring before the worst instant of the loads overcomes friction."""
    drawn = 2.0 * body.damping * body.belt_speed + x
    if body.belt_speed > 0.0:
        return body.friction + body.varying.table[LOWEST] - drawn
    return body.friction - body.varying.table[HIGHEST] + drawn


@inner
def whole_periods_of_stick(body: Any, here: Passage) -> float:
    """Return the displacement of a mass that sticks, over all whole periods until friction is exceeded."""
    if here.stick < body.period or body.belt_speed == 0.0:
        return 0.0
    carried = abs(body.belt_speed) * body.period
    room = room_to_stick(body, here.x) - carried
    return math.copysign(max(math.floor(room / carried), 0.0) * carried, body.belt_speed)


@inner
def scales(body: Any, x: float, w: float) -> tuple[float, float]:
    """Return the magnitudes of the numbers whose rounding errors enter x and w over one period."""
    length = body.size + body.friction + abs(x)
    speed = largest_swing(body) + abs(body.belt_speed) + abs(w)
    reach = min(body.period, 1.0)
    return length + reach * speed, speed + reach * length


@inner
def rounding(body: Any, x: float, w: float) -> float:
    """A residual that rounding alone can explain."""
    sx, sw = scales(body, x, w)
    return 4.0 * EPSILON * (sx + sw)


@inner
def impulse_error(body: Any, fixed: Fixed) -> float:
    """Bound the error of the friction impulse over one period.

    It is residual and rounding of the map, times the sensitivity of the steady state to them, by the adjoint of the
    map.
    """
    # (of_x, of_w) = (by_x, by_w) (I - M)^-1: the change of the impulse when the map is perturbed in x or w and the
    # fixed point moves accordingly.
    here = fixed.map
    a, b, c, d = 1.0 - here.xx, -here.xw, -here.wx, 1.0 - here.ww
    determinant = a * d - b * c
    of_x = abs((here.by_x * d - here.by_w * c) / determinant)
    of_w = abs((here.by_w * a - here.by_x * b) / determinant)
    sx, sw = scales(body, fixed.x, fixed.w)
    # Every leg rounds the state once more.
    share = 2.0 * EPSILON * (4.0 + here.legs)
    dx = abs(here.x - fixed.x) + share * sx
    dw = abs(here.w - fixed.w) + share * sw
    carried = (2.0 * of_x + abs(here.by_x)) * dx + (2.0 * of_w + abs(here.by_w)) * dw
    return carried + 4.0 * EPSILON * (4.0 + here.legs) * body.friction * body.period


@inner
def largest_multiplier(here: Passage) -> float:
    """Return the largest modulus of the eigenvalues of the derivative of the map."""
    # The modulus of a complex pair, or the larger one of a real pair, which is free of cancellation.
    half, determinant = 0.5 * (here.xx + here.ww), here.xx * here.ww - here.xw * here.wx
    square = half * half - determinant
    if square < 0.0:
        return math.sqrt(determinant)
    return abs(half) + math.sqrt(square)


FAR_ABOVE = 100.0


@inner
def friction_free_start(body: Any) -> tuple[float, float]:
    """Return the steady state at tau = 0 if slip never reverses: the response to the loads and to friction."""
    side = math.copysign(1.0, body.belt_speed)
    _, _, u, speed, _ = response_at(body, 0.0, -side)
    if body.varying.steady:
        return u + side * body.friction, speed - body.belt_speed
    # On a belt so fast that slip keeps its sign the map is linear: one step of Newton's method solves it.
    far = at_piece(body, 0, side * FAR_ABOVE * (body.size + largest_swing(body)))
    x, w = u + side * body.friction, speed - far.belt_speed
    dx, dw = newton_correction(passage(far, x, w, 0.0, body.period), x, w)
    if abs(dx) + abs(dw) < math.inf:
        x, w = x + dx, w + dw
    return x, w + (far.belt_speed - body.belt_speed)
