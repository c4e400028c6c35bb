"""The figures of a run, drawn by ``run``, ``plot`` and ``report``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from frictionlab.charts.figures import FigureData
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


def figure_data(saved: Saved) -> FigureData:
    """What the figures of a saved run are drawn of; of a long table, whose rows are not all there, no orbits."""
    from frictionlab.charts.figures import FigureData, Kept

    kept = Kept(saved.orbits_of if saved.rows is None else lambda rows: None, saved.harmonics)
    tables = {name: getattr(saved, name) for name in ("onsets", "curves", "attractors", "boundaries")}
    return FigureData.of(saved.study, saved.table, saved.title, kept=kept, **tables)
