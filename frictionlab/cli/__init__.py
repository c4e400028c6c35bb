"""Command line. Nothing heavy is imported before a command needs it: ``--help`` answers at once."""

from __future__ import annotations

import errno
import gc
import io
import os
import threading
import time
import traceback
from collections.abc import Collection, Sequence
from contextlib import suppress
from difflib import get_close_matches
from functools import cache
from importlib import import_module
from typing import Any

import click

from frictionlab.cli.interrupts import prompt_interrupts
from frictionlab.cli.output import (
    BROKEN_PLUGIN,
    BUG,
    FAILED,
    INTERRUPTED,
    OK,
    WRONG,
    CommandError,
    discard_stdout,
    flush_stdout,
    open_streams,
    print_message,
    results_apart,
)

COMMANDS = (
    *(
        "bench",
        "check",
        "columns",
        "explore",
        "fit",
        "laws",
        "methods",
        "needs",
        "new",
        "plot",
        "report",
        "run",
    ),
    *("schema", "warm"),
)
"""Each is the function ``NAME_command`` of the module of its name."""
OUT_OF_REACH = {errno.EACCES, errno.EPERM, errno.EROFS, errno.ENAMETOOLONG, errno.ELOOP}
"""Errors of a path that somebody gave, not of frictionlab."""
MOMENT = 0.2
"""Seconds in which the threads of an interrupted command may end."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; its exit code. Only our own bugs show a traceback."""
    if arguments is None:  # the process is the command's own: its many modules stay, and hold no garbage
        gc.set_threshold(50_000, 20, 100)
    open_streams()
    earlier = threading.enumerate()
    try:
        with prompt_interrupts():
            code = _invoke(arguments)
    except BaseException as problem:
        code = _report(problem)
    code = flush_stdout(code)
    if code == INTERRUPTED and _works_on(earlier):
        os._exit(code)  # a worker deep in a kernel cannot be stopped, and would be waited for
    if arguments is None:
        gc.freeze()  # nor is garbage looked for among them at the end
    return code


def _works_on(earlier: Collection[threading.Thread]) -> bool:
    """Check whether a thread goes on that is none of these; those about to end get a moment."""
    until = time.monotonic() + MOMENT
    with suppress(KeyboardInterrupt):  # a second one: no more waiting
        while time.monotonic() < until and not set(threading.enumerate()).issubset(earlier):
            time.sleep(0.01)
    return not set(threading.enumerate()).issubset(earlier)


def _invoke(arguments: Sequence[str] | None) -> int:
    result = cli.main(None if arguments is None else list(arguments), "frictionlab", standalone_mode=False)
    return result if isinstance(result, int) else OK


def _report(problem: BaseException) -> int:
    """Print what went wrong, and choose the exit code."""
    if isinstance(problem, click.ClickException):
        told = io.StringIO()
        problem.show(told)
        print_message(told.getvalue().rstrip("\n"))
        return problem.exit_code
    if isinstance(problem.__context__, BrokenPipeError):
        discard_stdout()  # the reader of a help text had enough: click's way to say so
        return OK
    if isinstance(problem, click.Abort | KeyboardInterrupt):
        print_message("interrupted")
        return INTERRUPTED
    code, message = _diagnose(problem)
    print_message(message)
    return code


def _diagnose(problem: BaseException) -> tuple[int, str]:
    """Return the exit code and the message of an error: the study's, the disk's, a plugin's or our own."""
    from frictionlab.laws.faults import BrokenPlugin, failing_law
    from frictionlab.runner.files import FolderError, NoScheduler, SaveError
    from frictionlab.values.notes import StudyError

    if isinstance(problem, CommandError):
        return problem.code, str(problem)
    if isinstance(problem, StudyError | FolderError | NoScheduler):
        return WRONG, str(problem)
    if isinstance(problem, SaveError):
        return FAILED, str(problem)
    if isinstance(problem, BrokenPlugin):
        return BROKEN_PLUGIN, str(problem)
    if isinstance(problem, OSError) and problem.errno in (errno.ENOSPC, errno.EDQUOT):
        return FAILED, f"cannot write the output: {problem.strerror}"
    if isinstance(problem, OSError) and problem.errno in OUT_OF_REACH and problem.filename is not None:
        return WRONG, f"{problem.filename}: {problem.strerror}"
    if law := failing_law(problem):
        return BROKEN_PLUGIN, law
    text = "".join(traceback.format_exception(problem))
    return BUG, f"{text}\nThis is a bug of frictionlab; please report it with the lines above and the study."


class CommandGroup(click.Group):
    """A group that imports the module of a command when the command is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of all commands, sorted."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return the command of a name; None where there is none."""
        if cmd_name not in COMMANDS:
            return None
        return _command(cmd_name)

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        """Return the command that is called; a misspelt one is told with the one that was perhaps meant."""
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError as problem:
            meant = "".join(f" Did you mean '{name}'?" for name in get_close_matches(args[0], COMMANDS, 1))
            raise click.UsageError(f"{problem.message}{meant}", ctx) from None


@cache
def _command(name: str) -> click.Command:
    """Return the command of this name, all of whose output but the result goes to stderr."""
    command: click.Command = getattr(import_module(f"frictionlab.cli.{name}"), f"{name}_command")
    assert command.callback is not None
    command.callback = results_apart()(command.callback)
    return command


@click.group(cls=CommandGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="frictionlab", message="%(prog)s %(version)s")
def cli() -> None:
    """Mean friction of a vibrated body on a moving belt, and how far each number may be off.

    Exit codes: 0 ok; 1 a bug of frictionlab; 2 wrong command or study; 3 some points failed or were killed,
    an expectation failed, or the results could not be written; 4 a plugin is broken; 130 interrupted, the
    same command continues.
    """
