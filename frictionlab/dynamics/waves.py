"""Sums of sines and a straight line as kernels see them: value, derivatives, bounds, integrals."""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.scene.body import Waves


@inner
def wave_at(waves: Waves, begins: float, tau: float) -> Any:
    """The value; begins: when the line has its value."""
    total = waves.value + (tau - begins) * waves.slope
    for j in range(waves.frequency.size):
        angle = waves.frequency[j] * tau
        total = total + waves.sine[j] * math.sin(angle) + waves.cosine[j] * math.cos(angle)
    return total


@inner
def wave_rate(waves: Waves, tau: float, order: int) -> Any:
    """The derivative of this order, 1 or higher."""
    total = waves.slope if order == 1 else 0.0 * waves.slope
    for j in range(waves.frequency.size):
        # every derivative is the wave a quarter of a period later
        angle = waves.frequency[j] * tau + 0.5 * math.pi * order
        turned = waves.sine[j] * math.sin(angle) + waves.cosine[j] * math.cos(angle)
        total = total + waves.frequency[j] ** order * turned
    return total


@inner
def wave_bound(waves: Waves, order: int) -> float:
    """A bound on the size of the derivative of this order, 1 or higher, at any time."""
    total = abs(waves.slope) if order == 1 else 0.0
    for j in range(waves.frequency.size):
        size = abs(waves.sine[j]) + abs(waves.cosine[j])
        total = total + waves.frequency[j] ** order * size
    return total


@inner
def wave_impulse(waves: Waves, begins: float, start: float, end: float) -> Any:
    """The integral."""
    lasts, middle = end - start, 0.5 * (start + end)
    total = lasts * (waves.value + (middle - begins) * waves.slope)
    for j in range(waves.frequency.size):
        half, angle = 0.5 * waves.frequency[j] * lasts, waves.frequency[j] * middle
        mean = math.sin(half) / half if half > 0.0 else 1.0
        total = total + (lasts * mean) * (waves.sine[j] * math.sin(angle) + waves.cosine[j] * math.cos(angle))
    return total


@inner
def wave_path_integral(waves: Waves, begins: float, start: float, end: float) -> Any:
    """The integral of the integral since the start."""
    lasts = end - start
    total = 0.5 * lasts * lasts * (waves.value + (start + lasts / 3.0 - begins) * waves.slope)
    for j in range(waves.frequency.size):
        frequency = waves.frequency[j]
        first, half = frequency * start, 0.5 * frequency * lasts
        # of a sine: what is left of lasts*cos(first) by the mean of the cosines on the way
        mean = math.sin(half) / half if half > 0.0 else 1.0
        by_sine = lasts * (math.cos(first) - mean * math.cos(first + half)) / frequency
        by_cosine = lasts * (mean * math.sin(first + half) - math.sin(first)) / frequency
        total = total + waves.sine[j] * by_sine + waves.cosine[j] * by_cosine
    return total
