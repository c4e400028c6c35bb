"""The table of boundaries of a run: lines over two swept numbers on which a measure of the curves has a level."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pandas as pd

from frictionlab import registry
from frictionlab.columns import BOUNDARIES, INPUTS
from frictionlab.onsets.level_lines import LevelLine, OfTwoNumbers, level_lines
from frictionlab.quantities import Floats
from frictionlab.results.curve_table import curve_inputs
from frictionlab.runner.curve_measures import measures_of
from frictionlab.runner.workforce import Workforce, workforce
from frictionlab.study import Study, StudyCurve
from frictionlab.study.axes import Axis, GridValue
from frictionlab.study.level_lines import columns_swept, swept_numbers
from frictionlab.study.parts import LawChoice


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
        """Those of the curves' law and method; None where an axis does not vary this law."""
        (law,) = (each for each in study.laws if each.label == curves.iloc[0]["law"])
        methods = tuple(each for each in study.methods if each.label == curves.iloc[0]["method"])
        first, second = (_Along.of(axis, law) for axis in swept_numbers(study))
        alone = replace(study, laws=(law,), methods=methods)
        return None if first is None or second is None else cls(alone, (first, second))

    @property
    def columns(self) -> list[str]:
        """Those of both axes."""
        return [name for axis in self.axes for name in axis.columns]

    def grid(self, curves: pd.DataFrame, measure: str) -> Floats:
        """A measure of curves on the grid [second, first number]."""
        first, second = (next(iter(axis.columns)) for axis in self.axes)
        return curves.pivot(index=second, columns=first, values=measure).to_numpy(dtype=float)

    def measured(self, measure: str, force: Workforce, laws: registry.Laws) -> OfTwoNumbers:
        """The measure of curves at places in steps of the grid, and its error."""
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
        """The columns of both axes along a line, each with its error."""
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
