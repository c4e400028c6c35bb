"""The kinds of motion on which orders are measured: one scene and law each.

What is refined: the steps, widths or tolerances of every solver, and its errors on a motion at each of them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from frictionlab.bench.measure import solve_points
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.stribeck import Stribeck
from frictionlab.methods.base import Method
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.march.run import MarchResult, MarchRun
from frictionlab.methods.march.steppers import Resolution, StepperName
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Drive, Load, Scene, Transverse
from frictionlab.values.quantities import Floats

_RESONANCE = Scene(
    damping_ratio=0.1, normal_load=10.0, belt_speed=20.0, drive=Drive(amplitude=10.0, frequency=1.0)
)
"""Strong friction at resonance: without friction the velocity has the amplitude 50."""
_MOSTLY_HELD = Scene(
    damping_ratio=0.1, normal_load=10.0, belt_speed=1.0, drive=Drive(amplitude=2.5, frequency=0.5)
)
"""The load is below friction: the mass sticks most of the time."""
_IN_PHASE = Scene(
    damping_ratio=0.1,
    normal_load=1.0,
    belt_speed=5.0,
    drive=Drive(unbalance=10.0, frequency=4.0),
    transverse=Transverse(natural_frequency=1.0, damping_ratio=0.1, load=Load(unbalance=10.0)),
)
"""Both velocities swing in phase, with 43: slip turns round twice a period at 0.7 of the belt's speed."""
_OFF_RESONANCE = Scene(
    damping_ratio=0.1, normal_load=10.0, belt_speed=45.0, drive=Drive(amplitude=30.0, frequency=1.5)
)
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
    KindOfMotion("smooth", "slip without reversal", _OFF_RESONANCE, _FALLING, "Stribeck, falling", False),
    KindOfMotion("crossing", "slip reverses", _RESONANCE, _COULOMB, "Coulomb", True),
    KindOfMotion("grazing", "slip just reaches rest", _RESONANCE.at(50.0), _COULOMB, "Coulomb", True),
    KindOfMotion("stick", "mostly stick", _MOSTLY_HELD, _COULOMB, "Coulomb", True),
    KindOfMotion(
        "bristle_dragged", "bristles, no reversal", _OFF_RESONANCE, _DRAGGED, "LuGre, falling", False
    ),
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
WIDEST, WIDTHS, ACCURACY = 2.0, 12, 1e-12
LOOSEST, TOLERANCES = 1e-2, 9


class Refinement(NamedTuple):
    """Errors of the mean friction at settings of one kind, coarse to fine; sizes: step, width or tolerance."""

    setting: str
    values: list[float]
    sizes: Floats
    errors: Floats


@dataclass(frozen=True)
class FixedSteps:
    """A stepper of march with steps of one length."""

    name: str
    stepper: StepperName
    memory: tuple[str, ...]
    theta: float = 0.5

    def refusal(self, motion: KindOfMotion) -> str | None:
        """Laws of another kind."""
        return None if motion.law.memory_kind in self.memory else "another kind of law"

    def refined(self, motion: KindOfMotion, mean: float, samples: int) -> Refinement:
        """Root mean squares over grids: where slip reverses within a step decides how large the error is.

        Each grid has its own phase and its own number of steps, the latter since two reversals in a period have
        always the same distance.
        """
        first = max(COARSEST_STEPS, MarchRun(motion.scene, motion.law, self.stepper).fewest())
        halvings = max(FEWEST, min(HALVINGS, 1 + int(math.log2(FINEST_STEPS / first))))
        grids = samples if motion.irregular else 1
        errors = [self._errors(motion, first, grid, grids, halvings, mean) for grid in range(grids)]
        counts = [float(first * 2**k) for k in range(halvings)]
        return Refinement(
            "steps", counts, 1.0 / np.array(counts), np.sqrt(np.mean(np.square(errors), axis=0))
        )

    def _errors(
        self, motion: KindOfMotion, first: int, grid: int, grids: int, halvings: int, mean: float
    ) -> list[float]:
        steps = first + grid * first // (2 * grids)
        errors: list[float] = []
        run: MarchResult | None = None
        for k in range(halvings):
            shift = 360.0 / (steps * 2**k) * ((grid * GOLDEN_PHASE) % 1.0)
            march = MarchRun(with_phase(motion.scene, shift), motion.law, self.stepper)
            pace = Resolution(
                steps=steps * 2**k, refined=2**k, theta=self.theta, enough=CLOSED_ORBIT, most=LAPS
            )
            run = march.run(pace, None if run is None else run.place)
            errors.append(run.mean.real - mean if run.settled else math.nan)
        return errors


@dataclass(frozen=True)
class Widths:
    """Smoothed friction, its steps so short that the width alone matters."""

    name: str = "smoothed"

    def refusal(self, motion: KindOfMotion) -> str | None:
        """Laws with memory."""
        return None if motion.law.memory_kind == "none" else "another kind of law"

    def refined(self, motion: KindOfMotion, mean: float, samples: int) -> Refinement:
        """By halves."""
        march, errors = MarchRun(motion.scene, motion.law, "smoothed"), list[float]()
        widths = [WIDEST * 0.5**k for k in range(WIDTHS)]
        run: MarchResult | None = None
        for width in widths:
            pace = Resolution(width=width, accuracy=ACCURACY, enough=100.0 * ACCURACY, most=LAPS)
            run = march.run(pace, None if run is None else run.place)
            errors.append(abs(run.mean.real - mean) if run.settled else math.nan)
        return Refinement("width", widths, np.array(widths), np.array(errors))


@dataclass(frozen=True)
class Tolerances:
    """A method that is asked for a tolerance."""

    name: str
    method: Method

    def refusal(self, motion: KindOfMotion) -> str | None:
        """The method's own."""
        return self.method.refusal(motion.scene, motion.law)

    def refined(self, motion: KindOfMotion, mean: float, samples: int) -> Refinement:
        """By tenths."""
        asked = [LOOSEST * 0.1**k for k in range(TOLERANCES)]
        errors = [
            abs(float(solve_points(self.method, [motion.scene], motion.law, tolerance).means[0]) - mean)
            for tolerance in asked
        ]
        return Refinement("tolerance", asked, np.array(asked), np.array(errors))


def with_phase(scene: Scene, degrees: float) -> Scene:
    """The scene as it is so much later in its period: the same mean friction."""
    assert scene.drive is not None
    later: dict[str, Any] = {"drive": scene.drive.model_copy(update={"phase": scene.drive.phase + degrees})}
    if scene.transverse is not None and scene.transverse.load is not None:
        load = scene.transverse.load
        load = load.model_copy(update={"phase": load.phase + degrees})
        later |= {"transverse": scene.transverse.model_copy(update={"load": load})}
    return scene.model_copy(update=later)


OrderSolver = FixedSteps | Widths | Tolerances
"""A solver whose order is measured."""
_ALL_SOLVERS: tuple[OrderSolver, ...] = (
    FixedSteps("rk4", "rk4", ("none", "bristle")),
    FixedSteps("moreau_0.5", "moreau", ("none",), 0.5),
    FixedSteps("moreau_1", "moreau", ("none",), 1.0),
    FixedSteps("sdirk2", "sdirk2", ("bristle",)),
    Widths(),
    Tolerances("shooting", Shooting()),
    Tolerances("exact", Exact()),
)
ORDER_SOLVERS: dict[str, OrderSolver] = {solver.name: solver for solver in _ALL_SOLVERS}
"""By name, in the order of tables and pictures."""
