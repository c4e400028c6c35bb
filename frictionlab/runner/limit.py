"""Chunks under a limit of time: points that take longer alone are killed, and keep no other point from its answer."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from frictionlab.compile.notice import seconds_compiling
from frictionlab.methods.base import refused
from frictionlab.methods.under_way import UnderWay, told_to
from frictionlab.results.part import Part
from frictionlab.runner.chunks import Chunk
from frictionlab.runner.solve import solve, text_columns
from frictionlab.runner.workers import OverLimit, within

TOGETHER = 10
"""Points of a chunk for which it is allowed the time of one: most need a small part of theirs."""
under_way: dict[int, UnderWay] = {}
"""By the id of each chunk that this process is solving: how far that is."""


class Solved(NamedTuple):
    """The rows of a chunk, and the seconds they took, compiling left out."""

    parts: list[Part]
    seconds: float


def solve_each(chunks: Sequence[Chunk]) -> list[Solved]:
    """Answer every point of chunks of one task; where they take too long together, of each half of them apart.

    Raises BrokenPlugin.
    """
    if len(chunks) == 1:
        return [solve_within(chunks[0])]
    try:
        return within(sum(map(_seconds, chunks)), _each_timed, chunks)
    except OverLimit:
        half = len(chunks) // 2
        return solve_each(chunks[:half]) + solve_each(chunks[half:])


def _each_timed(chunks: Sequence[Chunk]) -> list[Solved]:
    return [solve_timed(chunk) for chunk in chunks]


def solve_within(chunk: Chunk) -> Solved:
    """Answer every point of a chunk; what takes too long is halved, down to the single points that do.

    Raises BrokenPlugin.
    """
    size = len(chunk.rows)
    try:
        return within(_seconds(chunk), solve_timed, chunk)
    except OverLimit:
        if size == 1:
            return Solved([_killed(chunk)], chunk.task.seconds_per_point)
    halves = [solve_within(chunk.of(where)) for where in (slice(size // 2), slice(size // 2, None))]
    return Solved([part for half in halves for part in half.parts], sum(half.seconds for half in halves))


def _seconds(chunk: Chunk) -> float:
    """The time that it may take."""
    return chunk.task.seconds_per_point * max(1.0, len(chunk.rows) / TOGETHER)


def solve_timed(chunk: Chunk) -> Solved:
    """Answer every point of a chunk on this thread. Raises BrokenPlugin."""
    begun = time.perf_counter()
    now = under_way[id(chunk)] = UnderWay(begun - seconds_compiling(), begun, calls=chunk.calls)
    try:
        with told_to(now):
            parts = solve(chunk)
    finally:
        under_way.pop(id(chunk), None)
    return Solved(parts, time.perf_counter() - seconds_compiling() - now.begun)


def _killed(chunk: Chunk) -> Part:
    seconds = chunk.task.seconds_per_point
    reason = f"over the limit of {seconds:g} s (limit: {{seconds_per_point: {seconds:g}}} in the study)"
    answers = replace(refused([reason]), status=["killed"])
    return Part(chunk.rows, text_columns(answers), {}, {})
