"""Scenes of the stability maps, in which something decays at a local rate that can be chosen."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.scene.scene import Drive, Initial, Load, Scene, Transverse

MU = 0.4
_SHAKEN = Scene(damping_ratio=0.5, normal_load=1.0, belt_speed=1.0, drive=Drive(amplitude=4.0, frequency=1.0))
"""Weak friction: slip goes from -5 to 3, and settles within a few periods."""
_FASTEST = 5.0
_LOAD = 10.0
_CARRIED = Scene(damping_ratio=0.5, normal_load=_LOAD, belt_speed=0.5, drive=Drive(amplitude=3, frequency=1))
"""Load is below friction: smoothed friction lets the mass creep where it would stick."""


@dataclass(frozen=True)
class StabilityProblem:
    """Scenes by their local rate; rate_text: what that is, memory: what its law remembers."""

    name: str
    title: str
    rate_text: str
    memory: str
    at: Callable[[float], tuple[Scene, FrictionLaw]]


def width_at(rate: float) -> float:
    """Return the smoothing width whose slope at rest makes slip decay at this rate."""
    return _LOAD * MU / rate


def _bristles(rate: float) -> tuple[Scene, FrictionLaw]:
    return _SHAKEN, Dahl(mu=MU, stiffness=rate * MU / _FASTEST)


def _smoothing(rate: float) -> tuple[Scene, FrictionLaw]:
    return _CARRIED, Coulomb(mu=MU)


def _in_the_plane(rate: float) -> tuple[Scene, FrictionLaw]:
    """Belt speed 1; the transverse load turns the slip by as little as keeps the mass from moving with the belt.

    The spring across grows with the rate, or the mass would creep to its place within as many periods; along the belt
    it starts where the spring balances friction, or the belt would carry it there within as many.
    """
    quick, drive = math.sqrt(rate), Drive(amplitude=0.0, frequency=1.0)
    across = Transverse(natural_frequency=quick, damping_ratio=0.5, load=Load(amplitude=quick))
    known: dict[str, Any] = {"normal_load": rate / MU, "initial": Initial(x=rate)}
    return Scene(damping_ratio=0.5, belt_speed=1, drive=drive, transverse=across, **known), Coulomb(mu=MU)


_ALL = (
    StabilityProblem("bristle", "bristles of Dahl's law", "largest |slip| k/mu", "bristle", _bristles),
    StabilityProblem("smoothing", "friction smoothed by tanh", "friction limit / width", "none", _smoothing),
    StabilityProblem("plane", "slow slip in the plane", "friction limit / |slip|", "none", _in_the_plane),
)
PROBLEMS: dict[str, StabilityProblem] = {problem.name: problem for problem in _ALL}
"""By name, in the order of tables and pictures."""
