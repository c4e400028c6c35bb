"""Studies and curves, solved in pieces and gathered in one table."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.runner.arguments import (
    check_executor,
    check_limit,
    given_columns,
    given_law,
    given_method,
    given_scene,
    given_speeds,
    given_tolerance,
)
from frictionlab.runner.files import alone_in
from frictionlab.runner.folder import run_folder
from frictionlab.runner.gathering import whole_table
from frictionlab.runner.more_tables import attractor_table
from frictionlab.runner.pieces import Task
from frictionlab.runner.progress import ProgressAsked, progress_told, silent
from frictionlab.runner.results import Results
from frictionlab.runner.solving import Solving
from frictionlab.runner.store import FolderName, Store
from frictionlab.runner.study_run import RunWays, StudyRun
from frictionlab.runner.workforce import workforce
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.study.grid import StudyCurve
from frictionlab.study.parts import MethodChoice
from frictionlab.study.study import Study, kind_of
from frictionlab.values.columns import selected
from frictionlab.values.quantities import at_least_one


def solve_study(study: Study, out: FolderName | None, store: Store, ways: RunWays) -> Results:
    """Solve every case of a study. Raises what ``fl.run`` raises."""
    check_limit(study, ways.executor)
    if out is None:
        return StudyRun(study, None, store, ways).run()
    folder = run_folder(study, Path(out))
    with alone_in(folder.path):
        folder.check(ways.existing)
        return StudyRun(study, folder, store, ways).run()


def write_derived(done: Results, name: str) -> None:
    """Write the onsets or the boundaries of a run beside its table, unless they are there. Raises SaveError."""
    assert done.folder is not None
    folder = run_folder(done.study, done.folder)
    file = folder.path / f"{name}.csv"
    if not file.exists() and (table := getattr(done, name)) is not None:
        folder.add_text(file, table)


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
        Belt speeds [omega_1 L; m/s for a scene in SI units, or text such as ``"10 mm/s"``]; a number is one belt
        speed, ``{"start": 1, "stop": 60, "num": 120}`` a range.
    method : str or Method, default "auto"
        Name of a method, or a method such as ``fl.March(steps=1000)``.
    tolerance : float, > 0, default 1e-8
        Absolute bound [-] on the error of ``mean_friction``.
    columns : list of str or str, optional
        Result columns and groups of them, as for ``run``; "all" for every one.
    executor : concurrent.futures.Executor, optional
        Executor that solves the pieces; threads of this process if left out.
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
    different, places = np.unique(given_speeds(belt_speed, scene), return_inverse=True)
    whole = _one_curve(kind, law, ready, Scenes(scene, different))
    table = table_of([whole], task, executor, progress, usual=columns is None)
    return table.iloc[places].reset_index(drop=True)


def table_of(
    curves: Sequence[StudyCurve],
    task: Task,
    executor: Executor | None = None,
    progress: ProgressAsked = silent,
    usual: bool = False,
) -> pd.DataFrame:
    """Return the result table of curves whose rows follow one another; nothing is kept. Raises BrokenPlugin.

    usual: whether results that no row has are left out.
    """
    solving = Solving(curves, task)
    with workforce(executor) as force, progress_told(progress) as tell:
        solving.solve(force, tell)
    return whole_table(solving, usual)


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
    different = np.unique(given_speeds(belt_speed, scene))
    whole = _one_curve(kind_of(law), law, ready, Scenes(scene, different))
    with progress_told(progress, "following starts", ""):
        return attractor_table([whole], given_tolerance(tolerance), starts)


def _one_curve(kind: str, law: FrictionLaw, method: Method, scenes: Scenes) -> StudyCurve:
    return StudyCurve(law.label or kind, kind, law, MethodChoice.of(method), scenes, range(len(scenes)))
