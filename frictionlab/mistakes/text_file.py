"""Reading of a file of text: a study, a law."""

from __future__ import annotations

from pathlib import Path


class Unreadable(Exception):
    """A file that cannot be read as text; the message says why."""


def text_of(path: Path) -> str:
    """The text of a file. Raises Unreadable."""
    try:
        return path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise Unreadable("no such file") from None
    except IsADirectoryError:
        raise Unreadable("is a folder") from None
    except UnicodeDecodeError as problem:
        raise Unreadable(f"is not UTF-8 text (byte {problem.start + 1}); save it as UTF-8") from None
    except (OSError, ValueError) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else str(problem)
        raise Unreadable(f"cannot be read: {reason}") from None
