"""Harmonic balance: the motion a sine or some harmonics, friction by its mean and as many harmonics.

Zeros of many monotone functions at once.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import ClassVar

import numpy as np
from pydantic import Field

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.base import beyond_linear
from frictionlab.methods.reduced.bristle import bristle_refusal, bristles
from frictionlab.methods.reduced.common import (
    Modelled,
    OfOneModel,
    Sines,
    line_refusal,
    modelled_along,
    steadied,
)
from frictionlab.methods.reduced.sampled import sampled, sampled_refusal
from frictionlab.methods.shooting.method import suggest_shooting
from frictionlab.methods.words import ModelWord
from frictionlab.scene.scene import Scene
from frictionlab.theory import friction_free_velocity, one_harmonic_least_ratio, one_harmonic_velocity
from frictionlab.values.quantities import Floats


def monotone_root(function: Callable[..., Floats], low: Floats, high: Floats, *rows: Floats) -> Floats:
    """Find where a function of each row crosses zero between low and high, to rounding; else the nearer end.

    function(x, *rows) is elementwise: it is called with the rows that are not found yet. Chandrupatla's method, as
    scipy has it.
    """
    from scipy.optimize.elementwise import find_root

    found = find_root(function, (low, high), args=rows)
    (left, right), (below, above) = found.bracket, found.f_bracket
    nearer = np.where(np.abs(below) < np.abs(above), left, right)
    return np.where(found.success, found.x, nearer)


NOT_ONE_SINE = (
    "harmonic_balance takes sines of the drive's frequency, of loads and of the belt's vibration, under a constant "
    "normal load"
)
NO_TAIL = (
    "harmonic_balance leaves out all beyond its harmonics, for the tail in closed form is gone: leave tail out and "
    "give more harmonics, or use exact or shooting"
)
ONE_FOR_BRISTLES = "harmonic_balance balances bristle friction in one harmonic alone; give harmonics: 1"


class HarmonicBalance(OfOneModel):
    """Harmonic balance of motion and friction along the belt; explicit for one harmonic of Coulomb friction.

    Bristle friction has a part in phase with the displacement as well, and needs a loop of the law at every
    amplitude tried (methods/reduced/bristle.py).

    Parameters
    ----------
    harmonics : int, >= 1, default 1
        Number of harmonics.
    tail : bool, optional
        Same answer if false or left out, refused if true: all beyond these harmonics is left out. The error of
        the mean is of the order 1/harmonics where friction jumps.
    error : {"distance"}, default "distance"
        Kind of the error, always the distance to the mean of ``exact`` or ``shooting``.

    References
    ----------
    Source: Sulollari, van Dalen & Cabboi, Eqs. 5, 8 and 9 and appendix A.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4), method=fl.HarmonicBalance(harmonics=9))
    >>> round(state.mean_friction, 4), state.error < 1e-4
    (0.0506, True)
    """

    name: ClassVar[str] = "harmonic_balance"
    in_words: ClassVar[str] = "harmonic balance"
    harmonics: int = Field(default=1, ge=1, le=1000, strict=True)
    tail: bool | None = Field(default=None, strict=True)

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Return where the model has no motion to start from, or no friction that it can balance."""
        if self.tail:
            return NO_TAIL
        if scene.degrees_of_freedom == 0:
            reason = "harmonic_balance needs a mass: with a prescribed slip there is no motion to solve for"
            return suggest_shooting(reason, scene, law)
        if terms := beyond_linear(self.name, scene):
            return suggest_shooting(terms, scene, law)
        steady = steadied(scene)
        if steady is None:
            return suggest_shooting(NOT_ONE_SINE, scene, law)
        if steady.undriven:
            return f"{self.name} needs a drive: it starts from the driven motion"
        if isinstance(law, BristleLaw):
            return bristle_refusal(self.name, steady, law) if self.harmonics == 1 else ONE_FOR_BRISTLES
        if self.harmonics > 1:
            return sampled_refusal(self.name, steady, law, self.harmonics)
        refused = line_refusal(self.name, steady, law)
        takes_more = refused and sampled_refusal(self.name, steady, law, 3) is None
        return f"{refused}; harmonics: 3 or more take it" if takes_more else refused

    def modelled(self, scenes: Sequence[Scene], law: FrictionLaw) -> Modelled:
        """Return the harmonics that balance."""
        if isinstance(law, BristleLaw):
            return bristles(scenes, law)
        if self.harmonics > 1:
            return sampled(scenes, law, self.harmonics)
        return modelled_along(scenes, law, ModelWord.ONE_HARMONIC, one_harmonic)


def one_harmonic(scene: Scene, friction: float, belt_speeds: Floats) -> Sines:
    """Return the motion at belt speeds >= 0; from V_lin on, the friction-free one."""
    angle = _reversal(scene, friction, belt_speeds)
    ratio = np.cos(angle)
    free, mass = friction_free_velocity(scene), scene.mass()
    reverses = belt_speeds < free
    size = np.where(reverses, one_harmonic_velocity(scene, friction, ratio), free)
    held = np.where(reverses, 4.0 / np.pi * friction * np.sin(angle), 0.0)
    real = mass.damping + held / np.where(size > 0.0, size, 1.0)
    impedance = real + 1j * (mass.frequency - mass.stiffness / mass.frequency)
    velocity = size * np.exp(1j * (np.angle(mass.force) - np.angle(impedance)))
    # Eq. 5, without the arcsine's cancellation near 1.
    mean = np.where(reverses, 1.0 - 2.0 / np.pi * angle, 1.0)
    # A load below the first harmonic of friction leaves none on a belt at rest.
    stuck = (belt_speeds == 0.0) & (one_harmonic_least_ratio(scene, friction) > 0.0)
    return np.where(stuck, np.nan, mean), velocity


def _reversal(scene: Scene, friction: float, belt_speeds: Floats) -> Floats:
    """Phase from the peak of x1' to reversal, arccos of belt speed over amplitude: resolved where that tends to 1."""
    widest = math.acos(one_harmonic_least_ratio(scene, friction))

    def excess(angle: Floats, belt_speed: Floats) -> Floats:
        ratio = np.cos(angle)
        return np.asarray(ratio * one_harmonic_velocity(scene, friction, ratio) - belt_speed)

    size = np.ones(len(belt_speeds))
    angle = monotone_root(excess, 0.0 * size, widest * size, belt_speeds)
    return np.where(belt_speeds == 0.0, 0.5 * math.pi, angle)
