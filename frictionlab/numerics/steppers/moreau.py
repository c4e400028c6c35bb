"""Moreau-Jean: one step at velocity level, friction's impulse projected on its disk; springs and dashpots implicit.

Over a step of length h the balance of momentum reads, along each axis,

    v1 - v0 = h (load - damping v_theta - stiffness x_theta) - P,   x1 = x0 + h v_theta,

with v_theta = theta v1 + (1 - theta) v0, x_theta likewise, load and normal load taken at that instant, and P the
impulse of friction. Where the impulse that brings the slip to zero at the end of the step lies in the disk of radius
h*normal_load*(static coefficient), it is taken: the mass sticks. Otherwise P lies on the disk of the sliding
coefficient, along the slip w_theta and with the coefficient at that speed, both found with the step: nothing is
lagged. (Directed by the slip at the end of the step, the scheme is of order one wherever friction turns, for
theta = 1/2 too.) Stable for theta >= 1/2 however long the step. J. J. Moreau, in Nonsmooth Mechanics and
Applications (1988); M. Jean, Comput. Methods Appl. Mech. Engrg. 177 (1999).
"""

from __future__ import annotations

from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, length
from frictionlab.numerics.steppers.grid import BELT, LOAD, NORMAL_LOAD

MOST_TRIALS = 60
TINY = 1e-300
SMALL = 2e-15
"""Relative to the impulse or the speed; about what rounding leaves."""


class Taken(NamedTuple):
    """The state after a step, the integral of the friction coefficient over it, and whether it ended at rest."""

    x: Any
    v: Any
    rubbed: Any
    stuck: bool


class Contact(NamedTuple):
    """One contact over one step: slip w and impulse P with mass_1 w1 + P1 = q1, mass_2 w2 + P2 = q2."""

    law: Any
    weight: float  # normal load times step
    mass_1: float
    mass_2: float


class Met(NamedTuple):
    """What a contact ends with: slip velocity and impulse."""

    w: Any
    impulse: Any


def _over_on_the_line(a: float, b: float, q: float) -> float:
    return q / a


def _over_in_the_plane(a: float, b: float, q: complex) -> complex:
    return complex(q.real / a, q.imag / b)


over = by_dimension(_over_on_the_line, _over_in_the_plane)
"""q with its components along x1 and x2 divided by a and b."""


@inner
def _excess(contact: Contact, speed: float, q: Any) -> float:
    """Above zero where a slip of this speed takes more than q; linear in speed for one mass and constant friction."""
    rub = contact.weight * contact.law.sliding_friction(speed)
    return 1.0 / length(over(contact.mass_1 * speed + rub, contact.mass_2 * speed + rub, q)) - 1.0


@inner
def _slip_speed(contact: Contact, q: Any) -> float:
    """The speed of slip at the end of the step (Illinois regula falsi on a bracket that always holds).

    The first guess is exact for constant friction and one mass.
    """
    size = length(q)
    low, high = 0.0, size / min(contact.mass_1, contact.mass_2)
    nothing = SMALL * high
    speed = max((size - contact.weight * contact.law.sliding_friction(0.0)) / contact.mass_1, 0.0)
    speed = max((size - contact.weight * contact.law.sliding_friction(speed)) / contact.mass_1, 0.0)
    value = _excess(contact, min(speed, high), q)
    if abs(value) <= SMALL:
        return min(speed, high)
    at_low, at_high, side = _excess(contact, low, q), _excess(contact, high, q), 0
    speed = min(speed, high)
    for _ in range(MOST_TRIALS):
        if value > 0.0:
            high, at_high, at_low = speed, value, 0.5 * at_low if side > 0 else at_low
            side = 1
        else:
            low, at_low, at_high = speed, value, 0.5 * at_high if side < 0 else at_high
            side = -1
        last = speed
        speed = (low * at_high - high * at_low) / (at_high - at_low)
        if not abs(speed - last) > nothing:
            break
        value = _excess(contact, speed, q)
        if abs(value) <= SMALL:
            break
    return speed


@inner
def meet(contact: Contact, theta: float, before: Any, q: Any) -> Met:
    """Slip at the end of the step and impulse of a contact that is pushed by q; before: the slip it began with."""
    if length(q) <= contact.weight * contact.law.static_friction():
        return Met(0.0 * q, q)
    share = (1.0 - theta) / theta
    late = Contact(contact.law, contact.weight, contact.mass_1 / theta, contact.mass_2 / theta)
    pushed = q + over(1.0 / (share * contact.mass_1 + TINY), 1.0 / (share * contact.mass_2 + TINY), before)
    if length(pushed) <= contact.weight * contact.law.sliding_friction(0.0):
        return Met(-share * before, pushed)
    speed = _slip_speed(late, pushed)
    rub = contact.weight * contact.law.sliding_friction(speed)
    along = over(late.mass_1 * speed + rub, late.mass_2 * speed + rub, pushed)
    return Met(speed / theta * along - share * before, rub * along)


def stepper(restoring_force: Any) -> Any:
    """``step(problem, k, x, v, h)``: from the kth step's start over h.

    The problem has ``law``, ``body``, ``theta`` and ``grid``, what acts at every half step (grid.py);
    restoring_force(body, x, v) is linear, and acts along each axis for itself.
    """

    @inner
    def step(problem: Any, k: int, x: Any, v: Any, h: float) -> Taken:
        body, theta = problem.body, problem.theta
        late, left = theta * h, 1.0 - theta
        mass_1 = 1.0 + late * (body.damping_mean + body.damping_split)
        mass_1 += late * late * (body.stiffness_mean + body.stiffness_split)
        mass_2 = 1.0 + late * (body.damping_mean - body.damping_split)
        mass_2 += late * late * (body.stiffness_mean - body.stiffness_split)
        grid, j = problem.grid, 2 * k + int(2.0 * theta)
        pushed = v + h * (grid[j, LOAD] - restoring_force(body, x + late * left * v, left * v))
        pressed, belt = grid[j, NORMAL_LOAD].real, grid[2 * k + 2, BELT].real
        contact = Contact(problem.law, h * pressed, mass_1, mass_2)
        # Written for the slip that ends the step: mass * w1 + P = what pushes, less what carries along with the belt.
        w, impulse = meet(contact, theta, v - grid[2 * k, BELT].real, pushed - mass_1 * belt)
        after = w + belt
        return Taken(x + late * after + h * left * v, after, impulse / pressed, length(w) == 0.0)

    return step
