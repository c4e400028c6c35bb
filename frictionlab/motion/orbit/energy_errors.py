"""Errors of the energies of one period, from how well the recorded motion closes and agrees with itself."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.values.quantities import Floats

FOR_ERRORS = "duration", "open_ends", "swing", "misfit_load", "misfit_speed"
"""Columns of an orbit that bound these errors: its period; the distance of its end from its start in the norm
of energy; the root mean square of its velocity; and the difference of velocities and positions in every
panel, times its largest load and times its largest speed."""
_REACH = 3.0
"""Largest distance of a motion from the steady state, over the estimate from what the motion leaves open."""
_SHARE = 0.3
"""Share of the distance allowed by the error of the mean friction; most of that bound is caution."""
_ROUNDING = 1e-14


class Means(NamedTuple):
    """Mean friction along x1 found by a method, and the bound on its error [n].

    balanced: whether the method's motions obey the equation of motion, except for errors that shrink with the
    tolerance.
    """

    value: Floats
    error: Floats
    balanced: bool = True


def energy_errors(
    scenes: Sequence[Scene], mass: Mass, means: Means, read: Mapping[str, Floats]
) -> dict[str, Floats]:
    """Estimate bounds on the errors of the energies of orbits of these scenes; NaN where nothing is known.

    The error of the velocity has two parts. The first is the gap that the orbit leaves open, for as long as
    the dashpots let a disturbance live. The second is what the error of the mean stands for. To these the
    bounds add the difference of velocities and positions, panel by panel, and the residual of the balance of
    energies.
    """
    period, swing = read["duration"], read["swing"]
    wrong = _REACH * read["open_ends"] * _reach(scenes[0], mass, period)
    wrong = wrong + _SHARE * mass.normal_load * means.error * period  # integral of the velocity's error
    load = _largest_load(scenes[0], mass)
    damping = max(mass.damping, mass.transverse_damping if scenes[0].degrees_of_freedom == 2 else 0.0)
    put_in = 2.0 * read["misfit_load"] + load * (wrong + _ROUNDING * swing * period)
    viscous = damping * (4.0 * read["misfit_speed"] + 2.0 * wrong * (swing + wrong / period))
    viscous = viscous + _ROUNDING * damping * swing**2 * period
    belt = np.abs(belt_speeds_of(scenes))
    apart = np.abs(read["mean_friction"] - means.value)
    force = mass.normal_load * (apart + means.error + _ROUNDING) * period
    if scenes[0].degrees_of_freedom:
        # Residual of the balances of body and contact, and difference between the mean of the panels and the mean.
        missing = np.abs(read["energy_input"] - read["energy_viscous"] - read["energy_friction"])
        missing = missing + mass.normal_load * np.fmax(apart - means.error, 0.0) * period * (belt + swing)
        put_in, viscous = put_in + (missing if load > 0.0 else 0.0), viscous + missing
        friction = put_in + viscous
    else:  # the motion is prescribed: only friction can be wrong
        friction = 4.0 * force * swing
    if scenes[0].remembers:  # computed as work of the load less work of friction
        friction = put_in + belt * force + _ROUNDING * np.abs(read["energy_friction"])
        viscous = put_in + friction
    contact = friction + force * belt
    found = {"input": put_in, "viscous": viscous, "friction": friction, "contact": contact}
    return {
        f"energy_{name}_error": error + (0.0 if means.balanced else np.nan) for name, error in found.items()
    }


def _largest_load(scene: Scene, mass: Mass) -> float:
    if scene.is_harmonic or not scene.degrees_of_freedom:
        return abs(mass.force) + abs(mass.transverse_force)
    signals = scene.signals()
    return sum(max(map(abs, each.extremes(signals.period))) for each in signals.load)


def _reach(scene: Scene, mass: Mass, period: Floats) -> Floats:
    """Return the life of a disturbance of the motion, between half a period and ten."""
    bodies = [(mass.damping, mass.stiffness)]
    if scene.degrees_of_freedom == 2:
        bodies.append((mass.transverse_damping, mass.transverse_stiffness))
    decay = min(_decay(0.5 * damping, stiffness) for damping, stiffness in bodies)
    return np.clip(1.0 / decay if decay > 0.0 else math.inf, 0.5 * period, 10.0 * period)


def _decay(rate: float, stiffness: float) -> float:
    """Return the slower rate at which a free oscillation decays."""
    beyond = rate**2 - stiffness
    return rate if beyond <= 0.0 else stiffness / (rate + math.sqrt(beyond))
