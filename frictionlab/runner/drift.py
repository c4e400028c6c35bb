"""Speed at which a body that no spring holds travels over a plate that vibrates.

It is the speed of a belt, the other way, over which no mean force holds the body: a root of the mean force.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from frictionlab.runner.part import Part
from frictionlab.runner.pieces import Chunk
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.theory.linear import velocity_scale

_MOST_STEPS = 40
"""Times that the speed is doubled in search of one beyond which the mean force has the other sign."""
FIRST = 0.117
"""First speed that is tried, over that of the vibration; not a share at which waveforms have corners."""
CLOSE, NEAR = 1e-11, 1e-6
"""Distance to which the speed is sought, and the least one at which the slope of the mean force is taken, over the
speed of the vibration."""
_SLOPES = 2.0
"""Largest ratio of that slope to the one at the speed itself that the error allows for."""
FOR_BALANCE = frozenset({"mean_friction", "error", "mean_low", "mean_high", "seconds"})


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
        for _ in range(_MOST_STEPS):
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

    task = replace(chunk.task, samples=0, harmonics=0, columns=FOR_BALANCE)
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
    return Drift(best.speed, _SLOPES * (abs(best.left) + best.error) / -slope)
