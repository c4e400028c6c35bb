"""Instants at which Coulomb friction along a line switches, moved to where the slip that they cause vanishes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.methods.reduced.switching import Jumps
from frictionlab.quantities import EPSILON, Floats

NEWTON_STEPS = 12
"""Newton steps at most, those taken back and shortened included."""
SETTLED = 1e-12
"""Slip at a switch, relative to the largest, that may stay."""


class Driven(NamedTuple):
    """A 1DOF mass in the numbers needed.

    friction = mu*normal_load [K_1 L]; free: phasors of orders 1, 2 ... of the velocity that it has, or its slip
    about the mean belt speed, without friction: the imaginary part of the sum of phasor*exp(i order frequency tau).
    """

    damping_ratio: float
    frequency: float
    friction: float
    free: NDArray[np.complex128]

    def free_velocity(self, at: Floats) -> tuple[Floats, Floats]:
        """The friction-free velocity and its time derivative."""
        velocity, slope = np.zeros(at.shape), np.zeros(at.shape)
        for order, phasor in enumerate(self.free, 1):
            rate = order * self.frequency
            angle = rate * at + np.angle(phasor)
            velocity = velocity + abs(phasor) * np.sin(angle)
            slope = slope + abs(phasor) * rate * np.cos(angle)
        return velocity, slope

    def unsure(self) -> float:
        """What rounding may change the friction-free velocity by, relative to it: more next to undamped resonance."""
        rates = self.frequency * np.flatnonzero(self.free) + self.frequency
        impedances = np.abs(2.0 * self.damping_ratio + 1j * (rates - 1.0 / rates))
        return 16.0 * EPSILON * float(np.max(1.0 + (rates + 1.0 / rates) / impedances, initial=1.0))


class Switched(NamedTuple):
    """Friction of size 1 that switches: instants (row, switch), ascending within a period, and its sign after each.

    The sign is that of the slip velocity. A switch between equal signs does nothing: rows of fewer switches may
    repeat one.
    """

    switches: Floats
    signs: Floats

    def jumps(self) -> Floats:
        """Of friction at each switch."""
        return self.signs - np.roll(self.signs, 1, axis=1)


def one_wave(velocity: NDArray[np.complex128], frequency: float, belt_speeds: Floats) -> Switched:
    """The friction along harmonic velocities Im(velocity exp(i frequency tau)) on belts of speed >= 0."""
    size = np.abs(velocity)
    half = np.arccos(np.minimum(belt_speeds / np.where(size > 0.0, size, np.inf), 1.0))
    peak = 0.5 * np.pi - np.angle(velocity)
    switches = np.stack([peak - half, peak + half], axis=1) / frequency
    return Switched(switches, np.broadcast_to(np.array([1.0, -1.0]), switches.shape))


def settled(body: Driven, trial: Switched, belt_speeds: Floats) -> Switched:
    """The trial with its switches moved to where the slip they cause vanishes, by Newton's method.

    Rows are left where steps no longer lead on: a switch that sticks has no such place.
    """
    jumps = Jumps.of(body.damping_ratio, body.frequency)
    switches = trial.switches.copy()
    slip, slopes = _slip_at_switches(body, jumps, trial, belt_speeds)
    size, share = np.abs(slip).max(axis=1), np.ones(len(switches))
    enough = SETTLED * (np.abs(body.free).sum() + belt_speeds)
    for _ in range(NEWTON_STEPS):
        rows = np.flatnonzero((size > enough) & (share > 1e-3))
        if not len(rows):
            break
        step = share[rows, None] * _solved(slopes[rows], slip[rows])
        moved = Switched(switches[rows] - step, trial.signs[rows])
        found, turned = _slip_at_switches(body, jumps, moved, belt_speeds[rows])
        left = np.abs(found).max(axis=1)
        better = (left < size[rows]) & _ordered(moved.switches, jumps.period)
        share[rows] = np.where(better, np.minimum(1.0, 4.0 * share[rows]), 0.25 * share[rows])
        taken = rows[better]
        switches[taken], slip[taken], slopes[taken] = moved.switches[better], found[better], turned[better]
        size[taken] = left[better]
    return Switched(switches, trial.signs)


def _slip_at_switches(
    body: Driven, jumps: Jumps, trial: Switched, belt_speeds: Floats
) -> tuple[Floats, Floats]:
    """The slip velocity at each switch, and its derivatives (row, switch, other switch)."""
    switches, jump = trial.switches, body.friction * trial.jumps()[:, None, :]
    since = np.mod(switches[:, :, None] - switches[:, None, :], jumps.period)
    free, slope = body.free_velocity(switches)
    slopes = jump * jumps.slope(since)
    own = np.arange(switches.shape[1])
    slopes[:, own, own] = 0.0
    slopes[:, own, own] = slope - slopes.sum(axis=2)
    return free - (jump * jumps.rise(since)).sum(axis=2) - belt_speeds[:, None], slopes


def _solved(matrices: Floats, sides: Floats) -> Floats:
    """Of each row; NaN where one of them is singular."""
    try:
        return np.asarray(np.linalg.solve(matrices, sides[:, :, None])[:, :, 0], np.float64)
    except np.linalg.LinAlgError:
        return np.full(sides.shape, np.nan)


def _ordered(switches: Floats, period: float) -> NDArray[np.bool_]:
    """Whether switches still ascend within a period."""
    gaps = np.diff(switches, axis=1, append=switches[:, :1] + period)
    return np.asarray((gaps >= 0.0).all(axis=1))
