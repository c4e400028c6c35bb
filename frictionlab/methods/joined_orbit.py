"""The orbit of a mass whose motions along the belt and across it are known one by one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from frictionlab.methods.base import Floats, Orbit
from frictionlab.orbit import NODES, interpolation_weights

Complexes = NDArray[np.complex128]


def joined(along: Orbit, across: Orbit) -> Orbit:
    """Both motions on panels that reach over no edge of either's."""
    end = along.tau[-1, -1]
    edges = np.unique(np.concatenate([along.tau[:, 0], across.tau[:, 0]]))
    edges = edges[(np.diff(edges, append=end) > 1e-12 * end)]
    half = 0.5 * np.diff(edges, append=end)[:, None]
    tau: Floats = edges[:, None] + half * (1.0 + NODES)
    first, second = _on(along, tau), _on(across, tau)
    x, v, friction = (one.real + 1j * other.real for one, other in zip(first, second, strict=True))
    return Orbit(tau, x, v, friction, np.zeros(len(tau), np.bool_))


def _on(orbit: Orbit, tau: Floats) -> list[Complexes]:
    """Position, velocity and friction on panels, each inside one of the orbit's."""
    inside = np.searchsorted(orbit.tau[:, 0], 0.5 * (tau[:, 0] + tau[:, -1]), side="right") - 1
    start, end = orbit.tau[inside, :1], orbit.tau[inside, -1:]
    weights = interpolation_weights(((2.0 * tau - start - end) / (end - start)).ravel())
    weights = weights.reshape(*tau.shape, len(NODES))
    return [(weights * part[inside, None, :]).sum(axis=2) for part in (orbit.x, orbit.v, orbit.friction)]
