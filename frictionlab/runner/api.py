"""Studies, curves and single steady states from Python: solved in chunks, gathered in one table."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from frictionlab import __version__
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.runner.arguments import (
    Existing,
    check_executor,
    check_limit,
    check_ways,
    given_columns,
    given_law,
    given_method,
    given_scene,
    given_speeds,
    given_study,
    given_tolerance,
)
from frictionlab.runner.files import alone_in
from frictionlab.runner.folder import ASKED, SOLVER, Identity, RunFolder
from frictionlab.runner.gathering import whole_table
from frictionlab.runner.more_tables import attractor_table
from frictionlab.runner.pieces import Task
from frictionlab.runner.progress import ProgressAsked, progress_told, silent
from frictionlab.runner.run import Run
from frictionlab.runner.solving import Solving
from frictionlab.runner.store import USUAL_GIGABYTES, code_digest, store_of
from frictionlab.runner.study_run import Interrupted, RunWays, StudyRun, UnsavedError
from frictionlab.runner.table import without_empty
from frictionlab.runner.workforce import Workforce, workforce
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.study.grid import StudyCurve
from frictionlab.study.parts import MethodChoice
from frictionlab.study.study import Study, kind_of
from frictionlab.values.columns import selected
from frictionlab.values.quantities import at_least_one

__all__ = [
    "Interrupted",
    "UnsavedError",
    "attractors",
    "curve",
    "run",
    "run_folder",
    "table_of",
    "with_boundaries",
    "with_onsets",
]


def run(
    study: str | PathLike[str] | Mapping[str, Any] | Study,
    out: str | PathLike[str] | None = None,
    overrides: Sequence[str] = (),
    existing: Existing = "reuse",
    executor: Executor | Workforce | None = None,
    progress: ProgressAsked = None,
    columns: Sequence[str] | str | None = None,
    cache: str | PathLike[str] | None = None,
    cache_gigabytes: float = USUAL_GIGABYTES,
    as_csv: bool = False,
) -> Run:
    """Solve every case of a study.

    Nothing is written without ``out`` and ``cache``.

    Parameters
    ----------
    study : str, path-like, dict or Study
        Study: the path of a file, the content of one as a mapping, or a ``Study``.
    out : str or path-like, optional
        Folder for results; they are kept in memory only if left out.
    overrides : list of str, default ()
        Changes ``path=value`` as for ``--set``. A ``Study`` has them already: with one they are recorded
        only.
    existing : {"reuse", "replace"}, default "reuse"
        Treatment of results in ``out``: "reuse" takes over finished points of the same study, "replace"
        replaces any results.
    executor : concurrent.futures.Executor, optional
        Executor that solves the chunks; threads of this process if left out.
    progress : bool, optional
        Whether to report progress on stderr from the third second on. If left out, it is reported where a
        terminal or a notebook shows it.
    columns : list of str or str, optional
        Result columns and groups of them, instead of those of the study; "all" for every one.
        ``frictionlab columns`` lists them.
    cache : str or path-like, optional
        Folder that keeps solved chunks for this and other studies; ``.cache`` beside ``out`` if left out.
    cache_gigabytes : float, default 4
        Largest size of the cache [GB]; beyond it the chunks that were used longest ago are removed.
    as_csv : bool, default False
        Whether to write a table of more than 1e5 rows as text, too. Such a table is read from its file when
        ``.table`` is first used.

    Returns
    -------
    Run
        Tables, kept orbits, and the verdicts on what the study expects.

    Raises
    ------
    StudyError
        If the study has mistakes; the message has every one.
    FolderError
        If ``out`` holds another study, or another run writes there.
    UnsavedError
        If a file cannot be written; ``.run`` of the error has the results.
    Interrupted
        If the run is interrupted by Ctrl-C; finished points are kept in ``out``.
    BrokenPlugin
        If an installed law or a law from a file cannot be used.
    ValueError
        If a value makes no sense, such as an unknown column.
    TypeError
        If a value is of another kind.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = {"damping_ratio": 0.1, "normal_load": 10, "belt_speed": 5, "drive": {"unbalance": 10, "frequency": 1}}
    >>> study = {"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}], "methods": ["auto", "mdsm"]}
    >>> done = fl.run(study, overrides=["scene.belt_speed=25"])
    >>> done.table[["method", "mean_friction"]].round(4).values.tolist()
    [['auto', 0.2178], ['mdsm', 0.1333]]
    """
    check_ways(existing, executor)
    ready = given_study(study, overrides, columns)
    check_limit(ready, executor)
    store = store_of(out, cache, cache_gigabytes)
    with progress_told(progress) as tell:
        ways = RunWays(overrides, existing, executor, tell, as_csv)
        if out is None:
            return StudyRun(ready, None, store, ways).run()
        folder = run_folder(ready, Path(out))
        with alone_in(folder.path):
            folder.check(existing)
            return StudyRun(ready, folder, store, ways).run()


def run_folder(study: Study, out: Path) -> RunFolder:
    """The output folder of a study."""
    file = study.path.name if study.path is not None else None
    told = study.resolved(), study.digest(), __version__, file, study.code, study.law_texts()
    kept = study.keep_orbit, study.keep_harmonics, study.keep_attractors
    asked = repr((list(study.sweep), kept, sorted(study.selected()), *sorted(study.boundaries.items())))
    marks = {SOLVER: code_digest(study), ASKED: hashlib.sha256(asked.encode()).hexdigest()}
    return RunFolder(out, Identity(*told, marks=marks))


def with_onsets(done: Run) -> Run:
    """The run, its onsets in onsets.csv beside its table: found now, or read where an earlier run wrote them.

    Without a curve there is no such file. Raises SaveError.
    """
    assert done.folder is not None
    folder = run_folder(done.study, done.folder)
    earlier = folder.intact_text(folder.onsets_file) if done.computed == 0 else None
    if earlier is not None:
        return replace(done, onsets_made=lambda: earlier)
    if not done.curves.empty:
        folder.save_text(folder.onsets_file, done.onsets)
    return done


def with_boundaries(done: Run) -> Run:
    """The run, its boundaries in boundaries.csv beside its table: found now, or read where an earlier run wrote them.

    Raises SaveError.
    """
    assert done.folder is not None
    folder = run_folder(done.study, done.folder)
    earlier = folder.intact_text(folder.boundaries_file) if done.computed == 0 else None
    if earlier is not None:
        return replace(done, boundaries_made=lambda: earlier)
    folder.save_text(folder.boundaries_file, done.boundaries)
    return done


def curve(
    scene: Scene,
    law: FrictionLaw,
    belt_speed: ArrayLike,
    method: str | Method = "auto",
    tolerance: float = 1e-8,
    columns: Sequence[str] | str | None = None,
    executor: Executor | None = None,
    progress: ProgressAsked = None,
) -> pd.DataFrame:
    """Compute the result table of one law over belt speeds.

    Parameters
    ----------
    scene : Scene
        Body and belt, and what shakes them.
    law : FrictionLaw
        Law of friction.
    belt_speed : array_like of float, shape (n,)
        Belt speeds [omega_1 L; m/s for a scene in SI units]; a number is one belt speed.
    method : str or Method, default "auto"
        Name of a method, or a method such as ``fl.March(steps=1000)``.
    tolerance : float, > 0, default 1e-8
        Absolute bound [-] on the error of ``mean_friction``.
    columns : list of str or str, optional
        Result columns and groups of them, as for ``run``; "all" for every one.
    executor : concurrent.futures.Executor, optional
        Executor that solves the chunks; threads of this process if left out.
    progress : bool, optional
        Whether to report progress on stderr from the third second on. If left out, it is reported where a
        terminal or a notebook shows it.

    Returns
    -------
    pandas.DataFrame
        A row for each belt speed, in the order given.

    Raises
    ------
    ValueError
        If a value makes no sense.
    TypeError
        If a value is of another kind.
    BrokenPlugin
        If an installed law or a law from a file cannot be used.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> table = fl.curve(scene, fl.Coulomb(mu=0.4), belt_speed=[5, 25, 45])
    >>> table["mean_friction"].round(4).tolist()
    [0.0506, 0.2178, 0.3613]
    """
    scene, law, ready = given_scene(scene), given_law(law), given_method(method)
    check_executor(executor)
    kind, wanted = kind_of(law), selected(None if columns is None else given_columns(columns, scene))
    task = Task(given_tolerance(tolerance), columns=wanted)
    # a method is never given a belt speed twice
    different, places = np.unique(given_speeds(belt_speed), return_inverse=True)
    whole = _one_curve(kind, law, ready, Scenes(scene, different))
    table = table_of([whole], task, executor, progress).iloc[places].reset_index(drop=True)
    return without_empty(table) if columns is None else table


def table_of(
    curves: Sequence[StudyCurve],
    task: Task,
    executor: Executor | None = None,
    progress: ProgressAsked = silent,
) -> pd.DataFrame:
    """The result table of curves whose rows follow one another; nothing is kept. Raises BrokenPlugin."""
    solving = Solving(curves, task)
    with workforce(executor) as force, progress_told(progress) as tell:
        solving.solve(force, tell)
    return whole_table(solving)


def attractors(
    scene: Scene,
    law: FrictionLaw,
    belt_speed: ArrayLike,
    starts: int = 8,
    method: str | Method = "auto",
    tolerance: float = 1e-8,
    progress: ProgressAsked = None,
) -> pd.DataFrame:
    """Find every steady state that motions of a driven scene end in, whatever its period.

    Motions from ``starts`` initial states are followed at each belt speed, as ``shooting`` does. Every state
    found is continued to the next belt speed from both sides.

    Parameters
    ----------
    scene : Scene
        Body and belt, and what shakes them.
    law : FrictionLaw
        Law of friction.
    belt_speed : array_like of float, shape (n,)
        Belt speeds [omega_1 L; m/s for a scene in SI units].
    starts : int, >= 1, default 8
        Number of initial states at each belt speed.
    method : str or Method, default "auto"
        Name of a method, or a method such as ``fl.March(steps=1000)``.
    tolerance : float, > 0, default 1e-8
        Absolute bound [-] on the error of ``mean_friction``.
    progress : bool, optional
        Whether to report progress on stderr from the third second on. If left out, it is reported where a
        terminal or a notebook shows it.

    Returns
    -------
    pandas.DataFrame
        A row for each point of the Poincare map of each state, belt speeds ascending. Columns are those of
        ``attractors.csv`` of a study: ``period`` in drive periods, ``mean_friction`` [-], position ``x`` [L]
        and ``velocity`` [omega_1 L] of the point, ...

    Raises
    ------
    ValueError
        If a value makes no sense.
    TypeError
        If a value is of another kind.
    BrokenPlugin
        If an installed law or a law from a file cannot be used.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> found = fl.attractors(scene, fl.Coulomb(mu=0.4), belt_speed=[1, 5], starts=4)
    >>> found[["belt_speed", "period", "x"]].round(2).values.tolist()
    [[1.0, 1.0, -24.51], [5.0, 1.0, -24.93]]
    """
    scene, law, ready = given_scene(scene), given_law(law), given_method(method)
    starts = at_least_one("starts", starts)
    different = np.unique(given_speeds(belt_speed))
    whole = _one_curve(kind_of(law), law, ready, Scenes(scene, different))
    with progress_told(progress, "following starts", ""):
        return attractor_table([whole], given_tolerance(tolerance), starts)


def _one_curve(kind: str, law: FrictionLaw, method: Method, scenes: Scenes) -> StudyCurve:
    return StudyCurve(law.label or kind, kind, law, MethodChoice.of(method), scenes, range(len(scenes)))
