"""Hysteresis loops of friction over slip: Dahl's path, closed loops, their first harmonic, drift.

Friction is relative to its limit mu, lengths to the presliding length mu/stiffness, so a stiffness is relative to
that of the bristles. A describing function is the complex stiffness k + i Omega c of one harmonic of slip.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from frictionlab.values.quantities import Floats

Complexes = NDArray[np.complex128]


def dahl_path(start: ArrayLike, path: ArrayLike, exponent: float = 1.0) -> Floats:
    """Friction after slip of this length in one direction, along which friction is counted, by the law of Dahl.

    u = 1 - friction falls as u' = -sgn(u) |u|^i: exp(-path) for i = 1, else u^(1 - i) = u_0^(1 - i) + (i - 1) path,
    which for i < 1 ends at the limit exactly. Evaluated with log1p to keep all digits for i near 1.

    start [mu]: friction at the beginning, beyond its limit too; path [presliding lengths] >= 0; exponent i >= 0.
    Source: integral of Dahl (1968), Aerospace TOR-0158(3107-18)-1.
    """
    left = 1.0 - np.asarray(start, dtype=np.float64)
    size, length, steeper = np.abs(left), np.asarray(path, dtype=np.float64), exponent - 1.0
    if steeper == 0.0:
        return np.asarray(1.0 - left * np.exp(-length))
    gone = steeper * length * np.where(size > 0.0, size, 1.0) ** steeper
    shrunk = np.log1p(np.where(gone > -1.0, gone, 0.0)) / steeper
    return np.asarray(1.0 - np.where(gone > -1.0, left * np.exp(-shrunk), 0.0))


def dahl_loop_end(amplitude: ArrayLike) -> Floats:
    """Friction where a Dahl loop turns: tanh(amplitude) [mu], for exponent 1.

    amplitude [presliding lengths] of the slip. Source: ``dahl_path`` from -T over twice the amplitude to T.
    """
    return np.tanh(np.asarray(amplitude, dtype=np.float64))


def dahl_loop_area(amplitude: ArrayLike) -> Floats:
    """Work lost per cycle of a Dahl loop: 4 (a - tanh a) [mu presliding length], for exponent 1.

    From (4/3) a^3 for small amplitudes to the 4 a of Coulomb friction. a: amplitude [presliding lengths] >= 0 of
    the slip. Source: integral of ``dahl_path`` around the loop.
    """
    size = np.asarray(amplitude, dtype=np.float64)
    small = np.where(size < 1.0, size, 0.0)
    return np.asarray(4.0 * np.where(size < 1.0, moment(small, 1.0) / np.cosh(small), size - np.tanh(size)))


def moment(x: Floats, sign: float) -> Floats:
    """x cosh x - sinh x for sign 1, sin x - x cos x for sign -1, for |x| < 1, without cancellation.

    The series of 2 n (+-x^2)^(n - 1) x^3/(2 n + 1)!, nine terms.
    """
    square, term, total = sign * x * x, x**3 / 3.0, np.zeros_like(x)
    for n in range(1, 10):
        total = total + term
        term = term * square / (2.0 * n * (2.0 * n + 3.0))
    return np.asarray(total)


def coulomb_describing_function(amplitude: ArrayLike) -> Complexes:
    """Describing function of Coulomb friction: 4 i/(pi amplitude) [mu per unit of length]; no stiffness.

    amplitude > 0 of the slip, in any unit of length. Source: Sulollari, van Dalen & Cabboi, Eq. 9 at v_b = 0.
    """
    return np.asarray(4.0j / (np.pi * np.asarray(amplitude, dtype=np.float64)))


def dahl_describing_function(amplitude: ArrayLike) -> Complexes:
    """Describing function of Dahl friction of exponent 1 [bristle stiffness].

    2 I_1(a)/(a cosh a) + 4 i (a - tanh a)/(pi a^2): 1 for small amplitudes a; for large ones Coulomb's 4 i/(pi a),
    beside which the stiffness fades as 4/(sqrt(2 pi a) a) only.

    amplitude a [presliding lengths] > 0 of the slip. Source: first harmonic of the loop of ``dahl_path``.
    """
    from scipy.special import i1e  # I_1(a) exp(-a)

    size = np.asarray(amplitude, dtype=np.float64)
    stiffness = 4.0 * i1e(size) / size / (1.0 + np.exp(-2.0 * size))
    return np.asarray(stiffness + 1j * (dahl_loop_area(size) / np.pi / size / size))


def jenkins_describing_function(amplitude: ArrayLike) -> Complexes:
    """Describing function of Jenkins friction [spring stiffness]: 1 up to amplitude 1, where the slider moves.

    Beyond, (t - sin(2 t)/2)/pi + 4 i (a - 1)/(pi a^2) with t = arccos(1 - 2/a).

    amplitude a [mu/stiffness] > 0 of the slip. Source: Griffin (1980), J. Eng. Power 102, 329.
    """
    size = np.maximum(np.asarray(amplitude, dtype=np.float64), 1.0)
    angle = 2.0 * np.arcsin(1.0 / np.sqrt(size))  # arccos(1 - 2/a), where a is large too
    double = 2.0 * angle
    gap = np.where(double < 1.0, _less_its_sine(np.where(double < 1.0, double, 0.0)), double - np.sin(double))
    return np.asarray(gap / (2.0 * np.pi) + 4.0j * ((size - 1.0) / (np.pi * size)) / size)


def _less_its_sine(x: Floats) -> Floats:
    """x - sin x for 0 <= x < 1 without cancellation, by its series."""
    term, total = x**3 / 6.0, np.zeros_like(x)
    for n in range(1, 10):
        total = total + term
        term = -term * x * x / ((2.0 * n + 2.0) * (2.0 * n + 3.0))
    return np.asarray(total)


def dahl_drift(least: ArrayLike, largest: ArrayLike) -> Floats:
    """How far a Dahl contact of exponent 1 creeps per cycle of force between two values [presliding lengths].

    ln((1 - least^2)/(1 - largest^2)): positive where the larger of the two in size is, zero where they are opposite.

    least, largest [mu]: the two friction forces, each within (-1, 1).
    Source: ``dahl_path`` from one to the other and back.
    """
    low, high = np.asarray(least, dtype=np.float64), np.asarray(largest, dtype=np.float64)
    return np.asarray((np.log1p(-low) + np.log1p(low)) - (np.log1p(-high) + np.log1p(high)))
