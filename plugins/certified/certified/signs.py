"""Check of every leg of an enclosed orbit: slip of one sign, or stick that friction holds.

From a time at which a function g and its rate g' are known, g >= g0 + g0' h - M h^2/2 where |g''| <= M: as far as
that is positive no zero can be passed. At its end a leg may come to the zero of g that ends it.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from flint import arb, ctx

from certified.forces import SmoothPiece, TimeCourse
from certified.motion import (
    Mechanics,
    NotProved,
    Values,
    forced_motion,
    free_flow,
    integral,
    net_course,
    values_at,
)
from certified.system import Event, EventState, OrbitLeg, leg_parts, legs

MOST_MARCHED = 20_000
MOST_DESCENTS = 6
SPARE_OF_TIME = 28
"""Bits below those of a time that a step may not reach."""
NOT_HELD = "friction cannot hold the mass where stick is to begin"
PASSED = "slip comes to rest, or friction's limit is reached, before the leg ends"
SMALLEST_BEND = 1e-300
REACH = 0.97
"""Share of a step's bound that is gone."""


class Beyond(NamedTuple):
    """Distance beyond zero of a function that was to be positive.

    bend: its second derivative there, at the start of stick its first. x: position.
    """

    excess: float
    bend: float
    x: float = 0.0


_UNKNOWN = Beyond(0.0, 0.0)


class Wrong(NotProved):
    """Mistake in a leg, which is not what it is taken for.

    leg: its number. after: how long after its start [1/omega_1]. beyond: the function that shows it, where that is
    known. side: of friction's limit, in stick.
    """

    def __init__(self, what: str, leg: int, after: float, beyond: Beyond = _UNKNOWN, side: int = 0) -> None:
        super().__init__(what)
        self.leg, self.after, self.beyond, self.side = leg, after, beyond, side


class NoReversal(Wrong):
    """Mistake of a reversal at which friction holds the mass."""


class NoStick(Wrong):
    """Mistake of a stick in which friction cannot hold the mass."""


class Rise(NamedTuple):
    """Function that must be positive: its value, its rate, a bound on its bend from there on, and the position."""

    value: Any
    rate: Any
    bound: Any
    x: Any


def check_signs(mechanics: Mechanics, nodes: tuple[Event, ...], states: tuple[EventState, ...]) -> None:
    """Raise NotProved where a leg is not what it is taken for, anywhere in the box of states."""
    forces = mechanics.forces
    for node, state in zip(nodes, states, strict=True):
        piece = forces.pieces[node.piece]
        if not (node.fixed or forces.smooth or (state.tau > piece.start and state.tau < piece.stop)):
            raise NotProved("an event may be at a corner of the forces")
    for place, leg in enumerate(legs(nodes, states)):
        before = nodes[place - 1].sign
        if leg.node.sign:
            _check_slip(mechanics, leg, before, place)
        else:
            _check_stick(mechanics, leg, place)


def net_force(mechanics: Mechanics, piece: SmoothPiece, state: EventState) -> tuple[Values, Values]:
    """Return what friction has to hold on a mass that moves with the belt, and friction's limit."""
    load, belt, pressed = (
        values_at(each, piece.start, state.tau) for each in (piece.load, piece.belt, piece.normal_load)
    )
    b = mechanics.b
    held = Values(
        load.value - 2 * b * belt.value - state.x - belt.rate,
        load.rate - 2 * b * belt.rate - belt.value - belt.bend,
        arb(0),
    )
    return held, Values(mechanics.mu * pressed.value, mechanics.mu * pressed.rate, arb(0))


class SlipSign(NamedTuple):
    """Slip velocity times its sign in a part of a leg within a piece; u, u1: the free motion at its start ``low``."""

    sign: int
    b: Any
    forced: TimeCourse
    piece: SmoothPiece
    low: Any
    u: Any
    u1: Any

    @classmethod
    def of(cls, mechanics: Mechanics, sign: int, part: tuple[SmoothPiece, Any], x: Any, v: Any) -> SlipSign:
        """Make it from this position and velocity."""
        piece, low = part
        forced = forced_motion(net_course(mechanics, piece, sign), mechanics.b)
        first = values_at(forced, piece.start, low)
        return cls(sign, mechanics.b, forced, piece, low, x - first.value, v - first.rate)

    def __call__(self, r: Any) -> Rise:
        """Return the function a time r after the start."""
        now, belt = (
            values_at(each, self.piece.start, self.low + r) for each in (self.forced, self.piece.belt)
        )
        y, y1, y2, y3, _ = self.free(r)
        return Rise(
            self.sign * (now.rate + y1 - belt.value),
            self.sign * (now.bend + y2 - belt.rate),
            derivative_bound(self.forced, 3) + derivative_bound(self.piece.belt, 2) + hypotenuse(y2, y3),
            now.value + y,
        )

    def free(self, r: Any) -> tuple[Any, ...]:
        """Return the free motion and its first four derivatives; two neighbours of them never grow in size."""
        motion = free_flow(self.b, r)
        found = [
            motion.keep * self.u + motion.turn * self.u1,
            motion.damp * self.u1 - motion.turn * self.u,
        ]
        for _ in range(3):
            found.append(-2 * self.b * found[-1] - found[-2])
        return tuple(found)

    def state(self, r: Any) -> tuple[Any, Any]:
        """Return position and velocity."""
        now, (y, y1, *_) = values_at(self.forced, self.piece.start, self.low + r), self.free(r)
        return now.value + y, now.rate + y1


class Margin(NamedTuple):
    """Distance of what friction holds in stick to its limit on one side, in a part of a leg within a piece."""

    side: int
    mechanics: Mechanics
    piece: SmoothPiece
    low: Any
    x: Any

    def __call__(self, r: Any) -> Rise:
        """Return the function a time r after the start."""
        b, belt = self.mechanics.b, self.piece.belt
        held, limit = net_force(
            self.mechanics, self.piece, EventState(self.low + r, self.position(r), arb(0))
        )
        bend = (
            derivative_bound(self.piece.load, 2)
            + 2 * b * derivative_bound(belt, 2)
            + derivative_bound(belt, 1)
            + derivative_bound(belt, 3)
        )
        return Rise(
            limit.value - self.side * held.value,
            limit.rate - self.side * held.rate,
            bend + self.mechanics.mu * derivative_bound(self.piece.normal_load, 2),
            self.position(r),
        )

    def position(self, r: Any) -> Any:
        """Return the position of the mass, which goes with the belt."""
        return self.x + integral(self.piece.belt, self.piece.start, self.low, self.low + r)


def _check_slip(mechanics: Mechanics, leg: OrbitLeg, before: int, place: int) -> None:
    x, v, passed = leg.start.x, leg.start.v, 0.0
    every = leg_parts(mechanics.forces, leg)
    for k, (piece, low, high) in enumerate(every):
        slip, length, r = (
            SlipSign.of(mechanics, leg.node.sign, (piece, low), x, v),
            _length(low, high),
            arb(0),
        )
        if k == 0 and not leg.node.slides:
            r = _leave(mechanics, leg, before, slip, place, length)
        elif (k == 0 or piece.belt_jumps) and not slip(r).value > 0:
            raise Wrong("slip has the other sign after a jump of the belt", place, passed)
        ends = k == len(every) - 1 and not (leg.after.fixed and leg.after.slides)
        _march(slip, r, length, ends, place, passed)
        x, v = slip.state(length)
        passed += float(length.mid())


def _leave(mechanics: Mechanics, leg: OrbitLeg, before: int, slip: SlipSign, place: int, length: Any) -> Any:
    """Return how long slip from zero is sure to have its sign; 0 where it is at once driven that way."""
    sign, piece, start = leg.node.sign, slip.piece, slip(arb(0))
    if leg.node.fixed and piece.belt_jumps:
        if not start.value > 0:
            raise Wrong("the belt's jump does not make the mass slip this way", place, 0.0)
        return arb(0)
    if before or leg.node.fixed:
        if not start.rate > 0:
            raise NoReversal("friction holds the mass where slip is to reverse", place, 0.0)
        return arb(0)
    # Released from stick, by an excess that grows from zero.
    held, limit = net_force(mechanics, piece, leg.start)
    grows = sign * held.rate - limit.rate
    if not grows > 0:
        raise Wrong("friction's limit is not passed where stick is to end", place, 0.0)
    *_, y3, y4 = slip.free(arb(0))
    third = derivative_bound(slip.forced, 4) + derivative_bound(piece.belt, 3) + hypotenuse(y3, y4)
    far = 3 * REACH * grows / third
    return arb(min(float(far.lower()), 0.5 * float(length.mid())))


def _check_stick(mechanics: Mechanics, leg: OrbitLeg, place: int) -> None:
    x, passed = leg.start.x, 0.0
    every = leg_parts(mechanics.forces, leg)
    for k, (piece, low, high) in enumerate(every):
        length = _length(low, high)
        if k > 0 and piece.belt_jumps:
            raise NotProved("the belt's velocity jumps in stick")
        for side in (1, -1):
            margin = Margin(side, mechanics, piece, low, x)
            first = margin(arb(0))
            if not first.value > 0:
                excess, rate = -float(first.value.mid()), float(first.rate.mid())
                raise NoStick(NOT_HELD, place, passed, Beyond(excess, rate), side)
            released = k == len(every) - 1 and not leg.after.fixed and leg.after.sign == side
            try:
                _march(margin, arb(0), length, released, place, passed)
            except Wrong as problem:
                problem.side = side
                raise
        x = Margin(1, mechanics, piece, low, x).position(length)
        passed += float(length.mid())


def _length(low: Any, high: Any) -> Any:
    if not high > low:
        raise NotProved("the order of two events is not sure")
    return high - low


def hypotenuse(a: Any, b: Any) -> Any:
    """Return sqrt(a^2 + b^2), where rounding may leave intervals that reach below zero."""
    return (a * a + b * b).nonnegative_part().sqrt()


def derivative_bound(course: TimeCourse, order: int) -> Any:
    """Return a bound on the derivative of this order of its waves; of its line where that is not zero."""
    total = abs(course.slope) if order == 1 else arb(0)
    for frequency, sine, cosine in course.waves:
        total = total + hypotenuse(sine, cosine) * frequency**order
    return total


def _march(function: Any, r: Any, length: Any, ends: bool, place: int, passed: float) -> None:
    """Check that from a time r on the function stays positive; ``ends``: until it falls to zero at the end."""
    last = function(length)
    if ends and not last.rate < 0:
        raise NotProved("an event does not cross zero")
    end, at, now, scale = length.lower(), r, function(r), max(1.0, float(length.mid()))
    for _ in range(MOST_MARCHED):
        if ends and (length - at) * now.bound < -2 * last.rate:
            return
        step, left = REACH * _reach(now), float((end - at).mid())
        if not ends and step >= left and last.value > 0:
            return
        step = min(step, REACH * left)
        if not step > 2.0 ** (SPARE_OF_TIME - ctx.prec) * scale:
            raise _below_zero(function, at, length, place, passed)
        at = (at + step).mid()
        now = function(at)
        if not now.value > 0:
            raise _below_zero(function, at, length, place, passed)
    raise NotProved("the motion changes too fast to be followed")


def _below_zero(function: Any, at: Any, length: Any, place: int, passed: float) -> Wrong:
    """Return the lowest point near a time where a function is no longer positive."""
    small = length.mid() * arb(2) ** -40
    for _ in range(MOST_DESCENTS):
        now, bend = function(at), (function(at + small).rate - function(at - small).rate) / (2 * small)
        if not bend > 0:
            break
        at = (at - now.rate / bend).mid()
        if not (at > 0 and at < length):
            break
    else:
        low = function(at)
        excess, turn, x = (float(each.mid()) for each in (-low.value, bend, low.x))
        return Wrong(PASSED, place, passed + float(at), Beyond(excess, turn, x))
    return Wrong(PASSED, place, passed + float(at))


def _reach(now: Rise) -> float:
    """Return a time within which it stays positive, to rounding, which REACH covers."""
    value, rate, bend = float(now.value.lower()), float(now.rate.lower()), float(now.bound.upper())
    value, bend = max(value, 0.0), max(bend, SMALLEST_BEND)
    root = math.sqrt(rate * rate + 2.0 * bend * value)
    return (rate + root) / bend if rate >= 0.0 else 2.0 * value / (root - rate)
