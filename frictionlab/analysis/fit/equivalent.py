"""The nearest curve of another model: which numbers bring one curve of mean friction closest to another.

The experiment that tells models apart best: where their mean frictions lie furthest apart.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any, Literal

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from scipy.optimize import minimize
from scipy.stats import qmc

from frictionlab.analysis.fit.free import Model, free_numbers
from frictionlab.analysis.fit.measured import Measurements, given_measurements
from frictionlab.analysis.fit.residuals import FIT_TOLERANCE, STARTS, Residuals, search
from frictionlab.laws.base import FrictionLaw
from frictionlab.runner.api import curve
from frictionlab.runner.arguments import given_law, given_scene, given_speeds, given_tolerance
from frictionlab.runner.steady_state import steady_states
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.theory.linear import friction_free_velocity
from frictionlab.values.quantities import Floats

Norm = Literal["largest", "rms"]
USUAL_POINTS, USUAL_END = 40, 1.2
"""Belt speeds where none are given, and their end over V_lin."""


@dataclass(frozen=True, eq=False)
class Equivalent:
    """Nearest curve of one model to that of another.

    ``fl.equivalent`` returns it.

    Attributes
    ----------
    values : dict of str to float
        Free numbers of the model at the nearest curve.
    distance : float
        Distance of the mean friction coefficients at the belt speeds [-]: the largest or the root mean
        square, as asked for.
    distance_error : float
        Bound on the error of ``distance`` from the errors of both curves [-].
    at : float
        Belt speed of the largest distance.
    rms : float
        Root mean square distance [-].
    table : pandas.DataFrame
        A row for each value of the varied input, with the reason if there is no answer.
    curves : pandas.DataFrame
        Both curves, a row for each belt speed.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> other = (scene, fl.Coulomb(mu=0.3), {"mu": (0.1, 1.0)})
    >>> found = fl.equivalent((scene, fl.Coulomb(mu=0.4)), other, belt_speed=[5, 20, 40])
    >>> found.curves.shape
    (3, 3)
    """

    values: dict[str, float]
    distance: float
    distance_error: float
    at: float
    rms: float
    table: pd.DataFrame
    curves: pd.DataFrame

    def plot(self) -> Any:
        """Draw both curves, or the distance over the varied input.

        Returns
        -------
        matplotlib.figure.Figure
            Figure.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> stiff = fl.Dahl(mu=0.4, presliding_length=0.1)
        >>> other = (scene, fl.Coulomb(mu=0.4), {"mu": (0.3, 0.5)})
        >>> found = fl.equivalent((scene, stiff), other, belt_speed=[10, 40])
        >>> found.plot().savefig("equivalent.svg")
        """
        from frictionlab.charts.fits import equivalent_figure  # with matplotlib, which takes a second

        return equivalent_figure(self.table, self.curves)


def equivalent(
    of: tuple[Scene, FrictionLaw],
    among: tuple[Scene, FrictionLaw, Mapping[str, Any]],
    belt_speed: ArrayLike | None = None,
    norm: Norm = "largest",
    over: Mapping[str, Sequence[float]] | None = None,
    starts: int = STARTS,
) -> Equivalent:
    """Find the numbers of a model that bring its curve nearest to that of another model.

    Parameters
    ----------
    of : tuple of Scene and FrictionLaw
        Model whose curve is to be approached.
    among : tuple of Scene, FrictionLaw and dict
        Model with free numbers, and their ranges as for ``fit``.
    belt_speed : array_like of float, shape (n,), optional
        Belt speeds [omega_1 L; m/s for a scene in SI units]; 40 up to 1.2 V_lin if left out, with V_lin the
        largest velocity of the body without friction.
    norm : {"largest", "rms"}, default "largest"
        Distance that is made small: the largest one, or the root mean square.
    over : dict of str to list of float, optional
        One input of both scenes and its values, such as ``{"drive.frequency": [1, 1.5]}``. The numbers are
        found anew for each value; attributes beside ``table`` are those of the first value that has an
        answer.
    starts : int, >= 1, default 8
        Number of starts of the search.

    Returns
    -------
    Equivalent
        Numbers, distance and curves.

    Raises
    ------
    ValueError
        If a value makes no sense, or no pair of curves has a mean friction everywhere.
    TypeError
        If a value is of another kind.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> other = (scene, fl.Coulomb(mu=0.3), {"mu": (0.1, 1.0)})
    >>> found = fl.equivalent((scene, fl.Coulomb(mu=0.4)), other, belt_speed=[5, 20, 40])
    >>> round(found.values["mu"], 6), found.distance < 1e-7
    (0.4, True)
    """
    if norm not in ("largest", "rms"):
        raise ValueError(f"norm must be 'largest' or 'rms', got {norm!r}")
    one, other = given_scene(of[0]), given_scene(among[0])
    laws = given_law(of[1]), given_law(among[1])
    free = free_numbers(among[2], [laws[1]], other)[0]
    if over is not None and len(over) != 1:
        raise ValueError(f"over must name one input, such as {{'drive.frequency': [1, 1.5]}}, got {over!r}")
    path, values = next(iter(over.items())) if over else ("", [math.nan])
    rows: list[dict[str, Any]] = []
    first, why = None, None
    for value in values:
        scenes = [_changed(scene, path, value) for scene in (one, other)]
        rows.append({path: value} if path else {})
        try:
            found = _nearest(scenes[0], laws[0], Model(laws[1], scenes[1], free), belt_speed, norm, starts)
        except ValueError as none:
            why = none
            rows[-1]["reason"] = str(none)
            continue
        first = first or found
        numbers = {name: getattr(found, name) for name in ("distance", "distance_error", "at", "rms")}
        rows[-1] |= found.values | numbers
    if first is None:
        raise why or ValueError("over must have a value")
    return replace(first, table=pd.DataFrame(rows))


def _changed(scene: Scene, path: str, value: float) -> Scene:
    """The scene with this input, where it has it; a prescribed slip takes the frequency of a drive as its own."""
    if not path:
        return scene
    if scene.degrees_of_freedom == 0 and path == "drive.frequency":
        path = "slip.frequency"
    return scene.with_(**{path: value})


def _nearest(
    scene: Scene, law: FrictionLaw, model: Model, belt_speed: ArrayLike | None, norm: Norm, starts: int
) -> Equivalent:
    if belt_speed is None:
        end = USUAL_END * float(friction_free_velocity(scene))
        if not math.isfinite(end):
            raise ValueError(
                "belt_speed: give the belt speeds of the curve: this scene has no V_lin to choose them by"
            )
        speeds = np.linspace(end / USUAL_POINTS, end, USUAL_POINTS)
    else:
        speeds = np.unique(given_speeds(belt_speed))
    target = curve(scene, law, speeds, "auto", FIT_TOLERANCE, columns=["mean_friction"], progress=False)
    if target["mean_friction"].isna().any():
        row = target[target["mean_friction"].isna()].iloc[0]
        raise ValueError(
            f"the curve to come near has no mean friction everywhere: {row['status']}: {row['reason']}"
        )
    in_si = scene.dimensional is not None
    name = "belt_speed_m_per_s" if in_si else "belt_speed"
    measured: Measurements = given_measurements(
        {name: speeds, "mean_friction": target["mean_friction"]}, "of", in_si
    )
    residuals = Residuals(model, measured)
    shares = search(residuals, starts).best.shares
    if norm == "largest":
        shares = _least_largest(residuals, shares)
    apart = residuals.raw(shares)
    if residuals.unanswered:
        raise ValueError(
            f"the nearest curve has no mean friction at {residuals.unanswered} of {len(apart)} belt speeds"
        )
    at = int(np.argmax(np.abs(apart)))
    rms = float(np.sqrt(np.mean(apart**2)))
    largest = float(abs(apart[at]))
    error = float(target["error"].max()) + residuals.error
    both = pd.DataFrame({"belt_speed": speeds, "of": measured.values, "among": residuals.said(shares)})
    told = largest if norm == "largest" else rms
    return Equivalent(model.values(shares), told, error, float(speeds[at]), rms, pd.DataFrame(), both)


def _least_largest(residuals: Residuals, start: Floats) -> Floats:
    """From the least squares to the least largest distance: a bound t on all distances is made small."""
    scale = max(float(np.abs(residuals.raw(start)).max()), 1e-12)

    def room(point: Floats) -> Floats:
        apart = residuals.raw(point[:-1]) / scale
        return np.concatenate([point[-1] - apart, point[-1] + apart])

    def slopes(point: Floats) -> Floats:
        own = residuals.slopes(point[:-1]) / scale
        ones = np.ones((len(own), 1))
        return np.vstack([np.hstack([-own, ones]), np.hstack([own, ones])])

    gradient = np.append(np.zeros(len(start)), 1.0)
    done = minimize(
        lambda point: float(point[-1]),
        np.append(start, 1.0),
        jac=lambda point: gradient,
        bounds=[*[(0.0, 1.0)] * len(start), (0.0, None)],
        constraints={"type": "ineq", "fun": room, "jac": slopes},
        method="SLSQP",
        options={"maxiter": 60, "ftol": 1e-9},
    )
    found = np.clip(done.x[:-1], 0.0, 1.0)
    return found if np.abs(residuals.raw(found)).max() <= scale else start


DRAWN = 64
"""Experiments drawn over the ranges (Sobol's sequence)."""
REFINED = 3
"""The best of them from which a better one is looked for."""
BELT = "belt_speed"


@dataclass(frozen=True, eq=False)
class Experiments:
    """Experiments ranked by how well they distinguish models, the best first.

    ``fl.discriminate`` returns it.

    Attributes
    ----------
    table : pandas.DataFrame
        A row for each experiment: its inputs, the mean friction by each model (``mean_1``, ``mean_2``, ...),
        ``apart``, the smallest distance between two models over sigma, and ``nearest``, these two models.
    inputs : tuple of str
        Names of the inputs.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> models = [(scene, fl.Coulomb(mu=0.4)), (scene, fl.Coulomb(mu=0.5))]
    >>> found = fl.discriminate(models, {"belt_speed": (1, 60)}, sigma=0.01)
    >>> list(found.best), found.table["nearest"].iloc[0]
    (['belt_speed'], '1 and 2')
    >>> found.plot().savefig("experiments.svg")
    """

    table: pd.DataFrame
    inputs: tuple[str, ...]

    @property
    def best(self) -> dict[str, float]:
        """Inputs of the experiment that distinguishes the models best."""
        return {name: float(self.table[name].iloc[0]) for name in self.inputs}

    def plot(self) -> Any:
        """Draw the distance between the models over each input.

        Returns
        -------
        matplotlib.figure.Figure
            Figure.
        """
        from frictionlab.charts.fits import experiments_figure  # with matplotlib, which takes a second

        return experiments_figure(self.table, self.inputs)


def discriminate(
    models: Sequence[tuple[Scene, FrictionLaw]], experiments: Mapping[str, tuple[float, float]], sigma: float
) -> Experiments:
    """Rank experiments by how well they distinguish models.

    An experiment at which a model has no mean friction is left out.

    Parameters
    ----------
    models : list of tuple of Scene and FrictionLaw
        Two or more models.
    experiments : dict of str to tuple of float
        Range of each input of the scenes that can be set, by path, such as
        ``{"belt_speed": (1, 60), "drive.frequency": (0.5, 2)}``.
    sigma : float, > 0
        Standard error of a measured mean friction coefficient [-].

    Returns
    -------
    Experiments
        Experiments, the best first.

    Raises
    ------
    ValueError
        If a value makes no sense.
    TypeError
        If a value is of another kind.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> models = [(scene, fl.Coulomb(mu=0.4)), (scene, fl.Coulomb(mu=0.5))]
    >>> found = fl.discriminate(models, {"belt_speed": (1, 60)}, sigma=0.01)
    >>> found.best["belt_speed"] > 45, bool(found.table["apart"].iloc[0] >= 10)
    (True, True)
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
