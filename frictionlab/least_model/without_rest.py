"""Stick taken away: the motion along the belt that slips throughout, forward once a period and backward once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.least_model.lesser import LesserModel
from frictionlab.methods.reduced.common import Harmonic, line_means, line_refusal, steadied, steadied_all
from frictionlab.methods.reduced.two_reversals import Line, motions_at
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.theory.linear import friction_free_velocity

NOT_SINES = "the motion without rest is known for one sine along the belt under a constant normal load"
NO_SUCH_MOTION = "no motion without rest reverses twice a period"


def slipping(model: LesserModel) -> LesserModel | None:
    """The motion that never rests."""
    return None if model.scene.degrees_of_freedom == 0 else model.with_way(WithoutRest())


class WithoutRest:
    """The motion of two reversals a period with all its harmonics, consistent with friction at rest or not."""

    name = "two reversals"

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Anything but Coulomb friction along the belt under one sine."""
        steady = steadied(scene)
        return NOT_SINES if steady is None else line_refusal("the motion without rest", steady, law)

    def model_means(self, scenes: Sequence[Scene], law: FrictionLaw) -> Floats:
        """Of that motion; NaN where there is none."""
        return line_means(steadied_all(scenes), law, _two_reversals)


def _two_reversals(scene: Scene, friction: float, belt_speeds: Floats) -> Harmonic:
    """Its mean is one less twice the share of forward slip; from V_lin on slip does not reverse."""
    mass, free = scene.mass(), friction_free_velocity(scene)
    reverses = belt_speeds < free
    line = Line(0.5 * mass.damping, mass.frequency, friction, free)
    found = motions_at(line, np.where(reverses, belt_speeds, 0.0))
    mean = np.where(reverses, np.where(np.isnan(found.belt_speed), np.nan, 1.0 - 2.0 * found.share), 1.0)
    reasons = [NO_SUCH_MOTION if missing else "" for missing in np.isnan(mean)]
    return Harmonic(mean, np.full(len(mean), np.nan + 0j), reasons)
