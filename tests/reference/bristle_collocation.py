"""Bristle orbits by spectral collocation in time, closed by Newton's method: no time steps and no period map.

Written for the references alone. The period is cut into domains; in each the state is a polynomial through
Chebyshev-Lobatto nodes, and the equations hold at all of them in integral form. Domains end where the right-hand
side has a corner; those ends are moved until the switch is zero at them. Domains are halved where the polynomials
have not converged. The Jacobian is by complex steps.
"""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np

DEGREE = 15
MOST_DOMAINS = 3000
BATCH = 200
"""Domains whose linear systems are solved at once."""

nodes = -np.cos(np.pi * np.arange(DEGREE + 1) / DEGREE)
_to_coefficients = np.linalg.inv(np.polynomial.chebyshev.chebvander(nodes, DEGREE))
_antiderivatives = np.polynomial.chebyshev.chebint(np.eye(DEGREE + 1), lbnd=-1.0)
_integrals = np.polynomial.chebyshev.chebvander(nodes, DEGREE + 1) @ _antiderivatives @ _to_coefficients


def rates(n, modes, t, y):
    """Rates [domains, nodes, size] and the friction coefficient along x1, analytic in y within a mode."""
    mode, drive = modes[:, None], np.sin(n.frequency * t)
    if not n.planar:
        x, v, z = np.moveaxis(y, -1, 0)
        w = v - n.belt_speed
        curve = n.mu_kinetic + (n.mu_static - n.mu_kinetic) * np.exp(-((w / n.stribeck_speed) ** 2))
        share = _alpha(n, mode * z, curve) if n.elastic else 1.0
        dz = w - share * mode * w * z * n.stiffness / curve
        rub = n.stiffness * z + n.bristle_damping * dz + n.viscosity * w
        return np.stack([v, n.load * drive - n.damping * v - x - n.normal_load * rub, dz], axis=-1), rub
    x1, x2, v1, v2, z1, z2 = np.moveaxis(y, -1, 0)
    w1, w2 = v1 - n.belt_speed, v2
    speed = np.sqrt(w1 * w1 + w2 * w2)
    curve = n.mu_kinetic + (n.mu_static - n.mu_kinetic) * np.exp(-((speed / n.stribeck_speed) ** 2))
    share = np.where(mode > 0, _alpha(n, np.sqrt(z1 * z1 + z2 * z2), curve), 0.0) if n.elastic else 1.0
    back = share * speed * n.stiffness / curve
    dz1, dz2 = w1 - back * z1, w2 - back * z2
    rub1 = n.stiffness * z1 + n.bristle_damping * dz1 + n.viscosity * w1
    rub2 = n.stiffness * z2 + n.bristle_damping * dz2 + n.viscosity * w2
    dv1 = n.load * drive - n.damping * v1 - x1 - n.normal_load * rub1
    dv2 = n.transverse_load * drive - n.transverse_damping * v2 - n.transverse_stiffness * x2
    return np.stack([v1, v2, dv1, dv2 - n.normal_load * rub2, dz1, dz2], axis=-1), rub1


def _alpha(n, size, curve):
    top = curve / n.stiffness
    wave = 0.5 + 0.5 * np.sin(np.pi * (size - 0.5 * (top + n.breaks_at)) / (top - n.breaks_at))
    return np.where(size.real <= n.breaks_at, 0.0, np.where(size.real >= top.real, 1.0, wave))


def switch(n, y):
    """What is zero where the right-hand side has a corner."""
    if not n.planar:
        return y[..., 1] - n.belt_speed
    return y[..., 4] * (y[..., 2] - n.belt_speed) + y[..., 5] * y[..., 3]


def switch_rate(n, y, dy):
    """Its rate."""
    if not n.planar:
        return dy[..., 1]
    w1, w2 = y[..., 2] - n.belt_speed, y[..., 3]
    return dy[..., 4] * w1 + dy[..., 5] * w2 + y[..., 4] * dy[..., 2] + y[..., 5] * dy[..., 3]


class Mesh:
    """Domain ends, the mode of each domain, and which ends are corners."""

    def __init__(self, edges, modes):
        self.edges, self.modes = edges, modes

    def times(self):
        return self.edges[:-1, None] + 0.5 * np.diff(self.edges)[:, None] * (1.0 + nodes)

    def corners(self):
        """Inner ends where the mode changes."""
        return 1 + np.flatnonzero(np.diff(self.modes))

    def halved(self, which, values):
        """Some domains cut in two, the polynomials as they were."""
        cut = 0.5 * (self.edges[:-1] + self.edges[1:])[which]
        fine = np.sort(np.concatenate([self.edges, cut]))
        owner = np.repeat(np.arange(len(values)), 1 + which)
        mesh = Mesh(fine, self.modes[owner])
        start, width = self.edges[owner], np.diff(self.edges)[owner]
        place = 2.0 * (mesh.times() - start[:, None]) / width[:, None] - 1.0
        weights = np.polynomial.chebyshev.chebvander(place, DEGREE) @ _to_coefficients
        return mesh, np.einsum("dkj,djc->dkc", weights, values[owner])

    def moved(self, n, values, slopes):
        """Corners at the zero of the switch, the ends between them carried along; and how far they moved."""
        at = self.corners()
        shift = -switch(n, values[at, 0]) / switch_rate(n, values[at - 1, -1], slopes[at - 1, -1])
        anchors = np.concatenate([[self.edges[0]], self.edges[at], [self.edges[-1]]])
        room = 0.3 * np.minimum(np.diff(anchors)[:-1], np.diff(anchors)[1:])
        shift = np.clip(shift, -room, room)
        shifts = np.concatenate([[0.0], shift, [0.0]])
        return Mesh(self.edges + np.interp(self.edges, anchors, shifts), self.modes), np.abs(shift).max(
            initial=0
        )


def _newton_step(n, mesh, values):
    """The Newton correction of the periodic system, and the slopes."""
    size, domains = n.size, len(values)
    half, t = 0.5 * np.diff(mesh.edges)[:, None, None], mesh.times()
    slope, _ = rates(n, mesh.modes, t, values)
    jacobian = np.empty((*values.shape, size))
    for c in range(size):
        moved = values.astype(complex)
        moved[..., c] += 1e-30j
        jacobian[..., c] = rates(n, mesh.modes, t, moved)[0].imag / 1e-30
    path = values[:, :1] + half * np.einsum("kj,djc->dkc", _integrals, slope) - values
    own, per_start = np.empty_like(values), np.empty((*values.shape, size))
    own[:, 0], per_start[:, 0] = 0.0, np.eye(size)
    for first in range(0, domains, BATCH):
        part = slice(first, first + BATCH)
        wave = half[part, ..., None, None] * np.einsum("kj,djce->dkcje", _integrals, jacobian[part])
        count = len(wave)
        left = np.eye(size * DEGREE) - wave[:, 1:, :, 1:].reshape(count, size * DEGREE, -1)
        start = np.tile(np.eye(size), (DEGREE, 1)) + wave[:, 1:, :, 0].reshape(count, -1, size)
        both = np.concatenate([path[part, 1:].reshape(count, -1, 1), start], axis=2)
        answer = np.linalg.solve(left, both).reshape(count, DEGREE, size, size + 1)
        own[part, 1:], per_start[part, 1:] = answer[..., 0], answer[..., 1:]
    jump = np.concatenate([values[1:, 0], values[:1, 0]]) - values[:, -1]
    offset, matrix = np.zeros(size), np.eye(size)
    for d in range(domains):
        offset = per_start[d, -1] @ offset + own[d, -1] - jump[d]
        matrix = per_start[d, -1] @ matrix
    first = np.linalg.solve(np.eye(size) - matrix, offset)
    change = np.empty_like(values)
    for d in range(domains):
        change[d] = own[d] + per_start[d] @ first
        first = change[d, -1] - jump[d]
    return change, slope


def _newton(n, mesh, values, within):
    """Newton's method in the state, the corners moved along with it. Scaled change at the end below ``within``."""
    scale, last = n.scales(), np.inf
    for _ in range(60):
        change, _ = _newton_step(n, mesh, values)
        values = values + change
        size = np.abs(change / scale).max()
        slope, _ = rates(n, mesh.modes, mesh.times(), values)
        shift = 0.0
        if size < 1e-3 and len(mesh.corners()):
            mesh, shift = mesh.moved(n, values, slope)
        now = max(size, shift / n.period)
        if now < within or (now < 1e-11 and now > 0.5 * last):
            return mesh, values
        if not np.isfinite(now):
            break
        last = now
    raise ArithmeticError(f"Newton's method does not converge: {now:.1e}, {n}")


def _tails(n, values):
    """Size of the last coefficients of the scaled state [domains]."""
    return np.abs(np.einsum("ck,dke->dce", _to_coefficients[-3:], values / n.scales())).max(axis=(1, 2))


def _guess(n, track):
    """A mesh and values from the steps of an orbit: (t, mode, state) at the start of each."""
    t, modes, states = track[:, 0], track[:, 1], track[:, 2:]
    turns = t[1 + np.flatnonzero(np.diff(modes))]
    ends = np.concatenate([[0.0], turns, [n.period]])
    edges = [np.array([0.0])]
    for start, end in itertools.pairwise(ends):
        steps = t[(t > start) & (t < end)]
        layer = 20.0 * float(np.median(np.diff(steps))) if len(steps) > 2 else end - start
        inner = start + (end - start) * np.linspace(0.0, 1.0, 9)[1:]
        near = start + layer * 2.0 ** np.arange(12)
        edges.append(np.sort(np.concatenate([inner, near[near < inner[0]]])))
    edges = np.concatenate(edges)
    middle = 0.5 * (edges[:-1] + edges[1:])
    mesh = Mesh(edges, modes[np.searchsorted(t, middle, side="right") - 1])
    times = mesh.times()
    t, states = np.append(t, n.period), np.vstack([states, states[0]])
    return mesh, np.stack([np.interp(times, t, states[:, c]) for c in range(n.size)], axis=-1)


class Found(NamedTuple):
    """The mean friction coefficient along x1, how it moved when all domains were halved, and the state at tau = 0.

    track: time, mode and state of every node but the last of each domain.
    """

    mean: float
    change: float
    state: np.ndarray
    track: np.ndarray


def solve(n, track, within=1e-13):
    """The orbit near the one that was tracked. Raises ArithmeticError where Newton's method does not converge."""
    mesh, values = _guess(n, track)
    aim = 1e-6
    while True:
        mesh, values = _newton(n, mesh, values, max(1e-13, 1e-2 * aim))
        poor = _tails(n, values) > aim
        if len(values) > MOST_DOMAINS:
            raise ArithmeticError(f"more than {MOST_DOMAINS} domains: {n}")
        if poor.any():
            mesh, values = mesh.halved(poor, values)
        elif aim > within:
            aim = within
        else:
            break
    if np.any((mesh.modes[:, None] * switch(n, values))[:, 1:-1] < 0.0) and (n.elastic or not n.planar):
        raise ArithmeticError(f"the orbit has other corners than the guess: {n}")
    mean = _mean(n, mesh, values)
    mesh, values = mesh.halved(np.ones(len(values), bool), values)
    mesh, values = _newton(n, mesh, values, 1e-13)
    finer = _mean(n, mesh, values)
    times, modes = mesh.times()[:, :-1, None], np.repeat(mesh.modes, DEGREE)[:, None]
    track = np.hstack([times.reshape(-1, 1), modes, values[:, :-1].reshape(-1, n.size)])
    return Found(finer, abs(finer - mean), values[0, 0], track)


def _mean(n, mesh, values):
    rub = rates(n, mesh.modes, mesh.times(), values)[1]
    return -(0.5 * np.diff(mesh.edges) @ (rub @ _integrals[-1])) / n.period
