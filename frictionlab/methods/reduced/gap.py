"""What the mean Coulomb friction along a line can be at most and at least, from any trial of the friction's signs.

Friction lambda (per mu*normal_load, |lambda| <= 1) along the true slip velocity w obeys lambda w = |w|, in stick,
too. Take any periodic lambda~ between -1 and 1, and the linear response to it and to the loads, whose slip velocity
is w_y. Both equations of motion, subtracted and multiplied by the difference of the velocities, average to

    <|w| - lambda~ w> + <|w_y| - lambda w_y> + (2 beta/friction) <(w - w_y)^2> = <|w_y| - lambda~ w_y> =: gap.

No term on the left is negative, so <|w_y| - lambda w_y> <= gap, with w_y and the gap known. For any theta >= 0 and
any lambda between -1 and 1

    lambda <= theta (|w_y| - lambda w_y) + clip(1 + 2 theta w_y, -1, 1),

so that <lambda> <= theta gap + <clip(1 + 2 theta w_y)>, and the same from below with the signs of w_y turned round.
Where the trial is the true friction the gap is zero and both bounds meet. Else their distance is of the order of the
share of time by which the trial's reversals are wrong: the gap is of its second order. Nothing is divided by the
damping, and a trial without stick bounds a motion with it.

Source: this derivation; the identity is that by which such motions are unique (Leine & van de Wouw, 2008).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from frictionlab.methods.reduced.reversals import Driven, Switched, settled
from frictionlab.methods.reduced.switching import Jumps
from frictionlab.quantities import EPSILON, Floats


class _Mesh(NamedTuple):
    """Panels of a leg: the first, in shares of the leg; as many per period of the quickest wave; at most."""

    first: float
    per_wave: int
    most: int


COARSE, FINE = _Mesh(1e-3, 16, 400), _Mesh(1e-9, 32, 400)
RATIO = 2.5
"""Growth from one panel to the next. Below 3 a chord tells the sign of a parabola that touches zero at the switch."""
TOO_FAR_APART = 1e-8
"""Distance of the bounds above which finer panels are tried: slip nearly touches zero, or the trial is wrong."""
LOOKED_BEYOND = 16.0
"""How far beyond the level of slip expected to matter panels are looked at."""
ROUNDS = 6


class Bounds(NamedTuple):
    """Least and largest mean friction, relative to mu, at each belt speed."""

    low: Floats
    high: Floats


def line_bounds(body: Driven, trial: Switched, belt_speeds: Floats) -> Bounds:
    """Bounds from a trial's friction, its switches first moved to where the slip they cause vanishes.

    belt_speeds >= 0, one row of the trial each; of a motion that reverses or sticks: below the largest friction-free
    velocity.
    """
    moved = settled(body, trial, belt_speeds)
    low, high = _bounds(body, moved, belt_speeds, COARSE)
    rows = np.flatnonzero(~(high - low <= TOO_FAR_APART))
    if len(rows):
        finer = _bounds(body, Switched(moved.switches[rows], moved.signs[rows]), belt_speeds[rows], FINE)
        low[rows], high[rows] = np.fmax(low[rows], finer.low), np.fmin(high[rows], finer.high)
    return Bounds(low, high)


def _bounds(body: Driven, trial: Switched, belt_speeds: Floats, mesh: _Mesh) -> Bounds:
    panels = _panels(body, trial, belt_speeds, mesh)
    gap = panels.gap()
    with np.errstate(invalid="ignore"):
        largest = _largest_means(panels, gap)
    return Bounds(np.fmax(-largest[: len(gap)], -1.0), np.fmin(largest[len(gap) :], 1.0))


class _Panels(NamedTuple):
    """Slip velocities at both ends of panels (row, panel), linear between but for what is unsure at either end.

    share: of the period; sign: of the trial's friction.
    """

    share: Floats
    sign: Floats
    start: Floats
    end: Floats
    unsure_start: Floats
    unsure_end: Floats

    def gap(self) -> Floats:
        """<|w| - sign w>, at most."""
        against = _ramp(self.unsure_start - self.sign * self.start, self.unsure_end - self.sign * self.end)
        return 2.0 * (self.share * against).sum(axis=1)


def _panels(body: Driven, trial: Switched, belt_speeds: Floats, mesh: _Mesh) -> _Panels:
    """Slip of the linear response to a trial's friction.

    A chord departs from a curve by at most bend*length^2/8; next to a switch, where slip vanishes, by at most
    bend*length/2 times the distance from it.
    """
    jumps = Jumps.of(body.damping_ratio, body.frequency)
    jump = trial.jumps()
    amplitudes = body.friction * jumps.after(trial.switches, jump)
    lengths = np.diff(trial.switches, axis=1, append=trial.switches[:, :1] + jumps.period)
    since = lengths[:, :, None] * _places(body, mesh)
    slip = body.free_velocity(trial.switches[:, :, None] + since)[0] - belt_speeds[:, None, None]
    rates = body.frequency * np.arange(1.0, len(body.free) + 1.0)
    bend = np.full(since.shape, np.abs(body.free) @ rates**2)
    paired = jumps.exponents[0].imag != 0.0  # complex conjugates: twice the real part of one
    for exponent, amplitude in list(zip(jumps.exponents, amplitudes.transpose(2, 0, 1), strict=True))[
        : 1 if paired else 2
    ]:
        wave = (2.0 if paired else 1.0) * amplitude[:, :, None] * np.exp(exponent * since)
        slip = slip - wave.real
        bend = bend + abs(exponent) ** 2 * np.abs(wave)
    steps = np.diff(since, axis=2)
    chord = bend[:, :, :-1] * steps * steps / 8.0
    before, after = chord.copy(), chord.copy()
    before[:, :, 0], after[:, :, 0] = 0.0, 4.0 * chord[:, :, 0]
    before[:, :, -1], after[:, :, -1] = 4.0 * chord[:, :, -1], 0.0
    rounding = _rounding(body, jumps, jump, belt_speeds)[:, None, None]
    rows = len(belt_speeds), -1
    sign = np.broadcast_to(trial.signs[:, :, None], steps.shape)
    values = steps / jumps.period, sign, slip[:, :, :-1], slip[:, :, 1:], before + rounding, after + rounding
    return _Panels(*(value.reshape(rows) for value in values))


def _rounding(body: Driven, jumps: Jumps, jump: Floats, belt_speeds: Floats) -> Floats:
    """Of slip velocities, at most."""
    turns = np.abs(jumps.exponents) * jumps.period
    worn = 2.0 + turns + turns / np.abs(np.expm1(jumps.exponents * jumps.period))
    answer = (
        np.abs(jumps.weights) @ (np.minimum(2.0, turns) * worn) * body.friction * np.abs(jump).sum(axis=1)
    )
    return body.unsure() * (np.abs(body.free).sum() + belt_speeds) + 8.0 * EPSILON * answer


def _places(body: Driven, mesh: _Mesh) -> Floats:
    """Ends of panels in shares of a leg: graded towards its ends, even between."""
    quickest = max(1.0, body.frequency * len(body.free))
    even = min(mesh.most, math.ceil(mesh.per_wave * quickest / body.frequency))
    graded = mesh.first * RATIO ** np.arange(math.log(1.0 / (even * mesh.first)) // math.log(RATIO) + 1.0)
    inner = np.linspace(0.0, 1.0, even + 1)
    inner = inner[(inner > 1.2 * graded[-1]) & (inner < 1.0 - 1.2 * graded[-1])]
    return np.concatenate([[0.0], graded, inner, 1.0 - graded[::-1], [1.0]])


def _ramp(start: Floats, end: Floats) -> Floats:
    """The mean of max(0, f) over a panel on which f is linear."""
    tiny = 1e-300
    above, over = np.maximum(start, 0.0), np.maximum(end, 0.0)
    return 0.5 * (above + over) * ((np.abs(over - above) + tiny) / (np.abs(end - start) + tiny))


def _largest_means(panels: _Panels, gap: Floats) -> Floats:
    """The least of theta gap + <clip(1 + 2 theta w)> over theta, of w and, in as many more rows, of -w.

    It is least where twice the mean of |w| over -1/theta < w < 0 is the gap. Only panels that this level reaches
    need be looked at more than once.
    """
    most = np.abs(panels.start).max(axis=1)
    level = np.tile(2.0 * np.sqrt(gap * most) + 1e-14 * most, 2)
    start = np.concatenate([panels.start + panels.unsure_start, panels.unsure_start - panels.start])
    end = np.concatenate([panels.end + panels.unsure_end, panels.unsure_end - panels.end])
    share, gaps = np.concatenate([panels.share, panels.share]), np.concatenate([gap, gap])
    lower, upper, widest = np.minimum(start, end), np.maximum(start, end), LOOKED_BEYOND * level
    near = (lower < 0.0) & (upper > -widest[:, None])
    others = np.where(near, 0.0, np.where(lower < 0.0, -share, share)).sum(axis=1)
    rows = np.nonzero(near)[0]
    start, end, share = start[near], end[near], share[near]
    best = np.full(len(level), np.inf)
    for _ in range(ROUNDS):
        theta = (1.0 / level)[rows]
        clipped = (
            2.0 * (_ramp(1.0 + theta * start, 1.0 + theta * end) - _ramp(theta * start, theta * end)) - 1.0
        )
        best = np.fmin(best, gaps / level + others + np.bincount(rows, share * clipped, len(level)))
        inner, outer = np.clip(-start, 0.0, 1.0 / theta), np.clip(-end, 0.0, 1.0 / theta)
        part = np.abs(outer - inner) / (np.abs(end - start) + 1e-300)
        used = np.bincount(rows, share * (inner + outer) * part, len(level))
        change = np.sqrt(np.clip(gaps / np.maximum(used, 1e-300), 1e-4, 1e4))
        level = np.minimum(level * change, widest)
        if np.all((np.abs(change - 1.0) < 0.1) | (gaps < 1e-14 * widest)):
            break
    return best
