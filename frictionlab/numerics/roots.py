"""Zeros of many monotone functions at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from frictionlab.quantities import Floats


def monotone_root(function: Callable[[Floats], Floats], low: Floats, high: Floats) -> Floats:
    """Where a function of each row crosses zero between low and high, to rounding; an end where it does not.

    Vectorised over rows: inverse quadratic steps kept inside a bracket that at least halves when they stall
    (Chandrupatla, Advances in Engineering Software 28, 1997).
    """
    a, b = low.copy(), high.copy()
    fa, fb = function(a), function(b)
    away = np.sign(fa) == np.sign(fb)
    nearer = np.where(np.abs(fa) < np.abs(fb), a, b)
    c, fc, step = a.copy(), fa.copy(), np.full(len(a), 0.5)
    for _ in range(100):
        at = a + step * (b - a)
        value = function(at)
        same = np.sign(value) == np.sign(fa)
        c, fc = np.where(same, a, b), np.where(same, fa, fb)
        b, fb = np.where(same, b, a), np.where(same, fb, fa)
        a, fa = at, value
        best, least = np.where(np.abs(fa) < np.abs(fb), a, b), np.minimum(np.abs(fa), np.abs(fb))
        width = np.abs(b - c)
        tolerance = 0.5 * (4e-16 * np.abs(best) + 1e-300) / np.where(width > 0.0, width, 1.0)
        done = away | (tolerance > 0.5) | (least == 0.0)
        if done.all():
            break
        step = np.clip(
            _step(a, fa, b, fb, c, fc), np.minimum(tolerance, 0.5), 1.0 - np.minimum(tolerance, 0.5)
        )
        step = np.where(done, 0.0, step)
    return np.where(away, nearer, best)


def _step(a: Floats, fa: Floats, b: Floats, fb: Floats, c: Floats, fc: Floats) -> Floats:
    """Inverse quadratic interpolation where it is safe, else the middle, as a share of the way from a to b."""
    with np.errstate(divide="ignore", invalid="ignore"):
        xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
        safe = (phi**2 < xi) & ((1.0 - phi) ** 2 < 1.0 - xi)
        step = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
    return np.where(safe & np.isfinite(step), step, 0.5)
