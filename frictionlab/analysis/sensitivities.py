"""Derivatives of mean friction by each number of a scene and of a law: differences of steady states."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from math import isfinite
from typing import Any

import numpy as np
import pandas as pd

from frictionlab.analysis.quotients import Derivative, Pair, asked_for, derivative
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import NOT_UNIQUE, STATISTICAL, Method
from frictionlab.runner.arguments import given_law, given_scene, given_tolerance
from frictionlab.runner.state import SteadyState
from frictionlab.runner.steady_state import steady_state
from frictionlab.scene.scene import Scene
from frictionlab.values.quantities import Floats

_FINE = 1e-11
"""Tolerance of the means that are compared; those that a method leaves less accurate are taken with their error."""
_WIDEST = 0.02
"""First offset, in shares of a number."""
RADIAN = 57.3
"""Size of a phase [degrees]."""
BLUNT = 0.05
"""Error of a derivative that is none, of the derivative or of the mean over the parameter."""
BENDS = "the mean bends too sharply here: no offset is small enough for a derivative"
_COLUMNS = "parameter", "value", "derivative", "error", "elasticity", "reason"


def sensitivities(
    scene: Scene,
    law: FrictionLaw,
    parameters: Sequence[str] | None = None,
    method: str | Method = "auto",
    tolerance: float = 1e-8,
) -> pd.DataFrame:
    """Compute derivatives of the mean friction by numbers of a scene and a law.

    Steady states are found by ``method`` on both sides of each number, at offsets that shrink until errors of the
    means outweigh what wider ones leave; differences are extrapolated.

    Parameters
    ----------
    scene : Scene
        Body and belt, and what shakes them.
    law : FrictionLaw
        Law of friction.
    parameters : list of str, optional
        Paths of the numbers, such as ``"scene.damping_ratio"`` and ``"law.mu"``; all numbers if left out.
    method : str or Method, default "auto"
        Name of a method, or a method such as ``fl.March(steps=1000)``.
    tolerance : float, > 0, default 1e-8
        Absolute bound [-] on the error of ``mean_friction``.

    Returns
    -------
    pandas.DataFrame
        A row for each number, with the columns ``parameter``, ``value``, ``derivative`` d(mean)/d(parameter)
        [per unit of the parameter, a phase per degree], ``error`` (bound on the error of the derivative),
        ``elasticity`` (relative change of the mean over that of the parameter; empty for phases and where
        either is zero), ``reason`` (why there is no derivative, else "").

    Raises
    ------
    ValueError
        If a path is no number of the scene or the law, or a value makes no sense.
    TypeError
        If a value is of another kind.

    Examples
    --------
    >>> import frictionlab as fl
    >>> drive = fl.Drive(unbalance=10, frequency=1)
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
    >>> table = fl.sensitivities(scene, fl.Coulomb(mu=0.4), ["law.mu", "scene.belt_speed"])
    >>> table.derivative.round(6).tolist()
    [0.246794, 0.009882]
    """
    pair = Pair(given_scene(scene), given_law(law))
    numbers, finest = pair.numbers(), min(given_tolerance(tolerance), _FINE)
    asked = asked_for(numbers, parameters)
    state = steady_state(pair.scene, pair.law, method, tolerance)
    why = _refusal(state)
    if not why:
        state = steady_state(pair.scene, pair.law, method, finest)
    rows = []
    for path in asked:
        nothing = Derivative(np.full(1, np.nan), np.full(1, np.nan), 0, why)
        found = (
            nothing if why else _by_number(pair, path, numbers[path], state, partial(_mean, method, finest))
        )
        rows.append(_row(path, numbers[path], state, found))
    return pd.DataFrame(rows, columns=list(_COLUMNS))


def _refusal(state: SteadyState) -> str:
    """Return why a steady state is not to be differentiated, or ''."""
    if state.status != "ok":
        return f"no steady state with one mean: {state.reason}"
    if state.unique == NOT_UNIQUE or state.error_kind == STATISTICAL:
        return f"the steady state is not the only one, or does not repeat: {state.reason}"
    return "the mass rests on the belt" if state.stick_fraction == 1.0 else ""


def _mean(method: str | Method, tolerance: float, pair: Pair, path: str, number: float) -> Floats | None:
    """Return the mean with another number; None where it makes no scene or law, or has no mean."""
    try:
        state = steady_state(*pair.with_(path, number), method, tolerance)
    except ValueError:
        return None
    return np.array([state.mean_friction]) if isfinite(state.error) else None


def _by_number(pair: Pair, path: str, number: float, state: SteadyState, mean: Any) -> Derivative:
    """Return the derivative by a number; none where its error is a large part of it, or of what matters."""
    size = _size(path, number)

    def changed(offsets: Floats) -> list[Floats | None]:
        return [mean(pair, path, number + offset) for offset in offsets.tolist()]

    noise = np.array([state.error + 1e-16])
    found = derivative(changed, np.array([state.mean_friction]), _WIDEST * size, noise)
    least = max(abs(float(found.value[0])), abs(state.mean_friction) / size)
    blunt = not found.reason and found.error[0] > BLUNT * least
    return (
        found._replace(value=found.value * np.nan, error=found.error * np.nan, reason=BENDS)
        if blunt
        else found
    )


def _size(path: str, number: float) -> float:
    return RADIAN if path.endswith("phase") else abs(number) or 1.0


def _row(path: str, number: float, state: SteadyState, found: Derivative) -> tuple[Any, ...]:
    value, mean = float(found.value[0]), state.mean_friction
    relative = not path.endswith("phase") and number != 0.0 and mean != 0.0
    return (
        path,
        number,
        value,
        float(found.error[0]),
        value * number / mean if relative else np.nan,
        found.reason,
    )
