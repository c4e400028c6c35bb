"""heyoka's Taylor integrators: with terminal events along the line, in batch mode in the plane, as shipped."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from frictionlab.bench.peers.base import Peer, closed_mean
from frictionlab.bench.peers.equations import start
from frictionlab.bench.peers.scipy_events import LineMotion, MotionState, first_step, means
from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene
from frictionlab.values.quantities import Floats


class Heyoka(Peer):
    """Taylor series with just-in-time compiled derivatives, from the friction-free orbit until the period closes.

    Along the line one scene at a time, each reversal a terminal event; in the plane ``lanes`` belt speeds in
    lockstep (as many as the machine's vectors hold where left out), the friction impulse integrated along.
    Compilation is not timed. Biscani & Izzo, MNRAS 504 (2021) 2614.
    """

    name: ClassVar[str] = "heyoka"
    package: ClassVar[str] = "heyoka"
    together: ClassVar[bool] = True

    lanes: Annotated[int, Field(strict=True, ge=1)] | None = None

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Floats:
        """A curve."""
        mass = scenes[0].mass()
        friction = law.sliding_friction(1.0)
        if scenes[0].load_along_belt_only:
            return means(_line(mass, friction * mass.normal_load, tolerance), scenes, tolerance)
        import heyoka as hy

        speeds = np.array([scene.belt_speed for scene in scenes])
        lanes = self.lanes or int(hy.recommended_simd_size())
        batches = (speeds[i : i + lanes] for i in range(0, len(speeds), lanes))
        return np.concatenate([_plane(mass, friction, each, tolerance, lanes) for each in batches])


class _Line(LineMotion):
    """One integrator for slip, turned round by its own event as long as it does not end in stick; one for stick."""

    def __init__(self, mass: Mass, limit: float, tolerance: float) -> None:
        super().__init__(mass, limit)
        self._slip, self._stick = _slip(mass, limit, tolerance), _stick(mass, limit)

    def slide(self, side: float, start: MotionState) -> tuple[MotionState, float]:
        """Slip, reversals included, until it ends in stick."""
        place = first_step(self, side, start)
        slip = self._slip
        slip.time, slip.state[:], slip.pars[:] = place.t, (place.x, place.v, 0.0), (self.belt_speed, side)
        if place is not start:
            slip.reset_cooldowns()
        slip.propagate_until(self.period)
        x, v, friction_impulse = slip.state.tolist()
        stopped = slip.time < self.period
        end = MotionState(slip.time, x, self.belt_speed if stopped else v)
        return end, self.limit * (friction_impulse + side * (place.t - start.t))

    def hold(self, place: MotionState) -> MotionState:
        stick = self._stick
        stick.time, stick.state[0], stick.pars[0] = place.t, place.x, self.belt_speed
        stick.reset_cooldowns()
        stick.propagate_until(self.period)
        end = stick.time
        return MotionState(end, place.x + self.belt_speed * (end - place.t), self.belt_speed)


_line = lru_cache(maxsize=16)(_Line)  # compiled integrators are kept: a user makes them once for a curve


def _slip(mass: Mass, limit: float, tolerance: float) -> Any:
    """(x, v, time integral of the side); the side of the slip and the belt speed are parameters."""
    import heyoka as hy

    x, v, friction_impulse = hy.make_vars("x", "v", "friction_impulse")
    belt_speed, side = hy.par[0], hy.par[1]
    rate = _wave(mass.force, mass.frequency) - mass.damping * v - x - side * limit
    wave = mass.force, mass.frequency, mass.damping

    def turned(integrator: Any, _direction: int) -> bool:
        """Return the end of slip: slip the other way, or stop where friction can hold the mass."""
        force, frequency, damping = wave
        position, speed = integrator.state[0], integrator.pars[0]
        net = (force * cmath.exp(1j * frequency * integrator.time)).imag - damping * speed - position
        if abs(net) <= limit:
            return False
        integrator.pars[1] = math.copysign(1.0, net)
        return True

    ends = hy.t_event(v - belt_speed, callback=turned)
    system = [(x, v), (v, rate), (friction_impulse, side + 0.0 * x)]
    return hy.taylor_adaptive(system, [0.0] * 3, pars=[0.0] * 2, tol=tolerance, t_events=[ends])


def _stick(mass: Mass, limit: float) -> Any:
    """Stick, at full accuracy: it costs next to nothing."""
    import heyoka as hy

    x = hy.make_vars("x")
    net = _wave(mass.force, mass.frequency) - mass.damping * hy.par[0] - x
    up = hy.t_event(net - limit, direction=hy.event_direction.positive)
    down = hy.t_event(net + limit, direction=hy.event_direction.negative)
    return hy.taylor_adaptive([(x, hy.par[0] + 0.0 * x)], [0.0], pars=[0.0], t_events=[up, down])


def _wave(force: complex, frequency: float) -> Any:
    """Im(force exp(i frequency t))."""
    import heyoka as hy

    angle = frequency * hy.time
    wave = force.real * hy.sin(angle)
    return wave + force.imag * hy.cos(angle) if force.imag else wave


def _plane(mass: Mass, friction: float, speeds: Floats, tolerance: float, lanes: int) -> Floats:
    """Some belt speeds in lockstep until each period closes; lanes left over repeat the last speed."""
    integrator = _batch(mass, friction, tolerance, lanes)
    integrator.pars[0] = np.append(speeds, np.full(lanes - len(speeds), speeds[-1]))
    period = 2.0 * math.pi / mass.frequency

    def one_period(state: Floats) -> Floats:
        integrator.set_time(0.0)
        integrator.state[:] = state
        integrator.propagate_until(period)
        return integrator.state.copy()

    state = np.repeat(np.array([*start(mass), 0.0])[:, None], lanes, axis=1)
    enough = tolerance * mass.normal_load * period
    return closed_mean(one_period, state, slice(0, 4), period, enough)[: len(speeds)]


@lru_cache(maxsize=16)
def _batch(mass: Mass, friction: float, tolerance: float, lanes: int) -> Any:
    """Return the belt speed is a parameter of each lane."""
    import heyoka as hy

    loads = _wave(mass.force, mass.frequency), _wave(mass.transverse_force, mass.frequency)
    system = plane_system(mass, friction, hy.par[0], loads)
    zeros = np.zeros((5, lanes))
    return hy.taylor_adaptive_batch(system, zeros, pars=np.zeros((1, lanes)), tol=tolerance)


def plane_system(mass: Mass, friction: float, belt_speed: Any, loads: tuple[Any, Any]) -> Any:
    """Rates of x1, v1, x2, v2 and the integral of the friction coefficient along x1; numbers may be parameters."""
    import heyoka as hy

    x1, v1, x2, v2, friction_impulse = hy.make_vars("x1", "v1", "x2", "v2", "friction_impulse")
    slip, m = v1 - belt_speed, mass
    rub = friction * (slip * slip + v2 * v2) ** -0.5
    a1 = loads[0] - m.damping * v1 - x1 - m.normal_load * rub * slip
    a2 = loads[1] - m.transverse_damping * v2 - m.transverse_stiffness * x2 - m.normal_load * rub * v2
    return [(x1, v1), (v1, a1), (x2, v2), (v2, a2), (friction_impulse, rub * slip)]
