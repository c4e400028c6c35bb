"""One period of a harmonic motion on bristle friction, sampled as every orbit is."""

from __future__ import annotations

import cmath
import math

import numpy as np

from frictionlab.kernel import compiled
from frictionlab.laws.bristle import BristleLaw
from frictionlab.methods.base import Floats, Orbit
from frictionlab.methods.harmonic_bristle_balance import Balance, contact_of
from frictionlab.methods.harmonic_bristle_friction import NODES as RADAU
from frictionlab.methods.harmonic_bristle_friction import friction_over
from frictionlab.methods.harmonic_bristle_settle import panel_edges
from frictionlab.methods.radau_panel import STAGES
from frictionlab.orbit import NODES
from frictionlab.scene import Scene


def orbit_of_one_harmonic(scene: Scene, law: BristleLaw, balance: Balance) -> Orbit:
    """The motion about the position where its mean friction loads the spring; friction over it."""
    mass, amplitude = scene.mass(), balance.amplitude
    side = math.copysign(1.0, scene.belt_speed)
    lead = cmath.phase(mass.force) - balance.lag
    phasor = side * cmath.rect(amplitude, lead)  # seen from a belt that moves forward
    edges = panel_edges(mass, abs(scene.belt_speed), contact_of(law), np.array([phasor]))
    edges = edges - 2.0 * math.pi * math.floor(edges[0] / (2.0 * math.pi))
    friction = side * _between(_friction(scene, law, phasor, edges))
    angle = edges[:-1, None] + 0.5 * np.diff(edges)[:, None] * (1.0 + NODES)
    moving = amplitude * np.exp(1j * (angle + lead))
    position = -side * mass.normal_load * balance.friction.mean - moving.real / mass.frequency
    stick = np.zeros(len(angle), np.bool_)
    x, v, along = (part.astype(np.complex128) for part in (position, moving.imag, friction))
    return Orbit(angle / mass.frequency, x, v, along, stick)


def _friction(scene: Scene, law: BristleLaw, phasor: complex, edges: Floats) -> Floats:
    """At the Radau nodes of the panels."""
    half = 0.5 * np.diff(edges)
    angle = edges[:-1, None] + half[:, None] * (1.0 + RADAU)
    slip = (phasor * np.exp(1j * angle)).imag - abs(scene.belt_speed)
    entry = compiled(friction_over, law)
    return np.asarray(entry(contact_of(law), half / scene.frequency, slip))


def _between(friction: Floats) -> Floats:
    """From Radau nodes to those of an orbit, by the polynomial through them and the end of the panel before."""
    before = np.roll(friction[:, -1], 1)[:, None]
    at = np.concatenate([[-1.0], RADAU])
    powers = np.arange(STAGES + 1.0)
    weights = NODES[:, None] ** powers @ np.linalg.inv(at[:, None] ** powers)
    return np.concatenate([before, friction], axis=1) @ weights.T
