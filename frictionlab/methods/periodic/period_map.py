"""One span of any law's motion as a map of state vectors, whichever map follows it.

A state is a vector in the norm of energy: sqrt(stiffness)*y and u along x1, then along x2, then what the law
remembers: a deflection times sqrt(normal_load*stiffness). In it no two orbits of a monotone law without memory move
apart (Leine & van de Wouw, 2008), which turns a distance of states into a bound on the mean friction.

The kinds of period maps, by what a law remembers: how fine each is, and what is said of it.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, by_law, by_scalars
from frictionlab.compile.stack import count_of
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.words import ModelWord
from frictionlab.motion.linalg import dimension, norm
from frictionlab.motion.maps.case import Case, Stepping
from frictionlab.motion.maps.memory import coarsest, memory_map
from frictionlab.motion.maps.memory_state import (
    coordinates,
    cut_back,
    measure_scales,
    pack_memory,
    remember_sliding,
    unpack_memory,
)
from frictionlab.motion.maps.path import path_map
from frictionlab.motion.maps.rates import MEMORY, workspace
from frictionlab.motion.maps.sliding import Mapped, sliding_map
from frictionlab.motion.maps.stick import periods_at_rest
from frictionlab.scene.body import BodyNumbers


class MapKind(NamedTuple):
    """Facts of a kind of map.

    said: of how it is computed, in ``model``. rough: accuracy of the maps that follow a transient: with memory they
    are of lower order. finest: tolerance on the mean of maps that are differentiated; noise: what steps chosen
    otherwise change in them, relative to the size of a state.
    """

    said: str
    rough: float
    finest: float = 1e-10
    noise: float = 2e-12


_OF_MEMORY = MapKind(ModelWord.WITH_MEMORY, rough=1e-7)
MAP_KINDS = {
    "none": MapKind("", 1e-9, finest=1e-12, noise=1e-14),
    "exact path": MapKind(ModelWord.SLIP_PATH, 1e-6, finest=1e-12, noise=1e-14),
    "bristle": MapKind(ModelWord.WITH_BRISTLE, rough=1e-6),
    "deflections": _OF_MEMORY,
    "scalars": _OF_MEMORY,
}
"""By the kind of memory, and that of a bristle whose deflection the slip path tells."""


def map_kind(law: FrictionLaw, planar: bool) -> str:
    """Return which period map serves a law: that of an exact path along a line, else that of its kind of memory."""
    exact = not planar and isinstance(law, BristleLaw) and law.exact_path()
    return "exact path" if exact else law.memory_kind


def _pack_line(body: BodyNumbers, state: Any, y: float, u: float) -> None:
    state[0], state[1] = math.sqrt(body.stiffness_mean) * y, u


@inner
def planar_coordinates(body: BodyNumbers, y: Any, u: Any) -> Any:
    """A planar position and velocity in the norm of energy."""
    along, across = body.stiffness_mean + body.stiffness_split, body.stiffness_mean - body.stiffness_split
    return math.sqrt(along) * y.real, u.real, math.sqrt(across) * y.imag, u.imag


def _pack_plane(body: BodyNumbers, state: Any, y: complex, u: complex) -> None:
    state[0], state[1], state[2], state[3] = planar_coordinates(body, y, u)


pack = by_dimension(_pack_line, _pack_plane)


def _unpack_plane(body: BodyNumbers, state: Any, zero: complex) -> Any:
    y = complex(
        state[0] / math.sqrt(body.stiffness_mean + body.stiffness_split),
        state[2] / math.sqrt(body.stiffness_mean - body.stiffness_split),
    )
    return y, complex(state[1], state[3])


unpack = by_dimension(
    lambda body, state, zero: (state[0] / math.sqrt(body.stiffness_mean), state[1]), _unpack_plane
)


def _size_with_memory(law: Any, zero: Any) -> int:
    return 2 * dimension(zero) + coordinates(law, zero)


@inner
def size_of_deviation(normal_load: float, state: Any) -> float:
    """Size of a state, which tells how far friction of this load moves the mass off the friction-free motion."""
    return min(1.0, normal_load) + norm(state)


size_of = by_law(lambda law, zero: 2 * dimension(zero), _size_with_memory, _size_with_memory)
"""size_of(law, zero): how many numbers a state is."""

coarsest_of = coarsest
"""(law, body): the coarsest accuracy a map is made with, whatever is asked."""


def _nothing_hidden(law: Any, body: BodyNumbers, zero: Any) -> Any:
    return 0.0, 0.0


def _hidden_error_of_memory(law: Any, body: BodyNumbers, zero: Any) -> Any:
    """Return the error of a yield within a step, and that of the sum of the errors of all steps."""
    work, most = workspace(law, zero, body.varying.keeps_stiffness), 0.0
    measure_scales(law, body, work, zero)
    if law.turning > 0.0:
        for k in range(count_of(law)):
            most = max(most, work.unit[k])
    return 2.0 * most, 10.0


hidden_error_of = by_law(_nothing_hidden, _nothing_hidden, _hidden_error_of_memory)
"""hidden_error_of(law, body, zero): error of the mean that comparing two maps cannot reveal, per accuracy over the
normal load: a constant part, and a part that is divided by the span."""


def _smallest_unit(law: Any, body: BodyNumbers, zero: Any) -> float:
    work, least = workspace(law, zero, body.varying.keeps_stiffness), 1e300
    measure_scales(law, body, work, zero)
    for k in range(count_of(law)):
        least = min(least, work.unit[k])
    return least


unit_of_scalars = by_scalars(lambda law, body, zero: 1e300, _smallest_unit)
"""unit_of_scalars(law, body, zero): the smallest by which a coordinate of a scalar is measured; 1e300 for none."""


# --- the map --------------------------------------------------------------------------------------------------------


def _image_without_memory(case: Case, state: Any, residual: Any, stepping: Stepping) -> Mapped:
    """Its steps are not kept."""
    y, u = unpack(case.body, state, case.zero)
    image = sliding_map(case, y, u, stepping.accuracy, stepping.track)
    pack(case.body, residual, image.y - y, image.u - u)
    return image


def _image_with_memory(case: Case, state: Any, residual: Any, stepping: Stepping) -> Mapped:
    law, body, zero = case.law, case.body, case.zero
    y, u = unpack(body, state, zero)
    work = workspace(law, zero, body.varying.keeps_stiffness)
    measure_scales(law, body, work, zero)
    unpack_memory(law, body, work, state, zero)
    cut_back(law, work)
    image = memory_map(case, y, u, work, stepping)
    pack(body, residual, image.y - y, image.u - u)
    pack_memory(law, body, work, residual, zero)
    for row in range(2 * dimension(zero), residual.size):
        residual[row] = residual[row] - state[row]
    return image


@inner
def image_by_path(case: Case, state: Any, residual: Any, stepping: Stepping) -> Mapped:
    """``paced_image`` of a bristle on the line whose deflection the path of the slip tells."""
    law, body, zero = case.law, case.body, case.zero
    y, u = unpack(body, state, zero)
    work = workspace(law, zero, body.varying.keeps_stiffness)
    measure_scales(law, body, work, zero)
    unpack_memory(law, body, work, state, zero)
    z = work.start[MEMORY]
    image = path_map(case, y, u, z, stepping)
    there = (zero, zero) if body.prescribed else (image.y, image.u)  # of a motion that only measures errors
    pack(body, residual, there[0] - y, there[1] - u)
    residual[2] = work.unit[0] * (image.z - z)
    return Mapped(there[0], there[1], image.friction_impulse, 0.0, image.closest, -1.0, image.steps)


paced_image = by_law(_image_without_memory, _image_with_memory, _image_with_memory)
"""paced_image(case, state, residual, stepping): one span from a state, noted on a track with room, its steps kept or
repeated; leaves image - state in residual.

steps is -1 where it gave up, or where the events of this state are not those of the steps repeated."""


def _rest_with_a_bristle(law: Any, body: BodyNumbers, belt_speed: float, y: Any) -> float:
    """A bristle is never quite at rest."""
    return 1.0


rest_of = by_law(periods_at_rest, _rest_with_a_bristle, _rest_with_a_bristle)
"""Count of whole periods, at least one, for which a mass at rest at tau = 0 is sure to be carried on without slip."""


def _remember_a_deflection(law: Any, body: BodyNumbers, state: Any, z: Any) -> None:
    work = workspace(law, z, body.varying.keeps_stiffness)
    measure_scales(law, body, work, z)
    work.start[MEMORY] = z
    pack_memory(law, body, work, state, z)


def _remember_sliding(law: Any, body: BodyNumbers, state: Any, z: Any) -> None:
    """Write the memory of steady sliding at slip velocity z."""
    work = workspace(law, z, body.varying.keeps_stiffness)
    measure_scales(law, body, work, z)
    remember_sliding(law, body, work, z)
    pack_memory(law, body, work, state, z)


remember = by_law(
    # a law without memory
    lambda law, body, state, z: None,
    _remember_a_deflection,
    _remember_sliding,
)


@inner
def start_of(law: Any, body: BodyNumbers, state: Any, x: Any, v: Any, z: Any) -> None:
    """Write the state of a mass at x moving at v at tau = 0, its bristle, if there is one, deflected by z.

    With another memory, z is the velocity of steady sliding that it remembers.
    """
    pack(body, state, x - body.reference_cosine, v - body.frequency * body.reference_sine)
    remember(law, body, state, z)
