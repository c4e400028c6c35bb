"""Laws with several memories or scalars under a prescribed slip: fixed point of their period map."""

from __future__ import annotations

import math
from itertools import product
from typing import Any

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.interpret import interpreted
from frictionlab.laws.memory import MemoryLaw
from frictionlab.methods.base import Status
from frictionlab.methods.periodic.attraction import (
    Follow,
    Trail,
    iterate_until_periodic,
    unknown_orbit,
    write_start,
)
from frictionlab.methods.periodic.continuation import DIFFERENTIATED, RECORDED, Curve, Wanted, answer_curve
from frictionlab.methods.periodic.fixed_point import Goal
from frictionlab.methods.periodic.period_map import size_of
from frictionlab.methods.periodic.setting import table_of_maps
from frictionlab.methods.prescribed.loop import PrescribedMean
from frictionlab.methods.prescribed.varying_slip import VaryingSlip
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.record import Orbit
from frictionlab.scene.body import BodyNumbers, Motion
from frictionlab.scene.scene import Scene
from frictionlab.scene.varying import packed
from frictionlab.theory.rest import friction_at_rest
from frictionlab.values.quantities import Floats

PERIODS = 100
"""Number of periods for which a memory that does not forget is followed from each start."""
FORGETS = 1.0 - 1e-6
"""Largest multiplier of a memory that converges from every start."""
MOST_CORNERS = 4
"""Largest number of deflections whose starts are tried in all combinations of direction.

If there are more, all deflections start in one direction, then all in the other."""
INSIDE = 0.999
"""Fraction of the deflection of steady sliding at which starts begin.

At the limit itself rounding would decide whether an element yields."""
ROUGH, FINE, SAME_MEAN = 1e-6, 1e-9, 1e-6
"""Accuracies of maps with which starts are followed, over the normal load, and largest range of equal means.

The range is that of means found with fine maps."""
HOLDS = "a deflection that never yields keeps what it began with"
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
        self.from_rest: Floats | None = None
        self.tested = ""
        moves = self.belt_speed != 0.0 or self._swing() > 0.0
        self.found = self._answer(tolerance) if moves else self._left_open([], "no slip")

    def _swing(self) -> float:
        """Return a bound on the speed of the oscillation."""
        if self.slip is not None:
            return self.slip.along.size() + self.slip.across.size()
        return abs(self.motion.velocity) + abs(self.motion.transverse_velocity)

    def _answer(self, tolerance: float) -> PrescribedMean:
        guess = np.zeros((1, interpreted(size_of)(self.law, self.zero)))
        self.goal = Goal(tolerance, False, True, False)
        curve = self._called(guess, DIFFERENTIATED)
        multiplier = float(np.abs(np.linalg.eigvals(curve.matrices[0])).max())
        if not curve.closed.found[0] or not curve.reached[0] or multiplier > FORGETS:
            return self._followed(guess[0])
        if self.belt_speed == 0.0 and self.law.memory_kind == "deflections":
            # The belt is at rest: a slider that never yields keeps the deflection it began with. The mirror
            # image of a state is a state half a period later.
            means = [float(curve.closed.mean[0]), *self._followed_from(self._corners(guess[0].size), FINE)]
            if self.slip is None and self.law.obeys("oddness"):
                means += [-mean for mean in means]
            if max(means) - min(means) > max(float(curve.closed.error[0]), SAME_MEAN):
                self.from_rest = curve.states[0]
                return self._left_open(means, HOLDS)
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

    def _followed(self, state: Floats) -> PrescribedMean:
        """Follow the memory from steady sliding in either direction, then from rest; keep the last state."""
        swing, starts = self._swing() + abs(self.belt_speed), []
        for side in (1.0, -1.0, 0.0):
            KernelCall(write_start)(self.maps, (0j, 0j, complex(side * swing)), state)
            starts.append(state.copy())
        return self._left_open(
            self._followed_from(starts), "the memory does not converge from different starts"
        )

    def _corners(self, size: int) -> list[Floats]:
        """Return starts with deflections as in steady sliding in either direction; the last is from rest."""
        sides = np.empty((3, size))
        for row, side in enumerate((1.0, -1.0, 0.0)):
            KernelCall(write_start)(self.maps, (0j, 0j, complex(side * self._swing())), sides[row])
        moved = np.flatnonzero(sides[0] != sides[1])
        choices = product((0, 1), repeat=len(moved)) if len(moved) <= MOST_CORNERS else [(0,), (1,)]
        corners = []
        for choice in choices:
            corner = sides[2].copy()
            corner[moved] = INSIDE * sides[np.broadcast_to(choice, moved.shape), moved]
            corners.append(corner)
        return [*corners, sides[2]]

    def _followed_from(self, starts: list[Floats], accuracy: float = ROUGH) -> list[float]:
        """Return the mean of the last period from each start; keep the state reached from the last start.

        A start is left out if its state repeats only after two periods or more: it is then at a limit, where
        rounding decides whether an element yields.
        """
        means: list[float] = []
        for start in starts:
            each, states = np.empty(PERIODS), np.empty((PERIODS + 1, len(start)))
            states[0] = start
            how = Follow(accuracy * self.motion.normal_load, False)
            orbit, trail = unknown_orbit(len(start)), Trail(each, states)
            arguments = self.maps, self.belt_speed, self.body.periods, how, orbit, trail
            (repeats, count), seconds = KernelCall(iterate_until_periodic).timed(*arguments)
            self.seconds += seconds
            if repeats <= 1:
                means.append(float(each[count - 1]))
            self.from_rest = states[count]
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

    def orbit_from_rest(self) -> Orbit | None:
        """Return the orbit of the memory followed from rest, if the mean depends on the start; else None."""
        return None if self.from_rest is None else self._recorded(self.from_rest[None])

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
