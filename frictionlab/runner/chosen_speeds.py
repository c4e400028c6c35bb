"""Belt speeds chosen as a run goes: in rounds, each the ordinary run of the speeds that the one before asked for."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.results.bends import halves_to_add
from frictionlab.results.part import Part
from frictionlab.runner.chunks import Task
from frictionlab.runner.solving import Solving
from frictionlab.scene.scene import Scene
from frictionlab.study import Mistake, Study, StudyCurve, StudyError
from frictionlab.study.grid import grid_size
from frictionlab.study.ranges import CLOSEST, MOST_CHOSEN, WITHIN, SpeedRange
from frictionlab.theory import friction_free_velocity

Known = tuple[Floats, Floats, Floats]
"""Belt speeds of a curve, ascending, their mean friction and its error; NaN where there is no number."""

SHARES = (0.025, 0.05, *(0.1 * k for k in range(1, 10)))
"""Of V_lin: what the shape of a curve is read from where no more belt speeds are asked for."""


@dataclass(frozen=True)
class Round:
    """The curves of a round, at the belt speeds that are new in it, and what came of them."""

    solving: Solving

    def moved_to(self, curves: Sequence[StudyCurve]) -> list[Part]:
        """Its rows as those of these curves, which hold all belt speeds."""
        rows = np.empty(self.solving.points, np.int64)
        for each, whole in zip(self.solving.curves, curves, strict=True):
            rows[each.rows.start : each.rows.stop] = whole.rows.start + np.searchsorted(
                whole.scenes.given, each.scenes.given
            )
        return [part.moved(rows[part.rows]) for part in self.solving.parts()]


@dataclass(frozen=True)
class ChosenSpeeds:
    """A study with its belt speeds, the rounds in which they were solved, and whether the last was interrupted."""

    study: Study
    rounds: list[Round]
    stopped: bool

    def solved(self, task: Task) -> Solving:
        """The rows of all rounds as those of the study."""
        curves = list(self.study.curves())
        found = Solving(curves, task, known=[part for one in self.rounds for part in one.moved_to(curves)])
        found.rest = self.rounds[-1].solving.rest
        return found


def choose_speeds(study: Study, solve: Callable[[list[StudyCurve]], tuple[Solving, bool]]) -> ChosenSpeeds:
    """Solve at more and more belt speeds until chords are within what the study says; those of a scene are shared.

    Every law and method of a scene is solved at all of its belt speeds: begin with evenly spaced ones and V_lin, then
    halve each interval in which a curve asks for it. Raises StudyError where that would take too many points.
    """
    along = study.chosen_range
    assert along is not None
    curves = list(study.with_speeds([along.first()] * len(study.scenes_along)).curves())
    count = len(study.scenes_along)
    breaks = [
        _breaks([each.law for each in curves[at::count]], curves[at].scenes.scene, along)
        for at in range(count)
    ]
    named = _named(study, along)
    new = [_first(along, each, named) for each in breaks]
    speeds, known, rounds, stopped = new, [_nothing()] * len(curves), list[Round](), False
    while any(map(len, new)) and not stopped:
        one = study.with_speeds([each.tolist() for each in new])
        curves = list(one.curves())
        solving, stopped = solve(curves)
        rounds.append(Round(solving))
        known = [_merged(*both) for both in zip(known, _found(solving), strict=True)]
        asked = [_asked(known[at::count], breaks[at], along) for at in range(count)]
        new = [each if not stopped else np.empty(0) for each in asked]
        speeds = [np.union1d(*both) for both in zip(speeds, new, strict=True)]
        _check_size(study.with_speeds([each.tolist() for each in speeds]), along)
    return ChosenSpeeds(study.with_speeds([each.tolist() for each in speeds]), rounds, stopped)


def _check_size(study: Study, along: SpeedRange) -> None:
    if (size := grid_size(study)) > MOST_CHOSEN:
        name = "study" if study.path is None else str(study.path)
        path = next(path for path, each in study.ranges.items() if each is along)
        what = (
            f"takes more than {size} points, and {MOST_CHOSEN} at most are chosen: give a larger one, or num"
        )
        raise StudyError([Mistake(name, None, f"sweep.{path}.{WITHIN}", what)])


def _breaks(laws: Sequence[FrictionLaw], scene: Scene, along: SpeedRange) -> Floats:
    """V_lin of a scene under each of its laws, and its mirror image, where they lie inside the range."""
    si = scene.dimensional
    scale = 1.0 if si is None else si.scales.velocity
    sizes = {scale * friction_free_velocity(scene, law) for law in laws}
    found = [sign * size for size in sizes if math.isfinite(size) for sign in (-1.0, 1.0)]
    near = CLOSEST * (along.stop - along.start)
    return np.unique([each for each in found if along.start + near < each < along.stop - near])


def _named(study: Study, along: SpeedRange) -> Floats:
    """The belt speeds in the range that the study expects something of."""
    path = next(path for path, each in study.ranges.items() if each is along)
    wanted = [each.where[path] for each in study.expect if path in each.where]
    found = [one for each in wanted for one in (each if isinstance(each, list) else [each])]
    return np.array([each for each in found if isinstance(each, float) and along.start <= each <= along.stop])


def _first(along: SpeedRange, breaks: Floats, named: Floats) -> Floats:
    """Evenly spaced belt speeds, and V_lin and those named in place of any that are nearly there.

    Of a curve that bends within few of them also shares of V_lin, from which its shape can be read.
    """
    even, near = np.array(along.first()), CLOSEST * (along.stop - along.start)
    below = [
        share * each for each in breaks if (np.abs(even) < abs(each)).sum() < len(SHARES) for share in SHARES
    ]
    inside = [each for each in below if along.start + near < each < along.stop - near]
    wanted = np.unique(np.concatenate([breaks, named, inside]))
    far = [bool((np.abs(wanted - each) > near).all()) for each in even]
    return np.union1d(even[far], wanted)


def _asked(known: Sequence[Known], breaks: Floats, along: SpeedRange) -> Floats:
    """The belt speeds that the curves of one scene still need."""
    closest = CLOSEST * (along.stop - along.start)
    return np.unique(np.concatenate([halves_to_add(*each, breaks, along.within, closest) for each in known]))


def _nothing() -> Known:
    return np.empty(0), np.empty(0), np.empty(0)


def _found(solving: Solving) -> list[Known]:
    means, errors = np.full((2, solving.points), np.nan)
    for part in solving.parts():
        for name, column in (("mean_friction", means), ("error", errors)):
            column[part.rows] = part.numbers.get(name, np.nan)
    rows = [slice(each.rows.start, each.rows.stop) for each in solving.curves]
    return [
        (each.scenes.given, means[own], errors[own]) for each, own in zip(solving.curves, rows, strict=True)
    ]


def _merged(known: Known, found: Known) -> Known:
    speeds, means, errors = (np.concatenate(both) for both in zip(known, found, strict=True))
    rising = np.argsort(speeds, kind="stable")
    return speeds[rising], means[rising], errors[rising]
