"""Kernels of time stepping: laps of a motion, one after the other, until it repeats.

A lap is a period of the drive, or, undriven, from one falling zero of the velocity along the belt to the next. The
motion is stepped as it is, not as a deviation from a known response: that is how everybody does it, and its errors
are to be seen.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import embedded, inner
from frictionlab.compile.dispatch import length
from frictionlab.dynamics import smoothing
from frictionlab.dynamics.motion import (
    acceleration,
    acceleration_under,
    belt_path,
    belt_velocity,
    instant_at,
    load,
    normal_load,
    restoring_force,
    slip,
)
from frictionlab.dynamics.step_size import growth_of, squared
from frictionlab.numerics.steppers import dop853, moreau, rk4
from frictionlab.numerics.steppers.grid import BELT, LOAD, NORMAL_LOAD
from frictionlab.orbit.recorder import Track, panel_writer, track_of
from frictionlab.scene.body import Body

NOTHING = np.zeros(1)
"""Of a memory that is none."""


class MarchSettings(NamedTuple):
    """How to step: what the drive does, the stepper's numbers, and when to stop."""

    belt_speed: float
    driven: bool
    steps: int  # of equal length in a lap; 1 where the stepper meets the load wherever it likes, or there is none
    span: float  # a lap of a driven motion; undriven, the longest lap
    first: float  # step
    theta: float
    width: float
    shape: float
    accuracy: float
    reach: float  # longest step
    enough: float  # distance from the closed orbit, in the norm of energy
    most: int  # laps
    stride: int  # laps after which the motion is to repeat
    rate: float  # at which gaps are known to shrink from lap to lap; 0: unknown
    near: float  # slip speed below which the stepper cannot tell stick from creep
    work: int  # most steps
    window: int  # laps over which a motion that does not close is judged, twice
    room: int  # panels of the record of the last lap
    z: Any = 0.0  # deflection of the bristles to begin with, or an array of memories, if the law has any
    spring: Any = NOTHING  # stiffness of each memory, in the norm of energy
    fastest: float = 1e300  # slip that the steps are short enough for


class Problem(NamedTuple):
    """What a stepper sees."""

    law: Any
    body: Body
    belt_speed: float
    grid: Any  # numerics/steppers/grid.py
    theta: float
    width: float
    shape: float
    accuracy: float


class Node(NamedTuple):
    """Where a step starts."""

    k: int
    tau: float
    x: Any
    v: Any
    z: Any


class Advance(NamedTuple):
    """Where a step ends; growth: by how much to change the next one, below one where it is to be repeated."""

    x: Any
    v: Any
    rubbed: Any
    stuck: bool
    growth: float
    z: Any


class Lap(NamedTuple):
    """A lap's end and what was met on it."""

    x: Any
    v: Any
    rubbed: Any  # integral of the friction coefficient
    stuck: float  # time
    duration: float
    dip: float  # least slip speed between two nodes of more slip, no reversal seen
    bend: float  # second derivative of slip speed there
    crossings: int  # reversals of slip within a few steps; a run of them counts once
    peak: float  # largest friction coefficient over one step
    lingered: float  # time with less slip than ``near``
    step: float  # the next one
    steps: int
    returned: bool
    z: Any
    turn: float  # largest rate at which slip passed through zero
    met: float  # most slip


class March(NamedTuple):
    """Laps of a motion: states [laps + 1], integrals of friction, times at rest and durations [laps]."""

    x: Any
    v: Any
    z: Any  # [laps + 1, memories]
    rubbed: Any
    stuck: Any
    duration: Any
    dip: float
    bend: float
    crossings: int
    lingered: float
    rate: float  # at which the last gaps shrank
    distance: float  # to the closed orbit, in the norm of energy
    verdict: int
    steps: int
    track: Track
    turn: float
    met: float


SHORT = 3
"""Steps at rest within which a reversal counts as one without stick."""

CLOSED, STALLED, LATE, LOST, RESTING, TIRED, TOO_FAST, TOO_STIFF = range(8)


# --- steppers -----------------------------------------------------------------------------------------------------

_moreau_step = moreau.stepper(restoring_force)


@embedded
def _jumping_rates(problem: Problem, j: int, x: Any, v: Any) -> Any:
    """Acceleration and friction coefficient, friction along the slip wherever there is any."""
    w = v - problem.grid[j, BELT].real
    rub = problem.law.sliding_vector(w) if length(w) > 0.0 else 0.0 * w
    return acceleration_under(
        problem.body, problem.grid[j, LOAD], problem.grid[j, NORMAL_LOAD].real, x, v, rub
    ), rub


_rk4_step = rk4.stepper(_jumping_rates)


@embedded
def _smooth_rates(problem: Problem, tau: float, x: Any, v: Any) -> Any:
    """Acceleration and friction coefficient of smoothed friction."""
    body, now = problem.body, instant_at(problem.body, tau)
    rub = smoothing.friction(problem, slip(body, problem.belt_speed, now, v))
    return acceleration(body, now, x, v, rub), rub


_smooth_step = dop853.stepper(_smooth_rates)


@inner
def _by_moreau(problem: Problem, node: Node, h: float) -> Advance:
    taken = _moreau_step(problem, node.k, node.x, node.v, h)
    return Advance(taken.x, taken.v, taken.rubbed, taken.stuck, 1.0, node.z)


@inner
def _by_rk4(problem: Problem, node: Node, h: float) -> Advance:
    taken = _rk4_step(problem, node.k, node.x, node.v, h)
    return Advance(taken.x, taken.v, taken.rubbed, taken.stuck, 1.0, node.z)


@inner
def _by_smoothed(problem: Problem, node: Node, h: float) -> Advance:
    """A step whose error decides how long it may be."""
    a, f = _smooth_rates(problem, node.tau, node.x, node.v)
    taken = _smooth_step(problem, node.tau, dop853.State(node.x, node.v, a, f), h)
    growth = growth_of(problem.body, taken, problem.accuracy)
    before = slip(problem.body, problem.belt_speed, instant_at(problem.body, node.tau), node.v)
    # Slip may have come and gone within the step: the error estimate can be blind to that.
    if growth >= 1.0 and length(taken.v - node.v) > 2.0 * length(before) + 8.0 * problem.width:
        growth = 0.5
    return Advance(taken.x, taken.v, taken.rubbed, False, growth, node.z)


# --- the record of an orbit ---------------------------------------------------------------------------------------


@inner
def _straight(part: float, problem: Problem, node: Node, end: Advance, h: float) -> Any:
    """A while into a step of which only the ends are known: velocity changes evenly, friction is its mean."""
    share, stray = part / h, end.x - node.x - 0.5 * h * (node.v + end.v)
    x = node.x + share * (h * (node.v + 0.5 * share * (end.v - node.v)) + stray)
    return x, node.v + share * (end.v - node.v), end.rubbed / h


@inner
def _curved(part: float, problem: Problem, node: Node, end: Advance, h: float) -> Any:
    """A while into a step of high order, which is taken anew to there."""
    taken, now = _by_smoothed(problem, node, part), instant_at(problem.body, node.tau + part)
    w = slip(problem.body, problem.belt_speed, now, taken.v)
    return taken.x, taken.v, smoothing.friction(problem, w)


note_straight, _note_curved = panel_writer(_straight), panel_writer(_curved)


# --- laps ---------------------------------------------------------------------------------------------------------


@inner
def grid_of(body: Body, belt_speed: float, span: float, steps: int, x: Any) -> Any:
    """What acts on a body at x at the half steps of a lap: found once, for laps are alike."""
    grid = np.full((2 * steps + 1, 3), 0.0 * x)
    for j in range(2 * steps + 1):
        now = instant_at(body, j * (0.5 * span / steps))
        grid[j, LOAD], grid[j, NORMAL_LOAD] = load(body, now), normal_load(body, now)
        grid[j, BELT] = belt_velocity(body, belt_speed, now)
    return grid


class Marcher(NamedTuple):
    """How one stepper advances, is noted and keeps a memory, and what friction can hold, as kernel functions."""

    name: str
    advance: Any
    note: Any
    held: Any
    keep: Any


def _named(name: str) -> Any:
    """``inner`` for a function made once for each stepper, under a name of its own.

    Compiled functions are linked by name and types alone: of two with the same, loaded from two caches, one would
    run in the place of the other.
    """

    def compile_as(function: Any) -> Any:
        function.__name__ = f"{function.__name__}_{name}"
        function.__qualname__ = function.__name__
        return inner(function)

    return compile_as


def marcher(stepper: Marcher) -> Any:
    """The kernel ``marched(law, body, way, x, v)`` of a stepper; numba caches none that is handed a function."""
    name, advance, note, held, keep = stepper
    slack = 1e-9 if name == "smoothed" else 0.5  # loads end with the last of equal steps, however rounded
    inner_of = _named(name)

    @inner_of  # type: ignore[untyped-decorator]
    def falling_zero(problem: Problem, node: Node, h: float) -> float:
        """When within a step the velocity along the belt falls to zero (Illinois regula falsi)."""
        low, high, side = 0.0, h, 0
        at_low, at_high = node.v.real, advance(problem, node, h).v.real
        part = h
        for _ in range(100):
            if at_high == 0.0 or high - low <= 1e-15 * (node.tau + h):
                break
            part = (low * at_high - high * at_low) / (at_high - at_low)
            value = advance(problem, node, part).v.real
            if value <= 0.0:
                high, at_high, at_low = part, value, 0.5 * at_low if side > 0 else at_low
                side = 1
            else:
                low, at_low, at_high = part, value, 0.5 * at_high if side < 0 else at_high
                side = -1
        return high

    @inner_of  # type: ignore[untyped-decorator]
    def lap(problem: Problem, way: MarchSettings, start: Node, h: float, track: Track) -> Lap:
        """From tau = 0 once around."""
        x, v, z = start.x, start.v, start.z
        end, tau, k, steps, turn, met = way.span, 0.0, 0, 0, 0.0, 0.0
        rubbed, stuck, dip, bend, crossings, peak, crossed = 0.0 * x, 0.0, 1e300, 1.0, 0, 0.0, False
        body, belt_speed, resting, lingered = problem.body, problem.belt_speed, 0, 0.0
        w = slip(body, belt_speed, instant_at(body, tau), v)
        speed, before, swing, mark = length(w), -1.0, length(v), 2.0 * math.pi
        marked, halted = rubbed, stuck
        while tau < end and steps < way.work:
            last = end - tau <= h * (1.0 + (slack if way.driven else 1e-9))
            node, step = Node(k, tau, x, v, z), end - tau if last else h
            taken = advance(problem, node, step)
            steps += 1
            if taken.growth < 1.0:
                h = step * taken.growth
                continue
            back = not way.driven and v.real > 0.0 and taken.v.real <= 0.0
            if back:
                last, step = True, falling_zero(problem, node, step)
                taken = advance(problem, node, step)
            if way.room > 0 and track.filled[0] < way.room:
                note(track, tau, step, taken.stuck, problem, node, taken, step)
            x, v, z = taken.x, taken.v, taken.z
            rubbed = rubbed + taken.rubbed
            stuck += step if taken.stuck else 0.0
            k += 1 if way.driven else 0
            tau = end if last and not back else tau + step
            ahead = slip(body, belt_speed, instant_at(body, tau), v)
            fresh, turned = length(ahead), (w * ahead.conjugate()).real
            # A minimum of the slip speed between two nodes: what the steps may have missed of a reversal there.
            if before >= speed < fresh and turned > 0.0 and speed < dip:
                dip, bend = speed, (before - 2.0 * speed + fresh) / (step * step)
            crossings += 1 if turned < 0.0 and not crossed and resting <= SHORT else 0
            turn = max(turn, length(ahead - w) / step) if turned < 0.0 else turn
            met = max(met, fresh)
            crossed = turned < 0.0
            before = speed if turned > 0.0 else -1.0
            peak = max(peak, length(taken.rubbed) / step)
            lingered += step if fresh < way.near else 0.0
            speed, resting = fresh, resting + 1 if fresh == 0.0 else 0
            w = ahead if fresh > 0.0 else w
            if back:
                return Lap(
                    x, v - v.real, rubbed, stuck, tau, dip, bend, crossings, peak, lingered, h, steps, True,
                    z, turn, met,
                )  # fmt: skip
            h = min(h * taken.growth, way.reach) if taken.growth > 1.0 else h
            if not way.driven:
                swing = max(swing, length(v))
                if tau >= mark:  # a mass at rest in the spring never returns
                    late = tau - mark + 2.0 * math.pi
                    if swing <= 1e-12 * (length(x) + 1e-3):
                        rubbed, stuck = rubbed - marked, stuck - halted
                        return Lap(
                            x, v, rubbed, stuck, late, dip, bend, crossings, peak, lingered, 0.0, steps, False,
                            z, turn, met,
                        )  # fmt: skip
                    marked, halted, mark, swing = rubbed, stuck, tau + 2.0 * math.pi, 0.0
            if fresh > way.fastest:
                break
        done = way.driven and tau >= end
        return Lap(
            x, v, rubbed, stuck, tau, dip, bend, crossings, peak, lingered, h, steps, done, z, turn, met
        )

    @inner_of  # type: ignore[untyped-decorator]
    def marched(law: Any, body: Body, way: MarchSettings, x: Any, v: Any) -> March:
        """From the state x, v lap by lap, until it repeats, stalls, or the laps are used up."""
        grid = grid_of(body, way.belt_speed, way.span, way.steps, x)
        problem = Problem(law, body, way.belt_speed, grid, way.theta, way.width, way.shape, way.accuracy)
        xs, vs = np.empty(way.most + 1, np.complex128), np.empty(way.most + 1, np.complex128)
        rubs = np.empty(way.most, np.complex128)
        stuck, duration, gaps = np.empty(way.most), np.empty(way.most), np.empty(way.most)
        track = track_of(way.room)
        zs = np.empty((way.most + 1, way.spring.size), np.complex128)
        xs[0], vs[0] = x + 0j, v + 0j
        keep(zs, 0, way.z)
        one = Lap(x, v, 0.0 * x, 0.0, 0.0, 1e300, 1.0, 0, 0.0, 0.0, way.first, 0, True, way.z, 0.0, 0.0)
        carried = 0.0
        distance, good, steps, verdict, n = 1e300, 0, 0, LATE, 0
        carries = abs(belt_path(body, way.belt_speed, 0.0, way.span))
        drift = carries * (body.stiffness_mean + body.stiffness_split) / body.normal_load
        while n < way.most and verdict == LATE:
            one = lap(problem, way, Node(0, 0.0, one.x + carried, one.v, one.z), one.step, track)
            carried = 0.0
            steps += one.steps
            xs[n + 1], vs[n + 1], rubs[n] = one.x + 0j, one.v + 0j, one.rubbed + 0j
            keep(zs, n + 1, one.z)
            stuck[n], duration[n] = one.stuck, one.duration
            n += 1
            if one.met > way.fastest:
                verdict = TOO_FAST
            elif not squared(body, one.x, one.v) < 1e300:
                verdict = LOST
            elif not one.returned:
                verdict = RESTING if one.step == 0.0 else LOST if one.steps < way.work else TIRED
            elif n >= way.stride:
                gap = squared(body, xs[n] - xs[n - way.stride], vs[n] - vs[n - way.stride])
                for k in range(way.spring.size):
                    gap += way.spring[k] * abs(zs[n, k] - zs[n - way.stride, k]) ** 2
                gap = math.sqrt(gap)
                gaps[n - 1] = gap
                floor = 4e-16 * math.sqrt((100.0 + one.steps) * squared(body, one.x, one.v))
                distance = _distance(gaps, n, way, floor)
                good = good + 1 if distance <= way.enough else 0
                if good > (0 if way.rate > 0.0 else 2 * way.stride) or gap == 0.0:
                    verdict = CLOSED
                elif way.driven and one.stuck > 0.999999 * way.span:
                    # Carried by the belt all the time: go on by many laps at once, but not beyond release.
                    many = math.floor((held(law) - one.peak) / drift) - 1.0
                    if way.stride == 1 and many > 1.0:
                        carried = belt_path(body, way.belt_speed, 0.0, many * way.span)
                elif _stalled(body, gaps, xs, vs, n, way):
                    verdict = STALLED
                elif steps > way.work:
                    verdict = TIRED
        return March(
            xs[: n + 1], vs[: n + 1], zs[: n + 1], rubs[:n], stuck[:n], duration[:n],
            one.dip, one.bend, one.crossings, one.lingered, _rate(gaps, n, way.stride), distance, verdict, steps,
            track,
            one.turn, one.met,
        )  # fmt: skip

    return marched


@inner
def _rate(gaps: Any, n: int, stride: int) -> float:
    """At which the last gaps shrank, by the slowest of three looks back; 0 where there are too few."""
    if n < 7 * stride or gaps[n - 1 - 6 * stride] == 0.0:
        return 0.0
    gap, rate = gaps[n - 1], 0.0
    for back in (1, 5, 50):
        if n > (back + 1) * stride and gaps[n - 1 - back * stride] > 0.0:
            rate = max(rate, math.pow(gap / gaps[n - 1 - back * stride], 1.0 / back))
    return rate


@inner
def _distance(gaps: Any, n: int, way: MarchSettings, floor: float) -> float:
    """What is left to the closed orbit, from the last gap and the rate at which gaps shrink."""
    gap = gaps[n - 1]
    if gap <= floor:
        return 10.0 * gap
    rate = _rate(gaps, n, way.stride)
    if rate == 0.0:
        rate = way.rate
    return gap / (1.0 - rate) if 0.0 < rate < 0.9999999 else 1e7 * gap


@inner
def _stalled(body: Body, gaps: Any, xs: Any, vs: Any, n: int, way: MarchSettings) -> bool:
    """Whether the gaps have stopped to shrink, and lead nowhere: a slow drift towards the orbit is no stall."""
    half = way.window * way.stride
    if n < 2 * half + way.stride:
        return False
    early, late = 0.0, 0.0
    for i in range(n - half, n):
        late += gaps[i]
        early += gaps[i - half]
    led = math.sqrt(squared(body, xs[n] - xs[n - half], vs[n] - vs[n - half]))
    return late > 0.98 * early and led < 0.3 * late / way.stride


@inner
def _at_rest(law: Any) -> float:
    """What friction of a law without memory can hold."""
    return law.static_friction()


@inner
def keep_number(kept: Any, row: int, z: Any) -> None:
    """Write down a memory that is one number."""
    kept[row, 0] = z


march_moreau = marcher(Marcher("moreau", _by_moreau, note_straight, _at_rest, keep_number))
march_rk4 = marcher(Marcher("rk4", _by_rk4, note_straight, _at_rest, keep_number))
march_smoothed = marcher(Marcher("smoothed", _by_smoothed, _note_curved, _at_rest, keep_number))
