"""Tell how far a method is with the points it was given, for those who wait."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import TypeVar

from frictionlab.compile.notice import seconds_compiling

Each = TypeVar("Each")


@dataclass(eq=False)
class UnderWay:
    """Points answered since it was begun, the seconds they took, compiling left out, and when the last one was told.

    Of a method that answers all points together there are none.
    """

    begun: float
    told_at: float
    points: float = 0.0
    seconds: float = 0.0


_under_way: ContextVar[UnderWay | None] = ContextVar("under way", default=None)


@contextmanager
def told_to(under_way: UnderWay) -> Iterator[None]:
    """Meanwhile, in this context, points answered are counted there."""
    token = _under_way.set(under_way)
    try:
        yield
    finally:
        _under_way.reset(token)


def each_told(points: Iterable[Each], share: float = 1.0) -> Iterator[Each]:
    """Yield points, each counted as so much of one answered when the next one is asked for."""
    now = _under_way.get()
    for each in points:
        yield each
        if now is not None:
            now.points += share
            now.told_at = time.perf_counter()
            now.seconds = now.told_at - seconds_compiling() - now.begun
