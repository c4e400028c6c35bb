"""Moreau-Jean: one step at velocity level, with friction's impulse projected on its disk.

Springs and dashpots are implicit.

Over a step of length h the balance of momentum reads, along each axis,

    v1 - v0 = h (load - damping v_theta - stiffness x_theta) - P,   x1 = x0 + h v_theta,

with v_theta = theta v1 + (1 - theta) v0 and x_theta likewise; load and normal load are taken at that instant,
and P is the impulse of friction. If the impulse that brings slip to zero at the end of the step lies in the
disk of radius h*normal_load*(static coefficient), the step takes it and the mass sticks. Otherwise P lies on
the disk of the sliding coefficient, along the slip w_theta and with the coefficient at that speed. Both are
found with the step: no number is lagged. (Directed by the slip at the end of the step, the scheme would be of
order one wherever friction turns, for theta = 1/2 too.) The scheme is stable for theta >= 1/2 however long
the step. J. J. Moreau, in Nonsmooth Mechanics and Applications (1988); M. Jean, Comput. Methods Appl. Mech.
Engrg. 177 (1999).
"""

from __future__ import annotations

from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, length
from frictionlab.motion.steppers.step import FIRST, LAST, StepEnd, StepStart, belt_at, load_at, normal_load_at

MOST_TRIALS = 60
TINY = 1e-300
SMALL = 2e-15
"""Tolerance relative to the impulse or the speed; about the size of rounding."""


class ContactStep(NamedTuple):
    """Contact over one step: slip w and impulse P with mass_1 w1 + P1 = q1, mass_2 w2 + P2 = q2."""

    law: Any
    weight: float  # normal load times step
    mass_1: float
    mass_2: float


class ContactEnd(NamedTuple):
    """Slip velocity and impulse at the end of a step."""

    w: Any
    impulse: Any


over = by_dimension(lambda a, b, q: q / a, lambda a, b, q: complex(q.real / a, q.imag / b))
"""over(a, b, q): q with its components along x1 and x2 divided by a and b."""

momentum = by_dimension(
    lambda mass_1, mass_2, velocity: mass_1 * velocity,
    lambda mass_1, mass_2, velocity: complex(mass_1 * velocity.real, mass_2 * velocity.imag),
)
"""momentum(mass_1, mass_2, velocity): velocity with its components multiplied by the masses along x1 and
x2."""


@inner
def _excess(contact: ContactStep, speed: float, q: Any) -> float:
    """Return how much more than q a slip of this speed takes, relative to q.

    It is linear in speed for one mass and constant friction.
    """
    rub = contact.weight * contact.law.sliding_friction(speed)
    return 1.0 / length(over(contact.mass_1 * speed + rub, contact.mass_2 * speed + rub, q)) - 1.0


@inner
def _slip_speed(contact: ContactStep, q: Any) -> float:
    """Return the speed of slip at the end of the step (Illinois regula falsi on a bracket that always holds).

    The first guess is exact for constant friction and one mass.
    """
    size = length(q)
    low, high = 0.0, size / min(contact.mass_1, contact.mass_2)
    nothing = SMALL * high
    # Two fixed-point steps: exact already for constant friction and one mass.
    speed = max((size - contact.weight * contact.law.sliding_friction(0.0)) / contact.mass_1, 0.0)
    speed = max((size - contact.weight * contact.law.sliding_friction(speed)) / contact.mass_1, 0.0)
    value = _excess(contact, min(speed, high), q)
    if abs(value) <= SMALL:
        return min(speed, high)
    # Regula falsi; an end that stays twice has its value halved, else the other end would creep (Illinois).
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
def project_impulse(contact: ContactStep, theta: float, before: Any, q: Any) -> ContactEnd:
    """Return slip at the end of the step and impulse of a contact that is pushed by q.

    before: slip at the start of the step.
    """
    # The impulse that brings slip to zero lies in the disk of the static coefficient: the mass sticks.
    if length(q) <= contact.weight * contact.law.static_friction():
        return ContactEnd(0.0 * q, q)
    # Otherwise friction acts along the slip at theta, for which the same balance is written.
    share = (1.0 - theta) / theta
    late = ContactStep(contact.law, contact.weight, contact.mass_1 / theta, contact.mass_2 / theta)
    pushed = q + over(1.0 / (share * contact.mass_1 + TINY), 1.0 / (share * contact.mass_2 + TINY), before)
    # That slip vanishes if its push lies in the disk of the sliding coefficient: the step passes rest.
    if length(pushed) <= contact.weight * contact.law.sliding_friction(0.0):
        return ContactEnd(-share * before, pushed)
    speed = _slip_speed(late, pushed)
    rub = contact.weight * contact.law.sliding_friction(speed)
    along = over(late.mass_1 * speed + rub, late.mass_2 * speed + rub, pushed)
    return ContactEnd(speed / theta * along - share * before, rub * along)


@inner
def moreau_step(expanded: Any, slopes_at: Any, problem: Any, start: StepStart, h: float) -> StepEnd:
    """Take one step over h.

    slopes_at(body, x, v) is the linear body beside this motion; its springs and dashpots act along each axis
    separately. expanded(body, x, v, ahead, later) is its force at another position and velocity.
    """
    theta, x, v = problem.stepper.theta, start.x, start.v
    late, left, body = theta * h, 1.0 - theta, slopes_at(problem.body, x, v)
    # Effective mass along each axis: implicit springs and dashpots add to it.
    mass_1 = 1.0 + late * (body.damping_mean + body.damping_split)
    mass_1 += late * late * (body.stiffness_mean + body.stiffness_split)
    mass_2 = 1.0 + late * (body.damping_mean - body.damping_split)
    mass_2 += late * late * (body.stiffness_mean - body.stiffness_split)
    # Loads at the instant theta: the middle of the step, or its end.
    k, part = start.k, int(2.0 * theta)
    held = expanded(problem.body, x, v, x + late * left * v, left * v)
    pushed = v + h * (load_at(problem, k, part) - held)
    pressed, belt = normal_load_at(problem, k, part), belt_at(problem, k, LAST)
    contact = ContactStep(problem.law, h * pressed, mass_1, mass_2)
    # Balance for the slip at the end of the step: mass * w1 + P = push less momentum of the belt velocity.
    pushed = pushed - momentum(mass_1, mass_2, belt)
    w, impulse = project_impulse(contact, theta, v - belt_at(problem, k, FIRST), pushed)
    after = w + belt
    return StepEnd(x + late * after + h * left * v, after, impulse / body.normal_load, length(w) == 0.0, 1.0)
