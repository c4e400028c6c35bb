"""A rung of the ladder that ``auto`` climbs: a smaller model of a whole curve, with an error that covers."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import ClassVar

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers
from frictionlab.scene.scene import Scene


class Rung(ABC):
    """A smaller model: what it leaves out, which curves it takes, and its answers with what that may cost."""

    name: ClassVar[str]
    """Of the method that finds its answers."""
    model: ClassVar[str]
    left_out: ClassVar[str]

    @abstractmethod
    def takes(self, scene: Scene, law: FrictionLaw) -> bool:
        """Whether it has an answer and an error for this scene and law, at some belt speeds at least."""

    @abstractmethod
    def may_meet(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> bool:
        """Whether its error can be below the tolerance at all of these belt speeds, as far as a few numbers tell.

        Of scenes that it takes. True may turn out false; False only forgoes the rung.
        """

    @abstractmethod
    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Answers, their error that of the model included, and refused where there is none."""
