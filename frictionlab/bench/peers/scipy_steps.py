"""scipy's solve_ivp as most people call it: the equations of motion as they stand, no events."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import Any, ClassVar, Literal

import numpy as np

from frictionlab.bench.peers.base import ClosureTest, Peer, closed_mean
from frictionlab.bench.peers.line import free_orbit
from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene

MOST_CALLS = 500_000
"""Of the equations of motion per scene: where friction jumps, step control can grind for ever."""


class ScipySteps(Peer):
    """solve_ivp on the equations of motion, blind to reversals, from the friction-free orbit until it closes.

    solver: DOP853 (default), RK45, LSODA or Radau; rtol and atol are the tolerance.
    """

    name: ClassVar[str] = "scipy"
    package: ClassVar[str] = "scipy"

    solver: Literal["DOP853", "RK45", "LSODA", "Radau"] = "DOP853"

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Floats:
        """One scene after the other."""
        friction = law.sliding_friction(1.0)
        return np.array([_settled(scene, friction, self.solver, tolerance) for scene in scenes])


def _settled(scene: Scene, friction: float, solver: str, tolerance: float) -> float:
    from scipy.integrate import solve_ivp

    mass = scene.mass()
    period, rates = 2.0 * math.pi / mass.frequency, Rates(mass, friction, scene.belt_speed)
    state = np.array([*start(mass), 0.0])
    settings: dict[str, Any] = {"method": solver, "rtol": max(tolerance, 3e-14), "atol": tolerance}

    def one_period(start: Floats) -> Floats:
        found = solve_ivp(rates, (0.0, period), start, t_eval=[period], **settings)
        if found.status < 0:
            raise ArithmeticError(f"solve_ivp: {found.message}")
        return found.y[:, -1]

    closing = ClosureTest(tolerance, mass.normal_load, period)
    return closed_mean(one_period, state, slice(0, 4), closing, period)


def start(mass: Mass) -> tuple[float, float, float, float]:
    """x1, v1, x2, v2 on the friction-free orbit at t = 0."""
    along = free_orbit(mass.damping, mass.stiffness, mass.frequency, mass.force)
    across = (0.0, 0.0)
    if mass.transverse_force != 0:
        numbers = mass.transverse_damping, mass.transverse_stiffness, mass.frequency, mass.transverse_force
        across = free_orbit(*numbers)
    return *along, *across


class Rates:
    """The equations of motion of (x1, v1, x2, v2, integral of the friction coefficient along x1)."""

    def __init__(self, mass: Mass, friction: float, belt_speed: float) -> None:
        self._mass, self._friction, self._belt_speed = mass, friction, belt_speed
        self._straight = mass.transverse_force == 0
        self._calls = 0

    def __call__(self, t: float, y: Floats) -> list[float]:
        self._calls += 1
        if self._calls > MOST_CALLS:
            raise ArithmeticError(f"gave up after {MOST_CALLS} calls of the equations of motion")
        m = self._mass
        x1, v1, x2, v2, _ = y.tolist()
        slip, turn = v1 - self._belt_speed, cmath.exp(1j * m.frequency * t)
        speed = abs(slip) if self._straight else math.hypot(slip, v2)
        rub = self._friction / speed if speed > 0.0 else 0.0
        a1 = (m.force * turn).imag - m.damping * v1 - x1 - m.normal_load * rub * slip
        if self._straight:
            return [v1, a1, 0.0, 0.0, rub * slip]
        across = m.transverse_damping * v2 + m.transverse_stiffness * x2 + m.normal_load * rub * v2
        return [v1, a1, v2, (m.transverse_force * turn).imag - across, rub * slip]
