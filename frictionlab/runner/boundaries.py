"""The table of boundaries of a run: lines over two swept numbers on which a measure of the curves has a level."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import pandas as pd

from frictionlab.columns import BOUNDARIES, INPUTS, SHAPE
from frictionlab.onsets.level_lines import LevelLine, level_lines
from frictionlab.quantities import Floats
from frictionlab.results.curve_table import curve_inputs
from frictionlab.results.run import Run
from frictionlab.study import Study
from frictionlab.study.axes import Axis
from frictionlab.study.level_lines import column_swept, swept_numbers


def boundary_table(study: Study, curves: pd.DataFrame, solve: Callable[[Study], Run]) -> pd.DataFrame:
    """One row per place of every line, in its order; curves: those of the run, whose grid the lines are sought on.

    solve: a study of curves between those of the grid.
    """
    if not study.boundaries:
        return pd.DataFrame()
    axes = swept_numbers(study)
    columns = [column_swept(axis) for axis in axes]
    alike = [name for name in curve_inputs(curves.columns) if name not in columns]
    found = [
        _rows(of_one.iloc[0][alike], measure, level, piece, columns, line, _numbers(axes, line))
        for _, of_one in curves.groupby([*INPUTS], sort=False)
        for measure, levels in study.boundaries.items()
        for level in levels
        for piece, line in enumerate(_lines(study, axes, of_one, measure, level, solve), 1)
    ]
    told = [name for column in columns for name in (column, f"{column}_error")]
    return (
        pd.concat(found, ignore_index=True) if found else pd.DataFrame(columns=[*alike, *BOUNDARIES, *told])
    )


def _lines(
    study: Study,
    axes: tuple[Axis, Axis],
    curves: pd.DataFrame,
    measure: str,
    level: float,
    solve: Callable[[Study], Run],
) -> list[LevelLine]:
    """Those of one law by one method."""
    law, method = curves.iloc[0]["law"], curves.iloc[0]["method"]
    alone = replace(
        study,
        laws=tuple(each for each in study.laws if each.label == law),
        methods=tuple(each for each in study.methods if each.label == method),
        expect=(),
        boundaries={},
        columns=(SHAPE,),
        keep_orbit=None,
        keep_attractors=None,
        keep_harmonics=None,
    )
    first, second = (column_swept(axis) for axis in axes)
    grid = curves.pivot(index=second, columns=first, values=measure).to_numpy(dtype=float)
    along, across = (sorted(next(iter(axis.values.values()))) for axis in axes)
    if grid.shape != (len(across), len(along)):
        return []

    def function(places: Floats) -> tuple[Floats, Floats]:
        different, places_of = np.unique(_at_places(axes, places), axis=0, return_inverse=True)
        solved = solve(_at(alone, axes, different)).curves
        values, errors = (solved[name].to_numpy(dtype=float) for name in (measure, f"{measure}_error"))
        return values[places_of] - level, errors[places_of]

    return level_lines(function, grid - level)


def _at(study: Study, axes: tuple[Axis, Axis], numbers: Floats) -> Study:
    """The study with a curve at each of these pairs of numbers [n, 2]."""
    paths = tuple(path for axis in axes for path in axis.values)
    pairs = {path: tuple(values.tolist()) for path, values in zip(paths, numbers.T, strict=True)}
    others = {path: values for path, values in study.sweep.items() if path not in paths}
    return replace(
        study,
        sweep=pairs | others,
        links=(paths,),
        ranges={path: each for path, each in study.ranges.items() if path not in paths},
        chosen=(),
    )


def _at_places(axes: tuple[Axis, Axis], places: Floats) -> Floats:
    """The two numbers at places in steps of the grid; between its values they run evenly."""
    values = [np.sort(np.array(next(iter(axis.values.values())), dtype=np.float64)) for axis in axes]
    return np.stack(
        [np.interp(at, np.arange(len(of)), of) for at, of in zip(places.T, values, strict=True)], axis=1
    )


def _numbers(axes: tuple[Axis, Axis], line: LevelLine) -> Iterator[Floats]:
    """Each number along a line, and its error."""
    place, low, high = (_at_places(axes, line.places + by * line.errors) for by in (0.0, -1.0, 1.0))
    error = np.maximum(np.abs(high - place), np.abs(place - low))
    for number in range(2):
        yield from (place[:, number], error[:, number])


def _rows(
    alike: pd.Series,
    measure: str,
    level: float,
    piece: int,
    columns: list[str],
    line: LevelLine,
    numbers: Iterator[Floats],
) -> pd.DataFrame:
    told = alike.to_dict() | {"measure": measure, "level": level, "piece": piece, "closed": line.closed}
    names = [name for column in columns for name in (column, f"{column}_error")]
    return pd.DataFrame(dict(zip(names, numbers, strict=True))).assign(**told)[[*told, *names]]
