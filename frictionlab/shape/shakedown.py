"""What bristles that do not drift hold while the belt creeps: the start of their friction curve.

Below a deflection of its own a contact may be elastic: vibration within that range moves nothing on, and a belt
that creeps stretches the bristles until the vibration touches the end of the range (physics of a shakedown). Where
bristles drift under any vibration, or where it leaves the range, friction on a creeping belt averages to zero.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from frictionlab.laws.memory import BristleLaw
from frictionlab.shape.verdict import Unreadable

Value = Callable[[str], float]
"""A number of a scene by its dotted path; 0 for one that it does not have."""


class Hold(NamedTuple):
    """Elastic bristles under a vibration that they follow all the way.

    elastic: deflection up to which nothing drifts, 0 for none [scene length]. along, across: phasors of the
    vibration if it is elastic [scene length]. stiffness: friction coefficient per deflection. planar: of the law.
    """

    elastic: float
    along: complex
    across: complex
    stiffness: float
    planar: str

    def friction(self) -> float:
        """The limit of mean friction as the belt slows down, if the vibration stays what it is. Raises Unreadable."""
        across = 0j if self.planar == "per-axis" else self.across
        size = largest_turn(self.along, across)
        if size == 0.0:
            raise Unreadable("nothing shakes the bristles: their friction at rest has no limit that is known")
        if size >= self.elastic:
            return 0.0
        if across == 0:
            return self.stiffness * (self.elastic - size)
        if self.along == 0:
            return self.stiffness * math.sqrt(self.elastic**2 - size**2)
        raise Unreadable(
            "bristles hold the body on a slow belt: where the curve then starts is known for vibration along "
            "the belt or across it alone"
        )


def largest_turn(along: complex, across: complex) -> float:
    """The largest size that a vector of two harmonic components reaches within a period."""
    if math.inf in (abs(along), abs(across)):
        return math.inf
    squares = abs(along) ** 2 + abs(across) ** 2
    return math.sqrt(0.5 * (squares + abs(along**2 + across**2)))


def hold_of_a_slip(law: BristleLaw, value: Value) -> Hold:
    """Of the bristles of a law per unit of the scene's normal load, whose slip is prescribed."""
    frequency = value("scene.slip.frequency") or value("scene.transverse_slip.frequency")
    along, across = (value(f"scene.{slip}.velocity_amplitude") for slip in ("slip", "transverse_slip"))
    turn = [math.radians(value(f"scene.{slip}.phase")) for slip in ("slip", "transverse_slip")]
    phasors = [
        size / frequency * complex(math.cos(angle), math.sin(angle))
        for size, angle in zip((along, across), turn, strict=True)
    ]
    return _hold(law, phasors[0], phasors[1])


def hold_of_a_body(law: BristleLaw, value: Value, along: complex, across: complex) -> Hold:
    """Of the bristles between belt and body, pushed by two forces: springs and dashpots in parallel to its own."""
    load, omega = value("scene.normal_load"), value("scene.drive.frequency")
    stiffness, damping = load * law.friction(0.0, 1.0, 0.0), load * law.friction(1.0, 0.0, 1.0)
    omega_r = value("scene.transverse.natural_frequency")
    own = (
        (1.0, 2.0 * value("scene.damping_ratio")),
        (omega_r**2, 2.0 * value("scene.transverse.damping_ratio") * omega_r),
    )
    moved = [
        _response(force, complex(spring + stiffness - omega**2, omega * (dashpot + damping)))
        for force, (spring, dashpot) in zip((along, across), own, strict=True)
    ]
    return _hold(law, moved[0], moved[1])


def _response(force: complex, dynamic: complex) -> complex:
    """Of a linear body; without bound at undamped resonance."""
    if force == 0:
        return 0j
    return force / dynamic if dynamic != 0 else complex(math.inf)


def _hold(law: BristleLaw, along: complex, across: complex) -> Hold:
    return Hold(law.elastic_deflection(), along, across, law.friction(0.0, 1.0, 0.0), law.planar)
