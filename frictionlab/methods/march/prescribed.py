"""Time stepping where the slip is prescribed: there is nothing to step, only friction to sample and to sum up.

Licence (10 scenes): 36 times faster in the median at 1e-3 than the laps of march
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
from frictionlab.dynamics.motion import in_piece, mean_friction, pieces_of
from frictionlab.dynamics.smoothing import share
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Status
from frictionlab.methods.march.adapters import in_shares
from frictionlab.methods.march.answers import PointAnswer
from frictionlab.methods.march.error import COARSEST, ROUNDING, Plan
from frictionlab.methods.march.prescribed_slip import load_at_angle, piece_angles, slip_at_angle, whole_angle
from frictionlab.methods.march.steppers import SMOOTHINGS
from frictionlab.methods.prescribed.memory import driven
from frictionlab.methods.prescribed.quadrature import orbit_of_slip
from frictionlab.methods.prescribed.varying_slip import VaryingPoint
from frictionlab.numerics.richardson import bias
from frictionlab.orbit.record import Orbit
from frictionlab.scene.scene import Scene

MOST_SAMPLES = 1 << 21


class SampledMean(NamedTuple):
    """Mean coefficient over one period, and what samples may miss of it."""

    mean: complex
    error: float


class Sampling(NamedTuple):
    """The slip, and over which slip speed and by which shape the jump of friction at rest is smoothed."""

    motion: Any  # a Motion; a Body whose belt moves where the slip is no sine (prescribed_slip.py)
    belt_speed: float
    width: float  # 0: not at all
    shape: float


@inner
def _friction(law: Any, how: Sampling, angle: float) -> complex:
    """In shares of the mean normal load."""
    w = slip_at_angle(how.motion, how.belt_speed, angle, 0j)
    speed = math.sqrt(w.real * w.real + w.imag * w.imag)
    if speed == 0.0:
        return 0j
    rub = in_shares(how.motion, load_at_angle(how.motion, angle), law.sliding_vector(w))
    return share(how.shape, speed / how.width) * rub if how.width > 0.0 else rub


@inner
def _sample_piece(law: Any, how: Sampling, first: float, half: float, n: int, beyond: int) -> SampledMean:
    """The midpoint rule with n samples over twice the angle ``half`` from the angle ``first`` on.

    Between its samples friction may jump anywhere: a jump costs up to half of it times the spacing. Second
    differences count each jump twice, and vanish with the square of the spacing where friction is smooth.
    """
    # Two samples from before, so that every second difference is of three neighbours; where what comes after is no
    # repetition, as many from beyond.
    total, bent = 0j, 0.0
    before, now = (
        _friction(law, how, first + (-3.0 * half) / n),
        _friction(law, how, first + -half / n),
    )
    for i in range(n + beyond):
        after = _friction(law, how, first + ((2.0 * i + 1.0) * half) / n)
        bent += abs(after - 2.0 * now + before)
        before, now = now, after
        total += after if i < n else 0j
    return SampledMean(mean_friction(total, n), 0.25 * bent / n)


@inner
def sample_friction(law: Any, how: Sampling, n: int) -> SampledMean:
    """The mean over a period of everything, of n samples per period of the slip, corner by corner."""
    mean, error, beyond = 0j, 0.0, 0 if pieces_of(how.motion) == 1 else 1
    for k in range(pieces_of(how.motion)):
        first, goes = piece_angles(how.motion, k)
        own = max(1, math.ceil(n * (goes / (2.0 * math.pi)) - 1e-9))
        piece = Sampling(in_piece(how.motion, k), how.belt_speed, how.width, how.shape)
        found, weight = (
            _sample_piece(law, piece, first, 0.5 * goes, own, beyond),
            goes / whole_angle(how.motion),
        )
        mean, error = mean + weight * found.mean, error + weight * found.error
    return SampledMean(mean, error)


class SampledPoint:
    """One scene of prescribed slip, sampled."""

    def __init__(self, scene: Scene, law: FrictionLaw, tolerance: float, plan: Plan) -> None:
        self.scene, self.law, self.motion = scene, law, scene.motion()
        self.moved = self.motion if scene.is_harmonic else driven(self.motion, 0j)
        self.width = plan.width if plan.stepper == "smoothed" else 0.0
        self.shape, self.seconds = SMOOTHINGS[plan.smoothing], 0.0
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
        self.answer = PointAnswer(found.mean, error, 1.0 if scene.is_harmonic else float(scene.periods))
        if not scene.is_harmonic:
            self._leave_open_at_rest()

    def _leave_open_at_rest(self) -> None:
        """Where slip rests for a while no sample tells friction."""
        known = VaryingPoint(self.scene, self.law)
        if known.status != "ok":
            self.status, self.reason = known.status, known.reason
            self.answer = PointAnswer(low=known.found.low, high=known.found.high)

    def _sampled(self, n: int, width: float) -> SampledMean:
        call = KernelCall(sample_friction, self.law)
        found, seconds = call.timed(Sampling(self.moved, self.scene.belt_speed, width, self.shape), n)
        self.seconds += seconds
        return found

    def orbit(self) -> Orbit | None:
        """The prescribed motion and the friction along it."""
        speed = self.scene.belt_speed
        orbit = self._unsmoothed()
        if self.width == 0.0 or orbit is None:
            return orbit
        smooth = [interpreted(share)(self.shape, abs(w) / self.width) for w in (orbit.v - speed).ravel()]
        return replace(orbit, friction=np.reshape(smooth, orbit.v.shape) * orbit.friction)

    def _unsmoothed(self) -> Orbit | None:
        if self.scene.is_harmonic:
            return orbit_of_slip(self.motion, self.scene.belt_speed, self.law, 0j)
        return VaryingPoint(self.scene, self.law).orbit()
