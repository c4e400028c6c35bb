"""numbalsoda's LSODA on a mass on bristles: integrator and equations of motion both compiled."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from frictionlab.bench.peers.base import ClosureTest, Peer, closed_mean
from frictionlab.bench.peers.equations import LEAST_RTOL, start
from frictionlab.compile.cache import compiled
from frictionlab.compile.decorators import njit
from frictionlab.compile.dispatch import by_dimension
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import bristle_in_the_plane, bristle_on_the_line
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene
from frictionlab.values.quantities import Floats

compiled_resistance = by_dimension(bristle_on_the_line, bristle_in_the_plane)
MOST_LSODA_STEPS = 10_000_000
"""Per period: the default of 10,000 is too few for stiff bristles."""


class Numbalsoda(Peer):
    """numbalsoda on bristle laws, from the friction-free orbit with bristles at rest until the period closes.

    rtol and atol are the tolerance; one atol holds for the whole state, so the deflection is carried in deflections
    of steady slip where that is small.
    """

    name: ClassVar[str] = "numbalsoda"
    package: ClassVar[str] = "numbalsoda"
    remedy: ClassVar[str] = "pip install numbalsoda, which needs a Fortran compiler"

    def other_law(self, law: FrictionLaw) -> str | None:
        """Everything but bristle laws."""
        return None if law.memory_kind == "bristle" else "numbalsoda is set up for bristle laws"

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Floats:
        """One scene after the other."""
        mass = scenes[0].mass()
        ready: Any = law.under_load(mass.normal_load)
        reach = min(1.0, ready.sliding_friction(0.0) / ready.bristle_stiffness)
        system = _system(ready, not scenes[0].load_along_belt_only)
        return np.array([_settled(system, mass, scene.belt_speed, reach, tolerance) for scene in scenes])


def _settled(system: _System, mass: Mass, belt_speed: float, reach: float, tolerance: float) -> Floats:
    from numbalsoda import lsoda

    x1, v1, x2, v2 = start(mass)
    state = np.array([x1, v1, x2, v2, 0.0, 0.0, 0.0] if system.planar else [x1, v1, 0.0, 0.0])
    places = slice(0, 4) if system.planar else slice(0, 2)
    period = 2.0 * math.pi / mass.frequency
    closing, times = ClosureTest(tolerance, mass.normal_load, period), np.array([0.0, period])
    data = np.array([*_real(mass), belt_speed, reach])

    def one_period(start: Floats) -> Floats:
        limits = max(tolerance, LEAST_RTOL), tolerance, MOST_LSODA_STEPS
        found, fine = lsoda(system.address, start, times, data, *limits)
        if not fine:
            raise ArithmeticError("numbalsoda gave up")
        return found[-1]

    return closed_mean(one_period, state, places, closing, period)


def _real(mass: Mass) -> list[float]:
    """The numbers of a mass, each force as its sine and cosine part."""
    forces = mass.force, mass.transverse_force
    return [
        *(float(part) for part in mass[:6]),
        *(part for force in forces for part in (force.real, force.imag)),
    ]


class _System:
    """The equations of motion of one law as C sees them, and whether they are in the plane."""

    def __init__(self, law: FrictionLaw, planar: bool) -> None:
        import numba
        from numbalsoda import lsoda_sig

        c: Any = numba  # whose published types leave these two out

        entry: Any = compiled(_in_the_plane if planar else _on_the_line, law)
        rates, (numbers,), size = entry.entry, entry.bound, 7 if planar else 4

        def called(t: Any, state: Any, rate: Any, data: Any) -> None:
            rates(
                numbers,
                t,
                c.carray(state, (size,)),
                c.carray(rate, (size,)),
                c.carray(data, (12,)),
            )

        self._kept = c.cfunc(lsoda_sig)(called)
        self.address, self.planar = self._kept.address, planar


@lru_cache(maxsize=16)
def _system(law: FrictionLaw, planar: bool) -> _System:
    return _System(law, planar)


@njit
def _on_the_line(law: Any, t: float, state: Floats, rate: Floats, data: Floats) -> None:
    turn, slip = data[5] * t, state[1] - data[10]
    dz, rub = compiled_resistance(law, slip, state[2] * data[11])
    load = data[6] * math.sin(turn) + data[7] * math.cos(turn)
    rate[0], rate[1] = state[1], load - data[0] * state[1] - data[1] * state[0] - data[4] * rub
    rate[2], rate[3] = dz / data[11], rub


@njit
def _in_the_plane(law: Any, t: float, state: Floats, rate: Floats, data: Floats) -> None:
    turn = data[5] * t
    sine, cosine = math.sin(turn), math.cos(turn)
    slip = complex(state[1] - data[10], state[3])
    dz, rub = compiled_resistance(law, slip, complex(state[4], state[5]) * data[11])
    load, across = data[6] * sine + data[7] * cosine, data[8] * sine + data[9] * cosine
    rate[0], rate[1] = state[1], load - data[0] * state[1] - data[1] * state[0] - data[4] * rub.real
    rate[2], rate[3] = state[3], across - data[2] * state[3] - data[3] * state[2] - data[4] * rub.imag
    rate[4], rate[5], rate[6] = dz.real / data[11], dz.imag / data[11], rub.real
