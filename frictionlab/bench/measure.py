"""Time and error of every method and peer on every workload."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from frictionlab.bench.first_run import first_run
from frictionlab.bench.forecast import Expected, Forecast
from frictionlab.bench.peers.base import Peer
from frictionlab.bench.record import Bench, BenchSetting, Contender, ReferenceMeans, Workload
from frictionlab.bench.references import independent, reference_means
from frictionlab.bench.sections import SectionResult
from frictionlab.bench.solvers import (
    SolverAnswers,
    mean_task,
    model_task,
    seconds_per_point,
    solve_points,
    whole_task,
)
from frictionlab.bench.timing import Times, time_task
from frictionlab.compile.call import compiling_at_once
from frictionlab.methods.base import Method, ReducedModel
from frictionlab.quantities import Floats

BENCH_STATUSES = ("ok", "refused", "failed", "not_unique")
NO_TIME = Times(math.nan, (math.nan,) * 3, 0)


@dataclass(frozen=True)
class Row:
    """One contender at one setting on one workload; points: those it was given, times: per point that has an answer.

    model: of a reduced model for its mean friction alone; mean: for the mean friction and its error, of a reduced
    model the price of its error included; whole: with every other column; first: processor time [s] of the
    whole curve where no kernel is compiled yet, NaN where that was not measured. ``covered``: points whose
    stated error, with the reference's own, covers their error; None without a reference, and for a peer, which states
    none.
    """

    contender: Contender
    setting: BenchSetting
    points: int
    counts: dict[str, int]
    reason: str
    largest: float
    median: float
    stated: float
    covered: int | None
    mean: Times
    whole: Times
    reference: ReferenceMeans | None
    model: Times = NO_TIME
    first: float = math.nan

    @property
    def error_alone(self) -> float:
        """Seconds per point that a reduced model's stated error costs; NaN of others."""
        return self.mean.least - self.model.least


@dataclass(frozen=True)
class WorkloadResult:
    """A workload with its references and rows; missing: peers that are not installed, with the remedy."""

    work: Workload
    references: list[ReferenceMeans]
    rows: list[Row]
    missing: dict[str, str] = field(default_factory=dict)


def measure(
    bench: Bench, tell: Callable[[str], None], first_runs: bool = False
) -> Iterator[WorkloadResult | SectionResult]:
    """Measure the curves, then the sections of a bench list, and hand each out as soon as it is finished.

    first_runs: the first setting of each method without kernels, too.
    """
    forecast = Forecast(_steps(bench))
    with compiling_at_once():  # what is timed is machine code
        for work in bench.workloads:
            tell(f"{work.name}: references ({forecast})")
            found = reference_means(work)
            forecast.done()
            rows = list(_rows(bench, work, found, tell, forecast))
            rows = [_with_first_run(row, work, tell) for row in rows] if first_runs else rows
            yield WorkloadResult(work, found, rows, missing_peers(work))
        for section in bench.sections:
            tell(section.name)
            yield section.measure(tell)


def _rows(
    bench: Bench,
    work: Workload,
    found: Sequence[ReferenceMeans],
    tell: Callable[[str], None],
    forecast: Forecast,
) -> Iterator[Row]:
    for contender in _there(work):
        for setting, solver in contender.solvers:
            tell(f"{work.name}: {contender.label}, {setting} ({forecast})")
            yield measured_row(bench, work, found, contender, setting, solver)
            forecast.done()


def missing_peers(work: Workload) -> dict[str, str]:
    """The peers of a curve that are not installed, by label, with how to install them."""
    return {
        contender.label: told
        for contender in work.contenders
        if isinstance(peer := contender.solvers[0][1], Peer) and (told := peer.missing())
    }


def _there(work: Workload) -> list[Contender]:
    """The methods, and the peers that are installed."""
    missing = missing_peers(work)
    return [contender for contender in work.contenders if contender.label not in missing]


def _steps(bench: Bench) -> Iterator[Expected]:
    """Of each curve the references, then every setting, with a first guess of its seconds.

    A setting is solved, timed for its mean, solved once more for every column and timed for that.
    """
    for work in bench.workloads:
        yield Expected("references", bench.seconds)
        for contender in _there(work):
            for setting, solver in contender.solvers:
                points = len(chosen(len(work.scenes), contender.points))
                once = points * seconds_per_point(solver, work.scenes[-1], work.law, setting.tolerance)
                timed = max(once, min(bench.repeats * once, bench.seconds))
                yield Expected(contender.label, 2.0 * (once + timed))


def _with_first_run(row: Row, work: Workload, tell: Callable[[str], None]) -> Row:
    """The first setting of a method that answers, as it costs without kernels."""
    setting, solver = row.contender.solvers[0]
    if isinstance(solver, Peer) or row.setting != setting or not row.counts["ok"]:
        return row
    tell(f"{work.name}: {row.contender.label}, first run")
    scenes = [work.scenes[place] for place in chosen(len(work.scenes), row.contender.points)]
    return replace(row, first=first_run(solver, scenes, work.law, setting.tolerance))


def measured_row(
    bench: Bench,
    work: Workload,
    found: Sequence[ReferenceMeans],
    contender: Contender,
    setting: BenchSetting,
    solver: Method | Peer,
) -> Row:
    """One contender at one setting on a curve, errors against these references, timed as the list says."""
    places = chosen(len(work.scenes), contender.points)
    scenes = [work.scenes[place] for place in places]
    outcome = solve_points(solver, scenes, work.law, setting.tolerance)
    reference = independent(found, contender.kind, places)
    off, covered = _off(outcome, reference, places)
    answered = [places[i] for i in _solved(outcome)]
    mean, whole = _times(bench, work, setting, solver, answered)
    return Row(
        contender,
        setting,
        len(places),
        {status: Counter(outcome.status)[status] for status in BENCH_STATUSES},
        _reason(outcome, off, reference),
        float(np.max(off)) if off.size else math.nan,
        float(np.median(off)) if off.size else math.nan,
        _largest(outcome.errors),
        None if contender.side == "peer" or not off.size else covered,
        mean,
        whole,
        reference,
        _model_times(bench, work, solver, answered),
    )


def chosen(size: int, points: int | None) -> list[int]:
    """So many places, spread evenly from the first to the last."""
    if points is None or points >= size:
        return list(range(size))
    return sorted({round(place) for place in np.linspace(0, size - 1, points).tolist()})


def _off(outcome: SolverAnswers, reference: ReferenceMeans | None, places: list[int]) -> tuple[Floats, int]:
    """The errors of the points that are ok and known to the reference, and how many are covered."""
    if reference is None:
        return np.empty(0), 0
    means, errors = reference.means[places], reference.errors[places]
    known = np.isfinite(means) & (np.array(outcome.status) == "ok")
    off = np.abs(outcome.means - means)[known]
    return off, int((off <= (outcome.errors + errors)[known]).sum())


def _reason(outcome: SolverAnswers, off: Floats, reference: ReferenceMeans | None) -> str:
    """The most frequent reason of a point without a number, or why there is no error."""
    reasons = Counter(
        reason for status, reason in zip(outcome.status, outcome.reason, strict=True) if status != "ok"
    )
    if reasons:
        return reasons.most_common(1)[0][0]
    return (
        "" if off.size else "no independent reference" if reference is None else "the reference has no value"
    )


def _largest(errors: Floats) -> float:
    return float(np.nanmax(errors)) if np.isfinite(errors).any() else math.nan


def _solved(outcome: SolverAnswers) -> list[int]:
    """The points worth timing: those with an answer."""
    return [i for i, status in enumerate(outcome.status) if status in ("ok", "not_unique")]


def _times(
    bench: Bench, work: Workload, setting: BenchSetting, solver: Method | Peer, places: list[int]
) -> tuple[Times, Times]:
    """Time of the mean alone and of everything; the same twice for a peer, which gives no more than the mean."""
    if not places:
        return NO_TIME, NO_TIME
    given = [work.scenes[place] for place in places], work.law, setting.tolerance
    mean = time_task(mean_task(solver, *given), bench.repeats, bench.seconds).each_of(len(places))
    if isinstance(solver, Peer):
        return mean, mean
    task = whole_task(solver, *given)
    task()  # with kernels of its own, to be compiled first
    return mean, time_task(task, bench.repeats, bench.seconds).each_of(len(places))


def _model_times(bench: Bench, work: Workload, solver: Method | Peer, places: list[int]) -> Times:
    """Time of a reduced model's mean alone; none of other solvers, nor of a prescribed slip: nothing is left out."""
    if not places or not isinstance(solver, ReducedModel) or work.scenes[0].degrees_of_freedom == 0:
        return NO_TIME
    task = model_task(solver, [work.scenes[place] for place in places], work.law)
    task()
    return time_task(task, bench.repeats, bench.seconds).each_of(len(places))
