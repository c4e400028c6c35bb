"""Output of a command, and its end: results on stdout, everything else on stderr, an exit code."""

from __future__ import annotations

import io
import json
import os
import shutil
import sys
import textwrap
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any, TextIO

import click

from frictionlab.values.printable import printable

if TYPE_CHECKING:
    from frictionlab.runner.progress import Meter

STDOUT, STDERR = 1, 2
"""File descriptors."""
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


_apart: list[TextIO] = []
"""Stream of results while a command runs; empty before and after."""


@contextmanager
def results_apart() -> Iterator[None]:
    """Within, only results reach stdout: what else is printed, by a plugin or by a kernel, goes to stderr."""
    stdout = sys.stdout
    results, number = _copy_of(stdout)
    _apart.append(results)
    sys.stdout = sys.stderr
    try:
        yield
    finally:
        sys.stdout = stdout
        _apart.pop()
        if number is not None:
            os.dup2(results.fileno(), number)
            with suppress(OSError):  # what could not be written has been told
                results.close()


def _copy_of(stdout: TextIO) -> tuple[TextIO, int | None]:
    """A stream of its own to where stdout leads, whose file descriptor, if it has one, then leads to stderr."""
    try:
        number = stdout.fileno()
    except (OSError, ValueError):  # a stream in memory
        return stdout, None
    if number != STDOUT:  # not the program's own
        return stdout, None
    stdout.flush()
    copy = open(os.dup(number), "w", encoding=stdout.encoding, errors=stdout.errors)  # noqa: SIM115
    try:
        os.dup2(STDERR, number)
    except OSError:  # closed by the caller
        os.dup2(os.open(os.devnull, os.O_WRONLY), number)
    return copy, number


def _results() -> TextIO:
    return _apart[-1] if _apart else sys.stdout


_meters: list[Meter] = []
"""Meters that tell progress at this moment; one at most."""


@contextmanager
def metered(whose: str = "") -> Iterator[Meter]:
    """Progress on stderr, its line erased before anything else is printed. whose: words in front of it."""
    from frictionlab.runner.progress import Meter

    with Meter(sys.stderr, whose) as meter:
        _meters.append(meter)
        try:
            yield meter
        finally:
            _meters.remove(meter)


def tell_stopping() -> None:
    """Progress says that an interrupt was heard: what is being solved gets a moment."""
    for meter in _meters:
        meter.begins("stopping")


def _erase_progress() -> None:
    for meter in _meters:
        meter.clear()


def print_result(text: str) -> None:
    """A result, on stdout; a reader that closed the pipe is no error."""
    _erase_progress()
    try:
        click.echo(_wrapped(printable(text)), _results())
        _results().flush()
    except BrokenPipeError:
        discard_stdout()


def _wrapped(text: str) -> str:
    """Return the text with its lines broken between words where a terminal would break them anywhere."""
    if not _results().isatty():
        return text
    width = shutil.get_terminal_size().columns
    ways: dict[str, Any] = {"replace_whitespace": False, "break_long_words": False, "break_on_hyphens": False}
    lines = (textwrap.fill(line, width, subsequent_indent="    ", **ways) for line in text.split("\n"))
    return "\n".join(lines)


def print_records(records: list[dict[str, Any]]) -> None:
    """One record a line, null for an empty cell."""
    lines = ",\n".join(json.dumps(record, allow_nan=False) for record in records)
    print_result(f"[\n{lines}\n]")


def print_message(message: str) -> None:
    """A message, on stderr; a closed stderr is no error."""
    _erase_progress()
    with suppress(OSError, ValueError):
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
    os.dup2(os.open(os.devnull, os.O_WRONLY), _results().fileno())
