"""Place between two belt speeds at which a motion changes its kind.

The onsets of one curve: belt speeds at which stick begins, stick ends and reversal ends.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from frictionlab.curves.motions import CurveMotions, MotionSeen
from frictionlab.theory.linear import friction_free_velocity
from frictionlab.theory.rest import is_convergent

_MOST_MISSED = 3
"""Belt speeds in a row without an answer, one more of which ends a search."""
DistanceOf = Callable[[float], float | None]


class LocatedOnset(NamedTuple):
    """A value and the bound on its error; stopped: a belt speed without an answer at which the search ended."""

    value: float
    error: float
    stopped: float | None = None


class DistanceAt(NamedTuple):
    """A belt speed and a distance there, which changes its sign at the place looked for."""

    x: float
    f: float


def change_between(
    distance: DistanceOf, low: DistanceAt, high: DistanceAt, width: float, most: int
) -> LocatedOnset:
    """Return where a function changes its sign between two samples of opposite sign, to a bracket of this width.

    The function is smooth on each side, with a kink or a jump where it changes its sign. So the line through the two
    nearest samples of a side tells where it ends; the next sample lies beyond that by what such estimates differ, so
    that both ends of the bracket close in. A bracket that does not shrink is halved. distance: None where it has no
    answer. most: calls.
    """
    below, above = [low], [high]
    widths = [high.x - low.x]
    missed: list[float] = []
    for _ in range(most):
        a, b = below[-1].x, above[-1].x
        if b - a <= width:
            break
        stalls = len(widths) > 3 and widths[-1] > 0.3 * widths[-4]
        x = 0.5 * (a + b) if stalls else _next(below, above, width)
        if missed:  # half way from there to the farther end
            x = 0.5 * (missed[-1] + (a if missed[-1] - a > b - missed[-1] else b))
        f = distance(x)
        if f is None:
            missed.append(x)
            if len(missed) > _MOST_MISSED:
                break
            continue
        missed.clear()
        (below if (f > 0.0) == (low.f > 0.0) else above).append(DistanceAt(x, f))
        widths = [above[-1].x - below[-1].x] if stalls else [*widths, above[-1].x - below[-1].x]
    a, b = below[-1].x, above[-1].x
    return LocatedOnset(0.5 * (a + b), 0.5 * (b - a), missed[0] if missed else None)


def _next(below: list[DistanceAt], above: list[DistanceAt], width: float) -> float:
    """Return the next belt speed to look at, inside the bracket."""
    a, b = below[-1].x, above[-1].x
    pairs = [pair for pair in (below[-2:], above[-2:]) if len(pair) == 2]
    ends = [place for pair in pairs for place in _zeros(*pair) if a < place < b]
    ends = ends or _zeros(below[-1], above[-1])
    if not ends:
        return 0.5 * (a + b)
    middle = sum(ends) / len(ends)
    nearer = min(middle - a, b - middle)
    beyond = max(abs(ends[0] - ends[-1]) if len(ends) > 1 else 0.1 * nearer, 0.4 * width)
    # no farther than half way to the end of the bracket on the other side
    room = b - middle if middle - a < b - middle else a - middle
    x = middle + math.copysign(min(beyond, 0.5 * abs(room)), room)
    inside = min(0.45 * width, 0.25 * (b - a))
    return min(max(x, a + inside), b - inside)


def _zeros(first: DistanceAt, second: DistanceAt) -> list[float]:
    """Return where the line through two samples is zero; nothing for one that is level."""
    rise = second.f - first.f
    return [first.x - first.f * (second.x - first.x) / rise] if rise != 0.0 else []


class _Effort(NamedTuple):
    """Width of the bracket that a search ends with, relative to the belt speed, and how many motions it takes."""

    within: float
    most: int


_USUAL, _IF_QUICK, _IF_STARTS = _Effort(1e-6, 48), _Effort(1e-9, 96), _Effort(1e-5, 36)
"""Along a curve; of motions that are quick to solve for, under constant friction along the belt; where no theorem
makes motions unique, and starts are compared for each (in the plane at most one for four points of the curve)."""
_NEAR = 0.3
"""DistanceOf from stick below which the motions between two of a kind are looked at, for a window that none shows."""
_ROUNDING = 1e-12
"""Relative rounding of V_lin."""
_NOISE = 10.0
"""Error of a distance over that of the mean friction coefficient, relative to the static one."""

STICK_BEGINS, STICK_ENDS, REVERSAL_ENDS = "stick_begins", "stick_ends", "reversal_ends"
_HELD = "the force that would hold the mass is the static limit where slip is least"
_SOLVED_FOR = {
    STICK_BEGINS: _HELD,
    STICK_ENDS: _HELD,
    REVERSAL_ENDS: "the largest slip velocity along x1 is zero",
}
CLOSED_FORM = "closed form: V_lin"


class Onset(NamedTuple):
    """A belt speed at which the kind of motion changes, read along increasing belt speed, and how it was found."""

    onset: str
    belt_speed: float
    error: float
    how: str


class KnownRow(NamedTuple):
    """Facts that a row of the result table has of the motion at its belt speed > 0."""

    belt_speed: float
    sticks: bool
    reverses: bool


def onsets_along(motions: CurveMotions, rows: list[KnownRow], most: int) -> list[Onset]:
    """Return the onsets between the rows of a curve, ascending, of which only those with a motion are given.

    most: motions that may be solved for; ``_MOST`` of them at most. A window of stick narrower than the rows is found
    where the motions beside it come near stick: the distance from stick is followed to its least value between rows.
    """
    if len(rows) < 2:
        return []
    return _Search(motions, rows, most).onsets()


class _Search:
    """motions looked at, by belt speed."""

    def __init__(self, motions: CurveMotions, rows: list[KnownRow], most: int) -> None:
        self.motions, self.rows = motions, rows
        self.seen: dict[float, MotionSeen] = {}
        scene, law = motions.scene, motions.law
        self.quick = scene.load_along_belt_only and law.constant_sliding_friction() and law.monotone()
        self.compares_starts = not is_convergent(motions.scene, motions.law)
        # where starts are compared a motion costs many times what it does otherwise
        effort = _IF_STARTS if self.compares_starts else _IF_QUICK if self.quick else _USUAL
        dear = self.compares_starts and motions.scene.planar
        self.within, self.most = effort.within, min(most, effort.most, *([len(rows) // 4] if dear else []))
        self.end = self._closed_form_end()

    @property
    def left(self) -> int:
        return self.most - self.motions.looks if self.motions.tell_onsets else 0

    def onsets(self) -> list[Onset]:
        self._look_at_rows()
        found = self._ends_of_reversal()
        self._look_for_windows()
        found += self._ends_of_stick()
        return sorted(found, key=lambda each: (each.belt_speed, each.onset))

    def _closed_form_end(self) -> float | None:
        """V_lin, where slip of constant friction along the belt alone stops to reverse and to stick."""
        if not self.quick:
            return None
        end = friction_free_velocity(self.motions.scene, self.motions.law)
        return end if self.rows[0].belt_speed < end <= self.rows[-1].belt_speed else None

    # --- looking ----------------------------------------------------------------------------------------------------

    def _see(self, belt_speeds: list[float]) -> None:
        speeds = sorted({speed for speed in belt_speeds if speed not in self.seen})[: max(self.left, 0)]
        self.seen |= {each.belt_speed: each for each in self.motions.at(speeds)}

    def _look_at_rows(self) -> None:
        """Some of the rows, none where starts are compared; and the motions just below V_lin."""
        count = self.most // (2 if self.quick else 4)
        places = np.unique(np.linspace(0, len(self.rows) - 1, min(len(self.rows), count)).round())
        speeds = [self.rows[int(place)].belt_speed for place in places]
        near = _USUAL.within, 1e-3
        ends = [] if self.end is None else [self.end * (1.0 - share) for share in near]
        self._see([*[each for each in ends if each > self.rows[0].belt_speed], *speeds])

    def _known(self) -> list[KnownRow]:
        """Rows and motions looked at, ascending."""
        found = {each.belt_speed: each for each in self.rows}
        found |= {
            speed: KnownRow(speed, each.sticks, each.reverses)
            for speed, each in self.seen.items()
            if not each.reason
        }
        return [found[speed] for speed in sorted(found)]

    def _look_for_windows(self) -> None:
        """Follow the distance from stick to its least size where neighbours of one kind come near the other."""
        for _ in range(4):
            seen = [self.seen[speed] for speed in sorted(self.seen) if not self.seen[speed].reason]
            wanted = [
                0.5 * (each.belt_speed + here.belt_speed)
                for before, here, after in zip(seen, seen[1:], seen[2:], strict=False)
                if _comes_near(before, here, after)
                for each in (before, after)
            ]
            if not wanted or self.left < len(wanted):
                return
            self._see(wanted)

    # --- finding ----------------------------------------------------------------------------------------------------

    def _ends_of_reversal(self) -> list[Onset]:
        if self.end is not None:
            return [Onset(REVERSAL_ENDS, self.end, _ROUNDING * self.end, CLOSED_FORM)]
        return [
            self._located(REVERSAL_ENDS, low, high, lambda each: each.to_reversal)
            for low, high in pairwise(self._known())
            if low.reverses and not high.reverses
        ]

    def _ends_of_stick(self) -> list[Onset]:
        found = []
        for low, high in pairwise(self._known()):
            if low.sticks == high.sticks:
                continue
            name = STICK_BEGINS if high.sticks else STICK_ENDS
            if (
                self.end is not None
                and low.sticks
                and low.belt_speed >= self.end * (1.0 - 1.01 * _USUAL.within)
            ):
                found.append(Onset(name, self.end, _ROUNDING * self.end, CLOSED_FORM))
            else:
                found.append(self._located(name, low, high, lambda each: each.to_stick))
        return found

    def _located(
        self, name: str, low: KnownRow, high: KnownRow, read: Callable[[MotionSeen], float]
    ) -> Onset:
        if self.left > 2:
            self._see([low.belt_speed, high.belt_speed])
        ends = [self.seen.get(each.belt_speed) for each in (low, high)]
        if any(each is None or each.reason for each in ends):
            return _between_rows(name, low, high, self._why_not())
        first, last = (each for each in ends if each is not None)
        if (read(first) > 0.0) == (read(last) > 0.0):
            return _between_rows(name, low, high, "the motions do not show what the rows do")
        width = self.within * high.belt_speed

        def distance(speed: float) -> float | None:
            (each,) = self.motions.at([speed])
            self.seen[speed] = each
            return None if each.reason else read(each)

        begin, end = DistanceAt(low.belt_speed, read(first)), DistanceAt(high.belt_speed, read(last))
        place = change_between(distance, begin, end, width, max(self.left, 0))
        error = place.error + self._noise(begin, end, max(first.error, last.error))
        how = _SOLVED_FOR[name]
        if place.stopped is not None:
            why = self.seen[place.stopped].reason
            how = f"between motions that differ; none at {place.stopped:.6g}: {why}"
        elif place.error > width:
            how = f"{how}; stopped after {self.motions.looks} motions"
        return Onset(name, place.value, error, how)

    def _noise(self, low: DistanceAt, high: DistanceAt, error: float) -> float:
        """By how much the error of the motions moves the place at most, by the mean slope of the distance."""
        slope = abs(high.f - low.f) / (high.x - low.x)
        if not (slope > 0.0 and math.isfinite(slope)):
            return 0.0
        return _NOISE * error / (self.motions.friction * slope)

    def _why_not(self) -> str:
        if not self.motions.tell_onsets:
            return "not located: the method does not solve for the instants of stick and reversal"
        if self.compares_starts:
            return "not located: starts are compared, and no more motions were solved for"
        return "not located: so many curves leave no more motions to solve for"


def _comes_near(before: MotionSeen, here: MotionSeen, after: MotionSeen) -> bool:
    """Check whether a motion is nearer the other kind than its neighbours of the same kind."""
    sizes = [abs(each.to_stick) for each in (before, here, after)]
    alike = before.sticks == here.sticks == after.sticks and here.reverses
    return alike and sizes[1] <= min(sizes[0], sizes[2]) and sizes[1] < _NEAR


def _between_rows(name: str, low: KnownRow, high: KnownRow, why: str) -> Onset:
    middle, half = 0.5 * (low.belt_speed + high.belt_speed), 0.5 * (high.belt_speed - low.belt_speed)
    return Onset(name, middle, half, f"between two points of the curve; {why}")
