"""Figures and report of a comparison that was written to a folder."""

from __future__ import annotations

from pathlib import Path

from frictionlab.charts.figures import FigureData, draw_figures
from frictionlab.report.page import write_report
from frictionlab.results.run import Run
from frictionlab.runner.api import with_onsets
from frictionlab.runner.saved import saved_as


def draw_and_report(written: Run) -> Path:
    """The folder of a run, with its figures and its report in it. Raises SaveError, OSError."""
    written = with_onsets(written)
    saved = saved_as(written)
    folder = saved.folder / "figures"
    data = FigureData(saved.table, saved.title, saved.onsets, saved.curves, options=saved.study.figures)
    draw_figures(data, folder)
    write_report(saved)
    return saved.folder
