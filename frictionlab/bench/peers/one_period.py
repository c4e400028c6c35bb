"""One period of a motion by solvers of other libraries, at a tolerance, from a given state."""

from __future__ import annotations

import math
import warnings
from functools import lru_cache
from typing import Any

import numpy as np

from frictionlab.bench.peers.equations import (
    LEAST_RTOL,
    Creeping,
    Equations,
    OnBristles,
    Sliding,
    by_solve_ivp,
)
from frictionlab.bench.peers.heyoka_taylor import plane_system
from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene
from frictionlab.values.quantities import Floats

SOLVE_IVP_METHODS = "RK23", "RK45", "DOP853", "Radau", "LSODA"
MOST_CALLS_OF_A_PERIOD = 200_000
"""Most calls of the equations of motion."""
HUGE = 1e300
"""A tolerance at which every step passes."""


def equations_of(scene: Scene, law: FrictionLaw, width: float | None) -> Equations:
    """Equations of motion as a user would type them in; width: of smoothed friction, None for what it is."""
    if law.memory_kind == "bristle":
        return OnBristles(scene, law, MOST_CALLS_OF_A_PERIOD)
    if width is None:
        return Sliding(scene, law, MOST_CALLS_OF_A_PERIOD)
    creeping = Creeping(scene, law, MOST_CALLS_OF_A_PERIOD)
    creeping.width = width
    return creeping


def by_scipy(solver: str, equations: Equations, state: Floats, tolerance: float) -> tuple[float, float]:
    """Mean friction over one period, and the usual step. Raises ArithmeticError or ValueError where it gives up.

    The last number of the state is the integral of the friction coefficient.
    """
    settings = {"rtol": max(tolerance, LEAST_RTOL), "atol": tolerance}
    with warnings.catch_warnings(action="ignore"), np.errstate(all="ignore"):
        found = by_solve_ivp(equations, state, solver, settings)
    return -float(found.y[-1, -1]) / equations.period, float(np.median(np.diff(found.t)))


def growth_by_scipy(solver: str, z: float) -> float:
    """Return what one step of this length, forced on the solver, multiplies y of y' = -y with."""
    from scipy import integrate

    settings: dict[str, Any] = {"first_step": z, "max_step": z, "rtol": 1e-3, "atol": HUGE}
    one: Any = getattr(integrate, solver)(lambda t, y: -y, 0.0, np.ones(1), 1e9, **settings)
    one.step()
    return abs(float(one.y[0]))


def by_heyoka(
    scene: Scene, law: FrictionLaw, state: Floats, width: float | None, tolerance: float
) -> tuple[float, float]:
    """Return the same of smoothed friction along the belt, or of slip in the plane."""
    mass, friction = scene.mass(), law.sliding_friction(1.0)
    period = 2.0 * math.pi / mass.frequency
    integrator = _creep(tolerance) if width is not None else _plane(tolerance)
    along = mass.force.real, mass.damping, mass.normal_load, friction, scene.belt_speed
    across = mass.transverse_force.real, mass.transverse_damping, mass.transverse_stiffness
    integrator.pars[:] = (*along, *across) if width is None else (*along, width)
    integrator.time, integrator.state[:] = 0.0, state
    outcome, _, _, steps, *_ = integrator.propagate_until(period)
    mean = -float(integrator.state[-1]) / period
    if "time_limit" not in str(outcome) or not math.isfinite(mean):
        raise ArithmeticError(f"heyoka: {outcome}")
    return mean, period / max(1, steps)


@lru_cache(maxsize=128)
def _creep(tolerance: float) -> Any:
    """(x1, v1, x2, v2, integral of the friction coefficient), drive at frequency 1."""
    import heyoka as hy

    x, v, x2, v2, friction_impulse = hy.make_vars("x", "v", "x2", "v2", "friction_impulse")
    force, damping, load, mu, belt, width = (hy.par[i] for i in range(6))
    rub = mu * hy.tanh((v - belt) / width)
    rate = force * hy.sin(hy.time) - damping * v - x - load * rub
    system = [(x, v), (v, rate), (x2, 0.0 * x2), (v2, 0.0 * v2), (friction_impulse, rub)]
    return hy.taylor_adaptive(system, [0.0] * 5, pars=[0.0] * 6, tol=tolerance)


@lru_cache(maxsize=128)
def _plane(tolerance: float) -> Any:
    """Return the same of slip in the plane."""
    import heyoka as hy

    force, damping, load, mu, belt, force_2, damping_2, stiffness_2 = (hy.par[i] for i in range(8))
    mass: Any = Mass(damping, 1.0, damping_2, stiffness_2, load, 1.0, force, force_2)
    loads = force * hy.sin(hy.time), force_2 * hy.sin(hy.time)
    system = plane_system(mass, mu, belt, loads)
    return hy.taylor_adaptive(system, [0.0] * 5, pars=[0.0] * 8, tol=tolerance)
