"""One chunk of points through its method: every point comes back with a status, whatever the method does."""

from __future__ import annotations

from collections.abc import Sized
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from frictionlab.faults import MARK, BrokenPlugin, CannotCompile, failing_law
from frictionlab.methods.base import Answers, refused
from frictionlab.quantities import Floats
from frictionlab.results.derived import derived_columns
from frictionlab.runner.chunks import Chunk

if TYPE_CHECKING:
    from frictionlab.orbit.sample import Samples

from frictionlab.results.part import Part, Piece


def solve(chunk: Chunk) -> list[Part]:
    """Answer every point of a chunk. Raises BrokenPlugin; all else becomes the reason of a failed point."""
    return parts(chunk, answer(chunk))


def parts(chunk: Chunk, pieces: list[Piece]) -> list[Part]:
    """Answered pieces as rows of the table."""
    return [_part(chunk, piece) for piece in pieces]


def answer(chunk: Chunk) -> list[Piece]:
    """The pieces into which refusals and failures divide a chunk. Raises BrokenPlugin."""
    places = list(range(len(chunk.scenes)))
    try:
        reasons = [chunk.method.refusal(scene, chunk.law) for scene in chunk.scenes]
    except BrokenPlugin:
        raise
    except Exception as problem:
        return [Piece(places, _failed(len(places), problem))]
    out = {place: reason for place, reason in enumerate(reasons) if reason is not None}
    pieces = [Piece(list(out), refused(list(out.values())))] if out else []
    return pieces + _solved(chunk, [place for place in places if place not in out])


def _solved(chunk: Chunk, places: list[int]) -> list[Piece]:
    """Solve a piece; on an arithmetic error halve it, so that a point that fails does not affect its neighbours."""
    if not places:
        return []
    scenes = [chunk.scenes[place] for place in places]
    try:
        return [
            Piece(
                places, _believable(chunk.method.solve(scenes, chunk.law, chunk.task.tolerance), len(scenes))
            )
        ]
    except BrokenPlugin:
        raise
    except Exception as problem:
        if _numerical(problem) and len(places) > 1:
            half = len(places) // 2
            return _solved(chunk, places[:half]) + _solved(chunk, places[half:])
        return [Piece(places, _failed(len(places), problem))]


def _numerical(problem: Exception) -> bool:
    """ValueError covers numpy's LinAlgError and the domain errors of the math module."""
    return isinstance(problem, ArithmeticError | ValueError)


def _failed(size: int, problem: Exception) -> Answers:
    """Answers of points whose method raised; errors other than arithmetic are defects of a plugin law or of ours."""
    return replace(refused([_reason(problem)] * size), status=["failed"] * size)


def _reason(problem: Exception) -> str:
    sentence = f"{type(problem).__name__}: {problem}"
    if _numerical(problem):
        return sentence
    law = str(problem) if isinstance(problem, CannotCompile) else failing_law(problem)
    return (
        f"internal error: {sentence}"
        if law is None
        else MARK + "; ".join(line.strip() for line in law.splitlines())
    )


def _believable(answers: Answers, size: int) -> Answers:
    """The answers, every ``ok`` without a number made ``failed``. Raises TypeError for a wrong count."""
    lists: list[Sized] = [answers.status, answers.reason, answers.model, answers.error_kind]
    counts = {len(part) for part in [*lists, *answers.columns.values()]}
    if counts != {size}:
        raise TypeError(f"the method gave {sorted(counts)} answers for {size} points")
    bad = ~(np.isfinite(_column(answers, "mean_friction")) & np.isfinite(_column(answers, "error")))
    bad &= np.array(answers.status) == "ok"
    if not bad.any():
        return answers
    status = ["failed" if wrong else old for wrong, old in zip(bad, answers.status, strict=True)]
    reason = [
        "the method gave no finite mean_friction and error" if wrong else old
        for wrong, old in zip(bad, answers.reason, strict=True)
    ]
    return replace(answers, status=status, reason=reason)


def _column(answers: Answers, name: str) -> Floats:
    return answers.columns.get(name, np.full(len(answers.status), np.nan))


def _part(chunk: Chunk, piece: Piece) -> Part:
    rows = [chunk.rows[place] for place in piece.places]
    try:
        scenes = [chunk.scenes[place] for place in piece.places]
        derived = derived_columns(scenes, chunk.law, _column(piece.answers, "mean_friction"))
        return Part(rows, text_columns(piece.answers), piece.answers.columns | derived, _orbits(chunk, piece))
    except Exception as problem:
        return Part(rows, text_columns(_failed(len(rows), problem)), {}, {})


def text_columns(answers: Answers) -> dict[str, list[str]]:
    """The columns of words, by the names they have in the table."""
    names = "status", "reason", "model", "error_kind"
    return {name: list(getattr(answers, name)) for name in names}


def _orbits(chunk: Chunk, piece: Piece) -> dict[int, Samples]:
    """The orbits a study keeps, by row; empty where it keeps none."""
    if not chunk.task.samples:
        return {}
    from frictionlab.orbit.sample import sample  # imports numba: only where it is needed

    found = {place: piece.answers.orbit(at) for at, place in enumerate(piece.places)}
    return {
        chunk.rows[place]: sample(orbit, chunk.scenes[place], chunk.task.samples)
        for place, orbit in found.items()
        if orbit is not None
    }
