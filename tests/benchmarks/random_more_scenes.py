"""Random scenes of every kind, counted: python tests/benchmarks/random_more_scenes.py [T1] [EVERY] [COMPARED] [SEED].

T1 (default 1,000) scenes that theorem T1 holds for are followed by the tests' own integration from three starts, far
apart, until each repeats: one answer, and auto's error covers the difference from it. EVERY (default 3,000) scenes of
every kind are solved by auto at 1e-8, each within LIMIT seconds, in a process of its own that is given up where it
hangs; statuses are counted. COMPARED (default 100) of the answers are compared with the tests' own integration, from
the answer's own state; those that take it too long are passed over, and counted. Exit code 1 where there are two
answers, an error that does not cover, a hang, or more than .2 % failed.
"""

from __future__ import annotations

import math
import multiprocessing
import sys
import time
import warnings
from collections import Counter
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from draws_of_every_kind import Keys, Numpy, convergent_scene, scene_of_every_kind
from outside_state import Unsettled, steady

import frictionlab as fl
from frictionlab import registry

TOLERANCE, LIMIT, WARM = 1e-8, 300.0, 600.0
"""Of auto; seconds for one scene, compiling included, and for the first."""
MOST_FAILED = 0.002


class Found(NamedTuple):
    """What auto said, and the state of the orbit at tau = 0 where there is one."""

    status: str
    reason: str
    model: str
    mean: float
    error: float
    seconds: float
    start: tuple[float, ...]


def law_of(keys: Keys) -> Any:
    """A law by its keys."""
    return registry.law_class(keys["kind"])(**{name: keys[name] for name in keys if name != "kind"})


def solved(drawn: tuple[Keys, Keys]) -> Found:
    """By auto."""
    begun = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        state = fl.steady_state(fl.Scene(**drawn[0]), law_of(drawn[1]), tolerance=TOLERANCE)
    spent = time.perf_counter() - begun
    start: tuple[float, ...] = ()
    if state.status == "ok" and "slip" not in drawn[0]:
        first = state.orbit(1)
        parts = (first.x1, first.v1, first.x2, first.v2) if "transverse" in drawn[0] else (first.x1, first.v1)
        start = tuple(float(part[0]) for part in parts)
    return Found(state.status, state.reason, state.model, state.mean_friction, state.error, spent, start)


class Cases(list[str]):
    """What is wrong, printed at once."""

    def append(self, case: str) -> None:
        super().append(case)
        print(case, flush=True)


class Worker:
    """A process that solves one scene after another, and another one after a hang."""

    def __init__(self) -> None:
        self.pool: Any = None

    def solve(self, drawn: tuple[Keys, Keys]) -> Found:
        """Status "hung" after LIMIT seconds, "crashed" with what was raised."""
        limit = LIMIT
        if self.pool is None:
            self.pool, limit = multiprocessing.get_context("spawn").Pool(1), WARM
        try:
            return self.pool.apply_async(solved, (drawn,)).get(limit)
        except multiprocessing.TimeoutError:
            self.close()
            return Found("hung", f"{limit:g} s", "", math.nan, math.nan, limit, ())
        except Exception as problem:  # whatever was raised is what is counted
            return Found("crashed", repr(problem), "", math.nan, math.nan, 0.0, ())

    def close(self) -> None:
        """End the process."""
        if self.pool is not None:
            self.pool.terminate()
        self.pool = None


def starts(scene: Keys) -> list[tuple[float, ...]]:
    """On the belt, and far ahead and behind of any motion that lasts."""
    drive, swing = scene.get("drive", {}), scene.get("belt_vibration", {}).get("velocity_amplitude", 0.0)
    far = 3.0 * (drive.get("amplitude", 0.0) + scene["normal_load"] + swing + abs(scene["belt_speed"]))
    both = "transverse" in scene
    return [
        (),
        (far, -far, -far, far)[: 4 if both else 2],
        (-far, far, 0.5 * far, 0.5 * far)[: 4 if both else 2],
    ]


def one_answer(count: int, rng: np.random.Generator, worker: Worker) -> tuple[Counter[str], list[str]]:
    """Scenes of T1 from three starts each, and by auto."""
    tally, wrong = Counter[str](), Cases()
    for number in range(count):
        if number % 50 == 49:
            print(number + 1, dict(tally), file=sys.stderr, flush=True)
        scene, law = convergent_scene(Numpy(rng))
        found = worker.solve((scene, law))
        tally[f"auto: {found.status}"] += 1
        try:
            means = [steady(scene, law, start, 1e-12, periods=100_000) for start in starts(scene)]
        except Unsettled as why:
            tally[f"not followed to the end: {str(why)[-40:]}"] += 1
            continue
        spread, left = np.ptp([each.mean for each in means]), sum(each.error for each in means)
        tally["followed from three starts"] += 1
        if not spread <= 1e-9 + left:
            wrong.append(f"T1 {number}: TWO ANSWERS, {spread:.1e} apart, {left:.1e} open: {scene} {law}")
        if found.status != "ok":
            wrong.append(f"T1 {number}: {found.status}, {found.reason}: {scene} {law}")
        elif not abs(found.mean - means[0].mean) <= found.error + means[0].error:
            off = abs(found.mean - means[0].mean)
            wrong.append(
                f"T1 {number}: UNCOVERED {off:.1e} > {found.error:.1e}, {found.model}: {scene} {law}"
            )
    return tally, wrong


def every_kind(
    count: int, compared: int, rng: np.random.Generator, worker: Worker
) -> tuple[Counter[str], list[str]]:
    """Scenes of every kind by auto; the first so many answers against the tests' own integration."""
    tally, wrong, seconds = Counter[str](), Cases(), []
    for number in range(count):
        if number % 50 == 49:
            print(number + 1, dict(tally), file=sys.stderr, flush=True)
        scene, law = scene_of_every_kind(Numpy(rng))
        found = worker.solve((scene, law))
        tally[found.status] += 1
        tally[f"{found.status}: {law['kind']}"] += 1
        seconds.append(found.seconds)
        if found.status in ("failed", "hung", "crashed") or (found.status == "refused" and not found.reason):
            wrong.append(f"{number}: {found.status}, {found.reason}: {scene} {law}")
        elif found.status == "refused":
            tally[f"refused, {found.reason[:100]}"] += 1
        elif found.status == "ok" and not (math.isfinite(found.mean) and 0.0 <= found.error <= TOLERANCE):
            wrong.append(f"{number}: mean {found.mean}, error {found.error}: {scene} {law}")
        if found.status != "ok" or tally["compared"] >= compared:
            continue
        try:
            true = steady(scene, law, found.start, periods=4000)
        except Unsettled as why:
            tally[f"passed over: {str(why)[-40:]}"] += 1
            continue
        tally["compared"] += 1
        off = abs(found.mean - true.mean)
        if not off <= found.error + true.error:
            claim = f"{off:.2e} > {found.error:.1e} + {true.error:.1e}"
            wrong.append(f"{number}: UNCOVERED {claim}, {found.model}: {scene} {law}")
    if seconds:
        spans = np.quantile(seconds, [0.5, 0.9, 0.99, 1.0])
        print("seconds per scene, median, 90 %, 99 %, most:", *(f"{part:.3g}" for part in spans))
    return tally, wrong


def main(convergent: int, count: int, compared: int, seed: int) -> int:
    """Print both tallies; 1 where something is wrong."""
    worker, begun = Worker(), time.perf_counter()
    results = [
        one_answer(convergent, np.random.default_rng(seed), worker),
        every_kind(count, compared, np.random.default_rng(seed + 1), worker),
    ]
    worker.close()
    for tally, _ in results:
        for line in sorted(tally.items()):
            print(*line)
    print(f"{time.perf_counter() - begun:.0f} s")
    bad = [case for _, wrong in results for case in wrong if "failed" not in case.split(",")[0]]
    failed = results[1][0]["failed"]
    return int(bool(bad) or failed > MOST_FAILED * max(count, 1))


if __name__ == "__main__":
    given = [int(argument) for argument in sys.argv[1:]]
    sys.exit(main(*(given + [1000, 3000, 100, 1][len(given) :])))
