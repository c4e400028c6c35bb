"""The figures of a run, drawn by ``run``, ``plot`` and ``report``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from frictionlab.cli.output import metered

if TYPE_CHECKING:
    from frictionlab.charts.figures import FigureData, Kept
    from frictionlab.runner.progress import Meter
    from frictionlab.runner.saved import Saved


def draw_into(folder: Path, data: FigureData, meter: Meter) -> list[Path]:
    """Draw the figures of a run into its folder, onsets marked; the files. Raises SaveError."""
    from frictionlab.charts.figures import draw_figures  # with matplotlib, which takes a second
    from frictionlab.runner.errors import SaveError

    try:
        return draw_figures(data, folder / "figures", meter)
    except OSError as problem:
        raise SaveError(f"cannot write the figures in {folder}: {problem.strerror or problem}") from problem


def draw_saved(saved: Saved, folder: Path) -> list[Path]:
    """Draw the figures of a saved run anew, as its study wants them; the files. Raises SaveError."""
    from frictionlab.charts.figures import FigureData

    more = saved.onsets, saved.curves, saved.attractors, kept_of(saved), saved.study.figures
    with metered() as meter:
        meter.begins("drawing", "figures")
        return draw_into(folder, FigureData(saved.table, saved.title, *more), meter)


def kept_of(saved: Saved) -> Kept:
    """The orbits and harmonics of a saved run; of a long table, whose rows are not all there, no orbits."""
    from frictionlab.charts.figures import Kept

    return Kept(saved.orbits_of if saved.rows is None else lambda rows: None, saved.harmonics)
