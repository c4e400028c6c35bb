"""Events of slip on the line within a step: its zero, and its minimum where it comes close to zero."""

from __future__ import annotations

from typing import Any

from frictionlab.compile.decorators import fast, inner
from frictionlab.scene.body import BodyNumbers


@inner
def dips(w0: Any, rate0: Any, w1: Any, rate1: Any, h: float) -> bool:
    """Check whether slip comes much closer to rest between two nodes than at either (cubic Hermite)."""
    close = 0.0625 * min(w0.real * w0.real + w0.imag * w0.imag, w1.real * w1.real + w1.imag * w1.imag)
    closest = close
    for s in (0.25, 0.5, 0.75):
        r = 1.0 - s
        w = r * r * (1.0 + 2.0 * s) * w0 + s * s * (1.0 + 2.0 * r) * w1 + s * r * h * (r * rate0 - s * rate1)
        closest = min(closest, w.real * w.real + w.imag * w.imag)
    return closest < close


@fast
def reference_acceleration(body: BodyNumbers, sine: float, cosine: float) -> Any:
    """Return the second derivative of the harmonic reference."""
    return -(body.frequency**2) * (body.reference_sine * sine + body.reference_cosine * cosine)


def slip_events(step: Any, rates: Any, slip: Any, slip_rate: Any) -> Any:
    """Make ``stop`` and ``lowest`` for a stepper and its rates.

    They are made here because numba caches no kernel that is handed a function.

    rates(problem, tau, end) is the acceleration at the end of a step. slip(problem, tau, u) and
    slip_rate(problem, tau, a) are functions of the deviation's velocity and acceleration. problem.side is the
    sign of the slip before it turns.
    """

    @inner
    def rise(problem: Any, tau: float, end: Any) -> float:
        """Return the rate of the slip in its direction before the event."""
        a = rates(problem, tau, end)
        return problem.side * slip_rate(problem, tau, a)

    return _stop_at_zero(step, slip, rise), _slowest(step, rise)


def _stop_at_zero(step: Any, slip: Any, rise: Any) -> Any:
    @inner
    def stop(problem: Any, tau: float, state: Any, low: float, high: float) -> Any:
        """Return the step at whose end slip is zero, and that end (safeguarded Newton).

        low, high: steps with slip before its zero, and after it.
        """
        h = high
        end = step(problem, tau, state, h)
        for _ in range(60):
            w = problem.side * slip(problem, tau + h, end.v)
            low, high = (h, high) if w > 0.0 else (low, h)
            # A slip that grows there belongs to another zero: bisection keeps to the one that is bracketed.
            slope = rise(problem, tau + h, end)
            trial = h - w / slope if slope < 0.0 else low
            if not low < trial < high:
                trial = 0.5 * (low + high)
            done = abs(trial - h) <= 2e-15 * (tau + h)
            h = trial
            end = step(problem, tau, state, h)
            # The time has no more digits, even if the slip has.
            if done or high - low <= 4e-16 * (tau + h):
                break
        return h, end

    return stop


def _slowest(step: Any, rise: Any) -> Any:
    @inner
    def lowest(problem: Any, tau: float, state: Any, before: float, h: float) -> float:
        """Return the step at which slip is slowest, within one where slip first falls, then rises.

        before: rate at which it falls first.
        """
        low, high, middle = 0.0, h, h
        at_low, at_high = before, 0.0
        for _ in range(50):
            end = step(problem, tau, state, middle)
            value = rise(problem, tau + middle, end)
            if value > 0.0:
                high, at_high = middle, value
            else:
                low, at_low = middle, value
            if high - low < 1e-13 * h or value == 0.0:
                break
            # Regula falsi, kept a hundredth of the bracket away from its ends, where it would creep.
            linear = low - at_low * (high - low) / (at_high - at_low)
            middle = min(max(linear, low + 0.01 * (high - low)), high - 0.01 * (high - low))
        return middle

    return lowest
