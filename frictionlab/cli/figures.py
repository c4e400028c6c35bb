"""The figures of a run, drawn by ``run``, ``plot`` and ``report``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from frictionlab.cli.output import metered

if TYPE_CHECKING:
    from pandas import DataFrame

    from frictionlab.charts.figures import Kept
    from frictionlab.runner.progress import Meter
    from frictionlab.runner.saved import Saved
    from frictionlab.study.figure_options import FigureOptions


def draw_into(
    table: DataFrame,
    title: str,
    folder: Path,
    onsets: DataFrame | None = None,
    attractors: DataFrame | None = None,
    curves: DataFrame | None = None,
    options: FigureOptions | None = None,
    kept: Kept | None = None,
    meter: Meter | None = None,
) -> list[Path]:
    """Draw the figures of a run into its folder, onsets marked; the files. Raises SaveError.

    curves: of ``curves.csv``, with the shapes.
    """
    from frictionlab.charts.bifurcation import draw_bifurcations
    from frictionlab.charts.figures import draw_figures  # with matplotlib, which takes a second
    from frictionlab.runner.errors import SaveError
    from frictionlab.runner.progress import silent
    from frictionlab.study.figure_options import USUAL_FIGURES

    asked, told = options or USUAL_FIGURES, meter or silent
    try:
        files = draw_figures(table, title, folder / "figures", onsets, curves, asked, kept, told)
        more = [] if attractors is None else draw_bifurcations(attractors, title, folder / "figures")
        return files + more
    except OSError as problem:
        raise SaveError(f"cannot write the figures in {folder}: {problem.strerror or problem}") from problem


def draw_saved(saved: Saved, folder: Path) -> list[Path]:
    """Draw the figures of a saved run anew, as its study wants them; the files. Raises SaveError."""
    more = saved.onsets, saved.attractors, saved.curves, saved.study.figures
    with metered() as meter:
        meter.begins("drawing", "figures")
        return draw_into(saved.table, saved.title, folder, *more, kept_of(saved), meter)


def kept_of(saved: Saved) -> Kept:
    """The orbits and harmonics of a saved run; of a long table, whose rows are not all there, no orbits."""
    from frictionlab.charts.figures import Kept

    return Kept(saved.orbits_of if saved.rows is None else lambda rows: None, saved.harmonics)
