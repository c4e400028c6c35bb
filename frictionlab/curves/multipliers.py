"""Belt speeds at which a multiplier of the motion of one period leaves the unit circle, and how."""

from __future__ import annotations

import cmath
import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from frictionlab.curves.onsets import DistanceAt, Onset, change_between
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.periodic.continuation import DIFFERENTIATED, Curve
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.methods.periodic.sharpened import ClosedMotion, sharpened
from frictionlab.scene.scene import Scene
from frictionlab.values.quantities import Floats

MULTIPLIER_LEAVES = "multiplier_leaves"
_WITHIN_BELT_SPEED = 1e-5
"""Width of the bracket that a search ends with, relative to the belt speed."""
MOST_CLOSED = 24
"""Motions closed for one onset."""
_STEPS = 4
"""In which a motion is followed from a row at which it attracts to the next."""
_BY_QUOTIENTS, _AT_A_KINK = 1e-6, 1e-2
"""Error of a multiplier of a law without memory, and of one that fine maps do not confirm."""
_JUMP = 0.05
"""Change of the modulus across the last bracket from which on it jumps."""


class StabilityRow(NamedTuple):
    """Whether the motion of one period attracts at the belt speed of a row, by its status and multiplier."""

    belt_speed: float
    attracts: bool


class _Motion(NamedTuple):
    """A motion of one period: its state, its multiplier of largest modulus, that modulus less 1 and its error."""

    state: Floats
    multiplier: complex
    excess: float
    error: float


def multiplier_onsets(
    scene: Scene, law: FrictionLaw, tolerance: float, rows: list[StabilityRow]
) -> list[Onset]:
    """Between neighbouring rows of which one attracts and the other does not, ascending in belt speed.

    The motion of one period is followed from the first towards the other, whether it attracts or not. Where it keeps
    attracting, other motions came, and there is no onset.
    """
    problem = PeriodicProblem(scene, law, tolerance)
    found = []
    for low, high in pairwise(rows):
        if low.attracts != high.attracts:
            begin, other = (low, high) if low.attracts else (high, low)
            onset = _Followed(problem, scene, begin.belt_speed).onset(other.belt_speed)
            found += [] if onset is None else [onset]
    return found


class _Followed:
    """A motion followed along the belt speed from where it attracts; motions: those closed, by belt speed."""

    def __init__(self, problem: PeriodicProblem, scene: Scene, begin: float) -> None:
        self.problem, self.scene, self.begin = problem, scene, begin
        self.motions: dict[float, _Motion] = {}

    def onset(self, other: float) -> Onset | None:
        """Where a multiplier leaves on the way to another belt speed; None where none does."""
        first = self._closed(self.begin)
        if first is None or first.excess >= 0.0:
            return None
        last, gone = self.begin, None
        for speed in np.linspace(self.begin, other, _STEPS + 1)[1:].tolist():
            motion = self._closed(speed)
            if motion is None:
                gone = speed
                break
            if motion.excess > 0.0:
                return self._left_between(last, speed)
            last = speed
        return None if gone is None else self._ended_between(last, gone)

    def _closed(self, belt_speed: float) -> _Motion | None:
        """The motion from the nearest that is known; None where none is found."""
        near = min(self.motions, key=lambda speed: abs(speed - belt_speed), default=None)
        state = None if near is None else self.motions[near].state
        si = self.scene.dimensional
        scene = self.scene.at(belt_speed if si is None else belt_speed * si.scales.velocity)
        curve, _ = self.problem.close([scene], state, wanted=DIFFERENTIATED)
        if not curve.closed.found[0] or np.isnan(curve.matrices[0]).any():
            return None
        values = np.linalg.eigvals(curve.matrices[0])
        largest = complex(values[np.abs(values).argmax()])
        motion = _Motion(curve.states[0].copy(), largest, *self._excess(belt_speed, curve, largest))
        self.motions[belt_speed] = motion
        return motion

    def _excess(self, belt_speed: float, curve: Curve, rough: complex) -> tuple[float, float]:
        if self.problem.law.count() == 0:
            return abs(rough) - 1.0, _BY_QUOTIENTS * max(1.0, abs(rough))
        (fine,) = sharpened(self.problem, [ClosedMotion(belt_speed, curve.states[0], curve.matrices[0])])
        return (abs(rough) - 1.0, _AT_A_KINK) if fine.reason else (fine.modulus - 1.0, fine.error)

    def _left_between(self, inside: float, outside: float) -> Onset:
        low, high = sorted((inside, outside))
        ends = [DistanceAt(speed, self.motions[speed].excess) for speed in (low, high)]

        def excess(speed: float) -> float | None:
            motion = self._closed(speed)
            return None if motion is None else motion.excess

        place = change_between(excess, ends[0], ends[1], _WITHIN_BELT_SPEED * high, MOST_CLOSED)
        beside = sorted(self.motions, key=lambda speed: abs(speed - place.value))
        last, first = (
            next(motion for speed in beside if ((motion := self.motions[speed]).excess >= 0.0) == left)
            for left in (False, True)
        )
        how = how_it_leaves(last.multiplier, first.multiplier)
        slope = abs(ends[1].f - ends[0].f) / (high - low)
        return Onset(MULTIPLIER_LEAVES, place.value, place.error + max(last.error, first.error) / slope, how)

    def _ended_between(self, last: float, gone: float) -> Onset:
        """The motion ends on the way, its multiplier at +1 (a fold); None where it is far from that."""
        for _ in range(MOST_CLOSED // 2):
            middle = 0.5 * (last + gone)
            if abs(gone - last) <= _WITHIN_BELT_SPEED * max(last, gone):
                break
            motion = self._closed(middle)
            if motion is None:
                gone = middle
            elif motion.excess > 0.0:
                return self._left_between(last, middle)
            else:
                last = middle
        end = self.motions[last].multiplier
        middle, half = 0.5 * (last + gone), 0.5 * abs(gone - last)
        how = f"+1: the motion ends, its last multiplier is {_text(end)}"
        if abs(end.imag) > 1e-3 or end.real < 0.5:
            how = f"between motions; none of one period is closed at {gone:.6g}, the last multiplier is {_text(end)}"
        return Onset(MULTIPLIER_LEAVES, middle, half, how)


def how_it_leaves(inside: complex, outside: complex) -> str:
    """+1, -1 or complex, by the multiplier outside; with both where the modulus jumps."""
    if abs(outside.imag) > 1e-3 * abs(outside):
        how = f"complex, at {math.degrees(abs(cmath.phase(outside))):.4g} degrees"
    else:
        how = "+1" if outside.real > 0.0 else "-1"
    if abs(outside) - abs(inside) > _JUMP:
        return f"{how}: jumps from {_text(inside)} to {_text(outside)}"
    return how


def _text(multiplier: complex) -> str:
    real = abs(multiplier.imag) <= 1e-9 * abs(multiplier)
    return f"{multiplier.real:.4g}" if real else f"{multiplier.real:.4g}{multiplier.imag:+.4g}i"
