"""Speed at which a body that no spring holds travels over a plate that vibrates.

It is the speed of a belt, the other way, over which no mean force holds the body: a root of the mean force.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from numbers import Real
from typing import Any, NamedTuple

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.runner.arguments import given_law, given_method, given_scene, given_tolerance
from frictionlab.runner.engine import within as obeying
from frictionlab.runner.part import Part
from frictionlab.runner.pieces import Chunk, Task
from frictionlab.runner.solve import solve
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.study.grid import law_in_scene
from frictionlab.theory.linear import velocity_scale
from frictionlab.values.notes import Unfit, python_text
from frictionlab.values.units import in_units

MOST_STEPS = 40
"""Times that the speed is doubled in search of one beyond which the mean force has the other sign."""
FIRST = 0.117
"""First speed that is tried, over that of the vibration; not a share at which waveforms have corners."""
CLOSE, NEAR = 1e-11, 1e-6
"""Distance to which the speed is sought, and the least one at which the slope of the mean force is taken, over the
speed of the vibration."""
SLOPES = 2.0
"""Largest ratio of that slope to the one at the speed itself that the error allows for."""
COLUMNS = frozenset({"mean_friction", "error", "mean_low", "mean_high", "seconds"})


class Drift(NamedTuple):
    """Drift speed in the scales of the scene with its error, NaN with the reason where there is none."""

    speed: float
    error: float
    reason: str = ""


class _NoDriftError(Exception):
    """No mean friction at a speed, or no speed at which forces balance."""


class _Look(NamedTuple):
    """Mean force that is left on a body where it travels at a speed, and the error of that."""

    speed: float
    left: float
    error: float


class _Balance:
    """Mean force on the body of a chunk, of the same law, at the speeds at which it was asked for."""

    def __init__(self, chunk: Chunk, solve: Callable[[Chunk], Part], force: float) -> None:
        self._chunk, self._solve, self.scene = chunk, solve, chunk.scenes.scene
        self._load = self.scene.signals().load[0].mean + force
        self.seen: list[_Look] = []

    def __call__(self, speed: float) -> float:
        """Compute the force that is left. Raises _NoDriftError where there is no mean friction."""
        scene, normal_load = self.scene, self.scene.normal_load or 0.0
        found = self._solve(replace(self._chunk, scenes=_carried(scene, speed)))
        status, reason = (found.text[name][0] for name in ("status", "reason"))
        mean, error, low, high = (
            float(found.numbers[name][0]) for name in ("mean_friction", "error", "mean_low", "mean_high")
        )
        if status == "not_unique" and speed == 0.0:  # friction at rest takes what it can
            mean, error = min(max(-self._load / normal_load, low), high), 0.0
        elif status != "ok":
            raise _NoDriftError(f"no drift speed: {status} over a belt of speed {-speed:.6g}: {reason}")
        dashpot = 2.0 * (scene.damping_ratio or 0.0) * speed
        self.seen.append(_Look(speed, normal_load * mean + self._load - dashpot, normal_load * error))
        return self.seen[-1].left

    def bracket(self, step: float) -> tuple[float, float]:
        """Return two speeds between which the force changes its sign, one the first where it is nothing."""
        at_rest = self(0.0)
        if at_rest == 0.0:
            return 0.0, 0.0
        last, speed = 0.0, math.copysign(step, at_rest)
        for _ in range(MOST_STEPS):
            if self(speed) * at_rest <= 0.0:
                return min(last, speed), max(last, speed)
            last, speed = speed, 2.0 * speed
        raise _NoDriftError("no drift speed: the constant force is more than friction balances")

    def nearest(self, speed: float, distance: float) -> _Look:
        """Return the look nearest to a speed that is at least so far from it."""
        if all(abs(each.speed - speed) < distance for each in self.seen):
            self(speed + distance)
        far = [each for each in self.seen if abs(each.speed - speed) >= distance]
        return min(far, key=lambda each: abs(each.speed - speed))


def _carried(scene: Scene, speed: float) -> Scenes:
    """Return the scene on a belt that moves the other way at this speed [omega_1 L]."""
    si = scene.dimensional
    return Scenes(scene, np.array([-speed * (1.0 if si is None else si.scales.velocity)]))


def drift_of(
    chunk: Chunk,
    solve: Callable[[Chunk], Part],
    force: float = 0.0,
    within: tuple[float, float] | None = None,
) -> Drift:
    """Return the drift speed of the body of a chunk under a constant force, in the scales of the scene.

    within: ends of the range in which it is sought; from rest on, ever faster, if left out.
    """
    from scipy.optimize import brentq

    task = replace(chunk.task, samples=0, harmonics=0, columns=COLUMNS)
    balance = _Balance(replace(chunk, task=task), solve, force)
    scale = velocity_scale(chunk.scenes.scene)
    scale = scale if 0.0 < scale < math.inf else 1.0
    try:
        low, high = within or balance.bracket(FIRST * scale)
        if low < high and (balance(low) > 0.0) == (balance(high) > 0.0):
            raise _NoDriftError(f"no drift speed: the mean force has one sign from {low:.6g} to {high:.6g}")
        if low < high:
            brentq(balance, low, high, xtol=CLOSE * scale)
        best = min(balance.seen, key=lambda each: abs(each.left))
        if best.left == best.error == 0.0:  # friction holds the body
            return Drift(best.speed, 0.0)
        near = balance.nearest(best.speed, NEAR * scale)
    except _NoDriftError as problem:
        return Drift(math.nan, math.nan, str(problem))
    slope = (near.left - best.left) / (near.speed - best.speed)
    if slope >= 0.0:
        return Drift(
            math.nan, math.nan, f"no drift speed: forces balance at {best.speed:.6g}, but drive a body on"
        )
    return Drift(best.speed, SLOPES * (abs(best.left) + best.error) / -slope)


@dataclass(frozen=True)
class DriftSpeed:
    """Speed at which a body travels over a plate that vibrates; ``fl.drift_speed`` returns it.

    Attributes
    ----------
    speed : float
        Mean velocity of the body, positive along x1 [omega_1 L; m/s if the scene is in SI units].
    error : float
        Bound on its absolute error, estimated.
    scene : Scene
        Scene with the belt at minus this speed, in which the body stays where it is.

    Examples
    --------
    >>> import frictionlab as fl
    >>> shaken = fl.BeltVibration(velocity_amplitude=1, frequency=1, waveform={"square": {"duty": 0.8}})
    >>> scene = fl.Scene(spring=False, damping_ratio=0, normal_load=1, belt_speed=0, belt_vibration=shaken)
    >>> drift = fl.drift_speed(scene, fl.Coulomb(mu=0.01))
    >>> round(drift.speed, 3), drift.scene.belt_speed == -drift.speed
    (0.397, True)
    """

    speed: float
    error: float
    scene: Scene


def drift_speed(
    scene: Scene,
    law: FrictionLaw,
    force: float | str = 0.0,
    within: tuple[float | str, float | str] | None = None,
    method: str | Method = "auto",
    tolerance: float = 1e-8,
) -> DriftSpeed:
    """Compute the speed at which a body that no spring holds travels over a plate that vibrates.

    At this speed the mean of friction, the mean of the loads, the dashpot and ``force`` balance. The belt speed
    of the scene is of no account.

    Parameters
    ----------
    scene : Scene
        Body without a spring (``spring=False``, in SI units ``stiffness=0``), and what shakes it.
    law : FrictionLaw
        Law of friction.
    force : float or str, default 0
        Constant force along x1, beside those of the scene [K_1 L; N if the scene is in SI units, or text with a
        unit there].
    within : tuple of float or str, optional
        Two speeds between which it is sought. If left out it is sought from rest on, ever faster, towards the
        side to which the forces drive a body at rest; where friction falls with speed there may be others.
    method : str or Method, default "auto"
        Name of a method, or a method.
    tolerance : float, > 0, default 1e-8
        Absolute bound [-] on the error of the mean friction at each speed.

    Returns
    -------
    DriftSpeed
        Speed, its error, and the scene in which the body stays.

    Raises
    ------
    ValueError
        If the body has a spring, if there is no such speed, or if a value makes no sense.
    TypeError
        If scene, law or method are of another kind.

    References
    ----------
    Motion of a body on a vibrating plate: Blekhman, Vibrational Mechanics (2000).

    Examples
    --------
    >>> import frictionlab as fl
    >>> waves = {"harmonics": [{"order": 1, "amplitude": 1}, {"order": 2, "amplitude": 0.5, "phase": 90}]}
    >>> scene = fl.Scene.si(
    ...     mass="10 g", stiffness=0, normal_load="98.1 mN", belt_speed=0,
    ...     belt_vibration={"velocity_amplitude": "0.1 m/s", "frequency": "50 Hz", "waveform": waves},
    ... )
    >>> found = fl.drift_speed(scene, fl.Coulomb(mu=0.2))
    >>> round(found.speed, 4), found.error < 1e-6
    (0.049, True)
    """
    scene, law, ready = given_scene(scene), given_law(law), given_method(method)
    if not scene.is_free:
        raise ValueError("drift_speed needs a body without a spring: spring=False, in SI units stiffness=0")
    si = scene.dimensional
    speed_unit, force_unit = (1.0, 1.0) if si is None else (si.scales.velocity, si.scales.force)
    pushed = _number("force", force, "N", scene) / force_unit
    ends = None if within is None else _ends(within, scene, speed_unit)
    chunk = Chunk(
        Scenes.of([scene]), law_in_scene(law, scene), ready, Task(given_tolerance(tolerance), columns=COLUMNS)
    )
    found = obeying(math.inf, drift_of, chunk, solve, pushed, ends)
    if found.reason:
        raise ValueError(found.reason)
    speed = found.speed * speed_unit
    return DriftSpeed(speed, found.error * speed_unit, scene.at(-speed))


def _number(name: str, value: float | str, unit: str, scene: Scene) -> float:
    """Return the number that is given, as text with a unit, too, where the scene is in SI units."""
    read = in_units(value, unit) if isinstance(value, str) and scene.dimensional is not None else value
    if isinstance(read, Unfit | bool) or not isinstance(read, Real) or not math.isfinite(read):
        raise ValueError(f"{name}: {getattr(read, 'what', 'must be a number')}, got {python_text(value)}")
    return float(read)


def _ends(within: Any, scene: Scene, unit: float) -> tuple[float, float]:
    """Return the ends of the range that is given, the lower one first."""
    if isinstance(within, str) or not isinstance(within, Sequence) or len(within) != 2:
        raise ValueError(f"within: must be two speeds, got {python_text(within)}")
    low, high = sorted(_number("within", one, "m/s", scene) / unit for one in within)
    if low == high:
        raise ValueError(f"within: must be two different speeds, got {python_text(within)}")
    return low, high
