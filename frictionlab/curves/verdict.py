"""Shape of a friction curve: its side of the chord, the area between them, and the errors of both.

The curve is mean friction m over belt speed, from rest to the end of reversal v_e, above which slip neither
reverses nor sticks. Every number has an error bound: the sum of the effects of the errors of the points, of their
spacing, and of both ends.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from frictionlab.curves.interpolant import (
    ABSCISSAE,
    AREA_WEIGHTS,
    STEP,
    WINDOW,
    Estimate,
    FrictionCurve,
    Interpolant,
    UnreadableCurve,
    check_points,
    interpolant_of,
)
from frictionlab.values.quantities import EPSILON, Floats

__all__ = ["Estimate", "FrictionCurve", "Shape", "UnreadableCurve", "reduction", "shape_of"]

_PARTS = 16
"""Parts of the range, over which errors of an area do not cancel."""


@dataclass(frozen=True)
class Shape:
    """Measures of a curve; ``initial`` is None where no points lie near enough to rest.

    area: chord area; > 0 above the chord. window_area: the same over the first 0.8 of the range, against its
    own chord. half: friction at half the range over that at its end. initial: curvature at rest. above, below:
    the parts of the area on either side of the chord, area = above - below.
    """

    area: Estimate
    window_area: Estimate
    half: Estimate
    initial: Estimate | None
    above: Estimate
    below: Estimate

    @property
    def by_area(self) -> str:
        """Return the verdict by area: concave, convex, mixed or undecided."""
        if self.area.sign == 0 or self.window_area.sign != self.area.sign:
            return "undecided"
        if self.above.sign > 0 and self.below.sign > 0:
            return "mixed"
        return "concave" if self.area.sign > 0 else "convex"

    @property
    def by_initial(self) -> str | None:
        """Return the verdict by the curvature at rest: concave, convex or undecided; None without that measure."""
        if self.initial is None:
            return None
        return ("undecided", "convex", "concave")[self.initial.sign]


def shape_of(curve: FrictionCurve, even: bool = False) -> Shape:
    """Every measure of a curve with its error. Raises UnreadableCurve.

    even: whether points are evenly spaced in the angle of the interpolant, so that errors of an area cancel between
    neighbours.
    """
    check_points(curve)
    best = interpolant_of(curve)
    errors = _point_errors(curve, best), _spacing_errors(curve, best, even), *_end_errors(curve, best)
    area, window_area, half, initial = np.sum(errors, axis=0).tolist()
    above, below = (
        2.0 * float(AREA_WEIGHTS @ np.maximum(side * (best.range - ABSCISSAE), 0.0)) for side in (1, -1)
    )
    return Shape(
        area=Estimate(_area(best.range), area),
        window_area=Estimate(_area(best.window), window_area),
        half=Estimate(best.half, half),
        initial=Estimate(best.initial, initial) if _reaches_rest(curve) else None,
        above=Estimate(above, area),
        below=Estimate(below, area),
    )


def reduction(normalized: Floats, error: Floats) -> Estimate:
    """Return the largest fall of friction below that of steady sliding over the points: 1 - m/steady.

    normalized: mean friction over that of steady sliding, at rising belt speeds; error: of that ratio. Where the
    least value lies between others, a quarter of the rise beside it is added for the minimum between the points.
    """
    at = int(np.argmin(normalized))
    beside = normalized[at - 1 : at + 2] if 0 < at < len(normalized) - 1 else normalized[at : at + 1]
    dip = 0.25 * float(np.max(beside) - normalized[at])
    return Estimate(float(1.0 - normalized[at]), float(error[at]) + dip)


def _area(rise: Floats) -> float:
    return 2.0 * float(AREA_WEIGHTS @ rise) - 1.0


def _apart(one: Interpolant, other: Interpolant) -> Floats:
    """By how much each measure differs: both areas by the area between the interpolants, half and initial."""
    between = [
        AREA_WEIGHTS @ np.abs(a - b) for a, b in ((one.range, other.range), (one.window, other.window))
    ]
    return np.array(
        [*(2.0 * np.array(between)), abs(one.half - other.half), abs(one.initial - other.initial)]
    )


def _reaches_rest(curve: FrictionCurve) -> bool:
    """Check whether two points lie within the second difference at rest."""
    return int(np.count_nonzero(curve.speed[curve.inside] <= 2.0 * STEP * curve.end.value)) >= 2


def _point_errors(curve: FrictionCurve, best: Interpolant) -> Floats:
    """Effect of the errors of the points, and of the first interval, in which the curve is only known to rise."""
    low, high = curve.start.value, curve.end_friction
    rise, share = high - low, curve.speed / curve.end.value
    edge = max(float(np.interp(WINDOW, ABSCISSAE, best.range)), 1e-12)  # a curve may fall again
    before = abs(float(curve.friction[0]) - low) / rise * float(share[0])
    places = [WINDOW, 0.5, 1.0, STEP, 2.0 * STEP]
    at_edge, middle, last, first, second = (float(error) for error in np.interp(places, share, curve.error))
    mean, mean_in_window = (
        float(AREA_WEIGHTS @ np.interp(width * ABSCISSAE, share, curve.error)) for width in (1.0, WINDOW)
    )
    return np.array(
        [
            2.0 * (mean + last) / rise + before,
            2.0 * (mean_in_window + at_edge) / (rise * edge) + before / (WINDOW * edge),
            (middle + abs(best.half) * last) / high,
            ((second + 2.0 * first) / STEP**2 + abs(best.initial) * last) / high,
        ]
    )


def _spacing_errors(curve: FrictionCurve, best: Interpolant, even: bool) -> Floats:
    """Distance to the interpolant of every second point; for a local measure the largest distance around it.

    Twice the spacing makes the error of the interpolant at least four times as large.
    """
    every = slice((curve.speed.size - 1) % 2, None, 2)  # keep the last point, the end of the range
    columns = {name: getattr(curve, name)[every] for name in ("speed", "friction", "error")}
    coarse = interpolant_of(replace(curve, **columns))
    early = ABSCISSAE < 3.0 * STEP
    fine_rise, coarse_rise = float(best.range[early][-1]), float(coarse.range[early][-1])
    rises = min(fine_rise, coarse_rise) > EPSILON  # of the whole rise, which is one
    scale = fine_rise / coarse_rise if rises else 1.0  # compare the beginnings at the same scale
    away = np.abs(coarse.range - best.range)[np.abs(ABSCISSAE - 0.5) < 2.0 * STEP]
    bent = np.abs(scale * coarse.range - best.range)[early]
    local = [float(away.max()), 4.0 * float(bent.max()) / STEP**2 + abs((scale - 1.0) * best.initial)]
    areas = _apart(coarse, best)[:2]
    if even:
        areas = np.array([_area_apart(*both) for both in zip(coarse[:2], best[:2], strict=True)])
    return np.array([*areas, *local])


def _area_apart(one: Floats, other: Floats) -> float:
    """Return the difference of two areas, or the root of the sum of its squares over parts of the range.

    Of points evenly spaced, errors of neighbours cancel, and those of far parts at most by chance.
    """
    parts = 2.0 * (AREA_WEIGHTS * (one - other)).reshape(_PARTS, -1).sum(axis=1)
    return max(abs(float(parts.sum())), float(np.hypot.reduce(parts)))


def _end_errors(curve: FrictionCurve, best: Interpolant) -> list[Floats]:
    """Return the change of each measure when the start or the end of the curve moves to a bound of its interval."""
    starts = [replace(curve, start=Estimate(place, 0.0)) for place in curve.start.ends]
    ends = [replace(curve, end=Estimate(place, 0.0)) for place in curve.end.ends]
    moved = [[_apart(interpolant_of(other), best) for other in alike] for alike in (starts, ends)]
    return [np.max(apart, axis=0) for apart in moved if apart]
