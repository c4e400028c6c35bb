"""A scene and a law with some of their parts taken away, and the way its motion is found."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene


class CannotGo(Exception):
    """Why a part of a model cannot be taken away, as a sentence."""


class MotionWay(Protocol):
    """A reduced model of the motion, as far as it is needed here: what it refuses, and its means without an error."""

    @property
    def name(self) -> str:
        """What it is called."""

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Why it cannot do this scene and law; None where it can."""

    def model_means(self, scenes: Sequence[Scene], law: FrictionLaw) -> Floats | NDArray[np.complex128]:
        """Mean friction of the model at scenes that differ in belt speed alone; NaN where it has none."""


@dataclass(frozen=True)
class LesserModel:
    """A scene at any belt speed and a law in its scales. way: the reduced model of the motion, None for ``auto``."""

    scene: Scene
    law: FrictionLaw
    way: MotionWay | None = None

    @property
    def method(self) -> MotionWay | str:
        """What solves it: a reduced model, or ``auto``."""
        return self.way or "auto"

    def with_scene(self, **changes: Any) -> LesserModel:
        """With other values of the scene, as ``Scene.with_`` takes them. Raises WrongValues."""
        return replace(self, scene=self.scene.with_(**changes))

    def with_law(self, law: FrictionLaw) -> LesserModel:
        """With another law."""
        return replace(self, law=law)

    def with_way(self, way: MotionWay) -> LesserModel:
        """With a reduced model of the motion. Raises CannotGo where that refuses."""
        if reason := way.refusal(self.scene, self.law):
            raise CannotGo(reason)
        return replace(self, way=way)


Taken = Callable[[LesserModel], LesserModel | None]
"""Takes a part away; None where the model has no such part. Raises CannotGo, WrongValues."""
