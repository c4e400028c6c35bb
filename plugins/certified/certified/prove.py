"""Proof of the mean friction of a periodic orbit: it exists (Krawczyk's test), and its legs have the right signs.

With damping and under constant friction a scene whose mass must slip has one periodic motion (theory/uniqueness): an
orbit that is proved to exist has the mean of every motion in the long run.

Nodes of an orbit that was found in floating-point numbers are a first guess of those to be enclosed. Next to the
onset of a leg rounding may find the orbit with it or without it: what the proof found wrong says which.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from flint import arb, ctx

import frictionlab as fl
from certified.forces import Forces, forces_of
from certified.motion import Mechanics, NotProved, double_integral, integral, values_at
from certified.signs import NoReversal, NoStick, Wrong, check_signs
from certified.system import Event, EventState, enclose, event_states, leg_parts, legs

SHORTEST_LEG = 1e-13
"""Share of a period: legs shorter than this are dropped."""
AT_CORNER = 1e-12
"""Share of a period: how near to a corner an event may be taken for one that the corner makes."""


class LegStart(NamedTuple):
    """Start of a leg: its sign of slip, 0 in stick, time, position and velocity."""

    sign: int
    tau: float
    x: float
    v: float


def starts_of(orbit: fl.Orbit, period: float) -> list[LegStart]:
    """Return the starts of the legs of an orbit that begins at time 0, in the order of time."""
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
    """Return nodes and guesses of their unknowns. Raises NotProved."""
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
    """Check whether the mass slides just before this corner."""
    piece = forces.pieces[place - 1]
    belt: Any = values_at(piece.belt, piece.start, piece.stop).value
    return abs(one.v - float(belt.mid())) > 1e-9 * (abs(one.v) + 1e-300)


def repaired(starts: list[LegStart], period: float, problem: NotProved) -> list[LegStart]:
    """Return the legs in the order of time, mended. Raises the problem where it is not known how."""
    if isinstance(problem, NoReversal):
        return _inserted(starts, problem.leg, [starts[problem.leg]._replace(sign=0)])
    if isinstance(problem, NoStick):
        return _with_a_reversal(starts, problem)
    if isinstance(problem, Wrong):
        return _with_a_leg(starts, problem)
    return _without_the_shortest(starts, period, problem)


def _inserted(starts: list[LegStart], place: int, new: list[LegStart]) -> list[LegStart]:
    """Return the legs with new ones before that at this place."""
    return _joined([*starts[:place], *new, *starts[place:]])


def _with_a_reversal(starts: list[LegStart], problem: NoStick) -> list[LegStart]:
    """Return the legs with slip where stick was to begin: all the while, or until friction holds the mass."""
    wrong = starts[problem.leg]
    reversed_, rest = wrong._replace(sign=problem.side), starts[problem.leg + 1 :]
    excess, bend, _x = problem.beyond
    if bend > 0.0:
        length = 2.0 * excess / bend
        rest = [wrong._replace(tau=wrong.tau + length), *rest]
    return _joined([*starts[: problem.leg], reversed_, *rest])


def _with_a_leg(starts: list[LegStart], problem: Wrong) -> list[LegStart]:
    """Return the legs with a short stick where slip comes to rest, a short slip where stick exceeds the limit."""
    excess, bend, x = problem.beyond
    if not (excess > 0.0 and bend > 0.0):
        raise problem
    leg = starts[problem.leg]
    tau, half = leg.tau + problem.after, math.sqrt(2.0 * excess / bend)
    first, last = (tau - half, tau) if leg.sign else (tau - half, tau + 2.0 * half)
    inside = 0 if leg.sign else problem.side
    new = [LegStart(inside, first, x, leg.v), LegStart(leg.sign, last, x, leg.v)]
    return _inserted(starts, problem.leg + 1, new)


def _without_the_shortest(starts: list[LegStart], period: float, problem: NotProved) -> list[LegStart]:
    if len({one.sign for one in starts}) < 2:
        raise problem
    lengths = [(starts[(i + 1) % len(starts)].tau - one.tau) % period for i, one in enumerate(starts)]
    shortest = min(range(len(starts)), key=lambda i: min(lengths[i], period - lengths[i]))
    kept = _joined([one for i, one in enumerate(starts) if i != shortest])
    if len(kept) == 1 and not kept[0].sign:
        raise problem
    return kept


def _joined(starts: list[LegStart]) -> list[LegStart]:
    """Return the legs with neighbours of the same sign as one."""
    kept = [one for i, one in enumerate(starts) if one.sign != starts[i - 1].sign]
    return kept or starts[:1]


def mean_force(mechanics: Mechanics, nodes: tuple[Event, ...], states: tuple[EventState, ...]) -> Any:
    """Return the mean of the friction force on the mass over a common period [K_1 L]."""
    impulse = arb(0)
    for leg in legs(nodes, states):
        x = leg.start.x
        for piece, low, high in leg_parts(mechanics.forces, leg):
            if leg.node.sign:
                pressed = integral(piece.normal_load, piece.start, low, high)
                impulse = impulse - leg.node.sign * mechanics.mu * pressed
                continue
            # friction carries the mass along: B' + 2 b B + x - F
            travel = integral(piece.belt, piece.start, low, high)
            gained = (
                values_at(piece.belt, piece.start, high).value - values_at(piece.belt, piece.start, low).value
            )
            stretched = x * (high - low) + double_integral(piece.belt, piece.start, low, high)
            pushed = integral(piece.load, piece.start, low, high)
            impulse = impulse + gained + 2 * mechanics.b * travel + stretched - pushed
            x = x + travel
    return impulse / mechanics.forces.period


BITS, MORE_BITS = 128, 320
"""Bits of numbers; more where a leg is so short that the first leave its sign open."""
ATTEMPTS = 8


class Proved(NamedTuple):
    """Mean friction coefficient and a bound on its error."""

    mean: float
    error: float


def prove(scene: fl.Scene, coefficient: float, orbit: fl.Orbit) -> Proved:
    """Return the mean friction of a scene of one orbit, from that orbit as found in floating-point numbers.

    Raises NotProved with what cannot be proved of it.
    """
    try:
        return _proved(scene, coefficient, orbit, BITS)
    except NotProved:
        return _proved(scene, coefficient, orbit, MORE_BITS)


def _proved(scene: fl.Scene, coefficient: float, orbit: fl.Orbit, bits: int) -> Proved:
    with ctx.workprec(bits):
        mechanics = Mechanics(arb(scene.damping_ratio), arb(coefficient), forces_of(scene))
        period = float(mechanics.forces.period.mid())
        starts, first = starts_of(orbit, period), None
        for _ in range(ATTEMPTS):
            try:
                return _rounded(enclosed_mean(mechanics, starts) / arb(scene.normal_load))
            except Unproved as problem:
                first = first or problem.cause
                starts = repaired(problem.starts, period, problem.cause)
        raise first or NotProved("no orbit is near the one that was found")


class Unproved(Exception):
    """List of legs, in the order of time, and what is wrong with it."""

    def __init__(self, cause: NotProved, starts: list[LegStart]) -> None:
        super().__init__(str(cause))
        self.cause, self.starts = cause, starts


def enclosed_mean(mechanics: Mechanics, starts: list[LegStart]) -> arb:
    """Return the mean friction force [K_1 L] of the orbit with these legs. Raises Unproved."""
    nodes, guess = nodes_of(mechanics.forces, starts)
    states = event_states(mechanics, nodes, [arb(each) for each in guess])
    try:
        states = event_states(mechanics, nodes, enclose(mechanics, nodes, guess))
        check_signs(mechanics, nodes, states)
        return mean_force(mechanics, nodes, states)
    except NotProved as problem:
        raise Unproved(problem, [_start(*each) for each in zip(nodes, states, strict=True)]) from None


def _start(node: Event, state: EventState) -> LegStart:
    return LegStart(node.sign, float(state.tau.mid()), float(state.x.mid()), float(state.v.mid()))


def _rounded(mean: arb) -> Proved:
    middle = float(mean.mid())
    error = abs(mean - arb(middle)).upper()
    return Proved(middle, math.nextafter(float(error), math.inf))
