"""Mean friction of an enclosed orbit."""

from __future__ import annotations

from typing import Any

from flint import arb

from frictionlab.methods.exact.proof.motion import Mechanics, double_integral, integral, values_at
from frictionlab.methods.exact.proof.system import Event, EventState, leg_parts, legs


def mean_force(mechanics: Mechanics, nodes: tuple[Event, ...], states: tuple[EventState, ...]) -> Any:
    """Mean of the friction force on the mass over a common period [K_1 L]."""
    impulse = arb(0)
    for leg in legs(nodes, states):
        x = leg.start.x
        for piece, low, high in leg_parts(mechanics.forces, leg):
            if leg.node.sign:
                pressed = integral(piece.normal_load, piece.start, low, high)
                impulse = impulse - leg.node.sign * mechanics.mu * pressed
                continue
            # friction carries the mass along: B' + 2 b B + x - F
            travel = integral(piece.belt, piece.start, low, high)
            gained = (
                values_at(piece.belt, piece.start, high).value - values_at(piece.belt, piece.start, low).value
            )
            stretched = x * (high - low) + double_integral(piece.belt, piece.start, low, high)
            pushed = integral(piece.load, piece.start, low, high)
            impulse = impulse + gained + 2 * mechanics.b * travel + stretched - pushed
            x = x + travel
    return impulse / mechanics.forces.period
