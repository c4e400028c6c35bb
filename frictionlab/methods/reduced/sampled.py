"""H harmonics of motion and of friction without memory, balanced on samples of a period, on the line or in the plane.

Friction is taken at equal steps of the angle = frequency*tau, and its harmonics from there by FFT (alternating
frequency and time). Along the belt it jumps where slip reverses: the part that does, the friction of vanishing slip
times the sign of slip, has all its harmonics in closed form from the instants of reversal, and only what is left,
which vanishes there, is sampled. In the plane friction turns, the more steeply the closer slip passes to rest, and
samples are added until that is resolved. Newton's method uses the derivative of friction by the slip velocity, whose
harmonics couple every harmonic of motion with every other. Where it does not settle along the belt, as where a mass
rests and its harmonics cross zero again and again, the jump is spread over slip speeds at first.

Source: Cameron & Griffin, J. Appl. Mech. 56 (1989), 149-154, of alternating frequency and time.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.compile.lane_arrays import takes_lanes
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.prescribed.varying_slip import VaryingSlip, sliding_vectors
from frictionlab.methods.reduced.common import (
    Modelled,
    line_reasons,
    line_refusal,
    mean_position,
    plane_refusal,
)
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.record import Orbit
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.values.quantities import Floats

Phasors = NDArray[np.complex128]
NOT_SETTLED = (
    "Newton's method does not settle on a motion of {} harmonics: slip passes too near rest for so few, or "
    "crosses zero there again and again; use shooting"
)
_SAMPLES, _PER_HARMONIC = {1: (2048, 2**16), 2: (128, 2**13)}, 8
"""Fewest and most of a period by directions: on the line their error falls as a power, in the plane exponentially."""
_ENOUGH, _MORE = 1e-9, 4
"""Force that balance may lack on twice as many samples, relative to friction; how many times more are taken else."""
_CLOSED = 1e-12
"""Force that balance lacks, relative to load and friction."""
_ROUNDED = 1e4
"""Multiple of it that may be left where no step gains anything more."""
_MOST_STEPS = 40
_SPREADS = 0.5 ** np.arange(14)
"""Slip speeds over which a jump is spread, one after the other, relative to the largest velocity."""
_SHORTEST_STEP = 1e-3
_SLOWEST = 1e-12
"""Slip speed below which friction is as at this one, relative to the largest; the law gives none at rest."""
_NUDGE = 1e-6
"""Relative change of speed for the slope of a law."""
_MOST_CORRECTIONS = 6
"""Most corrections of a reversal."""


def impedances(damping: float, stiffness: float, frequency: float, harmonics: int) -> Phasors:
    """Force over velocity at the harmonics 1 ... H."""
    rate = frequency * np.arange(1.0, harmonics + 1.0)
    return np.asarray(damping + 1j * (rate - stiffness / rate))


class Equations(NamedTuple):
    """A mass, a law, and the impedance and force of every harmonic (direction, harmonic), of one direction or two.

    A velocity is the real part of the sum of V_k exp(i k angle). spread: slip speed over which friction rises to that
    of vanishing slip; at 0 it jumps.
    """

    mass: Mass
    law: FrictionLaw
    impedance: Phasors
    force: Phasors
    spread: float = 0.0

    @classmethod
    def of(cls, scene: Scene, law: FrictionLaw, harmonics: int) -> Equations:
        """Under loads of one sine."""
        mass = scene.mass()
        directions = [(mass.damping, mass.stiffness, mass.force)]
        if not scene.load_along_belt_only:
            directions.append((mass.transverse_damping, mass.transverse_stiffness, mass.transverse_force))
        impedance = np.array([impedances(c, k, mass.frequency, harmonics) for c, k, _ in directions])
        force = np.zeros_like(impedance)
        force[:, 0] = [-1j * load for *_, load in directions]  # Im(F e) = Re(-i F e)
        return cls(mass, law, impedance, force)

    @property
    def friction(self) -> float:
        """Return the force of quick sliding."""
        return self.mass.normal_load * self.law.sliding_friction(1.0)

    @property
    def jump(self) -> float:
        """Friction coefficient of vanishing slip where slip reverses at once; in the plane friction turns."""
        return self.law.sliding_friction(0.0) if len(self.impedance) == 1 and not self.spread else 0.0

    def sizes(self, speeds: Floats) -> Floats:
        """Friction coefficients at slip speeds."""
        sizes = sliding_vectors(self.law, speeds.astype(np.complex128)).real
        if self.spread:
            sizes = sizes - self.law.sliding_friction(0.0) * (1.0 - speeds / np.hypot(speeds, self.spread))
        return np.asarray(sizes)


class SampledMotion(NamedTuple):
    """Velocities, the slip at the samples (direction, sample), friction's mean, and the force every harmonic lacks.

    jumps: what those at reversals of a slip along the belt add to the harmonics 0 ... 2 H of friction's derivative.
    """

    velocity: Phasors
    slip: Floats
    mean: Floats
    missing: Phasors
    jumps: Phasors

    @property
    def left(self) -> float:
        """Return the largest of the forces."""
        return float(np.abs(self.missing).max())


def sampled_refusal(name: str, scene: Scene, law: FrictionLaw, harmonics: int) -> str | None:
    """Why harmonics on samples cannot do this driven scene and law at any belt speed; None if they can."""
    if scene.load_along_belt_only and law.constant_sliding_friction():
        mass = scene.mass()
        resonant = impedances(mass.damping, mass.stiffness, mass.frequency, harmonics) == 0.0
        unbounded = (
            f"without damping, harmonic {1 + resonant.argmax()} of friction drives the mass without bound"
        )
        return line_refusal(name, scene, law) or (f"{name}: {unbounded}" if resonant.any() else None)
    if not takes_lanes(law):
        return (
            f"{name} in two harmonics or more needs friction along the slip, of its speed alone; use shooting"
        )
    return plane_refusal(name, scene, law)


def sampled(scenes: Sequence[Scene], law: FrictionLaw, harmonics: int) -> Modelled:
    """Return the motion of H harmonics of scenes that differ in belt speed alone."""
    speeds, line = belt_speeds_of(scenes), scenes[0].load_along_belt_only
    motions = _motions(Equations.of(scenes[0], law, harmonics), speeds)
    means = np.array([complex(np.nan, np.nan) if each is None else -complex(*each.mean) for each in motions])
    # On a belt at rest it vanishes by symmetry: friction along the slip, of its speed alone, is odd.
    means = np.where((speeds == 0.0) & np.isfinite(means), 0j, means)
    unsettled = NOT_SETTLED.format(harmonics)
    if line:
        held = law.sliding_friction(0.0) * scenes[0].mass().normal_load
        reasons = line_reasons(scenes[0], held, speeds, means.real, unsettled)
    else:
        reasons = ["" if each else unsettled for each in motions]

    def orbit(i: int) -> Orbit | None:
        motion = motions[i]
        return None if motion is None else _orbit(scenes[i], law, motion.velocity, complex(means[i]))

    return Modelled(means.real if line else means, reasons, f"{harmonics} {ModelWord.SAMPLED}", orbit)


def _motions(what: Equations, belt_speeds: Floats) -> list[SampledMotion | None]:
    """From the fastest belt on, each from the one before; where that leads nowhere from the friction-free motion."""
    found: list[SampledMotion | None] = [None] * len(belt_speeds)
    start = free = what.force / what.impedance
    for i in np.argsort(-np.abs(belt_speeds), kind="stable").tolist():
        for begin in (start,) if start is free else (start, free):
            found[i] = found[i] or balanced(what, float(belt_speeds[i]), begin)
        motion = found[i]
        start = motion.velocity if motion else free
    return found


def balanced(what: Equations, belt_speed: float, start: Phasors) -> SampledMotion | None:
    """Return the motion that Newton's method finds from these velocities; None where it does not settle."""
    directions, harmonics = start.shape
    fewest, most = _SAMPLES[directions]
    count, found = 2 ** math.ceil(math.log2(max(fewest, _PER_HARMONIC * harmonics))), None
    if directions == 1 and what.law.constant_sliding_friction():
        most = count  # all of friction jumps: samples only tell reversals apart
    while count <= most:
        settled = _settled(what, belt_speed, start, count)
        if settled is None and directions == 1:
            settled = _settled_by_spreading(what, belt_speed, start, count)
        if settled is not None:
            found, start = settled, settled.velocity
            if _friction(what, start, belt_speed, 2 * count).left <= _ENOUGH * what.friction:
                break
        count *= _MORE
    return found


def _settled_by_spreading(
    what: Equations, belt_speed: float, start: Phasors, count: int
) -> SampledMotion | None:
    """Return the motion, found from others under friction whose jump is spread over ever less of slip."""
    for spread in (float(np.abs(start).max()) * _SPREADS).tolist():
        near = _settled(what._replace(spread=spread), belt_speed, start, count)
        if near is None:
            return None
        start = near.velocity
        found = _settled(what, belt_speed, start, count)
        if found is not None:
            return found
    return None


def _settled(what: Equations, belt_speed: float, start: Phasors, count: int) -> SampledMotion | None:
    """On so many samples."""
    found = _friction(what, start, belt_speed, count)
    closed = _CLOSED * (float(np.abs(what.force).sum()) + what.friction)
    for _ in range(_MOST_STEPS):
        if found.left <= closed:
            return found
        step = _newton_step(what, found)
        if step is None:
            return None
        share = 1.0
        while share >= _SHORTEST_STEP:
            tried = _friction(what, found.velocity + share * step, belt_speed, count)
            if tried.left < (1.0 - 0.1 * share) * found.left:
                break
            share *= 0.5
        if share < _SHORTEST_STEP:
            # As far as rounding lets it: a step that gains nothing from near the end.
            return found if found.left <= _ROUNDED * closed else None
        found = tried
    return None


def _friction(what: Equations, velocity: Phasors, belt_speed: float, count: int) -> SampledMotion:
    slip = _waves(velocity, count)
    slip[0] -= belt_speed
    harmonics, speed = velocity.shape[1], _speeds(slip)
    jump = what.jump
    smooth = (what.sizes(speed) - jump) * slip / speed
    friction, pulses = np.fft.rfft(smooth, axis=1)[:, : harmonics + 1] / count, np.zeros(1, np.complex128)
    if jump:
        signs, pulses = _switches(velocity[0], slip[0], belt_speed)
        friction[0] += jump * signs
    missing = what.impedance * velocity + what.mass.normal_load * 2.0 * friction[:, 1:] - what.force
    return SampledMotion(velocity, slip, friction[:, 0].real, missing, jump * pulses)


def _speeds(slip: Floats) -> Floats:
    speed = np.sqrt((slip**2).sum(axis=0))
    return np.maximum(speed, _SLOWEST * max(float(speed.max()), 1e-300))


def _waves(phasors: Phasors, count: int) -> Floats:
    """Return the sums of harmonics at equal steps of the angle."""
    spectrum = np.zeros((len(phasors), count // 2 + 1), np.complex128)
    spectrum[:, 1 : phasors.shape[1] + 1] = 0.5 * count * phasors
    return np.asarray(np.fft.irfft(spectrum, count, axis=1))


def _switches(velocity: Phasors, slip: Floats, belt_speed: float) -> tuple[Phasors, Phasors]:
    """Harmonics 0 ... H of the sign of a slip along the belt, and 0 ... 2 H of its derivative by the slip.

    Slip reverses between its samples and its turning points, so that no reversal is passed unseen.
    """
    harmonics, step = len(velocity), math.tau / len(slip)
    orders = np.arange(2.0 * harmonics + 1.0)
    rising = 1j * orders[1 : harmonics + 1] * velocity

    def at(angle: Floats) -> tuple[Floats, Floats]:
        turns = np.exp(1j * np.multiply.outer(angle, orders[1 : harmonics + 1]))
        return (turns @ velocity).real - belt_speed, (turns @ rising).real

    rate = _waves(rising[None, :], len(slip))[0]
    after = np.roll(rate, -1)
    turning = np.flatnonzero(rate * after < 0.0)
    between = step * (turning + rate[turning] / (rate[turning] - after[turning]))
    angles = np.concatenate([step * np.arange(len(slip)), between, [math.tau]])
    values = np.concatenate([slip, at(between)[0], slip[:1]])
    order = np.argsort(angles, kind="stable")
    angles, values = angles[order], values[order]
    sides = np.where(np.signbit(values), -1.0, 1.0)
    crossed = np.flatnonzero(sides[1:] != sides[:-1])
    low, high, start, end = angles[crossed], angles[crossed + 1], values[crossed], values[crossed + 1]
    angle = low + (high - low) * (start / (start - end))
    for _ in range(_MOST_CORRECTIONS):
        value, rate = at(angle)
        angle = np.clip(angle - value / np.where(rate == 0.0, 1e-300, rate), low, high)
    turns = np.exp(-1j * np.multiply.outer(orders, angle)) / math.tau
    jumps = 2.0 * sides[crossed + 1]
    signs = turns[: harmonics + 1] @ jumps / (1j * np.maximum(orders[: harmonics + 1], 1.0))
    signs[0] = sides[0] + (jumps * (1.0 - angle / math.tau)).sum()
    return signs, turns @ (2.0 / np.maximum(np.abs(at(angle)[1]), 1e-300))


def _newton_step(what: Equations, found: SampledMotion) -> Phasors | None:
    """Return the change of the velocities that removes what is missing, real and imaginary parts apart."""
    directions, harmonics = found.missing.shape
    derivative = _derivative(what, found)
    around = np.concatenate([derivative, np.conj(derivative[:, :, :0:-1])], axis=2)
    orders = np.arange(1, harmonics + 1)
    # The change of harmonic j by harmonic k, and by its complex conjugate.
    direct = what.mass.normal_load * around[:, :, orders[:, None] - orders[None, :]]
    mirrored = what.mass.normal_load * around[:, :, orders[:, None] + orders[None, :]]
    for direction in range(directions):
        direct[direction, direction] += np.diag(what.impedance[direction])
    together, apart = direct + mirrored, direct - mirrored
    parts = np.array([[together.real, -apart.imag], [together.imag, apart.real]])
    # (part, part, direction, direction, harmonic, harmonic) -> rows and columns by (part, direction, harmonic)
    size = 2 * directions * harmonics
    matrix = parts.transpose(0, 2, 4, 1, 3, 5).reshape(size, size)
    side = np.stack([found.missing.real, found.missing.imag]).ravel()
    try:
        change = np.linalg.solve(matrix, -side).reshape(2, directions, harmonics)
    except np.linalg.LinAlgError:
        return None
    return np.asarray(change[0] + 1j * change[1])


def _derivative(what: Equations, found: SampledMotion) -> Phasors:
    """Harmonics 0 ... 2 H of that of friction by slip velocity (direction, direction, harmonic).

    Across the slip friction's size over the speed, along it the slope of the law; a jump moves with its reversal.
    """
    (directions, harmonics), slip, speed = found.missing.shape, found.slip, _speeds(found.slip)
    size, way = what.sizes(speed), slip / speed
    slope = (what.sizes((1.0 + _NUDGE) * speed) - size) / (_NUDGE * speed)
    turning, along = size / speed, way[:, None] * way[None, :]
    changes = turning * (np.eye(directions)[:, :, None] - along) + slope * along
    spectrum = np.fft.rfft(changes, axis=2)[:, :, : 2 * harmonics + 1] / slip.shape[1]
    spectrum[0, 0] += found.jumps
    return np.asarray(spectrum)


def _orbit(scene: Scene, law: FrictionLaw, velocity: Phasors, mean: complex) -> Orbit:
    """Motion about the position where its mean friction loads the springs, on panels that end at reversals."""
    phasors = [*(1j * velocity).tolist(), [0j] * velocity.shape[1]]  # Re(V e) = Im(i V e)
    slip = VaryingSlip.of_sines(scene.frequency, phasors[0], phasors[1])
    orbit = slip.orbit(*slip.friction(scene.belt_speed, law))
    return replace(orbit, x=orbit.x + mean_position(scene, mean), stick=None)
