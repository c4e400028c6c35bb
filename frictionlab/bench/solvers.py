"""A method or a peer on a curve: its answers with their statuses, whatever happens, and the task to time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from frictionlab.bench.cores import core
from frictionlab.bench.peers.base import Peer
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.quantities import Floats
from frictionlab.runner.chunks import Chunk, Task
from frictionlab.runner.solve import answer
from frictionlab.scene.scene import Scene


@dataclass(frozen=True)
class SolverAnswers:
    """Status, reason, mean friction and stated error of each point; NaN where there is none."""

    status: list[str]
    reason: list[str]
    means: Floats
    errors: Floats

    @classmethod
    def without(cls, status: str, reason: str, n: int) -> SolverAnswers:
        """The same answer n times: none."""
        return cls([status] * n, [reason] * n, np.full(n, np.nan), np.full(n, np.nan))


def solve_points(
    solver: Method | Peer, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float
) -> SolverAnswers:
    """The answers of a solver, refusals and failures included."""
    if isinstance(solver, Peer):
        return _peer_answers(solver, scenes, law, tolerance)
    n = len(scenes)
    found = SolverAnswers.without("failed", "", n)
    for piece in answer(Chunk(tuple(range(n)), tuple(scenes), law, solver, Task(tolerance))):
        for at, place in enumerate(piece.places):
            found.status[place] = piece.answers.status[at]
            found.reason[place] = piece.answers.reason[at]
        for name, column in (("mean_friction", found.means), ("error", found.errors)):
            if name in piece.answers.columns:
                column[piece.places] = piece.answers.columns[name]
    return found


def _peer_answers(peer: Peer, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> SolverAnswers:
    n = len(scenes)
    if (reason := peer.refusal(scenes[0], law)) is not None:
        return SolverAnswers.without("refused", reason, n)
    try:
        means = peer.solve(scenes, law, tolerance)
    except Exception as problem:  # another's library may raise anything, and keeps its place all the same
        return SolverAnswers.without("failed", str(problem) or type(problem).__name__, n)
    status = ["ok" if good else "failed" for good in np.isfinite(means)]
    reasons = ["" if good else "the answer is no finite number" for good in np.isfinite(means)]
    return SolverAnswers(status, reasons, means, np.full(n, np.nan))


def whole_task(
    solver: Method | Peer, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float
) -> Callable[[], object]:
    """All that a solver does for a curve: every column of a method's answer."""
    return lambda: solver.solve(scenes, law, tolerance)


def mean_task(
    solver: Method | Peer, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float
) -> Callable[[], object] | None:
    """The mean friction and its error alone, where a method can give them without the rest."""
    return None if isinstance(solver, Peer) else core(solver, scenes, law, tolerance)
