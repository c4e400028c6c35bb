"""scipy's integrators as most people call them: the equations of motion as they stand, no events."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, ClassVar, Literal

import numpy as np

from frictionlab.bench.peers.base import ClosureTest, Peer, closed_mean
from frictionlab.bench.peers.equations import Equations, OnBristles, Sliding
from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene

MOST_CALLS, MOST_BRISTLE_CALLS = 500_000, 5_000_000
"""Of the equations of motion per scene: where friction jumps, step control can grind for ever."""
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


def _settled(equations: Equations, solver: str, tolerance: float) -> Floats:
    closing = ClosureTest(tolerance, equations.mass.normal_load, equations.period)
    return closed_mean(
        lambda state: one_period(equations, state, solver, tolerance),
        equations.start,
        equations.places,
        closing,
        equations.period,
    )


def one_period(equations: Equations, state: Floats, solver: str, tolerance: float) -> Floats:
    """The state at the end, by ``odeint`` or a solver of solve_ivp. Raises ArithmeticError where it gives up."""
    settings: dict[str, Any] = {"rtol": max(tolerance, LEAST_RTOL), "atol": tolerance * equations.scales}
    if solver != "odeint":
        return by_solve_ivp(equations, state, solver, settings).y[:, -1]
    from scipy.integrate import odeint

    settings |= {"mxstep": MOST_ODEINT_STEPS}
    with warnings.catch_warnings(action="ignore"):  # its message says the same
        found, told = odeint(
            equations, state, [0.0, equations.period], tfirst=True, full_output=True, **settings
        )
    if told["message"] != "Integration successful.":
        raise ArithmeticError(f"odeint: {told['message']}")
    return found[-1]


def by_solve_ivp(equations: Equations, state: Floats, solver: str, settings: dict[str, Any]) -> Any:
    """What solve_ivp finds over a period. Raises ArithmeticError where it gives up."""
    from scipy.integrate import solve_ivp

    found = solve_ivp(equations, (0.0, equations.period), state, method=solver, **settings)
    if found.status < 0:
        raise ArithmeticError(f"solve_ivp: {found.message}")
    return found
