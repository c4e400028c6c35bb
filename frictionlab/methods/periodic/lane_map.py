"""Period map of planar slip for several belt speeds at once, each in a lane with steps of its own.

The text of every step is that of maps/sliding.py. A lane that comes next to rest, or takes too many steps, is left
where it is: the map of one belt speed, which knows rest, is for it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.interpret import over_lanes
from frictionlab.compile.lane_arrays import any_lane, least_of_eight, read_lanes, select, write_lanes
from frictionlab.methods.periodic.period_map import planar_coordinates, unpack
from frictionlab.motion.equation import START, Flow, normal_load, rates, span, turned
from frictionlab.motion.events import dips
from frictionlab.motion.maps.sliding import Node, near_rest, node_at, step, step_towards_rest
from frictionlab.motion.steppers.dop853 import State
from frictionlab.motion.steppers.step import growth_of, longest_step
from frictionlab.scene.body import BodyNumbers

MOST_STEPS_IN_LANES = 3_000


class LaneRows(NamedTuple):
    """Input and output of a map, a lane a column.

    belt_speed [lanes], state [4, lanes]; residual [4, lanes]: image - state; impulse [2, lanes]: integral of the
    friction coefficient, along x1 and across; closest [lanes]: smallest slip speed at a node; arrived [lanes]: 1
    where the map came to its end, else 0.
    """

    belt_speed: Any
    state: Any
    residual: Any
    impulse: Any
    closest: Any
    arrived: Any


@inner
def rows_for(lanes: int) -> LaneRows:
    """Room for so many lanes."""
    return LaneRows(
        np.empty(lanes),
        np.empty((4, lanes)),
        np.empty((4, lanes)),
        np.empty((2, lanes)),
        np.empty(lanes),
        np.empty(lanes),
    )


@inner
def _merged(mask: Any, new: Node, old: Node) -> Node:
    """Return the new node where the mask is true."""
    a, b = new.state, old.state
    state = State(
        select(mask, a.x, b.x),
        select(mask, a.v, b.v),
        select(mask, a.a, b.a),
        select(mask, a.f, b.f),
    )
    return Node(
        select(mask, new.tau, old.tau),
        state,
        select(mask, new.w, old.w),
        select(mask, new.speed, old.speed),
        select(mask, new.rate, old.rate),
    )


class LaneWay(NamedTuple):
    """State of the lanes: the law and the body at the anchors, nodes, next steps, friction and slowest slip."""

    problem: Flow
    node: Node
    h: Any
    impulse: Any
    closest: Any


class LaneLimits(NamedTuple):
    """End of a map, its accuracy, the force of friction at rest, the slip next to rest, the longest step.

    alike: whether eight lanes beside each other take the same steps, those of the most demanding: what comes out is
    then a smooth function of what goes in.
    """

    end: float
    accuracy: float
    friction: float
    least: float
    longest: float
    alike: bool


@inner
def limits_of(law: Any, body: BodyNumbers, accuracy: float, alike: bool) -> LaneLimits:
    """Return the limits of a map over the span of the body."""
    coefficient = law.sliding_friction(0.0)
    friction = normal_load(body, START) * coefficient
    longest = longest_step(body, coefficient, accuracy)
    return LaneLimits(span(body), accuracy, friction, near_rest(accuracy, friction), longest, alike)


@inner
def begin_lanes(law: Any, body: BodyNumbers, rows: LaneRows, longest: float) -> LaneWay:
    """At tau = 0, from the states of the rows; every lane has an anchor of its own."""
    belt_speed, z = read_lanes(rows.belt_speed), rows.state
    zero = 0.0 * belt_speed
    state = read_lanes(z[0]), read_lanes(z[1]), read_lanes(z[2]), read_lanes(z[3])
    y, u = unpack(body, state, body.reference_sine)
    problem = Flow(law, body, belt_speed, 1.0, zero, zero, zero + 1.0)
    a, f = rates(problem, zero, y, u)
    node = node_at(problem, zero, State(y, u, a, f))
    return LaneWay(problem, node, zero + 0.1 * longest, 0.0 * y, node.speed)


@inner
def arrived(way: LaneWay, limits: LaneLimits) -> Any:
    """Select the lanes that are at the end."""
    return way.node.tau >= (1.0 - 4e-15) * limits.end


@inner
def moving(way: LaneWay, limits: LaneLimits) -> Any:
    """Select the lanes that have a step to take: they are neither at the end nor next to rest."""
    speed = least_of_eight(way.node.speed) if limits.alike else way.node.speed
    return (way.node.tau < (1.0 - 4e-15) * limits.end) & (speed >= limits.least)


@inner
def advance_lanes(way: LaneWay, going: Any, limits: LaneLimits) -> LaneWay:
    """A step of every lane that goes on; one that is too inaccurate, or passes close by rest, is to be repeated."""
    problem, node = way.problem, way.node
    ahead = min(min(way.h, limits.longest), limits.end - node.tau)
    h = select(going, step_towards_rest(node, limits.friction, ahead), 0.0)
    h = least_of_eight(h) if limits.alike else h
    taken, tau = step(problem, node.tau, node.state, h), node.tau + h
    a, f = rates(problem, tau, taken.x, taken.v)
    new = node_at(problem, tau, State(taken.x, taken.v, a, f))
    growth = growth_of(problem.body, taken, limits.accuracy)
    growth = select(dips(node.w, node.rate, new.w, new.rate, h), min(growth, 0.5), growth)
    growth = least_of_eight(growth) if limits.alike else growth
    good = going & (growth >= 1.0)
    node = _merged(good, new, node)
    # the sine and cosine of a step are expanded about its start
    sine, cosine = turned(problem, node.tau)
    problem = Flow(problem.law, problem.body, problem.belt_speed, 1.0, node.tau, sine, cosine)
    impulse = way.impulse + select(good, taken.friction_impulse, 0.0)
    return LaneWay(problem, node, h * growth, impulse, min(way.closest, node.speed))


@inner
def write_ends(way: LaneWay, limits: LaneLimits, rows: LaneRows) -> None:
    """Write where the lanes are to the rows, whose states they started from."""
    body, node, z = way.problem.body, way.node, rows.state
    along, speed, across, speed_across = planar_coordinates(body, node.state.x, node.state.v)
    write_lanes(rows.residual[0], along - read_lanes(z[0]))
    write_lanes(rows.residual[1], speed - read_lanes(z[1]))
    write_lanes(rows.residual[2], across - read_lanes(z[2]))
    write_lanes(rows.residual[3], speed_across - read_lanes(z[3]))
    write_lanes(rows.impulse[0], way.impulse.real)
    write_lanes(rows.impulse[1], way.impulse.imag)
    write_lanes(rows.closest, way.closest)
    write_lanes(rows.arrived, select(arrived(way, limits) & (node.speed >= limits.least), 1.0, 0.0))


@over_lanes
@inner
def lane_map(law: Any, body: BodyNumbers, rows: LaneRows, accuracy: float, alike: bool) -> int:
    """One span of the body from the states of the rows; accuracy is each step's, in the norm of energy.

    alike: as in ``LaneLimits``. Returns the number of steps that the slowest lane took.
    """
    limits = limits_of(law, body, accuracy, alike)
    way, steps = begin_lanes(law, body, rows, limits.longest), 0
    while steps < MOST_STEPS_IN_LANES:
        going = moving(way, limits)
        if not any_lane(going):
            break
        way = advance_lanes(way, going, limits)
        steps += 1
    write_ends(way, limits, rows)
    return steps
