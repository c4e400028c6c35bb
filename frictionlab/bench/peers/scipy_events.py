"""scipy's solve_ivp with its own event location: each reversal ends a leg, stick is handled between legs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import ClassVar, Literal

import numpy as np

from frictionlab.bench.peers.base import Peer
from frictionlab.bench.peers.line import LineMotion, MotionState, first_step, means
from frictionlab.bench.peers.scipy_steps import LEAST_RTOL
from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene

LOOKS = 128
"""At the force of stick per period, before its meeting with the limit is bracketed."""


class ScipyEvents(Peer):
    """solve_ivp from event to event along the line, from the friction-free orbit until the period closes.

    solver: DOP853 (default), RK45 or Radau; rtol and atol are the tolerance.
    """

    name: ClassVar[str] = "scipy_events"
    package: ClassVar[str] = "scipy"

    solver: Literal["DOP853", "RK45", "Radau"] = "DOP853"

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Motion in the plane, where slip has no sign to change."""
        if (known := super().refusal(scene, law)) is not None:
            return known
        return None if scene.load_along_belt_only else "scipy_events is set up for motion along the belt"

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Floats:
        """One scene after the other."""
        mass = scenes[0].mass()
        legs = _Legs(mass, law.sliding_friction(1.0) * mass.normal_load)
        legs.solver, legs.tolerance = self.solver, tolerance
        return means(legs, scenes, tolerance)


class _Legs(LineMotion):
    """Legs by solve_ivp."""

    solver: str
    tolerance: float

    def slide(self, side: float, place: MotionState) -> tuple[MotionState, float]:
        from scipy.integrate import solve_ivp

        begun, place = place.t, first_step(self, side, place)
        settings = {"method": self.solver, "rtol": max(self.tolerance, LEAST_RTOL), "atol": self.tolerance}
        found = solve_ivp(
            self._rates(side),
            (place.t, self.period),
            [place.x, place.v],
            events=self._end_of_slip(side),
            **settings,
        )
        if found.status < 0:
            raise ArithmeticError(f"solve_ivp: {found.message}")
        x, v = found.y[:, -1]
        end = float(found.t[-1])
        place = MotionState(end, float(x), self.belt_speed if found.status == 1 else float(v))
        return place, side * self.limit * (end - begun)

    def _rates(self, side: float) -> Callable[[float, Floats], list[float]]:
        damping, rub = self.mass.damping, side * self.limit
        return lambda t, y: [y[1], self.load(t) - damping * y[1] - y[0] - rub]

    def _end_of_slip(self, side: float) -> Callable[[float, Floats], float]:
        def slip(t: float, y: Floats) -> float:
            return float(y[1] - self.belt_speed)

        slip.terminal, slip.direction = True, -side  # type: ignore[attr-defined]  # how solve_ivp is told
        return slip

    def hold(self, place: MotionState) -> MotionState:
        """Stick needs no integrator: the spring is drawn out evenly, and the force to hold it is known."""
        from scipy.optimize import brentq

        def at(t: float) -> MotionState:
            return MotionState(t, place.x + self.belt_speed * (t - place.t), self.belt_speed)

        def room(t: float) -> float:
            return self.limit - abs(self.net(at(t)))

        times = np.append(np.arange(place.t, self.period, self.period / LOOKS), self.period)
        over = next((k for k in range(1, len(times)) if room(times[k]) < 0.0), None)
        if over is None:
            return at(self.period)
        low = float(times[over - 1])
        return at(low if room(low) <= 0.0 else brentq(room, low, float(times[over]), xtol=1e-15))
