"""What becomes of an undriven mass in the long run, as every way to follow it tells it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats

TURN = 2.0 * math.pi
"""The period of the free mass."""
COMES_TO_REST = "at rest, where the motion from scene.initial ends"
SLIDES = "steady sliding, which attracts"
SLIDES_FREELY = "a free oscillation in slip, which does not decay without damping"


class PeriodicMotion(NamedTuple):
    """A periodic motion from a state: its period, mean friction, error and largest multiplier, and what it is."""

    state: Floats
    period: float
    mean: float
    error: float
    multiplier: float
    kind: str


@dataclass
class Effort:
    """What following a motion has taken so far [steps], how far it has led [turns], and kernel time [s]."""

    work: int = 0
    turns: float = 0.0
    seconds: float = 0.0


class NotFound(Exception):
    """No periodic motion; the message says why."""


class Follower(Protocol):
    """An undriven scene and a law, followed through time."""

    @property
    def effort(self) -> Effort: ...
    def motion(self) -> PeriodicMotion:
        """The motion reached from the start. Raises NotFound."""

    def orbit(self, motion: PeriodicMotion) -> Orbit:
        """The orbit of the motion; of one that stands still, over 2 pi."""
