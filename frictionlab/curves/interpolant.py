"""Interpolation of a friction curve between its points, from rest to the end of reversal."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from frictionlab.values.quantities import Floats

LEAST_POINTS = 8
"""Fewest points below the end of reversal for which a curve is interpolated."""
WIDEST_GAP = 0.2
"""Widest gap between neighbours, as a share of the end of reversal, that is interpolated."""
WINDOW = 0.8
"""Share of the range in which the curve is interpolated a second time, without the kink at the end of reversal."""
STEP = 0.05
"""Step of the second difference at rest, as a share of the end of reversal."""
NO_SHARE = 1e-12
"""Share of the range, or of friction, that is taken for none."""

_FLAT = "friction may not rise between rest and the end of reversal"
# Equal panels of four Gauss points in the angle arcsin(u).
_PANELS = 128
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)
_ANGLE = ((np.arange(_PANELS)[:, None] + 0.5 * (1.0 + _NODES)) * (0.5 * np.pi / _PANELS)).ravel()
ABSCISSAE = np.sin(_ANGLE)
"""Belt speeds over the end of reversal at which curves are interpolated, from 0 to 1."""
AREA_WEIGHTS = np.tile(_WEIGHTS, _PANELS) * (0.25 * np.pi / _PANELS) * np.cos(_ANGLE)
"""Weights of the integral over ``ABSCISSAE``."""
_READ = np.concatenate([_ANGLE, np.arcsin(WINDOW * ABSCISSAE), np.arcsin([WINDOW, 0.5, STEP, 2.0 * STEP])])
"""Angles at which a curve is read: over the range, over the window, and single ones."""


class UnreadableCurve(ValueError):
    """A curve whose shape cannot be determined; the message says why."""


class Estimate(NamedTuple):
    """A number and the bound on its error."""

    value: float
    error: float

    @property
    def sign(self) -> int:
        """1 or -1; 0 where the error spans zero."""
        return int(np.sign(self.value)) if abs(self.value) > self.error else 0

    @property
    def ends(self) -> list[float]:
        """Both ends of the interval of the number; empty where they agree to rounding."""
        sharp = self.error <= NO_SHARE * abs(self.value)
        return [] if sharp else [self.value - self.error, self.value + self.error]


@dataclass(frozen=True)
class FrictionCurve:
    """Mean friction at rising belt speeds > 0, and both ends of the curve.

    friction, error: mean friction and the bounds on its error. start: its limit as belt speed falls to zero.
    end: the end of reversal. kinked: whether friction is known to have a kink there and to be constant beyond.
    """

    speed: Floats
    friction: Floats
    error: Floats
    start: Estimate
    end: Estimate
    kinked: bool

    @property
    def inside(self) -> NDArray[np.bool_]:
        """Select the points between rest and the end of reversal, apart from either by more than rounding."""
        share = self.speed / self.end.value
        return (share > NO_SHARE) & (share < 1.0 - NO_SHARE)

    @property
    def end_friction(self) -> float:
        """Friction at the end of reversal: of the first point beyond a kink, interpolated for smooth friction."""
        if self.kinked:
            first = int(np.searchsorted(self.speed, self.end.value * (1.0 - NO_SHARE)))
            return float(self.friction[first])
        return float(monotone_cubic(self.speed, self.friction)(self.end.value))


class Interpolant(NamedTuple):
    """An interpolated curve: its rise from 0 to 1 at ``ABSCISSAE``, over the range and over the window.

    half: friction at half the range over that at its end. initial: the second difference at rest, scaled by the
    range and by friction at its end.
    """

    range: Floats
    window: Floats
    half: float
    initial: float


def interpolant_of(curve: FrictionCurve) -> Interpolant:
    """Return the monotone cubic through the points in the angle arcsin(v/v_e).

    In that angle the square-root kink of one degree of freedom is smooth, and prescribed slip a straight line.
    Raises UnreadableCurve for a curve that does not rise.
    """
    low, high = curve.start.value, curve.end_friction
    if high - low <= NO_SHARE * float(np.abs(curve.friction).max()):
        raise UnreadableCurve(_FLAT)
    inside = curve.inside
    angle = np.concatenate(([0.0], np.arcsin(curve.speed[inside] / curve.end.value), [0.5 * np.pi]))
    path = monotone_cubic(angle, np.concatenate(([low], curve.friction[inside], [high])))
    read, many = path(_READ), len(ABSCISSAE)
    edge, half, first, second = read[2 * many :].tolist()
    # a curve that falls again may have no rise within the window
    rise = max(edge - low, NO_SHARE * abs(high))
    return Interpolant(
        range=(read[:many] - low) / (high - low),
        window=(read[many : 2 * many] - low) / rise,
        half=half / high,
        initial=(second - 2.0 * first + low) / STEP**2 / high,
    )


def check_points(curve: FrictionCurve) -> None:
    """Raises UnreadableCurve for a curve that ends below the end of reversal or has too few points up to it."""
    end, below = curve.end.value, curve.speed[curve.inside]
    if not curve.speed.size or curve.speed[-1] < end * (1.0 - NO_SHARE):
        last = f"ends at belt speed {curve.speed[-1]:.6g}," if curve.speed.size else "has no points"
        raise UnreadableCurve(f"the curve {last} below the end of reversal, {end:.6g}")
    if below.size < LEAST_POINTS:
        raise UnreadableCurve(
            f"points below the end of reversal, {end:.6g}: {below.size} of the {LEAST_POINTS} needed"
        )
    places = np.concatenate(([0.0], below, [end]))
    gap = int(np.argmax(np.diff(places)))
    if places[gap + 1] - places[gap] > WIDEST_GAP * end:
        between = f"{places[gap]:.6g} and {places[gap + 1]:.6g}"
        raise UnreadableCurve(
            f"no point between belt speeds {between}, more than {WIDEST_GAP:.0%} of the range"
        )
    if curve.end_friction - curve.start.value <= 2.0 * float(curve.error.max()) + curve.start.error:
        raise UnreadableCurve(_FLAT)


class MonotoneCubic(NamedTuple):
    """A continuously differentiable piecewise cubic through points, without overshoot; see ``monotone_cubic``."""

    x: Floats
    y: Floats
    slope: Floats

    def __call__(self, at: ArrayLike) -> Floats:
        """Values of the interpolant; outside the points the value of the nearest one."""
        x = np.minimum(np.maximum(np.asarray(at, dtype=np.float64), self.x[0]), self.x[-1])
        left = np.searchsorted(self.x[1:-1], x, side="right")
        width, before, after = np.diff(self.x), self.slope[:-1], self.slope[1:]
        rise = np.diff(self.y) / width
        square = (3.0 * rise - 2.0 * before - after) / width
        cube = (before + after - 2.0 * rise) / width**2
        s = x - self.x[left]
        return np.asarray(self.y[left] + s * (self.slope[left] + s * (square[left] + s * cube[left])))


def monotone_cubic(x: Floats, y: Floats) -> MonotoneCubic:
    """Return the monotone cubic through points, x strictly rising, at least two of them.

    Slopes of the parabola through each point and its neighbours, limited to prevent overshoot: second
    order on any spacing and, unlike the harmonic mean of the chords, third where the curve is smooth.

    Source: Steffen, Astron. Astrophys. 239 (1990), Eqs. 8, 11, 24-27.
    """
    width = np.diff(x)
    chord = np.diff(y) / width
    if len(chord) == 1:
        return MonotoneCubic(x, y, np.repeat(chord, 2))
    before, after = chord[:-1], chord[1:]
    parabola = (before * width[1:] + after * width[:-1]) / (width[1:] + width[:-1])
    least = np.minimum(np.minimum(np.abs(before), np.abs(after)), 0.5 * np.abs(parabola))
    inner = (np.sign(before) + np.sign(after)) * least
    first = _end_slope(chord[0], chord[1], width[0] / (width[0] + width[1]))
    last = _end_slope(chord[-1], chord[-2], width[-1] / (width[-1] + width[-2]))
    return MonotoneCubic(x, y, np.concatenate(([first], inner, [last])))


def _end_slope(near: float, far: float, share: float) -> float:
    """Return the slope of the parabola at an end, between zero and twice the chord."""
    parabola = near + (near - far) * share
    low, high = sorted((0.0, 2.0 * near))
    return min(max(parabola, low), high)
