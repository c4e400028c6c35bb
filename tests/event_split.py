"""Mean friction of bristles under a prescribed slip in the plane, by explicit steps of order 8 between events.

Written for tests alone; it shares no method with what it checks, and writes the laws down once more. Where bristles
begin to follow the slip, or cease to, a step ends: scipy's DOP853 sees a smooth rate within each.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.jenkins import Jenkins
from frictionlab.laws.memory import BristleLaw
from frictionlab.scene.scene import Scene

PERIOD = 2.0 * math.pi
LONGEST = 0.03
"""Step [rad]."""
PAST = 1e-13
"""Angle by which an event is passed."""


def slip_of(scene: Scene) -> Callable[[float], complex]:
    """The slip velocity at an angle of the period."""
    motion = scene.motion()

    def slip(angle: float) -> complex:
        turn = complex(math.cos(angle), math.sin(angle))
        along = (motion.velocity * turn).imag - scene.belt_speed
        return complex(along, (motion.transverse_velocity * turn).imag)

    return slip


def loaded_rate(law: BristleLaw, reach: float) -> Callable[[complex, complex], complex]:
    """The rate of a deflection that does not follow the slip, whichever way that points."""
    if isinstance(law, Jenkins):
        return lambda v, z: v - (v * z.conjugate()).real / reach**2 * z
    if not isinstance(law, ElastoPlastic):
        return law.rate
    begins = law.elastic_deflection()

    def rate(v: complex, z: complex) -> complex:
        ends = steady_deflection(law, abs(v))
        share = min(max((abs(z) - begins) / (ends - begins), 0.0), 1.0)
        return v - 0.5 * (1.0 - math.cos(math.pi * share)) * abs(v) / ends * z

    return rate


def steady_deflection(law: ElastoPlastic, speed: float) -> float:
    """Where the spring force is the Stribeck curve."""
    fall = math.exp(-((speed / law.stribeck_speed) ** law.stribeck_exponent))
    return (law.mu_kinetic + (law.peak - law.mu_kinetic) * fall) / law.bristle_stiffness


class Path:
    """A deflection along the period, from event to event. Its parts are shares of its reach."""

    def __init__(self, scene: Scene, law: BristleLaw) -> None:
        law = law.under_load(scene.motion().normal_load)
        self.law, self.slip, self.frequency = law, slip_of(scene), scene.frequency
        self.reach = law.largest_deflection()
        self.loaded = loaded_rate(law, self.reach)
        self.circle = isinstance(law, Jenkins)
        self.unloads = isinstance(law, ElastoPlastic) or self.circle
        self.events: list[tuple[float, bool]] = []

    def _load(self, angle: float, z: complex) -> float:
        return (self.slip(angle) * z.conjugate()).real

    def _follows(self, angle: float, z: complex) -> bool:
        """Whether the deflection follows the slip at the start."""
        within = self.circle and abs(z) < self.reach * (1.0 - 1e-12)
        return self.unloads and (within or self._load(angle, z) <= 0.0)

    def _event(self, follows: bool) -> Any:
        """Where a deflection begins to follow the slip, or ceases to."""

        def far(angle: float, state: Any) -> float:
            z = complex(state[0], state[1])
            return abs(z) - 1.0 if self.circle and follows else self._load(angle, z)

        far.terminal, far.direction = True, 1.0 if follows else -1.0  # type: ignore[attr-defined]
        return far

    def _breaks(self) -> Any:
        """Where bristles begin to break away, or have: the rate has a corner of its slope there."""
        law = self.law

        def far(angle: float, state: Any) -> float:
            if not isinstance(law, ElastoPlastic):
                return 1.0
            size, ends = abs(complex(state[0], state[1])), steady_deflection(law, abs(self.slip(angle)))
            return (size - law.elastic_deflection() / self.reach) * (size - ends / self.reach)

        far.terminal = True  # type: ignore[attr-defined]
        return far

    def _rates(self, follows: bool) -> Callable[[float, Any], list[float]]:
        def rates(angle: float, state: Any) -> list[float]:
            v, z = self.slip(angle), complex(state[0], state[1]) * self.reach
            dz = v if follows else self.loaded(v, z)
            rub = self.law.friction(v, z, dz)
            pace = self.reach * self.frequency
            return [dz.real / pace, dz.imag / pace, rub.real / PERIOD]

        return rates

    def period(self, start: complex) -> tuple[complex, float]:
        """The deflection at the end, and the mean friction."""
        angle, state = 0.0, np.array([start.real, start.imag, 0.0])
        follows, self.events = self._follows(0.0, start * self.reach), []
        while angle < PERIOD:
            rates = self._rates(follows)
            more: dict[str, Any] = {"rtol": 1e-12, "atol": 1e-15, "max_step": LONGEST}
            if self.unloads:
                more["events"] = [self._event(follows), self._breaks()]
            leg = solve_ivp(rates, (angle, PERIOD), state, "DOP853", **more)
            assert leg.success, leg.message
            angle, state = float(leg.t[-1]), leg.y[:, -1].copy()
            if leg.status == 1:
                if len(leg.t_events[0]):
                    follows = not follows
                    self.events.append((angle, follows))
                state = state + PAST * np.array(self._rates(follows)(angle, state))
                angle += PAST
        return complex(state[0], state[1]), -float(state[2])


def planar_mean(scene: Scene, law: BristleLaw) -> tuple[float, float]:
    """The mean friction along the belt of the deflection that repeats, and how far that was from closing."""
    path, z, small = Path(scene, law), 0.5 + 0j, 1e-6
    end, mean = path.period(z)
    left = abs(end - z)
    for _ in range(40):
        if left < 1e-13:
            break
        matrix = np.eye(2)
        for column, nudge in enumerate((small, 1j * small)):
            changed = (path.period(z + nudge)[0] - end) / small
            matrix[:, column] -= changed.real, changed.imag
        gain = np.array([(end - z).real, (end - z).imag])
        z, last = z + complex(*np.linalg.lstsq(matrix, gain, rcond=1e-9)[0]), left
        z = z / max(1.0, abs(z))
        end, mean = path.period(z)
        left = abs(end - z)
        if left > 0.5 * last:  # far from closing: two periods bring it nearer
            for _ in range(2):
                z = end
                end, mean = path.period(z)
            left = abs(end - z)
    return mean, left
