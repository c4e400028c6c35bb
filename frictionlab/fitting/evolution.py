"""The least value of a function that bends sharply where it is least: evolution with an adapted covariance.

Points are drawn about a mean; the better half moves the mean, and the covariance towards the steps that paid
(CMA-ES: Hansen, 2016, The CMA evolution strategy: a tutorial, with its usual numbers). Ranks alone count: corners and
slopes without bound do not mislead it, as they do a search along gradients.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from frictionlab.quantities import Floats

FIRST_STEP = 0.3
SETTLED = 10
"""Generations over which the best must not have changed."""
MOST_GENERATIONS = 400


def evolve(
    function: Callable[[Floats], float], start: Floats, seed: int, closeness: float = 3e-4
) -> tuple[Floats, float]:
    """The best point that was found, and its value. closeness: of values at the end, over the best and 1."""
    size = len(start)
    drawn, count = 4 + int(3.0 * math.log(size)), (4 + int(3.0 * math.log(size))) // 2
    weights = math.log(0.5 * drawn + 0.5) - np.log(np.arange(1, count + 1))
    weights = weights / weights.sum()
    selected = 1.0 / float(weights @ weights)
    path_share = (4.0 + selected / size) / (size + 4.0 + 2.0 * selected / size)
    step_share = (selected + 2.0) / (size + selected + 5.0)
    by_path = 2.0 / ((size + 1.3) ** 2 + selected)
    by_rank = min(1.0 - by_path, 2.0 * (selected - 2.0 + 1.0 / selected) / ((size + 2.0) ** 2 + selected))
    damping = 1.0 + 2.0 * max(0.0, math.sqrt((selected - 1.0) / (size + 1.0)) - 1.0) + step_share
    usual = math.sqrt(size) * (1.0 - 0.25 / size + 1.0 / (21.0 * size**2))
    random, mean, step = np.random.default_rng(seed), np.array(start), FIRST_STEP
    covariance, path, step_path = np.eye(size), np.zeros(size), np.zeros(size)
    best, least, bests = mean, function(mean), list[float]()
    for generation in range(1, MOST_GENERATIONS + 1):
        squares, ways = np.linalg.eigh(covariance)
        widths = np.sqrt(np.maximum(squares, 1e-20))
        moves = random.normal(size=(drawn, size)) * widths @ ways.T
        values = np.array([function(mean + step * move) for move in moves])
        order = np.argsort(values)
        bests.append(float(values[order[0]]))
        if bests[-1] < least:
            best, least = mean + step * moves[order[0]], bests[-1]
        near = closeness * (1.0 + abs(least))
        if np.ptp(bests[-SETTLED:]) < near and np.ptp(values) < near and generation > SETTLED:
            break
        better = moves[order[:count]]
        moved = weights @ better
        mean = mean + step * moved
        kept = 1.0 - step_share
        step_path = kept * step_path + math.sqrt((1.0 - kept**2) * selected) * (
            ways @ (ways.T @ moved / widths)
        )
        length = float(np.linalg.norm(step_path)) / usual
        steady = length / math.sqrt(1.0 - kept ** (2 * generation)) < 1.4 + 2.0 / (size + 1.0)
        path = (1.0 - path_share) * path
        if steady:
            path = path + math.sqrt(path_share * (2.0 - path_share) * selected) * moved
        covariance = (
            (1.0 - by_path - by_rank) * covariance
            + by_path * np.outer(path, path)
            + by_rank * (better.T * weights) @ better
        )
        step *= math.exp(step_share / damping * (length - 1.0))
    return best, least
