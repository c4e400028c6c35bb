"""Chunks under a limit of time: points that take longer alone are killed, and keep no other point from its answer."""

from __future__ import annotations

from dataclasses import replace

from frictionlab.methods.base import refused
from frictionlab.results.part import Part
from frictionlab.runner.chunks import Chunk
from frictionlab.runner.solve import solve, text_columns
from frictionlab.runner.workers import OverLimit, within

TOGETHER = 10
"""Points of a chunk for which it is allowed the time of one: most need a small part of theirs."""


def solve_within(chunk: Chunk) -> list[Part]:
    """Answer every point of a chunk; what takes too long is halved, down to the single points that do.

    Raises BrokenPlugin.
    """
    seconds, size = chunk.task.seconds_per_point, len(chunk.rows)
    try:
        return within(seconds * max(1.0, size / TOGETHER), solve, chunk)
    except OverLimit:
        if size == 1:
            return [_killed(chunk)]
    half = size // 2
    return [part for where in (slice(half), slice(half, None)) for part in solve_within(chunk.of(where))]


def _killed(chunk: Chunk) -> Part:
    seconds = chunk.task.seconds_per_point
    reason = f"over the limit of {seconds:g} s (limit: {{seconds_per_point: {seconds:g}}} in the study)"
    answers = replace(refused([reason]), status=["killed"])
    return Part(chunk.rows, text_columns(answers), {}, {})
