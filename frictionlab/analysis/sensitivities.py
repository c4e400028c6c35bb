"""How much the mean friction changes with each number of a scene and of a law.

One period of a scene and a law from a given state: the state that it leaves, and the mean friction meanwhile.

A steady state is a fixed point z = P(z, p) of the period map, and the mean friction m(z, p) is one number of the same
period. By the implicit function theorem dm/dp = m_p + m_z (I - P_z)^-1 P_p. The four derivatives are difference
quotients of one period from the fixed point, which no steady state needs to be found for.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from frictionlab.analysis.quotients import CORNER, MAPS_PER_TRY, Derivative, Pair, asked_for, derivative
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.base import NOT_UNIQUE, Method, in_length, own_length
from frictionlab.methods.periodic.continuation import FINE
from frictionlab.methods.periodic.period_map import MAP_KINDS, map_kind
from frictionlab.methods.periodic.problem import PeriodicProblem, along_the_belt
from frictionlab.runner.arguments import given_law, given_method, given_scene
from frictionlab.runner.state import SteadyState
from frictionlab.runner.steady_state import steady_state
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.study.grid import law_in_scene
from frictionlab.values.quantities import Floats

_WITH_ONE_DEFLECTION = 3
"""Numbers of a state on the line: position, velocity, deflection."""


class OnePeriod(NamedTuple):
    """The period map of a scene and a law; kind: of the map."""

    problem: PeriodicProblem
    scene: Scene
    law: FrictionLaw  # in the lengths and times of the scene
    length: float  # of the scene's own: the unit in which scene and law are

    @classmethod
    def of(cls, scene: Scene, law: FrictionLaw, length: float | None = None) -> OnePeriod:
        """Return that of a driven mass; length: the unit in which others have their states."""
        given = Scenes.of([scene])
        length = length or own_length(given)
        measured, inside = in_length(given, law_in_scene(law, scene), length)
        kind = map_kind(inside, not along_the_belt(measured[0], inside))
        problem = PeriodicProblem(measured[0], inside, MAP_KINDS[kind].finest)
        return cls(problem, measured[0], inside, length)

    def like(self, other: OnePeriod) -> bool:
        """Whether states of the other are states of this one, followed by the same map."""
        mine, theirs = ((one.problem.size, one.problem.kind, one.law.structure()) for one in (self, other))
        return mine == theirs

    def noise(self, z: Floats) -> Floats:
        """By how much state and mean friction jump where steps are chosen otherwise."""
        relative = MAP_KINDS[self.problem.kind].noise
        return np.append(np.full(z.size, relative * (1.0 + float(np.linalg.norm(z)))), relative)

    def drift(self, z: Floats) -> Floats:
        """By how much steps leave them wrong: what varies as slowly as they do themselves."""
        load = self.problem.body.normal_load
        return np.append(np.full(z.size, FINE * load), self.problem.goal.tolerance)

    def closed(self) -> Floats | None:
        """The state of the closed orbit, as well as the search finds it; None where it finds none."""
        for way in filter(None, (self.problem, self.problem.by_implicit_steps)):
            curve, _ = way.close([self.scene])
            if curve.closed.found[0]:
                return np.array(curve.states[0])
        return None

    def from_states(self, states: Floats) -> Floats:
        """From each of states [n, size] the state a period later and the mean friction along x1 [n, size + 1]."""
        ends, means = self.problem.repeated_once(self.scene, self._yielding(states))
        return np.column_stack((ends, means))

    def _yielding(self, states: Floats) -> Floats:
        """The states with deflections cut back to the yield of a slider: on the line no slip leads beyond."""
        law = self.law
        if not isinstance(law, BristleLaw) or states.shape[1] != _WITH_ONE_DEFLECTION:
            return states
        reach = law.yield_deflection()
        if not np.isfinite(reach):
            return states
        # as states have it: a deflection times sqrt(normal_load*stiffness)
        most = np.sqrt(self.problem.body.normal_load * abs(law.friction(0.0, reach, 0.0)) * reach)
        return np.column_stack((states[:, :2], np.clip(states[:, 2:], -most, most)))


_FEW_PARTS = 0.02
"""Of the size of a state or of a parameter: the first offset of difference quotients."""
_RADIAN = 57.3
"""The size of a phase [degrees]."""
_NEARLY_SINGULAR = 1e6
"""Norm of (I - P_z)^-1 above which a steady state is about to be lost."""
_AGREES = 1e-6
"""How far the mean of the closed orbit may be from that of the method."""
_PRESCRIBED = "the slip is prescribed: no mass moves that a period map could follow"
_UNDRIVEN = "the scene is undriven: its period is no number that is given"
_NO_MAP = "no period map follows a body that remembers: give one of springs and dashpots"
_RESTS = "the mass rests on the belt"
_OTHER_ORBIT = "the period map closes another orbit than the one of this steady state"
_LOST = "the steady state is about to be lost: a multiplier of the period map is close to +1"
_BENDS = "the period map bends too sharply here: no offset is small enough for a derivative"
_BLUNT = 0.05
"""Error of a derivative that is none, of the derivative or of the mean over the parameter."""
_COLUMNS = "parameter", "value", "derivative", "error", "elasticity", "reason"


_TURNS = 0.0, 50.0, 115.0, 205.0
"""Angles of the drive [degrees] at which a period is begun, the next where the map has a corner at the one before."""


class _Refused(Exception):
    """Why no derivative of this steady state is given."""


class _Corner(Exception):
    """Why the period map has no derivative by the state at this angle, and the periods followed to see it."""


class _AtFixedPoint(NamedTuple):
    """A closed orbit: its state z, what a period makes of it, P_z and m_z with errors; maps: periods followed."""

    pair: Pair
    turn: float  # of the drive at the beginning of the period [degrees]
    one: OnePeriod
    z: Floats
    image: Floats
    by_state: Floats  # P_z - I above, m_z below
    error: Floats
    maps: int


def sensitivities(
    scene: Scene,
    law: FrictionLaw,
    parameters: Sequence[str] | None = None,
    method: str | Method = "auto",
    tolerance: float = 1e-8,
) -> pd.DataFrame:
    """Compute derivatives of the mean friction by numbers of a scene and a law.

    The steady state is found by ``method``; the derivatives are those of the period map.

    Parameters
    ----------
    scene : Scene
        Body and belt, and what shakes them.
    law : FrictionLaw
        Law of friction.
    parameters : list of str, optional
        Paths of the numbers, such as ``"scene.damping_ratio"`` and ``"law.mu"``; all numbers if left out.
    method : str or Method, default "auto"
        Name of a method, or a method such as ``fl.March(steps=1000)``.
    tolerance : float, > 0, default 1e-8
        Absolute bound [-] on the error of ``mean_friction``.

    Returns
    -------
    pandas.DataFrame
        A row for each number, with the columns ``parameter``, ``value``, ``derivative`` d(mean)/d(parameter)
        [per unit of the parameter, a phase per degree], ``error`` (bound on the error of the derivative),
        ``elasticity`` (relative change of the mean over that of the parameter; empty for phases and where
        either is zero), ``reason`` (why there is no derivative, else ""). ``.attrs["maps"]`` counts the
        periods that were integrated.

    Raises
    ------
    ValueError
        If a path is no number of the scene or the law, or a value makes no sense.
    TypeError
        If a value is of another kind.

    Examples
    --------
    >>> import frictionlab as fl
    >>> drive = fl.Drive(unbalance=10, frequency=1)
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
    >>> table = fl.sensitivities(scene, fl.Coulomb(mu=0.4), ["law.mu", "scene.belt_speed"])
    >>> table.derivative.round(6).tolist()
    [0.246794, 0.009882]
    """
    pair = Pair(given_scene(scene), given_law(law))
    numbers = pair.numbers()
    asked = asked_for(numbers, parameters)
    state = steady_state(pair.scene, pair.law, method, tolerance)
    ready = given_method(method)
    found, maps = dict.fromkeys(asked, _NOTHING), 0
    try:
        _check(pair.scene, state)
        for turn in _TURNS:
            open_ones = [path for path in asked if found[path].reason in (CORNER, _BENDS, _NOTHING.reason)]
            left = {path: numbers[path] for path in open_ones}
            told, more = _at_turn(pair, turn, state, left, ready)
            found, maps = found | told, maps + more
    except _Refused as refused:
        found = dict.fromkeys(asked, _NOTHING._replace(reason=str(refused)))
    rows = [_row(path, numbers[path], state, found[path]) for path in asked]
    table = pd.DataFrame(rows, columns=list(_COLUMNS))
    table.attrs["maps"] = maps
    return table


class _ByNumber(NamedTuple):
    """The derivative of the mean by one number, its error, and why there is none, '' where there is one."""

    value: float
    error: float
    reason: str = ""


_NOTHING = _ByNumber(np.nan, np.nan, "not looked for")


def _at_turn(
    pair: Pair, turn: float, state: SteadyState, paths: dict[str, float], method: Method
) -> tuple[dict[str, _ByNumber], int]:
    """The derivatives by these numbers, the period begun at this angle, and the periods followed. Raises _Refused."""
    if not paths:
        return {}, 0
    try:
        there = _fixed_point(pair, turn, state)
    except _Corner as corner:
        reason, maps = corner.args
        return dict.fromkeys(paths, _NOTHING._replace(reason=reason)), maps
    maps, found = there.maps, {}
    for path, number in paths.items():
        by_number = _by_parameter(there, path, number, method)
        maps += MAPS_PER_TRY * by_number.tries
        told, least = _of_the_mean(there, by_number), abs(state.mean_friction) / _size(path, number)
        # an error may be no large part of the derivative, nor of the least derivative that matters
        blunt = told.error > _BLUNT * max(abs(told.value), least)
        found[path] = _NOTHING._replace(reason=_BENDS) if blunt and not told.reason else told
    return found, maps


def _row(path: str, number: float, state: SteadyState, found: _ByNumber) -> tuple[Any, ...]:
    relative = not path.endswith("phase") and number != 0.0 and state.mean_friction != 0.0
    elasticity = found.value * number / state.mean_friction if relative else np.nan
    return path, number, found.value, found.error, elasticity, found.reason


def _check(scene: Scene, state: SteadyState) -> None:
    """Raises _Refused where there is no steady state to be differentiated."""
    if scene.degrees_of_freedom == 0:
        raise _Refused(_PRESCRIBED)
    if scene.undriven:
        raise _Refused(_UNDRIVEN)
    if scene.remembers:
        raise _Refused(_NO_MAP)
    if state.status != "ok":
        raise _Refused(f"no steady state with one mean: {state.reason}")
    if state.unique == NOT_UNIQUE:
        raise _Refused(f"the steady state is not the only one: {state.reason}")
    if state.stick_fraction == 1.0:
        raise _Refused(_RESTS)


def _fixed_point(pair: Pair, turn: float, state: SteadyState) -> _AtFixedPoint:
    """The closed orbit of a steady state, the period begun at this angle. Raises _Refused, _Corner."""
    there = pair.later(turn)
    one = OnePeriod.of(there.scene, there.law)
    z = one.closed()
    if z is None:
        raise _Refused(_OTHER_ORBIT)
    found = _with_derivatives(pair, turn, one, z)
    # Newton's step of the residual that the search left, by the derivative that is known now
    moved = z - np.linalg.solve(found.by_state[:-1], found.image[:-1] - z)
    image = one.from_states(moved[None])[0]
    if not abs(image[-1] - state.mean_friction) <= _AGREES + state.error:
        raise _Refused(_OTHER_ORBIT)
    return found._replace(z=moved, image=image, maps=found.maps + 1)


def _with_derivatives(pair: Pair, turn: float, one: OnePeriod, z: Floats) -> _AtFixedPoint:
    here, size = one.from_states(z[None])[0], z.size
    length, columns, maps = 1.0 + float(np.linalg.norm(z)), [], 1
    for way in np.eye(size):

        def along(offsets: Floats, way: Floats = way) -> list[Floats | None]:
            return list(one.from_states(z + offsets[:, None] * way))

        found = derivative(along, here, _FEW_PARTS * length, one.noise(z))
        maps += MAPS_PER_TRY * found.tries
        if found.reason:
            raise _Corner(found.reason, maps)
        columns.append(found)
    by_state = np.column_stack([each.value for each in columns])
    error = np.column_stack([each.error + one.drift(z) / length for each in columns])
    by_state[:size] -= np.eye(size)
    if not np.linalg.cond(by_state[:size]) < _NEARLY_SINGULAR:
        raise _Refused(_LOST)
    return _AtFixedPoint(pair, turn, one, z, here, by_state, error, maps)


def _size(path: str, number: float) -> float:
    return _RADIAN if path.endswith("phase") else abs(number) or 1.0


def _by_parameter(found: _AtFixedPoint, path: str, number: float, method: Method) -> Derivative:
    """P_p and below it m_p."""

    def changed(offsets: Floats) -> list[Floats | None]:
        return [_a_period_with(found, path, number + offset, method) for offset in offsets.tolist()]

    size = _size(path, number)
    by_number = derivative(changed, found.image, _FEW_PARTS * size, found.one.noise(found.z))
    return by_number._replace(error=by_number.error + found.one.drift(found.z) / size)


def _a_period_with(found: _AtFixedPoint, path: str, number: float, method: Method) -> Floats | None:
    """From the state of the closed orbit; None where this number makes no scene or law that the method accepts."""
    try:
        other = found.pair.with_(path, number).later(found.turn)
    except ValueError:
        return None
    one = OnePeriod.of(other.scene, other.law, found.one.length)
    if method.refusal(one.scene, one.law) is not None:
        return None
    return np.asarray(one.from_states(found.z[None])[0]) if one.like(found.one) else None


def _of_the_mean(found: _AtFixedPoint, by_number: Derivative) -> _ByNumber:
    """dm/dp and its error, by those of the four derivatives."""
    matrix, gradient = found.by_state[:-1], found.by_state[-1]
    change = np.linalg.solve(-matrix, by_number.value[:-1])  # of the state
    adjoint = np.linalg.solve(-matrix.T, gradient)
    value = by_number.value[-1] + gradient @ change
    errors = by_number.error + found.error @ np.abs(change)
    error = errors[-1] + np.abs(adjoint) @ errors[:-1]
    return _ByNumber(float(value), float(error), by_number.reason)
