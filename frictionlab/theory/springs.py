"""Bodies that remember as springs that relax: one for a standard linear solid, else a sum of eight.

A force k y, y' = x1' - y/time, is k p/(p + 1/time) times x1, with p = i omega. Powers of p are no finite sum
of such terms, but a few of them and a dashpot come close to one over the harmonics of a drive. Stiffnesses
and rates are found by least squares, weighted as the harmonics of a motion under forces that jump fall off.
All are positive: they only take energy, as does the memory that they stand for. Their error is estimated from
the answers for two other sums, whose misfit is four times as large, in two ways.

Source: of sums of relaxing springs for fractional derivatives Diethelm, Numerical Algorithms 47 (2008),
361-390.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.scene.body import Mass, with_relaxing
from frictionlab.scene.receptance import RememberingBody
from frictionlab.scene.scene import Scene
from frictionlab.values.quantities import Floats

COUNT = 8
"""Number of springs in a sum."""
FASTEST, SLOWEST = 1e3, 1e-6
"""Range of the rate of a standard linear solid that is followed exactly, over the frequency at which all
repeats."""
RATES = 300.0, 1e-3
"""Highest and lowest rate in a sum, over the same frequency."""
FITTED_ORDERS = 1000
"""Number of harmonics over which a sum is fitted."""
FALL = 3.0
"""Power of frequency by which the harmonics of a motion fall under a force that jumps."""
COARSER = 4.0
"""Misfit of the two other sums, over that of the best one."""
SHIFTS = (1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0), (1.0, 1.0, -1.0, -1.0, 1.0, 1.0, -1.0, -1.0)
"""Shifts of the logarithms of the rates of the two other sums, in proportion."""
BEST, COARSE = 0, (1, 2)
"""Numbers of the sums: the best one, and the two coarser ones."""


class Springs(NamedTuple):
    """Stiffnesses and rates of springs that relax, and a dashpot beside them."""

    stiffness: tuple[float, ...]
    rate: tuple[float, ...]
    dashpot: float = 0.0


def is_exact(scene: Scene) -> bool:
    """Check whether a standard linear solid, followed exactly, is all the memory of the body."""
    body = scene.body
    if body is None or body.fractional is not None or body.relaxation is None or body.relaxation.order != 1.0:
        return False
    return SLOWEST < 1.0 / (body.relaxation.time * base_frequency(scene)) < FASTEST


def base_frequency(scene: Scene) -> float:
    """Return the frequency at which everything repeats."""
    return scene.frequency / scene.periods


def springs_of(scene: Scene, which: int = BEST) -> Springs:
    """Return the memory of the body as springs; which: number of the sum."""
    assert scene.body is not None
    relaxation, fractional = scene.body.relaxation, scene.body.fractional
    if is_exact(scene):
        assert relaxation is not None
        return Springs((relaxation.stiffness,), (1.0 / relaxation.time,))
    return _sums_for(relaxation, fractional, base_frequency(scene))[which]


def mass_of(scene: Scene, which: int = BEST) -> Mass:
    """Return the numbers of a free scene, including the memory of its body."""
    mass = scene.mass()
    if not scene.remembers:
        return mass
    springs = springs_of(scene, which)
    mass = mass._replace(damping=mass.damping + springs.dashpot)
    return with_relaxing(mass, springs.stiffness, springs.rate)


@lru_cache(maxsize=256)
def _sums_for(relaxation: Any, fractional: Any, base: float) -> list[Springs]:
    memory = RememberingBody(0.0, relaxation=relaxation, fractional=fractional).memory
    if relaxation is not None:
        return [_scaled(each, base, 1.0) for each in _fitted(lambda p: memory(base * p))]
    # one fit of a power serves all frequencies
    size = fractional.coefficient * base**fractional.order
    return [_scaled(each, base, size) for each in _of_power(fractional.order)]


@lru_cache(maxsize=256)
def _of_power(order: float) -> list[Springs]:
    return _fitted(lambda p: p**order)


def _scaled(springs: Springs, base: float, size: float) -> Springs:
    stiffness = tuple(size * each for each in springs.stiffness)
    return Springs(stiffness, tuple(base * each for each in springs.rate), size * springs.dashpot / base)


def _fitted(memory: Callable[[Any], Any]) -> list[Springs]:
    """Fit the three sums to a force over x1 at p = i times a share of the base frequency."""
    from scipy.optimize import least_squares

    fit, (highest, lowest) = _Fit(memory), RATES
    starts = [np.linspace(np.log(0.15), np.log(0.5 * high), COUNT) for high in (highest, 0.2 * highest)]
    bounds = np.log(lowest), np.log(highest)
    found = [
        least_squares(fit.missed, each, bounds=bounds, xtol=1e-12, ftol=1e-12, gtol=1e-14, max_nfev=100)
        for each in starts
    ]
    best = np.sort(min(found, key=lambda each: float(each.cost)).x)
    return [fit.springs(best), *(fit.springs(_coarser(fit, best, np.array(shift))) for shift in SHIFTS)]


def _coarser(fit: _Fit, best: Floats, shift: Floats) -> Floats:
    """Return the logarithms of rates whose misfit is so many times the best one."""
    aim = COARSER * np.linalg.norm(fit.missed(best)) + 1e-9
    size = 1e-3
    while size < 1.0 and np.linalg.norm(fit.missed(best + size * shift)) < aim:
        size *= 1.5
    return best + size * shift


class _Fit:
    """Springs and a dashpot, of given rates, that are closest to a memory over the harmonics."""

    def __init__(self, memory: Callable[[Any], Any]) -> None:
        rare = np.geomspace(20.0, FITTED_ORDERS, 40)
        orders = np.unique(np.round(np.concatenate([np.arange(1.0, 20.0), rare])))
        self.p = 1j * orders
        values: NDArray[np.complex128] = memory(self.p)
        # each sampled order stands for its neighbours
        self.weights = np.sqrt(np.gradient(orders)) * orders**-FALL / float(np.abs(values[0]))
        self.sought = self._real(values)

    def _real(self, values: Any) -> Floats:
        weights = self.weights if values.ndim == 1 else self.weights[:, None]
        return np.concatenate([values.real * weights, values.imag * weights])

    def _solved(self, logarithms: Floats) -> tuple[Floats, Floats]:
        from scipy.optimize import nnls

        p = self.p[:, None]
        columns = self._real(np.concatenate([p / (p + np.exp(logarithms)), p], axis=1))
        sizes = np.linalg.norm(columns, axis=0)
        found, _ = nnls(columns / sizes, self.sought, maxiter=10_000)
        return found / sizes, columns @ (found / sizes) - self.sought

    def missed(self, logarithms: Floats) -> Floats:
        """Return the misfit of springs of these rates, in thousandths, a scale that suits the search."""
        return 1e3 * self._solved(logarithms)[1]

    def springs(self, logarithms: Floats) -> Springs:
        """Return the springs of these rates.

        Those without stiffness relax as slowly as the motion goes.
        """
        strengths, _ = self._solved(logarithms)
        least = 1e-13 * float(strengths.max())
        rates = np.where(strengths[:-1] > least, np.exp(logarithms), 1.0)
        stiffness = np.maximum(strengths[:-1], least)
        return Springs(tuple(stiffness.tolist()), tuple(rates.tolist()), float(strengths[-1]))
