"""Time stepping where the slip is prescribed: there is nothing to step, only friction to sample and to sum up.

Licence (tests/benchmarks/specialists.py, 10 scenes): 36 times faster in the median at 1e-3 than the laps of march
with a mass that friction does not move (15 to 87 times), 120 times at 1e-4.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.cache import compiled, timed
from frictionlab.compile.decorators import inner
from frictionlab.dynamics.smoothing import share
from frictionlab.laws.base import SlidingLaw
from frictionlab.methods.base import Answers
from frictionlab.methods.march.error import COARSEST, ROUNDING, Plan
from frictionlab.methods.march.run import SHAPES
from frictionlab.numerics.richardson import bias
from frictionlab.orbit.panels import NODES
from frictionlab.orbit.record import Orbit
from frictionlab.scene.body import Motion
from frictionlab.scene.scene import Scene

MOST_SAMPLES = 1 << 21
PANELS = 128
"""Of the record of an orbit."""


class Sampled(NamedTuple):
    """Over one period: mean coefficient, what samples may miss of it, heat and work per unit load, reversals."""

    mean: complex
    error: float
    contact: float
    taken: float
    reversals: int


@inner
def _friction(law: Any, w: complex, width: float, shape: float) -> complex:
    speed = math.sqrt(w.real * w.real + w.imag * w.imag)
    if speed == 0.0:
        return 0j
    rub = law.sliding_vector(w)
    return share(shape, speed / width) * rub if width > 0.0 else rub


@inner
def _at(motion: Motion, angle: float) -> complex:
    turn = complex(math.cos(angle), math.sin(angle))
    return complex((motion.velocity * turn).imag, (motion.transverse_velocity * turn).imag)


@inner
def sampled(law: Any, motion: Motion, belt_speed: float, n: int, width: float, shape: float) -> Sampled:
    """The midpoint rule with n samples.

    Between its samples friction may jump anywhere: a jump costs up to half of it times the spacing. Second
    differences count each jump twice, and vanish with the square of the spacing where friction is smooth.
    """
    total, contact, taken, bent, reversals = 0j, 0.0, 0.0, 0.0, 0
    last = _at(motion, -math.pi / n) - belt_speed
    before, now = (
        _friction(law, _at(motion, -3.0 * math.pi / n) - belt_speed, width, shape),
        _friction(law, last, width, shape),
    )
    for i in range(n):
        v = _at(motion, (2.0 * i + 1.0) * math.pi / n)
        w = v - belt_speed
        after = _friction(law, w, width, shape)
        bent += abs(after - 2.0 * now + before)
        reversals += 1 if w.real * last.real < 0.0 else 0
        before, now, last = now, after, w
        total += after
        contact += (after * w.conjugate()).real
        taken += (after * v.conjugate()).real
    period = 2.0 * math.pi / motion.frequency
    return Sampled(-total / n, 0.25 * bent / n, contact * period / n, taken * period / n, reversals)


def solve_sampled(scenes: Sequence[Scene], law: SlidingLaw, tolerance: float, plan: Plan) -> Answers:
    """Answer scenes of prescribed slip."""
    rows = [_Point(scene, law, tolerance, plan) for scene in scenes]
    return Answers(
        ["ok"] * len(rows),
        [row.reason for row in rows],
        [row.model for row in rows],
        ["estimated"] * len(rows),
        {name: np.array([row.columns[name] for row in rows]) for name in rows[0].columns},
        lambda i: rows[i].orbit(),
    )


class _Point:
    """One scene of prescribed slip, sampled."""

    def __init__(self, scene: Scene, law: SlidingLaw, tolerance: float, plan: Plan) -> None:
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
        self.columns = self._row(found, error)

    def _sampled(self, n: int, width: float) -> Sampled:
        call = compiled(sampled, self.law)
        found, seconds = timed(call, self.motion, self.scene.belt_speed, n, width, self.shape)
        self.seconds += seconds
        return found

    def _row(self, found: Sampled, error: float) -> dict[str, float]:
        planar, load = self.scene.transverse_slip is not None, self.motion.normal_load
        along, across = abs(self.motion.velocity), abs(self.motion.transverse_velocity)
        return {
            "mean_friction": found.mean.real,
            "error": error,
            "mean_friction_transverse": found.mean.imag if planar else math.nan,
            "velocity_amplitude": along,
            "velocity_harmonic": along,
            "transverse_velocity_amplitude": across if planar else math.nan,
            "transverse_velocity_harmonic": across if planar else math.nan,
            "stick_fraction": 0.0,
            "reversals": float(found.reversals),
            "energy_friction": load * found.taken,
            "energy_contact": load * found.contact,
            "period": 1.0,
            "seconds": self.seconds,
        }

    def orbit(self) -> Orbit:
        """The prescribed motion and the friction along it."""
        angle = (np.arange(PANELS)[:, None] + 0.5 * (1.0 + NODES)) * (2.0 * math.pi / PANELS)
        turn = np.exp(1j * angle)
        phasors = self.motion.velocity, self.motion.transverse_velocity
        v = (phasors[0] * turn).imag + 1j * (phasors[1] * turn).imag
        x = -((phasors[0] * turn).real + 1j * (phasors[1] * turn).real) / self.motion.frequency
        rub = np.array([self._rub(w) for w in (v - self.scene.belt_speed).ravel()]).reshape(v.shape)
        return Orbit(angle / self.motion.frequency, x, v, rub, np.zeros(PANELS, np.bool_))

    def _rub(self, w: complex) -> complex:
        if w == 0:
            return 0j
        smooth = share.py_func(self.shape, abs(w) / self.width) if self.width > 0.0 else 1.0
        return smooth * self.law.sliding_vector(w)
