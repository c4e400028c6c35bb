"""Kernel of one lap of a motion: steps, and what is met on them.

A lap is a period of everything that drives, or, undriven, from one falling zero of the velocity along the belt to the
next. The motion is stepped as it is, not as a deviation from a known response: that is how everybody does it, and its
errors are to be seen. Steps end at the corners of what drives, and have between two of them equal lengths.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import embedded, inner
from frictionlab.compile.dispatch import length
from frictionlab.compile.stack import count_of
from frictionlab.methods.march.adapters import MarchProblem, advance, note_step
from frictionlab.motion.equation import in_piece, instant_at, piece_ends, pieces_of, slip
from frictionlab.motion.orbit.recorder import Track
from frictionlab.motion.steppers.step import StepEnd, StepStart
from frictionlab.scene.body import BodyNumbers

NOTHING = np.zeros(1)
"""Memory of a law that has none."""


class MarchSettings(NamedTuple):
    """Numbers of a lap, the length of steps, and when to stop."""

    belt_speed: float
    driven: bool
    steps: int  # of equal length in a lap; 1 where the stepper meets the load wherever it likes, or there is none
    span: float  # a lap of a driven motion; undriven, the longest lap
    first: float  # step
    slack: float  # share of a step by which the last of a lap may be longer
    reach: float  # longest step
    enough: float  # distance from the closed orbit, in the energy norm
    most: int  # laps
    stride: int  # laps after which the motion is to repeat
    rate: float  # at which gaps are known to shrink from lap to lap; 0: unknown
    work: int  # most steps
    window: int  # laps over which a motion that does not close is judged, twice
    room: int  # panels of the record of the last lap
    spring: Any = NOTHING  # stiffness of each memory, in the energy norm
    fastest: float = 1e300  # slip that the steps are short enough for
    refined: int = 0  # parts that the coarsest steps are cut into; 0: the stepper chooses how long steps are
    lightest: float = 1.0  # least normal load over its mean


class SlipTrace(NamedTuple):
    """Slip since a lap began: the last that was not zero, the quickest, and whether it reversed."""

    w: Any
    met: float
    reverses: bool


class Tally(NamedTuple):
    """Sums of friction since a lap began: its impulse, time at rest, its largest coefficient over one step."""

    impulse: Any
    stuck: float
    peak: float


class Swing(NamedTuple):
    """Sums of an undriven motion since a mark: its largest speed, and impulse and time at rest at the mark."""

    mark: float  # when it is judged
    most: float
    impulse: Any
    stuck: float


class Lap(NamedTuple):
    """A lap's end and what was met on it."""

    x: Any
    v: Any
    tally: Tally
    trace: SlipTrace
    duration: float
    step: float  # the next one; 0 where the mass rests in the spring
    steps: int
    returned: bool


# --- one step of a lap --------------------------------------------------------------------------------------------


@inner
def falling_zero(problem: MarchProblem, start: StepStart, h: float) -> float:
    """When within a step the velocity along the belt falls to zero (Illinois regula falsi)."""
    low, high, side = 0.0, h, 0
    at_low, at_high = start.v.real, advance(problem, start, h).v.real
    part = h
    # Every trial is a step from the same start: its end is no interpolation.
    for _ in range(100):
        if at_high == 0.0 or high - low <= 1e-15 * (start.tau + h):
            break
        part = (low * at_high - high * at_low) / (at_high - at_low)
        value = advance(problem, start, part).v.real
        # An end that stays twice has its value halved, else the other end would creep.
        if value <= 0.0:
            high, at_high, at_low = part, value, 0.5 * at_low if side > 0 else at_low
            side = 1
        else:
            low, at_low, at_high = part, value, 0.5 * at_high if side < 0 else at_high
            side = -1
    return high


@embedded
def slip_trace(trace: SlipTrace, w: Any) -> SlipTrace:
    """Return the trace with one more slip velocity."""
    speed, turned = length(w), (trace.w * w.conjugate()).real < 0.0
    return SlipTrace(w if speed > 0.0 else trace.w, max(trace.met, speed), trace.reverses or turned)


@inner
def keep_memory(problem: MarchProblem) -> None:
    """Keep what the law remembers at the end of a step for the start of the next."""
    for k in range(count_of(problem.law)):
        problem.memory[k] = problem.ahead[k]


@embedded
def tally_step(tally: Tally, taken: StepEnd, h: float) -> Tally:
    """Friction of a step over h added."""
    return Tally(
        tally.impulse + taken.impulse,
        tally.stuck + (h if taken.stuck else 0.0),
        max(tally.peak, length(taken.impulse) / h),
    )


@embedded
def rests_in_spring(swing: Swing, x: Any, v: Any, tau: float) -> bool:
    """Check whether it is time to judge the swing, and nothing has moved but by rounding since the mark."""
    return tau >= swing.mark and max(swing.most, length(v)) <= 1e-12 * (length(x) + 1e-3)


@embedded
def next_swing(swing: Swing, tally: Tally, tau: float, speed: float) -> Swing:
    """Return the swing after a step that ended with this speed; begun anew every 2 pi."""
    if tau >= swing.mark:
        return Swing(tau + 2.0 * math.pi, 0.0, tally.impulse, tally.stuck)
    return Swing(swing.mark, max(swing.most, speed), swing.impulse, swing.stuck)


# --- pieces of a lap ----------------------------------------------------------------------------------------------


@inner
def steps_in(settings: MarchSettings, lasts: float) -> int:
    """Equal steps between two corners, none longer than the first: halved steps are halved there, too."""
    coarsest = settings.refined * settings.first
    return settings.refined * max(1, math.ceil(lasts / coarsest - 1e-9))


@inner
def piece_end(body: BodyNumbers, settings: MarchSettings, k: int) -> float:
    """Return the time at which the k-th piece of a lap ends."""
    return settings.span if k == pieces_of(body) - 1 else piece_ends(body, k)[1]


@inner
def piece_step(settings: MarchSettings, lap: Lap, end: float) -> float:
    """Return the first step of a piece that begins where the lap has come to."""
    if settings.refined == 0 or not settings.driven:
        return lap.step
    return (end - lap.duration) / steps_in(settings, end - lap.duration)


@inner
def past_corner(body: BodyNumbers, belt_speed: float, lap: Lap) -> SlipTrace:
    """Return the trace where a piece begins."""
    return slip_trace(lap.trace, slip(body, belt_speed, instant_at(body, lap.duration), lap.v))


@inner
def problem_in_piece(problem: MarchProblem, k: int) -> MarchProblem:
    """Return the problem as the k-th piece of a lap has it."""
    return MarchProblem(
        problem.law,
        in_piece(problem.body, k),
        problem.belt_speed,
        problem.stepper,
        problem.grid,
        problem.memory,
        problem.ahead,
    )


# --- a lap --------------------------------------------------------------------------------------------------------


@inner
def march_lap(
    problem: MarchProblem, settings: MarchSettings, start: StepStart, h: float, track: Track
) -> Lap:
    """From tau = 0 once around, corner by corner; h: the first step."""
    body, belt_speed, x = problem.body, problem.belt_speed, start.x
    trace = SlipTrace(slip(body, belt_speed, instant_at(body, 0.0), start.v), 0.0, False)
    lap = Lap(x, start.v, Tally(0.0 * x, 0.0, 0.0), trace, 0.0, h, 0, True)
    for k in range(pieces_of(body)):
        end = piece_end(body, settings, k)
        lap = march_piece(problem_in_piece(problem, k), settings, lap, end, track)
        if not lap.returned:
            break
    return lap


@inner
def march_piece(problem: MarchProblem, settings: MarchSettings, lap: Lap, end: float, track: Track) -> Lap:
    """From where a lap has come to until a corner; undriven, until it returns."""
    body, belt_speed, driven = problem.body, problem.belt_speed, settings.driven
    x, v, tally, tau, steps, back = lap.x, lap.v, lap.tally, lap.duration, lap.steps, False
    h, trace, k = (
        piece_step(settings, lap, end),
        past_corner(body, belt_speed, lap),
        steps if driven else 0,
    )
    swing = Swing(2.0 * math.pi, length(v), 0.0 * x, 0.0)
    while tau < end and steps < settings.work:
        # The last step ends with the lap, however the sum of equal steps was rounded.
        last = end - tau <= h * (1.0 + settings.slack) or tau + h == tau
        begin, step = StepStart(k, tau, x, v), end - tau if last else h
        taken = advance(problem, begin, step)
        steps += 1
        # A step whose error is too large is taken again, shorter; it has cost work all the same.
        if taken.growth < 1.0:
            h = step * taken.growth
            continue
        # Undriven, a lap ends where the velocity falls through zero: that step is taken anew, to there.
        back = not driven and v.real > 0.0 and taken.v.real <= 0.0
        if back:
            step = falling_zero(problem, begin, step)
            taken = advance(problem, begin, step)
        if settings.room > 0 and track.filled[0] < settings.room:
            note_step(track, tau, step, taken.stuck, problem, begin, taken, step)
        keep_memory(problem)
        x, v, k, tau = taken.x, taken.v, k + 1 if driven else k, end if last and not back else tau + step
        # At rest on a belt that vibrates there is no slip but the rounding of a difference.
        w = 0.0 * v if taken.stuck else slip(body, belt_speed, instant_at(body, tau), v)
        trace = slip_trace(trace, w)
        tally = tally_step(tally, taken, step)
        if back:
            break
        h = min(h * taken.growth, settings.reach) if taken.growth > 1.0 else h
        # A mass at rest in its spring never returns: undriven, it is looked at once in 2 pi.
        if not driven and rests_in_spring(swing, x, v, tau):
            return resting_lap(Lap(x, v, tally, trace, tau, h, steps, False), swing)
        swing = swing if driven else next_swing(swing, tally, tau, length(v))
        # Steps too long for this slip would explode: no need to see it.
        if trace.met > settings.fastest:
            break
    return Lap(x, v - v.real if back else v, tally, trace, tau, h, steps, back or (driven and tau >= end))


@inner
def resting_lap(lap: Lap, swing: Swing) -> Lap:
    """Return the lap of a mass that never returns: the last time over which it was at rest in the spring."""
    since = Tally(lap.tally.impulse - swing.impulse, lap.tally.stuck - swing.stuck, lap.tally.peak)
    duration = lap.duration - swing.mark + 2.0 * math.pi
    return Lap(lap.x, lap.v, since, lap.trace, duration, 0.0, lap.steps, False)
