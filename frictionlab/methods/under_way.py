"""How far a method is with the points it was given, for those who wait, and what it has found for those who go on."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

import numpy as np

from frictionlab.compile.notice import seconds_compiling
from frictionlab.laws.base import FrictionLaw

Each = TypeVar("Each")
WORTH_KEEPING = 0.01
"""Seconds above which a call is kept: a file takes less than a tenth of that."""


class Calls(Protocol):
    """What earlier calls found, by their digests: a tuple that ends with the seconds it took."""

    def found(self, digest: str) -> Any:
        """None where it is not known."""

    def keep(self, digest: str, found: Any) -> None:
        """For a run that goes on with the same points."""


@dataclass(eq=False)
class UnderWay:
    """Points answered since it was begun, the seconds they took, compiling left out, and when the last one was told.

    Of a method that answers all points together there are none. calls: where its long calls are kept, if anywhere.
    """

    begun: float
    told_at: float
    points: float = 0.0
    seconds: float = 0.0
    calls: Calls | None = None


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
    """These, each counted as so much of a point answered when the next one is asked for."""
    now = _under_way.get()
    for each in points:
        yield each
        if now is not None:
            now.points += share
            now.told_at = time.perf_counter()
            now.seconds = now.told_at - seconds_compiling() - now.begun


def once(call: Callable[[], tuple[Each, float]], *told: Any) -> tuple[Each, float]:
    """What a call finds and the seconds it took; taken over where a run that was interrupted has found it.

    told: all that the answer hangs on beside the points under way, their law and method, and what tells it from other
    calls. The answer has to be numbers, texts, arrays and named tuples of them.
    """
    now = _under_way.get()
    if now is None or now.calls is None:
        return call()
    digest = hashlib.sha256(b"\0".join(_told(told))).hexdigest()
    known: tuple[Each, float] | None = now.calls.found(digest)
    if known is not None:
        now.begun -= known[1]  # what they took, not what reading them takes, tells how long others will
        return known
    found = call()
    if found[1] > WORTH_KEEPING:
        now.calls.keep(digest, found)
    return found


def _told(value: Any) -> Iterator[bytes]:
    """To the last bit."""
    if isinstance(value, tuple):
        yield f"{type(value).__name__} of {len(value)}".encode()
        for each in value:
            yield from _told(each)
    elif isinstance(value, np.ndarray):
        yield f"{value.dtype} {value.shape}".encode()
        yield value.tobytes()
    elif isinstance(value, FrictionLaw):
        yield f"{type(value).__qualname__} {value.model_dump_json()}".encode()
    else:
        yield repr(value).encode()
