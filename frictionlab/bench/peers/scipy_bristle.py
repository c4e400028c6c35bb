"""scipy's stiff integrators on a mass on bristles: the equations of motion with the law's own formulas."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, ClassVar, Literal

import numpy as np

from frictionlab.bench.peers.base import ClosureTest, Peer, closed_mean
from frictionlab.bench.peers.bristle_motion import BristleMotion
from frictionlab.bench.peers.scipy_steps import start
from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene

MOST_BRISTLE_CALLS = 5_000_000
"""Of the equations of motion per scene."""
MOST_ODEINT_STEPS = 1_000_000
"""Per period: odeint's own default of 500 is too few for stiff bristles."""


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
        return np.array([_settled(scene, law, self.solver, tolerance) for scene in scenes])


def _settled(scene: Scene, law: FrictionLaw, solver: str, tolerance: float) -> float:
    motion = BristleMotion(scene, law, MOST_BRISTLE_CALLS)
    x1, v1, x2, v2 = start(motion.mass)
    state = np.array([x1, v1, x2, v2, 0.0, 0.0, 0.0] if motion.planar else [x1, v1, 0.0, 0.0])
    places = slice(0, 4) if motion.planar else slice(0, 2)
    sizes = absolute_scales(motion, law, scene)
    closing = ClosureTest(tolerance, motion.mass.normal_load, motion.period)

    def next_state(state: Floats) -> Floats:
        return one_period(motion, state, solver, max(tolerance, 3e-14), tolerance * sizes)

    return closed_mean(next_state, state, places, closing, motion.period)


def absolute_scales(motion: BristleMotion, law: FrictionLaw, scene: Scene) -> Floats:
    """What atol is told in: one, but for deflections, whose own scale may be far smaller."""
    ready: Any = law.under_load(motion.mass.normal_load)
    reach = min(1.0, ready.sliding_friction(0.0) / ready.bristle_stiffness)
    return np.array([1.0] * 4 + [reach] * 2 + [1.0] if motion.planar else [1.0, 1.0, reach, 1.0])


def one_period(motion: BristleMotion, state: Floats, solver: str, rtol: float, atol: Floats) -> Floats:
    """The state at the end. Raises ArithmeticError where the integrator gives up."""
    if solver == "LSODA":
        return _odeint(motion, state, rtol, atol)
    from scipy.integrate import solve_ivp

    settings: dict[str, Any] = {"method": solver, "rtol": rtol, "atol": atol}
    found = solve_ivp(motion, (0.0, motion.period), state, t_eval=[motion.period], **settings)
    if found.status < 0:
        raise ArithmeticError(f"solve_ivp: {found.message}")
    return found.y[:, -1]


def _odeint(motion: BristleMotion, state: Floats, rtol: float, atol: Floats) -> Floats:
    from scipy.integrate import odeint

    settings: dict[str, Any] = {"rtol": rtol, "atol": atol, "mxstep": MOST_ODEINT_STEPS}
    with warnings.catch_warnings(action="ignore"):  # its message says the same
        found, told = odeint(motion, state, [0.0, motion.period], tfirst=True, full_output=True, **settings)
    if told["message"] != "Integration successful.":
        raise ArithmeticError(f"odeint: {told['message']}")
    return found[-1]
