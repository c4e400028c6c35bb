"""What shakes a scene, read from the plain keys of a study: loads, belt velocity and normal load over time.

Written for tests alone; it shares no code with the package. Each signal is a sum of sines and of straight pieces,
which end at the corners of square, triangle and sawtooth waves.
"""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

LOAD1, LOAD2, BELT1, BELT2, NORMAL = range(5)
CORNERS = {"square": (0.0, math.pi), "triangle": (0.5 * math.pi, 1.5 * math.pi), "sawtooth": (math.pi,)}
"""Angles at which a waveform or its slope jumps."""


class Forcing(NamedTuple):
    """Signals over one period, LOAD1 ... NORMAL: pieces + sum of amplitude sin(rate tau + phase)."""

    edges: np.ndarray
    """Times between which no signal has a corner: 0, ..., period."""
    pieces: np.ndarray
    """[span, signal, 2]: value at the start of the span, slope."""
    which: np.ndarray
    sines: np.ndarray
    """[sine, 3]: rate, phase, amplitude, each added to the signal that ``which`` names."""
    drive_periods: int
    fastest: float
    """Largest circular frequency of any signal."""


class _Wave(NamedTuple):
    """amplitude times a waveform of the angle rate tau + phase, added to signals with these weights."""

    weights: dict[int, float]
    amplitude: float
    waveform: Any
    rate: float
    phase: float

    lifted: float = 0.0
    """Mean over the period, taken off a velocity and a normal load."""

    def points(self) -> list[tuple[float, float]]:
        """Shares of the period and values there of a waveform that is straight between them."""
        if not isinstance(self.waveform, dict):
            return []
        if "square" in self.waveform:
            duty = self.waveform["square"]["duty"]
            return [(0.0, 1.0), (duty, 1.0), (duty, -1.0), (1.0, -1.0)]
        if "sawtooth" in self.waveform:
            half = 0.5 * self.waveform["sawtooth"]["width"]
            return [(half, 1.0), (1.0 - half, -1.0)]
        return [(share, value) for share, value in self.waveform.get("points", ())]

    def mean(self) -> float:
        """Mean of the waveform over its period."""
        points = self.points()
        pairs = itertools.pairwise([*points, *((share + 1.0, value) for share, value in points[:1])])
        return sum(0.5 * (low + high) * (b - a) for (a, low), (b, high) in pairs)

    def sines(self) -> list[tuple[float, float, float]]:
        if self.waveform == "sine":
            return [(self.rate, self.phase, self.amplitude)]
        if not isinstance(self.waveform, dict) or "harmonics" not in self.waveform:
            return []
        return [
            (
                term["order"] * self.rate,
                term["order"] * self.phase + math.radians(term.get("phase", 0.0)),
                self.amplitude * term["amplitude"],
            )
            for term in self.waveform["harmonics"]
        ]

    def corners(self, period: float) -> list[float]:
        if isinstance(self.waveform, str):
            angles = CORNERS.get(self.waveform, ())
        else:
            angles = tuple(2.0 * math.pi * share for share, _ in self.points())
        turns = round(period * self.rate / (2.0 * math.pi))
        first = [((angle - self.phase) / (2.0 * math.pi)) % 1.0 for angle in angles]
        return [(share + turn) * period / turns for share in first for turn in range(turns)]

    def piece(self, start: float, end: float) -> tuple[float, float]:
        """Value at the start of a span without corners, slope; nothing of what ``sines`` gives."""
        middle = self.rate * 0.5 * (start + end) + self.phase
        if self.waveform == "square":
            return math.copysign(self.amplitude, math.sin(middle)), 0.0
        if self.waveform == "triangle":
            value = 2.0 / math.pi * math.asin(math.sin(middle))
            slope = math.copysign(2.0 / math.pi, math.cos(middle)) * self.rate
        elif self.waveform == "sawtooth":
            value = math.remainder(middle, 2.0 * math.pi) / math.pi
            slope = self.rate / math.pi
        elif points := self.points():
            share, first = (middle / (2.0 * math.pi)) % 1.0, points[0]
            closed = [(points[-1][0] - 1.0, points[-1][1]), *points, (first[0] + 1.0, first[1])]
            (a, low), (b, high) = next(
                pair for pair in itertools.pairwise(closed) if pair[0][0] < share < pair[1][0]
            )
            slope = (high - low) / (b - a) * self.rate / (2.0 * math.pi)
            value = low + (high - low) * (share - a) / (b - a) - self.lifted
        else:
            return 0.0, 0.0
        return self.amplitude * (value - slope * 0.5 * (end - start)), self.amplitude * slope


def forcing(scene: dict[str, Any]) -> Forcing:
    """Of a scene with a drive, a prescribed slip, a vibrating belt or a changing normal load."""
    base, ratios = base_frequency(scene), [Fraction(1)]
    waves = list(_waves(scene, base, ratios))
    drive_periods = math.lcm(*(ratio.denominator for ratio in ratios))
    period = drive_periods * 2.0 * math.pi / base
    corners = sorted({0.0, period} | {time for wave in waves for time in wave.corners(period)})
    edges = [0.0]
    edges += [b for a, b in itertools.pairwise(corners) if b - a > 1e-12 * period]
    edges[-1] = period
    pieces, drive = np.zeros((len(edges) - 1, 5, 2)), scene.get("drive")
    pieces[:, BELT1, 0] = scene["belt_speed"]
    pieces[:, NORMAL, 0] = scene.get("normal_load", 1.0)
    for part, first, second in (
        (drive, LOAD1, LOAD2),
        ((scene.get("transverse") or {}).get("load"), LOAD2, LOAD1),
    ):
        for signal, weight in _along(part or {}, first, second).items():
            pieces[:, signal, 0] += weight * (part or {}).get("offset", 0.0)
    which, sines = [], []
    for wave in waves:
        for signal, weight in wave.weights.items():
            for span in range(len(pieces)):
                value, slope = wave.piece(edges[span], edges[span + 1])
                pieces[span, signal] += weight * value, weight * slope
            which += [signal] * len(wave.sines())
            sines += [(rate, phase, weight * size) for rate, phase, size in wave.sines()]
    fastest = max([wave.rate for wave in waves] + [rate for rate, _, _ in sines])
    return Forcing(
        np.array(edges),
        pieces,
        np.array(which, dtype=np.int64),
        np.array(sines).reshape(-1, 3),
        drive_periods,
        fastest,
    )


def base_frequency(scene: dict[str, Any]) -> float:
    """Of the drive or the prescribed slip, else of whichever vibration gives one."""
    parts = ("drive", "slip", "transverse_slip", "belt_vibration", "normal_load_variation")
    return next(scene[part]["frequency"] for part in parts if "frequency" in (scene.get(part) or {}))


def _along(part, first, second, sign=1.0):
    angle = math.radians(part.get("direction", 0.0))
    weights = {first: sign * math.cos(angle), second: sign * math.sin(angle)}
    return weights if part.get("direction") else {first: sign}


def _waves(scene, base, ratios):
    def wave(part, weights, amplitude):
        ratio = Fraction(part.get("frequency_ratio", 1)).limit_denominator(1000)
        ratios.append(ratio)
        phase = math.radians(part.get("phase", 0.0))
        keeps_none = "velocity_amplitude" in part or part is scene.get("normal_load_variation")
        found = _Wave(weights, amplitude, part.get("waveform", "sine"), base * float(ratio), phase)
        return found._replace(lifted=found.mean()) if keeps_none else found

    def force(part):
        if "amplitude" in part:
            return part["amplitude"]
        return part["unbalance"] * base**2

    if drive := scene.get("drive"):
        yield wave(drive, _along(drive, LOAD1, LOAD2), force(drive))
    if load := (scene.get("transverse") or {}).get("load"):
        yield wave(load, {LOAD2: 1.0}, force(load))
    if slip := scene.get("slip"):
        yield wave(slip, _along(slip, BELT1, BELT2, -1.0), slip["velocity_amplitude"])
    if slip := scene.get("transverse_slip"):
        yield wave(slip, {BELT2: -1.0}, slip["velocity_amplitude"])
    if belt := scene.get("belt_vibration"):
        yield wave(belt, _along(belt, BELT1, BELT2), belt["velocity_amplitude"])
    if normal := scene.get("normal_load_variation"):
        yield wave(normal, {NORMAL: 1.0}, scene.get("normal_load", 1.0) * normal["amplitude"])
