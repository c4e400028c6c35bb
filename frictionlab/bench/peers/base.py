"""Base class of peers: computation of mean friction by another library, without an error bound."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from importlib.util import find_spec
from typing import ClassVar

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.scene import Scene
from frictionlab.values.quantities import Floats, Record

NOISE_PERIODS = 8
"""Consecutive periods without a smaller gap: the rest is the error of the integrator."""
LONGEST_TRANSIENT = 5000


def closed_mean(
    one_period: Callable[[Floats], Floats], state: Floats, places: slice, period: float, enough: float
) -> Floats:
    """Return the mean friction of a motion, or of one a column, period by period until it closes.

    state: its last number is the integral of the friction coefficient, from zero in each period; places: those of
    positions and velocities. enough: a gap that counts as closed: the change of velocity that a mean friction of the
    tolerance makes in a period. Raises ArithmeticError for a motion that does not close.
    """
    least, since = math.inf, 0
    for _ in range(LONGEST_TRANSIENT):
        end = one_period(state)
        gap = float(np.max(np.linalg.norm((end - state)[places], axis=0)))
        if not math.isfinite(gap):
            raise ArithmeticError("the state is not finite")
        least, since = min(gap, least), 0 if gap < least else since + 1
        if gap <= enough or since >= NOISE_PERIODS:
            return -end[-1] / period
        state = end.copy()
        state[-1] = 0.0
    raise ArithmeticError(f"the motion has not closed after {LONGEST_TRANSIENT} periods")


class Peer(Record, ABC):
    """Steady states by another library; its fields are the settings a bench list may give."""

    name: ClassVar[str]
    package: ClassVar[str]
    remedy: ClassVar[str] = "pip install frictionlab[peers]"
    together: ClassVar[bool] = False
    """True if it solves many scenes at once for less than one after another."""

    def missing(self) -> str | None:
        """Return how to install it where it is not; None where it is."""
        return None if find_spec(self.package) else f"not installed: {self.remedy}"

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Why this peer cannot do this scene and law, or is not there; None when it can."""
        if (told := self.missing() or self.other_law(law)) is not None:
            return told
        if scene.degrees_of_freedom == 0 or scene.undriven:
            return f"{self.name} is set up for driven scenes with a mass"
        return None

    def other_law(self, law: FrictionLaw) -> str | None:
        """Why this peer cannot do this law; None when it can."""
        if law.constant_sliding_friction() and law.monotone():
            return None
        return f"{self.name} is set up for Coulomb friction, the same at rest and in slip"

    @abstractmethod
    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Floats:
        """Return the mean friction of scenes that differ in belt speed alone.

        Raises ArithmeticError, with a reason, where the integrator gives up.
        """
