"""Measurements in blocks that know nothing of each other: given, cycles of a path, or runs of alike residuals."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from frictionlab.fitting.measured import Measurements
from frictionlab.quantities import Floats

FEWEST, MOST = 4, 60
"""Blocks that are cut where none are given."""
TIMES_AS_LONG = 4.0
"""A block against the length over which residuals are correlated."""


def blocks_of(measured: Measurements, residuals: Floats) -> tuple[NDArray[np.int64], str]:
    """The block of each row, from 0, and a word on where it is from."""
    if "block" in measured.table:
        return np.unique(measured.table["block"].astype(str), return_inverse=True)[1], "given"
    if measured.is_path and (cycles := _cycles(measured)) is not None:
        return cycles, "cycles of the slip"
    order = np.argsort(measured.table[measured.along].to_numpy(dtype=float), kind="stable")
    length = TIMES_AS_LONG * correlation_length(residuals[order])
    count = int(
        np.clip(
            len(residuals) / length, min(FEWEST, len(residuals)), MOST if measured.is_path else len(residuals)
        )
    )
    cut = np.empty(len(residuals), np.int64)
    cut[order] = np.arange(len(residuals)) * count // len(residuals)
    return cut, "runs of correlated residuals" if count < len(residuals) else "single points"


def autocorrelation(residuals: Floats, most: int) -> Floats:
    """Of residuals in their order, at the lags from 0 to this one."""
    apart = residuals - residuals.mean()
    size = 1 << (2 * len(apart) - 1).bit_length()
    spectrum = np.abs(np.fft.rfft(apart, size)) ** 2
    found = np.fft.irfft(spectrum, size)[: most + 1]
    return np.asarray(found / found[0]) if found[0] > 0.0 else np.eye(1, most + 1)[0]


def correlation_length(residuals: Floats) -> float:
    """One and twice the sum of the autocorrelation up to its first value below 0: samples that count as one.

    One where neighbours are no more alike than independent ones may be by chance.
    """
    if len(residuals) < 4:
        return 1.0
    found = autocorrelation(residuals, len(residuals) // 2)[1:]
    if found[0] < 2.0 / math.sqrt(len(residuals)):
        return 1.0
    below = np.flatnonzero(found < 0.0)
    return 1.0 + 2.0 * float(found[: below[0] if below.size else len(found)].sum())


def _cycles(measured: Measurements) -> NDArray[np.int64] | None:
    """Whole swings of the slip about its mean, where it has several; a start before the first belongs to that."""
    slip = measured.table["slip"].to_numpy(dtype=float)
    swing = np.ptp(slip)
    high, low = slip.mean() + 0.25 * swing, slip.mean() - 0.25 * swing
    side = np.where(slip > high, 1, np.where(slip < low, -1, 0))
    known = np.flatnonzero(side)
    rises = known[1:][(side[known[1:]] == 1) & (side[known[:-1]] == -1)]
    if len(rises) < FEWEST:
        return None
    cycle = np.searchsorted(rises, np.arange(len(slip)), side="right") - 1
    last = len(rises) - 1
    return np.clip(cycle, 0, last - 1 if last > 0 else 0).astype(np.int64)
