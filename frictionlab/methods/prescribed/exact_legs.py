"""Closed loop of a bristle law with an exact path under slip along the belt: two legs between reversals.

Slip of velocity speed*(kappa + cos(psi)), 0 <= kappa < 1, goes forward while |psi| < pi - phi and back for the rest,
with cos(phi) = kappa. Along each leg the law gives the deflection exactly at any stiffness; there remain one equation
for the deflection at the start of the forward leg, and quadrature.

Licence: five times as quick as the map by path (.11 ms a point for .55; three contacts of Dahl's at four belt
speeds), with errors of 1e-14 for 1e-11.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner, njit
from frictionlab.motion.contact import resistance
from frictionlab.motion.orbit.recorder import NODES, WEIGHTS
from frictionlab.values.quantities import Floats

POINTS: Floats = 0.5 * (NODES + 1.0)
SHARES: Floats = 0.5 * WEIGHTS
ROOM = 1200
"""Most panels of a leg; grading from the smallest angle that floating point resolves needs a quarter of them."""
CLOSEST = 1e-15
SOFT = 0.1
"""Path [``Legs.length``] below which the change of deflection over a leg is integrated from its rate: as a difference
of two deflections it would lose the digits that determine the loop of a soft contact."""


class Legs(NamedTuple):
    """Two legs: half the angle of the backward one, slip amplitude [length], speed [velocity].

    length: the path on which the deflection changes most rapidly; reach: its largest value [length]. cuts: number of
    parts into which panels are divided.
    """

    turn: float
    amplitude: float
    speed: float
    length: float
    reach: float
    cuts: float


@inner
def _less_sine(angle: float) -> float:
    """angle - sin(angle) to rounding, by its series where the difference would cancel."""
    if angle > 0.6:
        return angle - math.sin(angle)
    # Taylor's series: up to 0.6 its next term is below rounding.
    square = angle * angle
    series = 1.0 - square / 110.0 * (1.0 - square / 156.0 * (1.0 - square / 210.0))
    series = 1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0 * series))
    return angle * square / 6.0 * series


@inner
def _path(legs: Legs, side: float, angle: float) -> float:
    """Length of the slip of a leg (side: 1 forward, -1 back) up to this angle after its start.

    Written with half angles: near a reversal the path is a small difference of large terms.
    """
    half = math.sin(0.5 * angle)
    turned = 2.0 * math.sin(legs.turn) * half * half
    return legs.amplitude * (turned + side * math.cos(legs.turn) * _less_sine(angle))


@inner
def _velocity(legs: Legs, side: float, angle: float) -> float:
    return 2.0 * side * legs.speed * math.sin(legs.turn + 0.5 * side * angle) * math.sin(0.5 * angle)


@inner
def _angle_of(legs: Legs, side: float, path: float, longest: float) -> float:
    """Return the angle at which the slip of a leg has this length, by bisection in its logarithm."""
    # Bisection in the logarithm: angles down to 1e-26 are as quick to find as large ones.
    low, high = -60.0, math.log(longest)
    for _ in range(80):
        middle = 0.5 * (low + high)
        if _path(legs, side, math.exp(middle)) < path:
            low = middle
        else:
            high = middle
    return math.exp(high)


@inner
def _deflected(law: Any, z: float, side: float, path: float) -> float:
    return law.deflected(z, side * path)


@inner
def gained(law: Any, length: float, z: float, side: float, path: float) -> float:
    """Return the change of deflection over a leg, with full relative accuracy for soft contacts, too.

    length: as in ``Legs``.
    """
    # Far along, or saturated, the difference of deflections keeps its digits; else the rate is integrated.
    if path > SOFT * length or path >= law.saturation_path(z, side):
        return _deflected(law, z, side, path) - z
    total = 0.0
    for node in range(POINTS.size):
        rate, _ = resistance(law, side, _deflected(law, z, side, POINTS[node] * path))
        total += SHARES[node] * rate
    return total * path


@inner
def _opened(law: Any, legs: Legs, z: float, forward: float, back: float) -> float:
    """Return the change of deflection over both legs; it decreases as the deflection at the start increases."""
    # The second leg starts where the first ends.
    up = gained(law, legs.length, z, 1.0, forward)
    return up + gained(law, legs.length, z + up, -1.0, back)


@inner
def _closed(law: Any, legs: Legs, forward: float, back: float) -> float:
    """Return the deflection at the start that both legs reproduce: regula falsi (Illinois) within a bracket."""
    # The change over both legs decreases with the deflection: its zero is bracketed by the largest deflections. A
    # contact that saturates returns exactly to one of them.
    low, high = -legs.reach, legs.reach
    at_low, at_high = _opened(law, legs, low, forward, back), _opened(law, legs, high, forward, back)
    if at_low <= 0.0:
        return low
    if at_high >= 0.0:
        return high
    side = 0
    for turn in range(300):
        z = (low * at_high - high * at_low) / (at_high - at_low)
        # Every third step is a bisection, which bounds the number of steps.
        if turn % 3 == 2 or not low < z < high:
            z = 0.5 * (low + high)
        opened = _opened(law, legs, z, forward, back)
        if opened == 0.0 or high - low <= 2e-16 * legs.reach:
            return z
        if opened > 0.0:
            low, at_low, at_high = z, opened, 0.5 * at_high if side > 0 else at_high
            side = 1
        else:
            high, at_high, at_low = z, opened, 0.5 * at_low if side < 0 else at_low
            side = -1
    return 0.5 * (low + high)


@inner
def _edges(law: Any, legs: Legs, z: float, side: float, longest: float, edges: Any) -> int:
    """Panel edges of a leg, graded towards its start and towards the angle where friction saturates."""
    # corner: the angle from which friction is constant; beyond the leg if there is none.
    corner = 2.0 * longest
    saturation = law.saturation_path(z, side)
    if saturation < _path(legs, side, longest):
        corner = _angle_of(legs, side, saturation, longest) if saturation > 0.0 else 0.0
    # The layer after a reversal, in which the deflection changes sign, starts with a fifth of the shortest path.
    first = _angle_of(legs, side, 0.2 * legs.length, longest)
    first, at, n = max(first, CLOSEST), 0.0, 0
    edges[0] = 0.0
    while at < longest and n < ROOM - 3:
        step = min(0.5 * max(at, first), 0.3) / legs.cuts
        # Panels double in size away from the start and halve towards the corner, which becomes an edge.
        gap = corner - at
        if gap > 0.0:
            step = min(step, max(0.5 * gap / legs.cuts, 1e-15 * longest))
            if step >= gap or gap <= 4e-15 * longest:
                step = gap
        following = min(at + step, longest)
        at = following if following > at else min(at * (1.0 + 3e-16), longest)
        n += 1
        edges[n] = at
    edges[n] = longest
    return n


@njit
def closed_legs(law: Any, legs: Legs) -> Any:
    """Return the closed loop on its panels, as arrays [panels] and [panels, nodes].

    Returns starts and widths of the panels (angles after the start of the forward leg), slip velocity, deflection
    and friction at their nodes.
    """
    # Both legs as paths: the loop closes on those alone, whatever the speed along them.
    long, short = 2.0 * (math.pi - legs.turn), 2.0 * legs.turn
    forward, back = _path(legs, 1.0, long), _path(legs, -1.0, short)
    z = _closed(law, legs, forward, back)
    edges = np.empty((2, ROOM))
    top = z + gained(law, legs.length, z, 1.0, forward)
    count = _edges(law, legs, z, 1.0, long, edges[0])
    both = count + _edges(law, legs, top, -1.0, short, edges[1])
    starts, widths = np.empty(both), np.empty(both)
    slips, deflections = np.empty((both, POINTS.size)), np.empty((both, POINTS.size))
    frictions = np.empty((both, POINTS.size))
    for panel in range(both):
        # Every node from the start of its leg: nothing accumulates from panel to panel.
        leg, row = (0, panel) if panel < count else (1, panel - count)
        side, base = (1.0, z) if leg == 0 else (-1.0, top)
        here, width = edges[leg, row], edges[leg, row + 1] - edges[leg, row]
        starts[panel], widths[panel] = here + leg * long, width
        for node in range(POINTS.size):
            angle = here + POINTS[node] * width
            v = _velocity(legs, side, angle)
            deflection = _deflected(law, base, side, _path(legs, side, angle))
            _, friction = resistance(law, v, deflection)
            slips[panel, node], deflections[panel, node], frictions[panel, node] = v, deflection, friction
    return starts, widths, slips, deflections, frictions
