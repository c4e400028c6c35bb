"""Step of a mass and the memory of its contact by Rodas5P, with elimination along an arrow matrix.

The rate of a number z_k of the memory depends on slip and on z_k alone. With the blocks A_k = dr_k/dz_k,
B_k = dr_k/dw, F_k = dmu/dz_k, G = dmu/dw, each a number on the line and a pair in the plane, the equations of
a stage

    (1/(gamma h) - A_k) k_zk - B_k k_u = r_zk,
    (1/(gamma h) + D + gamma h K + N G) k_u + N sum F_k k_zk = r_u

are solved number by number: E_k = (1/(gamma h) - A_k)^-1 and C_k = E_k B_k give k_zk = E_k r_zk + C_k k_u,
and one block for k_u remains. The cost grows with the count of these numbers, not with its cube.
"""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import fast, inner
from frictionlab.compile.dispatch import by_dimension, by_scalars, length
from frictionlab.compile.stack import count_of
from frictionlab.motion.equation import Flow, instant_near, load_share, restoring_force
from frictionlab.motion.linalg import add, apply, block, diagonal, inverse, keep, product, scale
from frictionlab.motion.maps.creep import (
    creeps,
    from_step_variable,
    step_variable_rate,
    to_step_variable,
    velocity_error,
)
from frictionlab.motion.maps.rates import (
    IMPULSE,
    MEMORY,
    U,
    Work,
    Y,
    as_memory,
    fill_rates,
    load_on,
    rows_of,
    springs_at,
)
from frictionlab.motion.steppers.rodas5p import COUPLINGS, DENSE, GAMMA, INCREMENTS, SLOPES, STAGES, TIMES
from frictionlab.scene.body import BodyNumbers

LITTLE = 1e-2
"""Share of the unit of a scalar by which its error counts where friction does not depend on it."""
SIMULTANEOUS = 6
"""Index of the first stage that reuses the sine and cosine of the stage before: both are at the end of the
step."""


@fast
def factor(flow: Flow, h: float, work: Work, zero: Any) -> None:
    """Fill ``work.factors`` for a step of h from ``work.jacobian``.

    There are no pivots: a block that is singular to rounding gives an infinite or undefined error, and the
    step is repeated.
    """
    body, n, diagonally, beside = flow.body, count_of(flow.law), 1.0 / (GAMMA * h), springs_at(flow, work)
    # friction by slip: at once, and through every deflection that slip moves within the step
    by_slip = block(work.jacobian, 3 * n, zero)
    for k in range(n):
        own = scale(-1.0, block(work.jacobian, 3 * k + 1, zero), zero)
        alone = inverse(add(diagonal(diagonally, 0.0, zero), own, zero), zero)
        moved = product(alone, block(work.jacobian, 3 * k, zero), zero)
        by_slip = add(by_slip, product(block(work.jacobian, 3 * k + 2, zero), moved, zero), zero)
        keep(work.factors, 2 * k, alone, zero)
        keep(work.factors, 2 * k + 1, moved, zero)
    # the mass, with its springs at the end of the step: y' = u makes them gamma h K in the block of u
    mean = diagonally + beside.damping_mean + GAMMA * h * beside.stiffness_mean
    mass = diagonal(mean, beside.damping_split + GAMMA * h * beside.stiffness_split, zero)
    keep(
        work.factors,
        2 * n,
        inverse(add(mass, scale(load_on(body, instant_near(flow, flow.anchor)), by_slip, zero), zero), zero),
        zero,
    )
    keep(work.factors, 2 * n + 1, by_slip, zero)


_stretched = by_dimension(
    lambda body, x: (body.stiffness_mean + body.stiffness_split) * x,
    lambda body, x: body.stiffness_mean * x + body.stiffness_split * x.conjugate(),
)
"""_stretched(body, x): force of the springs."""


@fast
def _argument(i: int, flow: Flow, work: Work) -> None:
    """Write the argument of stage i: the start plus the increments of the stages before it."""
    size = rows_of(flow)
    for row in range(size):
        work.stage[row] = work.start[row]
    for j in range(i):
        share = INCREMENTS[i, j]
        for row in range(size):
            work.stage[row] = work.stage[row] + share * work.increments[size * j + row]


@fast
def _right_side(i: int, flow: Flow, h: float, work: Work) -> None:
    """Add the contributions of earlier stages and of the slope in time to the right-hand sides of stage i."""
    size, late, per = rows_of(flow), h * SLOPES[i], 1.0 / h
    for row in range(size):
        work.rates[row] = work.rates[row] + late * work.slope[row]
    if creeps(flow.law, work):
        work.rates[IMPULSE] = work.rates[IMPULSE] + (late / flow.body.normal_load) * work.slope[U]
    for j in range(i):
        share = COUPLINGS[i, j] * per
        for row in range(size):
            work.rates[row] = work.rates[row] + share * work.increments[size * j + row]


@fast
def _solve(i: int, flow: Flow, h: float, work: Work, zero: Any) -> None:
    """Solve for the increments of stage i, from its right-hand sides in ``work.rates``."""
    n, body = count_of(flow.law), flow.body
    first = rows_of(flow) * i
    # each number at unchanged velocity, then the mass, then the effect of its change of velocity on each number
    alone = 0.0 * zero  # friction by the increments of the deflections at unchanged velocity
    for k in range(n):
        moved = apply(block(work.factors, 2 * k, zero), work.rates[MEMORY + k])
        work.increments[first + MEMORY + k] = moved
        alone = alone + apply(block(work.jacobian, 3 * k + 2, zero), moved)
    right = (
        work.rates[U]
        - GAMMA * h * _stretched(springs_at(flow, work), work.rates[Y])
        - load_on(body, instant_near(flow, flow.anchor)) * alone
    )
    u = apply(block(work.factors, 2 * n, zero), right)
    work.increments[first + Y] = GAMMA * h * (work.rates[Y] + u)
    work.increments[first + U] = u
    for k in range(n):
        moved = apply(block(work.factors, 2 * k + 1, zero), u)
        work.increments[first + MEMORY + k] = work.increments[first + MEMORY + k] + moved
    if creeps(flow.law, work):
        held = restoring_force(springs_at(flow, work), work.increments[first + Y], u)
        rubs = -held / body.normal_load
    else:
        share = load_share(body, instant_near(flow, flow.anchor))
        rubs = share * (alone + apply(block(work.factors, 2 * n + 1, zero), u))
    work.increments[first + IMPULSE] = GAMMA * h * (work.rates[IMPULSE] + rubs)


square = by_dimension(lambda x: x * x, lambda x: x.real * x.real + x.imag * x.imag)


def _elastic_in_the_plane(body: BodyNumbers, x: complex) -> float:
    along, across = body.stiffness_mean + body.stiffness_split, body.stiffness_mean - body.stiffness_split
    return along * x.real * x.real + across * x.imag * x.imag


_elastic = by_dimension(
    lambda body, x: (body.stiffness_mean + body.stiffness_split) * x * x, _elastic_in_the_plane
)
"""_elastic(body, x): twice the energy of the springs."""


def _scalars_within(flow: Flow, work: Work) -> bool:
    for k in range(count_of(flow.law)):
        work.memory[k] = as_memory(flow.law, work.stage[MEMORY + k])
    return flow.law.within(work.memory)


_within = by_scalars(lambda flow, work: True, _scalars_within)
"""_within(flow, work): whether the law has a rate at ``work.stage``; the age of a contact is never
negative."""


def _unit_of_impulse(flow: Flow, k: int, work: Work, zero: Any) -> float:
    """Return the unit of a scalar: its effect on friction for a radian, or a share of its usual unit."""
    effect = length(apply(block(work.jacobian, 3 * k + 2, zero), 1.0 + 0.0 * zero))
    here = length(work.start[MEMORY + k])
    return max(
        effect * flow.body.normal_load / flow.body.frequency, LITTLE * work.unit[k] / max(here, work.size[k])
    )


_unit = by_scalars(lambda flow, k, work, zero: work.unit[k], _unit_of_impulse)
"""_unit(flow, k, work, zero): factor of the error of a number."""


@inner
def _error(flow: Flow, work: Work, zero: Any) -> float:
    """Return the difference to the embedded method of order 4 in the norm of energy, impulse included."""
    n, body = count_of(flow.law), flow.body
    last = rows_of(flow) * (STAGES - 1)
    error = _elastic(body, work.increments[last + Y])
    velocity = velocity_error(flow.law, work, work.increments[last + U])
    error += velocity * velocity
    error += square(body.normal_load * work.increments[last + IMPULSE])
    for k in range(n):
        error += square(_unit(flow, k, work, zero) * work.increments[last + MEMORY + k])
    return math.sqrt(error)


@inner
def step(flow: Flow, tau: float, h: float, work: Work, zero: Any) -> float:
    """Take one step from ``work.start`` to ``work.end``, and return its error.

    It starts at the anchor of the flow. The error is that in the norm of energy, impulse included. It is
    infinite if a scalar has left its set of values on the way.
    """
    size = rows_of(flow)
    factor(flow, h, work, zero)
    now, taken = instant_near(flow, tau), work.start[U]
    for i in range(STAGES):
        # stages 6 to 8 are all at the end of the step: its sine and cosine serve them
        _argument(i, flow, work)
        if not _within(flow, work):
            return math.inf
        taken = work.stage[U]
        work.stage[U] = from_step_variable(flow.law, work, taken)
        if 0 < i < SIMULTANEOUS:
            now = instant_near(flow, tau + TIMES[i] * h)
        fill_rates(flow, now, work, zero)
        if creeps(flow.law, work):
            work.rates[IMPULSE] = work.rates[IMPULSE] + work.rates[U] / flow.body.normal_load
        work.rates[U] = step_variable_rate(flow.law, work, work.stage[U], work.rates[U])
        _right_side(i, flow, h, work)
        _solve(i, flow, h, work, zero)
    # the last increment, the difference to the embedded method, completes the step
    last = size * (STAGES - 1)
    for row in range(size):
        work.end[row] = work.stage[row] + work.increments[last + row]
    work.end[U] = from_step_variable(flow.law, work, taken + work.increments[last + U])
    if creeps(flow.law, work):
        work.end[IMPULSE] = work.end[IMPULSE] - (work.end[U] - work.start[U]) / flow.body.normal_load
    return _error(flow, work, zero)


@inner
def bend(flow: Flow, work: Work) -> None:
    """Write the interpolant of the last step to ``work.bends``, for ``within_step``."""
    size = rows_of(flow)
    for i in range(3):
        for row in range(size):
            total = DENSE[i, 0] * work.increments[row]
            for j in range(1, STAGES):
                total = total + DENSE[i, j] * work.increments[size * j + row]
            work.bends[size * i + row] = total


@inner
def within_step(flow: Flow, share: float, work: Work) -> None:
    """Write the state at a share of the last step to ``work.stage``; ``bend`` must have been called."""
    size, rest = rows_of(flow), 1.0 - share
    for row in range(size):
        bent = work.bends[row] + share * (work.bends[size + row] + share * work.bends[2 * size + row])
        end = work.end[row] if row != U else to_step_variable(flow.law, work, work.end[row])
        work.stage[row] = rest * work.start[row] + share * (end + rest * bent)
    # a polynomial may leave the set of a scalar's values, a straight line does not
    if not _within(flow, work):
        for row in range(size):
            work.stage[row] = rest * work.start[row] + share * work.end[row]
    else:
        work.stage[U] = from_step_variable(flow.law, work, work.stage[U])
