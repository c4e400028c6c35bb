"""Solvers of other libraries on the grid: one period from the known orbit at a tolerance, and how far off that is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, partial

import numpy as np

from frictionlab.bench.peers.one_period import (
    SOLVE_IVP_METHODS,
    PeriodByPeer,
    by_heyoka,
    by_solve_ivp,
    growth_by_heyoka,
    growth_by_solve_ivp,
    missing_heyoka,
    rates_of,
)
from frictionlab.bench.stability.grid import KnownState, known_state, local_rate, spaced
from frictionlab.bench.stability.limits import measured_limit, predicted_limit
from frictionlab.bench.stability.problems import StabilityProblem, width_at
from frictionlab.bench.stability.record import TIMES_ASKED, MapPoint, StabilityMap, StepLimit
from frictionlab.quantities import Floats


@dataclass(frozen=True)
class MappedPeer:
    """A solver of solve_ivp, or heyoka: it states no error, so that ten times what was asked is allowed."""

    name: str

    @property
    def integrated(self) -> str:
        """For the caption."""
        return "one period, from a state of the periodic motion"

    def problems(self) -> list[str]:
        """Heyoka's series need friction without corners."""
        return ["smoothing", "plane"] if self.name == "heyoka" else ["bristle", "smoothing", "plane"]

    def refusal(self) -> str | None:
        """Only heyoka may be missing."""
        return missing_heyoka() if self.name == "heyoka" else None

    def map_of(self, problem: StabilityProblem, n: int) -> StabilityMap:
        """n tolerances by n rates."""
        rates, tolerances = spaced(problem.rates, n), spaced(problem.tolerances, n)
        limit = StepLimit(predicted_limit(self.name), peer_limit(self.name))
        points = []
        for rate in rates:
            known = known_state(problem.name, rate, smoothed=problem.name == "smoothing")
            real = local_rate(problem.name, known, rate)
            width = width_at(rate) if problem.name == "smoothing" else None
            points += [self._point(known, width, tolerance, real) for tolerance in tolerances]
        return StabilityMap(problem, "tolerance", limit, tolerances, rates, points)

    def _point(self, known: KnownState, width: float | None, tolerance: float, rate: float) -> MapPoint:
        found = self._one_period(known, width, tolerance)
        status = "failed" if found.reason else "ok"
        error = abs(found.mean - known.mean)
        allowed = TIMES_ASKED * tolerance + known.error
        return MapPoint(tolerance, rate, found.step, status, found.reason, error, allowed)

    def _one_period(self, known: KnownState, width: float | None, tolerance: float) -> PeriodByPeer:
        state = start_of_period(known)
        if self.name == "heyoka":
            return by_heyoka(known.scene, known.law, state, width, tolerance)
        rates = rates_of(known.scene, known.law, width)
        return by_solve_ivp(self.name, rates, state, 2.0 * math.pi / known.scene.frequency, tolerance)


def start_of_period(known: KnownState) -> Floats:
    """The state as the peers' equations of motion hold it, the friction integral last."""
    x, v, z = known.state
    if known.law.memory_kind == "bristle":
        return np.array([x.real, v.real, float(z[0].real), 0.0])
    return np.array([x.real, v.real, x.imag, v.imag, 0.0])


@cache
def peer_limit(name: str) -> float:
    """The measured limit of a peer's steps; LSODA, which changes its formula as it goes, has none of its own."""
    if name == "LSODA":
        return math.inf
    return measured_limit(growth_by_heyoka if name == "heyoka" else partial(growth_by_solve_ivp, name))


MAPPED_PEERS = {name: MappedPeer(name) for name in (*SOLVE_IVP_METHODS, "heyoka")}
"""By name, in the order of tables and pictures."""
