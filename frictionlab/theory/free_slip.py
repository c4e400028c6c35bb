"""The slip velocity of a linear body without friction, under loads that are sines or have corners."""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import numpy as np

from frictionlab.quantities import Floats
from frictionlab.scene.receptance import LinearBody
from frictionlab.scene.signals import Segments, Signal, Wave, edges_of, highest
from frictionlab.theory.periodic_response import PeriodicResponse, periodic_response

POINTS_OF_PANEL = 64


class FreeSlip(NamedTuple):
    """On a belt whose mean velocity is zero: waves, and what corners of the load bring [n, 3]: their times in [0,
    period), by how much the load jumps there and by how much its slope does.

    With V and W of theory/periodic_response.py the slip velocity is the sum of waves, jump V + bend W after every
    corner, and ``steady``, that makes its mean zero.
    """

    waves: Signal
    corners: Floats
    steady: float
    response: PeriodicResponse | None

    def extremes(self, period: float) -> tuple[float, float]:
        """The least and the largest value."""
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
    """Of a body under this load, on a belt of this vibration."""
    waves = Signal(tuple(answered(body, each, 1) for each in load.waves)).plus(belt.scaled(-1.0))
    corners = corners_of(load, period)
    if not len(corners):
        return FreeSlip(waves, corners, 0.0, None)
    response = periodic_response(body, 2.0 * math.pi / period)
    steady = -response.static * float(corners[:, 1].sum()) / period
    return FreeSlip(waves, corners[np.argsort(corners[:, 0], kind="stable")], steady, response)


def corners_of(load: Signal, period: float) -> Floats:
    """Times in [0, period), by how much the load jumps there and by how much its slope does [n, 3]."""
    corners = np.array([row for each in load.pieces for row in _corners(each, period)]).reshape(-1, 3)
    return np.asarray(corners[np.any(corners[:, 1:] != 0.0, axis=1)])


def _corners(load: Segments, period: float) -> list[tuple[float, float, float]]:
    """Their times, and by how much the load and its slope jump there."""
    rows = []
    for line, last in zip(load.lines, [load.lines[-1], *load.lines[:-1]], strict=True):
        length = math.fmod(line.start - last.start + load.period, load.period) or load.period
        jump, bend = line.value - last.value - last.slope * length, line.slope - last.slope
        size = max(abs(line.value), abs(last.value), load.period * abs(line.slope))
        jump = 0.0 if abs(jump) < 1e-14 * size else jump
        rows += [(line.start + k * load.period, jump, bend) for k in range(round(period / load.period))]
    return rows


def answered(body: LinearBody, wave: Wave, order: int) -> Wave:
    """x1 under a force of this wave, or its derivative of order 1."""
    response = body.receptance(np.array([wave.frequency]))[0]
    return Wave(wave.frequency, complex((1j * wave.frequency) ** order * response * wave.phasor))
