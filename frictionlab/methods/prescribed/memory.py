"""Laws with several memories or scalars under a prescribed slip: fixed point of their period map."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.interpret import interpreted
from frictionlab.laws.memory import MemoryLaw
from frictionlab.methods.base import Status
from frictionlab.methods.periodic.attraction import (
    Follow,
    Trail,
    corners,
    iterate_until_periodic,
    unknown_orbit,
)
from frictionlab.methods.periodic.continuation import DIFFERENTIATED, RECORDED, Curve, Wanted, answer_curve
from frictionlab.methods.periodic.fixed_point import Goal
from frictionlab.methods.periodic.period_map import size_of
from frictionlab.methods.periodic.setting import table_of_maps
from frictionlab.methods.prescribed.loop import PrescribedMean
from frictionlab.methods.prescribed.varying_slip import VaryingSlip
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.record import End, Orbit
from frictionlab.scene.body import BodyNumbers, Motion
from frictionlab.scene.scene import Scene
from frictionlab.scene.varying import packed
from frictionlab.theory.rest import friction_at_rest
from frictionlab.values.quantities import Floats

PERIODS = 100
"""Number of periods for which a memory that does not forget is followed from each start."""
FORGETS = 1.0 - 1e-6
"""Largest multiplier of a memory that converges from every start."""
FINE, SAME_MEAN = 1e-9, 1e-6
"""Accuracy of maps with which starts are followed, over the normal load, and largest range of equal means."""
HOLDS = "a deflection that never yields keeps what it began with"
WANDERS = "the memory does not converge from different starts"
TWO_STARTS = "2 starts ended here, with no memory and with that of steady sliding"


class MemoryPoint:
    """Scene of prescribed slip, law with memory, and the answer."""

    def __init__(self, scene: Scene, law: MemoryLaw, tolerance: float) -> None:
        self.motion, self.belt_speed = scene.motion(), scene.belt_speed
        self.law = law.under_load(self.motion.normal_load)
        self.zero: complex = 0.0 if scene.load_along_belt_only else 0j
        self.body = driven(self.motion, self.zero)
        self.maps = table_of_maps(self.law, self.body)
        self.slip = None if scene.is_harmonic else VaryingSlip.of(scene.signals(), self.motion.normal_load)
        self.status: Status = "ok"
        self.reason, self.model = "", str(ModelWord.PRESCRIBED_MEMORY)
        self.error_kind, self.seconds = "estimated", 0.0
        self.curve: Curve | None = None
        self.reached: list[Floats] = []
        self.tested = ""
        self.found = self._answer(tolerance) if self._fastest() > 0.0 else self._left_open([], "no slip")

    def _fastest(self) -> float:
        """Return a bound on the speed of the slip."""
        parts = self.motion.velocity, self.motion.transverse_velocity
        sizes = map(abs, parts) if self.slip is None else (self.slip.along.size(), self.slip.across.size())
        return abs(self.belt_speed) + sum(sizes)

    def _answer(self, tolerance: float) -> PrescribedMean:
        guess = np.zeros((1, interpreted(size_of)(self.law, self.zero)))
        self.goal = Goal(tolerance, False, True, False)
        curve = self._called(guess, DIFFERENTIATED)
        multiplier = float(np.abs(np.linalg.eigvals(curve.matrices[0])).max())
        forgets = curve.closed.found[0] and curve.reached[0] and multiplier <= FORGETS
        if not forgets or (self.belt_speed == 0.0 and self.law.memory_kind == "deflections"):
            # On a belt at rest a slider that never yields keeps the deflection it began with.
            starts = corners(self.maps, self.law, guess[0].size, (0j, 0j), self._fastest())
            means = [*self._followed_from(starts), *(curve.closed.mean.tolist() if forgets else ())]
            if self.belt_speed == 0.0 and self.slip is None and self.law.obeys("oddness"):
                # The mirror image of a state is a state half a period later.
                means += [-mean for mean in means]
            if not forgets or max(means) - min(means) > max(float(curve.closed.error[0]), SAME_MEAN):
                return self._left_open(means, WANDERS if self.law.memory_kind == "scalars" else HOLDS)
        self.curve = curve
        constants = curve.reached[0] * -math.log(max(multiplier, 1e-300))
        self.tested = (
            f"tested: {TWO_STARTS}, each followed for {constants:.2g} or more of the slowest time constant"
        )
        closed = curve.closed
        return PrescribedMean(complex(closed.mean[0], closed.across[0]), closed.error[0])

    def _called(self, states: Floats, wanted: Wanted) -> Curve:
        arguments = self.body.periods, np.array([self.belt_speed]), states, self.goal, wanted
        curve, seconds = KernelCall(answer_curve).timed(self.maps, *arguments)
        self.seconds += seconds
        return curve

    def _followed_from(self, starts: list[Floats]) -> list[float]:
        """Return the mean of the last period from each start; keep the states reached."""
        means: list[float] = []
        for start in starts:
            each, states = np.empty(PERIODS), np.empty((PERIODS + 1, len(start)))
            states[0] = start
            how = Follow(FINE * self.motion.normal_load, False)
            orbit, trail = unknown_orbit(len(start)), Trail(each, states)
            arguments = self.maps, self.belt_speed, self.body.periods, how, orbit, trail
            (_, count), seconds = KernelCall(iterate_until_periodic).timed(*arguments)
            self.seconds += seconds
            means.append(float(each[count - 1]))
            self.reached.append(states[count])
        return means

    def _left_open(self, means: list[float], reason: str) -> PrescribedMean:
        self.status, self.error_kind = "not_unique", ""
        most = friction_at_rest(self.law)
        self.reason = f"{reason}: the mean depends on the start"
        low, high = (min(means), max(means)) if means else (-most, most)
        return PrescribedMean(low=low, high=high)

    def orbit(self) -> Orbit | None:
        """Return one period of the prescribed motion with its friction; None if the memory was not found."""
        return None if self.curve is None else self._recorded(self.curve.states)

    def ends(self) -> list[End]:
        """Return where starts ended, that from rest last, if the mean depends on the start."""
        reached = (state[None] for state in self.reached if self.status == "not_unique")
        return [End(self._recorded(state), self.goal.tolerance) for state in reached]

    def _recorded(self, states: Floats) -> Orbit:
        found = self._called(states, RECORDED)
        track, end = found.orbits, found.ends[0]
        tau, x, v, friction, stick = (
            part[:end] for part in (track.tau, track.x, track.v, track.friction, track.stick)
        )
        return Orbit(tau, x, v, friction, stick) if self.slip is None else self.slip.orbit(tau, friction)


def driven(motion: Motion, zero: complex) -> BodyNumbers:
    """Return a body whose motion is prescribed; its spring and dashpot only give the units of a state.

    A sine is the reference motion of the body. For any other slip the body stays at rest, and the belt moves
    with the opposite velocity.
    """
    omega, across, varying = motion.frequency, motion.transverse_velocity, _moved_belt(motion.varying, zero)
    share = 0.0 if varying else 1.0 / omega
    sine = share * complex(motion.velocity.imag, across.imag)
    cosine = -share * complex(motion.velocity.real, across.real)
    parts: Any = (sine, cosine, 0j) if isinstance(zero, complex) else (sine.real, cosine.real, 0.0)
    return BodyNumbers(
        damping_mean=2.0,
        damping_split=0.0,
        stiffness_mean=1.0,
        stiffness_split=0.0,
        normal_load=motion.normal_load,
        frequency=omega,
        load_sine=parts[2],
        load_cosine=parts[2],
        balanced_sine=parts[2],
        balanced_cosine=parts[2],
        reference_sine=parts[0],
        reference_cosine=parts[1],
        periods=varying.whole.periods if varying else 1.0,
        prescribed=True,
        varying=varying,
    )


def _moved_belt(varying: Any, zero: complex) -> Any:
    """Return the time-varying parts of a motion with the motion of the belt in place of that of the body."""
    if not varying:
        return varying
    moved = varying._replace(belt=varying.belt.scaled(-1.0))
    return packed(moved, isinstance(zero, complex))
