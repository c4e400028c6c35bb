"""Any linear body as a mass that steps can follow and a force that repeats: what the body is beside that mass.

With D = 1/H the dynamic stiffness of a body and D_0 = m p^2 + c p + k that of a mass on a spring and a dashpot,

    D_0 x1 = load + f - friction,   f = (D_0 - D) x1.

For any such force f shooting closes the motion of the mass, with all its harmonics. The body's is the one whose
harmonics obey (1 - H D_0) x1 + H f = 0, one by one: found by Broyden's method from the motion without friction, or
from a neighbour's. m and c are those of the body at high frequencies, where f falls off by the frequency squared
faster than friction, so that few of its harmonics matter. On its spring the mass swings half as fast as everything
repeats, as far from resonance with all harmonics as can be.

Source: of such forces Darbre & Wolf, Earthquake Engineering & Structural Dynamics 16 (1988), 569-581.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.periodic.continuation import Curve, Wanted, answer_curve
from frictionlab.methods.periodic.fixed_point import Goal
from frictionlab.methods.periodic.setting import table_of_maps
from frictionlab.motion.orbit.record import Orbit
from frictionlab.motion.orbit.sample import phasors_of_panels
from frictionlab.scene.body import Mass, on_the_line
from frictionlab.scene.receptance import ComplexValues, LinearBody
from frictionlab.scene.scene import Scene
from frictionlab.scene.signals import Signal, Signals, Wave
from frictionlab.scene.varying import varying_of
from frictionlab.theory.rest import is_convergent
from frictionlab.values.quantities import Floats

MOST_BROYDEN_STEPS = 80
"""Of Broyden's method."""
SHORTER = (1.0, 0.4, 0.16, 0.06, 0.02)
"""Shares of a step that are tried while it leaves much more open."""
PATIENT_STEPS, DIFFERENTIATED_HARMONICS = 12, 4
"""Steps after which the derivatives of the lowest harmonics are taken by quotients."""
LEFT_OPEN = 0.05
"""Share of the tolerance on the mean that steps may still move it by."""
ROUGH_MEAN = 1e-5
"""Tolerance on the mean of motions on the way."""


class MassMotion(NamedTuple):
    """A motion of the mass under a force: its mean friction, the error of that, harmonics of x1 from the first and of
    the friction coefficient, and its kernel's answer."""

    mean: float
    error: float
    x: ComplexValues
    friction: ComplexValues
    curve: Curve

    @property
    def orbit(self) -> Orbit:
        """As it was recorded."""
        track, end = self.curve.orbits, self.curve.ends[0]
        return Orbit(*(part[:end] for part in (track.tau, track.x, track.v, track.friction, track.stick)))


class BalancedMotion(NamedTuple):
    """A motion of the body: the force on the mass, harmonics 1 ... n, real parts before imaginary ones [2 n]; the
    inverse [2 n, 2 n] of the derivatives of what is left open; by how much that may move the mean."""

    belt_speed: float
    force: Floats
    inverse: Floats
    motion: MassMotion
    left: float

    @property
    def harmonics(self) -> int:
        """How many."""
        return len(self.force) // 2


class MassUnderForce:
    """The mass, spring and dashpot in the place of a scene's body, under one more force."""

    def __init__(self, scene: Scene, law: FrictionLaw, body: LinearBody, tolerance: float) -> None:
        assert scene.normal_load is not None
        self.scene, self.law, self.body, self.tolerance = scene, law, body, tolerance
        self.signals = scene.signals()
        self.frequency = 2.0 * math.pi / self.signals.period  # at which everything repeats
        self.spring = body.mass * (0.5 * self.frequency) ** 2
        self.normal_load = scene.normal_load
        self.contracts = is_convergent(scene, law)
        own = varying_of(self.signals, scene.frequency, scene.constant_contact)
        # steps that adapt need not be told of harmonics of the force, which are small where they are quick
        self.quickest = max(own.quickest, 2.0 * self.frequency)
        self.seconds = 0.0

    def frequencies(self, count: int) -> Floats:
        """Of harmonics 1 ... count."""
        return self.frequency * np.arange(1.0, count + 1.0)

    def loads(self, count: int) -> ComplexValues:
        """Harmonics 1 ... count of the load."""
        load, period = self.signals.load[0], self.signals.period
        return np.array([load.harmonic(each, period) for each in self.frequencies(count).tolist()])

    def stiffness(self, omega: Floats) -> ComplexValues:
        """D_0."""
        return self.spring - self.body.mass * omega**2 + 1j * self.body.damping * omega

    def moved(
        self, force: ComplexValues, belt_speed: float, state: Floats | None, tolerance: float
    ) -> MassMotion | None:
        """Its periodic motion, from this state if there is one; None where none is found."""
        omega = self.frequencies(len(force))
        waves = tuple(Wave(*each) for each in zip(omega.tolist(), force.tolist(), strict=True) if each[1])
        share, frequency = 1.0 / self.body.mass, self.scene.frequency
        load = self.signals.load[0].plus(Signal(waves)).scaled(share)
        pressed = self.signals.normal_load.scaled(share)
        signals = Signals(self.signals.period, (load, Signal()), self.signals.belt, pressed)
        varying = varying_of(signals, frequency, self.scene.constant_contact)
        mass = Mass(
            damping=share * self.body.damping,
            stiffness=share * self.spring,
            transverse_damping=1.0,
            transverse_stiffness=1.0,
            normal_load=share * self.normal_load,
            frequency=frequency,
            force=load.harmonic(frequency, signals.period),
            transverse_force=0j,
            varying=varying._replace(quickest=self.quickest),
        )
        periods = float(self.scene.periods)
        maps = table_of_maps(self.law, on_the_line(mass, periods))
        guess = np.empty((0, 0)) if state is None else state[None]
        goal = Goal(tolerance, self.contracts, False, False)
        arguments = maps, periods, np.array([belt_speed]), guess, goal, Wanted(True, True, False)
        curve, seconds = KernelCall(answer_curve).timed(*arguments)
        self.seconds += seconds
        if not curve.closed.found[0]:
            return self.moved(force, belt_speed, None, tolerance) if state is not None else None
        track, end = curve.orbits, curve.ends[0]
        velocity = phasors_of_panels(track.tau[:end], track.v[:end].real, omega)
        x = velocity / (1j * omega)
        pushed = self.loads(len(force)) + force - self.stiffness(omega) * x
        return MassMotion(curve.closed.mean[0], curve.closed.error[0], x, pushed / self.normal_load, curve)


class Balancing:
    """The search at one belt speed for the force of so many harmonics."""

    def __init__(self, mass: MassUnderForce, belt_speed: float, count: int) -> None:
        self.mass, self.belt_speed, self.count = mass, belt_speed, count
        omega = mass.frequencies(count)
        self.receptance, self.stiffness = mass.body.receptance(omega), mass.stiffness(omega)

    def without_friction(self) -> Floats:
        """The force on the mass in the body's motion without friction."""
        return _flat((self.stiffness * self.receptance - 1.0) * self.mass.loads(self.count))

    def without_slip(self) -> Floats:
        """The force on the mass in its motion on the springs of a contact that does not slip."""
        law, loads = self.mass.law, self.mass.loads(self.count)
        depth = law.presliding()
        spring = self.mass.normal_load * law.sliding_friction(1.0) / depth if 0.0 < depth < math.inf else 0.0
        x = loads * self.receptance / (1.0 + spring * self.receptance)
        return _flat((self.stiffness + spring) * x - loads)

    def found(self, start: BalancedMotion | Floats) -> BalancedMotion | None:
        """From a motion with as many harmonics or others, or from a force; None where there is none."""
        state: Floats | None = None
        if isinstance(start, BalancedMotion):
            force, inverse = self._with_as_many(start)
            state = start.motion.curve.states[0]
        else:
            force, inverse = start, np.eye(2 * self.count)
        here = self._left_open(force, state, ROUGH_MEAN)
        if here is None:
            return None
        missing, motion = here
        slope, before = 1.0 / self.mass.normal_load, 0.0
        for steps in range(MOST_BROYDEN_STEPS):
            if steps == PATIENT_STEPS:
                inverse = self._differentiated(force, missing, motion)
            step = -inverse @ missing
            left = max(slope, before) * float(np.linalg.norm(step))
            tolerance = self.mass.tolerance
            if left < LEFT_OPEN * tolerance and motion.error <= 0.2 * tolerance:
                return BalancedMotion(self.belt_speed, force, inverse, motion, left)
            asked = min(max(0.1 * tolerance, 0.01 * left), 10.0 * ROUGH_MEAN)
            taken = self._taken(force, step, missing, motion, asked)
            if taken is None:
                return None
            step, (fresh, moved) = taken
            before, slope = slope, abs(moved.mean - motion.mean) / float(np.linalg.norm(step))
            change = inverse @ (fresh - missing)
            along = float(step @ change)
            if along != 0.0:
                inverse = inverse + np.outer(step - change, step @ inverse) / along
            force, missing, motion = force + step, fresh, moved
        return None

    def _taken(
        self, force: Floats, step: Floats, missing: Floats, motion: MassMotion, asked: float
    ) -> tuple[Floats, tuple[Floats, MassMotion]] | None:
        """The step, shortened while much more is left open after it, and what is there."""
        for share in SHORTER:
            found = self._left_open(force + share * step, motion.curve.states[0], asked)
            if found is not None and np.linalg.norm(found[0]) < 2.0 * np.linalg.norm(missing):
                break
        return None if found is None else (share * step, found)

    def _left_open(
        self, force: Floats, state: Floats | None, tolerance: float
    ) -> tuple[Floats, MassMotion] | None:
        """D_0 ((1 - H D_0) x1 + H f), which without friction moves with f one to one, and the motion."""
        f = _phasors_of(force)
        motion = self.mass.moved(f, self.belt_speed, state, tolerance)
        if motion is None:
            return None
        missing = (1.0 - self.receptance * self.stiffness) * motion.x + self.receptance * f
        return _flat(self.stiffness * missing), motion

    def _differentiated(self, force: Floats, missing: Floats, motion: MassMotion) -> Floats:
        """The inverse by quotients of the lowest harmonics, the others as without friction."""
        matrix, lowest = np.eye(2 * self.count), min(DIFFERENTIATED_HARMONICS, self.count)
        size = 1e-3 * max(float(np.abs(force).max()), 0.01 * self.mass.normal_load)
        for k in [*range(lowest), *range(self.count, self.count + lowest)]:
            shift = np.zeros(2 * self.count)
            shift[k] = size
            found = self._left_open(force + shift, motion.curve.states[0], 0.1 * ROUGH_MEAN)
            if found is not None:
                matrix[:, k] = (found[0] - missing) / size
        return np.asarray(np.linalg.inv(matrix), dtype=np.float64)

    def _with_as_many(self, start: BalancedMotion) -> tuple[Floats, Floats]:
        """The force and the inverse of another motion, of harmonics that it lacks none and as without friction."""
        here, there = self.count, start.harmonics
        k = np.arange(min(here, there))
        mine, theirs = np.concatenate([k, here + k]), np.concatenate([k, there + k])
        force, inverse = np.zeros(2 * here), np.eye(2 * here)
        force[mine] = start.force[theirs]
        inverse[np.ix_(mine, mine)] = start.inverse[np.ix_(theirs, theirs)]
        return force, inverse


def _flat(phasors: ComplexValues) -> Floats:
    return np.concatenate([phasors.real, phasors.imag])


def _phasors_of(flat: Floats) -> ComplexValues:
    return np.asarray(flat[: len(flat) // 2] + 1j * flat[len(flat) // 2 :])
