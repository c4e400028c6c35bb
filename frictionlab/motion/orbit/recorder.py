"""Arrays into which a kernel writes an orbit, panel by panel, and calculus on such a panel.

A panel has Gauss-Lobatto nodes. Its polynomial is differentiated and interpolated, and its zeros are found.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.interpret import run_as
from frictionlab.motion.orbit.record import Orbit
from frictionlab.values.quantities import Floats

PER_PANEL = 10
_legendre = np.polynomial.legendre.Legendre.basis(PER_PANEL - 1)
NODES: Floats = np.concatenate(([-1.0], _legendre.deriv().roots().real, [1.0]))
WEIGHTS: Floats = 2.0 / (PER_PANEL * (PER_PANEL - 1) * _legendre(NODES) ** 2)
_differences = NODES[:, None] - NODES[None, :] + np.eye(PER_PANEL)
BARYCENTRIC: Floats = 1.0 / _differences.prod(axis=1)
_ratios = BARYCENTRIC[None, :] / BARYCENTRIC[:, None] / _differences * (1.0 - np.eye(PER_PANEL))
DERIVATIVE: Floats = _ratios - np.diag(_ratios.sum(axis=1))


def orbit_at_one_place(x: complex, mean: complex, rests: bool) -> Orbit:
    """Return the orbit of a mass that keeps its place, over a time of 2 pi; mean: of its friction coefficient."""
    whole, tau = np.ones((1, PER_PANEL), np.complex128), np.pi * (NODES[None, :] + 1.0)
    return Orbit(tau, x * whole, 0.0 * whole, -mean * whole, np.array([rests]))


@inner
def differentiate_panel(values: Any, slope: Any) -> None:
    """Write the derivative of the panel polynomial at the nodes to ``slope`` [per half panel]."""
    for row in range(values.size):
        total = 0.0
        for column in range(values.size):
            total += DERIVATIVE[row, column] * values[column]
        slope[row] = total


def _differentiate_in_python(values: Any, slope: Any) -> None:
    slope[:] = DERIVATIVE @ values


run_as(differentiate_panel, _differentiate_in_python)


@inner
def interpolate(values: Any, at: float) -> float:
    """Return the polynomial through the nodes at a place (barycentric formula; Berrut & Trefethen, 2004)."""
    above, below = 0.0, 0.0
    for node in range(values.size):
        gap = at - NODES[node]
        # At a node the formula divides zero by zero.
        if gap == 0.0:
            return values[node]
        above += BARYCENTRIC[node] / gap * values[node]
        below += BARYCENTRIC[node] / gap
    return above / below


@inner
def zero_between(values: Any, low: float, high: float) -> float:
    """Return a zero of the panel polynomial between two nodes of opposite sign (Illinois regula falsi)."""
    at_low, at_high = interpolate(values, low), interpolate(values, high)
    middle, side = high, 0
    for _ in range(40):
        # Illinois: an end that stays twice in a row has its value halved, so that both ends converge.
        if at_high == at_low or high - low < 1e-9:
            break
        middle = (low * at_high - high * at_low) / (at_high - at_low)
        value = interpolate(values, middle)
        if (value > 0.0) == (at_high > 0.0):
            high, at_high, at_low = middle, value, 0.5 * at_low if side > 0 else at_low
            side = 1
        else:
            low, at_low, at_high = middle, value, 0.5 * at_high if side < 0 else at_high
            side = -1
    return middle


def interpolation_weights(at: Floats) -> Floats:
    """Return rows of weights that interpolate from the nodes to each place in [-1, 1]."""
    gaps = at[:, None] - NODES[None, :]
    hit = gaps == 0.0
    weights = BARYCENTRIC / np.where(hit, 1.0, gaps)
    weights = np.where(hit.any(axis=1, keepdims=True), hit.astype(float), weights)
    return weights / weights.sum(axis=1, keepdims=True)


class Track(NamedTuple):
    """Arrays for the panels of an orbit [panels, nodes], stick [panels], and the number written [1]."""

    tau: Any
    x: Any
    v: Any
    friction: Any
    stick: Any
    filled: Any


@inner
def track_of(room: int) -> Track:
    """Return an empty track for at most ``room`` panels; with 0 nothing is recorded."""
    nodes = NODES.size
    return Track(
        np.empty((room, nodes)),
        np.empty((room, nodes), np.complex128),
        np.empty((room, nodes), np.complex128),
        np.empty((room, nodes), np.complex128),
        np.zeros(room, np.bool_),
        np.zeros(1, np.int64),
    )


@inner
def grown(track: Track, room: int) -> Track:
    """Return the same track with more room."""
    larger = track_of(room)
    for panel in range(track.filled[0]):
        larger.stick[panel] = track.stick[panel]
        for node in range(NODES.size):
            larger.tau[panel, node], larger.x[panel, node] = track.tau[panel, node], track.x[panel, node]
            larger.v[panel, node] = track.v[panel, node]
            larger.friction[panel, node] = track.friction[panel, node]
    larger.filled[0] = track.filled[0]
    return larger


def panel_writer(state_at: Any) -> Any:
    """Return ``note_panel(track, tau, h, stick, *given)`` for a kernel function ``state_at(part, *given)``.

    It writes the panel that begins at tau and lasts h, if there is room for it. state_at returns position,
    velocity and friction coefficient at the time ``part`` after the beginning. (numba caches no kernel that
    is handed a function.)
    """

    @inner
    def note_panel(track: Track, tau: float, h: float, stick: bool, *given: Any) -> None:
        # A track without room for a panel means that nothing is recorded.
        row = track.filled[0]
        if row == track.stick.size:
            return
        for k in range(NODES.size):
            part = 0.5 * h * (1.0 + NODES[k])
            x, v, rub = state_at(part, *given)
            track.tau[row, k] = tau + part
            track.x[row, k] = x
            track.v[row, k] = v
            track.friction[row, k] = rub
        track.stick[row] = stick
        track.filled[0] = row + 1

    return note_panel
