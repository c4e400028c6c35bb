"""One scene of a law as kernels see it: what a period map, its fixed point and its derivative belong to."""

from __future__ import annotations

from typing import Any, NamedTuple

from frictionlab.scene.body import Body


class Case(NamedTuple):
    """A law and a body on a belt; ``like`` is a number of the kind of its positions, float or complex."""

    law: Any
    body: Body
    belt_speed: float
    like: Any
