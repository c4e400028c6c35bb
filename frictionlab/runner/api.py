"""Studies, curves and single steady states from Python: solved in chunks, gathered in one table."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, Executor
from contextlib import contextmanager, suppress
from math import inf
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from frictionlab import __version__, registry
from frictionlab.columns import RESULTS, selected
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.results.curve_table import curve_table
from frictionlab.results.derived import si_columns, si_scales
from frictionlab.results.expectations import judge
from frictionlab.results.part import Part
from frictionlab.results.run import Run
from frictionlab.results.state import OrbitOf, SteadyState
from frictionlab.results.table import headings, inputs
from frictionlab.runner.accumulate import Accumulator
from frictionlab.runner.arguments import (
    check_ways,
    given_columns,
    given_law,
    given_method,
    given_scene,
    given_speeds,
    given_study,
    given_tolerance,
)
from frictionlab.runner.chunks import Chunk, Task, chunks
from frictionlab.runner.code_digest import code_digest
from frictionlab.runner.errors import SaveError
from frictionlab.runner.execute import collect
from frictionlab.runner.folder import Existing, Identity, RunFolder
from frictionlab.runner.progress import Progress, silent
from frictionlab.runner.solve import answer, parts
from frictionlab.runner.workers import Workers, within
from frictionlab.scene.scene import Scene
from frictionlab.study import Study, StudyCase


class Interrupted(KeyboardInterrupt):
    """A run was stopped; ``run`` is what it had found, already saved where it has a folder."""

    def __init__(self, run: Run) -> None:
        super().__init__("interrupted")
        self.run = run


class UnsavedError(SaveError):
    """A run whose results could not be written; ``run`` holds them."""

    def __init__(self, problem: SaveError, run: Run) -> None:
        super().__init__(str(problem))
        self.run = run


def run(
    study: str | PathLike[str] | Mapping[str, Any] | Study,
    out: str | PathLike[str] | None = None,
    overrides: Sequence[str] = (),
    existing: Existing = "reuse",
    executor: Executor | None = None,
    progress: Progress = silent,
    columns: Sequence[str] | None = None,
) -> Run:
    """Solve every case of a study. Writes only with ``out``, the folder for results.

    overrides: ``path=value`` as for ``--set``; a ``Study`` holds its own already, they are for the record.
    existing: take over finished points of the same study in ``out``, or replace whatever results it holds.
    executor: any; threads of this process by default.
    columns: result columns, in place of those of the study; inputs, mean_friction, error, status and reason always.
    Raises StudyError, FolderError, UnsavedError, Interrupted, BrokenPlugin, ValueError or TypeError for what makes no
    sense, such as an unknown column.
    """
    check_ways(existing, executor)
    ready = given_study(study, overrides, columns)
    folder = run_folder(ready, Path(out)) if out is not None else None
    if folder is not None:
        folder.check(existing)
    gathering = Accumulator(inputs(headings(ready)), folder, progress, overrides, ready.selected())
    task = Task(ready.tolerance, ready.keep_orbit or 0, ready.selected(), ready.seconds_per_point)
    gathering.resume(existing, task.samples)
    left = [] if gathering.complete else chunks(ready.cases(), task, gathering.finished)
    if folder is not None:
        folder.open(existing)
    stopped = _solve(gathering, left, executor)
    return _finished(ready, gathering, folder, stopped)


def run_folder(study: Study, out: Path) -> RunFolder:
    """The output folder of a study."""
    file = study.path.name if study.path is not None else None
    told = study.resolved(), study.digest(), __version__, file, study.code, study.law_texts()
    return RunFolder(out, Identity(*told, solver=code_digest(study)))


def _solve(gathering: Accumulator, left: list[Chunk], executor: Executor | None) -> bool:
    """Solve what is left and put it in the table; True when that was interrupted."""
    if not left:
        return False
    gathering.describe()
    try:
        with _workers(executor) as pool:
            collect(left, pool, gathering.take, gathering.tick)
    except KeyboardInterrupt:
        gathering.unfinished("interrupted")
        return True
    except BrokenExecutor as problem:
        gathering.unfinished(f"a worker died: {problem}")
    return False


@contextmanager
def _workers(executor: Executor | None) -> Iterator[Executor]:
    """The caller's executor, or threads that are not waited for after an interrupt."""
    if executor is not None:
        yield executor
        return
    pool = Workers(os.cpu_count() or 1)
    try:
        yield pool
    finally:
        pool.shutdown(wait=False, cancel_futures=True)


def _finished(study: Study, gathering: Accumulator, folder: RunFolder | None, stopped: bool) -> Run:
    """The run, saved and judged. Raises Interrupted or UnsavedError, both with the run."""
    table, orbits = gathering.table, gathering.orbits
    laws = registry.Laws({law.kind: law.law_class for law in study.laws})
    curves = curve_table(table.iloc[:0] if stopped else table, laws)
    verdicts = () if stopped else tuple(judge(expectation, table, curves) for expectation in study.expect)
    gathering.judged(verdicts)
    unsaved = _saved(gathering, table, orbits, curves)
    path = folder.path if folder is not None and unsaved is None else None
    done = Run(study, table, orbits, verdicts, path, gathering.computed, curves)
    if unsaved is not None:
        raise UnsavedError(unsaved, done) from unsaved
    if stopped:
        raise Interrupted(done)
    return done


def _saved(
    gathering: Accumulator, table: pd.DataFrame, orbits: pd.DataFrame | None, curves: pd.DataFrame
) -> SaveError | None:
    """Save the run; what kept it from being saved, to be raised once the run is whole."""
    try:
        gathering.save_all(table, orbits, curves)
    except SaveError as problem:
        return problem
    return None


def curve(
    scene: Scene,
    law: FrictionLaw,
    belt_speed: ArrayLike,
    method: str | Method = "auto",
    tolerance: float = 1e-8,
    columns: Sequence[str] | None = None,
) -> pd.DataFrame:
    """The result table of one law over belt speeds, in the order given.

    belt_speed [scene velocity; m/s for a scene given in SI units]: one-dimensional.
    tolerance [-]: absolute, on mean_friction.
    columns: result columns, all by default; inputs, mean_friction, error, status and reason always.
    Raises ValueError or TypeError for what makes no sense, BrokenPlugin.
    """
    scene, law, ready = given_scene(scene), given_law(law), given_method(method)
    kind, wanted = _kind(law), selected(None if columns is None else given_columns(columns, scene))
    task = Task(given_tolerance(tolerance), columns=wanted)
    # a method is never given a belt speed twice
    different, places = np.unique(given_speeds(belt_speed), return_inverse=True)
    scenes = [scene.at(float(speed)) for speed in different]
    cases = [StudyCase(kind, kind, law, ready.name, ready, each) for each in scenes]
    gathering = Accumulator(inputs(cases), columns=wanted)
    with _workers(None) as pool:
        collect(chunks(cases, task), pool, gathering.take, gathering.tick)
    return gathering.table.iloc[places].reset_index(drop=True)


def steady_state(
    scene: Scene, law: FrictionLaw, method: str | Method = "auto", tolerance: float = 1e-8
) -> SteadyState:
    """The steady state of one scene, refused and failed ones included: see ``status`` and ``reason``.

    tolerance [-]: absolute, on mean_friction. Raises ValueError or TypeError for what makes no sense, BrokenPlugin.
    """
    scene, law, ready = given_scene(scene), given_law(law), given_method(method)
    kind, task = _kind(law), Task(given_tolerance(tolerance))
    case = StudyCase(kind, kind, law, ready.name, ready, scene)
    (chunk,) = chunks([case], task)
    (piece,) = within(inf, answer, chunk)  # an interrupt is obeyed while a kernel runs
    (part,) = within(inf, parts, chunk, [piece])
    numbers = {name: float(column[0]) for name, column in part.numbers.items()}
    words = {name: column[0] for name, column in part.text.items()}
    motion = OrbitOf(piece.answers.orbit, scene)
    return SteadyState(**words, **numbers, si=_in_si(part, scene), motion=motion)  # type: ignore[arg-type]


def _in_si(part: Part, scene: Scene) -> dict[str, float]:
    """The columns in SI units; none where the scene is not given in them."""
    if scene.dimensional is None:
        return {}
    found = {name: part.numbers.get(name, np.full(1, np.nan)) for name in RESULTS}
    scales = {name: np.array([scale]) for name, scale in si_scales(scene).items()}
    return {name: float(column[0]) for name, column in si_columns(found, scales).items()}


def _kind(law: FrictionLaw) -> str:
    """The registered name of a law, of several that of its file; its class's where it is not registered."""
    names = []
    for name in registry.law_names():
        with suppress(registry.BrokenPlugin):  # another law's trouble
            if registry.law_class(name) is type(law):
                names.append(name)
    file = type(law).__module__.rpartition(".")[2].replace("_", "-")
    return file if file in names else next(iter(names), type(law).__name__)
