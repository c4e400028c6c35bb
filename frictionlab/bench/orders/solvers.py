"""What is refined: the steps, widths or tolerances of every solver, and its errors on a motion at each of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from frictionlab.bench.orders.motions import KindOfMotion
from frictionlab.bench.solvers import solve_points
from frictionlab.methods.base import Method
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.march.run import MarchResult, MarchRun
from frictionlab.methods.march.steppers import Resolution, StepperName
from frictionlab.methods.shooting.method import Shooting
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene

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
_ALL: tuple[OrderSolver, ...] = (
    FixedSteps("rk4", "rk4", ("none", "bristle")),
    FixedSteps("moreau_0.5", "moreau", ("none",), 0.5),
    FixedSteps("moreau_1", "moreau", ("none",), 1.0),
    FixedSteps("exponential", "exponential", ("bristle",)),
    FixedSteps("sdirk2", "sdirk2", ("bristle",)),
    Widths(),
    Tolerances("shooting", Shooting()),
    Tolerances("exact", Exact()),
)
ORDER_SOLVERS: dict[str, OrderSolver] = {solver.name: solver for solver in _ALL}
"""By name, in the order of tables and pictures."""
