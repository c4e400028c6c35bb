"""``plot``: another name of ``report --figures``."""

from __future__ import annotations

from pathlib import Path

import click

from frictionlab.cli import options
from frictionlab.cli.report import drawn_anew


@click.command("plot")
@click.argument("run", type=options.PATH)
def plot_command(run: Path) -> None:
    """Draw the figures of RUN anew: another name of ``report --figures``."""
    drawn_anew(run, figures=True)
