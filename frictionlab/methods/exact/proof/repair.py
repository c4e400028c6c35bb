"""Another list of legs where the first is not that of the scene.

Next to the onset of a leg rounding may find the orbit with it or without it. What the proof found wrong says which.
"""

from __future__ import annotations

import math

from frictionlab.methods.exact.proof.motion import NotProved
from frictionlab.methods.exact.proof.nodes import LegStart
from frictionlab.methods.exact.proof.signs import NoReversal, NoStick, Wrong


def repaired(starts: list[LegStart], period: float, problem: NotProved) -> list[LegStart]:
    """The legs without what is wrong with them, in the order of time. Raises the problem where that is not known."""
    if isinstance(problem, NoReversal):
        return _inserted(starts, problem.leg, [starts[problem.leg]._replace(sign=0)])
    if isinstance(problem, NoStick):
        return _with_a_reversal(starts, problem)
    if isinstance(problem, Wrong):
        return _with_a_leg(starts, problem)
    return _without_the_shortest(starts, period, problem)


def _inserted(starts: list[LegStart], place: int, new: list[LegStart]) -> list[LegStart]:
    """With new legs before that at this place."""
    return _joined([*starts[:place], *new, *starts[place:]])


def _with_a_reversal(starts: list[LegStart], problem: NoStick) -> list[LegStart]:
    """Slip where stick was to begin: all the while, or a little where friction comes to hold the mass after all."""
    wrong = starts[problem.leg]
    reversed_, rest = wrong._replace(sign=problem.side), starts[problem.leg + 1 :]
    excess, bend, _x = problem.beyond
    if bend > 0.0:
        length = 2.0 * excess / bend
        rest = [wrong._replace(tau=wrong.tau + length), *rest]
    return _joined([*starts[: problem.leg], reversed_, *rest])


def _with_a_leg(starts: list[LegStart], problem: Wrong) -> list[LegStart]:
    """A short stick where slip comes to rest, a short slip where stick exceeds the limit."""
    excess, bend, x = problem.beyond
    if not (excess > 0.0 and bend > 0.0):
        raise problem
    leg = starts[problem.leg]
    tau, half = leg.tau + problem.after, math.sqrt(2.0 * excess / bend)
    first, last = (tau - half, tau) if leg.sign else (tau - half, tau + 2.0 * half)
    inside = 0 if leg.sign else problem.side
    new = [LegStart(inside, first, x, leg.v), LegStart(leg.sign, last, x, leg.v)]
    return _inserted(starts, problem.leg + 1, new)


def _without_the_shortest(starts: list[LegStart], period: float, problem: NotProved) -> list[LegStart]:
    if len({one.sign for one in starts}) < 2:
        raise problem
    lengths = [(starts[(i + 1) % len(starts)].tau - one.tau) % period for i, one in enumerate(starts)]
    shortest = min(range(len(starts)), key=lambda i: min(lengths[i], period - lengths[i]))
    kept = _joined([one for i, one in enumerate(starts) if i != shortest])
    if len(kept) == 1 and not kept[0].sign:
        raise problem
    return kept


def _joined(starts: list[LegStart]) -> list[LegStart]:
    """Neighbours of the same sign are one leg."""
    kept = [one for i, one in enumerate(starts) if one.sign != starts[i - 1].sign]
    return kept or starts[:1]
