"""Kernels of time stepping: laps of a motion, one after the other, until it repeats."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_law
from frictionlab.compile.stack import items_of, room
from frictionlab.methods.march.adapters import MarchProblem
from frictionlab.methods.march.lap import (
    NOTHING,
    Lap,
    MarchSettings,
    SlipTrace,
    march_lap,
    piece_end,
    steps_in,
)
from frictionlab.motion.equation import (
    bare,
    belt_advance,
    belt_velocity,
    in_piece,
    instant_at,
    load,
    look_ahead,
    normal_load,
    piece_ends,
    pieces_of,
    runs_away,
)
from frictionlab.motion.orbit.recorder import Track, track_of
from frictionlab.motion.steppers.step import BELT, COLUMNS, GRID_NODES, LOAD, NORMAL_LOAD, StepStart, squared
from frictionlab.scene.body import BodyNumbers

CLOSED, STALLED, LATE, LOST, RESTING, TIRED, TOO_FAST, TOO_STIFF = range(8)
"""Verdicts on a march: it repeats; nears no orbit any more; has used up its laps; is not finite; rests in the spring;
has used up its steps; slips faster than the steps bear; is too stiff for them where slip comes to rest.
"""


class MarchState(NamedTuple):
    """Position and velocity, real along the belt and else x1 + i x2, and what the law remembers [numbers]."""

    x: Any
    v: Any
    z: Any = NOTHING


class LapsMarched(NamedTuple):
    """Laps of a motion: states [laps + 1], friction impulses, durations and gaps [laps]."""

    x: Any
    v: Any
    z: Any  # [laps + 1, memories]
    impulse: Any
    duration: Any
    gaps: Any  # to the state ``stride`` laps earlier, in the energy norm


class MarchProgress(NamedTuple):
    """State of a march."""

    laps: int
    steps: int
    distance: float  # to the closed orbit, in the energy norm
    good: int  # laps for which that was small enough
    verdict: int


class MarchHistory(NamedTuple):
    """Result of a march; trace: of the last lap."""

    laps: LapsMarched
    trace: SlipTrace
    progress: MarchProgress
    rate: float  # at which the last gaps shrank
    track: Track
    grid: Any  # what acted at the nodes of steps: kernels hold a pointer to it until the march ends


@inner
def _fill_node(body: BodyNumbers, belt_speed: float, tau: float, grid: Any, j: int) -> None:
    now = instant_at(body, tau)
    grid[COLUMNS * j + LOAD] = load(body, now)
    grid[COLUMNS * j + NORMAL_LOAD] = normal_load(body, now)
    grid[COLUMNS * j + BELT] = belt_velocity(body, belt_speed, now)


@inner
def grid_of(body: BodyNumbers, settings: MarchSettings, x: Any) -> Any:
    """Return what acts on a body at x at the nodes of a lap: computed once, for laps are alike."""
    gridded, total = settings.driven and settings.refined > 0, 1
    for k in range(pieces_of(body) if gridded else 0):
        total += steps_in(settings, piece_end(body, settings, k) - piece_ends(body, k)[0])
    grid, j = np.full(GRID_NODES * COLUMNS * total, 0.0 * x), 0
    if not gridded:  # nothing varies, or the stepper looks for itself
        for part in range(GRID_NODES):
            _fill_node(body, settings.belt_speed, 0.0, grid, part)
    for k in range(pieces_of(body) if gridded else 0):
        # From the piece itself, ends included: a neighbour may have other values there.
        piece, begin, end = in_piece(body, k), piece_ends(body, k)[0], piece_end(body, settings, k)
        half_steps = 2 * steps_in(settings, end - begin)
        for i in range(half_steps // 2):
            for part in range(GRID_NODES):
                tau = begin + (end - begin) * ((2 * i + part) / half_steps)
                _fill_node(piece, settings.belt_speed, tau, grid, j)
                j += 1
    return grid


# --- laps until the motion repeats --------------------------------------------------------------------------------


largest_hold = by_law(lambda law: law.static_friction(), lambda law: 0.0, lambda law: 0.0)
"""largest_hold(law): the coefficient up to which friction holds a mass at rest; with memory the contact gives."""


@inner
def laps_of(settings: MarchSettings) -> LapsMarched:
    """Arrays for the most laps there may be: not filled, for most are never touched."""
    most = settings.most
    return LapsMarched(
        np.empty(most + 1, np.complex128),
        np.empty(most + 1, np.complex128),
        np.empty((most + 1, settings.spring.size), np.complex128),
        np.empty(most, np.complex128),
        np.empty(most),
        np.empty(most),
    )


@inner
def keep_state(laps: LapsMarched, n: int, x: Any, v: Any, problem: MarchProblem) -> None:
    """Write down the state after n laps; zero for the memory of a law that has none."""
    laps.x[n], laps.v[n] = x + 0j, v + 0j
    for k in range(laps.z.shape[1]):
        laps.z[n, k] = problem.memory[k]


@inner
def gap_after(laps: LapsMarched, n: int, body: BodyNumbers, settings: MarchSettings) -> float:
    """Return how far the state after n laps is from that a stride earlier, in the energy norm."""
    before = n - settings.stride
    gap = squared(body, laps.x[n] - laps.x[before], laps.v[n] - laps.v[before])
    for k in range(settings.spring.size):
        gap += settings.spring[k] * abs(laps.z[n, k] - laps.z[before, k]) ** 2
    return math.sqrt(gap)


@inner
def shrinking_rate(gaps: Any, n: int, stride: int) -> float:
    """At which the last gaps shrank, by the slowest of three looks back; 0 where there are too few."""
    if n < 7 * stride or gaps[n - 1 - 6 * stride] == 0.0:
        return 0.0
    # One lap back, five and fifty: gaps that swing, or shrink by less than rounding, mislead a single look.
    gap, rate = gaps[n - 1], 0.0
    for back in (1, 5, 50):
        if n > (back + 1) * stride and gaps[n - 1 - back * stride] > 0.0:
            rate = max(rate, math.pow(gap / gaps[n - 1 - back * stride], 1.0 / back))
    return rate


@inner
def distance_left(gaps: Any, n: int, settings: MarchSettings, floor: float) -> float:
    """Return what is left to the closed orbit, from the last gap and the rate at which gaps shrink."""
    gap = gaps[n - 1]
    # Rounding alone keeps a gap this small open.
    if gap <= floor:
        return 10.0 * gap
    # Gaps that shrink like a geometric series leave gap/(1 - rate); next to no shrinking tells nothing.
    rate = shrinking_rate(gaps, n, settings.stride)
    if rate == 0.0:
        rate = settings.rate
    return gap / (1.0 - rate) if 0.0 < rate < 0.9999999 else 1e7 * gap


@inner
def has_stalled(body: BodyNumbers, laps: LapsMarched, n: int, settings: MarchSettings) -> bool:
    """Check whether the gaps have stopped to shrink, and lead nowhere: a slow drift towards the orbit is no stall."""
    half = settings.window * settings.stride
    if n < 2 * half + settings.stride:
        return False
    # Two windows beside each other: gaps of the later must be no smaller, and lead nowhere in all.
    early, late = 0.0, 0.0
    for i in range(n - half, n):
        late += laps.gaps[i]
        early += laps.gaps[i - half]
    led = math.sqrt(squared(body, laps.x[n] - laps.x[n - half], laps.v[n] - laps.v[n - half]))
    return late > 0.98 * early and led < 0.3 * late / settings.stride


@inner
def sticks_all_along(settings: MarchSettings, lap: Lap) -> bool:
    """Check whether the belt carried the mass for a whole period of the drive."""
    return settings.driven and lap.tally.stuck > 0.999999 * settings.span


@inner
def verdict_on_lap(body: BodyNumbers, settings: MarchSettings, lap: Lap) -> int:
    """Return the verdict where the last lap alone decides; LATE where it went well."""
    if lap.trace.met > settings.fastest:
        return TOO_FAST
    if not squared(body, lap.x, lap.v) < 1e300 or runs_away(body, lap.x):
        return LOST
    if lap.returned:
        return LATE
    if lap.step == 0.0:
        return RESTING
    return LOST if lap.steps < settings.work else TIRED


@inner
def progress_after(
    progress: MarchProgress, body: BodyNumbers, settings: MarchSettings, laps: LapsMarched, lap: Lap
) -> MarchProgress:
    """Return the progress with one more lap, which is written down already."""
    n, steps, verdict = progress.laps + 1, progress.steps + lap.steps, verdict_on_lap(body, settings, lap)
    if verdict != LATE or n < settings.stride:
        return MarchProgress(n, steps, progress.distance, progress.good, verdict)
    # The distance to the orbit is told by the gap and by how fast gaps shrink, down to the rounding of a lap.
    gap = gap_after(laps, n, body, settings)
    laps.gaps[n - 1] = gap
    floor = 4e-16 * math.sqrt((100.0 + lap.steps) * squared(body, lap.x, lap.v))
    distance = distance_left(laps.gaps, n, settings, floor)
    good = progress.good + 1 if distance <= settings.enough else 0
    # A rate known from a coarser run is believed at once; one just seen must hold for some laps.
    if good > (0 if settings.rate > 0.0 else 2 * settings.stride) or gap == 0.0:
        verdict = CLOSED
    # Carried by the belt all the time it nears no orbit until it is released: that is no stall.
    elif sticks_all_along(settings, lap):
        verdict = LATE
    elif has_stalled(body, laps, n, settings):
        verdict = STALLED
    elif steps > settings.work:
        verdict = TIRED
    return MarchProgress(n, steps, distance, good, verdict)


@inner
def path_stuck(law: Any, body: BodyNumbers, settings: MarchSettings, lap: Lap) -> float:
    """Carry a mass that stuck for a whole lap with the belt, by as many laps at once as it surely sticks."""
    if settings.stride > 1 or not (lap.returned and sticks_all_along(settings, lap)):
        return 0.0
    carried = belt_advance(body, settings.belt_speed)
    carries = abs(carried)
    if carries == 0.0 or look_ahead(body) < 1e300:
        return 0.0
    drift = carries * (body.stiffness_mean + body.stiffness_split) / body.normal_load
    # Not beyond release: one lap less than what friction can hold allows.
    many = math.floor((settings.lightest * largest_hold(law) - lap.tally.peak) / drift) - 1.0
    return many * carried if many > 1.0 else 0.0


@inner
def march_laps(
    law: Any, given: BodyNumbers, stepper: Any, settings: MarchSettings, start: MarchState
) -> MarchHistory:
    """From a state lap by lap, until it repeats, stalls, or the laps are used up."""
    # What acts and what is remembered are bare pointers to steppers: the first to an array kept until the end, the
    # others to this function's stack.
    body = bare(given, given.varying.table)
    grid, item = grid_of(body, settings, start.x), start.z[0]
    memory, ahead = room(law, 1, 1, item), room(law, 1, 1, item)
    problem = MarchProblem(law, body, settings.belt_speed, stepper, items_of(grid), memory, ahead)
    laps, track = laps_of(settings), track_of(settings.room)
    for k in range(start.z.size):
        memory[k] = start.z[k]
    keep_state(laps, 0, start.x, start.v, problem)
    # Lap by lap, each from where the last one ended and with the step that it ended with.
    trace, x, v, step = SlipTrace(start.v, 0.0, False), start.x, start.v, settings.first
    progress = MarchProgress(0, 0, 1e300, 0, LATE)
    while progress.laps < settings.most and progress.verdict == LATE:
        lap = march_lap(problem, settings, StepStart(0, 0.0, x, v), step, track)
        n = progress.laps
        keep_state(laps, n + 1, lap.x, lap.v, problem)
        laps.impulse[n], laps.duration[n] = lap.tally.impulse + 0j, lap.duration
        progress = progress_after(progress, body, settings, laps, lap)
        trace, x, v, step = lap.trace, lap.x + path_stuck(law, body, settings, lap), lap.v, lap.step
    n = progress.laps
    marched = LapsMarched(
        laps.x[: n + 1], laps.v[: n + 1], laps.z[: n + 1], laps.impulse[:n], laps.duration[:n],
        laps.gaps[:n],
    )  # fmt: skip
    # The grid is named once more, for numba lets go of an array after its last use.
    return MarchHistory(marched, trace, progress, shrinking_rate(laps.gaps, n, settings.stride), track, grid)
