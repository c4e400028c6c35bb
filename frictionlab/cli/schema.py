"""``schema``: the JSON Schema of a study file."""

from __future__ import annotations

from pathlib import Path

import click

from frictionlab.cli import options
from frictionlab.cli.output import print_result


@click.command("schema")
@options.law_files
def schema_command(law_files: tuple[Path, ...]) -> None:
    """Print the JSON Schema of a study file, by which editors complete and check it as you type."""
    from frictionlab.study.law_files import laws_of_files
    from frictionlab.study.schema import schema_text

    print_result(schema_text(laws_of_files(law_files)))
