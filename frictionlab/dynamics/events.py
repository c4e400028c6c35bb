"""Where the slip on a line turns inside a step: its zero, and its minimum where it comes close to one."""

from __future__ import annotations

from typing import Any

from frictionlab.compile.decorators import fast, inner
from frictionlab.scene.body import Body


@inner
def dips(w0: complex, rate0: complex, w1: complex, rate1: complex, h: float) -> bool:
    """Whether the slip comes much closer to rest between two nodes than at either (cubic Hermite, in the plane)."""
    close = 0.0625 * min(w0.real**2 + w0.imag**2, w1.real**2 + w1.imag**2)
    for s in (0.25, 0.5, 0.75):
        r = 1.0 - s
        w = r * r * (1.0 + 2.0 * s) * w0 + s * s * (1.0 + 2.0 * r) * w1 + s * r * h * (r * rate0 - s * rate1)
        if w.real**2 + w.imag**2 < close:
            return True
    return False


@fast
def reference_acceleration(body: Body, sine: float, cosine: float) -> Any:
    """Second derivative of the harmonic reference."""
    return -(body.frequency**2) * (body.reference_sine * sine + body.reference_cosine * cosine)


def slip_events(step: Any, rates: Any, slip: Any, slip_rate: Any) -> Any:
    """``stop`` and ``lowest`` for a stepper and the rates it is bound to (numba caches no kernel handed a function).

    slip(problem, tau, u) and slip_rate(problem, tau, a) are of the deviation; problem.side is the sign of the slip
    before it turns.
    """

    @inner
    def _fall(problem: Any, tau: float, taken: Any) -> float:
        a, _rub = rates(problem, tau, taken.x, taken.v)
        return problem.side * slip_rate(problem, tau, a)

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
