"""Mean Coulomb friction under prescribed slip, and that of compliant contacts with soft or stiff bristles.

Slip velocity is -belt_speed plus that of a sine of displacement amplitude X. ratio is belt speed over
velocity amplitude, presliding is the presliding length over X. A mean is relative to the friction coefficient
of steady sliding. ``reversal_kick`` is the effect of stiff bristles on a body after a reversal.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from frictionlab.scene.waveforms import form_of
from frictionlab.theory.loops import moment
from frictionlab.theory.piecewise import Piecewise
from frictionlab.values.quantities import EPSILON, Floats


def mean_prescribed_longitudinal(ratio: ArrayLike, waveform: str = "sine") -> Floats:
    """Compute mean Coulomb friction under a slip along the belt of this waveform; it is 1 from ratio 1 on.

    Sine: (2/pi) arcsin(ratio). Triangle and sawtooth, whose velocity is spread evenly: ratio. Parabola, the
    integral of a triangle: 1 - sqrt(1 - ratio). Square: 0, and NaN at ratio 1, where slip rests for half of
    the period. Any oscillation gives 2 CDF(v_b) - 1, with CDF(v) the share of time that its velocity is
    below v.

    Parameters
    ----------
    ratio : array_like of float
        Belt speed over the amplitude of the slip velocity [-], any sign.
    waveform : {"sine", "triangle", "sawtooth", "parabola", "square"}, default "sine"
        Waveform of the slip velocity.

    Returns
    -------
    numpy.ndarray of float
        Mean friction [coefficient of steady sliding].

    References
    ----------
    Sulollari, van Dalen & Cabboi, Eq. 5; of waveforms Michaux, Ferri & Cunefare (2008).
    """
    speed = np.asarray(ratio, dtype=np.float64)
    if waveform in _SMOOTH:
        return np.copysign(_SMOOTH[waveform](np.minimum(np.abs(speed), 1.0)), speed)
    form, mean = form_of(waveform), np.full(speed.shape, -1.0)
    for line, (length, end) in zip(form.lines, form.ends, strict=True):
        mean = mean + 2.0 * float(length) * _share_below(speed, float(line.value), float(end))
    return mean


def _share_below(speed: Floats, start: float, end: float) -> Floats:
    """Return the share of time that a straight line is below a speed.

    It is NaN if the line is level at that speed: slip then rests.
    """
    if start == end:
        return np.where(speed == start, np.nan, speed > start)
    return np.clip((speed - min(start, end)) / abs(end - start), 0.0, 1.0)


_SMOOTH: dict[str, Callable[[Floats], Floats]] = {
    "sine": lambda size: 2.0 / np.pi * np.arcsin(size),
    "parabola": lambda size: size / (1.0 + np.sqrt(1.0 - size)),
}


def mean_prescribed_pulsating(ratio: ArrayLike, amplitude: ArrayLike, phase: ArrayLike) -> Floats:
    """Compute mean Coulomb friction under a sine along the belt and a pulsating normal load.

    The load 1 + amplitude*sin leads the oscillation of the slip velocity by a phase. The mean is (2/pi)
    [arcsin(ratio) - amplitude sqrt(1 - ratio^2) cos(phase)] up to ratio 1. A load that is larger at positive
    slip velocity pushes the body back and lowers the mean, which may become negative.

    Parameters
    ----------
    ratio : array_like of float
        Belt speed over the amplitude of the slip velocity [-], any sign.
    amplitude : array_like of float
        Amplitude of the normal load over its mean [-].
    phase : array_like of float
        Phase of the load against the oscillation of the slip velocity [rad].

    Returns
    -------
    numpy.ndarray of float
        Mean friction [coefficient of steady sliding].

    Notes
    -----
    The result is -<n(t) sgn(w(t))>: the load n is integrated between reversals of the slip velocity w, with
    the sign of w.
    """
    size = np.clip(np.asarray(ratio, dtype=np.float64), -1.0, 1.0)
    pushed = np.asarray(amplitude) * np.sqrt((1.0 - size) * (1.0 + size)) * np.cos(phase)
    return np.asarray(2.0 / np.pi * (np.arcsin(size) - pushed))


class MeanDirection(NamedTuple):
    """Mean -<n sgn(w)> and its error by rounding.

    at_rest: integral of the normal load n over the time at zero slip, divided by the period.
    """

    mean: float
    error: float
    at_rest: float


def mean_direction(slip: Piecewise, normal_load: Piecewise) -> MeanDirection:
    """Compute mean Coulomb friction under any slip along the belt and any normal load.

    The mean is relative to the friction coefficient.

    It is -<n(t) sgn(w(t))>. The normal load n, of mean 1, is integrated in closed form between the corners
    and the zeros of the slip velocity w, at which w may change its sign. Both functions have the same pieces.
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
    """Compute mean Coulomb friction along the belt under a sinusoidal slip across it.

    It is (2/pi) k' K(k), with k = 1/sqrt(1 + ratio^2) the modulus and k' = ratio k the complementary one. It
    starts with an infinite slope and tends to 1.

    Parameters
    ----------
    ratio : array_like of float
        Belt speed over the amplitude of the slip velocity [-], any sign.

    Returns
    -------
    numpy.ndarray of float
        Mean friction [coefficient of steady sliding].

    References
    ----------
    Mean of ratio/sqrt(ratio^2 + sin^2), by Byrd & Friedman (1971).
    """
    from scipy.special import ellipkm1

    size = np.abs(np.asarray(ratio, dtype=np.float64))
    complement = size / np.hypot(1.0, size)
    first = ellipkm1(
        np.maximum(complement, 1e-150) ** 2
    )  # a smaller number has square zero, at which K is infinite
    return np.copysign(2.0 / np.pi * complement * first, ratio)


def mean_prescribed_circular(ratio: ArrayLike) -> Floats:
    """Compute mean Coulomb friction along the belt under circular slip.

    The oscillation of the slip velocity is circular: constant speed, direction turning at a constant rate. It
    is added to -belt_speed. The mean is (2/pi) [E(k) - (1 - k^2) K(k)]/k with modulus k = ratio up to 1, and
    (2/pi) E(1/ratio) from there on: Landen's transformation of [(1 + r) E(m) - (1 - r) K(m)]/(pi r),
    m = 4r/(1 + r)^2, which loses digits at small r. The difference up to 1 is k^2 (1 - k^2) R_D(0, 1,
    1 - k^2)/3 (DLMF 19.25.1), where nothing cancels.

    Parameters
    ----------
    ratio : array_like of float
        Belt speed over the speed of the circular slip [-], any sign.

    Returns
    -------
    numpy.ndarray of float
        Mean friction [coefficient of steady sliding].

    References
    ----------
    Derivative of the mean slip speed with respect to belt speed; elliptic integrals in the notation of
    Byrd & Friedman (1971).
    """
    from scipy.special import ellipe, elliprd

    size = np.abs(np.asarray(ratio, dtype=np.float64))
    slow = np.where(size < 1.0, size, 0.0)
    fast = 1.0 / np.where(size > 1.0, size, np.inf)
    complement = (1.0 - slow) * (1.0 + slow)
    below = slow * complement * elliprd(0.0, 1.0, complement) / 3.0
    mean = np.where(size < 1.0, below, np.where(size > 1.0, ellipe(fast**2), 1.0))
    return np.copysign(2.0 / np.pi * mean, ratio)


def slip_back_and_forth(ratio: ArrayLike) -> tuple[Floats, Floats]:
    """Compute distances slipped backward and forward per period, under a sine along the belt.

    Forward is the direction of the mean slip. The distances are 2 (sin t - t cos t) backward, and that plus
    2 pi cos t forward, with cos t = ratio. From ratio 1 on the distance backward is 0.

    Parameters
    ----------
    ratio : array_like of float
        Belt speed over velocity amplitude [-], any sign.

    Returns
    -------
    back, forth : numpy.ndarray of float
        Distances slipped against and along the mean slip [X].
    """
    size = np.abs(np.asarray(ratio, dtype=np.float64))
    angle = np.arccos(np.minimum(size, 1.0))
    small = moment(np.where(angle < 1.0, angle, 0.0), -1.0)
    back = 2.0 * np.where(angle < 1.0, small, np.sin(angle) - angle * np.cos(angle))
    return np.asarray(back), np.asarray(back + 2.0 * np.pi * size)


def _share_back(ratio: ArrayLike) -> Floats:
    back, forth = slip_back_and_forth(ratio)
    return np.asarray(back / forth)


def mean_soft_dahl(ratio: ArrayLike, exponent: float = 1.0) -> Floats:
    """Compute mean Dahl friction under a sine along the belt with soft bristles, (1 - r)/(1 + r).

    r = (distance slipped backward/distance forward)^(1/exponent). For exponent 1 the mean is the mean
    velocity over the mean speed, as for LuGre friction of constant g. The error at finite stiffness is of
    order presliding^-2.

    Parameters
    ----------
    ratio : array_like of float
        Belt speed over velocity amplitude [-], any sign.
    exponent : float, default 1.0
        Exponent of the law [-], > 0.

    Returns
    -------
    numpy.ndarray of float
        Mean friction [coefficient of steady sliding].

    References
    ----------
    Averaging Dahl (1968) over a period in which friction hardly changes.
    """
    remains = _share_back(ratio) ** (1.0 / exponent)
    return np.copysign((1.0 - remains) / (1.0 + remains), ratio)


def mean_soft_transverse(ratio: ArrayLike) -> Floats:
    """Compute mean friction of soft vectorial Dahl or LuGre bristles under a sine across the belt.

    It is the mean velocity over the mean speed, ratio/[(2/pi) sqrt(1 + ratio^2) E(1/sqrt(1 + ratio^2))], and
    lies below Coulomb's.

    Parameters
    ----------
    ratio : array_like of float
        Belt speed over velocity amplitude [-], any sign.

    Returns
    -------
    numpy.ndarray of float
        Mean friction along the belt [coefficient of steady sliding].

    Notes
    -----
    The result is found by averaging, as in ``mean_soft_dahl``.
    """
    from scipy.special import ellipe

    size = np.asarray(ratio, dtype=np.float64)
    whole = np.hypot(1.0, size)
    return np.asarray(0.5 * np.pi * size / whole / ellipe(1.0 / whole**2))


def mean_soft_circular(ratio: ArrayLike) -> Floats:
    """Compute mean friction of soft vectorial Dahl or LuGre bristles under a circular slip.

    It is the mean velocity over the mean speed, ratio/[(2/pi) (1 + ratio) E(2 sqrt(ratio)/(1 + ratio))], and
    lies above Coulomb's.

    Parameters
    ----------
    ratio : array_like of float
        Belt speed over the speed of the circular slip [-], any sign.

    Returns
    -------
    numpy.ndarray of float
        Mean friction along the belt [coefficient of steady sliding].

    Notes
    -----
    The result is found by averaging, as in ``mean_soft_dahl``.
    """
    from scipy.special import ellipe

    size = np.abs(np.asarray(ratio, dtype=np.float64))
    whole = 1.0 + size
    mean = 0.5 * np.pi * size / whole / ellipe(4.0 * size / whole**2)
    return np.copysign(mean, ratio)


def mean_soft_elasto_plastic(ratio: ArrayLike, breakaway_ratio: float) -> Floats:
    """Compute mean elasto-plastic friction of constant g under a sine along the belt, with soft bristles.

    The mean m has the sign of the belt speed. Its magnitude solves |m| alpha(|m|) = 1 - distance slipped
    backward/distance forward, with alpha rising from 0 at breakaway_ratio to 1 at 1. Bristles are elastic
    below breakaway, so |m| >= breakaway_ratio at any belt speed.

    Parameters
    ----------
    ratio : array_like of float
        Belt speed over velocity amplitude [-], not 0.
    breakaway_ratio : float
        Breakaway deflection over that of steady sliding [-], in (0, 1).

    Returns
    -------
    numpy.ndarray of float
        Mean friction m [coefficient of steady sliding].

    References
    ----------
    Averaging Dupont et al. (2002), IEEE TAC 47, 787, as ``mean_soft_dahl``.
    """
    from scipy.optimize.elementwise import find_root

    def excess(mean: Floats, wanted: Floats) -> Floats:
        turn = np.pi * (mean - 0.5 * (1.0 + breakaway_ratio)) / (1.0 - breakaway_ratio)
        return np.asarray(mean * (0.5 + 0.5 * np.sin(turn)) - wanted)

    found = find_root(excess, (breakaway_ratio, 1.0), args=(1.0 - _share_back(ratio),))
    return np.copysign(found.x, ratio)


def mean_soft_jenkins(ratio: ArrayLike, presliding: ArrayLike) -> Floats:
    """Compute mean Jenkins friction under a sine along the belt, exact if the slider never slips back.

    It is 1 - (mean distance of the slip behind its running maximum)/presliding. It tends to 1 for soft
    springs.

    Parameters
    ----------
    ratio : array_like of float
        Belt speed over velocity amplitude [-], > 0 or < 0.
    presliding : array_like of float
        Presliding length [X], > 0.

    Returns
    -------
    numpy.ndarray of float
        Mean friction [coefficient of steady sliding]; NaN if the distance slipped backward is more
        than twice the presliding length.

    Notes
    -----
    The model is the play operator of the spring in series with the slider.
    """
    from scipy.optimize.elementwise import find_root

    def gain(phase: Floats, size: Floats, most: Floats) -> Floats:
        return np.asarray(size * phase + np.sin(phase) - most)

    size = np.minimum(np.abs(np.asarray(ratio, dtype=np.float64)), 1.0)
    turn = np.arccos(-size)
    most = size * turn + np.sin(turn)
    again = find_root(gain, (2.0 * np.pi - turn, 2.0 * np.pi + turn), args=(size, most)).x
    behind = most * (again - turn) - 0.5 * size * (again**2 - turn**2) + np.cos(again) - np.cos(turn)
    back, length = slip_back_and_forth(ratio)[0], np.asarray(presliding, dtype=np.float64)
    mean = np.where(back <= 2.0 * length, 1.0 - behind / (2.0 * np.pi * length), np.nan)
    return np.copysign(mean, ratio)


def stiff_correction(ratio: ArrayLike, exponent: float = 1.0) -> Floats:
    """Compute (mean of a stiff Dahl contact - Coulomb's) divided by presliding, the presliding length over X.

    The slip is a sine along the belt. The result is (2/(3 pi)) H ratio/(1 - ratio^2), with
    H = 2^(1 - i)/(2 - i) the path, in presliding lengths, over which the jump of friction at a reversal is
    spread. H is 1 for exponent i = 1, and for 0, an ideal spring that slips (Jenkins). The terms in
    sqrt(presliding) of the two reversals of a period cancel.

    Parameters
    ----------
    ratio : array_like of float
        Belt speed over velocity amplitude [-], in (-1, 1), not near its ends.
    exponent : float, default 1.0
        Exponent i of the law [-], >= 0.

    Returns
    -------
    numpy.ndarray of float
        Difference of the means over presliding [coefficient of steady sliding]. It is infinite for i >= 2,
        where the difference falls more slowly.

    Notes
    -----
    The result is an expansion of ``dahl_path`` after both reversals.
    """
    felt = 2.0 ** (1.0 - exponent) / (2.0 - exponent) if exponent < 2.0 else math.inf
    size = np.asarray(ratio, dtype=np.float64)
    return np.asarray(2.0 / (3.0 * np.pi) * felt * size / ((1.0 - size) * (1.0 + size)))


def reversal_kick(friction: float, acceleration: float) -> float:
    """Compute velocity after a reversal minus that under Coulomb friction, per root of the presliding length.

    After a reversal Dahl friction of exponent 1 changes its sign over a path of a presliding length d. Over
    that path friction still pushes forward and adds to the velocity. With q = path/d, kick/sqrt(d) is the
    integral over q > 0 of 2 f exp(-q)/sqrt(2 a q + 4 f (1 - exp(-q))). So the mean of a free body differs
    from Coulomb's by a term of order sqrt(d), that of a prescribed slip by one of order d.

    Parameters
    ----------
    friction : float
        Largest friction force f per unit mass, > 0.
    acceleration : float
        Acceleration a of the slip after friction has reversed, > 0.

    Returns
    -------
    float
        Velocity per square root of the presliding length.

    Notes
    -----
    The result follows from the energy of x'' = a + 2 f exp(-x/d) from rest, by the trapezoidal rule in
    sqrt(q), exact to rounding.
    """
    root = 0.05 * np.arange(-140, 141) + 0.025
    square = root**2
    speed = np.sqrt(2.0 * acceleration - 4.0 * friction * np.expm1(-square) / square)
    return float(0.05 * np.sum(2.0 * friction * np.exp(-square) / speed))
