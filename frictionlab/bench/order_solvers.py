"""Kinds of motion on which orders are measured: one scene and law each.

What is refined: the steps, widths or tolerances of every solver, and its errors on a motion at each of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from frictionlab.bench.solve import solve_points
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.stribeck import Stribeck
from frictionlab.methods.base import Method
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.march.run import MarchRun
from frictionlab.methods.march.steppers import Resolution, StepperName
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Drive, Load, Scene, Transverse
from frictionlab.values.quantities import Floats

_RESONANCE = Scene(damping_ratio=0.1, normal_load=10, belt_speed=20, drive=Drive(amplitude=10, frequency=1))
"""Strong friction at resonance: without friction the velocity has the amplitude 50."""
_HELD = Scene(damping_ratio=0.1, normal_load=10, belt_speed=1, drive=Drive(amplitude=2.5, frequency=0.5))
"""Load is below friction: the mass sticks most of the time."""
_DRIVE = Drive(unbalance=10, frequency=4)
_ACROSS = Transverse(natural_frequency=1, damping_ratio=0.1, load=Load(unbalance=10))
_IN_PHASE = Scene(damping_ratio=0.1, normal_load=1, belt_speed=5, drive=_DRIVE, transverse=_ACROSS)
"""Both velocities swing in phase, with 43: slip turns round twice a period at 0.7 of the belt's speed."""
_QUICK = Scene(damping_ratio=0.1, normal_load=10, belt_speed=45, drive=Drive(amplitude=30, frequency=1.5))
"""Off resonance; without friction the velocity has the amplitude 35."""
_COULOMB = Coulomb(mu=0.4)
_FALLING = Stribeck(mu_kinetic=0.2, mu_static=0.4, stribeck_speed=40.0)
_DRAGGED = LuGre(mu_kinetic=0.2, mu_static=0.4, stribeck_speed=40.0, presliding_length=10.0)
_SOFT, _STIFF = LuGre(mu_kinetic=0.4, presliding_length=5.0), LuGre(mu_kinetic=0.4, presliding_length=0.5)


@dataclass(frozen=True)
class KindOfMotion:
    """A steady state whose errors are typical; law_text: in a few words.

    irregular: where in a step slip reverses or stick begins decides how large the error is.
    """

    name: str
    title: str
    scene: Scene
    law: FrictionLaw
    law_text: str
    irregular: bool


_ALL = (
    KindOfMotion("smooth", "slip without reversal", _QUICK, _FALLING, "Stribeck, falling", False),
    KindOfMotion("crossing", "slip reverses", _RESONANCE, _COULOMB, "Coulomb", True),
    KindOfMotion("grazing", "slip just reaches rest", _RESONANCE.at(50.0), _COULOMB, "Coulomb", True),
    KindOfMotion("stick", "mostly stick", _HELD, _COULOMB, "Coulomb", True),
    KindOfMotion("bristle_dragged", "bristles, no reversal", _QUICK, _DRAGGED, "LuGre, falling", False),
    KindOfMotion("bristle_soft", "soft bristles, 5 long", _RESONANCE, _SOFT, "LuGre", True),
    KindOfMotion("bristle_stiff", "stiff bristles, 0.5 long", _RESONANCE, _STIFF, "LuGre", True),
    KindOfMotion("plane_near_rest", "plane, slip passes near rest", _IN_PHASE, _COULOMB, "Coulomb", False),
)
MOTIONS: dict[str, KindOfMotion] = {motion.name: motion for motion in _ALL}
"""By name, in the order of tables and pictures."""


COARSEST_STEPS = 32
"""Steps per period to begin with, more where a stepper needs them."""
FINEST_STEPS = 40_000
"""Steps per period that the finest setting does not exceed, unless there would be fewer settings than FEWEST."""
HALVINGS, FEWEST = 10, 6
"""Settings of a step, and the fewest of one that must begin with many steps."""
CLOSED_ORBIT = 1e-13
"""Distance from the closed orbit, in the norm of energy."""
LAPS = 3000
GOLDEN_PHASE = 0.5 * (math.sqrt(5.0) - 1.0)
HALVED_WIDTHS = np.array([2.0 * 0.5**k for k in range(12)])
ACCURACY = 1e-12
"""Steps on smoothed friction, so short that the width alone matters."""
TOLERANCES = np.array([1e-2 * 0.1**k for k in range(9)])


class Refinement(NamedTuple):
    """Errors of the mean friction at settings of one kind, coarse to fine: steps, width or tolerance."""

    setting: str
    values: Floats
    errors: Floats


@dataclass(frozen=True)
class OrderSolver:
    """A solver whose order is measured; takes: whether it follows a motion, refined: its errors about a mean."""

    name: str
    takes: Callable[[KindOfMotion], bool]
    refined: Callable[[KindOfMotion, float, int], Refinement]


def _fixed_steps(name: str, stepper: StepperName, memory: Sequence[str], theta: float = 0.5) -> OrderSolver:
    """A stepper of march with steps of one length.

    Errors are root mean squares over grids: where slip reverses within a step decides how large the error is. Each
    grid has its own phase and its own number of steps, the latter since two reversals in a period have always the
    same distance.
    """

    def refined(motion: KindOfMotion, mean: float, samples: int) -> Refinement:
        first = max(COARSEST_STEPS, MarchRun(motion.scene, motion.law, stepper).fewest())
        halvings = max(FEWEST, min(HALVINGS, 1 + int(math.log2(FINEST_STEPS / first))))
        grids, doublings = samples if motion.irregular else 1, 2 ** np.arange(halvings)
        errors = np.empty((grids, halvings))
        for grid in range(grids):
            steps = ((first + grid * first // (2 * grids)) * doublings).tolist()
            told: dict[str, Any] = {"theta": theta, "enough": CLOSED_ORBIT, "most": LAPS}
            paces = [Resolution(steps=n, refined=n // steps[0], **told) for n in steps]
            shifts = [360.0 / n * ((grid * GOLDEN_PHASE) % 1.0) for n in steps]
            scenes = [with_phase(motion.scene, shift) for shift in shifts]
            errors[grid] = _run_through(scenes, motion, stepper, paces) - mean
        return Refinement(
            "steps", (first * doublings).astype(np.float64), np.sqrt(np.mean(errors**2, axis=0))
        )

    return OrderSolver(name, lambda motion: motion.law.memory_kind in memory, refined)


def _run_through(
    scenes: Sequence[Scene], motion: KindOfMotion, stepper: StepperName, paces: Sequence[Resolution]
) -> Floats:
    """Mean friction at each pace, begun from the orbit at the pace before; NaN where it does not settle."""
    means, run = list[float](), None
    for scene, pace in zip(scenes, paces, strict=True):
        run = MarchRun(scene, motion.law, stepper).run(pace, None if run is None else run.place)
        means.append(run.mean.real if run.settled else math.nan)
    return np.array(means)


def _by_width(motion: KindOfMotion, mean: float, samples: int) -> Refinement:
    """Friction smoothed over widths that are halved."""
    told: dict[str, Any] = {"accuracy": ACCURACY, "enough": 100.0 * ACCURACY, "most": LAPS}
    paces = [Resolution(width=width, **told) for width in HALVED_WIDTHS.tolist()]
    means = _run_through([motion.scene] * len(paces), motion, "smoothed", paces)
    return Refinement("width", HALVED_WIDTHS, np.abs(means - mean))


def _by_tolerance(method: Method) -> OrderSolver:
    """A method that is asked for a tenth of a tolerance, and again."""

    def refined(motion: KindOfMotion, mean: float, samples: int) -> Refinement:
        found = [solve_points(method, [motion.scene], motion.law, asked) for asked in TOLERANCES.tolist()]
        errors = np.abs(np.array([each["mean"].iloc[0] for each in found]) - mean)
        return Refinement("tolerance", TOLERANCES, errors)

    return OrderSolver(method.name, lambda motion: method.refusal(motion.scene, motion.law) is None, refined)


def with_phase(scene: Scene, degrees: float) -> Scene:
    """Return the scene as it is so much later in its period: the same mean friction."""
    assert scene.drive is not None
    later: dict[str, Any] = {"drive": scene.drive.model_copy(update={"phase": scene.drive.phase + degrees})}
    if scene.transverse is not None and scene.transverse.load is not None:
        load = scene.transverse.load
        load = load.model_copy(update={"phase": load.phase + degrees})
        later |= {"transverse": scene.transverse.model_copy(update={"load": load})}
    return scene.model_copy(update=later)


_ALL_SOLVERS = (
    _fixed_steps("rk4", "rk4", ("none", "bristle")),
    _fixed_steps("moreau_0.5", "moreau", ("none",), 0.5),
    _fixed_steps("moreau_1", "moreau", ("none",), 1.0),
    _fixed_steps("sdirk2", "sdirk2", ("bristle",)),
    OrderSolver("smoothed", lambda motion: motion.law.memory_kind == "none", _by_width),
    _by_tolerance(Shooting()),
    _by_tolerance(Exact()),
)
ORDER_SOLVERS = {solver.name: solver for solver in _ALL_SOLVERS}
"""By name, in the order of tables and pictures."""
