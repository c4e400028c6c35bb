"""Studies, curves and single steady states from Python: solved in chunks, gathered in one table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import BrokenExecutor, Executor
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from frictionlab import __version__, registry
from frictionlab.columns import selected
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.quantities import at_least_one
from frictionlab.results.attractor_table import attractor_table
from frictionlab.results.curve_table import curve_table
from frictionlab.results.expectations import judge
from frictionlab.results.part import Part
from frictionlab.results.run import Run
from frictionlab.results.table import inputs
from frictionlab.results.thinned import LONG_TABLE
from frictionlab.runner.accumulate import Accumulator
from frictionlab.runner.arguments import (
    Existing,
    check_executor,
    check_ways,
    given_columns,
    given_law,
    given_method,
    given_scene,
    given_speeds,
    given_study,
    given_tolerance,
)
from frictionlab.runner.chosen_speeds import ChosenSpeeds, choose_speeds, rows_of_round
from frictionlab.runner.chunks import Task, task_of
from frictionlab.runner.code_digest import code_digest
from frictionlab.runner.errors import SaveError
from frictionlab.runner.folder import Identity, RunFolder
from frictionlab.runner.in_use import alone_in
from frictionlab.runner.kept_chunks import USUAL_GIGABYTES, KeptChunks, Keys, kept_beside
from frictionlab.runner.long_run import LongRun
from frictionlab.runner.onsets import onset_table
from frictionlab.runner.open_chunks import OpenChunk, answered, each_once, open_chunks
from frictionlab.runner.progress import Progress, silent
from frictionlab.runner.workforce import Workforce, workforce
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.study import MethodChoice, Study, StudyCurve
from frictionlab.study.grid import grid_size
from frictionlab.study.objects import kind_of


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
    executor: Executor | Workforce | None = None,
    progress: Progress = silent,
    columns: Sequence[str] | None = None,
    cache: str | PathLike[str] | None = None,
    cache_gigabytes: float = USUAL_GIGABYTES,
    as_csv: bool = False,
) -> Run:
    """Solve every case of a study. Writes only with ``out``, the folder for results.

    overrides: ``path=value`` as for ``--set``; a ``Study`` holds its own already, they are for the record.
    existing: take over finished points of the same study in ``out``, or replace whatever results it holds.
    executor: any; threads of this process by default.
    cache: the folder that keeps solved chunks for this and other studies, ``.cache`` beside ``out`` by default; above
    so many gigabytes those used longest ago are removed. Without ``out`` and ``cache`` nothing is written.
    as_csv: write a table of more than 1e5 rows as text, too; it is read from its file where ``.table`` is asked for.
    columns: result columns, in place of those of the study; inputs, mean_friction, error, status and reason always.

    >>> import frictionlab as fl
    >>> scene = {"damping_ratio": 0.1, "normal_load": 10, "belt_speed": 5, "drive": {"unbalance": 10, "frequency": 1}}
    >>> study = {"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}], "methods": ["auto", "mdsm"]}
    >>> done = fl.run(study, overrides=["scene.belt_speed=25"])
    >>> done.table[["method", "mean_friction"]].round(4).values.tolist()
    [['auto', 0.2178], ['mdsm', 0.1333]]

    Raises StudyError, FolderError, UnsavedError, Interrupted, BrokenPlugin, ValueError or TypeError for what makes no
    sense, such as an unknown column.
    """
    check_ways(existing, executor)
    ready = given_study(study, overrides, columns)
    kept = kept_beside(out, cache, cache_gigabytes)
    how = overrides, existing, executor, progress, as_csv
    if out is None:
        return _run_into(None, ready, kept, *how)
    folder = run_folder(ready, Path(out))
    with alone_in(folder.path):
        folder.check(existing)
        return _run_into(folder, ready, kept, *how)


def _run_into(
    folder: RunFolder | None,
    ready: Study,
    kept: KeptChunks | None,
    overrides: Sequence[str],
    existing: Existing,
    executor: Executor | Workforce | None,
    progress: Progress,
    as_csv: bool,
) -> Run:
    if folder is not None and kept is not None and grid_size(ready) > LONG_TABLE:
        return _run_long(
            LongRun(ready, folder, kept, overrides), folder, existing, executor, progress, as_csv
        )
    attractors, harmonics = _earlier_texts(folder, existing)
    chosen = None
    if ready.chosen_range is not None:
        chosen = choose_speeds(ready, _RoundSolver(folder, kept, existing, executor, progress).solve)
        ready = chosen.study
    curves = list(ready.curves())
    gathering = Accumulator(inputs(curves), folder, progress, overrides, ready.selected())
    task = task_of(ready)
    if ready.keep_harmonics is None or harmonics is not None:
        gathering.resume(existing, task.samples, in_part=ready.keep_harmonics is None)
    complete = gathering.complete
    left = [] if complete or chosen else list(open_chunks(curves, task, gathering.finished, Keys(ready.code)))
    if folder is not None:
        folder.open(existing)
    if chosen is None or complete:
        stopped = _solve(gathering, left, kept, executor)
    else:
        stopped = _take_over(chosen, curves, gathering)
    attractors, harmonics = (attractors, harmonics) if gathering.complete else (None, None)
    done = _finished(ready, gathering, folder, stopped)
    return _with_attractors(_with_harmonics(done, harmonics, gathering, folder), attractors, folder)


@dataclass
class _RoundSolver:
    """Solves the rounds in which belt speeds are chosen; points of an earlier run in the folder are taken over."""

    folder: RunFolder | None
    kept: KeptChunks | None
    existing: Existing
    executor: Executor | Workforce | None
    progress: Progress
    points: int = 0

    def solve(self, study: Study, curves: list[StudyCurve]) -> tuple[Accumulator, bool]:
        """The rows of these curves, and whether that was interrupted."""
        task, before = task_of(study), self.points
        gathering = Accumulator(
            inputs(curves),
            progress=lambda done, total: self.progress(before + done, before + total),
            columns=study.selected(),
        )
        if study.keep_harmonics is None:
            gathering.resume(self.existing, task.samples, folder=self.folder)
        left = list(open_chunks(curves, task, gathering.finished, Keys(study.code)))
        self.points += sum(len(each.rows) for each in curves)
        return gathering, _solve(gathering, left, self.kept, self.executor)


def _take_over(chosen: ChosenSpeeds, curves: Sequence[StudyCurve], gathering: Accumulator) -> bool:
    """Enter the rows of every round; True where the last was interrupted."""
    for one in chosen.rounds:
        gathering.take_over(one.gathering, *rows_of_round(one, curves))
    return chosen.stopped


def _earlier_texts(
    folder: RunFolder | None, existing: Existing
) -> tuple[pd.DataFrame | None, pd.DataFrame | None]:
    """Attractors and harmonics that an earlier run of this study wrote once it was whole."""
    if folder is None:
        return None, None
    files = folder.attractors_file, folder.harmonics_file
    attractors, harmonics = (folder.earlier_text(file, existing) for file in files)
    return attractors, harmonics


def _run_long(
    long: LongRun,
    folder: RunFolder,
    existing: Existing,
    executor: Executor | Workforce | None,
    progress: Progress,
    as_csv: bool,
) -> Run:
    if existing == "reuse" and long.is_whole(as_csv):
        return long.taken_over()
    folder.open(existing)
    with workforce(executor) as force:
        stopped = long.solve(force, progress)
    done = long.gather(stopped, as_csv)
    if stopped:
        raise Interrupted(done)
    return done


def run_folder(study: Study, out: Path) -> RunFolder:
    """The output folder of a study."""
    file = study.path.name if study.path is not None else None
    told = study.resolved(), study.digest(), __version__, file, study.code, study.law_texts()
    return RunFolder(out, Identity(*told, solver=code_digest(study)))


def with_onsets(done: Run) -> Run:
    """The run, its onsets in onsets.csv beside its table: found now, or read where an earlier run wrote them.

    Without a curve there is no such file. Raises SaveError.
    """
    assert done.folder is not None
    folder = run_folder(done.study, done.folder)
    earlier = folder.onsets() if done.computed == 0 else None
    if earlier is not None:
        return replace(done, onsets_made=lambda: earlier)
    if not done.curves.empty:
        folder.save_onsets(done.onsets)
    return done


def _solve(
    gathering: Accumulator,
    left: list[OpenChunk],
    kept: KeptChunks | None,
    executor: Executor | Workforce | None,
) -> bool:
    """Solve what is left and put it in the table; True when that was interrupted."""
    if not left:
        return False
    gathering.describe()
    try:
        unknown = _look_up(left, kept, gathering)
        with workforce(executor) as force:
            force.solve(unknown, lambda work, parts: _take(work, parts, kept, gathering), gathering.tick)
    except KeyboardInterrupt:
        gathering.unfinished("interrupted")
        return True
    except BrokenExecutor as problem:
        gathering.unfinished(f"a worker died: {problem}")
    finally:
        if kept is not None:
            kept.trim()
    return False


def _look_up(left: Sequence[OpenChunk], kept: KeptChunks | None, gathering: Accumulator) -> list[OpenChunk]:
    """Enter what is known already; the rest, each once."""
    unknown = []
    for work in left:
        part = kept.found(work.key) if kept is not None and work.key is not None else None
        if part is None:
            unknown.append(work)
        else:
            gathering.take_found(work.of(part))
    return each_once(unknown)


def _take(work: OpenChunk, parts: list[Part], kept: KeptChunks | None, gathering: Accumulator) -> None:
    """Keep and enter what was found of a chunk."""
    part = answered(work, parts)
    if part is None:
        gathering.take(parts)
        return
    own, *others = work.of(part)
    gathering.take([own], kept is not None and kept.keeps(work.key, part))
    gathering.take_found(others)


def _finished(study: Study, gathering: Accumulator, folder: RunFolder | None, stopped: bool) -> Run:
    """The run, saved and judged. Raises Interrupted or UnsavedError, both with the run."""
    table, orbits = gathering.table, gathering.orbits
    laws = registry.Laws({law.kind: law.law_class for law in study.laws})
    read = table.iloc[:0] if stopped else table
    curves = curve_table(read, laws)
    verdicts = () if stopped else tuple(judge(expectation, table, curves) for expectation in study.expect)
    gathering.judged(verdicts)
    unsaved = _saved(gathering, table, orbits, curves)
    path = folder.path if folder is not None and unsaved is None else None
    done = Run(
        study,
        lambda: table,
        lambda: orbits,
        verdicts,
        path,
        gathering.computed,
        curves,
        onsets_made=lambda: onset_table(study, read),
    )
    if unsaved is not None:
        raise UnsavedError(unsaved, done) from unsaved
    if stopped:
        raise Interrupted(done)
    return done


def _with_harmonics(
    done: Run, found: pd.DataFrame | None, gathering: Accumulator, folder: RunFolder | None
) -> Run:
    """The run with its harmonics, where the study keeps them. Raises UnsavedError."""
    if done.study.keep_harmonics is None:
        return done
    done = replace(done, harmonics=gathering.harmonics if found is None else found)
    try:
        if folder is not None and found is None:
            assert done.harmonics is not None
            folder.save_harmonics(done.harmonics)
    except SaveError as problem:
        raise UnsavedError(problem, done) from problem
    return done


def _with_attractors(done: Run, found: pd.DataFrame | None, folder: RunFolder | None) -> Run:
    """The run with its attractors, where the study keeps them. Raises Interrupted, UnsavedError."""
    count = done.study.keep_attractors
    if count is None:
        return done
    try:
        table = (
            attractor_table(list(done.study.curves()), done.study.tolerance, count)
            if found is None
            else found
        )
    except KeyboardInterrupt:
        raise Interrupted(done) from None
    done = replace(done, attractors=table)
    try:
        if folder is not None and found is None:
            folder.save_attractors(table)
    except SaveError as problem:
        raise UnsavedError(problem, done) from problem
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
    executor: Executor | None = None,
) -> pd.DataFrame:
    """The result table of one law over belt speeds: a row each, in the order given.

    belt_speed [omega_1 L; m/s for a scene given in SI units]: a number, or a list or array of one dimension.
    method: a name, or a method such as ``fl.March(steps=1000)``. tolerance [-]: absolute, on mean_friction.
    columns: result columns, all by default; inputs, mean_friction, error, status and reason always.
    executor: any; threads of this process by default.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> table = fl.curve(scene, fl.Coulomb(mu=0.4), belt_speed=[5, 25, 45])
    >>> table["mean_friction"].round(4).tolist()
    [0.0506, 0.2178, 0.3613]

    Raises ValueError or TypeError for what makes no sense, BrokenPlugin.
    """
    scene, law, ready = given_scene(scene), given_law(law), given_method(method)
    check_executor(executor)
    kind, wanted = kind_of(law), selected(None if columns is None else given_columns(columns, scene))
    task = Task(given_tolerance(tolerance), columns=wanted)
    # a method is never given a belt speed twice
    different, places = np.unique(given_speeds(belt_speed), return_inverse=True)
    whole = _one_curve(kind, law, ready, Scenes(scene, different))
    return table_of([whole], task, executor).iloc[places].reset_index(drop=True)


def table_of(curves: Sequence[StudyCurve], task: Task, executor: Executor | None = None) -> pd.DataFrame:
    """The result table of curves whose rows follow one another; nothing is kept. Raises BrokenPlugin."""
    gathering = Accumulator(inputs(curves), columns=task.columns)
    with workforce(executor) as force:
        force.solve(list(open_chunks(curves, task)), lambda _, parts: gathering.take(parts), gathering.tick)
    return gathering.table


def attractors(
    scene: Scene,
    law: FrictionLaw,
    belt_speed: ArrayLike,
    starts: int = 8,
    method: str | Method = "auto",
    tolerance: float = 1e-8,
) -> pd.DataFrame:
    """Every state that motions of a driven scene end in, of whatever period: a row per Poincare point.

    So many starts are followed at each belt speed [scene velocity], as shooting does, and every state found is
    carried on to the next belt speed from both sides. Rows rise in belt speed; columns as in ``attractors.csv`` of a
    study: period in those of the drive, mean_friction [-], position x [L] and velocity [omega_1 L] of the point.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> found = fl.attractors(scene, fl.Coulomb(mu=0.4), belt_speed=[1, 5], starts=4)
    >>> found[["belt_speed", "period", "x"]].round(2).values.tolist()
    [[1.0, 1.0, -24.51], [5.0, 1.0, -24.93]]

    Raises ValueError or TypeError for what makes no sense, BrokenPlugin.
    """
    scene, law, ready = given_scene(scene), given_law(law), given_method(method)
    starts = at_least_one("starts", starts)
    different = np.unique(given_speeds(belt_speed))
    whole = _one_curve(kind_of(law), law, ready, Scenes(scene, different))
    return attractor_table([whole], given_tolerance(tolerance), starts)


def _one_curve(kind: str, law: FrictionLaw, method: Method, scenes: Scenes) -> StudyCurve:
    return StudyCurve(law.label or kind, kind, law, MethodChoice.of(method), scenes, range(len(scenes)))
