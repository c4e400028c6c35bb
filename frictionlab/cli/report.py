"""``report``: the report of a finished run.

The figures of a run, drawn by ``run``, ``plot`` and ``report``.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from frictionlab.cli import options
from frictionlab.cli.output import metered, print_message, print_result

if TYPE_CHECKING:
    from frictionlab.charts.figures import FigureData
    from frictionlab.runner.progress import Meter


def draw_into(folder: Path, data: FigureData, meter: Meter) -> list[Path]:
    """Draw the figures of a run into its folder, onsets marked; the files. Raises SaveError."""
    from frictionlab.charts.figures import draw_figures  # with matplotlib, which takes a second
    from frictionlab.runner.files import SaveError

    try:
        return draw_figures(data, folder / "figures", meter)
    except OSError as problem:
        raise SaveError(f"cannot write the figures in {folder}: {problem.strerror or problem}") from problem


@click.command("report")
@click.argument("run", type=options.PATH)
@click.option("--figures", is_flag=True, help="Draw the figures alone.")
def report_command(run: Path, figures: bool) -> None:
    """Draw the figures and write the report.html of RUN anew, a folder that ``run`` wrote. Nothing is computed.

    Width, formats and all else of the figures are those of ``figures`` in RUN/study.yaml, which may be edited.
    """
    drawn_anew(run, figures)


def drawn_anew(run: Path, figures: bool) -> None:
    """Write the figures of a run, and its report unless they alone are asked for."""
    from frictionlab.report.run import figure_data
    from frictionlab.runner.files import alone_in
    from frictionlab.runner.saved import read_run

    with alone_in(run, make=False):
        saved = read_run(run)
        for line in saved.damaged:
            print_message(line)
        data = figure_data(saved)
        with metered() as meter:
            meter.begins("drawing", "figures")
            files = draw_into(run, data, meter)
        if not figures:
            from frictionlab.report.page import write_report

            files = [write_report(saved, data)]
    if files:
        print_result("\n".join(map(str, files)))
    else:
        print_message(f"no figures: the study of {run} sweeps nothing")
