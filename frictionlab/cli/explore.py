"""``explore``: a page with sliders, an exact solver in it, and the table of a run."""

from __future__ import annotations

from pathlib import Path

import click

from frictionlab.cli import options
from frictionlab.cli.output import print_message, print_result


@click.command("explore")
@click.argument("run", type=options.PATH, required=False)
@click.option(
    *("-o", "--out", "file"),
    type=options.PATH,
    default=Path("explorer.html"),
    show_default=True,
    help="The page to write.",
)
def explore_command(run: Path | None, file: Path) -> None:
    """Write a page that solves Coulomb friction in the browser as you move sliders, offline.

    RUN, a folder that ``run`` wrote, puts its table on the page, too: sliders over what it swept, every law.
    """
    from frictionlab.report.explorer import write_explorer
    from frictionlab.runner.saved import read_run

    saved = None if run is None else read_run(run)
    for line in () if saved is None else saved.damaged:
        print_message(line)
    print_result(str(write_explorer(file, saved)))
