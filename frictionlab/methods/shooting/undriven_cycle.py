"""The cycle next to a largest deflection, by Newton's method on the map from one largest deflection to the next.

The velocity is zero there, and what the motion lacks of it after a period is made up for by a change of the period.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from frictionlab.compile.interpret import interpreted
from frictionlab.dynamics.motion import mean_friction
from frictionlab.methods.periodic.attraction import KnownOrbit, obeys
from frictionlab.methods.periodic.fixed_point import FINER, stated_error
from frictionlab.methods.shooting.undriven_path import LEAST, TURN, Return, UndrivenPath
from frictionlab.quantities import Floats

COARSEST_CLOSED, OF_BELT_SPEED = 1e-6, 1e-5
"""The coarsest accuracy of maps that close a cycle, per normal load and per belt speed."""
INSTANT = 1e-7
"""Turns over which rates of a state are quotients."""
MOST_NEWTON, MOST_DERIVATIVES = 16, 4
"""Steps of Newton's method, and how often derivatives are found anew for them."""
CHANCE = 0.15
"""Of the difference between the two coarser means, stands in where the two finer agree by chance."""


RETURN_DISTANCE = 0.05
"""How near to each other two largest deflections must come to close a cycle from them [distances to sliding]."""
CONVERGED_DISTANCE, STRONGLY_DISTANCE = 1e-6, 3e-5
"""How near a motion must come to what attracts it to be there without further proof; and to what halves its distance
each time, where the steps on the way may leave it farther off."""
MOST_RETURNS = 4
"""Largest deflections in one period."""


def nears(orbit: KnownOrbit, before: Floats, after: Floats) -> bool:
    """Whether a motion comes nearer to an orbit from one state to another as the derivative there says."""
    predicted = np.empty(before.size)
    return bool(interpreted(obeys)(orbit, before - orbit.state, after - orbit.state, predicted))


def is_there(orbit: KnownOrbit, state: Floats) -> bool:
    """Whether a state is so near to an orbit that attracts that the motion ends on it."""
    share = STRONGLY_DISTANCE if orbit.gap > 0.5 else CONVERGED_DISTANCE
    near = share * (1.0 + float(np.linalg.norm(orbit.state)))
    return bool(orbit.gap > CONVERGED_DISTANCE and float(np.linalg.norm(state - orbit.state)) < near)


class Cycle(NamedTuple):
    """A cycle from a largest deflection: its period [turns], mean friction and the error of that, and the derivative
    from each largest deflection to the next."""

    state: Floats
    turns: float
    mean: float
    error: float
    matrix: Floats

    @property
    def multiplier(self) -> float:
        """The largest modulus of the multipliers, without the trivial one."""
        return radius(self.matrix)

    @property
    def orbit(self) -> KnownOrbit:
        """As kernels see it."""
        return KnownOrbit(self.state, self.matrix, 1.0 - self.multiplier)

    def neared(self, returns: list[Return]) -> bool:
        """Whether it attracts and the last period of a motion led to it, or nearer to it as its derivative says."""
        orbit, last = self.orbit, returns[-1]
        if not orbit.gap > CONVERGED_DISTANCE:
            return False
        if is_there(orbit, last.state):
            return True
        a_period_ago = [
            one
            for one in returns[-1 - MOST_RETURNS : -1]
            if abs(last.turns - one.turns - self.turns) < RETURN_DISTANCE * self.turns
        ]
        return bool(a_period_ago) and nears(orbit, a_period_ago[-1].state, last.state)


class Linear(NamedTuple):
    """Rates of a largest deflection, the derivative from each to the next, and Newton's inverse of that."""

    rates: Floats
    matrix: Floats
    inverse: Floats


def radius(matrix: Floats) -> float:
    """The largest modulus of the eigenvalues."""
    return float(np.abs(np.linalg.eigvals(matrix)).max())


def close_cycle(path: UndrivenPath, guess: Return, tolerance: float) -> Cycle | None:
    """The cycle near a largest deflection that comes back after about so many turns; None where none is found.

    Its mean is that of the last of three or more closed cycles, each of maps FINER times finer than the one before.
    Raises NotFound.
    """
    coarsest = min(COARSEST_CLOSED, OF_BELT_SPEED * abs(path.speed) / path.mass.normal_load)
    accuracy, means, error = max(min(tolerance, coarsest), LEAST), list[float](), math.inf
    state = guess.state.copy()
    state[1] = 0.0
    at = Cycle(state, guess.turns, math.nan, math.inf, np.empty((0, 0)))
    linear = _linearize(path, at)
    while True:
        found, linear = _newton(path, at, linear, accuracy)
        if found is None:
            return None
        means.append(found.mean)
        if len(means) > 2:
            changed = max(abs(means[-1] - means[-2]), CHANCE * abs(means[-2] - means[-3]))
            steps = 10.0 * accuracy / (found.turns * TURN)
            error = interpreted(stated_error)(changed, 0.5 * found.error, steps)
        if error <= tolerance or accuracy <= LEAST:
            # derivatives that closed it are those of the guess, or of a step on the way
            return found._replace(error=error, matrix=_linearize(path, found).matrix)
        at, accuracy = found, max(accuracy / FINER, LEAST)


def close_shortest(path: UndrivenPath, guess: Return, loops: int, tolerance: float) -> Cycle | None:
    """The same of a guess that goes from largest deflection to largest deflection so many times: where the cycle
    found is a shorter one over again, that."""
    found = close_cycle(path, guess, tolerance)
    if found is None:
        return None
    for parts in range(loops, 1, -1):
        end = path.follow(found.state, found.turns / parts).end
        if loops % parts == 0 and is_there(found.orbit, end):
            return close_cycle(path, Return(found.state, found.turns / parts), tolerance)
    return found


def _newton(path: UndrivenPath, at: Cycle, linear: Linear, accuracy: float) -> tuple[Cycle | None, Linear]:
    """The cycle by maps of one accuracy, its error what the last step has moved the mean by; the derivatives used."""
    (state, turns, mean, _, _), size, derivatives = at, math.inf, 0
    for count in range(MOST_NEWTON):
        span = path.follow(state, turns, accuracy)
        before, mean = mean, float(interpreted(mean_friction)(span.impulse, turns * TURN))
        # along the motion, until the velocity is zero
        late = -float(span.end[1] / linear.rates[1])
        step = linear.inverse @ (span.end + late * linear.rates - state)
        step[1] = 0.0
        # as a way in the states: where the motion lingers at its largest deflection, the instant is hardly known
        last, size = size, float(np.abs(step).max() + abs(late) * np.abs(linear.rates).max())
        if not size < 1.0 + np.abs(state).max():
            break
        # steps that shrink no more are what the steps of a map jump about by
        if count > 0 and size <= 1e3 * accuracy and (size <= accuracy or size > 0.3 * last):
            # steady sliding comes back after any time, and motions next to it nearly do
            apart = path.from_sliding(state) > 1e3 * (size + accuracy)
            return Cycle(state, turns, mean, abs(mean - before), linear.matrix) if apart else None, linear
        state, turns = state + step, turns + late / TURN
        if not turns > 0.0:
            break
        if size > 0.3 * last:
            derivatives += 1
            if derivatives > MOST_DERIVATIVES:
                break
            linear = _linearize(path, at._replace(state=state, turns=turns))
    return None, linear


def _linearize(path: UndrivenPath, at: Cycle) -> Linear:
    rates: Floats = (path.follow(at.state, INSTANT, LEAST).end - at.state) / (INSTANT * TURN)
    whole = path.quotients(at.state, at.turns)
    # from one largest deflection to the next, not from one instant to another: along the motion
    matrix = whole - np.outer(rates, whole[1]) / rates[1]
    matrix[:, 1] = 0.0
    return Linear(rates, matrix, np.linalg.pinv(np.eye(path.size) - matrix))
