"""Reference values for errors: never the results of the method itself."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from frictionlab.bench.peers.base import Peer
from frictionlab.bench.record import ReferenceMeans, ReferenceSource, Workload
from frictionlab.bench.solvers import SolverAnswers, solve_points
from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene

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
