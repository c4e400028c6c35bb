"""``new``: a study, a list of a bench or a law to begin from."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Literal

import click

from frictionlab.cli import options
from frictionlab.cli.output import print_message, print_result


@click.group("new")
def new_command() -> None:
    """Write a file to begin from."""


@new_command.command("study")
@click.argument("path", type=options.PATH)
@click.option("--si", "template", flag_value="study_si.yaml", help="A scene in units such as mm/s, Hz and N.")
def study(path: Path, template: str | None) -> None:
    """Write a commented study to the file PATH, which ``run`` takes as it is. Never replaces a file.

    Beside it frictionlab.schema.json is written: by it editors complete and check the study as you type.
    """
    from frictionlab.cli.scaffold import SCHEMA_FILE, TEMPLATE, new_study, put_schema_beside
    from frictionlab.study.schema import schema_text

    file = new_study(path, TEMPLATE.with_name(template or TEMPLATE.name))
    print_result(str(file))
    if put_schema_beside(file, f"{schema_text()}\n") is None:
        print_message(
            f"{file.with_name(SCHEMA_FILE)} is that of other laws or another version and stays; "
            f"'frictionlab schema' prints the one for editors"
        )
    print_message(f"change what it says, then: frictionlab run {shlex.quote(str(file))}")


@new_command.command("bench")
@click.argument("path", type=options.PATH)
def bench(path: Path) -> None:
    """Write a commented list of what to measure to the file PATH, which ``bench`` takes. Never replaces a file."""
    from frictionlab.cli.scaffold import TEMPLATE, new_study

    file = new_study(path, TEMPLATE.with_name("bench.yaml"))
    print_result(str(file))
    print_message(f"change what it says, then: frictionlab bench {shlex.quote(str(file))}")


@new_command.command("law")
@click.argument("path", metavar="NAME", type=options.PATH)
@click.option(
    "--memory",
    type=click.Choice(["none", "bristle"]),
    default="bristle",
    show_default=True,
    help="What friction remembers: none, set by slip alone; bristle, a deflection of the contact.",
)
def law(path: Path, memory: Literal["none", "bristle"]) -> None:
    """Write the folder NAME: a law that installs, with its test and a study. Never replaces anything."""
    from frictionlab.cli.scaffold import BadName, new_law

    try:
        folder = new_law(path, memory)
    except BadName as problem:
        raise click.UsageError(str(problem)) from None
    module = folder / f"{path.name.replace('-', '_')}.py"
    print_result(str(folder))
    print_message(
        f"the law is in {module}; try it: "
        f"frictionlab run {shlex.quote(str(folder / 'study.yaml'))} --law {shlex.quote(str(module))}"
    )
