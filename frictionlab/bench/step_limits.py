"""Largest steps: largest step times rate at which a perturbation does not grow, predicted and measured.

Measured by root finding on the factor that one step, taken by the solver's own code, multiplies a perturbation with.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache, partial

import numpy as np

from frictionlab.bench.peers.one_period import growth_by_scipy
from frictionlab.compile.interpret import interpreted
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.methods.march.laps import MarchState
from frictionlab.methods.march.run import MarchRun
from frictionlab.methods.march.steppers import Resolution, StepperName
from frictionlab.motion.steppers import dop853, rk4
from frictionlab.scene.scene import Drive, Load, Scene, Transverse

PREDICTED = {"rk4": rk4.DECAY, "dop853": 6.394, "RK23": 2.513, "RK45": 3.307, "DOP853": 6.394}
"""Real axis: where the stability polynomial of an explicit formula leaves the unit disk."""
CLOSE_ROOT = 1e-4
"""Relative width of the bracket that a measured limit is found to."""
LONGEST_STEP = 1e4
"""Times rate; a perturbation that has not grown by then grows at no step."""
MANY_STEPS = 400
"""Steps that are tried, between the shortest and the longest, for the first at which a perturbation grows."""
WEAK, QUICK = 1e-12, 1e4
"""A friction that moves no mass, and a rate beside which springs are slow."""


def predicted_limit(stepper: str, theta: float = 0.5) -> float:
    """By theory; infinite where no step is too long."""
    if stepper == "moreau":
        return 2.0 / (1.0 - 2.0 * theta) if theta < 0.5 else math.inf
    return PREDICTED.get(stepper, math.inf)


def measured_limit(growth: Callable[[float], float]) -> float:
    """Least step times rate from which on growth(step times rate) exceeds 1; infinite where it never does."""
    trials = np.geomspace(0.1, LONGEST_STEP, MANY_STEPS)
    above = next((i for i, z in enumerate(trials) if growth(float(z)) > 1.0 + 1e-9), None)
    if not above:
        return math.inf if above is None else 0.0
    low, high = float(trials[above - 1]), float(trials[above])
    while high - low > CLOSE_ROOT * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if growth(middle) > 1.0 else (middle, high)
    return 0.5 * (low + high)


@cache
def stepper_limit(stepper: StepperName, theta: float, memory: str) -> float:
    """Return the measured limit of a stepper of march, on bristles or on slip in the plane."""
    if stepper == "smoothed":
        return measured_limit(_growth_of_dop853)
    grows = _growth_of_bristles if memory == "bristle" else _growth_across
    return measured_limit(lambda z: grows(stepper, theta, z))


def _growth_of_bristles(stepper: StepperName, theta: float, z: float) -> float:
    """Growth of a deflection, under a slip that nothing changes: the difference of two steps."""
    drive, law = Drive(amplitude=WEAK, frequency=2.0 * math.pi / z), Dahl(mu=0.4, stiffness=0.4 / QUICK)
    scene = Scene(damping_ratio=0.0, normal_load=WEAK, belt_speed=QUICK, drive=drive)
    starts = (MarchState(0j, 0j, np.array([bent])) for bent in (0j, 1.0 + 0j))
    straight, bent = (_one_step(scene, law, stepper, theta, start).z[0] for start in starts)
    return abs(complex(bent - straight))


def _growth_across(stepper: StepperName, theta: float, z: float) -> float:
    """Growth of a small velocity across the belt, while the spring balances friction along it."""
    small, drive = 1e-6, Drive(amplitude=0.0, frequency=2.0 * math.pi * QUICK / z)
    across = Transverse(natural_frequency=1e-3, damping_ratio=0.0, load=Load(amplitude=WEAK))
    load = QUICK / 0.4
    scene = Scene(damping_ratio=0, normal_load=load, belt_speed=1, drive=drive, transverse=across)
    end = _one_step(scene, Coulomb(mu=0.4), stepper, theta, MarchState(complex(QUICK), complex(0.0, small)))
    return abs(end.v.imag) / small


def _one_step(
    scene: Scene, law: FrictionLaw, stepper: StepperName, theta: float, start: MarchState
) -> MarchState:
    """A lap of one step."""
    return MarchRun(scene, law, stepper).run(Resolution(steps=1, most=1, theta=theta), start).place


def _decay(problem: None, stage: int, tau: float, x: float, v: float) -> tuple[float, float]:
    return -v, 0.0


def _growth_of_dop853(z: float) -> float:
    """Growth of a velocity that decays at the rate 1."""
    step = interpreted(dop853.stepper(_decay, dop853.unprepared))
    return abs(float(step(None, 0.0, dop853.State(0.0, 1.0, -1.0, 0.0), z).v))


@cache
def peer_limit(name: str, memory: str = "") -> float:
    """Return the measured limit of a peer's steps, whatever the law: LSODA changes its formula, heyoka its order."""
    return math.inf if name in ("LSODA", "heyoka") else measured_limit(partial(growth_by_scipy, name))
