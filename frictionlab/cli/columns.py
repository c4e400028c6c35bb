"""``columns``: the result columns and their groups."""

from __future__ import annotations

import textwrap
from typing import Any

import click

from frictionlab.cli import options
from frictionlab.cli.output import print_records, print_result

WIDEST_LINE = 110


@click.command("columns")
@options.as_json
def columns_command(as_json: bool) -> None:
    """List the result columns by the groups that a study's columns, or --columns, may name."""
    from frictionlab.values.columns import COLUMNS, DEFAULT

    if as_json:
        print_records(
            [
                {
                    "column": each.name,
                    "group": each.group,
                    "default": each.name in DEFAULT,
                    "meaning": each.meaning,
                }
                for each in COLUMNS
            ]
        )
    else:
        print_result("\n".join(_lines()))


def _lines() -> list[str]:
    """A heading a group, a line a column; * before the default ones."""
    from frictionlab.methods.words import ModelWord
    from frictionlab.values.columns import ALWAYS, COLUMNS, DEFAULT, GROUPS, columns_of

    lines = [
        "* found where no columns are asked for, and left out where no row has them",
        "",
        "in every table",
    ]
    lines += [_line(each, DEFAULT) for each in COLUMNS if each.name in ALWAYS]
    for group, meaning in GROUPS.items():
        own = [each for each in COLUMNS if each.group == group]
        lines += ["", f"{group}: {meaning}", *(_line(each, DEFAULT) for each in own)]
        if not own and len(names := columns_of(group)) < len(COLUMNS):
            lines += textwrap.wrap(
                f"with {', '.join(names)}", WIDEST_LINE, initial_indent="    ", subsequent_indent="    "
            )
    lines += ["", "words of the column model"]
    return lines + [_line_of_word(each) for each in ModelWord]


def _line_of_word(each: Any) -> str:
    indent = " " * 30
    return textwrap.fill(
        each.sentence, WIDEST_LINE, initial_indent=f"    {each:<26}", subsequent_indent=indent
    )


def _line(each: Any, default: tuple[str, ...]) -> str:
    mark = "*" if each.name in default else " "
    return f"  {mark} {each.name:<30}{each.meaning}"
