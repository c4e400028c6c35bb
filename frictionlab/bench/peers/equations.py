"""Equations of motion as a user of an integrator types them in: called with time and state, they give the rates.

scipy's integrators as most people call them: the equations of motion as they stand, no events.
"""

from __future__ import annotations

import cmath
import math
import warnings
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, ClassVar, Literal

import numpy as np

from frictionlab.bench.peers.base import Peer, closed_mean
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import bristle_in_the_plane, bristle_on_the_line
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene
from frictionlab.values.quantities import Floats


def free_orbit(damping: float, stiffness: float, frequency: float, force: complex) -> tuple[float, float]:
    """Position and velocity at t = 0 of the friction-free response; rest at undamped resonance."""
    dynamic = complex(stiffness - frequency**2, damping * frequency)
    response = force / dynamic if dynamic != 0 else 0j
    return response.imag, (1j * frequency * response).imag


def start(mass: Mass) -> tuple[float, float, float, float]:
    """x1, v1, x2, v2 on the friction-free orbit at t = 0."""
    across = mass.transverse_damping, mass.transverse_stiffness, mass.frequency, mass.transverse_force
    return (*free_orbit(mass.damping, mass.stiffness, mass.frequency, mass.force), *free_orbit(*across))


class Equations(ABC):
    """Equations of one scene. The last number of a state is the integral of the friction coefficient along x1.

    places: those of positions and velocities in a state; scales: what an absolute tolerance is told in, by number.
    Raises ArithmeticError after ``most_calls``.
    """

    places = slice(0, 4)

    def __init__(self, scene: Scene, most_calls: int) -> None:
        self.mass: Mass = scene.mass()
        self.belt_speed, self.period = scene.belt_speed, 2.0 * math.pi / self.mass.frequency
        self.calls, self.most_calls, self.turning = 0, most_calls, 1j * self.mass.frequency
        self.start = np.array([*start(self.mass), 0.0])
        self.scales = np.ones(5)

    def __call__(self, t: float, y: Floats) -> list[float]:
        """Return the rates."""
        self.calls += 1
        if self.calls > self.most_calls:
            raise ArithmeticError(f"gave up after {self.most_calls} calls of the equations of motion")
        return self.rates(cmath.exp(self.turning * t), y.tolist())

    @abstractmethod
    def rates(self, turn: complex, y: list[float]) -> list[float]:
        """Return the same where the drive has turned so far."""


class Sliding(Equations):
    """Constant friction against the slip: x1, v1, x2, v2 and that integral."""

    def __init__(self, scene: Scene, law: FrictionLaw, most_calls: int) -> None:
        super().__init__(scene, most_calls)
        self.friction, self.straight = law.sliding_friction(1.0), self.mass.transverse_force == 0

    def rates(self, turn: complex, y: list[float]) -> list[float]:
        m = self.mass
        x1, v1, x2, v2, _ = y
        slip = v1 - self.belt_speed
        speed = abs(slip) if self.straight else math.hypot(slip, v2)
        rub = self.friction / speed if speed > 0.0 else 0.0
        a1 = (m.force * turn).imag - m.damping * v1 - x1 - m.normal_load * rub * slip
        if self.straight:
            return [v1, a1, 0.0, 0.0, rub * slip]
        across = m.transverse_damping * v2 + m.transverse_stiffness * x2 + m.normal_load * rub * v2
        return [v1, a1, v2, (m.transverse_force * turn).imag - across, rub * slip]


class Creeping(Sliding):
    """Same along the belt, with friction smoothed by tanh over a width."""

    width: float

    def rates(self, turn: complex, y: list[float]) -> list[float]:
        m, x, v = self.mass, y[0], y[1]
        rub = self.friction * math.tanh((v - self.belt_speed) / self.width)
        return [v, (m.force * turn).imag - m.damping * v - x - m.normal_load * rub, 0.0, 0.0, rub]


class _Plain:
    """A law's own formulas on its bare numbers, as a user would type them in: no checks on the way."""

    def __init__(self, law: FrictionLaw) -> None:
        self.__dict__.update(law.numbers())
        for formula in ("rate", "friction"):
            setattr(self, formula, getattr(type(law), formula).__get__(self))


class OnBristles(Equations):
    """Formulas of a bristle law, on the line of x, v, z and that integral, in the plane of x1, v1, x2, v2, z1, z2
    and that integral.

    An absolute tolerance of a deflection is told in deflections of steady slip where these are small.
    """

    def __init__(self, scene: Scene, law: FrictionLaw, most_calls: int) -> None:
        super().__init__(scene, most_calls)
        ready: Any = law.under_load(self.mass.normal_load)
        self.law: Any = _Plain(ready)
        self.planar = not scene.load_along_belt_only
        x1, v1, x2, v2, _ = self.start.tolist()
        reach = min(1.0, ready.sliding_friction(0.0) / ready.bristle_stiffness)
        if self.planar:
            self.start, self.scales = np.array([x1, v1, x2, v2, 0.0, 0.0, 0.0]), np.ones(7)
            self.scales[4:6] = reach
        else:
            self.start, self.scales = np.array([x1, v1, 0.0, 0.0]), np.array([1.0, 1.0, reach, 1.0])
            self.places = slice(0, 2)

    def rates(self, turn: complex, y: list[float]) -> list[float]:
        m = self.mass
        if not self.planar:
            x, v, z, _ = y
            dz, rub = bristle_on_the_line(self.law, v - self.belt_speed, z)
            return [v, (m.force * turn).imag - m.damping * v - m.stiffness * x - m.normal_load * rub, dz, rub]
        x1, v1, x2, v2, z1, z2, _ = y
        dz, rub = bristle_in_the_plane(self.law, complex(v1 - self.belt_speed, v2), complex(z1, z2))
        a1 = (m.force * turn).imag - m.damping * v1 - m.stiffness * x1 - m.normal_load * rub.real
        across = m.transverse_damping * v2 + m.transverse_stiffness * x2 + m.normal_load * rub.imag
        a2 = (m.transverse_force * turn).imag - across
        return [v1, a1, v2, a2, dz.real, dz.imag, rub.real]


MOST_CALLS, MOST_BRISTLE_CALLS = 500_000, 5_000_000
"""Most calls of the equations of motion per scene: where friction jumps, step control can grind for ever."""
MOST_ODEINT_STEPS = 1_000_000
"""Per period: odeint's own default of 500 is too few for stiff bristles."""
LEAST_RTOL = 3e-14


class ScipySteps(Peer):
    """solve_ivp on the equations of motion, blind to reversals, from the friction-free orbit until it closes.

    solver: DOP853 (default), RK45, LSODA or Radau; rtol and atol are the tolerance.
    """

    name: ClassVar[str] = "scipy"
    package: ClassVar[str] = "scipy"

    solver: Literal["DOP853", "RK45", "LSODA", "Radau"] = "DOP853"

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Floats:
        """One scene after the other."""
        equations = (Sliding(scene, law, MOST_CALLS) for scene in scenes)
        return np.array([_settled(each, self.solver, tolerance) for each in equations])


class ScipyBristle(Peer):
    """scipy on bristle laws, from the friction-free orbit with bristles at rest until the period closes.

    solver: LSODA (default; by odeint, whose loop is compiled), or Radau or BDF by solve_ivp. rtol and atol are the
    tolerance, atol of the deflection in deflections of steady slip.
    """

    name: ClassVar[str] = "scipy_bristle"
    package: ClassVar[str] = "scipy"

    solver: Literal["LSODA", "Radau", "BDF"] = "LSODA"

    def other_law(self, law: FrictionLaw) -> str | None:
        """Everything but bristle laws."""
        return None if law.memory_kind == "bristle" else "scipy_bristle is set up for bristle laws"

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Floats:
        """One scene after the other."""
        solver = "odeint" if self.solver == "LSODA" else self.solver
        equations = (OnBristles(scene, law, MOST_BRISTLE_CALLS) for scene in scenes)
        return np.array([_settled(each, solver, tolerance) for each in equations])


def _settled(motion: Equations, solver: str, tolerance: float) -> Floats:
    def period(state: Floats) -> Floats:
        return one_period(motion, state, solver, tolerance)

    enough = tolerance * motion.mass.normal_load * motion.period
    return closed_mean(period, motion.start, motion.places, motion.period, enough)


def one_period(equations: Equations, state: Floats, solver: str, tolerance: float) -> Floats:
    """State at the end, by ``odeint`` or a solver of solve_ivp. Raises ArithmeticError where it gives up."""
    settings: dict[str, Any] = {"rtol": max(tolerance, LEAST_RTOL), "atol": tolerance * equations.scales}
    if solver != "odeint":
        return by_solve_ivp(equations, state, solver, settings).y[:, -1]
    from scipy.integrate import odeint

    settings |= {"mxstep": MOST_ODEINT_STEPS, "tfirst": True, "full_output": True}
    with warnings.catch_warnings(action="ignore"):  # its message says the same
        found, told = odeint(equations, state, [0.0, equations.period], **settings)
    if told["message"] != "Integration successful.":
        raise ArithmeticError(f"odeint: {told['message']}")
    return found[-1]


def by_solve_ivp(equations: Equations, state: Floats, solver: str, settings: dict[str, Any]) -> Any:
    """Return what solve_ivp finds over a period. Raises ArithmeticError where it gives up."""
    from scipy.integrate import solve_ivp

    found = solve_ivp(equations, (0.0, equations.period), state, method=solver, **settings)
    if found.status < 0:
        raise ArithmeticError(f"solve_ivp: {found.message}")
    return found
