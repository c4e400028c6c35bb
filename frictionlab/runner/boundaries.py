"""Table of boundaries of a run: lines over two swept numbers on which a measure of the curves has a level.

A measure of many curves at once, straight from what methods find: no table of their points is made.

The belt speeds of a curve are shares of its end of reversal, the same for every curve, evenly spaced in the angle in
which curves are interpolated: a measure then changes smoothly from curve to curve, and few points suffice.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pandas as pd

from frictionlab.curves.ends import Loads, Rows, end_of_reversal, reverses
from frictionlab.curves.level_lines import LevelLine, OfTwoNumbers, level_lines
from frictionlab.runner.curve_table import curve_inputs, loads, measures
from frictionlab.runner.packing import numbers_of, words_of
from frictionlab.runner.pieces import Task
from frictionlab.runner.solving import Solving
from frictionlab.runner.table import inputs
from frictionlab.runner.workforce import Workforce, workforce
from frictionlab.scene.scenes import Scenes
from frictionlab.study import registry
from frictionlab.study.axes import Axis, GridValue
from frictionlab.study.figure_options import columns_swept, swept_numbers
from frictionlab.study.grid import StudyCurve
from frictionlab.study.parts import LawChoice
from frictionlab.study.study import Study
from frictionlab.theory import friction_free_velocity
from frictionlab.values.columns import ALWAYS, BOUNDARIES, FROM_ORBITS, INPUTS, OF_SHAPE
from frictionlab.values.quantities import Floats

EVEN_SHARES = np.sin(0.5 * np.pi * np.array([0.125, 0.5, *range(1, 33)]) / 32)
"""Belt speeds of a curve over its end of reversal, and two more near rest."""
FIRST_SHARES = np.array([0.02, 0.05, *np.arange(0.1, 1.25, 0.1)])
"""Shares of V_lin between which the end of reversal is sought where it is not V_lin."""
SHARP = 3e-5
"""Share of the end of reversal within which it is then found."""
_ROUNDS = 16
NO_SPEEDS = np.empty(0)


def measures_of(
    curves: Sequence[StudyCurve], measure: str, tolerance: float, force: Workforce, laws: registry.Laws
) -> tuple[Floats, Floats]:
    """A measure of every curve and the bounds on its errors; NaN where it cannot be determined."""
    known = _loads_of(curves, laws)
    points = _Points(curves, tolerance, force)
    if measure == "reduction":  # over the belt speeds that the study has
        read = points.at([curve.scenes.belt_speeds for curve in curves])
    else:
        read = _up_to_the_end(points, known)
    found = [
        measures(rows, load, curve.method.is_reduced, even=True)
        for rows, load, curve in zip(read, known, curves, strict=True)
    ]
    values, errors = ([each.get(name, math.nan) for each in found] for name in (measure, f"{measure}_error"))
    return np.array(values, dtype=float), np.array(errors, dtype=float)


def _loads_of(curves: Sequence[StudyCurve], laws: registry.Laws) -> list[Loads]:
    heads = [
        replace(curve, scenes=curve.scenes[:1], rows=range(at, at + 1)) for at, curve in enumerate(curves)
    ]
    columns = inputs(heads).columns
    return [loads({name: column[at] for name, column in columns.items()}, laws) for at in range(len(curves))]


class _Points:
    """Points of curves, solved where they are asked for."""

    def __init__(self, curves: Sequence[StudyCurve], tolerance: float, force: Workforce) -> None:
        self.curves, self._tolerance, self._force = curves, tolerance, force

    def at(self, speeds: Sequence[Floats], orbits: bool = True) -> list[Rows]:
        """Solve every curve at these belt speeds, rising; without orbits those columns are empty."""
        curves, first = list[StudyCurve](), 0
        for curve, own in zip(self.curves, speeds, strict=True):
            si = curve.scenes.scene.dimensional
            given = own if si is None else own * si.scales.velocity
            rows = range(first, first + len(given))
            curves.append(replace(curve, scenes=Scenes(curve.scenes.scene, given), rows=rows))
            first = rows.stop
        asked = OF_SHAPE if orbits else [name for name in OF_SHAPE if name not in FROM_ORBITS]
        task = Task(self._tolerance, columns=frozenset({*ALWAYS, *asked}))
        solving = Solving([each for each in curves if each.rows], task)
        solving.solve(self._force)
        found = np.full((len(Rows._fields), first), np.nan)
        found[0] = np.concatenate(speeds)
        answers = solving.answers()
        for place, name in enumerate(Rows._fields[1:], 1):
            found[place] = numbers_of(answers, name)
        usable = (words_of(answers, "status") == "ok").to_numpy() & (found[0] > 0.0)
        own_rows = [slice(each.rows.start, each.rows.stop) for each in curves]
        return [Rows(*found[:, own][:, usable[own]]) for own in own_rows]


def _up_to_the_end(points: _Points, known: Sequence[Loads]) -> list[Rows]:
    """Return points of every curve up to its end of reversal; where no V_lin tells of it, those of its study."""
    speeds, sought, in_orbits = list[Floats](), list[Floats](), False
    for curve, load in zip(points.curves, known, strict=True):
        scene, law = curve.scenes.scene, curve.law
        size, one_end = friction_free_velocity(scene, law), load.along_belt_only and not load.lags
        is_end = load.prescribed or (one_end and law.constant_sliding_friction())
        has_size = 0.0 < size < math.inf
        speeds.append(size * EVEN_SHARES if has_size else curve.scenes.belt_speeds)
        sought.append(size * FIRST_SHARES if has_size and not is_end else NO_SPEEDS)
        in_orbits = in_orbits or not (has_size and is_end)
    if not in_orbits:
        return points.at(speeds, orbits=False)
    around = _around_ends(points, known, sought)
    for at, rows in enumerate(around):
        if (on := reverses(rows)).any() and not on.all():
            speeds[at] = end_of_reversal(rows, known[at])[0].value * EVEN_SHARES[:-1]
            last = int(np.flatnonzero(on)[-1])
            around[at] = Rows(*(column[[last, *range(last + 1, len(column))]] for column in rows))
    return [_joined(*both) for both in zip(points.at(speeds), around, strict=True)]


def _around_ends(points: _Points, known: Sequence[Loads], first: Sequence[Floats]) -> list[Rows]:
    """Return points of every curve between which reversal ends, from these belt speeds on; none without these."""
    rows, new = [Rows(*[NO_SPEEDS] * len(Rows._fields))] * len(first), first
    for _ in range(_ROUNDS):
        if not any(map(len, new)):
            break
        rows = [_joined(*both) for both in zip(rows, points.at(new), strict=True)]
        new = [_narrower(*both) for both in zip(rows, known, strict=True)]
    return rows


def _narrower(rows: Rows, load: Loads) -> Floats:
    """Belt speeds that are missing before the end of reversal is known sharply."""
    on = reverses(rows)
    if not len(on):
        return NO_SPEEDS
    if on.all() or not on.any():
        return 1.5 * rows.belt_speed[-1:] if on.all() else 0.25 * rows.belt_speed[:1]
    end, _ = end_of_reversal(rows, load)
    last = int(np.flatnonzero(on)[-1])
    low, high = rows.belt_speed[last : last + 2]
    beside = np.array([end.value - end.error / 8.0, 0.5 * (low + high), end.value + end.error / 8.0])
    sharp = end.error <= SHARP * end.value
    return NO_SPEEDS if sharp else np.unique(beside[(low < beside) & (beside < high)])


def _joined(one: Rows, other: Rows) -> Rows:
    together = np.concatenate([one, other], axis=1)
    return Rows(*together[:, np.argsort(together[0], kind="stable")])


def boundary_table(study: Study, curves: pd.DataFrame, laws: registry.Laws) -> pd.DataFrame:
    """One row per place of every line, in its order; curves: those of the run, whose grid the lines are sought on.

    laws: those that the study may name.
    """
    if not study.boundaries:
        return pd.DataFrame()
    with workforce(None) as force:
        return _table(study, curves, force, laws)


def _table(study: Study, curves: pd.DataFrame, force: Workforce, laws: registry.Laws) -> pd.DataFrame:
    inputs, found = curve_inputs(curves.columns), list[pd.DataFrame]()
    for _, of_one in curves.groupby([*INPUTS], sort=False):
        sought = _Sought.of(study, of_one)
        if sought is None:
            continue
        told = of_one.iloc[0][[name for name in inputs if name not in sought.columns]].to_dict()
        for measure, levels in study.boundaries.items():
            grid, measured = sought.grid(of_one, measure), sought.measured(measure, force, laws)
            for level in levels:
                for piece, line in enumerate(level_lines(measured, grid, level), 1):
                    own = {"measure": measure, "level": level, "piece": piece, "closed": line.closed}
                    found.append(pd.DataFrame(told | own | sought.numbers(line)))
    return pd.concat(found, ignore_index=True) if found else pd.DataFrame(columns=[*inputs, *BOUNDARIES])


class _Along(NamedTuple):
    """An axis that lines are sought over: its numbers by paths of a study, and by columns of the table of one law.

    They are in the order in which those of the first column rise.
    """

    paths: dict[str, Floats]
    columns: dict[str, Floats]

    @classmethod
    def of(cls, axis: Axis, law: LawChoice) -> _Along | None:
        """None where no number of this law is swept along it."""
        columns = columns_swept(axis, law)
        if not columns:
            return None
        rising = np.argsort(np.array(next(iter(columns.values())), dtype=float))
        told = [
            {name: np.array(values, dtype=float)[rising] for name, values in each.items()}
            for each in (axis.values, columns)
        ]
        return cls(*told)


class _Sought(NamedTuple):
    """A study of one law by one method, and the two axes that lines are sought over."""

    study: Study
    axes: tuple[_Along, _Along]

    @classmethod
    def of(cls, study: Study, curves: pd.DataFrame) -> _Sought | None:
        """Return the axes of the curves' law and method; None where an axis does not vary this law."""
        (law,) = (each for each in study.laws if each.label == curves.iloc[0]["law"])
        methods = tuple(each for each in study.methods if each.label == curves.iloc[0]["method"])
        first, second = (_Along.of(axis, law) for axis in swept_numbers(study))
        alone = replace(study, laws=(law,), methods=methods)
        return None if first is None or second is None else cls(alone, (first, second))

    @property
    def columns(self) -> list[str]:
        """Return the columns of both axes."""
        return [name for axis in self.axes for name in axis.columns]

    def grid(self, curves: pd.DataFrame, measure: str) -> Floats:
        """A measure of curves on the grid [second, first number]."""
        first, second = (next(iter(axis.columns)) for axis in self.axes)
        return curves.pivot(index=second, columns=first, values=measure).to_numpy(dtype=float)

    def measured(self, measure: str, force: Workforce, laws: registry.Laws) -> OfTwoNumbers:
        """Return the measure of curves at places in steps of the grid, and its error."""
        return lambda places: measures_of(self._curves(places), measure, self.study.tolerance, force, laws)

    def _curves(self, places: Floats) -> list[StudyCurve]:
        """A curve at each place [n, 2]; between the values of the grid numbers run evenly."""
        between = {
            path: tuple(_between(values, places[:, at]).tolist())
            for at, axis in enumerate(self.axes)
            for path, values in axis.paths.items()
        }
        others = {path: values for path, values in self.study.sweep.items() if path not in between}
        ranges = {path: each for path, each in self.study.ranges.items() if path not in between}
        sweep: dict[str, tuple[GridValue, ...]] = {**between, **others}
        one = replace(self.study, sweep=sweep, links=(tuple(between),), ranges=ranges, chosen=())
        return list(one.curves())

    def numbers(self, line: LevelLine) -> dict[str, Floats]:
        """Return the columns of both axes along a line, each with its error."""
        found = dict[str, Floats]()
        for at, axis in enumerate(self.axes):
            place, error = line.places[:, at], line.errors[:, at]
            for name, values in axis.columns.items():
                middle, low, high = (_between(values, place + by * error) for by in (0.0, -1.0, 1.0))
                found[name] = middle
                found[f"{name}_error"] = np.maximum(np.abs(high - middle), np.abs(middle - low))
        return found


def _between(values: Floats, places: Floats) -> Floats:
    return np.interp(places, np.arange(len(values)), values)
