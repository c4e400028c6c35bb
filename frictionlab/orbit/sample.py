"""One period of a steady state at equally spaced times."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from frictionlab.orbit.panels import interpolation_weights
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.scene.signals import Signal


class Samples(NamedTuple):
    """One period of a steady state at n equally spaced times [nondimensional, scales of ``scene``].

    friction [-] is the force that resists slip over the mean normal load; load [K_1 L] is the force that drives the
    mass, at a jump that after it; slip is the velocity against the belt; normal_load [K_1 L] with its variation.
    """

    tau: Floats
    x1: Floats
    v1: Floats
    x2: Floats
    v2: Floats
    friction: Floats
    friction_transverse: Floats
    load: Floats
    load_transverse: Floats
    slip: Floats
    slip_transverse: Floats
    normal_load: Floats


def sample(orbit: Orbit, scene: Scene, n: int) -> Samples:
    """The orbit at n equally spaced times tau = 0 ... its period (end not included)."""
    return sample_at(
        orbit,
        scene,
        orbit.tau[0, 0] + np.arange(n, dtype=np.float64) * (np.ptp(orbit.tau) / orbit.periods / n),
    )


def sample_at(orbit: Orbit, scene: Scene, times: Floats) -> Samples:
    """The orbit at these times [1/omega_1], within those it is recorded at."""
    panels = np.clip(np.searchsorted(orbit.tau[:, 0], times, side="right") - 1, 0, len(orbit.tau) - 1)
    start, end = orbit.tau[panels, 0], orbit.tau[panels, -1]
    weights = interpolation_weights((2.0 * times - start - end) / (end - start))
    x, v, rub = ((weights * part[panels]).sum(axis=1) for part in (orbit.x, orbit.v, orbit.friction))
    signals = scene.signals()
    along, across = (load(times) for load in signals.load)
    # of a prescribed slip the oscillation is that of the body
    belts = signals.belt if scene.degrees_of_freedom else (Signal(), Signal())
    slip, slip_across = v.real - scene.belt_speed - belts[0](times), v.imag - belts[1](times)
    assert scene.normal_load is not None
    pressed = scene.normal_load + signals.normal_load(times)
    return Samples(
        times, x.real, v.real, x.imag, v.imag, rub.real, rub.imag, along, across, slip, slip_across, pressed
    )
