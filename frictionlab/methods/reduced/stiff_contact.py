"""What the deflection of a stiff contact may change in the mean friction of Coulomb's motion along a line.

A bristle law of one sliding friction mu whose friction mu lambda, |lambda| <= 1, follows from the path slid: the true
motion x, lambda and Coulomb's x_C, lambda_C under the same loads differ by e = x - x_C,

    e'' + 2 b e' + e = -f (lambda - lambda_C),        f = mu N.

Multiplied by e' = w - w_C and averaged over a period (<>), with |w_C| = lambda_C w_C:

    <|w| - lambda_C w> + <|w_C| |lambda - lambda_C|> + (2 b/f) <e'^2> = <|w| - lambda w> = G,

no term on the left negative. Over a leg of slip |w| - lambda w adds up to at most ``lost_on_reversal``, whatever the
speed: G is known once the legs of a period are counted. They are taken to be those of Coulomb's motion, at least two,
and two more for every rest, in which bristles swing before they hold: an assumption, for which the bound is
``estimated``.

So where Coulomb's motion slips, lambda - lambda_C has the sign of -w_C, is at most 2 and lies where |w_C| is small:
the mean of either sign is at most that over the level set of |w_C| for which the mean of 2 |w_C| is G, and near a
reversal, w_C = a t, of size sqrt(G/a). (Any theta >= 0 gives the bound theta G + <2 (1 - theta |w_C|)_+>.)

In rest w_C = 0 says nothing of lambda. The same with a weight phi that vanishes there, phi'' - 2 b phi' + phi = <phi>
in slip, phi = 0 at its start, and a slope there such that phi' - 2 b phi goes through rests unchanged but for <phi>
times their length: the terms of e' in slip cancel, and

    <phi> <lambda - lambda_C> = <phi (lambda - lambda_C)>_slip + what happens where phi jumps to 0 as rest begins,

the latter at most 2 |phi| (G/f)^1/2 by the impulse that stops the mass; the deflection in rest adds terms of its own
size. The lesser of both bounds counts.

Dashpots beside the springs add lag lambda' to lambda, lag their damping over stiffness. Their own work only lowers
G; that on Coulomb's slip is lag <(lambda - lambda_C) w_C'> by parts, so that |w_C| counts less by lag max|w_C'|. The
mean of lag lambda' is zero, that of phi lag lambda' at most lag times the change of phi.

Source: this derivation; the energy of a difference as Leine & van de Wouw (2008).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner, njit
from frictionlab.orbit.panels import BARYCENTRIC, NODES
from frictionlab.quantities import Floats

NEAR_ENDS: Floats = np.array([1e-3, 4e-3, 1.5e-2])
"""Where a panel is looked at beside its nodes, from its ends: reversals lie there."""
LOOKED_AT: Floats = np.sort(np.concatenate([NODES, NEAR_ENDS - 1.0, 1.0 - NEAR_ENDS]))
LEAST_SLACK = 1e-3
"""Least share of friction that is taken to hold the mass as rest begins."""
THETAS = 4
"""Values of theta tried: the bound holds for every one, and is within some percent of the least after so many."""
FASTEST = 30.0
"""Growth, as a power of e, of a weight above which it is of no use."""


def _weights_at(points: Floats) -> Floats:
    """Of the nodes for the panel polynomial at these points [points, nodes]."""
    gaps: Floats = points[:, None] - NODES[None, :]
    at_node = np.isin(points, NODES)[:, None]
    parts = np.where(at_node, gaps == 0.0, BARYCENTRIC / np.where(gaps == 0.0, 1.0, gaps))
    return np.asarray(parts / parts.sum(axis=1)[:, None])


AT_POINTS = _weights_at(LOOKED_AT)
NODE_AT = np.array([int(np.argmin(np.abs(NODES - at))) if at in NODES else -1 for at in LOOKED_AT])
"""The node that a point is, or -1."""


class StiffContact(NamedTuple):
    """A contact beside Coulomb's motion: how far it deflects [scene length], what a reversal loses [scene length],
    damping over stiffness [scene time], friction in sliding [-] and as a force, and the damping 2 b of the mass."""

    deflection: float
    lost_on_reversal: float
    lag: float
    coefficient: float
    friction: float
    damping: float


class Weight(NamedTuple):
    """Solutions of phi'' - 2 b phi' + phi = 1 from phi = phi' = 0, and without the 1 from phi = 0, phi' = 1."""

    forced: float
    free: float
    slope: float


@inner
def weight_after(damping: float, time: float) -> Weight:
    """A time into slip; d forced/d time is free."""
    b = 0.5 * damping
    root = math.sqrt(abs(1.0 - b * b))
    if root * time < 1e-6:
        sine, cosine = time, 1.0
    elif b < 1.0:
        sine, cosine = math.sin(root * time) / root, math.cos(root * time)
    else:
        sine, cosine = math.sinh(root * time) / root, math.cosh(root * time)
    growth = math.exp(b * time)
    free = growth * sine
    return Weight(1.0 - growth * cosine + b * free, free, growth * cosine + b * free)


@inner
def count_legs(orbit: Any, belt_speed: float) -> int:
    """Legs of slip of a period, at least two, and two for every rest."""
    legs = 0
    for panel in range(orbit.tau.shape[0]):
        leg = leg_of(orbit, panel, belt_speed)
        if leg != leg_of(orbit, panel - 1, belt_speed):
            legs += 2 if leg == 0.0 else 1
    return max(legs, 2)


@inner
def leg_of(orbit: Any, panel: int, belt_speed: float) -> float:
    """The sign of the slip in a panel; 0 in rest."""
    if orbit.stick[panel]:
        return 0.0
    return 1.0 if orbit.v[panel, NODES.size // 2].real > belt_speed else -1.0


@inner
def slip_at_point(orbit: Any, panel: int, point: int, belt_speed: float) -> float:
    """The slip velocity at a point of a panel."""
    if NODE_AT[point] >= 0:
        return float(orbit.v[panel, NODE_AT[point]].real - belt_speed)
    slip = -belt_speed
    for node in range(NODES.size):
        slip += AT_POINTS[point, node] * orbit.v[panel, node].real
    return slip


@inner
def steepest_slip(orbit: Any) -> float:
    """The largest rate of change of the slip velocity, from node to node."""
    steepest = 0.0
    for panel in range(orbit.tau.shape[0]):
        for node in range(1, NODES.size):
            time = orbit.tau[panel, node] - orbit.tau[panel, node - 1]
            if time > 0.0:
                change = abs(orbit.v[panel, node].real - orbit.v[panel, node - 1].real)
                steepest = max(steepest, change / time)
    return steepest


@inner
def change_of_weight(table: Any, rows: int) -> float:
    """Of |weight| from stretch to stretch and along each, at most."""
    change = 0.0
    for row in range(rows):
        change += abs(table[row, 4] - table[row, 3]) + abs(
            table[row, 3] - table[row - 1 if row > 0 else rows - 1, 4]
        )
    return change


@inner
def start_of_slip(orbit: Any) -> float:
    """When the slip began in which the orbit starts, before its first instant."""
    panels = orbit.tau.shape[0]
    length = orbit.tau[panels - 1, NODES.size - 1] - orbit.tau[0, 0]
    start = orbit.tau[0, 0]
    for panel in range(panels):
        if not orbit.stick[panel] and orbit.stick[panel - 1]:
            start = orbit.tau[panel, 0] - length
    return float(start)


@inner
def tabulate(orbit: Any, belt_speed: float, weighed: bool, slopes: Any, contact: Any, table: Any) -> int:
    """Write every stretch of the orbit between points to rows: duration, speed and weight at both ends, and a sign.

    The sign is that of slip times weight, 0 in rest. Weighed: by |phi|, slopes [panels] being that of phi at the
    start of the slip that the panel lies in, and nothing where the mass rests; else by 1.
    """
    panels, row, start = orbit.tau.shape[0], 0, start_of_slip(orbit)
    slower = contact.lag * steepest_slip(orbit)
    for panel in range(panels):
        leg = leg_of(orbit, panel, belt_speed)
        if weighed and leg == 0.0:
            continue
        if leg != 0.0 and orbit.stick[panel - 1]:
            start = orbit.tau[panel, 0]
        turned = leg != leg_of(orbit, panel - 1, belt_speed)
        turns = leg != leg_of(orbit, (panel + 1) % panels, belt_speed)
        first, length = orbit.tau[panel, 0], orbit.tau[panel, NODES.size - 1] - orbit.tau[panel, 0]
        at, speed, weight = -1.0, 0.0, 0.0
        for point in range(LOOKED_AT.size):
            if NODE_AT[point] < 0 and not (turned if LOOKED_AT[point] < 0.0 else turns):
                continue
            here = 0.0
            if leg != 0.0:
                here = max(0.0, abs(slip_at_point(orbit, panel, point, belt_speed)) - slower)
            phi = 1.0
            if weighed:
                own = weight_after(contact.damping, first + 0.5 * (1.0 + LOOKED_AT[point]) * length - start)
                phi = own.forced + slopes[panel] * own.free
            if point > 0:
                table[row, 0] = 0.5 * (LOOKED_AT[point] - at) * length
                table[row, 1], table[row, 2] = speed, here
                table[row, 3], table[row, 4] = abs(weight), abs(phi)
                table[row, 5] = leg if weight + phi > 0.0 else -leg
                row += 1
            at, speed, weight = LOOKED_AT[point], here, phi
    return row


@inner
def share_above(a: float, b: float) -> float:
    """The share of a line from a to b that is positive."""
    if a > 0.0 and b > 0.0:
        return 1.0
    if a > 0.0:
        return a / (a - b)
    return b / (b - a) if b > 0.0 else 0.0


@inner
def over_level_set(table: Any, rows: int, side: float, theta: float) -> tuple[float, float]:
    """The integral of 2 (weight - theta |w|)_+ over stretches of this sign and over rest, and of 2 |w| there."""
    total, slid = 0.0, 0.0
    for row in range(rows):
        if table[row, 5] != -side:
            a = table[row, 3] - theta * table[row, 1]
            b = table[row, 4] - theta * table[row, 2]
            share = share_above(a, b)
            if share > 0.0:
                part = share * table[row, 0]
                within = table[row, 1] if a > b else table[row, 2]  # where the line is highest
                total += part * max(a, b) if share < 1.0 else part * (a + b)
                slid += part * (2.0 * within + share * abs(table[row, 2] - table[row, 1]))
    return total, slid


@inner
def bound_by_level_set(table: Any, rows: int, lost: float) -> float:
    """The larger of both sides: where slip is forward the difference of friction is negative, else positive."""
    longest, fastest = 0.0, 0.0
    for row in range(rows):
        longest, fastest = longest + table[row, 0], max(fastest, table[row, 2])
    bound = 0.0
    for side in (-1.0, 1.0):
        best, theta = math.inf, math.sqrt(longest / (lost * fastest)) if fastest > 0.0 else 0.0
        for _ in range(
            THETAS
        ):  # the sum is least where its slope is 0, and the second term falls about as 1/theta
            over, slid = over_level_set(table, rows, side, theta)
            best = min(best, theta * lost + over)
            theta *= math.sqrt(slid / lost)
        bound = max(bound, best)
    return bound


@inner
def add_rests(orbit: Any, contact: Any, lost: float, slopes: Any) -> float:
    """Write the slope of phi at the start of every slip; return what rests add to the bound, infinite for none."""
    panels, last = orbit.tau.shape[0], NODES.size - 1
    first = -1
    for panel in range(panels):
        if not orbit.stick[panel] and orbit.stick[panel - 1]:
            first = panel
    if first < 0:
        return math.inf
    whole, turned, slope, added = 0.0, 1.0, 0.0, 0.0
    # twice round: the slope that returns to itself follows from where the first round takes slope 0
    for lap in range(2):
        if lap == 1:
            if not abs(1.0 - turned) > 1e-9:
                return math.inf
            slope = whole / (1.0 - turned)
        slip, rest, begin = 0.0, 0.0, first
        for step in range(panels):
            panel = (first + step) % panels
            duration = orbit.tau[panel, last] - orbit.tau[panel, 0]
            if orbit.stick[panel]:
                rest += duration
            else:
                slip += duration
            slopes[panel] = slope
            if orbit.stick[panel] and not orbit.stick[(panel + 1) % panels]:
                if 0.5 * contact.damping * slip > FASTEST:
                    return math.inf
                phi = weight_after(contact.damping, slip)
                gained = rest + phi.free - contact.damping * phi.forced
                kept = phi.slope - contact.damping * phi.free
                if lap == 0:
                    whole, turned = gained + kept * whole, kept * turned
                else:
                    end, following = phi.forced + slope * phi.free, gained + kept * slope
                    added += held(orbit, contact, begin, lost, end)
                    added += (
                        4.0
                        * contact.deflection
                        * (abs(following) + abs(rest - following) + rest)
                        / contact.friction
                    )
                    slope = following
                slip, rest, begin = 0.0, 0.0, (panel + 1) % panels
    return added


@inner
def held(orbit: Any, contact: Any, first: int, lost: float, weight: float) -> float:
    """What the stop at the end of the slip that starts with panel ``first`` adds to the bound, for phi there."""
    panels, panel = orbit.tau.shape[0], first
    while not orbit.stick[panel]:
        panel = (panel + 1) % panels
    share = abs(orbit.friction[panel, 0].real) / contact.coefficient
    return 2.0 * abs(weight) * math.sqrt(lost / (contact.friction * max(LEAST_SLACK, 1.0 - share)))


@njit
def bound_each(contact: StiffContact, orbits: Any, ends: Any, belt_speeds: Any, out: Any) -> None:
    """Write the bound on the change of the mean friction coefficient at every belt speed that has an orbit."""
    begin = 0
    for i in range(belt_speeds.size):
        if ends[i] > begin:
            out[i] = contact.coefficient * bound_one(contact, part_of(orbits, begin, ends[i]), belt_speeds[i])
        begin = ends[i]


class CoulombOrbit(NamedTuple):
    """One orbit's panels [panels, nodes], and whether each is at rest."""

    tau: Any
    v: Any
    friction: Any
    stick: Any


@inner
def part_of(orbits: CoulombOrbit, begin: int, end: int) -> CoulombOrbit:
    """The panels of one orbit."""
    return CoulombOrbit(
        orbits.tau[begin:end], orbits.v[begin:end], orbits.friction[begin:end], orbits.stick[begin:end]
    )


@inner
def bound_one(contact: StiffContact, orbit: CoulombOrbit, belt_speed: float) -> float:
    """Of the mean of lambda, by the better weight."""
    panels, last = orbit.tau.shape[0], NODES.size - 1
    length = orbit.tau[panels - 1, last] - orbit.tau[0, 0]
    lost = contact.lost_on_reversal * count_legs(orbit, belt_speed)
    table, slopes = np.empty((panels * (LOOKED_AT.size - 1), 6)), np.zeros(panels)
    rows = tabulate(orbit, belt_speed, False, slopes, contact, table)
    found = bound_by_level_set(table, rows, lost)
    added = add_rests(orbit, contact, lost, slopes)
    if added < found:
        rows = tabulate(orbit, belt_speed, True, slopes, contact, table)
        weighed = bound_by_level_set(table, rows, lost) + contact.lag * change_of_weight(table, rows)
        found = min(found, added + weighed)
    return found / length
