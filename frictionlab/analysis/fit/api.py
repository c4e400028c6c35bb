"""``fl.fit``: laws to measured curves, or to slip and friction over time.

Measurements of a study from its files; a study at the points of its measurements.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from frictionlab.analysis.fit.errors import blocks_of
from frictionlab.analysis.fit.free import Model, free_numbers
from frictionlab.analysis.fit.measured import Measurements, WrongData, given_measurements
from frictionlab.analysis.fit.residuals import STARTS, Residuals, search
from frictionlab.analysis.fit.result import STOPPED, FittedLaw, FittedLaws
from frictionlab.laws.base import FrictionLaw
from frictionlab.runner.arguments import given_law, given_scene
from frictionlab.scene.scene import Scene
from frictionlab.study.keys import SLIP_ALONE
from frictionlab.study.study import Study
from frictionlab.values.quantities import at_least_one

NEEDS_SCENE = (
    "the measurements are mean friction against belt speed: write the scene that they were measured in, "
    "scene: {damping_ratio: ..., ...}"
)
NO_POINTS = "its measurements are slip and friction over time, without a body: use frictionlab fit"


def measured_of(study: Study) -> Measurements:
    """Return what a study's files hold. Raises WrongData, which names the file, the row and the column."""
    assert study.data is not None
    folder = Path() if study.path is None else study.path.parent
    tables = [_read(folder / name, dict(study.data.columns)) for name in study.data.file]
    measured = given_measurements(tables, ", ".join(study.data.file), study.scene, units=study.data.units)
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
    """Study at the belt speeds and other inputs that were measured; as it is where it names no measurements.

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
    return replace(study, sweep={**study.sweep, **values}, ranges=ranges, links=links, data=None, free=None)


def fit(
    data: Any,
    law: FrictionLaw | Sequence[FrictionLaw],
    scene: Scene | None = None,
    free: Mapping[str, Any] | None = None,
    blocks: ArrayLike | None = None,
    starts: int = STARTS,
    tell: Callable[[str], None] | None = None,
    threads: int = 1,
    units: Mapping[str, str] | None = None,
) -> FittedLaws:
    """Fit numbers of laws, and of their scene, to measurements by least squares.

    Parameters
    ----------
    data : pandas.DataFrame, dict of str to array_like, or list of them
        Measurements. Either columns ``belt_speed`` (``belt_speed_m_per_s`` for a scene in SI units) and
        ``mean_friction``, or columns ``time``, ``slip`` [a length] and ``friction`` [-] for the law along a
        measured path, without a body and a scene; rate-independent laws need no ``time``. Further columns are
        optional: ``sigma``, the standard error of a row, ``block``, and ``scene.<path>``, a number of the scene
        of the row. ``mean_friction_N`` or ``friction_N`` with ``normal_load_N`` replace a coefficient.
    law : FrictionLaw or list of FrictionLaw
        Laws; numbers that are not free keep their value.
    scene : Scene, optional
        Scene of the measurements; none for a measured path.
    free : dict of str to tuple
        Required. Ranges by name, ``{"mu": (0.1, 1)}``, of which each law takes those it has, or by path,
        ``"scene.damping_ratio"``; text with a unit if the scene is in SI units, ``("1 um", "0.1 mm")``.
        Instead of a tuple, a mapping with from, to and spacing (linear or log).
    blocks : array_like, shape (n,), optional
        Label of the block of each row, instead of the column; rows of different blocks are independent.
    starts : int, >= 1, default 8
        Number of starts of the search, drawn over the ranges.
    tell : callable, optional
        Function that is called with the name of what is being fitted.
    threads : int, >= 1, default 1
        Derivatives that are computed at the same time. Results do not depend on it.
    units : dict of str to str, optional
        Units of columns, for a scene in SI units: ``{"belt_speed": "mm/s", "mean_friction": "N"}``. A force is
        divided by ``normal_load_N``, or by the normal load of the scene.

    Returns
    -------
    FittedLaws
        Fitted laws, with errors and profiles of their numbers.

    Raises
    ------
    ValueError
        If a value or the data make no sense; the message has the row and what to do.
    TypeError
        If a value is of another kind.

    Examples
    --------
    >>> import numpy as np
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> speeds = np.linspace(2, 60, 12)
    >>> measured = fl.curve(scene, fl.Coulomb(mu=0.4), speeds)["mean_friction"] + 1e-3 * np.sin(7 * speeds)
    >>> data = {"belt_speed": speeds, "mean_friction": measured}
    >>> found = fl.fit(data, fl.Coulomb(mu=0.3), scene, free={"mu": (0.1, 1.0)})
    >>> round(found.values["mu"], 2), found.shapes["mu"]
    (0.4, 'bounded')
    """
    laws = [given_law(each) for each in (law if isinstance(law, Sequence) else [law])]
    body = None if scene is None else given_scene(scene)
    measured = given_measurements(data, scene=body, blocks=blocks, units=units)
    return fit_measured(measured, laws, body, free or {}, starts, tell, threads)


def fit_measured(
    measured: Measurements,
    laws: Sequence[FrictionLaw],
    scene: Scene | None,
    free: Mapping[str, Any],
    starts: int = STARTS,
    tell: Callable[[str], None] | None = None,
    threads: int = 1,
) -> FittedLaws:
    """Return the same of checked measurements. Raises ValueError."""
    scene = None if measured.is_path else scene
    if not measured.is_path and scene is None:
        raise ValueError(
            "a curve of mean friction needs the scene it was measured in: fit(data, law, scene, ...)"
        )
    numbers = free_numbers(free, laws, scene)
    models = [Model(law, scene, numbers[place]) for place, law in enumerate(laws)]
    for model in models:
        at_any_rate = getattr(model.law, "rate_independent", model.law.constant_sliding_friction)
        if not measured.timed and not at_any_rate():
            raise ValueError(
                f"data: {model.label} depends on how quick slip is: the column 'time' is missing"
            )
        if not model.free:
            raise ValueError(
                f"free: {model.label} has none of {', '.join(free)}; leave it out or free a number of it"
            )
        if len(model.free) >= len(measured.values):
            raise ValueError(
                f"{len(model.free)} free numbers need more than {len(model.free)} rows, got {len(measured.values)}"
            )
    fitted: list[FittedLaw] = []
    failed: dict[str, str] = {}
    for model in models:
        residuals = Residuals(model, measured, at_least_one("threads", threads))
        try:
            found = search(residuals, starts, tell)
        except KeyboardInterrupt:
            if not fitted:
                raise
            failed |= {each.label: STOPPED for each in models[len(fitted) + len(failed) :]}
            break
        raw = residuals.raw(found.best.shares)
        if residuals.unanswered:
            failed[model.label] = (
                f"{residuals.unanswered} of {len(raw)} rows have no mean friction at the optimum: {residuals.why}"
            )
        else:
            fitted.append(FittedLaw(residuals, found, *blocks_of(measured, raw)))
    # laws are ranked on the same rows left out: the blocks of that law which has the fewest
    fewest = min((each.blocks for each in fitted), key=np.max, default=None)
    fitted = [replace(each, parts=fewest) for each in fitted]
    if not fitted:
        told = "; ".join(f"{law}: {why}" for law, why in failed.items())
        raise ValueError(f"no law could be fitted: {told}")
    return FittedLaws(measured, tuple(fitted), failed)
