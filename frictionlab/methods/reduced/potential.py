"""The potential of friction that depends on slip speed alone: its integral over speed, of many speeds at once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats

TABULATED = 1024
"""Speeds of a table at first, closer together near rest."""
MOST_TABULATED = 16384
CLOSE_TABLE = 1e-13
"""Error of a potential, relative to its largest value, at which tables are close enough."""


class Potential(NamedTuple):
    """Of the coefficient + fall*speed, by cubic pieces between speeds, with its slope; up to the last speed.

    error: of its values.
    """

    speeds: Floats
    values: Floats
    slopes: Floats
    error: float

    def at(self, speed: Floats) -> Floats:
        """Its values; NaN beyond the last speed."""
        value, _ = self._both(speed)
        return value

    def slope(self, speed: Floats) -> Floats:
        """Its derivative: friction of this potential itself."""
        return self._both(speed)[1]

    def _both(self, speed: Floats) -> tuple[Floats, Floats]:
        if len(self.speeds) == 1:  # constant friction
            return self.slopes[0] * speed, np.full(speed.shape, self.slopes[0])
        last = len(self.speeds) - 1
        beyond = ~(speed <= self.speeds[-1])
        place = np.sqrt(np.where(beyond, 0.0, speed) / self.speeds[-1]) * last
        k = np.minimum(place.astype(np.int64), last - 1)
        step = self.speeds[k + 1] - self.speeds[k]
        t = (speed - self.speeds[k]) / step
        rise, low, high = (
            self.values[k + 1] - self.values[k],
            step * self.slopes[k],
            step * self.slopes[k + 1],
        )
        square, cube = 3.0 * rise - 2.0 * low - high, low + high - 2.0 * rise
        value = self.values[k] + t * (low + t * (square + t * cube))
        slope = (low + t * (2.0 * square + 3.0 * t * cube)) / step
        return np.where(beyond, np.nan, value), np.where(beyond, np.nan, slope)


def potential_of(law: FrictionLaw, largest_speed: float, fall: float) -> Potential:
    """Of a law of any friction without memory, up to this speed; fall: what is added to make it rise."""
    if law.constant_sliding_friction() and fall == 0.0:
        return Potential(np.zeros(1), np.zeros(1), np.array([law.sliding_friction(1.0)]), 0.0)
    count = TABULATED
    while True:
        found = _tabulated(law, largest_speed, fall, count)
        if found.error <= CLOSE_TABLE * found.values[-1] or count >= MOST_TABULATED:
            return found
        count *= 4


def _tabulated(law: FrictionLaw, largest_speed: float, fall: float, count: int) -> Potential:
    """By Simpson's rule over each piece; its error from pieces twice as long."""
    speeds = largest_speed * (np.arange(2 * count + 1) / (2.0 * count)) ** 2
    middles = 0.5 * (speeds[:-2:2] + speeds[2::2])
    ends = speeds[::2]
    slopes, between = (
        np.array([law.sliding_friction(speed) + fall * speed for speed in each.tolist()])
        for each in (ends, middles)
    )
    steps = np.diff(ends)
    values = np.concatenate([[0.0], np.cumsum(steps / 6.0 * (slopes[:-1] + 4.0 * between + slopes[1:]))])
    found = Potential(ends, values, slopes, 0.0)
    # friction of the cubic pieces against that of the law, where it was not used
    apart = np.abs(found.slope(middles) - between)
    return found._replace(error=float((apart * steps).max()))
