"""``report``: the report of a finished run."""

from __future__ import annotations

from pathlib import Path

import click

from frictionlab.cli import options
from frictionlab.cli.figures import draw_into, figure_data
from frictionlab.cli.output import metered, print_message, print_result


@click.command("report")
@click.argument("run", type=options.PATH)
@click.option("--figures", is_flag=True, help="Draw the figures alone.")
def report_command(run: Path, figures: bool) -> None:
    """Draw the figures and write the report.html of RUN anew, a folder that ``run`` wrote. Nothing is computed.

    Width, formats and all else of the figures are those of ``figures`` in RUN/study.yaml, which may be edited.
    """
    drawn_anew(run, figures)


def drawn_anew(run: Path, figures: bool) -> None:
    """The figures of a run, and its report unless they alone are asked for."""
    from frictionlab.runner.in_use import alone_in
    from frictionlab.runner.saved import read_saved

    with alone_in(run, make=False):
        saved = read_saved(run)
        for line in saved.damaged:
            print_message(line)
        data = figure_data(saved)
        with metered() as meter:
            meter.begins("drawing", "figures")
            files = draw_into(run, data, meter)
        if not figures:
            from frictionlab.report import write_report

            files = [write_report(saved, data)]
    if files:
        print_result("\n".join(map(str, files)))
    else:
        print_message(f"no figures: the study of {run} sweeps nothing")
