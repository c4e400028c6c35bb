"""A prescribed slip whatever the law: where it is slow, and the columns it fills."""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

from frictionlab.scene.body import Motion


class Reading(NamedTuple):
    """What a law made of a prescribed slip: mean friction (x1 + i x2) and its error, and per unit load and period
    heat in the contact and work taken; reversals of slip and of friction along x1."""

    mean: complex
    error: float
    contact: float
    taken: float
    reversals: float
    force_reversals: float


def prescribed_columns(motion: Motion, planar: bool, found: Reading) -> dict[str, float]:
    """Every column that applies; nothing is driven or damped, so no energy is put in or lost to viscosity."""
    nan, a, c = math.nan, abs(motion.velocity), abs(motion.transverse_velocity)
    return {
        "mean_friction": found.mean.real,
        "error": found.error,
        "mean_low": nan,
        "mean_high": nan,
        "window": nan,
        "mean_friction_transverse": found.mean.imag if planar else nan,
        "velocity_amplitude": a,
        "velocity_harmonic": a,
        "velocity_phase": nan,
        "transverse_velocity_amplitude": c if planar else nan,
        "transverse_velocity_harmonic": c if planar else nan,
        "transverse_velocity_phase": nan,
        "stick_fraction": 0.0,
        "reversals": found.reversals,
        "force_reversals": found.force_reversals,
        "energy_input": nan,
        "energy_viscous": nan,
        "energy_friction": motion.normal_load * found.taken,
        "energy_contact": motion.normal_load * found.contact,
        "period": 1.0,
        "floquet": nan,
    }


def undecided_columns(motion: Motion, low: float, high: float) -> dict[str, float]:
    """The columns of a slip that leaves the mean open between two numbers."""
    nothing = dict.fromkeys(prescribed_columns(motion, False, Reading(0j, 0.0, 0.0, 0.0, 0.0, 0.0)), math.nan)
    return nothing | {"mean_low": low, "mean_high": high, "window": 1.0}


def slow_passages(along: complex, across: complex, belt_speed: float) -> list[tuple[float, float]]:
    """Where in the complex plane of the angle the slip speed vanishes: (angle, distance from the real axis).

    |slip|^2 is the product of slip_1 + i slip_2 and slip_1 - i slip_2; each is p z - belt_speed + q/z in
    z = exp(i angle), and their zeros mirror each other in the real axis.
    """
    p, q = -0.5j * along + 0.5 * across, 0.5j * along.conjugate() - 0.5 * across.conjugate()
    root = cmath.sqrt(belt_speed * belt_speed - 4.0 * p * q)
    larger = max(belt_speed + root, belt_speed - root, key=abs)
    zeros = [
        top / bottom for top, bottom in ((larger, 2.0 * p), (2.0 * q, larger)) if top != 0 and bottom != 0
    ]
    return [(cmath.phase(z), abs(math.log(abs(z)))) for z in zeros]
