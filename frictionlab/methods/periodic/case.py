"""One scene of a law as kernels see it: what a period map, its fixed point and its derivative belong to."""

from __future__ import annotations

from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.dynamics.motion import in_piece
from frictionlab.scene.body import BodyNumbers


class Case(NamedTuple):
    """A law and a body on a belt; ``like`` is a zero of the kind of its positions, float or complex."""

    law: Any
    body: BodyNumbers
    belt_speed: float
    like: Any


@inner
def case_of(law: Any, body: BodyNumbers, belt_speed: float) -> Case:
    """The case of a body, whose own numbers tell whether it moves on a line or in the plane."""
    return Case(law, body, belt_speed, body.reference_sine - body.reference_sine)


@inner
def case_in_piece(case: Case, k: int) -> Case:
    """The case as the k-th piece of its span has it."""
    return Case(case.law, in_piece(case.body, k), case.belt_speed, case.like)
