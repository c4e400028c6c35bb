"""Mean friction of bristles at vanishing belt speed: elastic shakedown.

A contact may be elastic below a yield deflection: vibration within that range causes no drift, and the slow belt
stretches the bristles until the vibration reaches the end of the range (elastic shakedown). Where bristles drift
under any vibration, or where the vibration leaves the range, the mean friction tends to zero.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from typing import NamedTuple

from frictionlab.laws.memory import BristleLaw
from frictionlab.shape.verdict import UnreadableCurve

Value = Callable[[str], float]
"""Reads a number of a scene by its dotted path; 0 if the scene does not have it."""


class Shakedown(NamedTuple):
    """Elastic bristles and their vibration.

    elastic: deflection up to which they are elastic, 0 for none [scene length]. along, across: phasors of the
    vibration of elastic bristles [scene length]. stiffness: friction coefficient per deflection. planar: of the law.
    """

    elastic: float
    along: complex
    across: complex
    stiffness: float
    planar: str

    def friction(self) -> float:
        """The limit of mean friction at vanishing belt speed under this vibration. Raises UnreadableCurve."""
        across = 0j if self.planar == "per-axis" else self.across
        size = largest_magnitude(self.along, across)
        if size == 0.0:
            raise UnreadableCurve("no vibration: the limit of friction at vanishing belt speed is not known")
        if size >= self.elastic:
            return 0.0
        if across == 0:
            return self.stiffness * (self.elastic - size)
        if self.along == 0:
            return self.stiffness * math.sqrt(self.elastic**2 - size**2)
        raise UnreadableCurve(
            "the body sticks elastically to a slow belt: the start of its curve is known only for vibration along "
            "the belt or across it, not both"
        )


def largest_magnitude(along: complex, across: complex) -> float:
    """The largest magnitude, within a period, of a vector of two harmonic components."""
    if math.inf in (abs(along), abs(across)):
        return math.inf
    squares = abs(along) ** 2 + abs(across) ** 2
    return math.sqrt(0.5 * (squares + abs(along**2 + across**2)))


def shakedown_of_slip(law: BristleLaw, value: Value) -> Shakedown:
    """The shakedown under a prescribed slip; ``law`` is per unit of the scene's normal load."""
    frequency = value("scene.slip.frequency") or value("scene.transverse_slip.frequency")
    along, across = (
        cmath.rect(value(f"{slip}.velocity_amplitude") / frequency, math.radians(value(f"{slip}.phase")))
        for slip in ("scene.slip", "scene.transverse_slip")
    )
    return Shakedown(law.elastic_deflection(), along, across, law.friction(0.0, 1.0, 0.0), law.planar)


def shakedown_of_body(law: BristleLaw, value: Value, along: complex, across: complex) -> Shakedown:
    """The shakedown of a body under two forces: its bristles act in parallel to its springs and dashpots."""
    load, omega = value("scene.normal_load"), value("scene.drive.frequency")
    bristles = law.friction(0.0, 1.0, 0.0)
    stiffness, damping = load * bristles, load * law.friction(1.0, 0.0, 1.0)
    omega_r = value("scene.transverse.natural_frequency")

    def moved(force: complex, spring: float, dashpot: float) -> complex:
        """Displacement phasor of a linear oscillator; infinite at undamped resonance."""
        dynamic = complex(spring + stiffness - omega**2, omega * (dashpot + damping))
        if force == 0:
            return 0j
        return force / dynamic if dynamic != 0 else complex(math.inf)

    phasors = (
        moved(along, 1.0, 2.0 * value("scene.damping_ratio")),
        moved(across, omega_r**2, 2.0 * value("scene.transverse.damping_ratio") * omega_r),
    )
    return Shakedown(law.elastic_deflection(), *phasors, bristles, law.planar)
