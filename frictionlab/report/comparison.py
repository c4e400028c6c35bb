"""Laws, methods and scenes compared in memory: one call, one result that holds tables and makes pages of them."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd
from numpy.typing import ArrayLike

from frictionlab.report.preview import preview_html
from frictionlab.runner.api import run as run_study
from frictionlab.runner.api import with_onsets
from frictionlab.runner.arguments import given_scene, given_speeds
from frictionlab.runner.pairs import with_friction
from frictionlab.runner.progress import ProgressAsked
from frictionlab.runner.run import Run
from frictionlab.runner.saved import save_run, saved_as
from frictionlab.runner.summary import summary
from frictionlab.runner.table import swept_inputs, whole
from frictionlab.scene.scene import Scene
from frictionlab.study.axes import FRICTION
from frictionlab.study.figure_options import figure_options
from frictionlab.study.study import LawsGiven, MethodsGiven, Study
from frictionlab.values.columns import BELT_SPEEDS
from frictionlab.values.columns import belt_speed as column_of_speed
from frictionlab.values.units import in_shown_units

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False)
class Comparison:
    """Study that was solved in memory, with its table, curves and figures.

    ``fl.compare`` and ``fl.sweep`` return it. It is shown as its summary, in a notebook as a small table with
    the curves drawn in it.

    Attributes
    ----------
    run : Run
        Results of the study.
    seconds : float
        Time that the solution took [s].

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> done = fl.compare(scene, fl.Coulomb(mu=0.4), belt_speed=[5, 25, 45])
    >>> print(str(done).splitlines()[0])
    3 points: 3 ok
    """

    run: Run
    seconds: float

    @property
    def study(self) -> Study:
        """Study that was solved; ``.to_yaml()`` writes it as a study file.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> done = fl.compare(scene, [fl.Coulomb(mu=0.4), fl.Dahl(mu=0.4, stiffness=40)], belt_speed=[5, 25, 45])
        >>> done.study.laws[1].law()
        Dahl(mu=0.4, stiffness=40)
        """
        return self.run.study

    @property
    def table(self) -> pd.DataFrame:
        """Table with a row for each scene, law and method, and every result column.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> done = fl.compare(scene, [fl.Coulomb(mu=0.4), fl.Dahl(mu=0.4, stiffness=40)], belt_speed=[5, 25, 45])
        >>> done.table[["law", "scene.belt_speed", "mean_friction"]].round(4).values.tolist()[:2]
        [['coulomb', 5.0, 0.0506], ['coulomb', 25.0, 0.2178]]
        """
        return self.run.table

    @property
    def curves(self) -> pd.DataFrame:
        """Table of curves with their shapes, as in ``curves.csv``; empty if belt speed is not swept.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> done = fl.compare(scene, fl.Coulomb(mu=0.4), belt_speed={"start": 1, "stop": 60, "num": 30})
        >>> done.curves[["law", "shape"]].values.tolist()
        [['coulomb', 'concave']]
        """
        return self.run.curves

    @property
    def onsets(self) -> pd.DataFrame:
        """Table with a row for each belt speed at which the motion changes its kind.

        Onsets are computed when first used.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> done = fl.compare(scene, [fl.Coulomb(mu=0.4), fl.Dahl(mu=0.4, stiffness=40)], belt_speed=[5, 25, 45])
        >>> done.onsets[["law", "onset", "belt_speed"]].round(2).values.tolist()[0]
        ['coulomb', 'stick_begins', 43.9]
        """
        return self.run.onsets

    def to_xarray(self) -> xarray.Dataset:
        """Convert the table to an xarray dataset.

        Dimensions are law, belt speed, every swept input, and method if there are several. They have the
        names of columns: select a method by ``.sel({"method": "exact"})``. All other columns are variables,
        parameters of laws included.

        Returns
        -------
        xarray.Dataset
            Dataset with the values of the table.

        Raises
        ------
        ImportError
            If xarray is not installed; ``pip install 'frictionlab[xarray]'`` installs it.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> done = fl.compare(scene, [fl.Coulomb(mu=0.4), fl.Dahl(mu=0.4, stiffness=40)], belt_speed=[5, 25, 45])
        >>> arrays = done.to_xarray()
        >>> arrays["mean_friction"].sel({"law": "coulomb", "scene.belt_speed": 25}).round(4).item()
        0.2178
        """
        try:
            import xarray  # noqa: F401 - pandas makes the dataset, and tells less well that it is missing
        except ImportError:
            raise ImportError("to_xarray needs xarray: pip install 'frictionlab[xarray]'") from None
        table = self.table
        if FRICTION in self.study.sweep:  # one dimension for what each law calls mu or mu_kinetic
            table = table.assign(**{FRICTION: with_friction(table)["law.mu"]})
            table = table[[FRICTION, *(name for name in table.columns if name != FRICTION)]]
        methods = ["method"] * (table["method"].nunique() > 1)
        swept = [name for name in swept_inputs(table) if FRICTION not in table or name not in _COEFFICIENTS]
        shared = [FRICTION] * (FRICTION in table)
        dimensions = ["law", *methods, *shared, *swept, column_of_speed(table.columns)]
        rest = [name for name in table.columns if name not in dimensions]
        return table.set_index(dimensions)[rest].to_xarray()

    def plot(
        self, figure: str = "mean_friction", onsets: bool = False, ax: Axes | None = None, **options: Any
    ) -> Figure:
        """Draw one of the figures, to show, change and save; nothing is written.

        Parameters
        ----------
        figure : str, default "mean_friction"
            Name of the figure: "mean_friction", "velocity", "energies", "differences", "shape" or "map".
        onsets : bool, default False
            Whether to mark onsets, which take a while to compute.
        ax : matplotlib.axes.Axes, optional
            Axes to draw into, for a figure that is one picture; a figure is made if left out.
        **options : Any
            Keys of ``figures`` of a study, such as ``normalized=True``, ``width="single"``,
            ``against="coulomb"``.

        Returns
        -------
        matplotlib.figure.Figure
            Figure.

        Raises
        ------
        ValueError
            If there is no such figure, if the figure is several pictures and ``ax`` is given, or if an option
            has no meaning.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> figure = fl.compare(scene, fl.Coulomb(mu=0.4), belt_speed=[5, 25, 45, 60]).plot(width="single")
        >>> round(25.4 * figure.get_figwidth())
        85
        """
        from frictionlab.charts.figures import FigureData, figure_of  # with matplotlib, which takes a second

        study = self.study
        asked = figure_options(study.figures.resolved() | options, tuple(law.label for law in study.laws))
        marked = self.onsets if onsets else None
        told = {"onsets": marked, "curves": self.curves, "options": asked}
        return figure_of(FigureData.of(study, whole(self.table), study.title, **told), figure, ax)

    def save(self, folder: str | PathLike[str]) -> Path:
        """Write what ``frictionlab run`` writes into a folder, with figures and report.

        Parameters
        ----------
        folder : str or path-like
            Folder for results.

        Returns
        -------
        Path
            Path of the folder.

        Raises
        ------
        FolderError
            If the folder holds results of another study.
        SaveError
            If a file cannot be written.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> done = fl.compare(scene, fl.Coulomb(mu=0.4))
        >>> {"results.csv", "report.html", "study.yaml"} < {file.name for file in done.save("laws").iterdir()}
        True
        """
        from frictionlab.charts.figures import (  # with matplotlib, which takes a second
            FigureData,
            draw_figures,
        )
        from frictionlab.report.page import write_report

        saved = saved_as(with_onsets(save_run(self.run, Path(folder), self.seconds)))
        told = {"onsets": saved.onsets, "curves": saved.curves}
        data = FigureData.of(saved.study, saved.table, saved.title, **told)
        draw_figures(data, saved.folder / "figures")
        write_report(saved, data)
        return saved.folder

    def report(self, path: str | PathLike[str]) -> Path:
        """Write the report alone, one HTML file that needs no others.

        Parameters
        ----------
        path : str or path-like
            Path of the file.

        Returns
        -------
        Path
            Path of the file.

        Raises
        ------
        SaveError
            If the file cannot be written.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> done = fl.compare(scene, fl.Coulomb(mu=0.4))
        >>> print(done.report("laws.html"))
        laws.html
        """
        from frictionlab.runner.files import write_whole

        with tempfile.TemporaryDirectory() as folder:
            page = self.save(Path(folder) / Path(path).stem) / "report.html"
            write_whole(Path(path), page.read_bytes())
        return Path(path)

    def __repr__(self) -> str:
        """The summary that ``frictionlab run`` prints."""
        return summary(self.run)

    def _repr_html_(self) -> str:
        table, curves = (in_shown_units(each, self.study.units) for each in (self.table, self.curves))
        return preview_html(table, curves)


def compare(
    scene: Scene,
    laws: LawsGiven,
    belt_speed: ArrayLike | Mapping[str, float] | None = None,
    methods: MethodsGiven = "auto",
    tolerance: float = 1e-8,
    columns: Sequence[str] | None = None,
    executor: Executor | None = None,
    progress: ProgressAsked = None,
) -> Comparison:
    """Compare laws, by one or several methods, along belt speeds of one scene.

    Parameters
    ----------
    scene : Scene
        Body and belt, and what shakes them.
    laws : FrictionLaw, list of FrictionLaw, or dict of str to FrictionLaw
        One law, a list of laws, or a mapping label -> law. Two laws of one kind in a list need a ``label=``.
    belt_speed : array_like of float, or dict, optional
        Belt speeds [omega_1 L; m/s for a scene in SI units]: a list, or a range as in a study, ``{"start": 1,
        "stop": 60, "num": 120}``. With ``"within": 1e-3`` instead of ``num`` points are chosen where curves
        bend. The belt speed of the scene if left out.
    methods : str, Method, or a list or dict of them, default "auto"
        Name of a method, a method such as ``fl.March(steps=1000)``, a list of them, or a mapping
        label -> method.
    tolerance : float, > 0, default 1e-8
        Absolute bound [-] on the error of ``mean_friction``.
    columns : list of str, optional
        Result columns and groups of them; "all" for every one. All default columns if left out.
    executor : concurrent.futures.Executor, optional
        Executor that solves the chunks; threads of this process if left out.
    progress : bool, optional
        Whether to report progress on stderr from the third second on. If left out, it is reported where a
        terminal or a notebook shows it.

    Returns
    -------
    Comparison
        Table, curves and figures.

    Raises
    ------
    StudyError
        If the study has mistakes; the message has every one.
    TypeError
        If something is no scene, law or method.
    BrokenPlugin
        If an installed law or a law from a file cannot be used.

    Examples
    --------
    >>> import frictionlab as fl
    >>> drive = fl.Drive(unbalance=10, frequency=1)
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
    >>> found = fl.compare(scene, [fl.Coulomb(mu=0.4), fl.Dahl(mu=0.4, stiffness=40)], belt_speed=[5, 25, 45])
    >>> found.table.pivot(index="scene.belt_speed", columns="law", values="mean_friction").round(3).loc[25].tolist()
    [0.218, 0.218]
    """
    ready = given_scene(scene)
    listed = belt_speed if belt_speed is None or isinstance(belt_speed, Mapping) else given_speeds(belt_speed)
    over = {} if listed is None else {BELT_SPEEDS[ready.dimensional is not None]: listed}
    return sweep(scene, laws, over, methods, tolerance, columns, executor, progress)


def sweep(
    scene: Scene,
    laws: LawsGiven,
    over: Mapping[str, Any],
    methods: MethodsGiven = "auto",
    tolerance: float = 1e-8,
    columns: Sequence[str] | None = None,
    executor: Executor | None = None,
    progress: ProgressAsked = None,
) -> Comparison:
    """Solve the full grid of a sweep.

    Parameters
    ----------
    scene : Scene
        Body and belt, and what shakes them.
    laws : FrictionLaw, list of FrictionLaw, or dict of str to FrictionLaw
        One law, a list of laws, or a mapping label -> law. Two laws of one kind in a list need a ``label=``.
    over : dict of str to list or dict
        Lists or ranges of values by path: ``scene.<path>`` or ``laws.<label>.<parameter>``.
    methods : str, Method, or a list or dict of them, default "auto"
        Name of a method, a method such as ``fl.March(steps=1000)``, a list of them, or a mapping
        label -> method.
    tolerance : float, > 0, default 1e-8
        Absolute bound [-] on the error of ``mean_friction``.
    columns : list of str, optional
        Result columns and groups of them; "all" for every one. All default columns if left out.
    executor : concurrent.futures.Executor, optional
        Executor that solves the chunks; threads of this process if left out.
    progress : bool, optional
        Whether to report progress on stderr from the third second on. If left out, it is reported where a
        terminal or a notebook shows it.

    Returns
    -------
    Comparison
        Table, curves and figures.

    Raises
    ------
    StudyError
        If the study has mistakes; the message has every one.
    TypeError
        If something is no scene, law or method.
    BrokenPlugin
        If an installed law or a law from a file cannot be used.

    Examples
    --------
    >>> import frictionlab as fl
    >>> drive = fl.Drive(unbalance=10, frequency=1)
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
    >>> found = fl.sweep(scene, fl.Coulomb(mu=0.4), {"scene.drive.frequency": [1, 1.5], "scene.belt_speed": [5, 20]})
    >>> len(found.table)
    4
    """
    told = {
        "tolerance": tolerance,
        "columns": columns if columns is None or isinstance(columns, str) else list(columns),
    }
    study = Study.of(scene, laws, methods, over, **told)
    start = time.perf_counter()
    done = run_study(study, executor=executor, progress=progress)
    return Comparison(done, time.perf_counter() - start)


_COEFFICIENTS = "law.mu", "law.mu_kinetic", "law.mu_static"
