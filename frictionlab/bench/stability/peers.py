"""Solvers of other libraries on the grid: one period from the known orbit at a tolerance, and how far off that is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, partial

import numpy as np

from frictionlab.bench.peers.heyoka_taylor import Heyoka
from frictionlab.bench.peers.one_period import (
    SOLVE_IVP_METHODS,
    by_heyoka,
    by_scipy,
    equations_of,
    growth_by_scipy,
)
from frictionlab.bench.stability.grid import KnownState, MappedSolver, known_state, local_rate
from frictionlab.bench.stability.limits import measured_limit, predicted_limit
from frictionlab.bench.stability.problems import StabilityProblem, width_at
from frictionlab.bench.stability.record import TIMES_ASKED, MapPoint, StepLimit
from frictionlab.quantities import Floats

ONE_PERIOD = "one period, from a state of the periodic motion"


@dataclass(frozen=True)
class MappedPeer(MappedSolver):
    """A solver of solve_ivp, or heyoka: it states no error, so that ten times what was asked is allowed."""

    def missing(self) -> str:
        """Only heyoka may be missing."""
        return Heyoka().missing() or "" if self.name == "heyoka" else ""

    def limit(self, problem: StabilityProblem) -> StepLimit:
        """By theory, and of one step."""
        return StepLimit(predicted_limit(self.name), peer_limit(self.name))

    def point(self, problem: StabilityProblem, rate: float, at: float) -> MapPoint:
        """At a tolerance."""
        width = width_at(rate) if problem.name == "smoothing" else None
        known = known_state(problem.name, rate, smoothed=width is not None)
        state = start_of_period(known)
        if self.name == "heyoka":
            found = by_heyoka(known.scene, known.law, state, width, at)
        else:
            equations = equations_of(known.scene, known.law, width)
            found = by_scipy(self.name, equations, state, at)
        status, error = "failed" if found.reason else "ok", abs(found.mean - known.mean)
        rate = local_rate(problem.name, known, rate)
        allowed = TIMES_ASKED * at + known.error
        return MapPoint(at, rate, found.step, status, found.reason, error, allowed)


def start_of_period(known: KnownState) -> Floats:
    """The state as the peers' equations of motion hold it, the friction integral last."""
    x, v, z = known.state
    if known.law.memory_kind == "bristle":
        return np.array([x.real, v.real, float(z[0].real), 0.0])
    return np.array([x.real, v.real, x.imag, v.imag, 0.0])


@cache
def peer_limit(name: str) -> float:
    """The measured limit of a peer's steps; LSODA changes its formula as it goes, heyoka its order and its steps."""
    return math.inf if name in ("LSODA", "heyoka") else measured_limit(partial(growth_by_scipy, name))


_ALL_PROBLEMS = ("bristle", "smoothing", "plane")
_ALL = (
    *(MappedPeer(name, _ALL_PROBLEMS, ONE_PERIOD) for name in SOLVE_IVP_METHODS),
    MappedPeer("heyoka", ("smoothing", "plane"), ONE_PERIOD),  # whose series need friction without corners
)
MAPPED_PEERS = {peer.name: peer for peer in _ALL}
"""By name, in the order of tables and pictures."""
