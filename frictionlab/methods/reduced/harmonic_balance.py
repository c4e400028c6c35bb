"""Harmonic balance: the motion a sine or some harmonics, friction by its mean and as many harmonics."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationInfo, field_validator

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers, ReducedModel
from frictionlab.methods.reduced.bristle import answer_bristle, bristle_means, bristle_refusal
from frictionlab.methods.reduced.common import (
    Harmonic,
    answer_line,
    answer_steadied,
    line_means,
    line_refusal,
    steadied,
    steadied_all,
)
from frictionlab.methods.reduced.coulomb_harmonics import answer_coulomb, coulomb_means, coulomb_refusal
from frictionlab.methods.reduced.line_harmonics import answer_sliding, sliding_means, sliding_refusal
from frictionlab.methods.reduced.planar_harmonics import answer_planar, planar_means, planar_refusal
from frictionlab.methods.refusals import suggest_shooting
from frictionlab.numerics.roots import monotone_root
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.theory import friction_free_velocity, one_harmonic_least_ratio, one_harmonic_velocity

TEXT = "one harmonic of x1' and of Coulomb friction balanced (Eqs. 5, 8, 9 in explicit form)"
NOT_ONE_SINE = (
    "harmonic_balance takes sines of the drive's frequency, of loads and of the belt's vibration, under a constant "
    "normal load"
)
AT_REST = (
    "on a belt at rest one harmonic gives sliding only if the load exceeds 4/pi of mu*normal_load; use exact"
)


MOST_HARMONICS = 1000
ONE_HAS_NO_TAIL = "one harmonic has no tail: Eqs. 8 and 9 leave all others out; give harmonics of 2 or more"
ONE_FOR_BRISTLES = "harmonic_balance balances bristle friction in one harmonic alone; give harmonics: 1"


class HarmonicBalance(ReducedModel):
    """Harmonics of motion and friction balanced along the belt; for one of Coulomb friction the curve is explicit.

    harmonics: how many, from 1 on.
    tail: the mass beyond them as a free one, whose velocity is piecewise linear between the switches of Coulomb
    friction, or nothing; true for 2 harmonics or more where left out. Without it the mean is off by the order
    1/harmonics, with it by about harmonics^-3 (methods/reduced/switch_response.py).

    Amplitude and belt speed follow from their ratio without a search (theory.one_harmonic_velocity); only a given
    belt speed asks for that ratio, the one root of a rising function. The error is what the left-out harmonics,
    stick included, do to the mean: the distance to that of ``exact`` or ``shooting``.

    Bristle friction has a part in phase with the displacement as well, and both parts ask for a loop of the law at
    every amplitude looked at (methods/reduced/bristle.py).

    Source: Sulollari, van Dalen & Cabboi, Eqs. 5, 8 and 9 and appendix A.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4), method=fl.HarmonicBalance(harmonics=9))
    >>> round(state.mean_friction, 4), state.error < 1e-5
    (0.0506, True)
    """

    name: ClassVar[str] = "harmonic_balance"
    harmonics: int = Field(default=1, ge=1, le=MOST_HARMONICS, strict=True)
    tail: bool | None = Field(default=None, strict=True)

    @field_validator("tail")
    @classmethod
    def _has_tail(cls, tail: bool | None, info: ValidationInfo) -> bool | None:
        if tail and info.data.get("harmonics", 2) == 1:
            raise ValueError(ONE_HAS_NO_TAIL)
        return tail

    def _balance(self, scene: Scene, law: FrictionLaw) -> _Balance:
        if self.harmonics > 1:
            if not scene.load_along_belt_only:
                return _on_samples(self.harmonics, self.tail)
            varies = law.memory_kind == "none" and not law.constant_sliding_friction()
            return (_on_legs if varies else _on_switches)(self.harmonics, self.tail)
        return _OF_BRISTLES if law.memory_kind == "bristle" else _OF_COULOMB

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Where the model has no motion to start from, or no friction that it can balance."""
        if scene.degrees_of_freedom == 0:
            reason = "harmonic_balance needs a mass: with a prescribed slip there is no motion to solve for"
            return suggest_shooting(reason, scene, law)
        steady = steadied(scene)
        if steady is None:
            return suggest_shooting(NOT_ONE_SINE, scene, law)
        if self.harmonics > 1 and law.memory_kind == "bristle":
            return ONE_FOR_BRISTLES
        return self._balance(steady, law).refusal(self.name, steady, law)

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Answer scenes that differ in belt speed alone."""
        return answer_steadied(
            scenes, lambda others: self._balance(others[0], law).answer(others, law, tolerance)
        )

    def model_means(self, scenes: Sequence[Scene], law: FrictionLaw) -> Floats | NDArray[np.complex128]:
        """Of the harmonics that balance."""
        steady = steadied_all(scenes)
        return self._balance(steady[0], law).means(steady, law)

    def cost(self, scene: Scene, law: FrictionLaw, tolerance: float) -> float:
        """Two root searches on whole arrays; slow drives need more samples to be sure of the reversals.

        With bristles a search for every amplitude that balances, and shooting.
        """
        return self._balance(scene, law).cost(scene)


def one_harmonic(scene: Scene, friction: float, belt_speeds: Floats) -> Harmonic:
    """The one-harmonic motion at belt speeds >= 0; from V_lin on, the friction-free one."""
    angle = _reversal(scene, friction, belt_speeds)
    ratio = np.cos(angle)
    free, mass = friction_free_velocity(scene), scene.mass()
    reverses = belt_speeds < free
    size = np.where(reverses, one_harmonic_velocity(scene, friction, ratio), free)
    held = np.where(reverses, 4.0 / np.pi * friction * np.sin(angle), 0.0)
    real = mass.damping + held / np.where(size > 0.0, size, 1.0)
    impedance = real + 1j * (mass.frequency - mass.stiffness / mass.frequency)
    velocity = size * np.exp(1j * (np.angle(mass.force) - np.angle(impedance)))
    mean = np.where(
        reverses, 1.0 - 2.0 / np.pi * angle, 1.0
    )  # Eq. 5, without the arcsine's cancellation near 1
    held_still = (belt_speeds == 0.0) & (one_harmonic_least_ratio(scene, friction) > 0.0)
    reasons = [AT_REST if still else "" for still in held_still]
    return Harmonic(mean, velocity, reasons)


def _reversal(scene: Scene, friction: float, belt_speeds: Floats) -> Floats:
    """Phase from the peak of x1' to reversal, arccos of belt speed over amplitude: resolved where that tends to 1."""
    widest = math.acos(one_harmonic_least_ratio(scene, friction))

    def excess(angle: Floats, belt_speed: Floats) -> Floats:
        ratio = np.cos(angle)
        return np.asarray(ratio * one_harmonic_velocity(scene, friction, ratio) - belt_speed)

    size = np.ones(len(belt_speeds))
    angle = monotone_root(excess, 0.0 * size, widest * size, belt_speeds)
    return np.where(belt_speeds == 0.0, 0.5 * math.pi, angle)


class _Balance(NamedTuple):
    """One harmonic balanced for a kind of law."""

    refusal: Callable[[str, Scene, Any], str | None]
    answer: Callable[[Sequence[Scene], Any, float], Answers]
    means: Callable[[Sequence[Scene], Any], Floats | NDArray[np.complex128]]
    cost: Callable[[Scene], float]


_OF_COULOMB = _Balance(
    line_refusal,
    lambda scenes, law, tolerance: answer_line(scenes, law, tolerance, TEXT, one_harmonic),
    lambda scenes, law: line_means(scenes, law, one_harmonic),
    lambda scene: 5e-5 * max(1.0, 1.0 / scene.frequency),
)
_OF_BRISTLES = _Balance(
    bristle_refusal,
    answer_bristle,
    bristle_means,
    lambda _scene: 4e-2,
)


def _on_switches(harmonics: int, tail: bool | None) -> _Balance:
    """Two harmonics or more of Coulomb friction along the belt."""
    summed = tail is not False
    return _Balance(
        lambda name, scene, law: coulomb_refusal(name, scene, law, harmonics),
        lambda scenes, law, tolerance: answer_coulomb(scenes, law, tolerance, harmonics, summed),
        lambda scenes, law: coulomb_means(scenes, law, harmonics, summed),
        lambda _scene: 1e-5 + 1e-6 * harmonics,
    )


def _on_legs(harmonics: int, tail: bool | None) -> _Balance:
    """Two harmonics or more, along the belt, of friction that varies with the slip speed."""
    return _Balance(
        lambda name, scene, law: sliding_refusal(name, scene, law, harmonics, tail),
        lambda scenes, law, tolerance: answer_sliding(scenes, law, tolerance, harmonics),
        lambda scenes, law: sliding_means(scenes, law, harmonics),
        lambda _scene: 2e-2 + 4e-3 * harmonics,
    )


def _on_samples(harmonics: int, tail: bool | None) -> _Balance:
    """Two harmonics or more of planar friction without memory."""
    return _Balance(
        lambda name, scene, law: planar_refusal(name, scene, law, tail),
        lambda scenes, law, tolerance: answer_planar(scenes, law, tolerance, harmonics),
        lambda scenes, law: planar_means(scenes, law, harmonics),
        lambda _scene: 2e-3 + 1e-5 * harmonics**1.5,
    )
