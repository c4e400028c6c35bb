"""Proof of the mean friction of a periodic orbit: it exists (Krawczyk's test), and its legs have the right signs.

With damping and under constant friction a scene whose mass must slip has one periodic motion (theory/uniqueness): an
orbit that is proved to exist has the mean of every motion in the long run.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from flint import arb, ctx

from frictionlab.methods.exact.proof.forces import forces_of
from frictionlab.methods.exact.proof.mean import mean_force
from frictionlab.methods.exact.proof.motion import Mechanics, NotProved
from frictionlab.methods.exact.proof.nodes import LegStart, nodes_of, starts_of
from frictionlab.methods.exact.proof.repair import repaired
from frictionlab.methods.exact.proof.signs import check_signs
from frictionlab.methods.exact.proof.system import Event, EventState, enclose, event_states
from frictionlab.orbit.record import Orbit
from frictionlab.scene.scene import Scene

BITS, MORE_BITS = 128, 320
"""Of numbers; more where a leg is so short that the first leave its sign open."""
ATTEMPTS = 8


class Proved(NamedTuple):
    """Mean friction coefficient and a bound on its error."""

    mean: float
    error: float


def prove(scene: Scene, coefficient: float, orbit: Orbit) -> Proved:
    """The mean friction of a scene of one orbit, from that orbit as found in floating-point numbers.

    Raises NotProved with what cannot be proved of it.
    """
    try:
        return _proved(scene, coefficient, orbit, BITS)
    except NotProved:
        return _proved(scene, coefficient, orbit, MORE_BITS)


def _proved(scene: Scene, coefficient: float, orbit: Orbit, bits: int) -> Proved:
    with ctx.workprec(bits):
        mechanics = Mechanics(arb(scene.damping_ratio), arb(coefficient), forces_of(scene))
        period = float(mechanics.forces.period.mid())
        starts, first = starts_of(orbit, period), None
        for _ in range(ATTEMPTS):
            try:
                return _rounded(enclosed_mean(mechanics, starts) / arb(scene.normal_load))
            except Unproved as problem:
                first = first or problem.cause
                starts = repaired(problem.starts, period, problem.cause)
        raise first or NotProved("no orbit is near the one that was found")


class Unproved(Exception):
    """A list of legs, in the order of time, and what is wrong with it."""

    def __init__(self, cause: NotProved, starts: list[LegStart]) -> None:
        super().__init__(str(cause))
        self.cause, self.starts = cause, starts


def enclosed_mean(mechanics: Mechanics, starts: list[LegStart]) -> arb:
    """Mean friction force [K_1 L] of the orbit with these legs. Raises Unproved."""
    nodes, guess = nodes_of(mechanics.forces, starts)
    states = event_states(mechanics, nodes, [arb(each) for each in guess])
    try:
        states = event_states(mechanics, nodes, enclose(mechanics, nodes, guess))
        check_signs(mechanics, nodes, states)
        return mean_force(mechanics, nodes, states)
    except NotProved as problem:
        raise Unproved(problem, [_start(*each) for each in zip(nodes, states, strict=True)]) from None


def _start(node: Event, state: EventState) -> LegStart:
    return LegStart(node.sign, float(state.tau.mid()), float(state.x.mid()), float(state.v.mid()))


def _rounded(mean: arb) -> Proved:
    middle = float(mean.mid())
    error = abs(mean - arb(middle)).upper()
    return Proved(middle, math.nextafter(float(error), math.inf))
