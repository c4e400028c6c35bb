"""The canonical scene of a mass under Coulomb friction, and its functions of time.

    y'' + 2 damping y' + y + (friction + press) Sgn(w) = load,    w = y' - belt_speed.

One sine: y is the position x, the load is load*sin(frequency tau), press is zero and belt_speed >= 0. What varies
otherwise (forcing.py): y is the position less the path of the belt's vibration, so that the load holds what the belt
does to spring, dashpot and inertia, and w jumps where the belt's velocity does; press is what the normal load adds to
the limit of friction. Functions of time come in two bodies, chosen when kernels are compiled.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_variation
from frictionlab.methods.exact.forcing import (
    ARC,
    BELT,
    FREQUENCY,
    LINE,
    LOAD,
    PARABOLA,
    PATH,
    PRESS,
    PRESSED,
    RAMP,
    RESPONSE,
    START,
    STOP,
    Forcing,
)


class Oscillator(NamedTuple):
    """The canonical scene and its friction-free response in_phase sin + quadrature cos.

    rate: |1 - damping^2|^(1/2); size: bound on the response; jolt: bound on its fourth derivative; resonant: 1.0
    where the response from rest at tau = 0 replaces it (near undamped resonance the periodic one is too large).
    """

    damping: float
    rate: float
    frequency: float
    period: float
    load: float
    friction: float
    belt_speed: float
    in_phase: float
    quadrature: float
    size: float
    jolt: float
    resonant: float


class ForcedOscillator(NamedTuple):
    """The canonical scene under what varies otherwise; ``piece``: of ``varying.pieces``, the one that holds now.

    friction: its limit under the mean normal load.
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
    varying: Forcing


@inner
def free_rate(damping: float) -> float:
    """|1 - damping^2|^(1/2): frequency or rate of the free motion."""
    return math.sqrt(abs((1.0 - damping) * (1.0 + damping)))


RESONANT = 1e-3


@inner
def canonical(
    damping: float, frequency: float, load: float, friction: float, belt_speed: float
) -> Oscillator:
    """The record of a canonical scene."""
    # Written with (1 - a)(1 + a), which keeps the digits that 1 - a^2 loses near critical damping and resonance.
    rate = free_rate(damping)
    stiffness = (1.0 - frequency) * (1.0 + frequency)
    viscous = 2.0 * damping * frequency
    square = stiffness * stiffness + viscous * viscous
    period = 2.0 * math.pi / frequency
    # Near undamped resonance the periodic response is the small difference of large numbers: the growing response
    # from rest is used instead, bounded over one period by the force times the time.
    in_phase, quadrature, size, jolt, resonant = 0.0, 0.0, 4.0 * load, 8.0 * load, 1.0
    if square >= RESONANT * RESONANT:
        size, resonant = load / math.sqrt(square), 0.0
        in_phase, quadrature = load * stiffness / square, -load * viscous / square
        jolt = size * frequency**4
    given = damping, rate, frequency, period, load, friction, belt_speed
    return Oscillator(*given, in_phase, quadrature, size, jolt, resonant)


def _response_to_one_sine(body: Any, tau: float, sign: float) -> tuple[float, float, float, float, float]:
    angle = body.frequency * tau
    sine, cosine = math.sin(angle), math.cos(angle)
    load, rate = body.load * sine, body.load * body.frequency * cosine
    if body.resonant != 0.0:
        u, speed = _growing_response(body, tau, sine, cosine)
        return load, rate, u, speed, body.friction
    u = body.in_phase * sine + body.quadrature * cosine
    speed = body.frequency * (body.in_phase * cosine - body.quadrature * sine)
    return load, rate, u, speed, body.friction


@inner
def _growing_response(body: Oscillator, tau: float, sine: float, cosine: float) -> tuple[float, float]:
    """The response from rest at tau = 0, without the cancellation of the periodic one near resonance.

    With lambda = -b + i rate and zeta = u' - conj(lambda) u, zeta' = lambda zeta + load sin(frequency tau); in real
    numbers, since complex ones take numba a second to compile.
    """
    # The load is made of exp(i frequency tau) and its conjugate. One of them is nearly in resonance with lambda:
    # its integral ("near") is written as free * tau * (exp(z) - 1)/z with small z, which loses no digits.
    b, both = body.damping, body.frequency + body.rate
    size = math.exp(-b * tau)
    free, free_i = size * math.cos(body.rate * tau), size * math.sin(body.rate * tau)
    detuning = (body.frequency - 1.0) + b * b / (1.0 + body.rate)
    quotient, quotient_i = _exponential_quotient(b * tau, detuning * tau)
    near = tau * (free * quotient - free_i * quotient_i)
    near_i = tau * (free * quotient_i + free_i * quotient)
    gap, gap_i = (cosine - free) / (b * b + both * both), (-sine - free_i) / (b * b + both * both)
    far, far_i = gap * b - gap_i * both, gap_i * b + gap * both
    u = -0.5 * body.load * (near - far) / body.rate
    return u, 0.5 * body.load * (near_i - far_i) - b * u


@inner
def _exponential_quotient(z: float, z_i: float) -> tuple[float, float]:
    """Real and imaginary part of (exp(z) - 1)/z for small complex z."""
    total, total_i, term, term_i = 1.0, 0.0, 1.0, 0.0
    for n in range(2, 9):
        term, term_i = (term * z - term_i * z_i) / n, (term * z_i + term_i * z) / n
        total, total_i = total + term, total_i + term_i
    return total, total_i


def _response_to_pieces(body: Any, tau: float, sign: float) -> tuple[float, float, float, float, float]:
    b, waves, piece = body.damping, body.varying.waves, body.varying.pieces[body.piece]
    r = tau - piece[START]
    press, more = piece[RAMP] + piece[RAMP + 1] * r, piece[RAMP + 1]
    load = piece[PARABOLA] + r * (piece[PARABOLA + 1] + 0.5 * r * piece[PARABOLA + 2]) - sign * press
    rate = piece[PARABOLA + 1] + r * piece[PARABOLA + 2] - sign * more
    u = piece[ARC] + r * (piece[ARC + 1] + 0.5 * r * piece[ARC + 2]) - sign * (press - 2.0 * b * more)
    speed = piece[ARC + 1] + r * piece[ARC + 2] - sign * more
    for j in range(waves.shape[0]):
        frequency = waves[j, FREQUENCY]
        sine, cosine = math.sin(frequency * tau), math.cos(frequency * tau)
        s, c = waves[j, LOAD] - sign * waves[j, PRESS], waves[j, LOAD + 1] - sign * waves[j, PRESS + 1]
        load, rate = load + (s * sine + c * cosine), rate + frequency * (s * cosine - c * sine)
        s, c = (
            waves[j, RESPONSE] - sign * waves[j, PRESSED],
            waves[j, RESPONSE + 1] - sign * waves[j, PRESSED + 1],
        )
        u, speed = u + (s * sine + c * cosine), speed + frequency * (s * cosine - c * sine)
        press = press + (waves[j, PRESS] * sine + waves[j, PRESS + 1] * cosine)
    return load, rate, u, speed, body.friction + press


response_at = by_variation(_response_to_one_sine, _response_to_pieces)
"""(body, tau, sign): in slip of this sign the load less sign*press and its rate, the response to it and its velocity,
and the limit of friction."""


def _holding_under_one_sine(body: Any, tau: float) -> tuple[float, float, float, float, float, float]:
    angle = body.frequency * tau
    sine, cosine = math.sin(angle), math.cos(angle)
    rate, bend = body.load * body.frequency * cosine, -body.load * body.frequency**2 * sine
    return body.load * sine, rate, bend, body.friction, 0.0, 0.0


def _holding_in_pieces(body: Any, tau: float) -> tuple[float, float, float, float, float, float]:
    waves, piece = body.varying.waves, body.varying.pieces[body.piece]
    r = tau - piece[START]
    load = piece[PARABOLA] + r * (piece[PARABOLA + 1] + 0.5 * r * piece[PARABOLA + 2])
    rate, bend = piece[PARABOLA + 1] + r * piece[PARABOLA + 2], piece[PARABOLA + 2]
    limit, more, curve = body.friction + (piece[RAMP] + piece[RAMP + 1] * r), piece[RAMP + 1], 0.0
    for j in range(waves.shape[0]):
        frequency = waves[j, FREQUENCY]
        sine, cosine = math.sin(frequency * tau), math.cos(frequency * tau)
        s, c = waves[j, LOAD], waves[j, LOAD + 1]
        now, later = s * sine + c * cosine, frequency * (s * cosine - c * sine)
        load, rate, bend = load + now, rate + later, bend - frequency * frequency * now
        s, c = waves[j, PRESS], waves[j, PRESS + 1]
        now, later = s * sine + c * cosine, frequency * (s * cosine - c * sine)
        limit, more, curve = limit + now, more + later, curve - frequency * frequency * now
    return load, rate, bend, limit, more, curve


holding_at = by_variation(_holding_under_one_sine, _holding_in_pieces)
"""(body, tau): the load, its rate and the rate of that; the limit of friction, its rate and the rate of that."""


largest_push = by_variation(lambda body: body.load * body.frequency**3, lambda body: body.varying.push)
"""(body): a bound on the third derivative of load + press and load - press."""


largest_swing = by_variation(lambda body: body.frequency * body.size, lambda body: body.varying.swing)
"""(body): a bound on the velocity of the response."""


def _load_impulse_of_one_sine(body: Any, tau: float, r: float) -> float:
    half = 0.5 * body.frequency * r
    return 2.0 * body.load / body.frequency * math.sin(half) * math.sin(body.frequency * tau + half)


def _load_impulse_in_pieces(body: Any, tau: float, r: float) -> float:
    piece = body.varying.pieces[body.piece]
    s = tau - piece[START]
    value = piece[PARABOLA] + s * (piece[PARABOLA + 1] + 0.5 * s * piece[PARABOLA + 2])
    slope = piece[PARABOLA + 1] + s * piece[PARABOLA + 2]
    lines = r * (value + r * (0.5 * slope + r * piece[PARABOLA + 2] / 6.0))
    return lines + _integral_of_waves(body.varying.waves, LOAD, tau, r)


@inner
def _integral_of_waves(waves: Any, column: int, tau: float, r: float) -> float:
    """Over a time r from tau on."""
    total = 0.0
    for j in range(waves.shape[0]):
        half = 0.5 * waves[j, FREQUENCY] * r
        angle = waves[j, FREQUENCY] * tau + half
        middle = waves[j, column] * math.sin(angle) + waves[j, column + 1] * math.cos(angle)
        total = total + 2.0 / waves[j, FREQUENCY] * math.sin(half) * middle
    return total


impulse_of_load = by_variation(_load_impulse_of_one_sine, _load_impulse_in_pieces)
"""(body, tau, r): the integral of the load over a time r from tau on."""


def _limit_impulse_of_one_sine(body: Any, tau: float, r: float) -> float:
    return body.friction * r


def _limit_impulse_in_pieces(body: Any, tau: float, r: float) -> float:
    piece = body.varying.pieces[body.piece]
    press = piece[RAMP] + piece[RAMP + 1] * (tau - piece[START] + 0.5 * r)
    return (body.friction + press) * r + _integral_of_waves(body.varying.waves, PRESS, tau, r)


impulse_of_limit = by_variation(_limit_impulse_of_one_sine, _limit_impulse_in_pieces)
"""(body, tau, r): the integral of the limit of friction over a time r from tau on."""


def _belt_steady(body: Any, tau: float) -> tuple[float, float]:
    return 0.0, 0.0


def _belt_in_pieces(body: Any, tau: float) -> tuple[float, float]:
    waves, piece = body.varying.waves, body.varying.pieces[body.piece]
    r = tau - piece[START]
    path = piece[PATH] + r * (piece[LINE] + 0.5 * r * piece[LINE + 1])
    velocity = piece[LINE] + r * piece[LINE + 1]
    for j in range(waves.shape[0]):
        frequency = waves[j, FREQUENCY]
        sine, cosine = math.sin(frequency * tau), math.cos(frequency * tau)
        path = path + (waves[j, BELT + 1] * sine - waves[j, BELT] * cosine) / frequency
        velocity = velocity + (waves[j, BELT] * sine + waves[j, BELT + 1] * cosine)
    return path, velocity


vibration_at = by_variation(_belt_steady, _belt_in_pieces)
"""(body, tau): path and velocity of the belt's vibration."""


next_corner = by_variation(lambda body, end: end, lambda body, end: body.varying.pieces[body.piece, STOP])
"""(body, end): when the piece ends; ``end`` where there are none."""


with_piece = by_variation(lambda body, piece: body, lambda body, piece: _forced(body, body.belt_speed, piece))
"""(body, piece): the body where this piece holds."""


piece_of = by_variation(lambda body: 0, lambda body: body.piece)
"""(body): the piece that holds."""


@inner
def with_belt_speed(body: ForcedOscillator, belt_speed: float) -> ForcedOscillator:
    """The body on another belt, in its first piece."""
    return _forced(body, belt_speed, 0)


@inner
def _forced(body: ForcedOscillator, belt_speed: float, piece: int) -> ForcedOscillator:
    numbers = body.damping, body.rate, body.period, body.friction
    bounds = body.size, body.load, body.jolt
    return ForcedOscillator(*numbers, belt_speed, *bounds, piece, body.varying)


count_pieces = by_variation(lambda body: 1, lambda body: body.varying.pieces.shape[0])
"""(body): in a period."""


shortest_period = by_variation(lambda body: body.period, lambda body: body.varying.shortest)
"""(body): in which a force may turn round."""
