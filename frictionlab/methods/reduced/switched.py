"""Harmonic balance of a mass on Coulomb friction along the belt in two harmonics or more, on its switching angles.

Most motions reverse their slip twice a period: those of all belt speeds are found together (reversals.py). Where
such a motion would slip against its friction, the mass rests on the belt or reverses more often. With the tail, which
lets a mass rest, those are found one by one from the legs of the exact motion (legs.py). A slip of H harmonics and
nothing else cannot rest: it crosses zero again and again instead, and is refused.

Motions of H harmonics on Coulomb friction along the belt, by the legs on which the mass slips or rests.

With R the force of load, dashpot and spring in H harmonics, a mass that is a free one beyond them obeys
x'' = R - friction*lambda exactly. It slips with lambda = +-1, its velocity the integral of R -+ friction; it rests
with lambda = R/friction until that leaves [-1, 1]. R follows from lambda harmonic by harmonic,

    R_k = i k Omega F_k/Z_k + friction*Q_k*lambda_k,    Q_k = (damping + stiffness/(i k Omega))/Z_k,    Q_0 = 1,

Z_k the impedance: at rest a linear equation for R at Gauss nodes. The instants at which legs of slip and of rest
begin remain, found by Newton's method: each slip begins and ends at zero, each rest ends at lambda = +-1, and slip
has the mean of -belt_speed. A mass of H harmonics and nothing else obeys x'' = R - friction*(H harmonics of lambda).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.reduced.common import TOLERANCE, Modelled, line_reasons, line_refusal
from frictionlab.methods.reduced.reversals import (
    DrivenLine,
    Phasors,
    harmonic_impedances,
    response_of_harmonics,
    reversals_at,
)
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.record import Orbit
from frictionlab.motion.orbit.recorder import NODES, WEIGHTS
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.theory import friction_free_velocity
from frictionlab.values.quantities import Floats

_CLOSED = 1e-11
"""Slip and friction at the ends of legs, relative to V_lin and to sliding friction, at which they are balanced."""
_NODES_PER_TURN, _FEWEST_NODES = 1.3, 14
_SAMPLES_PER_HARMONIC, _FEWEST_SAMPLES = 8, 128
_LOOSE = 1e-8
"""What signs of slip and friction at rest may be wrong by, in the units of _CLOSED."""
_PANELS_PER_HARMONIC, _FEWEST_PANELS = 2, 16


class SwitchedLine(NamedTuple):
    """A mass along the belt, its friction and V_lin, in H harmonics; tail: beyond them it is a free one.

    Phases are of the friction-free velocity. compliances [H + 1]: Q_k.
    """

    frequency: float
    friction: float
    friction_free: float
    compliances: Phasors
    tail: bool

    @classmethod
    def of(
        cls, mass: Mass, harmonics: int, friction: float, friction_free: float, tail: bool
    ) -> SwitchedLine:
        """In so many harmonics."""
        inertia = 1j * mass.frequency * np.arange(1.0, harmonics + 1.0)
        compliances = (mass.damping + mass.stiffness / inertia) / harmonic_impedances(mass, harmonics)
        return cls(mass.frequency, friction, friction_free, np.concatenate([[1.0], compliances]), tail)


class LegStarts(NamedTuple):
    """Phases at which legs begin [..., leg], ascending within a period, and the direction of slip on each.

    That is 0 for rest. Where slip never reverses there is one leg, which begins at phase 0.
    """

    starts: Floats
    kinds: NDArray[np.int64]

    @property
    def lengths(self) -> Floats:
        """To the start of the next."""
        return np.diff(self.starts, append=self.starts[..., :1] + math.tau)


class Force(NamedTuple):
    """R: real parts of coefficients[k] exp(i k phase), and friction's harmonics likewise [..., H + 1]."""

    coefficients: Phasors
    friction: Phasors

    def at(self, phase: Floats, *integrals: int) -> list[Floats]:
        """R at phases [..., n] for 0 among ``integrals``, its integral over the phase once or twice for 1 or 2."""
        orders = np.arange(1.0, self.coefficients.shape[-1])
        turns = np.exp(1j * phase[..., None] * orders)
        means = [self.coefficients[..., :1].real * phase**n / max(n, 1) for n in integrals]
        waves = [self.coefficients[..., 1:, None] / (1j * orders[:, None]) ** n for n in integrals]
        return [mean + (turns @ wave)[..., 0].real for mean, wave in zip(means, waves, strict=True)]


def force_on(line: SwitchedLine, legs: LegStarts) -> Force:
    """R and friction's harmonics of legs that need not be balanced yet; many of the same kinds, or one that rests."""
    q = line.compliances
    orders = np.arange(len(q))
    turns = np.exp(-1j * legs.starts[..., None, :] * orders[1:, None])
    slips = np.empty((*legs.starts.shape[:-1], len(q)), np.complex128)
    slips[..., 0] = legs.lengths @ legs.kinds / math.tau
    slips[..., 1:] = (turns - np.roll(turns, -1, axis=-1)) @ legs.kinds / (1j * math.pi * orders[1:])
    base = line.friction * q * slips
    base[..., 1] += line.frequency * line.friction_free
    if legs.kinds.all():
        return Force(base, slips)
    phases, weights = _rest_nodes(line, legs)
    turn = np.exp(1j * np.multiply.outer(phases, orders))
    shares = np.where(orders > 0, 1.0, 0.5) / math.pi
    kernel = ((turn * (q * shares)) @ turn.conj().T).real * weights
    at_rest = np.linalg.solve(np.eye(len(phases)) - kernel, (turn @ base).real)
    held = shares * (turn.conj().T @ (weights * at_rest))
    return Force(base + q * held, slips + held / line.friction)


def _rest_nodes(line: SwitchedLine, legs: LegStarts) -> tuple[Floats, Floats]:
    """Gauss nodes and weights of the rests, as many as waves of the highest harmonic ask for."""
    phases, weights = [], []
    for start, length in zip(legs.starts[legs.kinds == 0], legs.lengths[legs.kinds == 0], strict=True):
        turned = length * len(line.compliances) / 2.0
        gauss, shares = _gauss(_FEWEST_NODES + math.ceil(_NODES_PER_TURN * abs(turned)))
        phases.append(start + 0.5 * length * (1.0 + gauss))
        weights.append(0.5 * length * shares)
    return np.concatenate(phases), np.concatenate(weights)


_gauss = cache(np.polynomial.legendre.leggauss)


def balanced_legs(line: SwitchedLine, legs: LegStarts, belt_speed: float) -> LegStarts | None:
    """Legs like these on a belt of speed >= 0, with the tail; None where Newton's method finds none that hold."""
    from scipy.optimize import root

    def missing(starts: Floats) -> Floats:
        return _missing(line, legs._replace(starts=starts), belt_speed)

    found = legs._replace(starts=root(missing, legs.starts, options={"eps": 1e-14, "xtol": 1e-11}).x)
    if np.abs(missing(found.starts)).max() > _CLOSED or not holds(line, found, force_on(line, found)):
        return None
    return found


def _missing(line: SwitchedLine, legs: LegStarts, belt_speed: float) -> Floats:
    """What legs lack of balance: slip at the ends of slips, the mean of slip, friction at the ends of rests."""
    starts, lengths, kinds, force = legs.starts, legs.lengths, legs.kinds, force_on(line, legs)
    edges, slips = np.append(starts, starts[0] + math.tau), kinds != 0
    held, first, second = force.at(edges, 0, 1, 2)
    gained = (np.diff(first) - line.friction * kinds * lengths) / line.frequency
    swept = np.diff(second) - first[:-1] * lengths - 0.5 * line.friction * kinds * lengths**2
    lacking = gained / line.friction_free
    # The gains of all slips add up to zero by themselves: in place of one of them the mean of slip. What a slip
    # leaves over at the start of the next leg adds to its integral until every slip ends at zero.
    over = np.concatenate([[0.0], np.cumsum(np.where(slips, gained, 0.0))[:-1]])
    mean = (swept[slips].sum() / line.frequency + over @ lengths) / math.tau
    lacking[int(np.flatnonzero(slips)[0])] = (mean + belt_speed) / line.friction_free
    lacking[~slips] = held[1:][~slips] / line.friction - np.roll(kinds, -1)[~slips]
    return np.asarray(lacking)


def _accelerating(line: SwitchedLine, force: Force) -> tuple[Force, float]:
    """What accelerates a slipping mass: a force in H harmonics, and beside it friction of this size as it is."""
    if line.tail:
        return force, line.friction
    return Force(force.coefficients - line.friction * force.friction, force.friction), 0.0


def holds(line: SwitchedLine, legs: LegStarts, force: Force) -> NDArray[np.bool_]:
    """Whether slip has its direction on every leg, and friction at rest does not exceed that of sliding.

    At equal steps of the period, and where legs begin.
    """
    pulls, friction = _accelerating(line, force)
    harmonics = force.coefficients.shape[-1] - 1
    count = max(_FEWEST_SAMPLES, _SAMPLES_PER_HARMONIC * harmonics)
    orders = np.arange(1, harmonics + 1)
    spectra = np.zeros((2, *pulls.coefficients.shape[:-1], count // 2 + 1), np.complex128)
    spectra[:, ..., 1 : harmonics + 1] = 0.5 * count * pulls.coefficients[..., 1:]
    spectra[1, ..., 1 : harmonics + 1] /= 1j * orders
    mean = pulls.coefficients[..., :1].real
    value, integral = np.fft.irfft(spectra, count)
    # Phases since the first leg began, the leg that each is on, and how long that lasts already.
    since = np.mod(np.arange(count) * (math.tau / count) - legs.starts[..., :1], math.tau)
    offsets = legs.starts - legs.starts[..., :1]
    leg = (since[..., None, :] >= offsets[..., :, None]).sum(axis=-2) - 1
    since, kind = since - np.take_along_axis(offsets, leg, axis=-1), legs.kinds[leg]
    pull, begun = pulls.at(legs.starts, 0, 1)
    slip = (
        integral
        - np.take_along_axis(begun - mean * legs.starts, leg, axis=-1)
        + (mean - friction * kind) * since
    )
    least = -_LOOSE * line.friction_free * line.frequency
    slips = np.where(kind == 0, 0.0, kind * slip).min(axis=-1) >= least
    rests = np.where(kind == 0, np.abs(value + mean), 0.0).max(axis=-1) <= line.friction * (1.0 + _LOOSE)
    onset = legs.kinds * (pull - friction * legs.kinds)
    goes_on = (onset >= -line.friction * _LOOSE).all(axis=-1) & (legs.lengths > 0.0).all(axis=-1)
    return np.asarray(slips & rests & goes_on)


def orbit_of(line: SwitchedLine, legs: LegStarts, belt_speed: float, lead: float) -> Orbit:
    """One period about the mean position, friction relative to that of sliding, of legs that hold.

    lead: the phase at tau = 0. Panels are short enough for the highest harmonic.
    """
    force = force_on(line, legs)
    pulls, friction = _accelerating(line, force)
    widest = math.tau / max(_FEWEST_PANELS, _PANELS_PER_HARMONIC * len(line.compliances))
    counts = np.ceil(legs.lengths / widest).astype(np.int64)
    parts = [
        start + length * np.arange(count) / count
        for start, length, count in zip(legs.starts, legs.lengths, counts, strict=True)
    ]
    edges = np.append(np.concatenate(parts), legs.starts[0] + math.tau)
    width, kind = np.diff(edges)[:, None], np.repeat(legs.kinds, counts)[:, None]
    phase = edges[:-1, None] + 0.5 * width * (1.0 + NODES)
    since, fall = phase - phase[:, :1], friction * kind
    first, second = pulls.at(phase, 1, 2)
    slips = np.where(kind == 0, 0.0, 1.0) / line.frequency
    gain = slips * (first - first[:, :1] - fall * since)
    # Slip begins at zero; where it never reverses, x1' is zero at phase 0.
    slip = _joined(gain) - (belt_speed if len(legs.kinds) == 1 else 0.0)
    swept = slips * (second - second[:, :1] - first[:, :1] * since - 0.5 * fall * since**2)
    x = _joined((swept + (slip[:, :1] + belt_speed) * since) / line.frequency)
    x = x - (width * WEIGHTS * x).sum() / (2.0 * math.tau)
    rub = np.where(kind == 0, force.at(phase, 0)[0] / line.friction, kind)
    tau, at_once = (phase - lead) / line.frequency, np.array([x, slip + belt_speed, rub], np.complex128)
    return Orbit(tau, at_once[0], at_once[1], at_once[2], kind[:, 0] == 0)


def _joined(panels: Floats) -> Floats:
    """Gains within panels, with what all panels before have gained."""
    return panels + np.concatenate([[0.0], np.cumsum(panels[:, -1])[:-1]])[:, None]


CROSSES_AGAIN = (
    "the slip of {harmonics} harmonics crosses zero more than twice a period: it cannot rest on the belt; give "
    "tail: true, or use exact"
)
NOT_FOUND = (
    "no motion of {harmonics} harmonics found near the legs of slip and rest that exact finds; use exact"
)
_SAME = 1e-9
"""Distance of the belt speed of a motion from the one asked for, relative to V_lin."""


class Switched(NamedTuple):
    """Motions at belt speeds >= 0: their means relative to mu, NaN without one, and their legs."""

    mean: Floats
    legs: list[LegStarts | None]


def switched_refusal(name: str, scene: Scene, law: FrictionLaw, harmonics: int) -> str | None:
    """Why H harmonics cannot do this scene and law at any belt speed; None if they can."""
    reason = line_refusal(name, scene, law)
    if reason is not None:
        return reason
    resonant = 1 + np.flatnonzero(harmonic_impedances(scene.mass(), harmonics) == 0.0)
    if len(resonant):
        return f"{name}: without damping, harmonic {resonant[0]} of friction drives the mass without bound"
    return None


def switched(scenes: Sequence[Scene], law: FrictionLaw, harmonics: int, tail: bool) -> Modelled:
    """The motions of H harmonics of scenes that differ in belt speed alone."""
    mu, speeds, mass = law.sliding_friction(1.0), belt_speeds_of(scenes), scenes[0].mass()
    friction, free = mu * mass.normal_load, friction_free_velocity(scenes[0])
    line = SwitchedLine.of(mass, harmonics, friction, free, tail)
    found = switched_motions(scenes[0], law, line, np.abs(speeds))
    mean = mu * np.copysign(1.0, speeds) * found.mean
    without = (NOT_FOUND if tail else CROSSES_AGAIN).format(harmonics=harmonics)
    reasons = line_reasons(scenes[0], friction, speeds, mean, without)

    def orbit(i: int) -> Orbit | None:
        legs, side = found.legs[i], math.copysign(1.0, speeds[i])
        if legs is None:
            return None
        one = orbit_of(line, legs, abs(float(speeds[i])), _lead(scenes[0]))
        # On a belt that runs backward the same motion the other way, half a period later.
        tau = one.tau - (0.0 if side > 0.0 else math.pi / mass.frequency)
        x = side * one.x + mass.normal_load * mean[i]
        return replace(one, tau=tau, x=x, v=side * one.v, friction=mu * side * one.friction)

    beyond = ModelWord.TAIL if tail else ModelWord.NO_TAIL
    return Modelled(mean, reasons, f"{harmonics} {ModelWord.SWITCHED}; {beyond}", orbit)


def switched_motions(scene: Scene, law: FrictionLaw, line: SwitchedLine, speeds: Floats) -> Switched:
    """Those of a scene at belt speeds >= 0."""
    never = LegStarts(np.zeros(1), np.array([-1]))
    found = Switched(np.ones(len(speeds)), [never for _ in speeds])
    reverses = np.flatnonzero(speeds < line.friction_free)
    if not len(reverses):
        return found
    response = response_of_harmonics(scene.mass(), len(line.compliances) - 1, line.tail)
    two = reversals_at(DrivenLine(response, line.friction, line.friction_free), speeds[reverses])
    same = np.abs(two.belt_speed - speeds[reverses]) <= _SAME * line.friction_free
    ends = np.where(same, two.middle, 0.0)[:, None] + two.half[:, None] * np.array([-1.0, 1.0])
    slips = LegStarts(ends, np.array([1, -1]))
    same &= holds(line, slips, force_on(line, slips))
    found.mean[reverses] = np.where(same, 1.0 - 2.0 / math.pi * two.half, np.nan)
    for place, settled, row in zip(reverses.tolist(), same, ends, strict=True):
        found.legs[place] = LegStarts(row, slips.kinds) if settled else None
    if line.tail and not same.all():
        _add_rests(scene, law, line, speeds, found)
    return found


def _add_rests(scene: Scene, law: FrictionLaw, line: SwitchedLine, speeds: Floats, found: Switched) -> None:
    """Motions that rest or reverse often, from the legs that exact finds."""
    places = [place for place, legs in enumerate(found.legs) if legs is None]
    scenes = [scene.model_copy(update={"belt_speed": float(speeds[place])}) for place in places]
    full = Exact().solve(scenes, law, TOLERANCE * law.sliding_friction(1.0))
    for k, place in enumerate(places):
        orbit = full.orbit(k) if full.status[k] == "ok" else None
        if orbit is not None:
            legs = balanced_legs(line, _legs_of(orbit, scene), float(speeds[place]))
            if legs is not None:
                found.legs[place] = legs
                found.mean[place] = -force_on(line, legs).friction[0].real


def _legs_of(orbit: Orbit, scene: Scene) -> LegStarts:
    """The legs of an orbit of Coulomb friction along the belt."""
    assert orbit.stick is not None
    kinds = np.where(orbit.stick, 0, np.sign(orbit.friction[:, 1].real)).astype(np.int64)
    begins = kinds != np.roll(kinds, 1)
    return LegStarts(scene.frequency * orbit.tau[begins, 0] + _lead(scene), kinds[begins])


def _lead(scene: Scene) -> float:
    """The phase of the friction-free velocity at tau = 0 [rad]."""
    mass = scene.mass()
    return float(np.angle(mass.force) - np.angle(harmonic_impedances(mass, 1)[0]))
