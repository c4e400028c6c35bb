"""A mass on bristles as an integrator of the interpreted law sees it: state, deflection and the work in progress."""

from __future__ import annotations

import cmath
import math
from typing import Any

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import bristle_in_the_plane, bristle_on_the_line
from frictionlab.quantities import Floats
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene


class _Plain:
    """A law's own formulas on its bare numbers, as a user would type them in: no checks on the way."""

    def __init__(self, law: FrictionLaw) -> None:
        self.__dict__.update(law.numbers())
        for formula in ("rate", "friction"):
            setattr(self, formula, getattr(type(law), formula).__get__(self))


class BristleMotion:
    """The equations of motion of one scene: called with time and state, they give the rates.

    On the line the state is x, v, z and the integral of the friction coefficient along x1; in the plane x1, v1, x2,
    v2, z1, z2 and that integral. Raises ArithmeticError after ``most_calls``.
    """

    def __init__(self, scene: Scene, law: FrictionLaw, most_calls: int) -> None:
        self.mass: Mass = scene.mass()
        self.law: Any = _Plain(law.under_load(self.mass.normal_load))
        self.belt_speed, self.planar = scene.belt_speed, not scene.load_along_belt_only
        self.period = 2.0 * math.pi / self.mass.frequency
        self.calls, self.most_calls = 0, most_calls

    def __call__(self, t: float, y: Floats) -> list[float]:
        """The rates."""
        self.calls += 1
        if self.calls > self.most_calls:
            raise ArithmeticError(f"gave up after {self.most_calls} calls of the equations of motion")
        turn = cmath.exp(1j * self.mass.frequency * t)
        return self._in_the_plane(turn, y) if self.planar else self._on_the_line(turn, y)

    def _on_the_line(self, turn: complex, y: Floats) -> list[float]:
        m = self.mass
        x, v, z, _ = y.tolist()
        dz, rub = bristle_on_the_line(self.law, v - self.belt_speed, z)
        return [v, (m.force * turn).imag - m.damping * v - m.stiffness * x - m.normal_load * rub, dz, rub]

    def _in_the_plane(self, turn: complex, y: Floats) -> list[float]:
        m = self.mass
        x1, v1, x2, v2, z1, z2, _ = y.tolist()
        dz, rub = bristle_in_the_plane(self.law, complex(v1 - self.belt_speed, v2), complex(z1, z2))
        a1 = (m.force * turn).imag - m.damping * v1 - m.stiffness * x1 - m.normal_load * rub.real
        across = m.transverse_damping * v2 + m.transverse_stiffness * x2 + m.normal_load * rub.imag
        a2 = (m.transverse_force * turn).imag - across
        return [v1, a1, v2, a2, dz.real, dz.imag, rub.real]
