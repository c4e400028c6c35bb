"""Mean Coulomb friction under prescribed slip."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from frictionlab.quantities import EPSILON, Floats
from frictionlab.scene.waveforms import form_of
from frictionlab.theory.piecewise import Piecewise


def mean_prescribed_longitudinal(ratio: ArrayLike, waveform: str = "sine") -> Floats:
    """Mean Coulomb friction under a slip along the belt of this waveform; 1 from ratio 1 on.

    Sine (2/pi) arcsin(ratio); triangle and sawtooth, whose velocity is spread evenly, ratio; parabola, the integral
    of a triangle, 1 - sqrt(1 - ratio); square 0, at ratio 1 NaN: slip then rests for half of the period. Of any
    velocity oscillation 1 - 2 CDF(-v_b), CDF(v) the share of time below v.

    ratio [-]: belt speed over the amplitude of the slip velocity, any sign.
    Source: Sulollari, van Dalen & Cabboi, Eq. 5; of waveforms Michaux, Ferri & Cunefare (2008).
    """
    speed = np.asarray(ratio, dtype=np.float64)
    if waveform in _SMOOTH:
        return np.copysign(_SMOOTH[waveform](np.minimum(np.abs(speed), 1.0)), speed)
    form, mean = form_of(waveform), np.full(speed.shape, -1.0)
    for line, (length, end) in zip(form.lines, form.ends, strict=True):
        mean = mean + 2.0 * float(length) * _share_below(speed, float(line.value), float(end))
    return mean


def _share_below(speed: Floats, start: float, end: float) -> Floats:
    """The share of time that a straight line is below a speed; NaN where it is level there: slip then rests."""
    if start == end:
        return np.where(speed == start, np.nan, speed > start)
    return np.clip((speed - min(start, end)) / abs(end - start), 0.0, 1.0)


_SMOOTH: dict[str, Callable[[Floats], Floats]] = {
    "sine": lambda size: 2.0 / np.pi * np.arcsin(size),
    "parabola": lambda size: size / (1.0 + np.sqrt(1.0 - size)),
}


def mean_prescribed_pulsating(ratio: ArrayLike, amplitude: ArrayLike, phase: ArrayLike) -> Floats:
    """Mean Coulomb friction under a sine along the belt and a normal load 1 + amplitude*sin that leads it by phase.

    (2/pi) [arcsin(ratio) - amplitude sqrt(1 - ratio^2) cos(phase)] up to ratio 1: a load that presses while slip goes
    forward pushes the body back. amplitude: of the load, in shares of its mean; phase [rad] of the load against the
    oscillation of the slip velocity.

    ratio [-]: belt speed over the amplitude of the slip velocity, any sign.
    Source: -<n(t) sgn(w(t))>, the integral of n between the instants at which the slip w reverses.
    """
    size = np.clip(np.asarray(ratio, dtype=np.float64), -1.0, 1.0)
    pushed = np.asarray(amplitude) * np.sqrt((1.0 - size) * (1.0 + size)) * np.cos(phase)
    return np.asarray(2.0 / np.pi * (np.arcsin(size) - pushed))


class MeanDirection(NamedTuple):
    """-<n sgn(w)>, its error by rounding, and the share of the normal load that acts while slip rests."""

    mean: float
    error: float
    at_rest: float


def mean_direction(slip: Piecewise, normal_load: Piecewise) -> MeanDirection:
    """Mean Coulomb friction, relative to its coefficient, under any slip along the belt and any normal load.

    -<n(t) sgn(w(t))>: the normal load n, of mean 1, integrated in closed form between the instants at which the slip
    velocity w changes its sign: its corners and its zeros. Both on the same pieces.
    """
    zeros, edges = slip.crossings(), slip.edges
    cuts = np.unique(np.concatenate([edges, zeros.tau]))
    start, stop = cuts[:-1], cuts[1:]
    middle = 0.5 * (start + stop)
    k = np.clip(np.searchsorted(edges, middle, side="right") - 1, 0, len(edges) - 2)
    share = normal_load.integral(start, stop, k) / slip.period
    rests = slip.at_rest()[k]
    side = np.where(rests, 0.0, np.sign(slip.at(middle, k)[0]))
    unsure = normal_load.size() * float(zeros.unsure.sum()) / slip.period
    mean = -math.fsum((side * share).tolist())
    return MeanDirection(mean, 2.0 * unsure + 16.0 * EPSILON, math.fsum(share[rests].tolist()))


def mean_prescribed_transverse(ratio: ArrayLike) -> Floats:
    """Mean Coulomb friction along the belt under a sinusoidal slip across it.

    (2/pi) k' K(k), with k = 1/sqrt(1 + ratio^2) the modulus and k' = ratio k the complementary one. It starts
    with an infinite slope and tends to 1.

    ratio [-]: belt speed over the amplitude of the slip velocity, any sign.
    Source: the mean of ratio/sqrt(ratio^2 + sin^2), by Byrd & Friedman (1971).
    """
    from scipy.special import ellipkm1

    size = np.abs(np.asarray(ratio, dtype=np.float64))
    complement = size / np.hypot(1.0, size)
    first = ellipkm1(np.maximum(complement, 1e-150) ** 2)  # the square of less is zero, where K is infinite
    return np.copysign(2.0 / np.pi * complement * first, ratio)


def mean_prescribed_circular(ratio: ArrayLike) -> Floats:
    """Mean Coulomb friction along the belt under circular slip: constant speed, direction turning at a constant rate.

    (2/pi) [E(k) - (1 - k^2) K(k)]/k with modulus k = ratio up to 1, (2/pi) E(1/ratio) from there on: Landen's
    transformation of [(1 + r) E(m) - (1 - r) K(m)]/(pi r), m = 4r/(1 + r)^2, which loses digits at small r. The
    difference up to 1 is k^2 (1 - k^2) R_D(0, 1, 1 - k^2)/3 (DLMF 19.25.1), where nothing cancels.

    ratio [-]: belt speed over the speed of the circular slip, any sign.
    Source: gradient of the mean slip speed; elliptic integrals in the notation of Byrd & Friedman (1971).
    """
    from scipy.special import ellipe, elliprd

    size = np.abs(np.asarray(ratio, dtype=np.float64))
    slow = np.where(size < 1.0, size, 0.0)
    fast = 1.0 / np.where(size > 1.0, size, np.inf)
    complement = (1.0 - slow) * (1.0 + slow)
    below = slow * complement * elliprd(0.0, 1.0, complement) / 3.0
    mean = np.where(size < 1.0, below, np.where(size > 1.0, ellipe(fast**2), 1.0))
    return np.copysign(2.0 / np.pi * mean, ratio)
