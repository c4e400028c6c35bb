"""Time stepping where the slip is prescribed: there is nothing to step, only friction to sample and to sum up.

Licence (tests/benchmarks/specialists.py, 10 scenes): 36 times faster in the median at 1e-3 than the laps of march
with a mass that friction does not move (15 to 87 times), 120 times at 1e-4.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import inner
from frictionlab.compile.interpret import interpreted
from frictionlab.dynamics.motion import mean_friction
from frictionlab.dynamics.smoothing import share
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Status
from frictionlab.methods.march.answers import PointAnswer
from frictionlab.methods.march.error import COARSEST, ROUNDING, Plan
from frictionlab.methods.march.prescribed_slip import slip_at_angle
from frictionlab.methods.march.run import SHAPES
from frictionlab.methods.prescribed.quadrature import orbit_of_slip
from frictionlab.numerics.richardson import bias
from frictionlab.orbit.record import Orbit
from frictionlab.scene.body import Motion
from frictionlab.scene.scene import Scene

MOST_SAMPLES = 1 << 21


class SampledMean(NamedTuple):
    """Mean coefficient over one period, and what samples may miss of it."""

    mean: complex
    error: float


@inner
def _friction(law: Any, w: complex, width: float, shape: float) -> complex:
    speed = math.sqrt(w.real * w.real + w.imag * w.imag)
    if speed == 0.0:
        return 0j
    rub = law.sliding_vector(w)
    return share(shape, speed / width) * rub if width > 0.0 else rub


@inner
def sample_friction(
    law: Any, motion: Motion, belt_speed: float, n: int, width: float, shape: float
) -> SampledMean:
    """The midpoint rule with n samples.

    Between its samples friction may jump anywhere: a jump costs up to half of it times the spacing. Second
    differences count each jump twice, and vanish with the square of the spacing where friction is smooth.
    """
    # Two samples of the period before, so that every second difference is of three neighbours.
    total, bent = 0j, 0.0
    before, now = (
        _friction(law, slip_at_angle(motion, belt_speed, -3.0 * math.pi / n, 0j), width, shape),
        _friction(law, slip_at_angle(motion, belt_speed, -math.pi / n, 0j), width, shape),
    )
    for i in range(n):
        after = _friction(
            law, slip_at_angle(motion, belt_speed, (2.0 * i + 1.0) * math.pi / n, 0j), width, shape
        )
        bent += abs(after - 2.0 * now + before)
        before, now = now, after
        total += after
    return SampledMean(mean_friction(total, n), 0.25 * bent / n)


class SampledPoint:
    """One scene of prescribed slip, sampled."""

    def __init__(self, scene: Scene, law: FrictionLaw, tolerance: float, plan: Plan) -> None:
        self.scene, self.law, self.motion = scene, law, scene.motion()
        self.width = plan.width if plan.stepper == "smoothed" else 0.0
        self.shape, self.seconds = SHAPES[plan.smoothing], 0.0
        n = plan.steps or COARSEST
        found = self._sampled(n, self.width)
        while plan.steps is None and found.error > 0.5 * tolerance and n < MOST_SAMPLES:
            n *= 2
            found = self._sampled(n, self.width)
        error = found.error + ROUNDING
        if self.width > 0.0:
            others = [self._sampled(n, part * self.width) for part in (2.0, 0.5, 0.25)]
            wide, narrow, narrowest = (other.mean.real for other in others)
            error += bias(wide, found.mean.real, narrow, narrowest) + others[-1].error
        self.model = f"prescribed slip: friction at {n} samples per period"
        self.reason = f"the error is above the tolerance {tolerance:.1e}" if error > tolerance else ""
        self.status: Status = "ok"
        self.answer = PointAnswer(found.mean, error, 1.0)

    def _sampled(self, n: int, width: float) -> SampledMean:
        call = KernelCall(sample_friction, self.law)
        found, seconds = call.timed(self.motion, self.scene.belt_speed, n, width, self.shape)
        self.seconds += seconds
        return found

    def orbit(self) -> Orbit:
        """The prescribed motion and the friction along it."""
        motion, speed = self.motion, self.scene.belt_speed
        orbit = orbit_of_slip(motion, speed, self.law, 0j)
        if self.width == 0.0:
            return orbit
        smooth = [interpreted(share)(self.shape, abs(w) / self.width) for w in (orbit.v - speed).ravel()]
        return replace(orbit, friction=np.reshape(smooth, orbit.v.shape) * orbit.friction)
