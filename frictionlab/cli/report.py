"""``report``: the report of a finished run."""

from __future__ import annotations

from pathlib import Path

import click

from frictionlab.cli import options
from frictionlab.cli.figures import draw_saved
from frictionlab.cli.output import print_message, print_result


@click.command("report")
@click.argument("run", type=options.PATH)
def report_command(run: Path) -> None:
    """Write the figures and the report.html of RUN anew, a folder that ``run`` wrote. Nothing is computed."""
    from frictionlab.report import write_report
    from frictionlab.runner.in_use import alone_in
    from frictionlab.runner.saved import read_saved

    with alone_in(run, make=False):
        saved = read_saved(run)
        for line in saved.damaged:
            print_message(line)
        draw_saved(saved, run)
        page = write_report(saved)
    print_result(str(page))
