"""The shape of a friction curve: on which side of its chord it runs, by how much, and how sure that is.

Mean friction m over belt speed, from rest to the end of reversal v_e, from where on slip neither reverses nor
sticks. Every number comes with an error made of the errors of the points, of their spacing, and of what is not
known about both ends.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from frictionlab.quantities import Floats
from frictionlab.shape.interpolant import (
    MEASURE,
    SHARE,
    STEP,
    WINDOW,
    Course,
    Curve,
    Measured,
    Unreadable,
    check,
    course_of,
)

__all__ = ["Curve", "Measured", "Shape", "Unreadable", "reduction", "shape_of"]


@dataclass(frozen=True)
class Shape:
    """The measures of a curve; ``initial`` is None where the points begin too late for it.

    area: chord area; > 0 above the chord. window_area: the same over the first 0.8 of the range, against its
    own chord. half: friction at half the range over that at its end. initial: curvature at rest. above, below:
    the parts of the area on either side of the chord, area = above - below.
    """

    area: Measured
    window_area: Measured
    half: Measured
    initial: Measured | None
    above: Measured
    below: Measured

    @property
    def by_area(self) -> str:
        """The verdict by area: concave, convex, mixed or undecided."""
        if self.area.sign == 0 or self.window_area.sign != self.area.sign:
            return "undecided"
        if self.above.sign > 0 and self.below.sign > 0:
            return "mixed"
        return "concave" if self.area.sign > 0 else "convex"

    @property
    def by_initial(self) -> str | None:
        """The verdict by the curvature at rest: concave, convex or undecided; None without that measure."""
        if self.initial is None:
            return None
        return ("undecided", "convex", "concave")[self.initial.sign]


def shape_of(curve: Curve) -> Shape:
    """Every measure of a curve with its error. Raises Unreadable."""
    check(curve)
    best = course_of(curve)
    error = _total([_of_points(curve, best), _of_spacing(curve, best), *_of_ends(curve, best)])
    above, below = (2.0 * float(MEASURE @ np.maximum(side * (best.range - SHARE), 0.0)) for side in (1, -1))
    return Shape(
        area=Measured(_area(best.range), error.area),
        window_area=Measured(_area(best.window), error.window_area),
        half=Measured(best.half, error.half),
        initial=Measured(best.initial, error.initial) if _starts_early(curve) else None,
        above=Measured(above, error.area),
        below=Measured(below, error.area),
    )


def reduction(normalized: Floats, error: Floats) -> Measured:
    """The largest fall of friction below that of steady sliding over the points: 1 - m/steady.

    normalized: mean friction over that of steady sliding, at rising belt speeds; error: of that ratio. Where the
    least value lies between others, a quarter of the rise beside it is added for the dip between the points.
    """
    at = int(np.argmin(normalized))
    beside = normalized[at - 1 : at + 2] if 0 < at < len(normalized) - 1 else normalized[at : at + 1]
    dip = 0.25 * float(np.max(beside) - normalized[at])
    return Measured(float(1.0 - normalized[at]), float(error[at]) + dip)


class _Error(NamedTuple):
    """What one uncertainty can do to each measure."""

    area: float
    window_area: float
    half: float
    initial: float


def _total(errors: list[_Error]) -> _Error:
    return _Error(*(float(sum(parts)) for parts in zip(*errors, strict=True)))


def _area(course: Floats) -> float:
    return 2.0 * float(MEASURE @ course) - 1.0


def _between(one: Floats, other: Floats) -> float:
    """The area between two courses, in the units of the area between a course and its chord."""
    return 2.0 * float(MEASURE @ np.abs(one - other))


def _starts_early(curve: Curve) -> bool:
    """Whether two points lie within the second difference at rest."""
    return int(np.count_nonzero(curve.speed <= 2.0 * STEP * curve.end.value)) >= 2


def _of_points(curve: Curve, best: Course) -> _Error:
    """The errors of the points; and the first interval, where a curve that rises may run anywhere."""
    low, high = curve.start.value, curve.end_friction
    rise, share = high - low, curve.speed / curve.end.value
    edge = max(float(np.interp(WINDOW, SHARE, best.range)), 1e-12)  # a curve may fall again
    before = abs(float(curve.friction[0]) - low) / rise * float(share[0])
    places = [WINDOW, 0.5, 1.0, STEP, 2.0 * STEP]
    at_edge, middle, last, first, second = (float(error) for error in np.interp(places, share, curve.error))
    mean, mean_in_window = (
        float(MEASURE @ np.interp(width * SHARE, share, curve.error)) for width in (1.0, WINDOW)
    )
    return _Error(
        2.0 * (mean + last) / rise + before,
        2.0 * (mean_in_window + at_edge) / (rise * edge) + before / (WINDOW * edge),
        (middle + abs(best.half) * last) / high,
        ((second + 2.0 * first) / STEP**2 + abs(best.initial) * last) / high,
    )


def _of_spacing(curve: Curve, best: Course) -> _Error:
    """The distance to the course through every second point; at one place it is the largest one around it.

    Twice the spacing makes the error of the interpolant four times as large or more.
    """
    every = slice((curve.speed.size - 1) % 2, None, 2)  # the last point, which closes the range, stays
    columns = {name: getattr(curve, name)[every] for name in ("speed", "friction", "error")}
    coarse = course_of(replace(curve, **columns))
    early = SHARE < 3.0 * STEP
    rises = best.range[early][-1] > 0.0 < coarse.range[early][-1]
    scale = (
        best.range[early][-1] / coarse.range[early][-1] if rises else 1.0
    )  # a coarser end, the same beginning
    away = np.abs(coarse.range - best.range)[np.abs(SHARE - 0.5) < 2.0 * STEP]
    bent = np.abs(scale * coarse.range - best.range)[early]
    return _Error(
        _between(coarse.range, best.range),
        _between(coarse.window, best.window),
        float(away.max()),
        4.0 * float(bent.max()) / STEP**2 + abs((scale - 1.0) * best.initial),
    )


def _of_ends(curve: Curve, best: Course) -> list[_Error]:
    """What becomes of each measure where an end of the curve lies at an end of its own range."""
    starts = [replace(curve, start=Measured(place, 0.0)) for place in curve.start.ends]
    ends = [replace(curve, end=Measured(place, 0.0)) for place in curve.end.ends]
    return [_largest([course_of(other) for other in alike], best) for alike in (starts, ends) if alike]


def _largest(others: list[Course], best: Course) -> _Error:
    return _Error(
        max(_between(other.range, best.range) for other in others),
        max(_between(other.window, best.window) for other in others),
        max(abs(other.half - best.half) for other in others),
        max(abs(other.initial - best.initial) for other in others),
    )
