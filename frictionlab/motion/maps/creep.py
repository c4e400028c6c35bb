"""Steps in the logarithm of a slip that creeps.

Friction by scalars may grow as asinh(slip/scale) with a scale of 1e-40 of the belt speed. A contact that
seems at rest then creeps, at a speed that is exponential in the force on it. In w = scale sinh(q) that
friction is linear in q (in the plane: along q), and a linearly implicit step over a creep can be as long as
over any linear motion. A step from such a slow slip integrates the number w0 + J0 (q - q0) in place of w,
with J = dw/dq. At its start this number and its rate are those of the slip, so that all blocks of the step
are those of w itself. The change of J within the step counts as error of the step: below ``BELOW`` times the
accuracy, slip is known well enough by far.
"""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, by_scalars, length
from frictionlab.motion.equation import Flow, instant_near, normal_load
from frictionlab.motion.maps.rates import U, Work, friction_in_mode

BELOW = 30.0
"""Slip slower than this many times the accuracy is followed by its logarithm."""
WITHOUT_INERTIA = 3e-4
"""Share of that slip below which inertia has no effect on a change to another slip as slow."""
HALVES = 4.3
"""Argument at which asinh is half of its linear term."""
_CLOSE = 0.1
"""Largest error of the logarithm of such a slip; within the accuracy all slips look the same."""
SLOWEST = -150.0
"""Decimal logarithm of the slowest slip that differs from none: kernels take squares of it."""
FASTEST = 1e30
"""Largest slip of a stage; a faster one is as wrong."""
SCALE, SLOW = 0, 1
"""Places in ``Work.creep``: scale of the logarithm, 0 for a step that integrates slip itself; largest slip
that creeps."""


def _stays_quick(flow: Flow, w: Any, a: Any, work: Work) -> None:
    """Do nothing: only friction by scalars is steep enough for creep."""


def _may_creep(flow: Flow, w: Any, a: Any, work: Work) -> None:
    law, slow = flow.law, work.creep[SLOW]
    work.creep[SCALE] = 0.0
    far = length(w)
    if far >= slow:
        return
    along = w / far if far > 0.0 else 1.0 + 0.0 * w
    low, high = SLOWEST, math.log10(slow)
    slope = length(friction_in_mode(law, work, 10.0**low * along)) * 10.0**-low
    while high - low > 0.1:
        middle = 0.5 * (low + high)
        if length(friction_in_mode(law, work, 10.0**middle * along)) < 0.5 * slope * 10.0**middle:
            high = middle
        else:
            low = middle
    if high >= math.log10(slow):
        return
    work.creep[SCALE] = 10.0**high / HALVES
    pull = friction_in_mode(law, work, w) + a / normal_load(flow.body, instant_near(flow, flow.anchor))
    crawl = WITHOUT_INERTIA * slow
    if far < crawl and length(pull) >= length(friction_in_mode(law, work, 2.0 * crawl * along)):
        # a mass that is pulled harder than the friction of two crawls starts to slip so; under a weaker pull it would
        # fall back to less than a crawl, step by step
        work.start[U] = (2.0 * crawl / length(pull)) * pull


note_creep = by_scalars(_stays_quick, _may_creep)
"""note_creep(flow, w, a, work): decide whether a step from slip w with rate a integrates its logarithm, and
on which scale; ``work.memory`` is the memory at the start."""


creeps = by_scalars(lambda law, work: False, lambda law, work: work.creep[SCALE] > 0.0)
"""creeps(law, work): whether a step from ``work.start`` integrates the logarithm of slip.

Slip then changes much sooner than a step resolves, and friction with it. By the balance of momentum, the
impulse of friction is that of the pulling forces less the gain of slip. The step integrates that impulse
instead."""


@inner
def _weightless(work: Work) -> bool:
    return work.creep[SCALE] == 0.0 or length(work.start[U]) < WITHOUT_INERTIA * work.creep[SLOW]


@inner
def _while_slow(law: Any, work: Work, a: Any) -> float:
    return math.inf if _weightless(work) else 2.0 * length(work.start[U]) / (length(a) + 1e-300)


longest_while_slow = by_scalars(lambda law, work, a: math.inf, lambda law, work, a: _while_slow(law, work, a))
"""longest_while_slow(law, work, a): longest step worth a trial from a slow slip with rate a."""


# --- w = scale sinh(q) along q, and J -------------------------------------------------------------------------------


@inner
def _logarithm(w: Any, scale: float) -> Any:
    far = length(w)
    return (math.asinh(far / scale) / far) * w if far > 0.0 else 0.0 * w


@inner
def _slip(q: Any, scale: float) -> Any:
    far = length(q)
    return (scale * math.sinh(min(far, math.asinh(FASTEST / scale))) / far) * q if far > 0.0 else 0.0 * q


@inner
def _stretch_along(w: Any, scale: float) -> float:
    return math.hypot(scale, length(w))


def _stretched_in_the_plane(w: complex, scale: float, change: complex) -> complex:
    far = length(w)
    if far == 0.0:
        return scale * change
    turned = change * w.conjugate() / far
    across = far / math.asinh(far / scale)
    return complex(_stretch_along(w, scale) * turned.real, across * turned.imag) * w / far


def _shrunk_in_the_plane(w: complex, scale: float, change: complex) -> complex:
    far = length(w)
    if far == 0.0:
        return change / scale
    turned = change * w.conjugate() / far
    across = far / math.asinh(far / scale)
    return complex(turned.real / _stretch_along(w, scale), turned.imag / across) * w / far


_stretched = by_dimension(lambda w, scale, change: _stretch_along(w, scale) * change, _stretched_in_the_plane)
"""_stretched(w, scale, change): J(w), the derivative at w, of a change of q."""
_shrunk = by_dimension(lambda w, scale, change: change / _stretch_along(w, scale), _shrunk_in_the_plane)
"""_shrunk(w, scale, change): change of q that J(w) turns into this one."""


# --- what a step takes ----------------------------------------------------------------------------------------------


@inner
def _step_variable(work: Work, w: Any) -> Any:
    scale, start = work.creep[SCALE], work.start[U]
    if scale == 0.0:
        return w
    return start + _stretched(start, scale, _logarithm(w, scale) - _logarithm(start, scale))


@inner
def _velocity_of(work: Work, p: Any) -> Any:
    scale, start = work.creep[SCALE], work.start[U]
    if scale == 0.0:
        return p
    return _slip(_logarithm(start, scale) + _shrunk(start, scale, p - start), scale)


@inner
def _step_variable_rate(work: Work, w: Any, a: Any) -> Any:
    scale, start = work.creep[SCALE], work.start[U]
    return a if _weightless(work) else _stretched(start, scale, _shrunk(w, scale, a))


@inner
def _velocity_error(work: Work, error: Any) -> float:
    scale, start, end, most = work.creep[SCALE], work.start[U], work.end[U], length(error)
    if scale == 0.0:
        return most
    lengthens = _shrunk(start, scale, error)
    ends = length(_stretched(end, scale, lengthens))
    if _weightless(work):
        return max(ends, 0.1 * length(end) / (BELOW * WITHOUT_INERTIA))
    # a slip that slows down to creep loses its speed within the step, and the error of that speed counts
    return max(ends, most, work.creep[SLOW] / (BELOW * _CLOSE) * length(lengthens))


to_step_variable = by_scalars(lambda law, work, w: w, lambda law, work, w: _step_variable(work, w))
"""to_step_variable(law, work, w): number that a step from ``work.start`` integrates in place of the velocity
w."""
from_step_variable = by_scalars(lambda law, work, p: p, lambda law, work, p: _velocity_of(work, p))
"""from_step_variable(law, work, p): velocity that belongs to the number p which a step integrates."""
step_variable_rate = by_scalars(
    lambda law, work, w, a: a, lambda law, work, w, a: _step_variable_rate(work, w, a)
)
"""step_variable_rate(law, work, w, a): rate of that number at velocity w with rate a."""
velocity_error = by_scalars(
    lambda law, work, error: length(error), lambda law, work, error: _velocity_error(work, error)
)
"""velocity_error(law, work, error): error of the velocity at ``work.end``, from the error of the integrated
number."""
