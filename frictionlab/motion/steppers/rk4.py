"""Classical Runge-Kutta method of order 4 (W. Kutta, 1901) for a mass and the memory of its contact.

x'' = a(tau, x, x', z), z' = r(x', z) with z of no, one or several numbers. The method is explicit: a step is
short enough while step * rate <= 2.785 for every rate of decay, and step * frequency <= 2.828 for every
undamped frequency. It locates no events. If friction jumps inside a step, that step is of order one with
irregular errors, since the weighted mean of four rates does not depend on the time of the jump. If the rate
of a memory has a corner inside a step, the order falls to two.
"""

from __future__ import annotations

from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.compile.stack import count_of, room
from frictionlab.motion.steppers.step import FIRST, LAST, MIDDLE, StepEnd, StepStart

DECAY = 2.785
"""Largest step times rate of decay: the stability polynomial leaves the unit disk there on the real axis."""


@inner
def rk4_step(rates: Any, problem: Any, start: StepStart, h: float) -> StepEnd:
    """Take one step over h; ``rates(problem, k, part, x, v, memory, moving)`` returns (x'', friction).

    It writes z' into ``moving``; part is a node of the k-th step. There are no stick phases: a step never
    ends at rest.
    """
    law, memory, k, x, v = problem.law, problem.memory, start.k, start.x, start.v
    n, half, sixth = count_of(law), 0.5 * h, h / 6.0
    stage, rate, total = room(law, 1, 0, memory[0]), room(law, 1, 0, memory[0]), room(law, 1, 0, memory[0])
    a1, f1 = rates(problem, k, FIRST, x, v, memory, rate)
    # First half step, with the rates of the start.
    v2 = v + half * a1
    for i in range(n):
        total[i] = rate[i]
        stage[i] = memory[i] + half * rate[i]
    a2, f2 = rates(problem, k, MIDDLE, x + half * v, v2, stage, rate)
    # The same half step, with the rates found at its end.
    v3 = v + half * a2
    for i in range(n):
        total[i] = total[i] + 2.0 * rate[i]
        stage[i] = memory[i] + half * rate[i]
    a3, f3 = rates(problem, k, MIDDLE, x + half * v2, v3, stage, rate)
    # Whole step, with the rates of its middle.
    v4 = v + h * a3
    for i in range(n):
        total[i] = total[i] + 2.0 * rate[i]
        stage[i] = memory[i] + h * rate[i]
    a4, f4 = rates(problem, k, LAST, x + h * v3, v4, stage, rate)
    # Simpson's weights; only the running sum of z' is kept, since there may be many numbers.
    for i in range(n):
        problem.ahead[i] = memory[i] + sixth * (total[i] + rate[i])
    return StepEnd(
        x + sixth * (v + 2.0 * v2 + 2.0 * v3 + v4),
        v + sixth * (a1 + 2.0 * a2 + 2.0 * a3 + a4),
        sixth * (f1 + 2.0 * f2 + 2.0 * f3 + f4),
        False,
        1.0,
    )
