"""Options that several commands share."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from frictionlab.study.registry import Laws


class _Place(click.Path):
    """A path that is given: an empty one, of a shell variable without a value, would be the folder one is in."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the path. Raises BadParameter."""
        if value == "":
            self.fail("the path is empty", param, ctx)
        return super().convert(value, param, ctx)


PATH = _Place(path_type=Path)
"""Type of arguments that are paths."""
overrides = click.option(
    "--set",
    "overrides",
    multiple=True,
    metavar="PATH=VALUE",
    help="Replace a value of the study; may be repeated.",
)
law_files = click.option(
    "--law",
    "law_files",
    multiple=True,
    type=PATH,
    metavar="FILE",
    help="Take the laws of a Python file, too; may be repeated.",
)
no_plugins = click.option(
    "--no-plugins",
    "plugins",
    is_flag=True,
    callback=lambda context, parameter, refused: "refuse" if refused else "run",
    help="Refuse a study that lists plugins: their code would be run.",
)
workers = click.option(
    "-j", "workers", type=click.IntRange(min=1), metavar="N", help="Threads; all cores if left out."
)
as_json = click.option("--json", "as_json", is_flag=True, help="Print a list of records instead of text.")


def folder(default: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Return the option ``-o``, the folder that a command writes to."""
    help_text = f"Where to; {default} if left out."
    return click.option("-o", "--out", "out", type=PATH, metavar="DIR", help=help_text)


def check_laws(names: Iterable[str], known: Laws) -> None:
    """Raises UsageError for the first name that no law has."""
    for name in names:
        if name not in known.names():
            said, hint = known.unknown(name)
            raise click.UsageError(f"{said}; {hint}" if hint else said)


def make_folder(out: Path) -> None:
    """Make the folder, before anything is computed. Raises FolderError."""
    from frictionlab.runner.files import FolderError

    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        raise FolderError(
            f"cannot make the folder {out}: {problem.strerror}; give another one with -o"
        ) from problem
