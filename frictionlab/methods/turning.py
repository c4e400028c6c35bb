"""Where the slip on a line turns inside a step: its zero, and its minimum where it comes close to one."""

from __future__ import annotations

from typing import Any

from frictionlab.kernel import fast, inner
from frictionlab.scene import Body


@fast
def reference_acceleration(body: Body, sine: float, cosine: float) -> Any:
    """Second derivative of the harmonic reference."""
    return -(body.frequency**2) * (body.reference_sine * sine + body.reference_cosine * cosine)


def turning(step: Any, rates: Any, slip: Any, turned: Any) -> Any:
    """``stop`` and ``lowest`` for a stepper and the rates it is bound to (numba caches no kernel handed a function).

    problem.side is the sign of the slip before it turns.
    """

    @inner
    def _fall(problem: Any, tau: float, taken: Any) -> float:
        sine, cosine = turned(problem, tau)
        a, _rub = rates(problem, tau, taken.x, taken.v)
        return problem.side * (a + reference_acceleration(problem.body, sine, cosine))

    @inner
    def stop(problem: Any, tau: float, state: Any, low: float, high: float) -> Any:
        """The step at whose end slip is zero, between two with slip before and none after (safeguarded Newton)."""
        h = high
        taken = step(problem, tau, state, h)
        for _ in range(60):
            w = problem.side * slip(problem, tau + h, taken.v)
            low, high = (h, high) if w > 0.0 else (low, h)
            slope = _fall(problem, tau + h, taken)
            trial = h - w / slope if slope < 0.0 else low
            if not low < trial < high:
                trial = 0.5 * (low + high)
            done = abs(trial - h) <= 2e-15 * (tau + h)
            h = trial
            taken = step(problem, tau, state, h)
            if done or high - low <= 4e-16 * (tau + h):
                break
        return h, taken

    @inner
    def lowest(problem: Any, tau: float, state: Any, before: float, h: float) -> float:
        """Step at which slip is slowest inside one whose slip falls first, at rate ``before``, and rises last."""
        low, high, middle = 0.0, h, h
        at_low, at_high = before, 0.0
        for _ in range(50):
            taken = step(problem, tau, state, middle)
            value = _fall(problem, tau + middle, taken)
            if value > 0.0:
                high, at_high = middle, value
            else:
                low, at_low = middle, value
            if high - low < 1e-13 * h or value == 0.0:
                break
            linear = low - at_low * (high - low) / (at_high - at_low)
            middle = min(max(linear, low + 0.01 * (high - low)), high - 0.01 * (high - low))
        return middle

    return stop, lowest
