"""A slip that is prescribed, by the angle of its period: velocity, way and slip; on the line and in the plane."""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension
from frictionlab.dynamics.motion import belt_path, instant_at, slip
from frictionlab.scene.body import Motion


def _wave_on_the_line(motion: Motion, turn: complex, like: float) -> float:
    return (motion.velocity * turn).imag


def _wave_in_the_plane(motion: Motion, turn: complex, like: complex) -> complex:
    return complex((motion.velocity * turn).imag, (motion.transverse_velocity * turn).imag)


_wave = by_dimension(_wave_on_the_line, _wave_in_the_plane)


@inner
def velocity_at_angle(motion: Motion, angle: float, like: Any) -> Any:
    """The velocity of the mass; like: a number of its kind."""
    return _wave(motion, complex(math.cos(angle), math.sin(angle)), like)


@inner
def position_at_angle(motion: Motion, angle: float, like: Any) -> Any:
    """Its integral over time."""
    return _wave(motion, complex(math.sin(angle), -math.cos(angle)), like) / motion.frequency


@inner
def slip_at_angle(motion: Motion, belt_speed: float, angle: float, like: Any) -> Any:
    """The slip velocity."""
    now = instant_at(motion, angle / motion.frequency)
    return slip(motion, belt_speed, now, velocity_at_angle(motion, angle, like))


@inner
def path_between(motion: Motion, belt_speed: float, start: float, end: float, like: Any) -> Any:
    """The way slid from one angle to another."""
    carried = belt_path(motion, belt_speed, start / motion.frequency, end / motion.frequency)
    return position_at_angle(motion, end, like) - position_at_angle(motion, start, like) - carried
