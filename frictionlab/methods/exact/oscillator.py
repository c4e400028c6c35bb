"""Canonical scene of a mass under Coulomb friction, and its functions of time.

    y'' + 2 damping y' + y + (friction + press) Sgn(w) = load,    w = y' - belt_speed.

y is the position less the path of the belt's vibration (forcing.py), so that the load holds what the belt does to
spring, dashpot and inertia, and w jumps where the belt's velocity does; press is what the normal load adds to the
limit of friction.

Licence of one wave alone in closed form: as a sum of one wave curves take 1.14 to 1.24 times as long (list
``standard`` of the benchmarks).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.compile.stack import items_of
from frictionlab.methods.exact.forcing import (
    ARC,
    BELT,
    FREQUENCY,
    GROWING,
    GROWS,
    HEAD,
    LINE,
    LOAD,
    PARABOLA,
    PATH,
    PIECE_COLUMNS,
    PRESS,
    PRESSED,
    PUSH,
    RAMP,
    RESPONSE,
    START,
    STOP,
    SWING,
    WAVE_COLUMNS,
    Forcing,
)


class Held(NamedTuple):
    """Forcing as kernels hold it: a bare pointer to the table, whose references nobody counts.

    terms: count of the waves. pieces: place of the first of ``segments`` pieces. Others: as in ``Forcing``.
    """

    table: Any
    terms: int
    pieces: int
    segments: int
    smooth: bool
    presses: bool
    steady: bool
    alone: bool


class Oscillator(NamedTuple):
    """Canonical scene at one belt speed; ``piece``: the one that holds now.

    rate: |1 - damping^2|^(1/2); friction: its limit under the mean normal load; size, load, jolt: of ``Forcing``.
    """

    damping: float
    rate: float
    period: float
    friction: float
    belt_speed: float
    size: float
    load: float
    jolt: float
    piece: int
    varying: Held


@inner
def oscillator_at(forcing: Forcing, belt_speed: float) -> Oscillator:
    """Return the canonical scene at this belt speed, in its first piece; the forcing must outlive it."""
    # (1 - a)(1 + a) keeps the digits that 1 - a^2 loses near critical damping.
    b = forcing.damping
    rate = math.sqrt(abs((1.0 - b) * (1.0 + b)))
    flags = forcing.smooth, forcing.presses, forcing.steady, forcing.alone
    pieces = HEAD + WAVE_COLUMNS * forcing.terms
    held = Held(items_of(forcing.table), forcing.terms, pieces, forcing.segments, *flags)
    bounds = forcing.size, forcing.load, forcing.jolt
    return Oscillator(b, rate, forcing.period, forcing.friction, belt_speed, *bounds, 0, held)


@inner
def at_piece(body: Oscillator, piece: int, belt_speed: float) -> Oscillator:
    """Return the body where this piece holds, on this belt."""
    numbers = body.damping, body.rate, body.period, body.friction
    bounds = body.size, body.load, body.jolt
    return Oscillator(*numbers, belt_speed, *bounds, piece, body.varying)


@inner
def piece_at(body: Oscillator) -> int:
    """Return the place of the current piece in the table."""
    return body.varying.pieces + PIECE_COLUMNS * body.piece


@inner
def next_corner(body: Oscillator, end: float) -> float:
    """Return when the piece ends, at the latest ``end``."""
    return min(end, body.varying.table[piece_at(body) + STOP])


@inner
def response_at(body: Oscillator, tau: float, sign: float) -> tuple[float, float, float, float, float]:
    """Return, in slip of this sign, the load less sign*press and its rate, the response to it and its velocity, and
    the limit of friction."""
    varying = body.varying
    if not varying.alone:
        return _response_in_general(body, tau, sign)
    table = varying.table
    frequency = table[HEAD + FREQUENCY]
    sine, cosine = math.sin(frequency * tau), math.cos(frequency * tau)
    s, c = table[HEAD + LOAD], table[HEAD + LOAD + 1]
    load, rate = s * sine + c * cosine, frequency * (s * cosine - c * sine)
    s, c = table[HEAD + RESPONSE], table[HEAD + RESPONSE + 1]
    return load, rate, s * sine + c * cosine, frequency * (s * cosine - c * sine), body.friction


@inner
def _response_in_general(
    body: Oscillator, tau: float, sign: float
) -> tuple[float, float, float, float, float]:
    varying, at = body.varying, piece_at(body)
    table = varying.table
    load, rate, u, speed, press = 0.0, 0.0, 0.0, 0.0, 0.0
    if not varying.smooth:
        r, twice = tau - table[at + START], 2.0 * body.damping
        press, more = table[at + RAMP] + table[at + RAMP + 1] * r, table[at + RAMP + 1]
        load = table[at + PARABOLA] + r * (table[at + PARABOLA + 1] + 0.5 * r * table[at + PARABOLA + 2])
        load, rate = (
            load - sign * press,
            table[at + PARABOLA + 1] + r * table[at + PARABOLA + 2] - sign * more,
        )
        u = table[at + ARC] + r * (table[at + ARC + 1] + 0.5 * r * table[at + ARC + 2])
        u, speed = (
            u - sign * (press - twice * more),
            table[at + ARC + 1] + r * table[at + ARC + 2] - sign * more,
        )
    for j in range(varying.terms):
        row = HEAD + WAVE_COLUMNS * j
        frequency = table[row + FREQUENCY]
        sine, cosine = math.sin(frequency * tau), math.cos(frequency * tau)
        s, c = table[row + LOAD], table[row + LOAD + 1]
        p, q = table[row + RESPONSE], table[row + RESPONSE + 1]
        if varying.presses:
            s, c = s - sign * table[row + PRESS], c - sign * table[row + PRESS + 1]
            p, q = p - sign * table[row + PRESSED], q - sign * table[row + PRESSED + 1]
            press = press + (table[row + PRESS] * sine + table[row + PRESS + 1] * cosine)
        load, rate = load + (s * sine + c * cosine), rate + frequency * (s * cosine - c * sine)
        u, speed = u + (p * sine + q * cosine), speed + frequency * (p * cosine - q * sine)
        if table[row + GROWS] != 0.0:
            s, c = (
                table[row + GROWING] - sign * table[row + PRESS],
                table[row + GROWING + 1] - sign * table[row + PRESS + 1],
            )
            more_u, more_speed = _growing_response(body, tau, frequency, s, c)
            u, speed = u + more_u, speed + more_speed
    return load, rate, u, speed, body.friction + press


@inner
def _growing_response(
    body: Oscillator, tau: float, frequency: float, s: float, c: float
) -> tuple[float, float]:
    """Return the response to s sin + c cos from rest at tau = 0, without the cancellation of the periodic one.

    With lambda = -b + i rate and zeta = u' - conj(lambda) u,
    zeta' = lambda zeta + Im((s + i c) exp(i frequency tau));
    in real numbers, since complex ones take numba a second to compile.
    """
    # exp(i frequency tau) is nearly in resonance with lambda: its integral ("near") is written as
    # free * tau * (exp(z) - 1)/z with small z, which loses no digits; that of its conjugate is "far".
    b, both = body.damping, frequency + body.rate
    size = math.exp(-b * tau)
    free, free_i = size * math.cos(body.rate * tau), size * math.sin(body.rate * tau)
    detuning = (frequency - 1.0) + b * b / (1.0 + body.rate)
    quotient, quotient_i = _exponential_quotient(b * tau, detuning * tau)
    near = tau * (free * quotient - free_i * quotient_i)
    near_i = tau * (free * quotient_i + free_i * quotient)
    square = b * b + both * both
    gap = (math.cos(frequency * tau) - free) / square
    gap_i = (-math.sin(frequency * tau) - free_i) / square
    far, far_i = gap * b - gap_i * both, gap_i * b + gap * both
    u = -0.5 * (s * (near - far) - c * (near_i + far_i)) / body.rate
    return u, 0.5 * (s * (near_i - far_i) + c * (near + far)) - b * u


@inner
def _exponential_quotient(z: float, z_i: float) -> tuple[float, float]:
    """Return real and imaginary part of (exp(z) - 1)/z for complex z."""
    square = z * z + z_i * z_i
    if square > 0.25:
        size = math.exp(z)
        a, b = size * math.cos(z_i) - 1.0, size * math.sin(z_i)
        return (a * z + b * z_i) / square, (b * z - a * z_i) / square
    total, total_i, term, term_i = 1.0, 0.0, 1.0, 0.0
    for n in range(2, 14):
        term, term_i = (term * z - term_i * z_i) / n, (term * z_i + term_i * z) / n
        total, total_i = total + term, total_i + term_i
    return total, total_i


@inner
def holding_at(body: Oscillator, tau: float) -> tuple[float, float, float, float, float, float]:
    """Return the load, its rate and the rate of that; the limit of friction, its rate and the rate of that."""
    varying = body.varying
    if not varying.alone:
        return _holding_in_general(body, tau)
    table = varying.table
    frequency = table[HEAD + FREQUENCY]
    sine, cosine = math.sin(frequency * tau), math.cos(frequency * tau)
    s, c = table[HEAD + LOAD], table[HEAD + LOAD + 1]
    load, rate = s * sine + c * cosine, frequency * (s * cosine - c * sine)
    return load, rate, -frequency * frequency * load, body.friction, 0.0, 0.0


@inner
def _holding_in_general(body: Oscillator, tau: float) -> tuple[float, float, float, float, float, float]:
    varying, at = body.varying, piece_at(body)
    table = varying.table
    load, rate, bend, press, more, curve = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if not varying.smooth:
        r = tau - table[at + START]
        load = table[at + PARABOLA] + r * (table[at + PARABOLA + 1] + 0.5 * r * table[at + PARABOLA + 2])
        rate, bend = table[at + PARABOLA + 1] + r * table[at + PARABOLA + 2], table[at + PARABOLA + 2]
        press, more = table[at + RAMP] + table[at + RAMP + 1] * r, table[at + RAMP + 1]
    for j in range(varying.terms):
        row = HEAD + WAVE_COLUMNS * j
        frequency = table[row + FREQUENCY]
        sine, cosine = math.sin(frequency * tau), math.cos(frequency * tau)
        s, c = table[row + LOAD], table[row + LOAD + 1]
        now, later = s * sine + c * cosine, frequency * (s * cosine - c * sine)
        load, rate, bend = load + now, rate + later, bend - frequency * frequency * now
        if varying.presses:
            s, c = table[row + PRESS], table[row + PRESS + 1]
            now, later = s * sine + c * cosine, frequency * (s * cosine - c * sine)
            press, more, curve = press + now, more + later, curve - frequency * frequency * now
    return load, rate, bend, body.friction + press, more, curve


@inner
def largest_push(body: Oscillator) -> float:
    """Bound the third derivative of load + press and load - press."""
    return body.varying.table[PUSH]


@inner
def largest_swing(body: Oscillator) -> float:
    """Bound the velocity of the response."""
    return body.varying.table[SWING]


@inner
def impulse_of_load(body: Oscillator, tau: float, r: float) -> float:
    """Integrate the load over a time r from tau on."""
    total = _integral_of_waves(body.varying, LOAD, tau, r)
    if body.varying.smooth:
        return total
    table, at = body.varying.table, piece_at(body)
    s, bend = tau - table[at + START], table[at + PARABOLA + 2]
    value = table[at + PARABOLA] + s * (table[at + PARABOLA + 1] + 0.5 * s * bend)
    return total + r * (value + r * (0.5 * (table[at + PARABOLA + 1] + s * bend) + r * bend / 6.0))


@inner
def impulse_of_limit(body: Oscillator, tau: float, r: float) -> float:
    """Integrate the limit of friction over a time r from tau on."""
    if not body.varying.presses:
        return body.friction * r
    table, at = body.varying.table, piece_at(body)
    press = table[at + RAMP] + table[at + RAMP + 1] * (tau - table[at + START] + 0.5 * r)
    return (body.friction + press) * r + _integral_of_waves(body.varying, PRESS, tau, r)


@inner
def _integral_of_waves(varying: Held, column: int, tau: float, r: float) -> float:
    total, table = 0.0, varying.table
    for j in range(varying.terms):
        row = HEAD + WAVE_COLUMNS * j
        frequency = table[row + FREQUENCY]
        half = 0.5 * frequency * r
        angle = frequency * tau + half
        middle = table[row + column] * math.sin(angle) + table[row + column + 1] * math.cos(angle)
        total = total + 2.0 / frequency * math.sin(half) * middle
    return total


@inner
def vibration_at(body: Oscillator, tau: float) -> tuple[float, float]:
    """Return path and velocity of the belt's vibration."""
    varying, at = body.varying, piece_at(body)
    table = varying.table
    r = tau - table[at + START]
    path = table[at + PATH] + r * (table[at + LINE] + 0.5 * r * table[at + LINE + 1])
    velocity = table[at + LINE] + r * table[at + LINE + 1]
    for j in range(varying.terms):
        row = HEAD + WAVE_COLUMNS * j
        frequency = table[row + FREQUENCY]
        sine, cosine = math.sin(frequency * tau), math.cos(frequency * tau)
        path = path + (table[row + BELT + 1] * sine - table[row + BELT] * cosine) / frequency
        velocity = velocity + (table[row + BELT] * sine + table[row + BELT + 1] * cosine)
    return path, velocity
