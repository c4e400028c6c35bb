"""One mass on a moving belt under Coulomb friction: closed-form legs of slip and stick between events.

In slip of constant sign, the position x of the canonical scene (oscillator.py) is the response to the loads plus a
free oscillation about -friction*sign; in stick it moves with the belt. A leg ends at the latest at the next corner of
a load, normal load or belt velocity, which may make the mass slide or stick. An event is the first zero of a function
whose third derivative is bounded over the whole leg: every step goes at most to the first zero of a cubic below the
function. It therefore cannot pass an event, not even a grazing pair of zeros, and converges to the event from the
left with third order.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.methods.exact.forcing import JUMP, PIECE_COLUMNS, START
from frictionlab.methods.exact.oscillator import (
    at_piece,
    holding_at,
    largest_push,
    largest_swing,
    response_at,
)
from frictionlab.values.quantities import EPSILON

_TINY = 1e-300
STICK = 0.0
MOST_CREEPING = 1000
"""Most steps of rounding size in a leg; more give NaN: the motion is smaller than the rounding of its position."""
STEPS_IN_A_LEG = 1_000_000
"""Most steps of any size in a leg; more give NaN."""


class LegEnd(NamedTuple):
    """End of a leg: its duration, the state there, the net force, the leg that follows.

    limit: of friction there. event: 1.0 if it ended in an event. keep, turn, damp: those of ``free_motion``, which
    are the entries of the derivative by the state at the start.
    """

    duration: float
    x: float
    w: float
    net: float
    limit: float
    following: float
    event: float
    keep: float
    turn: float
    damp: float


@inner
def free_motion(body: Any, r: float) -> tuple[float, float, float]:
    """Return C + b S, S and C - b S, which lead from the state of the free motion to that a time r later.

    C and S: exp(-b r) times cos and sin/rate (cosh and sinh where overdamped), critical damping included.
    """
    # Overdamped: cosh and sinh overflow where exp(-b r) underflows, so the slow exponential is taken out first.
    b, rate = body.damping, body.rate
    if b < 1.0:
        e = math.exp(-b * r)
        c, s = e * math.cos(rate * r), e * math.sin(rate * r) / rate
    else:
        slow = math.exp(-r / (b + rate))
        gone = math.expm1(-2.0 * rate * r)
        c, s = slow, slow * r
        if rate > 0.0:
            c, s = slow * (1.0 + 0.5 * gone), -slow * gone / (2.0 * rate)
    return c + b * s, s, c - b * s


@inner
def first_zero(g: float, g1: float, g2: float, bound: float) -> float:
    """Return a lower bound, close to it, of the first positive zero of g + g1 r + g2 r^2/2 - bound r^3/6; g >= 0."""
    # The cubic first bends upwards and then, for good, downwards. ``base`` is a place before its first zero from
    # which on it only falls, ever faster; -1 if the first zero lies on the way down before that.
    discriminant = g2 * g2 + 2.0 * bound * g1
    base = -1.0  # not known yet
    if g1 >= 0.0:
        # It rises at first: base is its maximum, written for either sign of g2 without cancellation.
        root = math.sqrt(discriminant)
        base = (g2 + root) / bound if g2 >= 0.0 else 2.0 * g1 / (root - g2)
    elif g2 <= 0.0:
        # It falls ever faster from the start.
        base = 0.0
    else:
        # It falls to a local minimum (or an inflection) first: a zero before it is reached by Newton from 0.
        root = math.sqrt(max(discriminant, 0.0))
        bottom = -2.0 * g1 / (g2 + root) if discriminant > 0.0 else g2 / bound
        if g + bottom * (g1 + bottom * (0.5 * g2 - bottom * bound / 6.0)) > 0.0:
            base = (g2 + root) / bound
    if base >= 0.0:
        return _zero_beyond(base, g, g1, g2, bound)
    return _zero_of_the_convex_part(g, g1, g2, bound)


@inner
def _cubic(r: float, g: float, g1: float, g2: float, bound: float) -> float:
    return g + r * (g1 + r * (0.5 * g2 - r * bound / 6.0))


@inner
def _zero_of_the_convex_part(g: float, g1: float, g2: float, bound: float) -> float:
    """Approach the zero by Newton's method from 0: the cubic is convex there, so every step stays below the zero."""
    r = 0.0
    for _ in range(8):
        step = -_cubic(r, g, g1, g2, bound) / (g1 + r * (g2 - 0.5 * bound * r))
        if not step > 1e-3 * r:
            break
        r = r + step
    return r


@inner
def _zero_beyond(base: float, g: float, g1: float, g2: float, bound: float) -> float:
    """Approach the zero beyond ``base``, where the cubic is concave.

    Newton's method comes from above, then the chord, which ends below the zero.
    """
    height = max(_cubic(base, g, g1, g2, bound), 0.0)
    if height == 0.0:
        return base
    slope = max(-(g1 + base * (g2 - 0.5 * bound * base)), _TINY)
    bend = max(bound * base - g2, _TINY)
    # Each of the three terms alone would bring the cubic to zero there: all together do so earlier.
    r = min(height / slope, math.sqrt(2.0 * height / bend), (6.0 * height / bound) ** (1.0 / 3.0))
    below = height
    for _ in range(6):
        below = r * (slope + r * (0.5 * bend + r * bound / 6.0))
        excess = below - height
        if excess <= 1e-3 * height:
            break
        r = r - excess / (slope + r * (bend + 0.5 * bound * r))
    # r is at or beyond the zero of a concave function: its chord from base crosses zero before the function does.
    return base + r * height / max(below, height)


@inner
def _slip_cubic(body: Any, sign: float, y: float, z: float, response: Any) -> tuple[float, float, float]:
    """Return the rate of the slip speed, the rate of that, and a bound on the third derivative.

    response: of ``response_at`` here.
    """
    load, load_rate, u, speed, _ = response
    b = body.damping
    free = -2.0 * b * z - y
    forced = load - 2.0 * b * speed - u
    # The free oscillation never grows, so its present size bounds its third derivative over the rest of the leg;
    # that of the response is bounded by jolt.
    third = -2.0 * b * free - z
    fourth = -2.0 * b * third - free
    bend = sign * (third + load_rate - 2.0 * b * forced - speed)
    bound = max(math.sqrt(third * third + fourth * fourth) + body.jolt, _TINY)
    return sign * (free + forced), bend, bound


@inner
def slip_leg(body: Any, tau: float, x: float, w: float, sign: float, left: float) -> LegEnd:
    """Follow slip of one sign from (x, w) at tau until it stops, for at most ``left``."""
    friction, response = body.friction * sign, response_at(body, tau, sign)
    load, _, u, speed, limit = response
    # (y, z): the free oscillation, what is left of x and x' without the response and the static shift by friction.
    y0, z0 = x - u + friction, w + (body.belt_speed - speed)
    noise = slip_noise(body, y0, z0)
    y, z, r = y0, z0, 0.0
    keep, turn, damp, event, crept, steps = 1.0, 0.0, 1.0, 0.0, 0, 0
    while r < left:
        slope, bend, bound = _slip_cubic(body, sign, y, z, response)
        if r > 0.0:
            w = z + (speed - body.belt_speed)
        g, falls, step = sign * w, slope < 0.0 and r > 0.0, 0.0
        touches = g <= noise  # the zero the leg starts from, or a touch: look for the next one
        if not (touches and falls):
            step = first_zero(0.0 if touches else g, max(slope, 0.0) if touches else slope, bend, bound)
        # A step below the rounding of the time would not move: the slip is zero to rounding, which ends it if it
        # falls, or it starts so flat that a few steps of rounding size must carry it away from zero.
        least = EPSILON * (tau + r + 1e-3 * body.period)
        if step < least:
            if falls:
                event = 1.0
                break
            step, crept = 8.0 * least, crept + 1
        steps += 1
        if crept > MOST_CREEPING or steps > STEPS_IN_A_LEG:
            y = math.nan
            break
        r = min(r + step, left)
        # Always from the start of the leg, so that rounding does not accumulate over its steps.
        response = response_at(body, tau + r, sign)
        load, _, u, speed, limit = response
        keep, turn, damp = free_motion(body, r)
        y, z = keep * y0 + turn * z0, damp * z0 - turn * y0
    x = y + (u - friction)
    if event == 0.0:
        return LegEnd(r, x, z + (speed - body.belt_speed), 0.0, 0.0, sign, 0.0, keep, turn, damp)
    # At zero slip velocity the net force without friction decides between stick and slip to either side.
    net = load + sign * (limit - body.friction) - 2.0 * body.damping * body.belt_speed - x
    return LegEnd(r, x, 0.0, net, limit, after_rest(net, limit), 1.0, keep, turn, damp)


@inner
def slip_noise(body: Any, y: float, z: float) -> float:
    """Bound on the rounding error of a slip velocity."""
    return (
        4.0 * EPSILON * (abs(z) + min(body.period, 1.0) * abs(y) + largest_swing(body) + abs(body.belt_speed))
    )


@inner
def after_rest(net: float, limit: float) -> float:
    """Return the leg after slip velocity zero under this net force: stick, or slip along the force."""
    if abs(net) <= limit:
        return STICK
    return math.copysign(1.0, net)


@inner
def stick_leg(body: Any, tau: float, x: float, left: float) -> LegEnd:
    """Follow rest on the belt from x at tau until the net force exceeds friction, for at most ``left``."""
    carried = 2.0 * body.damping * body.belt_speed
    noise = 4.0 * EPSILON * (body.friction + body.load + abs(x) + abs(carried))
    bound = max(largest_push(body), _TINY)
    r, event, side, net, crept, steps = 0.0, 0.0, 1.0, 0.0, 0, 0
    lost = False
    while True:
        load, load_rate, load_bend, limit, limit_rate, limit_bend = holding_at(body, tau + r)
        net = load - carried - (x + body.belt_speed * r)
        if r >= left:
            break
        slope = load_rate - body.belt_speed
        step = left
        # Friction can be exceeded to either side; the step goes to the first zero of the nearer cubic.
        for direction in (1.0, -1.0):
            margin, rise = limit - direction * net, limit_rate - direction * slope
            curve = limit_bend - direction * load_bend
            if margin <= noise and (rise < 0.0 or (rise == 0.0 and curve < 0.0)):
                event, side = 1.0, direction
                break
            # At the limit to rounding but moving away from it: look for the next zero. Where it stays there, a load
            # that is constant between corners, rounding is no event.
            if margin <= noise:
                margin, rise = noise if rise == 0.0 and curve == 0.0 else 0.0, max(rise, 0.0)
            step = min(step, first_zero(margin, rise, curve, bound))
        if event != 0.0:
            break
        least = 8.0 * EPSILON * (tau + r + 1e-3 * body.period)
        crept, steps = crept + 1 if step < least else crept, steps + 1
        lost = crept > MOST_CREEPING or steps > STEPS_IN_A_LEG
        r = left if lost else min(r + max(step, least), left)
    x = math.nan if lost else x + body.belt_speed * r
    return LegEnd(r, x, 0.0, net, limit, side * event, event, 1.0, 0.0, 0.0)


@inner
def starting_mode(body: Any, tau: float, x: float, w: float) -> float:
    """Return the mode at an arbitrary state, slip of either sign or stick; slip of rounding size is zero."""
    load, _, u, _, limit = response_at(body, tau, 0.0)
    if abs(w) > slip_noise(body, x - u, w):
        return math.copysign(1.0, w)
    return after_rest(load - 2.0 * body.damping * body.belt_speed - x, limit)


@inner
def cross_corner(body: Any, x: float, w: float, mode: float) -> tuple[Any, float, float, float]:
    """Return, at the end of a piece, the body in the next one, the slip velocity and the mode there, and the
    derivative of that velocity by the one before."""
    varying = body.varying
    if varying.smooth:
        return body, w, mode, 1.0
    following = body.piece + 1 if body.piece + 1 < varying.segments else 0
    body, at = at_piece(body, following, body.belt_speed), varying.pieces + PIECE_COLUMNS * following
    w = w - varying.table[at + JUMP]
    after = starting_mode(body, varying.table[at + START], x, w)
    # Every velocity near zero becomes zero where the mass comes to rest here, as at the end of a leg of slip.
    return body, w, after, 0.0 if after == STICK and mode != STICK else 1.0
