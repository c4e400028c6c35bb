"""Direct separation of motion where more than sines of one frequency changes in time: the friction-free motion of a
linear body under any waveform, over any vibrating belt, and the mean of friction over it."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers
from frictionlab.methods.prescribed.varying_slip import VaryingPoint, VaryingSlip, piece_at
from frictionlab.methods.reduced.common import Modelled, far_from_full, judged
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.theory.linear import friction_free_response, less
from frictionlab.theory.rest import stays_at_rest

AVERAGED = "direct separation of motion: friction averaged over the friction-free motion of these waveforms"
MAY_STAY = "the belt is at rest and static friction holds the mass: it may rest anywhere in a range"


class FreeMotions:
    """The friction-free motion of a scene, its slip velocity about the belt's mean speed, and its position."""

    def __init__(self, scene: Scene, law: FrictionLaw) -> None:
        assert scene.normal_load is not None
        prescribed = VaryingSlip.of(
            scene.signals(), scene.normal_load
        )  # of the belt, under the same normal load
        velocity, position = (friction_free_response(scene, law, order) for order in (1, 0))
        assert velocity is not None
        assert position is not None
        self.velocity, self.position = velocity, position
        belt = prescribed.along, prescribed.across
        along, across = (less(own, other) for own, other in zip(velocity, belt, strict=True))
        waves = (*along.waves, *across.waves, *prescribed.normal_load.waves)
        quickest = max([scene.frequency, 1.0, *(wave.frequency for wave in waves)])
        self.slip = VaryingSlip(along, across, prescribed.normal_load, quickest)

    def orbit(self, point: VaryingPoint, at: complex) -> Orbit:
        """This motion about a mean position, and friction along it."""
        tau, friction = point.friction()
        k = piece_at(self.slip.along.edges, 0.5 * (tau[:, :1] + tau[:, -1:]))
        x, v = (one.at(tau, k)[0] + 1j * other.at(tau, k)[0] for one, other in (self.position, self.velocity))
        return Orbit(tau, at + x, v, friction, None)


def waveform_means(scenes: Sequence[Scene], law: FrictionLaw) -> NDArray[np.complex128]:
    """The mean friction over the friction-free motion, without its error; NaN where there is none."""
    points = [VaryingPoint(scene, law, FreeMotions(scene, law).slip) for scene in scenes]
    return np.array([point.found.mean if point.status == "ok" else complex(np.nan) for point in points])


def answer_waveforms(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """Answers on scenes that differ in belt speed alone, their error from the mean of the full problem."""
    start = time.perf_counter()
    motions = [FreeMotions(scene, law) for scene in scenes]
    points = [VaryingPoint(scene, law, free.slip) for scene, free in zip(scenes, motions, strict=True)]
    means = np.array([point.found.mean for point in points])
    against = [_against(scene, law, point) for scene, point in zip(scenes, points, strict=True)]
    left_out = far_from_full(scenes, law, means.real, against)
    errors: Floats = left_out.error + np.array([point.found.error for point in points])

    def orbit(i: int) -> Orbit:
        mass = scenes[i].mass()
        mean = means[i]
        return motions[i].orbit(
            points[i], mass.normal_load * complex(mean.real, mean.imag / mass.transverse_stiffness)
        )

    found = Modelled(means, errors, time.perf_counter() - start)
    answers = judged(found, left_out.reasons, AVERAGED, tolerance, orbit)
    return replace(answers, period=np.where(np.isnan(answers.error), np.nan, float(scenes[0].periods)))


def _against(scene: Scene, law: FrictionLaw, point: VaryingPoint) -> str:
    """Why there is no one mean over the friction-free motion, or of the full problem; else empty."""
    if point.status != "ok":
        return point.reason
    return MAY_STAY if stays_at_rest(scene, law) else ""
