"""The nodes of an orbit that was found in floating-point numbers, as a first guess of those to be enclosed."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.methods.exact.proof.forces import Forces
from frictionlab.methods.exact.proof.motion import values_at
from frictionlab.methods.exact.proof.system import Event
from frictionlab.orbit.record import Orbit

SHORTEST_LEG = 1e-13
"""Of a period: legs shorter than this are dropped."""
AT_CORNER = 1e-12
"""Of a period: how near to a corner an event may be taken for one that the corner makes."""


class LegStart(NamedTuple):
    """Where a leg begins: its sign of slip, 0 in stick, time, position and velocity."""

    sign: int
    tau: float
    x: float
    v: float


def starts_of(orbit: Orbit, period: float) -> list[LegStart]:
    """The starts of the legs of an orbit that begins at time 0, in the order of time."""
    middle = orbit.tau.shape[1] // 2
    assert orbit.stick is not None
    signs = np.where(orbit.stick, 0, np.sign(orbit.friction[:, middle].real)).astype(int).tolist()
    ends = zip(orbit.tau[:, 0], orbit.tau[:, -1], orbit.x[:, 0].real, orbit.v[:, 0].real, strict=True)
    found: list[LegStart] = []
    for sign, (tau, stop, x, v) in zip(signs, ends, strict=True):
        if stop - tau > SHORTEST_LEG * period and not (found and found[-1].sign == sign):
            found.append(LegStart(sign, float(tau), float(x), float(v)))
    if len(found) > 1 and found[0].sign == found[-1].sign:
        del found[0]  # the last leg goes on into the next period
    return found


def nodes_of(forces: Forces, starts: list[LegStart]) -> tuple[tuple[Event, ...], list[float]]:
    """Nodes and guesses of their unknowns. Raises NotProved."""
    if (
        len(starts) == 1
    ):  # slip that never reverses: any corner, or any time, will do as the start of its one leg
        return (Event(starts[0].sign, 0, True, True),), [starts[0].x, starts[0].v]
    period, first = float(forces.period.mid()), float(forces.pieces[0].start.mid())
    corners = np.array([float(piece.start.mid()) for piece in forces.pieces])
    found = []
    for i, one in enumerate(starts):
        before, tau = starts[i - 1].sign, first + (one.tau - first) % period
        if first + period - tau < AT_CORNER * period:  # at the first corner, a period on
            tau -= period
        near = int(np.argmin(np.abs(corners - tau)))
        at_corner = not forces.smooth and abs(corners[near] - tau) < AT_CORNER * period
        slides = bool(at_corner and before and forces.pieces[near].belt_jumps and _slides(forces, near, one))
        fixed = slides or (at_corner and before == 0)
        piece = near if fixed else max(int(np.searchsorted(corners, tau, side="right")) - 1, 0)
        found.append((float(corners[near]) if fixed else tau, Event(one.sign, piece, fixed, slides), one))
    nodes, guess = [], []
    for tau, node, one in sorted(found, key=lambda each: each[0]):
        nodes.append(node)
        guess += [] if node.fixed else [tau]
        guess += [one.x, one.v] if node.slides else [one.x]
    return tuple(nodes), guess


def _slides(forces: Forces, place: int, one: LegStart) -> bool:
    """Whether the mass slides just before this corner."""
    piece = forces.pieces[place - 1]
    belt: Any = values_at(piece.belt, piece.start, piece.stop).value
    return abs(one.v - float(belt.mid())) > 1e-9 * (abs(one.v) + 1e-300)
