"""Harmonic balance of a mass on bristle friction, one harmonic: all amplitudes at which it balances.

Friction over a harmonic slip has a mean, a part in quadrature to the displacement (it damps) and a part in phase
with it (it stiffens, unlike Coulomb's). Both depend on the amplitude, and on the belt speed that biases the slip.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from frictionlab.laws.memory import BristleLaw, bristle_on_the_line
from frictionlab.methods.prescribed.bristle import Along, line_loop
from frictionlab.methods.prescribed.loop import Open
from frictionlab.methods.prescribed.method import solve_prescribed
from frictionlab.methods.reduced.common import ROUNDING, TOLERANCE, Modelled
from frictionlab.methods.shooting.method import suggest_shooting
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.record import Orbit
from frictionlab.motion.orbit.recorder import WEIGHTS
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene, Slip
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.theory import friction_free_velocity
from frictionlab.values.quantities import Floats

LOOPS_ROUNDING = 99.0 * ROUNDING
"""Rounding error of friction over a loop, relative to steady friction, beyond that of formulas."""
STEADY = 0.98
"""Largest Floquet multiplier of a motion of one drive period that counts as stable."""
NO_DECAY = "without damping and without slip reversal the free oscillation does not decay"
REMEMBERED = "slip within the elastic range of the bristles: the mean depends on the start; use shooting"
AMBIGUOUS = "one harmonic balances at velocity amplitudes {} (contact resonance); use shooting"
_PER_DECADE, _DECADES = 12, 9
"""Amplitudes looked at by factors of ten, and how many of these below the largest."""
_OF_LOOPS = 1e-4
"""Tolerance of a loop's mean, so loose that its first steps are taken: they are off by 1e-8 of friction at most."""
_SAMPLES = 64
"""Number of samples of an elastic loop."""


class OverSine(NamedTuple):
    """Friction coefficient over the slip amplitude*sin(theta) - belt_speed: its mean and its first harmonic.

    first: the coefficient of sin(theta), in quadrature to the displacement, + i times that of cos(theta).
    """

    mean: float
    first: complex


def over_sine(law: BristleLaw, amplitude: float, belt_speed: float, frequency: float) -> OverSine:
    """Friction of the closed loop, of an elastic contact from its middle; NaN where none is found."""
    if _elastic(law, amplitude, belt_speed, frequency):
        theta = np.arange(_SAMPLES) * (math.tau / _SAMPLES)
        moved = amplitude * np.sin(theta), -amplitude / frequency * np.cos(theta)
        rub = [bristle_on_the_line(law, v, z)[1] for v, z in np.transpose(moved).tolist()]
        return OverSine(0.0, complex(2j / _SAMPLES * (rub * np.exp(-1j * theta)).sum()))
    if not law.exact_path():
        slip = Slip(velocity_amplitude=amplitude, frequency=frequency)
        answers = solve_prescribed([Scene(belt_speed=belt_speed, slip=slip)], law, _OF_LOOPS)
        orbit = answers.orbit(0)
        if orbit is None:
            return OverSine(math.nan, complex(math.nan))
        shares = 0.5 * np.diff(orbit.tau[:, [0, -1]]) * WEIGHTS * frequency / math.pi
        first = (shares * orbit.friction.real * np.exp(-1j * frequency * orbit.tau)).sum()
        return OverSine(-float(answers.mean[0].real), complex(1j * first))
    found = line_loop(law, Along(complex(amplitude), belt_speed, frequency))
    if isinstance(found, Open):
        return OverSine(math.nan, complex(math.nan))
    loop = found.loop
    angle = loop.start[:, None] + loop.width[:, None] * loop.points
    return OverSine(-loop.mean.real, 1j * loop.total(loop.friction * np.exp(-1j * angle)) / math.pi)


def _elastic(law: BristleLaw, amplitude: float, belt_speed: float, frequency: float) -> bool:
    return belt_speed == 0.0 and amplitude < law.elastic_deflection() * frequency


class OneBalance(NamedTuple):
    """One harmonic of motion, Im(velocity exp(i angle)), and the mean of friction over it."""

    velocity: complex
    mean: float


def bristle_refusal(name: str, scene: Scene, law: BristleLaw) -> str | None:
    """Why one harmonic does not apply to this driven scene and law at any belt speed; None if it does."""
    if scene.degrees_of_freedom == 2:
        return suggest_shooting(
            f"{name} follows bristle friction along one line: this scene has two directions", scene, law
        )
    if not law.obeys("oddness"):
        return f"{name} needs bristles that are alike to both sides: this law is not odd; use shooting"
    if not math.isfinite(law.under_load(scene.mass().normal_load).largest_deflection()):
        return f"{name} needs a law with a largest deflection; use shooting"
    if not math.isfinite(friction_free_velocity(scene)):
        return f"{name} starts from the friction-free motion, which is unbounded at undamped resonance; use shooting"
    return None


def bristles(scenes: Sequence[Scene], law: BristleLaw) -> Modelled:
    """Return the one balance of each of scenes that differ in belt speed alone."""
    mass, speeds = scenes[0].mass(), belt_speeds_of(scenes)
    law = law.under_load(mass.normal_load)
    points = [_point(_Balancing(mass, speed, law, {})) for speed in np.abs(speeds).tolist()]
    means = [math.nan if balance is None else -balance.mean for balance, _ in points]
    mean, reasons = np.copysign(1.0, speeds) * means, [reason for _, reason in points]

    def orbit(i: int) -> Orbit | None:
        return _orbit(scenes[i], law, points[i][0], float(mean[i]))

    rounding = LOOPS_ROUNDING * law.sliding_friction(0.0)
    decay = math.exp(-math.pi * mass.damping / mass.frequency)
    return Modelled(
        mean, reasons, ModelWord.ONE_OF_BRISTLES, orbit, rounding, max(STEADY, 0.5 * (1.0 + decay))
    )


def _orbit(scene: Scene, law: BristleLaw, balance: OneBalance | None, mean: float) -> Orbit | None:
    """Return the motion about the position where its mean friction loads the spring, its slip taken as prescribed."""
    if balance is None:
        return None
    mass = scene.mass()
    size, lead = cmath.polar(balance.velocity)
    slip = Slip(velocity_amplitude=size, frequency=mass.frequency, phase=math.degrees(lead))
    prescribed = Scene(belt_speed=scene.belt_speed, normal_load=mass.normal_load, slip=slip)
    orbit = solve_prescribed([prescribed], law, TOLERANCE).orbit(0)
    return None if orbit is None else replace(orbit, x=orbit.x + mass.normal_load * mean, stick=None)


class _Balancing(NamedTuple):
    """A mass, damped or off resonance, a belt speed >= 0 and a law per unit normal load, all in scene scales.

    known: friction over motions of these amplitudes.
    """

    mass: Mass
    belt_speed: float
    law: BristleLaw
    known: dict[float, OverSine]

    @property
    def impedance(self) -> complex:
        """Force over velocity."""
        return self.mass.damping + 1j * (self.mass.frequency - self.mass.stiffness / self.mass.frequency)

    def friction(self, amplitude: float) -> OverSine:
        """Friction over a motion of this amplitude."""
        if amplitude <= self.belt_speed and self.law.constant_sliding_friction():
            return OverSine(-self.law.sliding_friction(0.0), 0j)
        if amplitude not in self.known:
            self.known[amplitude] = over_sine(self.law, amplitude, self.belt_speed, self.mass.frequency)
        return self.known[amplitude]

    def pull(self, amplitude: float) -> complex:
        """Return the force that the motion requires."""
        return self.impedance * amplitude + self.mass.normal_load * self.friction(amplitude).first

    def excess(self, amplitude: float) -> float:
        """Return the size of that force, less the load's."""
        return abs(self.pull(amplitude)) - abs(self.mass.force)

    def amplitudes(self) -> Floats:
        """Return amplitudes that enclose the balances, and the belt speed, at which slip begins to reverse.

        Above the largest, friction that steady sliding bounds cannot balance inertia, and what grows with speed
        damps. Below the least it cannot balance the load: its harmonic is at most twice that of steady sliding, or
        half more than at the largest amplitude.
        """
        force, size, load = abs(self.mass.force), abs(self.impedance), self.mass.normal_load
        held = 2.0 * load * self.law.sliding_friction(0.0)
        most = max((force + held) / size, self.belt_speed, 1e-300)
        while self.excess(most) <= 0.0:
            most *= 1.5
        least = (force - max(held, 1.5 * load * abs(self.friction(most).first))) / size
        looked = most * 10.0 ** -np.linspace(0.0, _DECADES, _DECADES * _PER_DECADE + 1)
        return np.unique(np.clip([*looked, self.belt_speed], max(least, looked[-1]), most))

    def balances(self) -> list[float]:
        """All amplitudes that balance, rising."""
        from scipy.optimize import brentq

        ends = self.amplitudes().tolist()
        above = np.array([self.excess(v) > 0.0 for v in ends])
        changes = np.flatnonzero(above[1:] != above[:-1]).tolist()
        return [float(brentq(self.excess, *ends[i : i + 2], xtol=1e-13 * ends[i + 1])) for i in changes]


def _point(what: _Balancing) -> tuple[OneBalance | None, str]:
    """Return the balance if it is the only one, else None, and why it is no answer."""
    mass, found = what.mass, what.balances()
    if len(found) != 1:
        return None, AMBIGUOUS.format(", ".join(f"{amplitude:.4g}" for amplitude in found) or "none")
    turned = cmath.phase(mass.force) - cmath.phase(what.pull(found[0]))
    balance = OneBalance(cmath.rect(found[0], turned), what.friction(found[0]).mean)
    if mass.damping == 0.0 and what.belt_speed >= abs(mass.force / what.impedance):
        return balance, NO_DECAY
    return balance, REMEMBERED if _elastic(what.law, found[0], what.belt_speed, mass.frequency) else ""
