"""All that march knows of a stepper, but for its step: what it suits, what a study may give it, order and limits."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple

from frictionlab.dynamics.smoothing import ARCTAN, SQUARE_ROOT, TANH
from frictionlab.methods.march.adapters import Exponential, Moreau, Rk4, Sdirk2, Smoothed, Stepper
from frictionlab.numerics.steppers import exponential, rk4

StepperName = Literal["moreau", "rk4", "smoothed", "exponential", "sdirk2"]
SMOOTHINGS = {"tanh": TANH, "square_root": SQUARE_ROOT, "arctan": ARCTAN}


@dataclass(frozen=True)
class Resolution:
    """How finely to step, and how well to close: numbers of one run."""

    steps: int = 1  # per period of the drive, or per 2 pi; of fixed steps
    theta: float = 0.5
    width: float = 1.0
    smoothing: str = "tanh"
    accuracy: float = 1.0  # of each adaptive step, in the norm of energy
    enough: float = 0.0  # distance from the closed orbit, in the same norm
    most: int = 1  # laps
    work: int = 1_000_000_000  # steps
    refined: int = 1  # times as many as in the coarsest run: a power of two
    rate: float = 0.0  # at which gaps are known to shrink, 0: unknown


class StepperFacts(NamedTuple):
    """What is known of a stepper.

    kinds: of memory that it steps. keys: of a study, beside ``periods``. order: on smooth motion, by theta.
    record: its numbers in a run. held: largest stable step times frequency of a mass held by its contact. decay:
    largest stable step times decay rate of the memory, infinite where that does not limit steps. bears_jumps: whether
    rates may jump at yield. gridded: whether it meets loads at half steps alone. adaptive: whether it chooses its
    steps. sticks: whether it knows a mass at rest on the belt.
    """

    kinds: tuple[str, ...]
    keys: tuple[str, ...]
    order: Callable[[float], int]
    record: Callable[[Resolution], Stepper]
    held: float = math.inf
    decay: float = math.inf
    bears_jumps: bool = True
    gridded: bool = False
    adaptive: bool = False
    sticks: bool = False

    @property
    def limited_by_rates(self) -> bool:
        """Whether the decay of the memory limits steps, too."""
        return math.isfinite(self.decay)

    def is_blind(self, kind: str) -> bool:
        """Whether it steps over the rest of a law with this kind of memory, which is then chatter about rest."""
        return kind == "none" and not (self.sticks or self.adaptive)


STEPPERS: dict[StepperName, StepperFacts] = {
    "moreau": StepperFacts(
        ("none",),
        ("theta", "steps"),
        lambda theta: 2 if theta == 0.5 else 1,
        lambda pace: Moreau(pace.theta),
        gridded=True,
        sticks=True,
    ),
    "exponential": StepperFacts(
        ("bristle",), ("steps",), lambda _: 2, lambda _: Exponential(), held=exponential.DECAY, gridded=True
    ),
    "rk4": StepperFacts(
        ("none", "bristle", "deflections", "scalars"),
        ("steps",),
        lambda _: 4,
        lambda _: Rk4(),
        held=rk4.DECAY,
        decay=rk4.DECAY,
        gridded=True,
    ),
    "smoothed": StepperFacts(
        ("none",),
        ("width", "smoothing"),
        lambda _: 8,
        lambda pace: Smoothed(pace.width, SMOOTHINGS[pace.smoothing], pace.accuracy),
        adaptive=True,
    ),
    "sdirk2": StepperFacts(("bristle",), ("steps",), lambda _: 2, lambda _: Sdirk2(), bears_jumps=False),
}
"""Of each kind of memory, the first that steps it is taken where none is named."""


def steppers_of(kind: str) -> list[StepperName]:
    """Those that step a law with this kind of memory; none for a kind that march does not know."""
    return [name for name, facts in STEPPERS.items() if kind in facts.kinds]
