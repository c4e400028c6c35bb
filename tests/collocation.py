"""A planar Coulomb orbit without stick by spectral collocation in time, closed by Newton's method.

Written for tests alone; it shares no formula and no code with the methods it checks: no time steps and no period
map but one nonlinear system for a whole period, in position and velocity themselves. The period is cut into
domains; in each the motion is a polynomial through Chebyshev-Lobatto nodes, the equation of motion holds at all of
them in integral form, and the domains are halved where the polynomial has not converged, which is where the slip is
slow. The Jacobian of w/|w| is analytic; the guess comes by way of friction w/sqrt(|w|^2 + width^2), width -> 0.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

REFERENCE = Path(__file__).parent / "reference"
DEGREE = 15
MOST_DOMAINS = 4000

nodes = -np.cos(np.pi * np.arange(DEGREE + 1) / DEGREE)
_to_coefficients = np.linalg.inv(np.polynomial.chebyshev.chebvander(nodes, DEGREE))
_antiderivatives = np.polynomial.chebyshev.chebint(np.eye(DEGREE + 1), lbnd=-1.0)
_integrals = np.polynomial.chebyshev.chebvander(nodes, DEGREE + 1) @ _antiderivatives @ _to_coefficients
"""Integral from -1 to each node of the polynomial through values at the nodes."""


class Numbers(NamedTuple):
    """x1'' + 2 b x1' + x1 and x2'' + 2 b2 r x2' + r^2 x2 under loads P1, P2 times sin(Omega tau), friction, belt."""

    damping: float
    transverse_damping: float
    natural_frequency: float
    frequency: float
    load: float
    transverse_load: float
    friction: float
    belt_speed: float


class Found(NamedTuple):
    """Time means of w/|w|, the least |w|, the largest Floquet multiplier, and how the mean moved on refinement."""

    along: float
    across: float
    slowest: float
    multiplier: float
    change: float


def solve(numbers: Numbers) -> Found:
    """The orbit, refined until its mean moves by less than 1e-13. Raises ArithmeticError where it does not."""
    edges = np.linspace(0.0, 2.0 * np.pi / numbers.frequency, 25)
    values = _linear_response(numbers, edges)
    width = np.abs(values[..., 2:]).max()
    while width > 0.0:
        edges, values, _ = _converged(numbers, edges, values, width, 1e-6)
        slowest = _slip(numbers, values)[1].min()
        width = 0.3 * width if width > 0.03 * slowest else 0.0
    edges, values, _ = _converged(numbers, edges, values, 0.0, 1e-13)
    mean = _mean(numbers, edges, values)
    for _ in range(3):
        edges, values = _halved(edges, values, np.ones(len(edges) - 1, bool))
        edges, values, matrix = _converged(numbers, edges, values, 0.0, 1e-13)
        finer = _mean(numbers, edges, values)
        mean, change = finer, np.abs(finer - mean).max()
        if change < 1e-13:
            break
    else:
        raise ArithmeticError(f"the mean still moves by {change:.1e}: {numbers}")
    multiplier = np.abs(np.linalg.eigvals(matrix)).max()
    return Found(mean[0], mean[1], _slip(numbers, values)[1].min(), multiplier, change)


def _times(edges):
    """Times of the nodes [domains, nodes]."""
    return edges[:-1, None] + 0.5 * np.diff(edges)[:, None] * (1.0 + nodes)


def _linear_response(n, edges):
    """Position and velocity [domains, nodes, 4] without friction."""
    turn = np.exp(1j * n.frequency * _times(edges))
    omega = n.frequency
    along = n.load / (1.0 - omega**2 + 2j * n.damping * omega)
    r = n.natural_frequency
    across = n.transverse_load / (r**2 - omega**2 + 2j * n.transverse_damping * r * omega)
    x1, x2 = along * turn, across * turn
    return np.stack([x1.imag, x2.imag, (1j * omega * x1).imag, (1j * omega * x2).imag], axis=-1)


def _slip(n, values):
    w = values[..., 2:] - np.array([n.belt_speed, 0.0])
    return w, np.hypot(w[..., 0], w[..., 1])


def _rates(n, edges, values, width):
    """The right-hand side [domains, nodes, 4] and its Jacobian [domains, nodes, 4, 4]."""
    w, speed = _slip(n, values)
    size = np.sqrt(speed**2 + width**2)[..., None]
    drive = np.sin(n.frequency * _times(edges))[..., None] * np.array([n.load, n.transverse_load])
    springs = np.array([1.0, n.natural_frequency**2])
    dashpots = 2.0 * np.array([n.damping, n.transverse_damping * n.natural_frequency])
    x, v = values[..., :2], values[..., 2:]
    rate = np.concatenate([v, drive - springs * x - dashpots * v - n.friction * w / size], axis=-1)
    slope = np.zeros((*values.shape, 4))
    slope[..., :2, 2:] = np.eye(2)
    slope[..., 2:, :2] = -np.diag(springs)
    outer = w[..., :, None] * w[..., None, :]
    slope[..., 2:, 2:] = -np.diag(dashpots) - n.friction * (
        np.eye(2) / size[..., None] - outer / size[..., None] ** 3
    )
    return rate, slope


def _newton_step(n, edges, values, width):
    """The Newton correction of the periodic collocation system, and its monodromy matrix."""
    domains, size = len(values), 4 * DEGREE
    half = 0.5 * np.diff(edges)[:, None, None]
    rate, slope = _rates(n, edges, values, width)
    path = values[:, :1] + half * np.einsum("kj,djc->dkc", _integrals, rate) - values
    wave = half[..., None, None] * np.einsum("kj,djce->dkcje", _integrals, slope)
    left = np.eye(size) - wave[:, 1:, :, 1:].reshape(domains, size, size)
    start = np.tile(np.eye(4), (DEGREE, 1)) + wave[:, 1:, :, 0].reshape(domains, size, 4)
    both = np.concatenate([path[:, 1:].reshape(domains, size, 1), start], axis=2)
    answer = np.linalg.solve(left, both).reshape(domains, DEGREE, 4, 5)
    own, per_start = answer[..., 0], answer[..., 1:]
    jump = np.concatenate([values[1:, 0], values[:1, 0]]) - values[:, -1]  # of the next start from this end
    offset, matrix = np.zeros(4), np.eye(4)
    for d in range(domains):
        offset = per_start[d, -1] @ offset + own[d, -1] - jump[d]
        matrix = per_start[d, -1] @ matrix
    first = np.linalg.solve(np.eye(4) - matrix, offset)
    change = np.empty_like(values)
    for d in range(domains):
        change[d, 0] = first
        change[d, 1:] = own[d] + per_start[d] @ first
        first = change[d, -1] - jump[d]
    return change, matrix


def _newton(n, edges, values, width):
    """Newton's method to rounding, with shortened steps where the slip would turn too far at once."""
    for _ in range(60):
        change, matrix = _newton_step(n, edges, values, width)
        turn = np.hypot(change[..., 2], change[..., 3]) / np.hypot(_slip(n, values)[1], width)
        part = min(1.0, 0.7 / turn.max())
        values = values + part * change
        if part == 1.0 and np.abs(change).max() <= 1e-13 * np.abs(values).max():
            return values, matrix
    if np.abs(change).max() > 1e-11 * np.abs(values).max():
        raise ArithmeticError(f"Newton's method does not converge: {n}")
    return values, matrix


def _tails(w, speed, width):
    """Size of the last coefficients of the direction of slip [domains], which converges last."""
    direction = w / np.hypot(speed, width)[..., None]
    return np.abs(np.einsum("ck,dke->dce", _to_coefficients[-3:], direction)).max(axis=(1, 2))


def _halved(edges, values, which):
    """The same polynomials on a mesh with some domains cut in two."""
    cut = [0.5 * (edges[:-1] + edges[1:])[which]]
    fine = np.sort(np.concatenate([edges, *cut]))
    owner = np.repeat(np.arange(len(values)), 1 + which)
    start, width = edges[owner], np.diff(edges)[owner]
    place = 2.0 * (_times(fine) - start[:, None]) / width[:, None] - 1.0
    weights = np.polynomial.chebyshev.chebvander(place, DEGREE) @ _to_coefficients
    return fine, np.einsum("dkj,djc->dkc", weights, values[owner])


def _converged(n, edges, values, width, within):
    """Solve and halve until the direction of slip has converged in every domain."""
    while True:
        values, matrix = _newton(n, edges, values, width)
        w, speed = _slip(n, values)
        rounding = 1e-15 * np.abs(values[..., 2:]).max() / np.hypot(speed.min(), width)
        poor = _tails(w, speed, width) > max(within, rounding)
        if not poor.any():
            return edges, values, matrix
        if len(values) > MOST_DOMAINS:
            raise ArithmeticError(f"more than {MOST_DOMAINS} domains: {n}")
        edges, values = _halved(edges, values, poor)


def _mean(n, edges, values):
    w, speed = _slip(n, values)
    parts = np.einsum("k,dke->de", _integrals[-1], w / speed[..., None])
    return (0.5 * np.diff(edges) @ parts) / (edges[-1] - edges[0])


def numbers_of(path: Path, belt_speed: float) -> Numbers:
    """A point of a planar reference file: both loads of unbalance 10, damping 0.1, mu = 0.4."""
    frequency, normal_load, omega_r = map(float, re.findall(r"(?<=Om|_g|wr)[\d.]+(?=_|\.csv)", path.name))
    load = 10.0 * frequency**2
    return Numbers(0.1, 0.1, omega_r, frequency, load, load, 0.4 * normal_load, belt_speed)
