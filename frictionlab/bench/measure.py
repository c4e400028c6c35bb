"""Time and error of one method or peer on one curve."""

from __future__ import annotations

import gc
import math
import os
import pickle
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from frictionlab.bench.peers.base import Peer
from frictionlab.bench.record import (
    BENCH_STATUSES,
    NO_TIME,
    Contender,
    ReferenceMeans,
    Row,
    Times,
    Workload,
)
from frictionlab.bench.solvers import SolverAnswers, independent, solve_points, whole_task
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method, ReducedModel
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene


def time_task(task: Callable[[], object], repeats: int, seconds: float) -> Times:
    """Run a task so many times, or for so long if that is less, but once at least; the caller has warmed it up."""
    spent: list[float] = []
    collecting = gc.isenabled()
    gc.disable()
    try:
        while not spent or (len(spent) < repeats and sum(spent) < seconds):
            start = time.perf_counter()
            task()
            spent.append(time.perf_counter() - start)
    finally:
        if collecting:
            gc.enable()
    low, middle, high = np.percentile(spent, (25, 50, 75)).tolist()
    return Times(min(spent), (low, middle, high), len(spent))


SCRIPT = """
import pickle, sys, time
method, scenes, law, tolerance = pickle.load(sys.stdin.buffer)
from frictionlab.bench.solvers import whole_task
whole_task(method, scenes, law, tolerance)()
print(time.process_time())
"""


def first_run(method: Method, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> float:
    """Processor time [s] of every column of a curve, imports and compiling included.

    Raises CalledProcessError where the method raises.
    """
    with tempfile.TemporaryDirectory() as empty:
        environment = {name: value for name, value in os.environ.items() if name != "FRICTIONLAB_COMPILE"}
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT],
            input=pickle.dumps((method, list(scenes), law, tolerance)),
            env=environment | {"FRICTIONLAB_CACHE": empty},
            stdout=subprocess.PIPE,
            check=True,
        )
    return float(done.stdout)


ANSWERED = ("ok", "not_unique")
"""The points that are worth timing."""


def measured_row(work: Workload, found: Sequence[ReferenceMeans], contender: Contender, at: int) -> Row:
    """One contender at one of its settings on a curve, errors against these references."""
    setting, solver = contender.solvers[at]
    places = chosen(len(work.scenes), contender.points)
    scenes = [work.scenes[place] for place in places]
    outcome = solve_points(solver, scenes, work.law, setting.tolerance)
    reference = independent(found, contender.kind, places)
    off, covered = _off(outcome, reference, places)
    answered = [place for place, status in zip(places, outcome.status, strict=True) if status in ANSWERED]
    timed = _Timed(work, [work.scenes[place] for place in answered], solver, setting.tolerance)
    mean = timed.mean()
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
        mean if isinstance(solver, Peer) else timed.whole(),
        reference,
        timed.model(),
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


@dataclass(frozen=True)
class _Timed:
    """The tasks of a solver on the scenes that it answers; no time where there are none."""

    work: Workload
    scenes: list[Scene]
    solver: Method | Peer
    tolerance: float

    def mean(self) -> Times:
        """The mean friction and its error: all that is found before another column is asked for."""
        return self._of(lambda: self.solver.solve(self.scenes, self.work.law, self.tolerance), warm=True)

    def whole(self) -> Times:
        """Every column of a method's answers, with kernels of their own."""
        assert isinstance(self.solver, Method)
        return self._of(whole_task(self.solver, self.scenes, self.work.law, self.tolerance))

    def model(self) -> Times:
        """A reduced model's mean without its error; of a prescribed slip nothing is left out."""
        model = self.solver
        if not isinstance(model, ReducedModel) or self.work.scenes[0].degrees_of_freedom == 0:
            return NO_TIME
        return self._of(lambda: model.model_means(self.scenes, self.work.law))

    def _of(self, task: Callable[[], object], warm: bool = False) -> Times:
        if not self.scenes:
            return NO_TIME
        if not warm:
            task()
        return time_task(task, self.work.repeats, self.work.seconds).each_of(len(self.scenes))


def with_first_run(row: Row, work: Workload) -> Row:
    """The first setting of a method that answers, as it costs without kernels; else the row as it is."""
    setting, solver = row.contender.solvers[0]
    if isinstance(solver, Peer) or row.setting != setting or not row.counts["ok"]:
        return row
    scenes = [work.scenes[place] for place in chosen(len(work.scenes), row.contender.points)]
    return replace(row, first=first_run(solver, scenes, work.law, setting.tolerance))
