"""Kernel time per curve point of the exact method, warm: python tests/benchmarks/speed_exact.py.

64 belt speeds in [0.5, 60] (W1: Omega 1, gamma^2 10; W2: Omega 4, gamma^2 1; W1g: grazing, [49, 50.02]) or
[0.05, 2.5] (W5: Omega 0.5, load 2.5 below friction 4); damping ratio 0.1, mu 0.4, unbalance 10. The least of many
runs, mean_friction and error alone; then everything read from the orbits too; then two threads on 2,000 points.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from frictionlab.kernel import compiled
from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.base import Answers
from frictionlab.methods.coulomb_curve import solve_curve
from frictionlab.methods.exact import Exact
from frictionlab.scene import Drive, Scene

WORKLOADS = {
    "W1": (Drive(unbalance=10.0, frequency=1.0), 10.0, np.linspace(0.5, 60.0, 64)),
    "W1g": (Drive(unbalance=10.0, frequency=1.0), 10.0, np.linspace(49.0, 50.02, 64)),
    "W2": (Drive(unbalance=10.0, frequency=4.0), 1.0, np.linspace(0.5, 60.0, 64)),
    "W5": (Drive(amplitude=2.5, frequency=0.5), 10.0, np.linspace(0.05, 2.5, 64)),
}


def least(task: Callable[[], object], runs: int) -> float:
    """The least wall time of a task [s]."""
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        task()
        times.append(time.perf_counter() - start)
    return min(times)


def scene(name: str, belt_speed: float) -> Scene:
    """One point of a workload."""
    drive, load, _ = WORKLOADS[name]
    return Scene(damping_ratio=0.1, normal_load=load, belt_speed=belt_speed, drive=drive)


def report(name: str) -> None:
    """Print one workload."""
    speeds = WORKLOADS[name][2]
    rows, solve, mass = np.zeros((64, 9)), compiled(solve_curve), scene(name, 1.0).mass()
    seconds = least(lambda: solve(mass, 0.4, speeds, rows), 300) / 64
    scenes = [scene(name, v) for v in speeds]
    answers = min((Exact().solve(scenes, Coulomb(mu=0.4), 1e-11) for _ in range(50)), key=_seconds)
    worst = answers.columns["error"].max()
    whole = _seconds(answers)
    print(
        f"{name:4s} {1e6 * seconds:6.2f} us per point, {1e6 * whole:6.2f} us with all columns, error <= {worst:.1e}"
    )


def _seconds(answers: Answers) -> float:
    return float(answers.columns["seconds"][0])


def threads() -> None:
    """Print how two threads share 2,000 points of W1 in chunks of 125."""
    solve, mass = compiled(solve_curve), scene("W1", 1.0).mass()
    chunks = np.array_split(np.linspace(0.5, 49.9, 2000), 16)

    def all_chunks(pool: ThreadPoolExecutor) -> object:
        return list(pool.map(lambda chunk: solve(mass, 0.4, chunk, np.zeros((chunk.size, 9))), chunks))

    with ThreadPoolExecutor(1) as alone, ThreadPoolExecutor(2) as pair:
        rounds = [
            [least(lambda pool=pool: all_chunks(pool), 10) for pool in (alone, pair)] for _ in range(12)
        ]
    one, both = np.min(rounds, axis=0)
    print(
        f"2,000 points: one thread {1e3 * one:.2f} ms, two threads {1e3 * both:.2f} ms, ratio {one / both:.2f}"
    )


if __name__ == "__main__":
    for workload in WORKLOADS:
        report(workload)
    threads()
