"""Bounds on the mean friction of a body that moves in a plane, from any periodic trial of its friction.

Friction per normal load is T = grad Phi(w), Phi convex: of a coefficient that never falls the integral over speed; of
one that falls by at most ``fall`` per velocity that of T + fall*w, the rest taken from the dashpots. With any trial
T~ = grad Phi(w~) and the linear response to it and to the loads, of slip w_y, both equations of motion subtracted
average to <(T - T~).(w - w_y)> <= 0, and Fenchel's inequality leaves of it

    <Phi(w_y) + Phi*(T) - T.w_y> <= <Phi(w_y) - Phi(w~) - T~.(w_y - w~)> =: gap,

Phi* the conjugate. For any length l > 0 and unit vector e, Phi(w_y + l e) + Phi*(T) >= T.(w_y + l e), so that

    <T.e> <= [gap + <Phi(w_y + l e) - Phi(w_y)>] / l,

which for Coulomb friction along a line is the bound of gap.py. Where the linear response is to samples of the trial,
between which the trial differs from them by r, the gap grows by normal_load <r^2>/(4 c), c the lesser dashpot.

Source: this derivation.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.reduced.gap import Bounds
from frictionlab.methods.reduced.potential import Potential, potential_of
from frictionlab.quantities import EPSILON, Floats
from frictionlab.scene.body import Mass

SAMPLED_AT = (32, 128, 512, 2048)
"""Of a period, more where slip nearly comes to rest: as many again tell what they miss."""
MOST_TRIALS = 10
"""Trials at most, each the friction along the response to the one before."""
CLOSE_ENOUGH = 0.1
"""Distance of the bounds, relative to what the model leaves out, at which no further trial is asked for."""
UNSEEN_TURN = 0.5
"""Turn of slip from sample to sample, as sine of half its angle, above which it may nearly rest unseen."""
GIBBS = 2.2
"""How far friction and the Fourier series of its samples may lie apart where it turns round, in its largest size."""
MISSED = 0.2
"""Share of the distance of the bounds that samples may miss."""
LENGTHS = (0.5, 1.0, 2.0)
"""Of l, in those expected to be best."""


class _Plane(NamedTuple):
    """The body and its friction; slips are pairs (row, direction, sample).

    dashpots: less what friction took from them so that it never falls; free: velocities without friction.
    """

    normal_load: float
    frequency: float
    dashpots: tuple[float, float]
    springs: tuple[float, float]
    free: NDArray[np.complex128]
    potential: Potential

    def free_slip(self, belt_speeds: Floats, samples: int) -> Floats:
        """Without friction."""
        angle = 2.0 * np.pi * np.arange(samples) / samples
        wave = (self.free[:, None] * np.exp(1j * angle)).imag
        return np.asarray(wave[None, :, :] - belt_speeds[:, None, None] * np.array([[1.0], [0.0]]))

    def answer(self, friction: Floats) -> Floats:
        """The velocity that friction at evenly spaced instants causes, at these and those halfway between."""
        given = friction.shape[2]
        rates = self.frequency * np.arange(1.0, given // 2)
        mobility = np.zeros((2, given // 2 + 1), np.complex128)
        for i, (dashpot, spring) in enumerate(zip(self.dashpots, self.springs, strict=True)):
            mobility[i, 1:-1] = 1.0 / (dashpot + 1j * (rates - spring / rates))
        return -2.0 * self.normal_load * np.fft.irfft(np.fft.rfft(friction) * mobility, 2 * given)

    def friction(self, slip: Floats) -> Floats:
        """Along slips."""
        speed = np.hypot(slip[:, 0], slip[:, 1])
        return np.asarray((self.potential.slope(speed) / np.maximum(speed, 1e-300))[:, None, :] * slip)

    def energy(self, slip: Floats) -> Floats:
        """The potential of friction at slips."""
        return self.potential.at(np.hypot(slip[:, 0], slip[:, 1]))


class _Response(NamedTuple):
    """Slip of the linear response to a trial, the gap and what samples may miss of it."""

    slip: Floats
    gap: Floats
    missed: Floats


def plane_bounds(mass: Mass, law: FrictionLaw, belt_speeds: Floats, means: Floats) -> Bounds:
    """Least and largest mean friction coefficient along x1 at belt speeds other than 0; NaN where none is found.

    mass: damped in both directions, by more than friction falls; means: of a model, which tell how close the bounds
    need be.
    """
    fall = law.steepest_fall()
    springs, forces = (mass.stiffness, mass.transverse_stiffness), (mass.force, mass.transverse_force)
    dashpots = mass.damping - fall * mass.normal_load, mass.transverse_damping - fall * mass.normal_load
    free = np.array([
        force / (dashpot + 1j * (mass.frequency - spring / mass.frequency))
        for force, dashpot, spring in zip(forces, dashpots, springs, strict=True)
    ])  # fmt: skip
    quickest = 4.0 * float(np.abs(free).sum() + np.abs(belt_speeds).max())
    potential = potential_of(law, quickest, fall)
    plane = _Plane(mass.normal_load, mass.frequency, dashpots, springs, free, potential)
    low, high = np.full(len(belt_speeds), np.nan), np.full(len(belt_speeds), np.nan)
    rows, taken = np.arange(len(belt_speeds)), fall * belt_speeds
    slip = plane.free_slip(belt_speeds, 2 * SAMPLED_AT[0])
    for samples in SAMPLED_AT:
        slip = _resampled(slip, 2 * samples)
        last = samples == SAMPLED_AT[-1]
        tried: NDArray[np.bool_] = np.logical_or(~_unseen(slip).any(axis=1), last)
        here = rows[tried]
        if len(here):
            found, slip[tried], sure = _bounds(
                plane, belt_speeds[here], means[here] + taken[here], slip[tried]
            )
            sure = sure | last
            low[here[sure]], high[here[sure]] = found.low[sure], found.high[sure]
            tried[tried] = sure
        rows, slip = rows[~tried], slip[~tried]
        if not len(rows):
            break
    return Bounds(low - taken, high - taken)


def _resampled(slip: Floats, samples: int) -> Floats:
    """At so many instants, no fewer, by its Fourier series."""
    return samples / slip.shape[2] * np.fft.irfft(np.fft.rfft(slip), samples)


def _bounds(
    plane: _Plane, belt_speeds: Floats, means: Floats, first: Floats
) -> tuple[Bounds, Floats, NDArray[np.bool_]]:
    """Bounds by friction along first slips and better ones; the best one's; whether its samples are enough."""
    with np.errstate(invalid="ignore", over="ignore"):
        slip, gap, missed = _best_response(plane, belt_speeds, means, first)
        size = np.hypot(slip[:, 0], slip[:, 1])
        bend = plane.potential.slope(size) * (slip[:, 1] / size) ** 2 / size
        level = np.sqrt(2.0 * gap / bend.mean(axis=1))
        energy, unseen = plane.energy(slip), _unseen(slip)
        most_friction = plane.potential.slope(size).max(axis=1)
        sides, left = [], np.zeros(len(gap))
        for sign in (1.0, -1.0):
            most = np.full(len(gap), np.inf)
            for length in LENGTHS:
                step = length * level
                moved = slip + sign * step[:, None, None] * np.array([[1.0], [0.0]])
                rise, unsure = _mean(plane.energy(moved) - energy)
                unsure = unsure + 2.0 * most_friction * step * (unseen | _unseen(moved)).mean(axis=1)
                most = np.fmin(most, (gap + rise + unsure + 4.0 * plane.potential.error) / step)
                left = np.maximum(left, (unsure + missed) / step)
            sides.append(most)
        low, high = -sides[0], sides[1]
        enough = np.maximum(MISSED * (high - low), CLOSE_ENOUGH * np.maximum(high - means, means - low))
        return Bounds(low, high), slip, left <= enough


def _best_response(plane: _Plane, belt_speeds: Floats, means: Floats, first: Floats) -> _Response:
    """Of the trials, the response of the least gap.

    Each trial is friction along the last response, or along a mixture of it with the one before where they go to and
    fro (Aitken). More are tried as long as the bounds would lie far apart for what they are to tell.
    """
    free = plane.free_slip(belt_speeds, first.shape[2])
    slip, best = first, _Response(free.copy(), np.full(len(free), np.inf), np.zeros(len(free)))
    rows, share, before = np.arange(len(free)), np.ones(len(free)), None
    for _ in range(MOST_TRIALS):
        found, friction = _response(plane, free[rows], slip)
        better = found.gap < best.gap[rows]
        for kept, new in zip(best, found, strict=True):
            kept[rows[better]] = new[better]
        size = np.hypot(found.slip[:, 0], found.slip[:, 1])
        apart = 2.0 * np.sqrt(2.0 * found.gap * (plane.potential.slope(size) / size).mean(axis=1))
        go_on = apart > CLOSE_ENOUGH * np.abs(-friction[:, 0].mean(axis=1) - means[rows])
        go_on &= found.missed < 0.5 * found.gap  # else finer samples would help, and no other trial
        step = found.slip - slip
        if before is not None:
            change = step - before
            falls = -(before * change).sum(axis=(1, 2)) / np.maximum((change**2).sum(axis=(1, 2)), 1e-300)
            share = np.where(falls > 0.0, np.clip(share * falls, 0.02, 1.5), 0.3)
        if not go_on.any():
            break
        rows, share, before = rows[go_on], share[go_on], step[go_on]
        slip = slip[go_on] + share[:, None, None] * before
    return best


def _response(plane: _Plane, free: Floats, slip: Floats) -> tuple[_Response, Floats]:
    """To friction along slips, and that friction."""
    friction = plane.friction(slip)
    given = friction[:, :, ::2]
    found = free + plane.answer(given)
    between = 2.0 * np.fft.irfft(np.fft.rfft(given), 2 * given.shape[2])  # what the response is to
    unseen, most = _unseen(slip), np.hypot(friction[:, 0], friction[:, 1]).max(axis=1)
    apart = ((between - friction) ** 2).sum(axis=1).mean(axis=1) + (GIBBS * most) ** 2 * unseen.mean(axis=1)
    away = plane.normal_load / (4.0 * min(plane.dashpots)) * apart
    work = (friction * (found - slip)).sum(axis=1)
    energy = plane.energy(found)
    gap, unsure = _mean(energy - plane.energy(slip) - work)
    rounding = 16.0 * EPSILON * energy.max(axis=1)
    sizes = np.hypot(found[:, 0], found[:, 1]) + np.hypot(slip[:, 0], slip[:, 1])
    near = sizes + np.roll(sizes, -1, axis=1)
    missed = unsure + 2.0 * away + 2.0 * most * (np.where(unseen | _unseen(found), near, 0.0)).mean(axis=1)
    return _Response(found, np.maximum(gap, 0.0) + missed + rounding, missed), friction


def _mean(values: Floats) -> tuple[Floats, Floats]:
    """Over all samples, and the difference between every second one and the others."""
    even, odd = values[:, ::2].mean(axis=1), values[:, 1::2].mean(axis=1)
    return 0.5 * (even + odd), np.abs(even - odd)


def _unseen(slip: Floats) -> NDArray[np.bool_]:
    """After which samples slip turns so much to the next that it may nearly rest between them."""
    after = np.roll(slip, -1, axis=2)
    moved = np.hypot(after[:, 0] - slip[:, 0], after[:, 1] - slip[:, 1])
    size = np.hypot(slip[:, 0], slip[:, 1])
    return np.asarray(moved > UNSEEN_TURN * (size + np.roll(size, -1, axis=1)))
