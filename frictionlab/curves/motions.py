"""Steady motions of one curve, and how far each is from stick and from the end of reversal."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers
from frictionlab.motion.orbit.record import Orbit, Orbits
from frictionlab.motion.orbit.recorder import DERIVATIVE, interpolation_weights
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.theory.linear import velocity_scale
from frictionlab.theory.piecewise import piecewise
from frictionlab.theory.rest import friction_at_rest, size_of_friction
from frictionlab.values.quantities import Floats

_LEAST = 1e-12
"""Least distance from stick of a motion that slips throughout."""
_NOTHING = 1e-100
"""Static limit of a contact that holds nothing."""
_FINE = interpolation_weights(np.linspace(-1.0, 1.0, 201))


class MotionSeen(NamedTuple):
    """Facts of the steady motion at a belt speed.

    reason: why there is none, '' where there is one. sticks, reverses: whether it rests on the belt; whether its slip
    along x1 reverses or rests. to_stick: distance from stick, negative where it sticks: how far the force that would
    keep the mass with the belt is above (below) the static limit, relative to it, where slip is least; its square
    where that grows as a square root beside the onset. to_reversal: how far slip along x1 stays from changing its
    sign, relative to the velocity of the loads; negative where it does. Both are smooth on either side of the onset.
    error: bound on that of the mean friction.
    """

    belt_speed: float
    reason: str
    sticks: bool = False
    reverses: bool = False
    to_stick: float = math.nan
    to_reversal: float = math.nan
    error: float = math.nan


SolveScenes = Callable[[Scenes], list[tuple[Answers, int]]]
"""Solver of scenes that differ in belt speed alone: for each the answers and its place among them."""


class CurveMotions:
    """Steady motions of one scene under a law at any belt speed > 0.

    law: in the lengths and times of the scene, per unit of its normal load. solve: by the method of the curve.
    tell_onsets: whether instants of stick and reversal are solved for. looks: how many were solved for.
    """

    def __init__(self, scene: Scene, law: FrictionLaw, solve: SolveScenes, tell_onsets: bool) -> None:
        self.scene, self.law, self.solve, self.tell_onsets = scene, law, solve, tell_onsets
        self.looks = 0
        # a film that holds nothing at rest never sticks; its friction is measured by that of slip
        self.limit = friction_at_rest(law) or _NOTHING
        self.friction = size_of_friction(scene, law)
        self.scale = velocity_scale(scene)
        if not math.isfinite(self.scale) or self.scale == 0.0:
            self.scale = 1.0

    def at(self, belt_speeds: Sequence[float]) -> list[MotionSeen]:
        """Return the motions at these belt speeds, ascending."""
        if not len(belt_speeds):
            return []
        self.looks += len(belt_speeds)
        si, speeds = self.scene.dimensional, np.asarray(belt_speeds, dtype=np.float64)
        answered = self.solve(Scenes(self.scene, speeds if si is None else speeds * si.scales.velocity))
        together = {
            id(answers): answers.orbits()
            for answers, _ in answered
            if answers.orbits and "ok" in answers.status
        }
        return [
            self._of(speed, answers, i, together.get(id(answers)))
            for speed, (answers, i) in zip(speeds.tolist(), answered, strict=True)
        ]

    def _of(self, belt_speed: float, answers: Answers, i: int, orbits: Orbits | None) -> MotionSeen:
        if answers.status[i] != "ok":
            return MotionSeen(belt_speed, f"{answers.status[i]}: {answers.reason[i]}")
        orbit = answers.orbit(i) if orbits is None else orbits.one(i)
        if orbit is None or orbit.stick is None:
            return MotionSeen(belt_speed, "the method does not tell rest from slip")
        return self._read(belt_speed, orbit, float(answers.error[i]))

    def _read(self, belt_speed: float, orbit: Orbit, error: float) -> MotionSeen:
        slip, limit, belt_acceleration = self._contact(belt_speed, orbit)
        rests = np.broadcast_to(np.asarray(orbit.stick)[:, None], slip.shape)
        shares = np.diff(orbit.tau[:, [0, -1]])[:, 0]
        sticks = bool((np.asarray(orbit.stick) & (shares > 0.0)).any())
        if sticks:
            with np.errstate(invalid="ignore"):
                to_stick = min(float((np.abs(orbit.friction) / limit - 1.0)[rests].min()), -_LEAST)
        else:
            to_stick = self._distance_from_stick(orbit, slip, limit, belt_acceleration)
        to_reversal = -_largest(slip.real, np.asarray(orbit.stick)) / self.scale
        touches = to_reversal > -_LEAST  # its slip does not reverse but for rounding
        if sticks and (self.scene.planar or touches):
            to_stick = -(to_stick**2)  # on a line only stick that ends a reversal begins in proportion
        if sticks and touches:
            # next to the end of reversal, where slip touches zero, the time at rest grows as a square root
            to_reversal = -float((shares[orbit.stick].sum() / shares.sum()) ** 2)
        return MotionSeen(belt_speed, "", sticks, sticks or to_reversal < 0.0, to_stick, to_reversal, error)

    def _contact(self, belt_speed: float, orbit: Orbit) -> tuple[np.ndarray, Floats, np.ndarray]:
        """Slip, the largest friction coefficient at rest (per mean normal load), acceleration of the belt."""
        if self.scene.is_harmonic:
            limit, still = np.full(orbit.tau.shape, self.limit), np.zeros(orbit.tau.shape, complex)
            return orbit.v - belt_speed, limit, still
        signals, mass = self.scene.signals(), self.scene.mass()
        edges = signals.edges()
        tau = orbit.tau
        middle = np.mod(0.5 * (tau[:, :1] + tau[:, -1:]), signals.period)
        k = np.clip(np.searchsorted(edges, middle, side="right") - 1, 0, len(edges) - 2)
        since = middle + (tau - 0.5 * (tau[:, :1] + tau[:, -1:]))
        k = np.broadcast_to(k, tau.shape)
        along, across = (piecewise(each, edges).at(since, k) for each in signals.belt)
        pressed = 1.0 + piecewise(signals.normal_load, edges).at(since, k)[0] / mass.normal_load
        slip = orbit.v - belt_speed - (along[0] + 1j * across[0])
        return slip, self.limit * pressed, along[1] + 1j * across[1]

    def _distance_from_stick(
        self, orbit: Orbit, slip: np.ndarray, limit: Floats, belt_acceleration: np.ndarray
    ) -> float:
        """Return the least slip of a motion that slips throughout, over the instants at which slip is least.

        The force that would keep the mass with the belt follows from its acceleration and its friction.
        """
        half = 0.5 * (orbit.tau[:, -1:] - orbit.tau[:, :1])
        with np.errstate(divide="ignore", invalid="ignore"):
            acceleration = orbit.v @ DERIVATIVE.T / half
        friction = orbit.friction.real + 1j * np.nan_to_num(orbit.friction.imag)
        normal_load = self.scene.mass().normal_load
        held = (acceleration - belt_acceleration) / normal_load + friction
        speed = np.abs(slip).ravel()
        least = (speed <= np.roll(speed, 1)) & (speed <= np.roll(speed, -1))
        excess = np.maximum((np.abs(held) / limit - 1.0).ravel(), 0.0)
        distance = (excess + speed / self.scale)[least]
        distance = distance[np.isfinite(distance)]
        return max(float(distance.min()), _LEAST) if distance.size else math.inf


def _largest(values: Floats, stick: np.ndarray) -> float:
    """Return the maximum over the panels of slip, extremes between their nodes included."""
    values = values[~stick]
    if not len(values):
        return 0.0
    top = values.max(axis=1)
    # between its nodes a panel leaves the range of their values by less than that range
    chosen = values[top >= top.max() - np.ptp(values, axis=1)]
    fine = chosen @ _FINE.T
    row, place = np.unravel_index(int(fine.argmax()), fine.shape)
    if not 0 < place < fine.shape[1] - 1:
        return float(fine[row, place])
    left, middle, right = fine[row, place - 1 : place + 2]
    bend = left - 2.0 * middle + right
    return float(middle - (right - left) ** 2 / (8.0 * bend)) if bend < 0.0 else float(middle)
