"""``warm``: kernels compiled before they are needed."""

from __future__ import annotations

from pathlib import Path

import click

from frictionlab.cli import options
from frictionlab.cli.output import print_result


@click.command("warm")
@click.argument("names", nargs=-1, metavar="[LAW...]")
@options.law_files
def warm_command(names: tuple[str, ...], law_files: tuple[Path, ...]) -> None:
    """Compile the kernels of the laws named, or of all, and keep them for the runs to come.

    Without it a run lets Python do the work of kernels that are not there, as long as that takes less time than
    compiling them. It compiles for method auto; of other methods a run compiles what it needs.
    """
    from frictionlab.runner.warm import warm
    from frictionlab.study.law_files import laws_of_files

    known = laws_of_files(law_files)
    options.check_laws(names, known)
    for done in warm({name: known.named(name) for name in names or known.usable()}):
        told = f"{done.kernels} compiled in {done.seconds:.0f} s" if done.kernels else "all kept already"
        print_result(f"{done.law}, {done.scene}: {told}")
