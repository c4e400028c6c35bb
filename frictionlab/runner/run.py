"""What a run returns: its table, curves, verdicts and orbits."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import pandas as pd

from frictionlab.runner.expectations import Verdict
from frictionlab.runner.table import status_counts
from frictionlab.runner.words import counted
from frictionlab.study.study import Study


@dataclass(frozen=True, repr=False)
class Run:
    """Results of a study: its tables, its kept orbits, and the verdicts on what it expects.

    ``fl.run`` returns it.

    Attributes
    ----------
    study : Study
        Study that was solved.
    made : callable
        Function that returns the table, or reads it from its file; ``table`` calls it once.
    orbits_made : callable
        The same for ``orbits``.
    verdicts : tuple of Verdict
        Verdict on each expectation of the study.
    folder : Path, optional
        Folder that the run was written to; None if it was not written.
    computed : int
        Number of points computed by this run, not taken over.
    curves : pandas.DataFrame
        A row for each curve, with its shape; empty if belt speed is not swept or the run was stopped.
    onsets_made : callable
        Function that returns ``onsets``.
    boundaries_made : callable
        Function that returns ``boundaries``.
    shown : pandas.DataFrame, optional
        Rows that figures and pages show, of a table too long to be held in memory.
    found : dict of str to int, optional
        Number of rows of each status, of such a table.
    attractors : pandas.DataFrame, optional
        A row for each Poincare point of every state that motions end in, if the study keeps them. Else a row
        for each state of the points that have several; None if no point has.
    harmonics : pandas.DataFrame, optional
        A row for each harmonic of every orbit; None if the study does not keep them.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": 1}}
    >>> done = fl.run({"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}]})
    >>> done
    Run(1 point: 1 ok)
    """

    study: Study
    made: Callable[[], pd.DataFrame]  # the table, or what reads it from its file; so of the others
    orbits_made: Callable[[], pd.DataFrame | None]
    verdicts: tuple[Verdict, ...]
    folder: Path | None
    computed: int
    curves: pd.DataFrame = field(default_factory=pd.DataFrame)
    onsets_made: Callable[[], pd.DataFrame] = pd.DataFrame
    boundaries_made: Callable[[], pd.DataFrame] = pd.DataFrame
    shown: pd.DataFrame | None = None  # of a table too long to be held: the rows that figures and pages show
    found: Mapping[str, int] | None = None  # and how many of all rows have each status
    attractors: pd.DataFrame | None = None
    harmonics: pd.DataFrame | None = None

    def __repr__(self) -> str:
        """How many points there are of each status, and where the table is."""
        told = ", ".join(f"{count} {status}" for status, count in self.counts.items())
        where = f"; table in {self.table_file}" if self.table_file else ""
        return f"Run({counted(self.size, 'point')}: {told}{where})"

    @cached_property
    def table(self) -> pd.DataFrame:
        """Table with a row for each scene, law and method, with the inputs and every result column.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": 1}}
        >>> done = fl.run({"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}]})
        >>> done.table["mean_friction"].round(4).tolist()
        [0.1333]
        """
        return self.made()

    @cached_property
    def orbits(self) -> pd.DataFrame | None:
        """Kept orbits, a row for each instant; None if the study keeps none.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": 1}}
        >>> study = {"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}], "keep": {"orbit": 4}}
        >>> fl.run(study).orbits["slip"].round(6).tolist()
        [-1.0, 1.0, -1.0, -3.0]
        """
        return self.orbits_made()

    @cached_property
    def onsets(self) -> pd.DataFrame:
        """Table with a row for each onset of a curve, such as the belt speed where stick begins.

        Onsets are computed when first used.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> study = fl.Study.of(scene, fl.Coulomb(mu=0.4), sweep={"scene.belt_speed": [30, 40, 60]})
        >>> fl.run(study).onsets[["onset", "belt_speed"]].round(2).values.tolist()
        [['stick_begins', 43.9], ['reversal_ends', 50.0], ['stick_ends', 50.0]]
        """
        return self.onsets_made()

    @cached_property
    def boundaries(self) -> pd.DataFrame:
        """Table with a row for each place on the lines that ``boundaries`` of the study asks for.

        Lines are computed when first used. Each of the two swept numbers has an error: how far the line may be
        from the place. Curves between those of the grid are solved for them.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(amplitude=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> loads, speeds = {"start": 5, "stop": 15, "num": 2}, {"start": 1, "stop": 60, "num": 60}
        >>> frequencies = {"start": 0.99, "stop": 1, "num": 2}
        >>> sweep = {"scene.normal_load": loads, "scene.drive.frequency": frequencies, "scene.belt_speed": speeds}
        >>> done = fl.run(fl.Study.of(scene, fl.Coulomb(mu=0.4), sweep=sweep, boundaries={"shape_area": 0}))
        >>> done.boundaries["scene.normal_load"].iloc[[0, -1]].round(2).tolist()
        [8.36, 8.28]
        """
        return self.boundaries_made()

    @property
    def to_show(self) -> pd.DataFrame:
        """Rows that figures and pages show, all of the table or some of a long one.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": 1}}
        >>> done = fl.run({"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}]})
        >>> len(done.to_show)
        1
        """
        return self.table if self.shown is None else self.shown

    @property
    def table_file(self) -> Path | None:
        """Path of the table; None if it was not written.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": 1}}
        >>> done = fl.run({"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}]})
        >>> print(done.table_file)
        None
        """
        return self.folder / "results.parquet" if self.folder is not None else None

    @property
    def counts(self) -> dict[str, int]:
        """Number of rows of each status.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": 1}}
        >>> done = fl.run({"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}]})
        >>> done.counts
        {'ok': 1}
        """
        return status_counts(self.table) if self.found is None else dict(self.found)

    @property
    def size(self) -> int:
        """Number of rows.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": 1}}
        >>> done = fl.run({"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}]})
        >>> done.size
        1
        """
        return sum(self.counts.values())
