"""Calculus on a panel of Gauss-Lobatto nodes: derivative, interpolation, zeros."""

from __future__ import annotations

from typing import Any

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.interpret import run_as
from frictionlab.quantities import Floats

PER_PANEL = 10
_legendre = np.polynomial.legendre.Legendre.basis(PER_PANEL - 1)
NODES: Floats = np.concatenate(([-1.0], _legendre.deriv().roots().real, [1.0]))
WEIGHTS: Floats = 2.0 / (PER_PANEL * (PER_PANEL - 1) * _legendre(NODES) ** 2)
_differences = NODES[:, None] - NODES[None, :] + np.eye(PER_PANEL)
BARYCENTRIC: Floats = 1.0 / _differences.prod(axis=1)
_ratios = BARYCENTRIC[None, :] / BARYCENTRIC[:, None] / _differences * (1.0 - np.eye(PER_PANEL))
DERIVATIVE: Floats = _ratios - np.diag(_ratios.sum(axis=1))


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
    """The polynomial through the nodes (barycentric formula; Berrut & Trefethen, 2004)."""
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
    """A zero of the panel polynomial between two nodes of opposite sign (Illinois regula falsi)."""
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
    """Rows of weights that interpolate from the nodes to each place in [-1, 1]."""
    gaps = at[:, None] - NODES[None, :]
    hit = gaps == 0.0
    weights = BARYCENTRIC / np.where(hit, 1.0, gaps)
    weights = np.where(hit.any(axis=1, keepdims=True), hit.astype(float), weights)
    return weights / weights.sum(axis=1, keepdims=True)
