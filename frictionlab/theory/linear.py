"""Friction-free response of a linear body under loads that are sines or have corners.

Its slip velocity is computed, too.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.free_body import held, springs_for, without_spring
from frictionlab.scene.receptance import LinearBody, linear_body
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.scene.signals import Segments, Signal, Wave, edges_of, highest
from frictionlab.scene.units import measured
from frictionlab.theory.periodic_response import PeriodicResponse, periodic_response
from frictionlab.theory.piecewise import FreeMotion, Piecewise, oscillation, piecewise
from frictionlab.values.quantities import EPSILON, Floats

POINTS_OF_PANEL = 64


class FreeSlip(NamedTuple):
    """Friction-free slip on a belt whose mean velocity is zero: waves, and the effect of corners of the load.

    corners [n, 3]: their times in [0, period), the jumps of the load there and those of its slope. With V and
    W of theory/periodic_response.py the slip velocity is the sum of waves, jump V + bend W after every
    corner, and ``steady``, which makes its mean zero.
    """

    waves: Signal
    corners: Floats
    steady: float
    response: PeriodicResponse | None

    def extremes(self, period: float) -> tuple[float, float]:
        """Return the least and the largest value."""
        of = self.response
        if of is None:
            return self.waves.extremes(period)
        low, high = math.inf, -math.inf
        edges = edges_of(sorted({*self.corners[:, 0].tolist(), *self.waves.corners(period)}), period)
        for start, stop in itertools.pairwise(edges):
            tau = np.linspace(
                start, stop, 3 + math.ceil(POINTS_OF_PANEL * of.panels * (stop - start) / period)
            )
            values = self.waves.between(tau) + self.steady
            for at, jump, bend in self.corners:
                since = np.mod(tau - at, period)
                values += jump * of.at(of.value, since) + bend * of.at(of.integral, since)
            low, high = min(low, -highest(-values)), max(high, highest(values))
        return low, high


def friction_free_slip(body: LinearBody, load: Signal, belt: Signal, period: float) -> FreeSlip:
    """Return the friction-free slip of a body under this load, on a belt of this vibration."""
    waves = Signal(tuple(answered(body, each, 1) for each in load.waves)).plus(belt.scaled(-1.0))
    corners = corners_of(load, period)
    if not len(corners):
        return FreeSlip(waves, corners, 0.0, None)
    response = periodic_response(body, 2.0 * math.pi / period)
    steady = -response.static * float(corners[:, 1].sum()) / period
    return FreeSlip(waves, corners[np.argsort(corners[:, 0], kind="stable")], steady, response)


def corners_of(load: Signal, period: float) -> Floats:
    """Return times of corners in [0, period), jumps of the load there and those of its slope [n, 3]."""
    corners = np.array([row for each in load.pieces for row in _corners(each, period)]).reshape(-1, 3)
    return np.asarray(corners[np.any(corners[:, 1:] != 0.0, axis=1)])


def _corners(load: Segments, period: float) -> list[tuple[float, float, float]]:
    """Return the times of corners, the jumps of the load there and those of its slope."""
    rows = []
    for line, last in zip(load.lines, [load.lines[-1], *load.lines[:-1]], strict=True):
        length = math.fmod(line.start - last.start + load.period, load.period) or load.period
        jump, bend = line.value - last.value - last.slope * length, line.slope - last.slope
        size = max(abs(line.value), abs(last.value), load.period * abs(line.slope))
        jump = 0.0 if abs(jump) < 1e-14 * size else jump
        rows += [(line.start + k * load.period, jump, bend) for k in range(round(period / load.period))]
    return rows


def answered(body: LinearBody, wave: Wave, order: int) -> Wave:
    """Return x1 under a force of this wave, or its derivative of order 1."""
    response = body.receptance(np.array([wave.frequency]))[0]
    return Wave(wave.frequency, complex((1j * wave.frequency) ** order * response * wave.phasor))


_SINGULAR = 64.0 * EPSILON
"""Determinant of the loss of a free motion in a period, below which an oscillator is at undamped
resonance."""


def friction_free_velocity(scene: Scene, law: FrictionLaw | None = None) -> float:
    """Compute V_lin, the largest velocity of x1 over the belt's vibration without friction.

    It is the maximum over time of x1' minus the belt's vibration along x1, of the linear response to the
    loads. If the normal load varies, the alternating part of the friction of steady sliding acts as well, and
    the law is needed. For a prescribed slip it is the maximum of the oscillation, for one sine the velocity
    amplitude. On a belt that runs backward it is that of the opposite velocity. At belt speeds above V_lin a
    body of one degree of freedom under constant sliding friction never reverses its slip; the curve of the
    mean has its kink there.

    Parameters
    ----------
    scene : Scene
        Body, loads and belt.
    law : FrictionLaw, optional
        Law of friction, needed only if the normal load varies.

    Returns
    -------
    float
        V_lin [omega_1 L]. It is infinite at undamped resonance, and NaN for a body that is not linear or
        whose table does not give its response to the load.

    Raises
    ------
    ValueError
        If the normal load varies and there is no law.

    References
    ----------
    Sulollari, van Dalen & Cabboi, Eq. 6 (there the response where friction is a small perturbation).
    """
    if scene.is_free:
        return _without_spring(friction_free_velocity, scene, law)
    if scene.bends:
        return math.nan
    if scene.remembers or not scene.is_harmonic:
        return _largest_slip(scene, _coefficient(scene, law))
    if scene.degrees_of_freedom == 0:
        return abs(scene.motion().velocity)
    mass = scene.mass()
    stiffness = complex(mass.stiffness - mass.frequency**2, mass.damping * mass.frequency)
    force = abs(mass.force) * mass.frequency
    return force / abs(stiffness) if stiffness else math.inf


def _without_spring(velocity: Callable[..., float], scene: Scene, *law: FrictionLaw | None) -> float:
    """Return a velocity of a body that no spring holds, as the limit on soft ones."""
    scenes, found = Scenes.of([scene]), []
    for units in springs_for(scene, remembers=False):
        given = (one and measured(one, units) for one in law)
        found.append(velocity(held(scenes, units)[0], *given) * units.velocity)
    return float(without_spring(np.array(found)).value)


def velocity_scale(scene: Scene) -> float:
    """Return V_lin for a constant normal load, a scale of velocities that needs no law [omega_1 L].

    For a body that is not linear it is that of one harmonic or, where loads are no sine, that of its linear
    springs and dashpots.
    """
    if scene.is_free:
        return _without_spring(velocity_scale, scene)
    if not scene.is_harmonic:
        return _largest_slip(scene, 0.0)
    if scene.bends:
        bends = scene.mass().bends
        return scene.frequency * math.hypot(bends.sine, bends.cosine)
    return friction_free_velocity(scene)


def friction_free_response(
    scene: Scene, law: FrictionLaw | None, order: int
) -> tuple[Piecewise, Piecewise] | None:
    """Return the friction-free x1 and x2, or for order 1 their velocities; None if one has no bound.

    Raise ValueError as ``friction_free_velocity``, and for a body that remembers under loads that have
    corners.
    """
    found = _response(scene, _coefficient(scene, law), order)
    return None if found[0] is None or found[1] is None else (found[0], found[1])


def _coefficient(scene: Scene, law: FrictionLaw | None) -> float:
    """Return the coefficient with which a varying normal load pushes the body along x1 in steady sliding."""
    if scene.degrees_of_freedom == 0 or scene.signals().normal_load == Signal():
        return 0.0
    if law is None:
        raise ValueError("friction_free_velocity: where the normal load varies, give the law of friction")
    return math.copysign(law.sliding_friction(abs(scene.belt_speed)), scene.belt_speed)


def _response(scene: Scene, coefficient: float, order: int) -> tuple[Piecewise | None, Piecewise | None]:
    mass, signals = scene.mass(), scene.signals()
    edges = signals.edges()
    push = signals.load[0].plus(signals.normal_load.scaled(coefficient))
    across = LinearOscillator(mass.transverse_damping, mass.transverse_stiffness)
    if scene.remembers:
        if push.pieces:
            raise ValueError("friction_free_response: a body that remembers answers sums of sines alone")
        body = linear_body(scene)
        along: Piecewise | None = piecewise(
            Signal(tuple(answered(body, each, order) for each in push.waves)), edges
        )
    else:
        along = LinearOscillator(mass.damping, mass.stiffness).response(push, edges, order)
    return along, across.response(signals.load[1], edges, order)


def _largest_slip(scene: Scene, coefficient: float) -> float:
    """Return the maximum of x1' minus the belt's vibration, over a period; infinite without a bound."""
    signals = scene.signals()
    if scene.remembers:
        body, load = linear_body(scene), signals.load[0].plus(signals.normal_load.scaled(coefficient))
        if not math.isfinite(body.mass) and load.reaches_beyond(body.known_to):
            return math.nan
        slip_of_body = friction_free_slip(body, load, signals.belt[0], signals.period)
        low, high = slip_of_body.extremes(signals.period)
        return high if scene.belt_speed >= 0.0 else -low
    slip = piecewise(signals.belt[0], signals.edges())
    if scene.degrees_of_freedom > 0:
        response, _ = _response(scene, coefficient, 1)
        if response is None:
            return math.inf
        slip = less(response, slip)
    return (slip if scene.belt_speed >= 0.0 else slip.negative()).maximum()


def less(first: Piecewise, second: Piecewise) -> Piecewise:
    """Return the difference of two functions on the same pieces, the second without free motion."""
    other = second.negative()
    return first._replace(
        middle=first.middle + other.middle,
        slope=first.slope + other.slope,
        waves=first.waves + other.waves,
    )


class LinearOscillator(NamedTuple):
    """Oscillator x'' + damping x' + stiffness x = load, with damping >= 0, stiffness > 0."""

    damping: float
    stiffness: float

    def response(self, load: Signal, edges: Floats, order: int) -> Piecewise | None:
        """Return the periodic x, or its derivative of order 1, under a load; None if it has no bound.

        edges: of pieces within which the load has no corner.
        """
        waves = []
        for frequency, phasor in load.waves:
            dynamic = complex(self.stiffness - frequency**2, self.damping * frequency)
            if dynamic == 0 and phasor != 0:
                return None
            if phasor != 0:
                waves.append(Wave(frequency, (1j * frequency) ** order * phasor / dynamic))
        x, v = np.zeros(len(edges) - 1), np.zeros(len(edges) - 1)
        for each in load.pieces:
            found = self._free(each, edges[:-1])
            if found is None:
                return None
            x, v = x + found[0], v + found[1]
        value, slope = load.lines_at(0.5 * (edges[:-1] + edges[1:]))
        steady = value / self.stiffness - slope * self.damping / self.stiffness**2, slope / self.stiffness
        middle, slope = (*steady, np.zeros(len(value)))[order : order + 2]
        return Piecewise(
            edges, middle, slope, tuple(waves), FreeMotion(self.damping, self.stiffness, x, v, order)
        )

    def _free(self, load: Segments, at: Floats) -> tuple[Floats, Floats] | None:
        """Return position and velocity of the free motion that joins the responses to the lines.

        At every corner the responses jump, and the free motion jumps the other way. In a period it loses what
        the jumps add.
        """
        lines, period, k, c = load.lines, load.period, self.stiffness, self.damping
        starts = np.array([line.start for line in lines])
        length = np.diff([*starts, starts[0] + period])
        value, slope = np.array([line.value for line in lines]), np.array([line.slope for line in lines])
        after = np.array([value / k - slope * c / k**2, slope / k])
        before = np.roll(after + np.array([slope / k * length, np.zeros(len(lines))]), 1, axis=1)
        kept = self._flow(np.array([period]))[:, :, 0]
        lost = np.eye(2) - kept
        if abs(np.linalg.det(lost)) <= _SINGULAR:
            return None
        kicks = np.linalg.solve(lost, before - after)
        since = np.mod(at[:, None] - starts, period)
        since = np.where(period - since <= 1e-12 * period, 0.0, since)
        x, v = np.einsum("abij,bj->ai", self._flow(since), kicks)
        return x, v

    def _flow(self, since: Floats) -> Floats:
        """Return the matrix of a free motion over this time, from (x, v) to (x, v), on the first two axes."""
        cosine, sine = oscillation(self.damping, self.stiffness, since)
        half = 0.5 * self.damping
        return np.array(
            [[cosine + half * sine, sine], [-self.stiffness * sine, cosine - half * sine]], dtype=np.float64
        )
