"""Time and error of one method or peer on one curve.

Solving a curve by a method or a peer, failures included; reference values, never those of the method itself.
"""

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
from dataclasses import dataclass, field, replace

import numpy as np

from frictionlab.bench.peers.base import Peer
from frictionlab.bench.record import (
    BENCH_STATUSES,
    NO_TIME,
    Contender,
    ReferenceMeans,
    ReferenceSource,
    Row,
    Times,
    Workload,
)
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method, ReducedModel
from frictionlab.runner.pieces import Chunk, Task
from frictionlab.runner.solve import FROM_METHODS, answer, number_columns
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.values.quantities import Floats


@dataclass(frozen=True)
class SolverAnswers:
    """Status, reason, mean friction and stated error of each point; NaN where there is none. more: other columns."""

    status: list[str]
    reason: list[str]
    means: Floats
    errors: Floats
    more: dict[str, Floats] = field(default_factory=dict)

    @classmethod
    def without(cls, status: str, reason: str, n: int) -> SolverAnswers:
        """The same answer n times: none."""
        return cls([status] * n, [reason] * n, np.full(n, np.nan), np.full(n, np.nan))


def solve_points(
    solver: Method | Peer,
    scenes: Sequence[Scene],
    law: FrictionLaw,
    tolerance: float,
    more: Sequence[str] = (),
) -> SolverAnswers:
    """The results of a solver, refusals and failures included; more: columns to read from a method's orbits."""
    if isinstance(solver, Peer):
        return _peer_answers(solver, scenes, law, tolerance)
    n, along = len(scenes), Scenes.of(scenes)
    found = SolverAnswers.without("failed", "", n)
    found.more.update({name: np.full(n, np.nan) for name in more})
    for places, answers in answer(Chunk(along, law, solver, Task(tolerance))):
        for at, place in enumerate(places):
            found.status[place], found.reason[place] = answers.status[at], answers.reason[at]
        found.means[places], found.errors[places] = answers.mean.real, answers.error
        if more and "ok" in answers.status:
            read = number_columns(answers, along.taken(places), more)
            for name in more:
                found.more[name][places] = read[name]
    return found


def _peer_answers(peer: Peer, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> SolverAnswers:
    n = len(scenes)
    if (reason := peer.refusal(scenes[0], law)) is not None:
        return SolverAnswers.without("refused", reason, n)
    if n > 1 and not peer.together:
        return _joined([_peer_answers(peer, [scene], law, tolerance) for scene in scenes])
    try:
        means = peer.solve(scenes, law, tolerance)
    except Exception as problem:  # another's library may raise anything, and keeps its place all the same
        if n > 1:  # one scene that fails leaves the others their answers
            return _joined([_peer_answers(peer, [scene], law, tolerance) for scene in scenes])
        return SolverAnswers.without("failed", str(problem) or type(problem).__name__, n)
    status = ["ok" if good else "failed" for good in np.isfinite(means)]
    reasons = ["" if good else "the answer is no finite number" for good in np.isfinite(means)]
    return SolverAnswers(status, reasons, means, np.full(n, np.nan))


def _joined(parts: Sequence[SolverAnswers]) -> SolverAnswers:
    """Answers of one scene after another."""
    return SolverAnswers(
        [status for part in parts for status in part.status],
        [reason for part in parts for reason in part.reason],
        np.concatenate([part.means for part in parts]),
        np.concatenate([part.errors for part in parts]),
    )


def whole_task(
    method: Method, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float
) -> Callable[[], object]:
    """Every column of a method's answers."""
    return lambda: number_columns(method.solve(scenes, law, tolerance), scenes, FROM_METHODS)


CAREFUL = 10.0
LOOSER = 100.0
"""Times the tolerance of a peer, for an answer that tells how well the first is known."""


def reference_means(work: Workload) -> list[ReferenceMeans]:
    """Every reference of a workload at each of its points."""
    return [_reference_means(trusted, work) for trusted in work.references]


def _reference_means(trusted: ReferenceSource, work: Workload) -> ReferenceMeans:
    if trusted.solver is None:
        means = np.array([_known(trusted.values, speed) for speed in work.speeds()])
        return ReferenceMeans(
            trusted.label, "", means, np.where(np.isnan(means), math.nan, trusted.tolerance)
        )
    outcome = solve_points(trusted.solver, work.scenes, work.law, trusted.tolerance)
    means, errors = known_means(trusted, outcome, work.scenes, work.law)
    return ReferenceMeans(trusted.label, trusted.kind, means, errors)


def known_means(
    trusted: ReferenceSource, outcome: SolverAnswers, scenes: Sequence[Scene], law: FrictionLaw
) -> tuple[Floats, Floats]:
    """What a solver's answers are worth as a reference: means and their errors, NaN where it has no answer.

    A method states its error. That of a peer is taken from asking once more, for ``LOOSER`` times the tolerance:
    ``CAREFUL`` times how far that answer is away, and as often the tolerance. Where an integrator gets no nearer the
    errors of both are of one size, and their difference may be small by chance.
    """
    good = np.array(outcome.status) == "ok"
    errors = outcome.errors
    if isinstance(trusted.solver, Peer) and good.any():
        loose = solve_points(trusted.solver, scenes, law, LOOSER * trusted.tolerance)
        errors = CAREFUL * (np.abs(loose.means - outcome.means) + trusted.tolerance)
        good &= np.isfinite(errors)
    return np.where(good, outcome.means, math.nan), np.where(good, errors, math.nan)


def _known(values: dict[float, float], speed: float) -> float:
    """The value at this belt speed, give or take its last digits."""
    return next((mean for at, mean in values.items() if math.isclose(at, speed, rel_tol=1e-12)), math.nan)


def independent(found: Sequence[ReferenceMeans], kind: str, places: Sequence[int]) -> ReferenceMeans | None:
    """The first reference not made by this kind of method or peer that knows one of these points."""
    others = (each for each in found if each.kind != kind)
    return next((each for each in others if np.isfinite(each.means[list(places)]).any()), None)


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
from frictionlab.bench.measure import whole_task
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
