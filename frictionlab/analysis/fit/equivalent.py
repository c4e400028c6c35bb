"""Nearest curve of another model: which numbers bring one curve of mean friction closest to another."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from scipy.optimize import minimize

from frictionlab.analysis.fit.free import Model, free_numbers
from frictionlab.analysis.fit.measured import Measurements, given_measurements
from frictionlab.analysis.fit.residuals import FIT_TOLERANCE, STARTS, Residuals, search
from frictionlab.laws.base import FrictionLaw
from frictionlab.runner.api import curve
from frictionlab.runner.arguments import given_law, given_scene, given_speeds
from frictionlab.scene.scene import Scene
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
    """Scene with this input, where it has it; a prescribed slip takes the frequency of a drive as its own."""
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
        speeds = np.unique(given_speeds(belt_speed, scene))
    target = curve(scene, law, speeds, "auto", FIT_TOLERANCE, columns=["mean_friction"], progress=False)
    if target["mean_friction"].isna().any():
        row = target[target["mean_friction"].isna()].iloc[0]
        raise ValueError(
            f"the curve to come near has no mean friction everywhere: {row['status']}: {row['reason']}"
        )
    name = "belt_speed" if scene.dimensional is None else "belt_speed_m_per_s"
    found = {name: speeds, "mean_friction": target["mean_friction"]}
    measured: Measurements = given_measurements(found, "of", scene)
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
