"""The figures of a run, drawn by ``run``, ``plot`` and ``report``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pandas import DataFrame


def draw_into(
    table: DataFrame,
    title: str,
    folder: Path,
    onsets: DataFrame | None = None,
    attractors: DataFrame | None = None,
) -> list[Path]:
    """Draw the figures of a run into its folder, onsets marked; the files. Raises SaveError."""
    from frictionlab.charts.bifurcation import draw_bifurcations
    from frictionlab.charts.figures import draw_figures  # with matplotlib, which takes a second
    from frictionlab.runner.errors import SaveError

    try:
        files = draw_figures(table, title, folder / "figures", onsets)
        more = [] if attractors is None else draw_bifurcations(attractors, title, folder / "figures")
        return files + more
    except OSError as problem:
        raise SaveError(f"cannot write the figures in {folder}: {problem.strerror or problem}") from problem
