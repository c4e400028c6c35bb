"""The orbit of a motion along the belt that H harmonics of force drive between the switches of friction."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from frictionlab.methods.reduced.balanced_rests import Force, LegStarts
from frictionlab.orbit.panels import NODES, WEIGHTS
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats

_PANELS_PER_HARMONIC = 2
_FEWEST_PANELS = 16


class BalancedMotion(NamedTuple):
    """A motion in phases of the friction-free velocity, on a belt of speed >= 0, friction of size 1.

    force: what accelerates the mass beside its free fall under ``step`` times friction's sign on every leg: 0 where
    the force holds all there is of friction. slip: at the first start of a leg.
    """

    legs: LegStarts
    force: Force
    step: float
    friction: float
    frequency: float
    belt_speed: float
    slip: float


def orbit_of(motion: BalancedMotion, lead: float, side: float, mu: float, position: float) -> Orbit:
    """One period, its mean position given; on a belt that runs backward, side -1, half a period later.

    lead: the phase at tau = 0.
    """
    phase, kinds = _phases(motion)
    slip, displacement = _followed(motion, phase, kinds)
    resting = motion.force.at(phase) / motion.friction
    friction = np.where(kinds[:, None] == 0, resting, kinds[:, None])
    width = np.ptp(phase, axis=1) / (2.0 * math.tau)
    displacement = displacement - (width[:, None] * WEIGHTS * displacement).sum()
    x, v = position + side * displacement, side * (slip + motion.belt_speed)
    tau = (phase - lead - (0.0 if side > 0.0 else math.pi)) / motion.frequency
    rub = mu * side * friction
    return Orbit(tau, x.astype(np.complex128), v.astype(np.complex128), rub.astype(np.complex128), kinds == 0)


def _phases(motion: BalancedMotion) -> tuple[Floats, Floats]:
    """Nodes of panels short enough for the highest harmonic, and the kind of leg that each panel lies on."""
    widest = math.tau / max(_FEWEST_PANELS, _PANELS_PER_HARMONIC * len(motion.force.coefficients))
    edges, kinds = [], []
    for start, length, kind in zip(motion.legs.starts, motion.legs.lengths, motion.legs.kinds, strict=True):
        count = math.ceil(length / widest)
        edges.append(start + length * np.arange(count) / count)
        kinds.append(np.full(count, float(kind)))
    ends = np.append(np.concatenate(edges), motion.legs.starts[0] + math.tau)
    half = 0.5 * np.diff(ends)[:, None]
    return ends[:-1, None] + half * (1.0 + NODES), np.concatenate(kinds)


def _followed(motion: BalancedMotion, phase: Floats, kinds: Floats) -> tuple[Floats, Floats]:
    """Slip velocity and displacement at the nodes, panel by panel from the first on."""
    since = phase - phase[:, :1]
    fall = motion.step * kinds[:, None]
    first, second = motion.force.at(phase, 1), motion.force.at(phase, 2)
    gain = (first - first[:, :1] - fall * since) / motion.frequency
    gain = np.where((kinds == 0.0)[:, None], 0.0, gain)
    slip = motion.slip + gain + _sums(gain)
    swept = second - second[:, :1] - first[:, :1] * since - 0.5 * fall * since**2
    swept = np.where((kinds == 0.0)[:, None], 0.0, swept) / motion.frequency
    way = (swept + (slip[:, :1] + motion.belt_speed) * since) / motion.frequency
    return slip, way + _sums(way)


def _sums(panels: Floats) -> Floats:
    """What all panels before have gained, for each."""
    return np.concatenate([[0.0], np.cumsum(panels[:, -1])[:-1]])[:, None]
