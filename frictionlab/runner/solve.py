"""One chunk of points through its method: every point comes back with a status, whatever the method does."""

from __future__ import annotations

import math
import time
from collections.abc import Collection, Sequence, Sized
from dataclasses import replace

import numpy as np

from frictionlab.compile.notice import seconds_compiling
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.faults import (
    INTERNAL,
    MARK,
    BrokenPlugin,
    CannotCompile,
    failing_law,
    lost_error,
    text_of_error,
)
from frictionlab.methods.base import NOT_UNIQUE, Answers, in_own_lengths, refused
from frictionlab.runner.free_body import solved_on_springs
from frictionlab.runner.part import (
    Answered,
    KeptRows,
    Part,
    columns_of_states,
    derived_columns,
    one_part,
)
from frictionlab.runner.pieces import Chunk
from frictionlab.scene.scene import Scene
from frictionlab.theory.linear import velocity_scale
from frictionlab.values.columns import DERIVED, FROM_ORBITS, RESULTS, TEXT
from frictionlab.values.quantities import Floats


def solve(chunk: Chunk) -> Part:
    """Answer every point of a chunk. Raises BrokenPlugin; all else becomes the reason of a failed point."""
    if chunk.scenes.scene.is_free:
        return solved_on_springs(chunk, solve)
    return columns_answered(chunk, answer(chunk))


def columns_answered(chunk: Chunk, answered: Sequence[Answered]) -> Part:
    """Return what was answered, all points of a chunk, as columns."""
    return one_part([part for each in answered for part in _parts(chunk, each)], len(chunk))


def answer(chunk: Chunk) -> list[Answered]:
    """Return the pieces into which refusals and failures divide a chunk. Raises BrokenPlugin."""
    places = list(range(len(chunk.scenes)))
    try:
        reasons = _negative(chunk) or chunk.method.refusals(chunk.scenes, chunk.law)
    except BrokenPlugin:
        raise
    except (Exception, SystemExit) as problem:
        return [Answered(places, _failed(len(places), problem))]
    out = {place: reason for place, reason in enumerate(reasons) if reason is not None}
    pieces = [Answered(list(out), refused(list(out.values())))] if out else []
    return pieces + _solved(chunk, [place for place in places if place not in out])


def _negative(chunk: Chunk) -> list[str | None]:
    """Return why points are refused whose law has negative sliding friction there; nothing if none is."""
    scale = velocity_scale(chunk.scenes.scene)
    quickest = np.abs(chunk.scenes.belt_speeds) + (scale if scale < math.inf else 0.0)
    speeds = [(speed, chunk.law.sliding_friction(speed)) for speed in quickest.tolist()]
    if not any(friction < 0.0 for _, friction in speeds):
        return []
    what = (
        "sliding_friction of the law is {:.3g} at slip speed {:.3g}: a coefficient of friction is at least 0"
    )
    return [what.format(friction, speed) if friction < 0.0 else None for speed, friction in speeds]


def _solved(chunk: Chunk, places: list[int]) -> list[Answered]:
    """Solve a piece; on an arithmetic error halve it, so that a point that fails does not affect its neighbours."""
    if not places:
        return []
    scenes = chunk.scenes.taken(places)
    try:
        answers = in_own_lengths(chunk.method.solve, scenes, chunk.law, chunk.task.tolerance)
        return [Answered(places, _believable(answers, chunk.law, len(scenes)))]
    except BrokenPlugin:
        raise
    except (Exception, SystemExit) as problem:
        if _numerical(problem) and len(places) > 1:
            return _solved_in_halves(chunk, places)
        return [Answered(places, _failed(len(places), problem))]


def _solved_in_halves(chunk: Chunk, places: list[int]) -> list[Answered]:
    half = len(places) // 2
    return _solved(chunk, places[:half]) + _solved(chunk, places[half:])


def _numerical(problem: BaseException) -> bool:
    """ValueError covers numpy's LinAlgError and the domain errors of the math module."""
    return isinstance(problem, ArithmeticError | ValueError)


def _failed(size: int, problem: BaseException) -> Answers:
    """Answers of points whose method raised; errors other than arithmetic are defects of a plugin law or of ours."""
    return replace(refused([_reason(problem)] * size), status=["failed"] * size)


def _reason(problem: BaseException) -> str:
    sentence = text_of_error(problem)
    if _numerical(problem):
        return sentence
    law = str(problem) if isinstance(problem, CannotCompile) else failing_law(problem)
    return f"{INTERNAL}{sentence}" if law is None else _broken(law)


def _broken(law: str) -> str:
    """Return the reason of a point that failed in a law of another package."""
    return MARK + "; ".join(line.strip() for line in law.splitlines())


def _believable(answers: Answers, law: FrictionLaw, size: int) -> Answers:
    """Return the answers, every ``ok`` without a number made ``failed``. Raises TypeError for a wrong count."""
    lists: list[Sized | None] = [answers.status, answers.reason, answers.model, answers.error_kind]
    lists += [answers.mean, answers.error, answers.unique, *(getattr(answers, name) for name in OWN)]
    counts = {len(part) for part in lists if part is not None}
    if counts != {size}:
        raise TypeError(f"the method gave {sorted(counts)} answers for {size} points")
    bad = ~(np.isfinite(answers.mean.real) & np.isfinite(answers.error))
    bad &= np.array(answers.status) == "ok"
    if not bad.any():
        return answers
    status = ["failed" if wrong else old for wrong, old in zip(bad, answers.status, strict=True)]
    lost = lost_error(law)
    why = "the method gave no finite mean_friction and error" if lost is None else _broken(lost)
    reason = [why if wrong else old for wrong, old in zip(bad, answers.reason, strict=True)]
    return replace(answers, status=status, reason=reason)


FROM_METHODS = tuple(name for name in RESULTS if name not in TEXT and name not in DERIVED)
"""Columns of numbers that hang on what a method found."""
OWN = "period", "mean_low", "mean_high", "window", "seconds"
"""Columns that answers hold as arrays, or leave out."""


def number_columns(answers: Answers, scenes: Sequence[Scene], wanted: Collection[str]) -> dict[str, Floats]:
    """Return those of these columns that a method's answers give: the one place where answers are read.

    Orbits are made, and multipliers found, where one of the columns needs them.
    """
    nothing, start = np.full(len(scenes), np.nan), time.perf_counter() - seconds_compiling()
    found = {"mean_friction": answers.mean.real, "error": answers.error}
    if scenes[0].planar:
        found["mean_friction_transverse"] = np.where(np.isnan(answers.mean.real), np.nan, answers.mean.imag)
    found |= {name: _given(getattr(answers, name), nothing) for name in OWN}
    if "floquet" in wanted or "floquet_error" in wanted:
        found |= _multipliers(answers)
    if any(name in wanted for name in FROM_ORBITS):
        from frictionlab.motion.orbit.energy_errors import Means
        from frictionlab.motion.orbit.read import read_columns  # brings numba: only where it is needed

        asks_errors = any(name.endswith("_error") for name in wanted)
        means = Means(answers.mean.real, answers.error, answers.balanced) if asks_errors else None
        found |= read_columns(scenes, answers.orbit, answers.orbits, means, answers.ends)
    spent = time.perf_counter() - seconds_compiling() - start
    found["seconds"] = found["seconds"] + spent / len(scenes)
    return {name: found.get(name, nothing) for name in wanted}


def _multipliers(answers: Answers) -> dict[str, Floats]:
    if answers.multipliers is not None:
        known = answers.multipliers()
        return {"floquet": known.modulus, "floquet_error": known.error}
    return {} if answers.floquet is None else {"floquet": answers.floquet()}


def _given(numbers: Floats | None, nothing: Floats) -> Floats:
    return nothing if numbers is None else numbers


def _parts(chunk: Chunk, piece: Answered) -> list[tuple[list[int], Part]]:
    """A piece in one; where a column of it raises an arithmetic error, its halves, solved anew."""
    size = len(piece.places)
    try:
        scenes = chunk.scenes.taken(piece.places)
        asked = chunk.task.columns
        numbers = number_columns(piece.answers, scenes, [name for name in FROM_METHODS if name in asked])
        if any(name in asked for name in DERIVED):
            derived = derived_columns(scenes, chunk.law, numbers["mean_friction"])
            numbers |= {name: column for name, column in derived.items() if name in asked}
        text = text_columns(piece.answers)
        if "floquet" in asked and piece.answers.multipliers is not None:
            text["reason"] = _noted(text["reason"], piece.answers.multipliers().reason)
        return [(piece.places, Part(text, numbers, _kept(chunk, piece)))]
    except BrokenPlugin:
        raise
    except (Exception, SystemExit) as problem:
        if _numerical(problem) and size > 1:
            halves = _solved_in_halves(chunk, piece.places)
            return [part for each in halves for part in _parts(chunk, each)]
        return [(piece.places, Part(text_columns(_failed(size, problem)), {}, {}))]


def text_columns(answers: Answers) -> dict[str, list[str]]:
    """Return the columns of words, by the names they have in the table."""
    names = "status", "reason", "model", "error_kind"
    return {name: list(getattr(answers, name)) for name in names} | {"unique": _unique(answers)}


def _unique(answers: Answers) -> list[str]:
    """Tell whether the state is the only one: what its method says of an ok answer, no of an open one."""
    told = answers.unique or [""] * len(answers.status)
    said = {"not_unique": NOT_UNIQUE}
    return [
        each if status == "ok" else said.get(status, "")
        for status, each in zip(answers.status, told, strict=True)
    ]


def _noted(reasons: list[str], notes: list[str]) -> list[str]:
    """Return the reasons, with why a number beside them is empty."""
    return ["; ".join(filter(None, both)) for both in zip(reasons, notes, strict=True)]


def _kept(chunk: Chunk, piece: Answered) -> dict[str, KeptRows]:
    """Return the tables beside the results: the states of points that have several, and the orbits that are kept."""
    task, answers, kept = chunk.task, piece.answers, dict[str, KeptRows]()
    for at, status in enumerate(answers.status):
        if status == "not_unique" and (states := answers.states(at)):
            kept.setdefault("states", {})[at] = columns_of_states(states)
    if not (task.samples or task.harmonics):
        return kept
    # these import numba: only where it is needed
    from frictionlab.motion.orbit.sample import harmonic_columns, sample

    found = [(at, chunk.scenes[place], answers.orbit(at)) for at, place in enumerate(piece.places)]
    there = [(at, scene, one) for at, scene, one in found if one]
    if task.samples:
        kept["orbits"] = {
            at: sample(one, scene, chunk.law, task.samples).columns() for at, scene, one in there
        }
    if task.harmonics:
        kept["harmonics"] = {at: harmonic_columns(scene, one, task.harmonics) for at, scene, one in there}
    return kept
