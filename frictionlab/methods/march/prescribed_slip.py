"""A slip that is prescribed, by the angle of its period: velocity, way and slip; on the line and in the plane.

A sine is the motion of the mass. For any other waveform the mass stays where it is and the belt goes the other way:
``motion`` is then a Body with such a belt (methods/prescribed/memory.py), as a piece between corners has it.
"""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, by_variation
from frictionlab.dynamics.motion import belt_path, instant_at, normal_load, piece_ends, slip
from frictionlab.scene.body import Motion


def _wave_on_the_line(motion: Motion, turn: complex, like: float) -> float:
    return (motion.velocity * turn).imag


def _wave_in_the_plane(motion: Motion, turn: complex, like: complex) -> complex:
    return complex((motion.velocity * turn).imag, (motion.transverse_velocity * turn).imag)


_wave = by_dimension(_wave_on_the_line, _wave_in_the_plane)


def _velocity_of_sine(motion: Motion, angle: float, like: Any) -> Any:
    return _wave(motion, complex(math.cos(angle), math.sin(angle)), like)


def _position_of_sine(motion: Motion, angle: float, like: Any) -> Any:
    return _wave(motion, complex(math.sin(angle), -math.cos(angle)), like) / motion.frequency


def _unmoved(motion: Any, angle: float, like: Any) -> Any:
    return 0.0 * like


velocity_at_angle = by_variation(_velocity_of_sine, _unmoved)
"""velocity_at_angle(motion, angle, like): the velocity of the mass; like: a number of its kind."""

position_at_angle = by_variation(_position_of_sine, _unmoved)
"""position_at_angle(motion, angle, like): its integral over time."""


def _whole_turn(motion: Motion, k: int) -> Any:
    return 0.0, 2.0 * math.pi


def _turn_between_corners(motion: Any, k: int) -> Any:
    begins, ends = piece_ends(motion, k)
    return motion.frequency * begins, motion.frequency * (ends - begins)


piece_angles = by_variation(_whole_turn, _turn_between_corners)
"""piece_angles(motion, k): the angle at which the k-th piece begins, and how far it goes on."""


def _one_turn(motion: Motion) -> float:
    return 2.0 * math.pi


def _turns(motion: Any) -> float:
    return 2.0 * math.pi * motion.periods


whole_angle = by_variation(_one_turn, _turns)
"""whole_angle(motion): of a period of everything."""


@inner
def load_at_angle(motion: Any, angle: float) -> float:
    """The normal load."""
    return normal_load(motion, instant_at(motion, angle / motion.frequency))


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
