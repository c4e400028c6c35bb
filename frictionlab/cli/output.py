"""What a command prints, and how it ends: results on stdout, everything else on stderr, an exit code."""

from __future__ import annotations

import io
import json
import os
import sys
from contextlib import suppress
from typing import Any

import click

from frictionlab.printable import printable

OK, BUG, WRONG, FAILED, BROKEN_PLUGIN, INTERRUPTED = 0, 1, 2, 3, 4, 130


class CommandError(Exception):
    """A command that ends here, with an exit code and a message."""

    def __init__(self, code: int, message: str) -> None:
        super().__init__(message)
        self.code = code


def open_streams() -> None:
    """Streams that take every text: one that the caller closed (Python: None) is replaced by one that nobody reads.

    A character that a terminal cannot show is written with a backslash.
    """
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, io.StringIO())
        elif isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def print_result(text: str) -> None:
    """A result, on stdout; a reader that closed the pipe is no error."""
    try:
        click.echo(printable(text))
        sys.stdout.flush()
    except BrokenPipeError:
        discard_stdout()


def print_records(records: list[dict[str, Any]]) -> None:
    """One record a line, null for an empty cell."""
    lines = ",\n".join(json.dumps(record, allow_nan=False) for record in records)
    print_result(f"[\n{lines}\n]")


def print_message(message: str) -> None:
    """A message, on stderr; a closed stderr is no error."""
    with suppress(OSError):
        click.echo(printable(message), err=True)


def flush_stdout(code: int) -> int:
    """Flush stdout while its errors can still be reported; the exit code."""
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        discard_stdout()
    except OSError as problem:
        print_message(f"cannot write the output: {problem.strerror}")
        discard_stdout()
        return code or FAILED
    return code


def discard_stdout() -> None:
    """Send what is still written to stdout nowhere: the interpreter flushes it once more at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
