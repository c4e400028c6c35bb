"""``methods``: the installed methods."""

from __future__ import annotations

import click

from frictionlab.cli import options
from frictionlab.cli.output import print_records, print_result


@click.command("methods")
@options.as_json
def methods_command(as_json: bool) -> None:
    """List the installed methods and what they refuse."""
    from frictionlab.study import registry
    from frictionlab.study.records import method_record, one_line_each

    records = [method_record(each) for each in registry.method_names()]
    print_records(records) if as_json else print_result(one_line_each(records))
