"""Interpolation that adds no wiggle: between two points the curve stays between their values."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


class Monotone(NamedTuple):
    """A continuously differentiable piecewise cubic through points, without overshoot; see ``monotone``."""

    x: Floats
    y: Floats
    slope: Floats

    def __call__(self, at: ArrayLike) -> Floats:
        """The values at any places; those outside the points take the value of the nearest one."""
        x = np.clip(np.asarray(at, dtype=np.float64), self.x[0], self.x[-1])
        left = np.clip(np.searchsorted(self.x, x, side="right") - 1, 0, len(self.x) - 2)
        width = self.x[left + 1] - self.x[left]
        rise = (self.y[left + 1] - self.y[left]) / width
        s = x - self.x[left]
        square = (3.0 * rise - 2.0 * self.slope[left] - self.slope[left + 1]) / width
        cube = (self.slope[left] + self.slope[left + 1] - 2.0 * rise) / width**2
        return np.asarray(self.y[left] + s * (self.slope[left] + s * (square + s * cube)))


def monotone(x: Floats, y: Floats) -> Monotone:
    """The monotone cubic through points, x strictly rising, at least two of them.

    Slopes of the parabola through each point and its neighbours, limited so that nothing overshoots: second
    order on any spacing and, unlike the harmonic mean of the chords, third where the curve is smooth.

    Source: Steffen, Astron. Astrophys. 239 (1990), Eqs. 8, 11, 24-27.
    """
    width = np.diff(x)
    chord = np.diff(y) / width
    if len(chord) == 1:
        return Monotone(x, y, np.repeat(chord, 2))
    before, after = chord[:-1], chord[1:]
    parabola = (before * width[1:] + after * width[:-1]) / (width[1:] + width[:-1])
    least = np.minimum(np.minimum(np.abs(before), np.abs(after)), 0.5 * np.abs(parabola))
    inner = (np.sign(before) + np.sign(after)) * least
    first = _end_slope(chord[0], chord[1], width[0] / (width[0] + width[1]))
    last = _end_slope(chord[-1], chord[-2], width[-1] / (width[-1] + width[-2]))
    return Monotone(x, y, np.concatenate(([first], inner, [last])))


def _end_slope(near: float, far: float, share: float) -> float:
    """The slope of the parabola at an end, between zero and twice the chord."""
    parabola = near + (near - far) * share
    low, high = sorted((0.0, 2.0 * near))
    return min(max(parabola, low), high)
