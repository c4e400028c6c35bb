"""The experiment that tells models apart best: where their mean frictions lie furthest apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import minimize
from scipy.stats import qmc

from frictionlab.fitting.residuals import FIT_TOLERANCE
from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.runner.arguments import given_law, given_scene, given_tolerance
from frictionlab.runner.steady_state import steady_states
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes

DRAWN = 64
"""Experiments drawn over the ranges (Sobol's sequence)."""
REFINED = 3
"""The best of them from which a better one is looked for."""
BELT = "belt_speed"


@dataclass(frozen=True, eq=False)
class Experiments:
    """Experiments, the best first.

    table: the inputs of each, the mean friction by each model (``mean_1``, ``mean_2``, ...), apart: the smallest
    distance between two models over sigma, and the two that lie so near. best: the inputs of the first.
    """

    table: pd.DataFrame
    inputs: tuple[str, ...]

    @property
    def best(self) -> dict[str, float]:
        """The inputs of the experiment that tells the models apart best."""
        return {name: float(self.table[name].iloc[0]) for name in self.inputs}

    def plot(self) -> Any:
        """A matplotlib figure: how far apart the models are, over each input."""
        from frictionlab.charts.experiments import experiments_figure  # with matplotlib, which takes a second

        return experiments_figure(self.table, self.inputs)


def discriminate(
    models: Sequence[tuple[Scene, FrictionLaw]], experiments: Mapping[str, tuple[float, float]], sigma: float
) -> Experiments:
    """Rank experiments by how well they tell models apart.

    models: two or more scenes with a law. experiments: inputs of the scenes by path, with the range that can be set,
    such as ``{"belt_speed": (1, 60), "drive.frequency": (0.5, 2)}``. sigma: standard error of a measured mean
    friction coefficient. An experiment at which a model has no mean friction is left out.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> models = [(scene, fl.Coulomb(mu=0.4)), (scene, fl.Coulomb(mu=0.5))]
    >>> found = fl.discriminate(models, {"belt_speed": (1, 60)}, sigma=0.01)
    >>> found.best["belt_speed"] > 45, bool(found.table["apart"].iloc[0] >= 10)
    (True, True)

    Raises ValueError or TypeError for what makes no sense.
    """
    if len(models) < 2:
        raise ValueError(f"models: two or more are needed to tell apart, got {len(models)}")
    pairs = [(given_scene(scene), given_law(law)) for scene, law in models]
    names, ranges = tuple(experiments), np.array([*experiments.values()], dtype=float)
    if not names or ranges.shape != (len(names), 2) or not (ranges[:, 0] < ranges[:, 1]).all():
        raise ValueError(
            f"experiments must be ranges by input, such as {{'belt_speed': (1, 60)}}, got {experiments!r}"
        )
    error = given_tolerance(sigma, "sigma")
    drawn = ranges[:, 0] + qmc.Sobol(len(names), seed=1).random(DRAWN) * np.ptp(ranges, axis=1)
    tried = [*drawn, *(np.where(side, ranges[:, 1], ranges[:, 0]) for side in (False, True))]
    rows = {tuple(point): _means(pairs, names, point) for point in tried}

    def apart(point: Floats) -> float:
        inside = tuple(np.clip(point, ranges[:, 0], ranges[:, 1]))
        if inside not in rows:
            rows[inside] = _means(pairs, names, np.array(inside))
        return _smallest(rows[inside])[0]

    best = sorted(rows, key=lambda point: -np.nan_to_num(_smallest(rows[point])[0], nan=-1.0))[:REFINED]
    for start in best:
        steps = 0.05 * np.ptp(ranges, axis=1)
        corners = [np.array(start), *(np.array(start) + step for step in np.diag(steps))]
        minimize(
            lambda point: -np.nan_to_num(apart(point), nan=-1.0),
            np.array(start),
            method="Nelder-Mead",
            options={"initial_simplex": np.array(corners), "maxfev": 40, "xatol": 1e-4, "fatol": 1e-6},
        )
    return Experiments(_table(names, rows, error), names)


def _means(pairs: Sequence[tuple[Scene, FrictionLaw]], names: Sequence[str], point: Floats) -> Floats:
    """The mean friction of each model at an experiment; NaN where it has none."""
    given = dict(zip(names, point.tolist(), strict=True))
    found = []
    for scene, law in pairs:
        there = scene.with_(**{name: value for name, value in given.items() if name != BELT})
        speed = given.get(BELT, scene.belt_speed)
        answered = steady_states(Scenes(there, np.array([speed])), law, FIT_TOLERANCE, ["mean_friction"])
        found.append(float(answered.numbers["mean_friction"][0]))
    return np.array(found)


def _smallest(means: Floats) -> tuple[float, tuple[int, int]]:
    """The smallest distance between two models, and which these are."""
    return min(
        (abs(float(means[one] - means[other])), (one, other))
        for one, other in combinations(range(len(means)), 2)
    )


def _table(names: Sequence[str], rows: Mapping[tuple[float, ...], Floats], sigma: float) -> pd.DataFrame:
    """The best first, those without a number left out."""
    told = []
    for point, means in rows.items():
        if np.isnan(means).any():
            continue
        distance, (one, other) = _smallest(means)
        row: dict[str, Any] = dict(zip(names, map(float, point), strict=True))
        row |= {f"mean_{place}": float(mean) for place, mean in enumerate(means, 1)}
        told.append(row | {"apart": distance / sigma, "nearest": f"{one + 1} and {other + 1}"})
    if not told:
        raise ValueError("no experiment in these ranges has a mean friction by every model")
    return pd.DataFrame(told).sort_values("apart", ascending=False, kind="stable").reset_index(drop=True)
