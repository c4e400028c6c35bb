"""No search for garbage while numba compiles: its trees outlive every search, which took an eighth of the time."""

from __future__ import annotations

import gc
from typing import Any

import numba.core.event

_event: Any = numba.core.event


class _PausesCollection(_event.Listener):  # type: ignore[misc]  # numba has no types
    """Switches the collector off where the outermost function begins to compile, and on again where it ends.

    One kernel is compiled at a time: numba holds a lock from before the first of these calls to after the last.
    """

    depth = 0
    was_on = False

    def on_start(self, event: Any) -> None:
        """Called for every function, before it is compiled."""
        if self.depth == 0:
            self.was_on = gc.isenabled()
            gc.disable()
        self.depth += 1

    def on_end(self, event: Any) -> None:
        """Called for every function, whether it was compiled or could not be."""
        self.depth -= 1
        if self.depth == 0 and self.was_on:
            gc.enable()


def pause_collection() -> None:
    """From now on."""
    _event.register("numba:compile", _PausesCollection())
