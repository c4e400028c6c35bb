"""A prescribed slip for time stepping: a mass that friction does not move, on a belt that moves in its place."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frictionlab.laws.memory import VECTORIAL
from frictionlab.methods.prescribed.varying_slip import VaryingSlip, piece_at
from frictionlab.motion.orbit.record import Orbit
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene
from frictionlab.scene.varying import varying_of

WEAK = 2.0**-200
"""The normal load of such a mass: its slip keeps all digits, and squares of what friction does to it are numbers."""

UNLOADS = 4
"""Beginnings and ends of unloading per period of a slip that turns."""


def unmoved_mass(scene: Scene) -> Mass:
    """A mass on neither spring nor dashpot; the contact carries its load in the same shares of the mean."""
    assert scene.normal_load is not None
    varying = varying_of(scene.signals(), scene.frequency, scene.constant_contact)
    varying = varying._replace(
        belt=varying.belt.scaled(-1.0), normal_load=varying.normal_load.scaled(WEAK / scene.normal_load)
    )
    return Mass(0.0, 0.0, 0.0, 0.0, WEAK, scene.frequency, 0j, 0j, varying)


def unseen_share(scene: Scene, law: Any, steps: int) -> float:
    """The share of friction that steps may have wrong where slip turns in the plane, whatever halved ones say.

    The mean angle by which bristles trail behind it, over the steps that pass the presliding length: these tell
    nothing of it. Half a step wherever bristles begin or end to be unloaded, if that changes their rate at once: an
    ellipse does so four times at most.
    """
    if scene.load_along_belt_only or law.form != VECTORIAL:
        return 0.0
    slip, step = slip_of(scene), 2.0 * math.pi / scene.frequency / steps
    tau = np.asarray((np.arange(round(steps * scene.periods)) + 0.5) * step, np.float64)
    k = piece_at(slip.along.edges, tau)
    (along, rate), (across, rate_2) = slip.along.at(tau, k), slip.across.at(tau, k)
    velocity, turns = along - scene.belt_speed + 1j * across, rate + 1j * rate_2
    speed = np.abs(velocity)
    with np.errstate(divide="ignore", invalid="ignore"):
        trailed = law.presliding() * np.abs((velocity.conj() * turns).imag) / speed**3
    passed = speed * step > law.presliding()
    unloads = 0.5 * UNLOADS / steps if law.elastic_unloading() else 0.0
    return unloads + float(np.where(passed, np.fmin(trailed, 1.0), 0.0).mean())


def slip_of(scene: Scene) -> VaryingSlip:
    """The slip that is prescribed."""
    assert scene.normal_load is not None
    return VaryingSlip.of(scene.signals(), scene.normal_load)


def as_prescribed(scene: Scene, orbit: Orbit) -> Orbit:
    """The orbit of such a mass as that of the motion that is prescribed, the friction along it the same; no stick."""
    return slip_of(scene).orbit(orbit.tau, orbit.friction)
