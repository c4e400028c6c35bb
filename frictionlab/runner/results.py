"""Results of a run, in memory or in a folder: tables that are read, or made, when somebody asks for them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd

from frictionlab.runner.expectations import Verdict
from frictionlab.runner.table import whole
from frictionlab.runner.words import counted
from frictionlab.study.study import Study
from frictionlab.values.columns import ONSETS_GROUP

Reader = Callable[[], pd.DataFrame | None]


@dataclass(frozen=True, repr=False)
class Results:
    """Results of a study: its tables, and the verdicts on what it expects.

    readers: what reads or makes each table, by its name: ``table``, ``curves``, ``onsets``, ``boundaries``,
    ``attractors``, ``orbits``, ``harmonics``, and ``shown`` of a table that is too long for figures and pages.
    computed: points solved by this run itself. seconds: wall time of all runs that worked on it [s]. account: what
    provenance.json says of a run in a folder. damaged: what is wrong with files that a report does without, and the
    command that mends them.
    """

    study: Study
    readers: Mapping[str, Reader]
    counts: dict[str, int]
    verdicts: tuple[Verdict, ...] = ()
    computed: int = 0
    seconds: float = 0.0
    folder: Path | None = None
    account: Mapping[str, Any] = field(default_factory=dict)
    damaged: tuple[str, ...] = ()

    def _read(self, name: str) -> pd.DataFrame | None:
        return self.readers[name]() if name in self.readers else None

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
        found = self._read("table")
        assert found is not None
        return found

    @cached_property
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
        found = self._read("curves")
        return pd.DataFrame() if found is None else found

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
        return self._read("orbits")

    @cached_property
    def harmonics(self) -> pd.DataFrame | None:
        """Harmonics of every kept orbit, a row for each; None if the study keeps none.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": 1}}
        >>> study = {"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}], "keep": {"harmonics": 1}}
        >>> fl.run(study).harmonics["harmonic"].tolist()
        [0, 1]
        """
        return self._read("harmonics")

    @cached_property
    def attractors(self) -> pd.DataFrame | None:
        """States that motions end in, a row for each Poincare point of each, if the study keeps them.

        Else a row for each state of the points that have several; None if no point has.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": 1}}
        >>> done = fl.run({"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}]})
        >>> print(done.attractors)
        None
        """
        return self._read("attractors")

    @cached_property
    def onsets(self) -> pd.DataFrame | None:
        """Table with a row for each onset of a curve, such as the belt speed where stick begins.

        Onsets are computed when first used; those of a loaded folder are read, None without ``onsets.csv``.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> study = fl.Study.of(scene, fl.Coulomb(mu=0.4), sweep={"scene.belt_speed": [30, 40, 60]})
        >>> fl.run(study).onsets[["onset", "belt_speed"]].round(2).values.tolist()
        [['stick_begins', 43.9], ['reversal_ends', 50.0], ['stick_ends', 50.0]]
        """
        return self._read("onsets")

    @cached_property
    def boundaries(self) -> pd.DataFrame | None:
        """Table with a row for each place on the lines that ``boundaries`` of the study asks for.

        Lines are computed when first used; those of a loaded folder are read, None without ``boundaries.csv``. Each
        of the two swept numbers has an error: how far the line may be from the place. Curves between those of the
        grid are solved for them.

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
        return self._read("boundaries")

    @cached_property
    def shown(self) -> pd.DataFrame:
        """Rows that figures and pages show, all of the table or some of a long one, with every result column.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": 1}}
        >>> done = fl.run({"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}]})
        >>> len(done.shown)
        1
        """
        found = self._read("shown")
        return whole(self.table if found is None else found)

    @property
    def shown_onsets(self) -> pd.DataFrame | None:
        """Onsets that figures and pages show; None if the study does not ask for them.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": 1}}
        >>> done = fl.run({"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}]})
        >>> print(done.shown_onsets)
        None
        """
        return self.onsets if self.study.asks_for(ONSETS_GROUP) else None

    @property
    def is_thinned(self) -> bool:
        """True if figures and pages show some of the rows alone.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": 1}}
        >>> fl.run({"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}]}).is_thinned
        False
        """
        return "shown" in self.readers

    def orbits_of(self, rows: Sequence[int]) -> pd.DataFrame | None:
        """Return the kept orbits of some rows; None where none are kept, or figures show some of the rows alone.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": 1}}
        >>> study = {"schema": 1, "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}], "keep": {"orbit": 4}}
        >>> len(fl.run(study).orbits_of([0]))
        4
        """
        if self.is_thinned or (orbits := self.orbits) is None:
            return None
        return orbits[orbits["row"].isin(rows)]

    @property
    def title(self) -> str:
        """Title of the study, else the name of its file, else of the folder.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": 1}}
        >>> fl.run({"schema": 1, "title": "One", "scene": scene, "laws": [{"kind": "coulomb", "mu": 0.4}]}).title
        'One'
        """
        file = Path(str(self.account.get("study") or "")).stem
        return self.study.title or file or ("" if self.folder is None else self.folder.absolute().name)

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

    def __repr__(self) -> str:
        """Tell how many points there are of each status, and where the table is."""
        told = ", ".join(f"{count} {status}" for status, count in self.counts.items())
        where = f"; table in {self.table_file}" if self.table_file else ""
        return f"{type(self).__name__}({counted(self.size, 'point')}: {told}{where})"


def folder_of(done: Results) -> Path:
    """Return the folder of a run that was written."""
    assert done.folder is not None
    return done.folder
