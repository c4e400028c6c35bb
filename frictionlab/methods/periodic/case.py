"""One period map as a record: the law, the body and the belt speed it belongs to."""

from __future__ import annotations

from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.methods.periodic.maps.sliding import Mapped
from frictionlab.methods.periodic.period_map import period_map
from frictionlab.orbit.recorder import Track, track_of
from frictionlab.scene.body import Body


class Case(NamedTuple):
    """A law and a body on a belt; ``like`` is a zero of the kind of its positions, float or complex."""

    law: Any
    body: Body
    belt_speed: float
    like: Any


@inner
def case_of(law: Any, body: Body, belt_speed: float) -> Case:
    """The case of a body, whose own numbers tell whether it moves on a line or in the plane."""
    return Case(law, body, belt_speed, body.reference_sine - body.reference_sine)


@inner
def image_of(case: Case, state: Any, residual: Any, accuracy: float) -> Mapped:
    """The image of a state after one span of the body; leaves image - state in residual."""
    return recorded_image(case, state, residual, accuracy, track_of(0))


@inner
def recorded_image(case: Case, state: Any, residual: Any, accuracy: float, track: Track) -> Mapped:
    """The same, with the motion written to the track."""
    return period_map(case.law, case.body, case.belt_speed, state, residual, accuracy, track, case.like)
