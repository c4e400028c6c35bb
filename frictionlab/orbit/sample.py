"""One period of a steady state at equally spaced times."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw
from frictionlab.orbit.memory import Contact, deflections, followed
from frictionlab.orbit.panels import NODES, PER_PANEL, WEIGHTS, interpolation_weights
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.scene.signals import Signal

_POWERS = np.arange(1, PER_PANEL + 1)
_PRIMITIVE: Floats = np.linalg.inv(np.vander(NODES, increasing=True)) / _POWERS[:, None]
"""Coefficients, of the powers of a place from 1 on, of the integral of the polynomial through values at the nodes."""


class Samples(NamedTuple):
    """One period of a steady state at n equally spaced times [nondimensional, scales of ``scene``].

    friction [-] is the force that resists slip over the mean normal load; load [K_1 L] is the force that drives the
    mass, at a jump that after it; slip is the velocity against the belt; normal_load [K_1 L] with its variation; work
    [K_1 L^2] what friction has done on the body since the beginning. memory [count, n]: what the law remembers.
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
    work: Floats
    memory: NDArray[np.complex128]
    directed: bool  # whether memories have a direction

    def columns(self) -> dict[str, Floats]:
        """As columns by name; each memory as ``memory_<k>``, with a direction also ``memory_<k>_transverse``."""
        found = self._asdict()
        memory, directed = found.pop("memory"), found.pop("directed")
        for k, values in enumerate(memory):
            found[memory_column(k)] = values.real
            if directed:
                found[memory_column(k, across=True)] = values.imag
        return found


def memory_column(k: int, across: bool = False) -> str:
    """The name of the column of the k-th memory."""
    return f"memory_{k}_transverse" if across else f"memory_{k}"


def memory_columns(law: FrictionLaw) -> list[str]:
    """The names of its columns of memory."""
    directions = (False,) if law.memory_kind == "scalars" else (False, True)
    return [memory_column(k, across) for k in range(law.count()) for across in directions]


def sample(orbit: Orbit, scene: Scene, law: FrictionLaw, n: int) -> Samples:
    """The orbit at n equally spaced times tau = 0 ... its period (end not included)."""
    step = np.ptp(orbit.tau) / orbit.periods / n
    return sample_at(orbit, scene, law, orbit.tau[0, 0] + np.arange(n, dtype=np.float64) * step)


def sample_at(orbit: Orbit, scene: Scene, law: FrictionLaw, times: Floats) -> Samples:
    """The orbit at these times [1/omega_1], within those it is recorded at; law: in the scales of the scene."""
    panels = np.clip(np.searchsorted(orbit.tau[:, 0], times, side="right") - 1, 0, len(orbit.tau) - 1)
    start, end = orbit.tau[panels, 0], orbit.tau[panels, -1]
    places = (2.0 * times - start - end) / (end - start)
    weights = interpolation_weights(places)
    x, v, rub = ((weights * part[panels]).sum(axis=1) for part in (orbit.x, orbit.v, orbit.friction))
    signals = scene.signals()
    along, across = (load(times) for load in signals.load)
    slip = _slip(scene, v, times)
    assert scene.normal_load is not None
    pressed = scene.normal_load + signals.normal_load(times)
    along_belt = not orbit.v.imag.any()  # nothing moves across it
    contact = Contact(slip, rub, pressed / scene.normal_load, along_belt, scene.constant_contact)
    memory = _memory(orbit, scene, law, contact, (weights, panels))
    work = _work(orbit, scene.normal_load, panels, places)
    motion = x.real, v.real, x.imag, v.imag, rub.real, rub.imag
    around = along, across, slip.real, slip.imag, pressed
    return Samples(times, *motion, *around, work, memory, law.memory_kind != "scalars")


def _slip(scene: Scene, v: NDArray[np.complex128], times: Floats) -> NDArray[np.complex128]:
    """The velocity against the belt; of a prescribed slip the oscillation is that of the body."""
    belts = scene.signals().belt if scene.degrees_of_freedom else (Signal(), Signal())
    return np.asarray(v - scene.belt_speed - belts[0](times) - 1j * belts[1](times))


def work_of(orbit: Orbit, scene: Scene) -> float:
    """What friction does on the body over the whole record [K_1 L^2]."""
    assert scene.normal_load is not None
    return float(_work(orbit, scene.normal_load, np.array([len(orbit.tau) - 1]), np.array([1.0]))[0])


def _work(orbit: Orbit, normal_load: float, panels: NDArray[np.int64], places: Floats) -> Floats:
    """What friction has done on the body from the beginning of the orbit to places in these panels."""
    power = orbit.friction.real * orbit.v.real
    # across the belt friction may not be known, where nothing moves
    power = -normal_load * (power + np.where(orbit.v.imag == 0.0, 0.0, orbit.friction.imag * orbit.v.imag))
    half = 0.5 * (orbit.tau[:, -1] - orbit.tau[:, 0])
    before = np.concatenate(([0.0], np.cumsum(half * (power @ WEIGHTS))))
    primitive = places[:, None] ** _POWERS - (-1.0) ** _POWERS
    within = ((primitive @ _PRIMITIVE) * power[panels]).sum(axis=1)
    return np.asarray(before[panels] + half[panels] * within)


def _memory(
    orbit: Orbit, scene: Scene, law: FrictionLaw, contact: Contact, at: tuple[Floats, NDArray[np.int64]]
) -> NDArray[np.complex128]:
    """What the law remembers at samples [count, n], NaN where the record does not tell it.

    at: the weights that interpolate each sample from the nodes of its panel, and the panels.
    """
    weights, panels = at
    if law.count() == 0:
        return np.empty((0, len(weights)), np.complex128)
    known = np.full((law.count(), len(weights)), np.nan + 0j)
    if isinstance(law, BristleLaw):
        known = deflections(law, contact)[None]
    if not np.isnan(known).any():
        return known
    assert scene.normal_load is not None
    share = 1.0 + scene.signals().normal_load(orbit.tau) / scene.normal_load
    slip = _slip(scene, orbit.v, orbit.tau)
    whole = contact._replace(slip=slip, friction=orbit.friction, share=share)
    found = followed(law, orbit.tau, whole)
    if found is None:
        return known
    return np.asarray((weights[:, :, None] * found[panels]).sum(axis=1).T)
