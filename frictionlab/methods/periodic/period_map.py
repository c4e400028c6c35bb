"""One span of any law's motion as a map of state vectors, whichever map follows it.

A state is a vector in the norm of energy: sqrt(stiffness)*y and u along x1, then along x2, then the deflection of a
bristle times sqrt(normal_load*stiffness). In it no two orbits of a monotone law without memory move apart (Leine &
van de Wouw, 2008), which turns a distance of states into a bound on the mean friction.
"""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, by_law
from frictionlab.compile.stack import room
from frictionlab.dynamics.motion import belt_velocity, instant_at, span
from frictionlab.methods.periodic.maps.deflection import coarsest, deflection_map
from frictionlab.methods.periodic.maps.memory import begun, coarsest_of_memory, follow, grain_of_memory
from frictionlab.methods.periodic.maps.memory_rates import work_of
from frictionlab.methods.periodic.maps.memory_state import (
    filled,
    kept,
    memory_of,
    parts,
    pulled,
    recalled,
    scales_of,
    slid,
    spilled,
)
from frictionlab.methods.periodic.maps.path import Carried, path_map
from frictionlab.methods.periodic.maps.sliding import Mapped, sliding_map
from frictionlab.methods.periodic.maps.stick import periods_at_rest
from frictionlab.numerics.vectors import dimension, taken
from frictionlab.orbit.recorder import Track
from frictionlab.scene.body import Body


def _pack_line(body: Body, state: Any, y: float, u: float) -> None:
    state[0], state[1] = math.sqrt(body.stiffness_mean) * y, u


def _pack_plane(body: Body, state: Any, y: complex, u: complex) -> None:
    state[0], state[1] = math.sqrt(body.stiffness_mean + body.stiffness_split) * y.real, u.real
    state[2], state[3] = math.sqrt(body.stiffness_mean - body.stiffness_split) * y.imag, u.imag


pack = by_dimension(_pack_line, _pack_plane)


def _unpack_line(body: Body, state: Any, like: float) -> Any:
    return state[0] / math.sqrt(body.stiffness_mean), state[1]


def _unpack_plane(body: Body, state: Any, like: complex) -> Any:
    y = complex(
        state[0] / math.sqrt(body.stiffness_mean + body.stiffness_split),
        state[2] / math.sqrt(body.stiffness_mean - body.stiffness_split),
    )
    return y, complex(state[1], state[3])


unpack = by_dimension(_unpack_line, _unpack_plane)


def _size_without_memory(law: Any, like: Any) -> int:
    return 2 * dimension(like)


def _size_with_a_bristle(law: Any, like: Any) -> int:
    return 3 * dimension(like)


def _size_with_memory(law: Any, like: Any) -> int:
    memory = memory_of(law, like)
    return 2 * dimension(like) + memory.size * parts(memory[0])


size_of = by_law(_size_without_memory, _size_with_a_bristle, None, _size_with_memory)

coarsest_of = by_law(coarsest, coarsest, None, coarsest_of_memory)
"""(law, body): the coarsest accuracy a map is made with, whatever is asked."""


def _no_grain(law: Any, body: Body, accuracy: float, like: Any) -> float:
    return 0.0


grain_of = by_law(_no_grain, _no_grain, None, grain_of_memory)
"""What the steps of a map leave in the mean even if two maps agree."""


@inner
def bristle_unit(law: Any, body: Body) -> float:
    """Square root of the contact's stiffness about the undeflected bristle: what a deflection is multiplied by."""
    length = law.largest_deflection()
    length = length if length < 1e300 else 1.0
    return math.sqrt(body.normal_load * abs(law.friction(0.0, length, 0.0)) / length)


def _deflection_on_the_line(state: Any, unit: float, like: float) -> float:
    return state[2] / unit


def _deflection_in_the_plane(state: Any, unit: float, like: complex) -> complex:
    return complex(state[4], state[5]) / unit


deflection = by_dimension(_deflection_on_the_line, _deflection_in_the_plane)


def _store_on_the_line(state: Any, unit: float, z: float) -> None:
    state[2] = unit * z


def _store_in_the_plane(state: Any, unit: float, z: complex) -> None:
    state[4], state[5] = unit * z.real, unit * z.imag


store = by_dimension(_store_on_the_line, _store_in_the_plane)


@inner
def _carried_by_steps(
    law: Any, body: Body, belt_speed: float, y: Any, u: Any, z: Any, accuracy: float, track: Track
) -> Carried:
    memory = room(law, 1, 0, z)
    memory[0] = z
    image = deflection_map(law, body, belt_speed, y, u, memory, accuracy, track)
    return Carried(image.y, image.u, memory[0], image.rubbed, image.closest, image.steps)


carried = by_law(_carried_by_steps, _carried_by_steps, path_map)
"""The map of a bristle law: by the way slid on the line where that says all, else mass and deflection together."""


def _mapped_without_memory(
    law: Any,
    body: Body,
    belt_speed: float,
    state: Any,
    residual: Any,
    accuracy: float,
    track: Track,
    like: Any,
) -> Mapped:
    y, u = unpack(body, state, like)
    image = sliding_map(law, body, belt_speed, y, u, accuracy, track)
    pack(body, residual, image.y - y, image.u - u)
    return image


def _mapped_with_a_bristle(
    law: Any,
    body: Body,
    belt_speed: float,
    state: Any,
    residual: Any,
    accuracy: float,
    track: Track,
    like: Any,
) -> Mapped:
    y, u = unpack(body, state, like)
    unit = bristle_unit(law, body)
    z = deflection(state, unit, like)
    image = carried(law, body, belt_speed, y, u, z, accuracy, track)
    pack(body, residual, image.y - y, image.u - u)
    store(residual, unit, image.z - z)
    return Mapped(image.y, image.u, image.rubbed, 0.0, image.closest, -1.0, image.steps)


def _mapped_with_memory(
    law: Any,
    body: Body,
    belt_speed: float,
    state: Any,
    residual: Any,
    accuracy: float,
    track: Track,
    like: Any,
) -> Mapped:
    y, u = unpack(body, state, like)
    scales, work, d = scales_of(law, body, like), work_of(law, body, like), dimension(like)
    begun(body, belt_speed, y, u, work)
    recalled(work.memory, law, scales, state, 2 * d, work.memory[0])
    pulled(law, work.memory, work.moving)
    spilled(work.memory, work.at, 3 * d, work.memory[0])
    closest, steps = follow(law, body, belt_speed, scales, accuracy, track, work, like)
    end_y = taken(work.at, 0, like)
    now = instant_at(body, span(body))
    end_u = taken(work.at, 1, like) + belt_velocity(body, belt_speed, now)
    end_u = end_u - body.frequency * body.reference_sine
    filled(work.memory, work.at, 3 * d, work.memory[0])
    kept(work.memory, law, scales, residual, 2 * d, work.memory[0])
    pack(body, residual, end_y - y, end_u - u)
    for row in range(2 * d, residual.size):
        residual[row] = residual[row] - state[row]
    return Mapped(end_y, end_u, taken(work.at, 2, like), 0.0, closest, -1.0, steps)


def _mapped_with_deflections(
    law: Any,
    body: Body,
    belt_speed: float,
    state: Any,
    residual: Any,
    accuracy: float,
    track: Track,
    like: Any,
) -> Mapped:
    y, u = unpack(body, state, like)
    scales, z, d = scales_of(law, body, like), memory_of(law, like), dimension(like)
    recalled(z, law, scales, state, 2 * d, z[0])
    pulled(law, z, memory_of(law, like))
    image = deflection_map(law, body, belt_speed, y, u, z, accuracy, track)
    kept(z, law, scales, residual, 2 * d, z[0])
    pack(body, residual, image.y - y, image.u - u)
    for row in range(2 * d, residual.size):
        residual[row] = residual[row] - state[row]
    return image


period_map = by_law(
    _mapped_without_memory,
    _mapped_with_a_bristle,
    None,
    _mapped_with_memory,
    None,
    _mapped_with_deflections,
)
"""One span from a state, noted on a track with room; leaves image - state in residual."""


def _rest_without_memory(law: Any, body: Body, belt_speed: float, y: Any) -> float:
    return periods_at_rest(law, body, belt_speed, y)


def _rest_with_a_bristle(law: Any, body: Body, belt_speed: float, y: Any) -> float:
    """A bristle is never quite at rest."""
    return 1.0


rest_of = by_law(_rest_without_memory, _rest_with_a_bristle, None, _rest_with_a_bristle)
"""How many whole periods, at least one, a mass at rest at tau = 0 is sure to be carried on without slip."""


def _remember_nothing(law: Any, body: Body, state: Any, z: Any) -> None:
    """A law without memory."""


def _remember_a_deflection(law: Any, body: Body, state: Any, z: Any) -> None:
    store(state, bristle_unit(law, body), z)


def _remember_sliding(law: Any, body: Body, state: Any, z: Any) -> None:
    """The memory of steady sliding at slip velocity z."""
    memory = memory_of(law, z)
    slid(law, body, memory, z)
    kept(memory, law, scales_of(law, body, z), state, 2 * dimension(z), memory[0])


remember = by_law(_remember_nothing, _remember_a_deflection, None, _remember_sliding)


@inner
def start_of(law: Any, body: Body, state: Any, x: Any, v: Any, z: Any) -> None:
    """The state of a mass at x moving at v at tau = 0, its bristle, if there is one, deflected by z.

    With another memory, z is the velocity of steady sliding that it remembers.
    """
    pack(body, state, x - body.reference_cosine, v - body.frequency * body.reference_sine)
    remember(law, body, state, z)
