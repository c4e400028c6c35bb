"""``plot``: the figures of a finished run."""

from __future__ import annotations

from pathlib import Path

import click

from frictionlab.cli import options
from frictionlab.cli.figures import draw_saved
from frictionlab.cli.output import print_message, print_result


@click.command("plot")
@click.argument("run", type=options.PATH)
def plot_command(run: Path) -> None:
    """Draw the figures of RUN anew, a folder that ``run`` wrote. Nothing is computed.

    Width, formats and all else are those of ``figures`` in RUN/study.yaml, which may be edited.
    """
    from frictionlab.runner.in_use import alone_in
    from frictionlab.runner.saved import read_saved

    with alone_in(run, make=False):
        saved = read_saved(run)
        for line in saved.damaged:
            print_message(line)
        files = draw_saved(saved, run)
    if files:
        print_result("\n".join(map(str, files)))
    else:
        print_message(f"no figures: the study of {run} sweeps nothing")
