"""Hysteresis loops of friction over slip: Dahl's path, closed loops, their first harmonic, drift.

Friction is relative to its limit mu. Lengths are relative to the presliding length mu/stiffness, so that a
stiffness is relative to that of the bristles. A describing function is the complex stiffness k + i Omega c of
one harmonic of slip.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from frictionlab.values.quantities import Floats

Complexes = NDArray[np.complex128]


def dahl_path(start: ArrayLike, path: ArrayLike, exponent: float = 1.0) -> Floats:
    """Compute Dahl friction after slip of this length in one direction, along which friction is counted.

    u = 1 - friction falls as u' = -sgn(u) |u|^i: exp(-path) for i = 1, else u^(1 - i) = u_0^(1 - i) + (i - 1)
    path, which for i < 1 ends at the limit exactly. The formula is evaluated with log1p to keep all digits
    for i near 1.

    Parameters
    ----------
    start : array_like of float
        Friction at the beginning [mu], also beyond its limit.
    path : array_like of float
        Length of the slip [presliding lengths], >= 0.
    exponent : float, default 1.0
        Exponent i of the law [-], >= 0.

    Returns
    -------
    numpy.ndarray of float
        Friction at the end [mu].

    References
    ----------
    Integral of Dahl (1968), Aerospace TOR-0158(3107-18)-1.
    """
    left = 1.0 - np.asarray(start, dtype=np.float64)
    size, length, steeper = np.abs(left), np.asarray(path, dtype=np.float64), exponent - 1.0
    if steeper == 0.0:
        return np.asarray(1.0 - left * np.exp(-length))
    gone = steeper * length * np.where(size > 0.0, size, 1.0) ** steeper
    shrunk = np.log1p(np.where(gone > -1.0, gone, 0.0)) / steeper
    return np.asarray(1.0 - np.where(gone > -1.0, left * np.exp(-shrunk), 0.0))


def dahl_loop_end(amplitude: ArrayLike) -> Floats:
    """Compute the friction at which a Dahl loop of exponent 1 turns, tanh(amplitude).

    Parameters
    ----------
    amplitude : array_like of float
        Amplitude of the slip [presliding lengths].

    Returns
    -------
    numpy.ndarray of float
        Friction at the end of the loop [mu].

    Notes
    -----
    The result is ``dahl_path`` from -T over twice the amplitude to T.
    """
    return np.tanh(np.asarray(amplitude, dtype=np.float64))


def dahl_loop_area(amplitude: ArrayLike) -> Floats:
    """Compute the work lost per cycle of a Dahl loop of exponent 1, 4 (a - tanh a).

    It grows from (4/3) a^3 for small amplitudes to the 4 a of Coulomb friction.

    Parameters
    ----------
    amplitude : array_like of float
        Amplitude a of the slip [presliding lengths], >= 0.

    Returns
    -------
    numpy.ndarray of float
        Work lost per cycle [mu presliding length].

    Notes
    -----
    The result is the integral of ``dahl_path`` around the loop.
    """
    size = np.asarray(amplitude, dtype=np.float64)
    small = np.where(size < 1.0, size, 0.0)
    return np.asarray(4.0 * np.where(size < 1.0, moment(small, 1.0) / np.cosh(small), size - np.tanh(size)))


def moment(x: Floats, sign: float) -> Floats:
    """Return x cosh x - sinh x for sign 1, sin x - x cos x for sign -1, for |x| < 1, without cancellation.

    It is the series of 2 n (+-x^2)^(n - 1) x^3/(2 n + 1)!, nine terms.
    """
    square, term, total = sign * x * x, x**3 / 3.0, np.zeros_like(x)
    for n in range(1, 10):
        total = total + term
        term = term * square / (2.0 * n * (2.0 * n + 3.0))
    return np.asarray(total)


def coulomb_describing_function(amplitude: ArrayLike) -> Complexes:
    """Compute the describing function of Coulomb friction, 4 i/(pi amplitude); it has no stiffness.

    Parameters
    ----------
    amplitude : array_like of float
        Amplitude of the slip, > 0, in any unit of length.

    Returns
    -------
    numpy.ndarray of complex
        Describing function [mu per unit of length].

    References
    ----------
    Sulollari, van Dalen & Cabboi, Eq. 9 at v_b = 0.
    """
    return np.asarray(4.0j / (np.pi * np.asarray(amplitude, dtype=np.float64)))


def dahl_describing_function(amplitude: ArrayLike) -> Complexes:
    """Compute the describing function of Dahl friction of exponent 1.

    It is 2 I_1(a)/(a cosh a) + 4 i (a - tanh a)/(pi a^2): 1 for small amplitudes a, and Coulomb's 4 i/(pi a)
    for large ones. Beside that, the stiffness fades only as 4/(sqrt(2 pi a) a).

    Parameters
    ----------
    amplitude : array_like of float
        Amplitude a of the slip [presliding lengths], > 0.

    Returns
    -------
    numpy.ndarray of complex
        Describing function [bristle stiffness].

    Notes
    -----
    The result is the first harmonic of the loop of ``dahl_path``.
    """
    from scipy.special import i1e  # I_1(a) exp(-a)

    size = np.asarray(amplitude, dtype=np.float64)
    stiffness = 4.0 * i1e(size) / size / (1.0 + np.exp(-2.0 * size))
    return np.asarray(stiffness + 1j * (dahl_loop_area(size) / np.pi / size / size))


def jenkins_describing_function(amplitude: ArrayLike) -> Complexes:
    """Compute the describing function of Jenkins friction: 1 up to amplitude 1, where the slider moves.

    Beyond, it is (t - sin(2 t)/2)/pi + 4 i (a - 1)/(pi a^2) with t = arccos(1 - 2/a).

    Parameters
    ----------
    amplitude : array_like of float
        Amplitude a of the slip [mu/stiffness], > 0.

    Returns
    -------
    numpy.ndarray of complex
        Describing function [spring stiffness].

    References
    ----------
    Griffin (1980), J. Eng. Power 102, 329.
    """
    size = np.maximum(np.asarray(amplitude, dtype=np.float64), 1.0)
    angle = 2.0 * np.arcsin(1.0 / np.sqrt(size))  # arccos(1 - 2/a), where a is large too
    double = 2.0 * angle
    gap = np.where(double < 1.0, _less_its_sine(np.where(double < 1.0, double, 0.0)), double - np.sin(double))
    return np.asarray(gap / (2.0 * np.pi) + 4.0j * ((size - 1.0) / (np.pi * size)) / size)


def _less_its_sine(x: Floats) -> Floats:
    """Return x - sin x for 0 <= x < 1 without cancellation, by its series."""
    term, total = x**3 / 6.0, np.zeros_like(x)
    for n in range(1, 10):
        total = total + term
        term = -term * x * x / ((2.0 * n + 2.0) * (2.0 * n + 3.0))
    return np.asarray(total)


def dahl_drift(least: ArrayLike, largest: ArrayLike) -> Floats:
    """Compute the creep of a Dahl contact of exponent 1 per cycle of force between two values.

    It is ln((1 - least^2)/(1 - largest^2)): positive if the larger of the two in size is positive, zero if
    they are opposite.

    Parameters
    ----------
    least, largest : array_like of float
        Both friction forces [mu], each within (-1, 1).

    Returns
    -------
    numpy.ndarray of float
        Creep per cycle [presliding lengths].

    Notes
    -----
    The result is ``dahl_path`` from one force to the other and back.
    """
    low, high = np.asarray(least, dtype=np.float64), np.asarray(largest, dtype=np.float64)
    return np.asarray((np.log1p(-low) + np.log1p(low)) - (np.log1p(-high) + np.log1p(high)))
