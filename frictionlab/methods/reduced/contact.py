"""Kernels for the friction of a bristle law over a periodic slip along a line.

A period is divided into panels with Radau nodes, short near reversals of slip. Slip at the nodes is given. The
deflection is computed from node to node by the exact path of the law, or else panel by panel by collocation: the
polynomial whose derivative is the law's rate at every node (Radau IIA of order nine; stiff bristles do not limit the
panels). Its start is the fixed point of the period.

Source: Hairer & Wanner, Solving Ordinary Differential Equations II (1996), IV.5.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner, njit
from frictionlab.dynamics import radau_panel
from frictionlab.dynamics.contact import resistance
from frictionlab.dynamics.radau_panel import STAGES, eliminate
from frictionlab.quantities import Floats

NODES: Floats = 2.0 * radau_panel.NODES - 1.0
"""Nodes of Radau quadrature on [-1, 1], the right end included."""
INTEGRAL: Floats = 2.0 * radau_panel.MATRIX
"""Integrals from -1 to each node of the polynomial through the nodes."""
WEIGHTS: Floats = INTEGRAL[-1].copy()

MOST_PANELS = 600
MOST_CORRECTIONS = 25
MOST_CLOSINGS = 60
CLOSED = 1e-13
"""Largest change of deflection over a closed period, relative to the largest deflection."""
FINEST = 1e-7
"""Shortest panel [rad]."""
COARSEST = math.pi / 16.0
SHARE = 0.1
"""Largest path in a panel while bristles without an exact path yield [largest deflections]."""
SETTLING = 8.0
"""Path after a reversal within which bristles yield [largest deflections]."""


class HarmonicContact(NamedTuple):
    """Whether the exact path of the law is used (1 or 0), and its largest deflection [scene length]."""

    exact: float
    size: float


class LineBristle(NamedTuple):
    """A law, whether its exact path is used (1 or 0), and its largest deflection [scene length]."""

    law: Any
    exact: float
    size: float


class SlipPanels(NamedTuple):
    """Panels of a period: half widths [time], slip and angle at their nodes [panels, STAGES]."""

    half: Any
    slip: Any
    angle: Any


class Harmonics(NamedTuple):
    """Friction coefficient over the slip amplitude*sin(theta) - belt_speed: its mean, its coefficients of sin(theta)
    (in quadrature to the displacement) and cos(theta), the number of sign changes, and the multiplier of a
    disturbance of the deflection over a period."""

    mean: float
    sine: float
    cosine: float
    sign_changes: float
    multiplier: float


@inner
def _straight(law: Any, last: float, half: float, slip: Any, z: float, deflections: Any) -> float:
    """The deflections at the nodes of a panel along the exact path; ``last`` is the slip before the panel."""
    before, gone, node = last, 0.0, -1.0
    for k in range(STAGES):
        now, path = slip[k], 0.0
        for j in range(STAGES):
            path = path + half * INTEGRAL[k, j] * slip[j]
        step, time = path - gone, half * (NODES[k] - node)
        # Slip reverses between two nodes: the path forth and the path back are applied one after the other. The one
        # on the side of the smaller slip is computed as if slip were linear in time there, the other is the rest.
        if before * now < 0.0:
            out = 0.5 * time * before * before / (before - now)
            if abs(now) < abs(before):
                out = step - 0.5 * time * now * now / (now - before)
            z, step = law.deflected(z, out), step - out
        z = law.deflected(z, step)
        deflections[k] = z
        before, gone, node = now, path, NODES[k]
    return z


@inner
def _collocated(bristle: Any, half: float, slip: Any, z: float, room: Any, deflections: Any) -> float:
    """The deflections at the nodes of a panel by collocation, with Newton's method; room: matrix and right side."""
    law, (matrix, right) = bristle.law, room
    # Differences are of this length: rounding of a deflection is far below it, and no law bends within it.
    small, at, node = 1e-7 * bristle.size, z, -1.0
    # First guess: linearly implicit Euler steps from node to node, which no stiffness makes unstable.
    for k in range(STAGES):
        time = half * (NODES[k] - node)
        rate = law.rate(slip[k], at)
        slope = min((law.rate(slip[k], at + small) - rate) / small, 0.0)
        at = at + time * rate / (1.0 - time * slope)
        deflections[k], node = at, NODES[k]
    for _ in range(MOST_CORRECTIONS):
        # Residual z + half * INTEGRAL rate(found) - found, and its Jacobian with difference quotients of the rate.
        for i in range(STAGES):
            right[i, 0] = z - deflections[i]
        for j in range(STAGES):
            rate = law.rate(slip[j], deflections[j])
            slope = (law.rate(slip[j], deflections[j] + small) - rate) / small
            for i in range(STAGES):
                right[i, 0] = right[i, 0] + half * INTEGRAL[i, j] * rate
                matrix[i, j] = -half * INTEGRAL[i, j] * slope
            matrix[j, j] = matrix[j, j] + 1.0
        eliminate(matrix, right)
        change = 0.0
        for i in range(STAGES):
            deflections[i] = deflections[i] + right[i, 0]
            change = max(change, abs(right[i, 0]))
        # Converged, or not a number: neither gets better by another correction.
        if not change > 1e-12 * bristle.size:
            break
    return deflections[STAGES - 1]


@inner
def _period(bristle: LineBristle, panels: SlipPanels, z: float, deflections: Any, count: int) -> float:
    """The deflections at the nodes of ``count`` panels, starting from z; returns the deflection at the end."""
    room = np.empty((STAGES, STAGES)), np.empty((STAGES, 1))
    last = panels.slip[count - 1, STAGES - 1]
    for p in range(count):
        half, slip = panels.half[p], panels.slip[p]
        if bristle.exact > 0.0:
            z = _straight(bristle.law, last, half, slip, z, deflections[p])
        else:
            z = _collocated(bristle, half, slip, z, room, deflections[p])
        last = slip[STAGES - 1]
    return z


@inner
def _closed(bristle: LineBristle, panels: SlipPanels, deflections: Any, count: int) -> float:
    """Find periodic deflections by a bracketed secant method; returns the multiplier of a disturbance."""
    # Solutions of a scalar equation never cross, so end - z has one sign below the fixed point and the other above
    # it.
    size = bristle.size
    low, high, z = -size, size, 0.0
    last, last_gap, slope = math.nan, math.nan, 0.0
    for step in range(MOST_CLOSINGS):
        end = _period(bristle, panels, z, deflections, count)
        gap = end - z
        if z != last and step > 0:
            slope = (gap - last_gap) / (z - last)
        if abs(gap) <= CLOSED * size:
            break
        if gap > 0.0:
            low = max(low, z)
        else:
            high = min(high, z)
        # The first two steps iterate the period; then secant steps, replaced by bisection where the slope has the
        # wrong sign, where they leave the bracket, and every twelfth time against slow convergence.
        following = end
        if step > 1:
            following = z - gap / slope if slope < 0.0 else 0.5 * (low + high)
        if not low <= following <= high or step % 12 == 11:
            following = 0.5 * (low + high)
        last, last_gap, z = z, gap, following
        if high - low <= CLOSED * size:
            break
    return 1.0 + slope


@inner
def _edges(turn: float, reach: Any, least: float, size: float, corners: Any, edges: Any) -> int:
    """Panel edges of one period from ``turn`` on, short near it and near pi - turn; returns their number.

    Over a path of ``SETTLING * size`` after a reversal every panel covers at most ``SHARE * size``.
    """
    amplitude, belt_speed, frequency = reach
    reverses = amplitude > belt_speed
    there, end = math.pi - turn, turn + 2.0 * math.pi
    at, count = turn, 1
    edges[0] = turn
    while at < end and count < MOST_PANELS:
        # Half the distance to the nearest reversal: panels grow and shrink in proportion to it.
        near = min(abs(at - turn), abs(at - there), abs(end - at))
        step = min(COARSEST, max(least, 0.5 * near))
        behind = turn if at < there else there
        path = amplitude * (math.cos(behind) - math.cos(at)) - belt_speed * (at - behind)
        if reverses and abs(path) < SETTLING * size * frequency:
            pace = abs(amplitude * math.sin(at) - belt_speed)
            step = min(step, max(0.2 * least, SHARE * size * frequency / max(pace, 1e-300)))
        following = at + step
        # Corners of friction, the second reversal and the end become edges; a remainder below least/4 is merged.
        for stop in (corners[0], corners[1], there if reverses else end, end):
            if at < stop < following + 0.25 * least:
                following = stop
        # Towards a reversal panels shrink as they grew after the previous one.
        ahead = there if at < there else end
        if reverses and following < ahead:
            following = min(following, max(at + least, at + 0.34 * (ahead - at)))
            if ahead - following < 0.5 * least:
                following = ahead
        edges[count] = following
        at, count = following, count + 1
    return count


@inner
def _corner(law: Any, z: float, side: float, start: float, end: float, reach: Any) -> float:
    """The angle on a leg from which friction is constant; -inf where there is none."""
    amplitude, belt_speed, frequency = reach
    wanted = law.saturation_path(z, side) * frequency
    if not 0.0 < wanted < math.inf:
        return -math.inf
    low, high = start, end
    for _ in range(80):
        middle = 0.5 * (low + high)
        path = amplitude * (math.cos(start) - math.cos(middle)) - belt_speed * (middle - start)
        if side * path < wanted:
            low = middle
        else:
            high = middle
    return low if high < end else -math.inf


@inner
def _lay_panels(edges: Any, count: int, reach: Any, panels: SlipPanels) -> None:
    """Write half widths, angles and slip at the nodes of the panels between these edges."""
    amplitude, belt_speed, frequency = reach
    for p in range(count - 1):
        half = 0.5 * (edges[p + 1] - edges[p])
        panels.half[p] = half / frequency
        for k in range(STAGES):
            panels.angle[p, k] = edges[p] + half * (1.0 + NODES[k])
            panels.slip[p, k] = amplitude * math.sin(panels.angle[p, k]) - belt_speed


@inner
def _first_panel(size: float, reach: Any) -> tuple[float, float]:
    """The angle of the first reversal, or else of the largest slip speed, and the width of the panel there."""
    amplitude, belt_speed, frequency = reach
    if amplitude > belt_speed:
        # From the path amplitude*angle^2/2 of slip after a reversal and the largest deflection.
        turn = math.asin(belt_speed / amplitude)
        pace = amplitude * math.cos(turn) / frequency
        least = 0.25 * math.sqrt(2.0 * size / max(pace, 1e-300))
        return turn, max(FINEST, min(least, 0.125 * (math.pi - 2.0 * turn), COARSEST))
    # Without a reversal, from the width of the minimum of slip.
    least = COARSEST
    if amplitude > 0.0:
        least = max(FINEST, min(COARSEST, math.sqrt(2.0 * (belt_speed / amplitude - 1.0))))
    return 0.5 * math.pi, least


@inner
def _find_corners(law: Any, edges: Any, count: int, reach: Any, deflections: Any, corners: Any) -> float:
    """Write the angles from which friction of an exact path is constant; return the deflection at the first reversal.

    The deflection is known at both reversals: that at the first is the one at the end of the period.
    """
    turn = edges[0]
    there, end, back = math.pi - turn, turn + 2.0 * math.pi, 0.0
    for p in range(count - 1):
        if edges[p + 1] == there:
            back = deflections[p, STAGES - 1]
    start = deflections[count - 2, STAGES - 1]
    corners[0] = _corner(law, start, 1.0, turn, there, reach)
    corners[1] = _corner(law, back, -1.0, there, end, reach)
    return start


@inner
def _harmonics(law: Any, frequency: float, panels: SlipPanels, deflections: Any, count: int) -> Any:
    """Mean, coefficients of sin(theta) and cos(theta), and sign changes of friction over these panels."""
    mean, sine, cosine, changes, last = 0.0, 0.0, 0.0, 0.0, 0.0
    for p in range(count):
        for k in range(STAGES):
            angle = panels.angle[p, k]
            _, friction = resistance(law, panels.slip[p, k], deflections[p, k])
            share = WEIGHTS[k] * panels.half[p] * frequency / (2.0 * math.pi)
            mean = mean + share * friction
            sine = sine + 2.0 * share * friction * math.sin(angle)
            cosine = cosine + 2.0 * share * friction * math.cos(angle)
            changes = changes + (1.0 if last * friction < 0.0 else 0.0)
            last = friction if friction != 0.0 else last
    # From the last node around to the first.
    _, first = resistance(law, panels.slip[0, 0], deflections[0, 0])
    return mean, sine, cosine, changes + (1.0 if last * first < 0.0 else 0.0)


@njit
def harmonic_friction(law: Any, contact: Any, amplitude: float, belt_speed: float, frequency: float) -> Any:
    """Harmonics of friction over the slip amplitude*sin(theta) - belt_speed, belt_speed >= 0; see Harmonics."""
    bristle, reach = LineBristle(law, contact.exact, contact.size), (amplitude, belt_speed, frequency)
    turn, least = _first_panel(contact.size, reach)
    yielding = contact.size if contact.exact == 0.0 else 0.0
    edges, corners = np.empty(MOST_PANELS + 1), np.array([-math.inf, -math.inf])
    shape = (MOST_PANELS + 1, STAGES)
    panels, deflections = SlipPanels(np.empty(shape[0]), np.empty(shape), np.empty(shape)), np.empty(shape)
    count = _edges(turn, reach, least, yielding, corners, edges)
    _lay_panels(edges, count, reach, panels)
    multiplier = _closed(bristle, panels, deflections, count - 1)
    # Friction of an exact path may have a corner where it saturates: with the deflections at both reversals known,
    # the corners are located and become edges, and the period is computed once more.
    if amplitude > belt_speed and contact.exact > 0.0:
        start = _find_corners(law, edges, count, reach, deflections, corners)
        if max(corners[0], corners[1]) > -math.inf:
            count = _edges(turn, reach, least, yielding, corners, edges)
            _lay_panels(edges, count, reach, panels)
            _period(bristle, panels, start, deflections, count - 1)
    mean, sine, cosine, changes = _harmonics(law, frequency, panels, deflections, count - 1)
    return mean, sine, cosine, changes, multiplier
