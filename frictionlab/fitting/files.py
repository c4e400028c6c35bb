"""Measurements of a study from its files; a study at the points of its measurements."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pandas as pd

from frictionlab.fitting.measured import Measurements, WrongData, given_measurements
from frictionlab.scene.scene import Scene
from frictionlab.study import Study
from frictionlab.study.data import SLIP_ALONE

NEEDS_SCENE = (
    "the measurements are mean friction against belt speed: write the scene that they were measured in, "
    "scene: {damping_ratio: ..., ...}"
)
NO_POINTS = "its measurements are slip and friction over time, without a body: use frictionlab fit"


def measured_of(study: Study) -> Measurements:
    """What a study's files hold. Raises WrongData, which names the file, the row and the column."""
    assert study.data is not None
    folder = Path() if study.path is None else study.path.parent
    tables = [_read(folder / name, dict(study.data.columns)) for name in study.data.files]
    where = ", ".join(study.data.files)
    measured = given_measurements(tables, where, study.scene.dimensional is not None)
    if not measured.is_path and study.scene == Scene(**SLIP_ALONE):
        raise WrongData(f"{study.path or 'study'}: {NEEDS_SCENE}")
    return measured


def _read(file: Path, columns: dict[str, str]) -> pd.DataFrame:
    """A table with our names for its columns."""
    try:
        table = _table(file)
    except (OSError, ValueError, pd.errors.ParserError) as problem:
        raise WrongData(f"{file}: cannot be read as a table: {problem}") from None
    for ours, theirs in columns.items():
        if theirs not in table:
            known = ", ".join(map(str, table.columns))
            raise WrongData(f"{file}: data.columns.{ours}: there is no column '{theirs}', there are {known}")
    return table.rename(columns={theirs: ours for ours, theirs in columns.items()})


def _table(file: Path) -> pd.DataFrame:
    name = file.name.removesuffix(".gz")
    if name.endswith(".parquet"):
        return pd.read_parquet(file)
    separator = "," if name.endswith(".csv") else "\t" if name.endswith(".tsv") else r"\s+"
    return pd.read_csv(file, sep=separator, comment="#")


def at_measured_points(study: Study) -> Study:
    """The study at the belt speeds and other inputs that were measured; as it is where it names no measurements.

    Raises WrongData.
    """
    if study.data is None:
        return study
    measured = measured_of(study)
    if measured.is_path:
        raise WrongData(f"{study.path or 'study'}: {NO_POINTS}")
    inputs = [name for name in measured.table if name.startswith("scene.")]
    speed = measured.speed
    points = measured.table.rename(columns={measured.along: speed})[[*inputs, speed]].drop_duplicates()
    points = points.sort_values(speed, kind="stable")
    values = {name: tuple(points[name].tolist()) for name in points}
    ranges = {name: each for name, each in study.ranges.items() if name not in values}
    links = (*study.links, tuple(values)) if len(values) > 1 else study.links
    sweep = {**study.sweep, **values}
    return replace(study, sweep=sweep, ranges=ranges, links=links, data=None, free=None)
