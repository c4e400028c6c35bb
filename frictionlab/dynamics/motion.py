"""The equation of motion of the deviation from the friction-free response, and the slip velocity."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import fast, inner
from frictionlab.compile.dispatch import by_dimension
from frictionlab.dynamics.events import reference_acceleration
from frictionlab.scene.body import Body
from frictionlab.scene.body import restoring_force as _restoring_force
from frictionlab.scene.body import span as _span

restoring_force = fast(_restoring_force)
span = fast(_span)


class SlidingMotion(NamedTuple):
    """A law and a body on a belt; the side of slip on the line; sine and cosine at the anchor time."""

    law: Any
    body: Body
    belt_speed: float
    side: float
    anchor: float
    sine: float
    cosine: float


@fast
def turned(problem: SlidingMotion, tau: float) -> Any:
    """Sine and cosine of Omega*tau from those at the anchor, at most one radian away (Taylor, to rounding)."""
    angle = problem.body.frequency * (tau - problem.anchor)
    q = angle * angle
    cosine = 1.0 - q / 2.0 * (
        1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0 * (1.0 - q / 90.0 * (1.0 - q / 132.0 * (
            1.0 - q / 182.0 * (1.0 - q / 240.0 * (1.0 - q / 306.0)))))))
    )  # fmt: skip
    sine = angle * (
        1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0 * (1.0 - q / 110.0 * (
            1.0 - q / 156.0 * (1.0 - q / 210.0 * (1.0 - q / 272.0)))))))
    )  # fmt: skip
    return (
        problem.sine * cosine + problem.cosine * sine,
        problem.cosine * cosine - problem.sine * sine,
    )


@inner
def anchored(law: Any, body: Body, belt_speed: float, side: float, tau: float) -> SlidingMotion:
    angle = body.frequency * tau
    return SlidingMotion(law, body, belt_speed, side, tau, math.sin(angle), math.cos(angle))


@fast
def reference_velocity(body: Body, sine: float, cosine: float) -> Any:
    return body.frequency * (body.reference_sine * cosine - body.reference_cosine * sine)


@fast
def slip(problem: SlidingMotion, tau: float, u: Any) -> Any:
    """Slip velocity: of the mass against the belt."""
    sine, cosine = turned(problem, tau)
    return u + reference_velocity(problem.body, sine, cosine) - problem.belt_speed


def _friction_on_the_line(problem: SlidingMotion, w: float) -> Any:
    return problem.side * problem.law.sliding_friction(max(problem.side * w, 0.0))


def _friction_in_the_plane(problem: SlidingMotion, w: complex) -> Any:
    return problem.law.sliding_vector(w)


_friction = by_dimension(_friction_on_the_line, _friction_in_the_plane)


@fast
def rates(problem: SlidingMotion, tau: float, y: Any, u: Any) -> Any:
    """Acceleration of the deviation, and the friction coefficient."""
    body = problem.body
    sine, cosine = turned(problem, tau)
    rub = _friction(problem, u + reference_velocity(body, sine, cosine) - problem.belt_speed)
    force = body.force_sine * sine + body.force_cosine * cosine
    return force - restoring_force(body, y, u) - body.normal_load * rub, rub


@fast
def slip_rate(problem: SlidingMotion, tau: float, a: Any) -> Any:
    sine, cosine = turned(problem, tau)
    return a + reference_acceleration(problem.body, sine, cosine)


@inner
def reference_position(body: Body, tau: float) -> Any:
    angle = body.frequency * tau
    return body.reference_sine * math.sin(angle) + body.reference_cosine * math.cos(angle)
