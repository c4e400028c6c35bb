"""Motions of H harmonics, a free mass beyond them, that rest on the belt for part of the period or reverse often.

With R the force of load, dashpot and spring in H harmonics, the mass obeys x'' = R - friction*lambda exactly: R acts
on it as on a free mass. It slips with lambda = +-1, its velocity the integral of R -+ friction; it rests with
lambda = R/friction until that leaves [-1, 1]. R follows from lambda harmonic by harmonic,

    R_k = i k Omega F_k/Z_k + friction*Q_k*lambda_k,    Q_k = (damping + stiffness/(i k Omega))/Z_k,    Q_0 = 1,

Z_k the impedance: at rest a linear equation for R at Gauss nodes. The instants at which legs of slip and of rest
begin remain, found by Newton's method: each slip begins and ends at zero, each rest ends at lambda = +-1, and slip
has the mean of -belt_speed.
"""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.methods.reduced.switch_response import harmonic_impedances
from frictionlab.quantities import Floats
from frictionlab.scene.body import Mass

_MOST_STEPS = 30
_MOST_LOST = 0.75
"""Of the length of a leg in a step."""
_STEP = 1e-7
"""Of an instant [rad], for its effect."""
_CLOSED = 1e-11
"""Slip and friction at the ends of legs, relative to V_lin and to sliding friction, at which they are balanced."""
_NODES_PER_TURN = 1.3
_FEWEST_NODES = 14
_SAMPLES = 24
"""Of a leg, and as many for each wavelength of the highest harmonic in it divided by _PER_WAVE."""
_PER_WAVE = 4.0
_LOOSE = 1e-7
"""What signs of slip and friction at rest may be wrong by, in the same units."""


class FreeMassLine(NamedTuple):
    """A mass along the belt whose spring and dashpot act in H harmonics alone.

    Phases are of the friction-free velocity; compliances [H + 1]: Q_k.
    """

    frequency: float
    friction: float
    friction_free: float
    compliances: NDArray[np.complex128]


class LegStarts(NamedTuple):
    """Phases at which legs begin, ascending within a period, and the direction of slip on each, 0 for rest."""

    starts: Floats
    kinds: NDArray[np.int64]

    @property
    def lengths(self) -> Floats:
        """To the start of the next."""
        return np.diff(self.starts, append=self.starts[0] + math.tau)


class BalancedLegs(NamedTuple):
    """LegStarts and the force on them."""

    legs: LegStarts
    force: Force


class Force(NamedTuple):
    """R: real parts of coefficients[k] exp(i k phase), and friction's harmonics likewise."""

    coefficients: NDArray[np.complex128]
    friction: NDArray[np.complex128]

    def at(self, phase: Floats, integrals: int = 0) -> Floats:
        """R, or its integral over the phase once or twice."""
        orders = np.arange(1.0, len(self.coefficients))
        turns = np.exp(1j * np.multiply.outer(phase, orders))
        mean = self.coefficients[0].real * phase**integrals / (2.0 if integrals == 2 else 1.0)
        return np.asarray(mean + (turns @ (self.coefficients[1:] / (1j * orders) ** integrals)).real)


def free_mass_line(mass: Mass, harmonics: int, friction: float, friction_free: float) -> FreeMassLine:
    """Of a mass along the belt."""
    inertia = 1j * mass.frequency * np.arange(1.0, harmonics + 1.0)
    compliances = (mass.damping + mass.stiffness / inertia) / harmonic_impedances(mass, harmonics)
    return FreeMassLine(mass.frequency, friction, friction_free, np.concatenate([[1.0], compliances]))


def balanced_legs(line: FreeMassLine, trial: LegStarts, belt_speed: float) -> BalancedLegs | None:
    """LegStarts like those of the trial on a belt of speed >= 0; None where Newton's method finds none that hold."""
    legs, force = trial, force_on(line, trial)
    missing = _missing(line, legs, force, belt_speed)
    effects = np.column_stack([_effect(line, legs, missing, belt_speed, k) for k in range(len(missing))])
    for _ in range(_MOST_STEPS):
        if np.abs(missing).max() <= _CLOSED:
            return BalancedLegs(legs, force) if _holds(line, legs, force) else None
        try:
            step = _shortened(legs, np.linalg.solve(effects, -missing).astype(np.float64))
        except np.linalg.LinAlgError:
            return None
        legs = legs._replace(starts=legs.starts + step)
        force = force_on(line, legs)
        found = _missing(line, legs, force, belt_speed)
        # What the step did and what it should have done correct the effects (Broyden).
        way = max(float((step**2).sum()), 1e-300)
        effects = effects + np.outer(found - missing - effects @ step, step) / way
        missing = found
    return None


def _effect(line: FreeMassLine, legs: LegStarts, missing: Floats, belt_speed: float, k: int) -> Floats:
    """What moving the start of leg k changes, per radian."""
    moved = legs._replace(starts=legs.starts + _STEP * (np.arange(len(legs.starts)) == k))
    return np.asarray((_missing(line, moved, force_on(line, moved), belt_speed) - missing) / _STEP)


def _shortened(legs: LegStarts, step: Floats) -> Floats:
    """A Newton step, shortened where a leg would lose more than _MOST_LOST of its length."""
    lost = float(np.max((step - np.roll(step, -1)) / legs.lengths))
    return np.asarray(step * min(1.0, _MOST_LOST / max(lost, _MOST_LOST)))


def force_on(line: FreeMassLine, legs: LegStarts) -> Force:
    """R and friction's harmonics of legs that need not be balanced yet."""
    q = line.compliances
    orders = np.arange(len(q))
    ends = np.append(legs.starts, legs.starts[0] + math.tau)
    turns = np.exp(-1j * np.multiply.outer(orders[1:], ends))
    slips = np.empty(len(q), np.complex128)
    slips[0] = legs.kinds @ legs.lengths / math.tau
    slips[1:] = (turns[:, :-1] - turns[:, 1:]) @ legs.kinds / (1j * math.pi * orders[1:])
    base = line.friction * q * slips
    base[1] += line.frequency * line.friction_free
    if legs.kinds.all():
        return Force(base, slips)
    nodes, weights = _rest_nodes(line, legs)
    turn = np.exp(1j * np.multiply.outer(nodes, orders))
    shares = np.where(orders > 0, 1.0, 0.5) / math.pi
    kernel = ((turn * (q * shares)) @ turn.conj().T).real * weights
    at_rest = np.linalg.solve(np.eye(len(nodes)) - kernel, (turn @ base).real)
    held = shares * (turn.conj().T @ (weights * at_rest))
    return Force(base + q * held, slips + held / line.friction)


def _rest_nodes(line: FreeMassLine, legs: LegStarts) -> tuple[Floats, Floats]:
    """Gauss nodes of the rests, as many as waves of the highest harmonic ask for."""
    nodes, weights = [], []
    for start, length in zip(legs.starts[legs.kinds == 0], legs.lengths[legs.kinds == 0], strict=True):
        turned = length * len(line.compliances) / 2.0
        gauss, shares = _gauss(_FEWEST_NODES + math.ceil(_NODES_PER_TURN * turned))
        nodes.append(start + 0.5 * length * (1.0 + gauss))
        weights.append(0.5 * length * shares)
    return np.concatenate(nodes), np.concatenate(weights)


@cache
def _gauss(count: int) -> tuple[Floats, Floats]:
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return nodes.astype(np.float64), weights.astype(np.float64)


def _missing(line: FreeMassLine, legs: LegStarts, force: Force, belt_speed: float) -> Floats:
    """What legs lack of balance: slip at the ends of slips, the mean of slip, friction at the ends of rests."""
    starts, lengths, kinds = legs.starts, legs.lengths, legs.kinds
    ends = starts + lengths
    slips, rests = kinds != 0, kinds == 0
    first = [force.at(each, 1) for each in (starts, ends)]
    second = [force.at(each, 2) for each in (starts, ends)]
    gained = (first[1] - first[0] - line.friction * kinds * lengths) / line.frequency
    swept = second[1] - second[0] - first[0] * lengths - 0.5 * line.friction * kinds * lengths**2
    lacking = gained / line.friction_free
    # The gains of all slips add up to zero by themselves: in place of one of them the mean of slip.
    one = int(np.flatnonzero(slips)[0])
    mean = (swept[slips].sum() / line.frequency + _before(gained, lengths, slips)) / math.tau
    lacking[one] = (mean + belt_speed) / line.friction_free
    lacking[rests] = force.at(ends[rests]) / line.friction - np.roll(kinds, -1)[rests]
    return np.asarray(lacking)


def _before(gained: Floats, lengths: Floats, slips: NDArray[np.bool_]) -> float:
    """What slip left over at the starts of legs adds to its integral: nothing once every slip ends at zero."""
    return float((np.concatenate([[0.0], np.cumsum(np.where(slips, gained, 0.0))[:-1]]) * lengths).sum())


def _holds(line: FreeMassLine, legs: LegStarts, force: Force) -> bool:
    """Whether slip has its direction on every leg, and friction at rest does not exceed that of sliding."""
    for start, length, kind in zip(legs.starts, legs.lengths, legs.kinds, strict=True):
        count = _SAMPLES + math.ceil(_PER_WAVE * length * len(line.compliances))
        phase = start + length * (np.arange(count) + 0.5) / count
        if kind == 0:
            if np.abs(force.at(phase)).max() > line.friction * (1.0 + _LOOSE):
                return False
        else:
            slip = (
                force.at(phase, 1) - force.at(np.array([start]), 1) - line.friction * kind * (phase - start)
            )
            if (kind * slip).min() < -_LOOSE * line.friction_free * line.frequency:
                return False
    return bool(legs.lengths.min() > 0.0)
