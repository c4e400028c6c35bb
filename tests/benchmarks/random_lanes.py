"""Random planar curves closed in lanes: do errors cover, by machine code and by Python on arrays?

python tests/benchmarks/random_lanes.py [--curves 40] [--seed 1]

Every curve of 24 belt speeds, of Coulomb or convergent Stribeck friction, is closed at tolerances of 1e-2 to 1e-10
and held against the search for one belt speed at 1e-12. Prints for each tolerance how many orbits lanes closed, how
many they left, how many errors do not cover (exit code 1 where there is one), and the largest true error over the
stated one; then how far the largest multipliers are from those of difference quotients.
"""

from __future__ import annotations

import argparse
import sys
from collections import defaultdict
from typing import Any

import numpy as np

import frictionlab as fl
from frictionlab.compile.cache import compiled
from frictionlab.compile.interpret import interpreted
from frictionlab.methods.periodic.continuation import CLOSED, MULTIPLIERS, answer_curve
from frictionlab.methods.periodic.lane_curve import CLOSED_ORBIT, answer_lanes
from frictionlab.methods.periodic.lane_monodromy import differentiate_in_lanes
from frictionlab.methods.periodic.problem import PeriodicProblem

TOLERANCES = 1e-2, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10
POINTS, TRUTH = 24, 1e-12
ON_ARRAYS = 1e-8
"""The tolerance at which Python closes the curve, too."""


def drawn(rng: np.random.Generator) -> PeriodicProblem:
    """The problem of one scene; loads, dampings and frequencies over decades."""
    across = fl.Transverse(
        natural_frequency=float(np.exp(rng.uniform(-1.2, 2.5))),
        damping_ratio=float(np.exp(rng.uniform(-4, 0))),
        load=fl.Load(amplitude=float(np.exp(rng.uniform(-2, 3))), phase=float(rng.uniform(-180, 180))),
    )
    scene = fl.Scene(
        damping_ratio=float(np.exp(rng.uniform(-4, 0))),
        normal_load=float(np.exp(rng.uniform(-3, 2.5))),
        belt_speed=1.0,
        drive=fl.Drive(
            amplitude=float(np.exp(rng.uniform(-1, 3))), frequency=float(np.exp(rng.uniform(-1, 1.8)))
        ),
        transverse=across,
    )
    law: Any = fl.Coulomb(mu=float(rng.uniform(0.05, 0.9)))
    if rng.random() < 0.4:
        speed = float(np.exp(rng.uniform(0, 4)))
        law = fl.Stribeck(mu_kinetic=0.3, mu_static=0.35, stribeck_speed=speed)
    return PeriodicProblem(scene, law, ON_ARRAYS)


def main(curves: int, seed: int) -> int:
    """Solve and print; 1 where an error does not cover."""
    rng, shares, left = np.random.default_rng(seed), defaultdict(list), defaultdict(int)
    on_arrays: list[float] = []
    left_on_arrays = 0
    gaps: list[float] = []
    for _ in range(curves):
        problem = drawn(rng)
        if problem.lanes is None:
            continue
        speeds = np.linspace(0.01, 1.3, POINTS) * problem.swing
        known = compiled(answer_curve, problem.law)(
            problem.body, speeds, np.empty((0, 0)), problem.goal._replace(tolerance=TRUTH), CLOSED
        )
        for tolerance in TOLERANCES:
            goal = problem.goal._replace(tolerance=tolerance)
            lanes = compiled(answer_lanes, problem.law)(problem.body, speeds, goal)
            shares[tolerance] += shares_of(lanes, known)
            left[tolerance] += int((lanes.fate != CLOSED_ORBIT).sum())
        with np.errstate(all="ignore"):
            arrays = interpreted(answer_lanes)(problem.law, problem.body, speeds, problem.goal)
        on_arrays += shares_of(arrays, known)
        left_on_arrays += int((arrays.fate != CLOSED_ORBIT).sum())
        gaps += multiplier_gaps(problem, speeds, lanes)
    for tolerance in TOLERANCES:
        told(f"{tolerance:g}", shares[tolerance], left[tolerance])
    told(f"{ON_ARRAYS:g} on arrays", on_arrays, left_on_arrays)
    print(f"multipliers: {len(gaps)}, median {np.median(gaps):.1e}, largest {max(gaps):.1e}")
    return int(any(share > 1.0 for found in (*shares.values(), on_arrays) for share in found))


def shares_of(lanes: Any, known: Any) -> list[float]:
    """True errors over stated ones, the error of the truth taken off."""
    closed = (lanes.fate == CLOSED_ORBIT) & (known.closed.maps > 0.0)
    gaps = np.abs(lanes.closed.mean - known.closed.mean) - known.closed.error
    return list((gaps / lanes.closed.error)[closed])


def multiplier_gaps(problem: PeriodicProblem, speeds: np.ndarray, lanes: Any) -> list[float]:
    """How far the largest are from those of the map of one belt speed."""
    closed = lanes.fate == CLOSED_ORBIT
    speeds, states = speeds[closed], lanes.states[closed]
    if not len(speeds):
        return []
    found = compiled(differentiate_in_lanes, problem.law)(problem.body, speeds, states)
    alone = compiled(answer_curve, problem.law)(problem.body, speeds, states, problem.goal, MULTIPLIERS)
    moduli = [np.abs(np.linalg.eigvals(np.nan_to_num(each))).max(axis=1) for each in (found, alone.matrices)]
    return list(np.abs(moduli[0] - moduli[1])[~np.isnan(found).any(axis=(1, 2))])


def told(name: str, shares: list[float], left: int) -> None:
    """One line."""
    missed = sum(share > 1.0 for share in shares)
    print(f"{name}: {len(shares)} closed, {left} left, {missed} uncovered, true/stated {max(shares):.2f}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--curves", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    sys.exit(main(**vars(parser.parse_args())))
