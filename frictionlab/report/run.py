"""Studies, laws, methods and scenes solved from Python: one result that holds tables and makes pages of them."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, fields
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from frictionlab.runner.api import solve_study
from frictionlab.runner.arguments import (
    Existing,
    check_ways,
    given_scene,
    given_speeds,
    given_study,
)
from frictionlab.runner.pairs import with_friction
from frictionlab.runner.progress import ProgressAsked, progress_told
from frictionlab.runner.results import Results
from frictionlab.runner.saved import read_run, save_run
from frictionlab.runner.store import USUAL_GIGABYTES, store_of
from frictionlab.runner.study_run import Interrupted, RunWays, UnsavedError
from frictionlab.runner.summary import summary
from frictionlab.runner.table import swept_inputs, whole
from frictionlab.runner.workforce import Workforce
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

    from frictionlab.charts.figures import FigureData


@dataclass(frozen=True, repr=False)
class Run(Results):
    """Results of a study, in memory or in a folder: tables, verdicts, figures, report.

    ``fl.run``, ``fl.compare``, ``fl.sweep`` and ``fl.load`` return it. It is shown as its summary, in a notebook as a
    small table with the curves drawn in it.

    Attributes
    ----------
    study : Study
        Study that was solved; ``.to_yaml()`` writes it as a study file.
    readers : dict of str to callable
        Functions that read or make each table; a table is read when its attribute is first used.
    counts : dict of str to int
        Number of rows of each status.
    verdicts : tuple of Verdict
        Verdict on each expectation of the study.
    computed : int
        Number of points computed by this run, not found in the store.
    seconds : float
        Wall time of all runs that worked on it [s].
    folder : Path, optional
        Folder that the run was written to; None if it is in memory.
    account : dict
        Content of ``provenance.json`` of a run in a folder.
    damaged : tuple of str
        Files of a loaded folder that are damaged, and the command that mends them.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> done = fl.compare(scene, fl.Coulomb(mu=0.4), belt_speed=[5, 25, 45])
    >>> done
    Run(3 points: 3 ok)
    >>> print(str(done).splitlines()[0])
    3 points: 3 ok
    """

    @classmethod
    def of(cls, results: Results) -> Run:
        """Return results as a run.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": 1}}
        >>> done = fl.run({"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}]})
        >>> fl.Run.of(done).size
        1
        """
        return cls(**{each.name: getattr(results, each.name) for each in fields(Results)})

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
        from frictionlab.charts.figures import draw_figures  # with matplotlib, which takes a second
        from frictionlab.report.page import write_report

        saved = save_run(self, Path(folder))
        data = figure_data(saved)
        draw_figures(data, Path(folder) / "figures")
        write_report(saved, data)
        return Path(folder)

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

    def __str__(self) -> str:
        """Return the summary that ``frictionlab run`` prints."""
        return summary(self)

    def _repr_html_(self) -> str:
        from frictionlab.report.preview import preview_html  # with jinja2, which takes a moment

        table, curves = (in_shown_units(each, self.study.units) for each in (self.table, self.curves))
        return preview_html(table, curves)


def figure_data(done: Results) -> FigureData:
    """Return what the figures of a run are drawn of; of a long table, whose rows are not all there, no orbits."""
    from frictionlab.charts.figures import FigureData, Kept  # with matplotlib, which takes a second

    kept = Kept(done.orbits_of, done.harmonics)
    told = {"onsets": done.shown_onsets, "curves": done.curves, "attractors": done.attractors}
    boundaries = done.boundaries if done.study.boundaries else None
    return FigureData.of(done.study, done.shown, done.title, kept=kept, boundaries=boundaries, **told)


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
        Changes ``path=value`` as for ``--set``. Of a ``Study`` nothing is changed; they are only recorded.
    existing : {"reuse", "replace"}, default "reuse"
        Treatment of results in ``out``: "reuse" takes over finished points of the same study, "replace"
        replaces any results.
    executor : concurrent.futures.Executor, optional
        Executor that solves the pieces; threads of this process if left out.
    progress : bool, optional
        Whether to report progress on stderr from the third second on. If left out, it is reported where a
        terminal or a notebook shows it.
    columns : list of str or str, optional
        Result columns and groups of them, instead of those of the study; "all" for every one.
        ``frictionlab columns`` lists them.
    cache : str or path-like, optional
        Folder that keeps solved pieces for this and other studies; ``.cache`` beside ``out`` if left out.
    cache_gigabytes : float, default 4
        Largest size of the cache [GB]; beyond it the pieces that were used longest ago are removed.
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
    store = store_of(out, cache, cache_gigabytes)
    with progress_told(progress) as tell:
        try:
            return Run.of(
                solve_study(ready, out, store, RunWays(overrides, existing, executor, tell, as_csv))
            )
        except (Interrupted, UnsavedError) as problem:
            problem.run = Run.of(problem.run)
            raise


def load(folder: str | PathLike[str]) -> Run:
    """Read a run from its folder; nothing is computed.

    Parameters
    ----------
    folder : str or path-like
        Folder that ``frictionlab run``, ``fl.run`` or ``.save()`` wrote.

    Returns
    -------
    Run
        Tables, kept orbits and verdicts of the run, as they were written.

    Raises
    ------
    FolderError
        If it is not the folder of a run, or a file in it is damaged.
    StudyError
        If its ``study.yaml`` has mistakes.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> fl.load(fl.compare(scene, fl.Coulomb(mu=0.4)).save("one")).counts
    {'ok': 1}
    """
    return Run.of(read_run(Path(folder)))


def compare(
    scene: Scene,
    laws: LawsGiven,
    belt_speed: ArrayLike | Mapping[str, float] | None = None,
    methods: MethodsGiven = "auto",
    tolerance: float = 1e-8,
    columns: Sequence[str] | None = None,
    executor: Executor | None = None,
    progress: ProgressAsked = None,
) -> Run:
    """Compare laws, by one or several methods, along belt speeds of one scene.

    Parameters
    ----------
    scene : Scene
        Body and belt, and what shakes them.
    laws : FrictionLaw, list of FrictionLaw, or dict of str to FrictionLaw
        One law, a list of laws, or a mapping label -> law. Two laws of one kind in a list need a ``label=``.
    belt_speed : array_like of float, or dict, optional
        Belt speeds [omega_1 L; m/s for a scene in SI units, or text such as ``"10 mm/s"``]: a list, or a range as
        in a study, ``{"start": 1, "stop": 60, "num": 120}``. With ``"within": 1e-3`` instead of ``num`` points
        are chosen where curves bend. The belt speed of the scene if left out.
    methods : str, Method, or a list or dict of them, default "auto"
        Name of a method, a method such as ``fl.March(steps=1000)``, a list of them, or a mapping
        label -> method.
    tolerance : float, > 0, default 1e-8
        Absolute bound [-] on the error of ``mean_friction``.
    columns : list of str, optional
        Result columns and groups of them; "all" for every one. All default columns if left out.
    executor : concurrent.futures.Executor, optional
        Executor that solves the pieces; threads of this process if left out.
    progress : bool, optional
        Whether to report progress on stderr from the third second on. If left out, it is reported where a
        terminal or a notebook shows it.

    Returns
    -------
    Run
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
    listed = (
        belt_speed
        if belt_speed is None or isinstance(belt_speed, Mapping)
        else given_speeds(belt_speed, ready)
    )
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
) -> Run:
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
        Executor that solves the pieces; threads of this process if left out.
    progress : bool, optional
        Whether to report progress on stderr from the third second on. If left out, it is reported where a
        terminal or a notebook shows it.

    Returns
    -------
    Run
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
    asked = columns if columns is None or isinstance(columns, str) else list(columns)
    study = Study.of(scene, laws, methods, over, tolerance=tolerance, columns=asked)
    return run(study, executor=executor, progress=progress)


_COEFFICIENTS = "law.mu", "law.mu_kinetic", "law.mu_static"
