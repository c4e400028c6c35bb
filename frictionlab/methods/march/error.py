"""The mean of a motion by time stepping and its error, from runs at several steps or smoothing widths.

The limit of a sequence of values from halved steps or halved smoothing widths, with an error bound.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from frictionlab.methods.march.laps import CLOSED, LATE, STALLED, TIRED, TOO_FAST, TOO_STIFF
from frictionlab.methods.march.run import MarchResult, MarchRun
from frictionlab.methods.march.steppers import MARGIN, Resolution, StepperName, lightest_contact

SURE = 0.25
"""Largest relative deviation of the observed ratio of two changes from that of the order."""
FEWEST = 4
"""Values needed to observe an order twice."""


class Limit(NamedTuple):
    """The limit of a sequence, a bound on its error, and the order used for extrapolation."""

    value: float
    error: float
    order: int  # 0: none was observed


SMOOTH, STICKING, REVERSING = 0.2, 1.0, math.inf
"""Smallest share of Richardson's correction that is added to the error: for smooth motion; for stick, which keeps the
order but not the regularity of the error; for reversals inside a step, where errors are irregular."""


def richardson(values: Sequence[float], order: int, least: float) -> Limit:
    """The limit of values from steps halved each time, of a method of this order on smooth motion.

    Where two consecutive ratios of changes agree with the order: Richardson's extrapolation (1911), with at least the
    share ``least`` of the correction as error. Otherwise the last value with an error of order one: 1.5 times the
    largest of the last three changes, each divided by 2 (without reversals 3) per halving since.
    """
    changes = np.diff(values)
    if len(values) >= FEWEST and least < math.inf and _seen(changes, order):
        rest = changes[-1] / (2.0**order - 1.0)
        doubt = 2.0 * abs(changes[-2] / changes[-1] / 2.0**order - 1.0)
        return Limit(float(values[-1] + rest), float(abs(rest) * max(least, doubt)), order)
    rate = 2.0 if least == REVERSING else 3.0
    recent = [abs(change) / rate**age for age, change in enumerate(changes[::-1][:3])]
    return Limit(float(values[-1]), 1.5 * float(max(recent)), 0)


def _seen(changes: np.ndarray, order: int) -> bool:
    """Whether the last three changes decrease in the ratio of the order."""
    if (changes[-3:] == 0.0).any():
        return False
    ratios = changes[-3:-1] / changes[-2:]
    return bool((np.abs(ratios / 2.0**order - 1.0) < SURE).all())


SLOWEST = 0.8
"""Largest ratio of a change to the one before at which errors of steps that are still too long are taken to fall."""


def first_error(values: Sequence[float]) -> float:
    """Bound on the distance of the first of three values to the limit, from those of steps halved once and twice.

    At order one with half as much again; where both changes go one way and the second is more than half the first,
    at the ratio that is seen: steps that are still too long converge more slowly than their order says.
    """
    first, last = values[1] - values[0], values[2] - values[1]
    seen = min(last / first, SLOWEST) if first * last > 0.0 else 0.0
    return max(1.5 * max(abs(first), abs(first + last)), abs(first + last / (1.0 - seen)))


def bias(wide: float, asked: float, narrow: float, narrowest: float) -> float:
    """Bound on the bias of smoothing at a width, from the values at twice, once, half and a quarter of that width.

    A bias of order q in the width is 1/(1 - 2^-q) times its change from the width to half of it, and 1/(1 - 4^-q)
    times that to a quarter: 3.4 and 2 for the square root, the slowest; the latter is taken as 3, for at the onset of
    stick the bias is slower to begin with, and as 6 where the changes still grow as the width shrinks. Where the bias
    changes sign with the width one of the changes may be small, so the largest counts.
    """
    still_growing = abs(narrow - narrowest) > abs(asked - narrow)
    far = 6.0 if still_growing else 3.0
    return max(3.5 * abs(asked - narrow), far * abs(asked - narrowest), 1.75 * abs(wide - asked))


COARSEST, WORK = 64, 16_000_000
"""Steps per period to begin with, and steps in all that a point may cost, where ``steps`` is left out."""
MOST_WORK, MOST_ADAPTIVE = 500_000_000, 10_000_000
"""Steps of one run, where they are given, and where they are adaptive."""
FEWEST_LAPS = 10
NONE = 1e200
"""A least slip speed above this stands for none."""
ROUNDING = 1e-13
"""Rounding error of the mean coefficient from summing the impulses of a period."""


class Plan(NamedTuple):
    """The parameters of a study for time stepping, defaults filled in."""

    stepper: StepperName
    theta: float
    order: int  # on smooth motion; of fixed steps
    steps: int | None
    width: float
    smoothing: str
    periods: int


@dataclass(frozen=True)
class MarchMean:
    """A mean with its error, the period [time], and the runs it was computed from, the finest last."""

    mean: complex
    error: float
    period: float
    runs: tuple[MarchResult, ...]
    how: str


def march_mean(march: MarchRun, plan: Plan, tolerance: float) -> MarchMean:
    """The mean by this plan; without an error where a run did not settle."""
    if march.facts.adaptive:
        return _by_widths(march, plan, tolerance)
    return _by_given_steps(march, plan, tolerance) if plan.steps else _by_halving(march, plan, tolerance)


# --- fixed steps --------------------------------------------------------------------------------------------------


def _by_given_steps(march: MarchRun, plan: Plan, tolerance: float) -> MarchMean:
    """The mean at a given number of steps; its error from runs of twice and four times as many."""
    assert plan.steps is not None
    runs: list[MarchResult] = []
    for steps in (plan.steps, 2 * plan.steps, 4 * plan.steps):
        runs.append(_next_run(march, plan, steps, runs, tolerance))
        if not runs[-1].settled:
            return _unsettled(runs)
    first = runs[0]
    doubt = first_error([run.mean.real for run in runs])
    doubt = 2.0 * doubt if _ends_of_stick_vary(march, first) else doubt
    doubt += max(_unseen(march, runs[:2]), _unseen(march, runs[1:]))
    error = (
        doubt
        + crossing(march, first)
        + _creep(march, first)
        + sum(run.closing for run in runs)
        + _rounding(first)
    )
    return MarchMean(first.mean, error, first.period, tuple(runs), f"{plan.steps} steps per period")


def _by_halving(march: MarchRun, plan: Plan, tolerance: float) -> MarchMean:
    """Steps are doubled until the error is below the tolerance or the work is done."""
    # what the motion asks for, and what the stepper needs not to explode
    steps, work = max(COARSEST * _slowness(march), march.fewest()), 0
    runs: list[MarchResult] = []
    best: MarchMean | None = None
    while best is None or best.error > tolerance:
        run = _next_run(march, plan, steps, runs, tolerance, WORK - work)
        work += run.steps
        if not run.settled:
            more = steps_needed(march, run)
            if 3 * FEWEST_LAPS * more > WORK - work:
                break
            runs, steps = [], math.ceil(more)
            continue
        runs.append(run)
        if len(runs) >= FEWEST:
            best = _limit(march, plan, runs)
        if work + 2 * run.steps * min(1.0, 12 / run.laps) > WORK or _changes_for_ever(runs, march):
            break
        steps *= 2
    if best is None and len(runs) > 1 and run.verdict != TOO_STIFF:
        best = _limit(march, plan, runs)
    return best or _unsettled([*runs, run])


def steps_needed(march: MarchRun, run: MarchResult) -> float:
    """Steps per period that would be stable where those of a run were not; infinite where it failed otherwise."""
    if run.verdict == TOO_FAST:
        return 1.5 * run.pace.steps * run.met / march.fastest(run.pace)
    return MARGIN * march.through_rest if run.verdict == TOO_STIFF else math.inf


def _limit(march: MarchRun, plan: Plan, runs: list[MarchResult]) -> MarchMean:
    last, every = runs[-1], runs
    runs = [run for run in runs if (run.verdict, run.stride) == (last.verdict, last.stride)]
    runs = runs if len(runs) > 1 else every
    unseen = _unseen(march, runs[-3:])
    reversing = unseen > 0.0 or len(runs) < len(every) or any(run.crossings > 0 for run in runs[-3:])
    reversing = reversing or last.verdict == STALLED or march.has_corners or _ends_of_stick_vary(march, last)
    least = REVERSING if reversing else STICKING if last.stuck > 0.0 else SMOOTH
    along = richardson([run.mean.real for run in runs], plan.order, least)
    across = richardson([run.mean.imag for run in runs], plan.order, least)
    period = richardson([run.period for run in runs], plan.order, least)
    error = (
        along.error + unseen + crossing(march, last) + _creep(march, last) + last.closing + _rounding(last)
    )
    error += runs[-2].closing if along.order else 0.0
    how = f"{last.pace.steps} steps per period"
    how += f", extrapolated at order {along.order}" if along.order else ""
    return MarchMean(complex(along.value, across.value), error, period.value, tuple(runs), how)


def _ends_of_stick_vary(march: MarchRun, run: MarchResult) -> bool:
    """Whether stick begins and ends anywhere in steps that are of several lengths, or under loads of several waves:
    errors fall with the steps, but irregularly."""
    return bool(march.mass.varying) and run.stuck > 0.0


def _rounding(run: MarchResult) -> float:
    """Of the sums of a period's impulses."""
    return ROUNDING * (1.0 + 1e-3 * run.pace.steps)


def _next_run(
    march: MarchRun,
    plan: Plan,
    steps: int,
    runs: Sequence[MarchResult],
    tolerance: float,
    work: int = MOST_WORK,
) -> MarchResult:
    """A run of so many steps per period, from where the last one ended."""
    before = runs[-1] if runs else None
    share = max(0.05 * tolerance, 0.02 * _expected(march, runs, steps))
    pace = Resolution(
        steps=steps,
        refined=steps // runs[0].pace.steps if runs else 1,
        theta=plan.theta,
        enough=0.25 * share * march.mass.normal_load,
        most=plan.periods,
        work=max(work, FEWEST_LAPS * steps),
        rate=before.rate if before is not None and before.verdict == CLOSED else 0.0,
    )
    return march.run(pace, before.place if before is not None and march.forgets else None)


def _expected(march: MarchRun, runs: Sequence[MarchResult], steps: int) -> float:
    """The expected error of the mean at this number of steps; small enough at first not to limit the result."""
    if len(runs) < 2:
        return 0.1 * march.law.sliding_friction(1.0) / steps
    change = abs(runs[-1].mean.real - runs[-2].mean.real)
    return max(0.25 * change, crossing(march, runs[-1]) * runs[-1].pace.steps / steps)


def crossing(march: MarchRun, run: MarchResult) -> float:
    """What reversals inside a step may cost: of the impulse of that step, a grid knows the sign but not the share.

    A release costs the drop of friction from rest to slip in the same way. Several grids in a row can round either
    the same way, and then no change between them tells of it.
    """
    per_period = run.pace.steps * run.period / march.drive_period
    slip = march.slipping
    if march.law.count() > 0:
        turns = run.crossings * _unresolved(march, run) + run.flips * run.stride * _unresolved_jump(
            march, run
        )
        return slip * turns / per_period
    release = march.at_rest - slip if run.stuck > 0.0 else 0.0
    return (slip * run.crossings + release * run.stride) / per_period


def _unresolved(march: MarchRun, run: MarchResult) -> float:
    """How much of the impulse of the step in which slip reverses is in doubt: bristles take time to bend back.

    Until slip that gathers speed at the rate a has covered the presliding length d: sqrt(2 d/a). A step h misplaces
    a path of at most a h^2/8 to either side, a part (h/time)^2/4 of that length, and for as long as that time the
    friction is off by this part of its jump, 2 at most.
    """
    step, presliding = _step(march, run), lightest_contact(march.scene) * march.law.presliding()
    if run.turn == 0.0:
        return 0.0
    bending = math.sqrt(2.0 * presliding / run.turn)
    return min(1.0, 0.5 * step / bending) if bending > 0.0 else 1.0


def _unresolved_jump(march: MarchRun, run: MarchResult) -> float:
    """The same where slip reverses by a jump of the belt: it covers the presliding length at once at its speed."""
    presliding = lightest_contact(march.scene) * march.law.presliding()
    return min(1.0, 0.5 * _step(march, run) * run.met / presliding) if presliding > 0.0 else 1.0


def _step(march: MarchRun, run: MarchResult) -> float:
    return run.period / run.stride / march.periods / run.pace.steps if run.pace.steps else 0.0


def _creep(march: MarchRun, run: MarchResult) -> float:
    """Where creep hides stick, friction may have any value while it does."""
    return 2.0 * march.at_rest * run.creeping


def _unseen(march: MarchRun, runs: Sequence[MarchResult]) -> float:
    """What a reversal would cost that the last grid does not see, slip being least between two of its nodes.

    The least slip is known as well as it agrees between runs, and as the nodes around it are close. A reversal
    that deep in a parabola of that bend lasts so long, with friction reversed. Where the last grid sees contact and
    the one before did not, it may still be as much deeper.
    """
    *earlier, fine = runs
    missed = [run.dip for run in earlier if run.dip < NONE]
    if fine.dip < NONE:
        node = fine.period / fine.stride / march.periods / fine.pace.steps
        depth = 1.5 * max([abs(dip - fine.dip) for dip in missed] or [fine.dip])
        depth += 0.125 * fine.bend * node**2 - fine.dip
        bend = fine.bend
    else:
        depth = 1.5 * max(missed, default=0.0)
        bend = max((run.bend for run in earlier if run.dip < NONE), default=0.0)
    if not (depth > 0.0 and bend > 0.0):
        return 0.0
    lasts = min(2.0 * math.sqrt(2.0 * depth / bend), fine.period)
    return 2.0 * march.slipping * lasts / fine.period


def _slowness(march: MarchRun) -> int:
    """Steps are counted per period; a slow drive needs more of them for the body's own motion."""
    mass = march.mass
    quickest = max(1.0, mass.damping)
    if mass.varying:
        quickest = max(quickest, mass.varying.quickest)
    if not march.straight:
        quickest = max(quickest, math.sqrt(mass.transverse_stiffness), mass.transverse_damping)
    return max(1, math.ceil(quickest / mass.frequency - 1e-9))


def _changes_for_ever(runs: Sequence[MarchResult], march: MarchRun) -> bool:
    """Whether finer steps calm a motion that does not repeat no more."""
    return len(runs) >= FEWEST and all(run.verdict == STALLED for run in runs[-3:]) and restless(runs, march)


def restless(runs: Sequence[MarchResult], march: MarchRun) -> bool:
    """Whether the motion itself never repeats: the spread of its means is there, and does not shrink with the steps.

    A thousandth of the friction at rest passes for noise, and is left to the error.
    """
    early, last = runs[max(0, len(runs) - 3)], runs[-1]
    spread = last.high - last.low
    seen = last.verdict == STALLED == early.verdict and spread > 1e-3 * march.at_rest
    return not march.converges and seen and spread > 0.5 * (early.high - early.low)


def why_not(run: MarchResult) -> str:
    """Why a run has no steady state, as the continuation of "the motion"."""
    if run.verdict == LATE:
        return (
            f"still changes by {run.drift:.1e} a period after {run.laps} periods (at most {run.pace.most}); "
            f"give more periods"
        )
    if run.verdict == TOO_FAST and math.isfinite(run.met):
        return f"slips faster, at {run.met:.3g}, than {run.pace.steps} steps per period are stable for"
    if run.verdict == TOO_STIFF:
        return f"comes to rest, where the law is too stiff for {run.pace.steps} explicit steps per period"
    if run.verdict == TIRED:
        return f"is not periodic within {run.steps:.1g} steps ({run.laps} periods); give fewer or wider ones"
    return f"is not finite after {run.laps} periods: it grows without bound, or never returns; give shorter steps"


def _unsettled(runs: Sequence[MarchResult]) -> MarchMean:
    return MarchMean(complex(math.nan), math.nan, math.nan, tuple(runs), "")


# --- smoothed friction --------------------------------------------------------------------------------------------


def _by_widths(march: MarchRun, plan: Plan, tolerance: float) -> MarchMean:
    """The mean of this width; twice, half and a quarter of it tell the bias, a run of looser steps their error."""
    load = march.mass.normal_load * march.law.sliding_friction(plan.width)
    accuracy = max(min(1e-5 * tolerance * load, 1e-3 * plan.width, 1e-6 * load), 1e-13 * load)
    pace = Resolution(
        width=plan.width,
        smoothing=plan.smoothing,
        accuracy=accuracy,
        enough=1e3 * accuracy,
        most=plan.periods,
        work=MOST_ADAPTIVE,
    )
    paces = {
        "loose": replace(pace, accuracy=32.0 * accuracy, enough=32e3 * accuracy),
        "wide": replace(pace, width=2.0 * plan.width),
        "narrow": replace(pace, width=0.5 * plan.width),
        "narrowest": replace(pace, width=0.25 * plan.width),
        "asked": pace,
    }
    runs: dict[str, MarchResult] = {}
    place = None
    for name, one in paces.items():
        runs[name] = march.run(one, place)
        if not runs[name].settled:
            return _unsettled(list(runs.values()))
        place = runs[name].place if march.forgets else None
    means = {name: run.mean.real for name, run in runs.items()}
    error = bias(means["wide"], means["asked"], means["narrow"], means["narrowest"]) + abs(
        means["loose"] - means["asked"]
    )
    error += runs["asked"].closing + runs["narrowest"].closing + _creep(march, runs["asked"]) + ROUNDING
    asked = runs["asked"]
    return MarchMean(
        asked.mean, error, asked.period, tuple(runs.values()), f"{plan.smoothing} of width {plan.width:g}"
    )
