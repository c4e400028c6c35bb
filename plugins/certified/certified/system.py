"""Equations that the events of a periodic orbit obey, and their solution enclosed by Krawczyk's test.

A node is where one leg ends and the next begins. Unknown are its time and position (its velocity is the belt's), or,
at a corner of the forces, whose time is known, its position, and its velocity where the mass slides there.

Sources: Krawczyk (1969); Rump (2010).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from flint import arb, arb_mat, ctx

from certified.forces import Forces
from certified.motion import (
    Mechanics,
    NotProved,
    PieceTime,
    forced_motion,
    free_flow,
    integral,
    net_course,
    stretches,
    values_at,
)

ENLARGED = 12
"""Times a box is tried again, larger."""
REFINEMENTS = 12
SPARE_BITS = 16
"""Bits that rounding may take: of the last correction of a refinement, and of the radius of a box."""


class Event(NamedTuple):
    """Start of a leg: its sign of slip, 0 in stick, and when.

    piece: that holds from the node on. fixed: whether it is at the piece's start, so that its time is known. slides:
    whether it is reached in slip whose velocity is not zero.
    """

    sign: int
    piece: int
    fixed: bool
    slides: bool


class EventState(NamedTuple):
    """Time in its lap, position and velocity of a node."""

    tau: Any
    x: Any
    v: Any


def widths(nodes: tuple[Event, ...]) -> list[int]:
    """Return how many unknowns each node has."""
    return [1 + node.slides if node.fixed else 2 for node in nodes]


def event_states(
    mechanics: Mechanics, nodes: tuple[Event, ...], unknowns: list[Any]
) -> tuple[EventState, ...]:
    """Return the state of every node."""
    found, at = [], 0
    for node in nodes:
        piece = mechanics.forces.pieces[node.piece]
        tau, first = (piece.start, at) if node.fixed else (unknowns[at], at + 1)
        x = unknowns[first]
        v = unknowns[first + 1] if node.slides else _before(mechanics.forces, node, tau)
        found.append(EventState(tau, x, v))
        at = first + 1 + node.slides
    return tuple(found)


def _before(forces: Forces, node: Event, tau: Any) -> Any:
    """Return the belt's velocity just before a node."""
    if not node.fixed:
        piece = forces.pieces[node.piece]
        return values_at(piece.belt, piece.start, tau).value
    piece = forces.pieces[node.piece - 1]
    return values_at(piece.belt, piece.start, piece.stop).value


class OrbitLeg(NamedTuple):
    """Leg from one node to the next, with their places among the unknowns."""

    node: Event
    after: Event
    start: EventState
    stop: EventState
    laps: int


def legs(nodes: tuple[Event, ...], states: tuple[EventState, ...]) -> list[OrbitLeg]:
    """Return every leg of a period."""
    found = []
    for i, node in enumerate(nodes):
        j = (i + 1) % len(nodes)
        found.append(OrbitLeg(node, nodes[j], states[i], states[j], int(j == 0)))
    return found


def last_piece(forces: Forces, leg: OrbitLeg) -> tuple[int, int]:
    """Return the piece in which a leg ends and the laps to it: before a corner, not after it."""
    if not leg.after.fixed:
        return leg.after.piece, leg.laps
    if leg.after.piece > 0:
        return leg.after.piece - 1, leg.laps
    return len(forces.pieces) - 1, leg.laps - 1


def leg_parts(forces: Forces, leg: OrbitLeg) -> list[Any]:
    """Return the leg in its pieces: the piece, and when the leg is in it."""
    piece, laps = last_piece(forces, leg)
    stop = leg.stop.tau if not leg.after.fixed else forces.pieces[piece].stop
    start = PieceTime(leg.start.tau, leg.node.piece)
    return list(stretches(forces, start, PieceTime(stop, piece), laps))


class Slope(NamedTuple):
    """Residuals of a leg's two equations (the second None where there is but one), and their derivatives.

    by_start, by_stop: pairs of rows by (tau, x, v) of the node.
    """

    residuals: list[Any]
    by_start: list[tuple[Any, Any, Any]]
    by_stop: list[tuple[Any, Any, Any]]


def slip_equations(mechanics: Mechanics, leg: OrbitLeg) -> Slope:
    """Return the equations of slip: the flow from the first node ends at the second."""
    x, v, total, begins = leg.start.x, leg.start.v, arb(0), None
    for piece, low, high in leg_parts(mechanics.forces, leg):
        forced = forced_motion(net_course(mechanics, piece, leg.node.sign), mechanics.b)
        first, last = values_at(forced, piece.start, low), values_at(forced, piece.start, high)
        here = high - low
        free = free_flow(mechanics.b, here)
        if begins is None:
            begins = first.bend - 2 * mechanics.b * (v - first.rate) - (x - first.value)
        u, u1 = x - first.value, v - first.rate
        x = last.value + free.keep * u + free.turn * u1
        v = last.rate + free.damp * u1 - free.turn * u
        ends = last.bend - 2 * mechanics.b * (v - last.rate) - (x - last.value)
        total = total + here
    free = free_flow(mechanics.b, total)
    by_start = [
        (-(free.keep * leg.start.v + free.turn * begins), free.keep, free.turn),
        (-(free.damp * begins - free.turn * leg.start.v), -free.turn, free.damp),
    ]
    by_stop = [(v, arb(-1), arb(0)), (ends, arb(0), arb(-1))]
    return Slope([x - leg.stop.x, v - leg.stop.v], by_start, by_stop)


def stick_equations(mechanics: Mechanics, leg: OrbitLeg) -> Slope:
    """Return the equations of stick: the mass goes with the belt, until friction is at its limit."""
    carried = leg.start.x
    for piece, low, high in leg_parts(mechanics.forces, leg):
        carried = carried + integral(piece.belt, piece.start, low, high)
    residuals = [carried - leg.stop.x]
    by_start, by_stop = [(-leg.start.v, arb(1), arb(0))], [(leg.stop.v, arb(-1), arb(0))]
    if not leg.after.fixed:
        piece = mechanics.forces.pieces[leg.after.piece]
        load, belt, pressed = (
            values_at(each, piece.start, leg.stop.tau) for each in (piece.load, piece.belt, piece.normal_load)
        )
        limit = leg.after.sign * mechanics.mu
        residuals.append(
            load.value - 2 * mechanics.b * belt.value - leg.stop.x - belt.rate - limit * pressed.value
        )
        by_start.append((arb(0), arb(0), arb(0)))
        rate = load.rate - 2 * mechanics.b * belt.rate - belt.bend - limit * pressed.rate
        by_stop.append((rate, arb(-1), arb(0)))
    return Slope(residuals, by_start, by_stop)


def system(mechanics: Mechanics, nodes: tuple[Event, ...], unknowns: list[Any]) -> tuple[arb_mat, arb_mat]:
    """Return the residuals [n, 1] and their derivatives [n, n] by the unknowns."""
    states = event_states(mechanics, nodes, unknowns)
    count = widths(nodes)
    places = np.concatenate([[0], np.cumsum(count)]).tolist()
    size, row = places[-1], 0
    residuals, rows = [], [[arb(0)] * size for _ in range(size)]
    for i, leg in enumerate(legs(nodes, states)):
        found = (slip_equations if leg.node.sign else stick_equations)(mechanics, leg)
        j = (i + 1) % len(nodes)
        for k, residual in enumerate(found.residuals):
            residuals.append([residual])
            for place, node, state, slope in (
                (places[i], leg.node, leg.start, found.by_start[k]),
                (places[j], leg.after, leg.stop, found.by_stop[k]),
            ):
                for offset, derivative in enumerate(_by_unknowns(mechanics, node, state, slope)):
                    rows[row][place + offset] = rows[row][place + offset] + derivative
            row += 1
    if row != size:
        raise NotProved(f"{row} equations for {size} unknowns")
    return arb_mat(residuals), arb_mat(rows)


def _by_unknowns(
    mechanics: Mechanics, node: Event, state: EventState, slope: tuple[Any, Any, Any]
) -> list[Any]:
    """Return the derivatives by the unknowns of a node from those by (tau, x, v)."""
    tau, x, v = slope
    if node.fixed:
        return [x, v] if node.slides else [x]
    piece = mechanics.forces.pieces[node.piece]
    return [tau + v * values_at(piece.belt, piece.start, state.tau).rate, x]


def enclose(mechanics: Mechanics, nodes: tuple[Event, ...], guess: list[float]) -> list[Any]:
    """Return a box that holds exactly one solution, by Krawczyk's test. Raises NotProved."""
    middle, least = [arb(each) for each in guess], arb(2) ** (SPARE_BITS - ctx.prec)
    for _ in range(REFINEMENTS):
        residuals, slopes = system(mechanics, nodes, middle)
        step = _column(_inverse(slopes) * residuals)
        middle = [(each - off).mid() for each, off in zip(middle, step, strict=True)]
        if all(abs(off) < least * (1 + abs(each)) for each, off in zip(middle, step, strict=True)):
            break
    residuals, slopes = system(mechanics, nodes, middle)
    inverse = _inverse(slopes)
    step = _column(inverse * residuals)
    radius = [
        4 * abs(off).upper() + least * (1 + abs(each)).upper() for off, each in zip(step, middle, strict=True)
    ]
    for _ in range(ENLARGED):
        box = [each + arb(0, wide.upper()) for each, wide in zip(middle, radius, strict=True)]
        image = _krawczyk(mechanics, nodes, middle, box, inverse, step)
        if all(a.contains_interior(b) for a, b in zip(box, image, strict=True)):
            return image
        radius = [8 * wide for wide in radius]
    raise NotProved("Krawczyk's test leaves open whether the events have a solution near")


def _krawczyk(
    mechanics: Mechanics,
    nodes: tuple[Event, ...],
    middle: list[Any],
    box: list[Any],
    inverse: arb_mat,
    step: list[Any],
) -> list[Any]:
    """Return the image of a box: where it lies inside, it holds exactly one solution, and so does the image."""
    size = len(middle)
    identity = arb_mat([[int(i == k) for k in range(size)] for i in range(size)])
    reach = arb_mat([[wide - each] for wide, each in zip(box, middle, strict=True)])
    spread = _column((identity - inverse * system(mechanics, nodes, box)[1]) * reach)
    return [each - off + wide for each, off, wide in zip(middle, step, spread, strict=True)]


def _column(matrix: arb_mat) -> list[Any]:
    return [each[0] for each in matrix.tolist()]


def _inverse(slopes: arb_mat) -> arb_mat:
    """Return the inverse of the midpoint."""
    try:
        return slopes.mid().inv().mid()
    except ZeroDivisionError:
        raise NotProved("the derivative of the events is singular") from None
