"""Solving a curve by a method or a peer, failures included; reference values, never those of the method itself."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from frictionlab.bench.peers.base import Peer
from frictionlab.bench.record import ReferenceMeans, ReferenceSource, Workload
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.quantities import Floats
from frictionlab.runner.chunks import Chunk, Task
from frictionlab.runner.solve import FROM_METHODS, answer, number_columns
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes


@dataclass(frozen=True)
class SolverAnswers:
    """Status, reason, mean friction and stated error of each point; NaN where there is none. more: other columns."""

    status: list[str]
    reason: list[str]
    means: Floats
    errors: Floats
    more: dict[str, Floats] = field(default_factory=dict)

    @classmethod
    def without(cls, status: str, reason: str, n: int) -> SolverAnswers:
        """The same answer n times: none."""
        return cls([status] * n, [reason] * n, np.full(n, np.nan), np.full(n, np.nan))


def solve_points(
    solver: Method | Peer,
    scenes: Sequence[Scene],
    law: FrictionLaw,
    tolerance: float,
    more: Sequence[str] = (),
) -> SolverAnswers:
    """The results of a solver, refusals and failures included; more: columns to read from a method's orbits."""
    if isinstance(solver, Peer):
        return _peer_answers(solver, scenes, law, tolerance)
    n, along = len(scenes), Scenes.of(scenes)
    found = SolverAnswers.without("failed", "", n)
    found.more.update({name: np.full(n, np.nan) for name in more})
    for places, answers in answer(Chunk(np.arange(n), along, law, solver, Task(tolerance))):
        for at, place in enumerate(places):
            found.status[place], found.reason[place] = answers.status[at], answers.reason[at]
        found.means[places], found.errors[places] = answers.mean.real, answers.error
        if more and "ok" in answers.status:
            read = number_columns(answers, along.taken(places), more)
            for name in more:
                found.more[name][places] = read[name]
    return found


def _peer_answers(peer: Peer, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> SolverAnswers:
    n = len(scenes)
    if (reason := peer.refusal(scenes[0], law)) is not None:
        return SolverAnswers.without("refused", reason, n)
    if n > 1 and not peer.together:
        return _joined([_peer_answers(peer, [scene], law, tolerance) for scene in scenes])
    try:
        means = peer.solve(scenes, law, tolerance)
    except Exception as problem:  # another's library may raise anything, and keeps its place all the same
        if n > 1:  # one scene that fails leaves the others their answers
            return _joined([_peer_answers(peer, [scene], law, tolerance) for scene in scenes])
        return SolverAnswers.without("failed", str(problem) or type(problem).__name__, n)
    status = ["ok" if good else "failed" for good in np.isfinite(means)]
    reasons = ["" if good else "the answer is no finite number" for good in np.isfinite(means)]
    return SolverAnswers(status, reasons, means, np.full(n, np.nan))


def _joined(parts: Sequence[SolverAnswers]) -> SolverAnswers:
    """Answers of one scene after another."""
    return SolverAnswers(
        [status for part in parts for status in part.status],
        [reason for part in parts for reason in part.reason],
        np.concatenate([part.means for part in parts]),
        np.concatenate([part.errors for part in parts]),
    )


def whole_task(
    method: Method, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float
) -> Callable[[], object]:
    """Every column of a method's answers."""
    return lambda: number_columns(method.solve(scenes, law, tolerance), scenes, FROM_METHODS)


CAREFUL = 10.0
LOOSER = 100.0
"""Times the tolerance of a peer, for an answer that tells how well the first is known."""


def reference_means(work: Workload) -> list[ReferenceMeans]:
    """Every reference of a workload at each of its points."""
    return [_reference_means(trusted, work) for trusted in work.references]


def _reference_means(trusted: ReferenceSource, work: Workload) -> ReferenceMeans:
    if trusted.solver is None:
        means = np.array([_known(trusted.values, speed) for speed in work.speeds()])
        return ReferenceMeans(
            trusted.label, "", means, np.where(np.isnan(means), math.nan, trusted.tolerance)
        )
    outcome = solve_points(trusted.solver, work.scenes, work.law, trusted.tolerance)
    means, errors = known_means(trusted, outcome, work.scenes, work.law)
    return ReferenceMeans(trusted.label, trusted.kind, means, errors)


def known_means(
    trusted: ReferenceSource, outcome: SolverAnswers, scenes: Sequence[Scene], law: FrictionLaw
) -> tuple[Floats, Floats]:
    """What a solver's answers are worth as a reference: means and their errors, NaN where it has no answer.

    A method states its error. That of a peer is taken from asking once more, for ``LOOSER`` times the tolerance:
    ``CAREFUL`` times how far that answer is away, and as often the tolerance. Where an integrator gets no nearer the
    errors of both are of one size, and their difference may be small by chance.
    """
    good = np.array(outcome.status) == "ok"
    errors = outcome.errors
    if isinstance(trusted.solver, Peer) and good.any():
        loose = solve_points(trusted.solver, scenes, law, LOOSER * trusted.tolerance)
        errors = CAREFUL * (np.abs(loose.means - outcome.means) + trusted.tolerance)
        good &= np.isfinite(errors)
    return np.where(good, outcome.means, math.nan), np.where(good, errors, math.nan)


def _known(values: dict[float, float], speed: float) -> float:
    """The value at this belt speed, give or take its last digits."""
    return next((mean for at, mean in values.items() if math.isclose(at, speed, rel_tol=1e-12)), math.nan)


def independent(found: Sequence[ReferenceMeans], kind: str, places: Sequence[int]) -> ReferenceMeans | None:
    """The first reference not made by this kind of method or peer that knows one of these points."""
    others = (each for each in found if each.kind != kind)
    return next((each for each in others if np.isfinite(each.means[list(places)]).any()), None)
