"""The time that Python has spent on a kernel, in this process and in others: a file of that many bytes.

Its length is all that counts: processes append to it at once, and no damage can make it unreadable.
"""

from __future__ import annotations

import contextlib
from pathlib import Path

SPENT = ".spent"
PER_BYTE = 0.01
"""Processor time [s] that a byte stands for."""

_spent: dict[str, float] = {}
"""By kernel [s]: what was written when this process first asked, and what it has spent since."""


class Account:
    """What Python has spent on one kernel for arguments of one kind.

    name: of both. path: of the file; None where none can be kept. compiled: whether there is machine code.
    """

    def __init__(self, name: str, path: Path | None, compiled: bool) -> None:
        self.name, self.path, self.compiled = name, path, compiled
        _spent.setdefault(name, self._written())

    @property
    def spent(self) -> float:
        """Processor time [s]."""
        return _spent[self.name]

    def spend(self, seconds: float) -> None:
        """Add to it."""
        before = _spent[self.name]
        _spent[self.name] = before + seconds
        ticks = int((before + seconds) / PER_BYTE) - int(before / PER_BYTE)
        if ticks and self.path is not None:
            with contextlib.suppress(OSError):
                self.path.parent.mkdir(parents=True, exist_ok=True)
                with self.path.open("ab") as file:
                    file.write(b"." * ticks)

    def _written(self) -> float:
        with contextlib.suppress(OSError):
            return 0.0 if self.path is None else self.path.stat().st_size * PER_BYTE
        return 0.0
