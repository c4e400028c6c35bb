"""What two threads are worth, on kernels and on whole runs: python tests/benchmarks/threads.py [REPEATS].

2,000 belt speeds of W1 (one degree of freedom at resonance) and W3_4 (two degrees of freedom) of standard.yaml, in
chunks of 125; beside them a loop that touches no memory, which no kernel can beat on the machine as it is right now.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import frictionlab as fl
from frictionlab import bench
from frictionlab.bench.timing import time_task
from frictionlab.compile.cache import compiled
from frictionlab.compile.decorators import njit
from frictionlab.methods.base import Method
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Scene

STANDARD = Path(__file__).parent / "standard.yaml"
POINTS, CHUNK, THREADS = 2_000, 125, 2


@njit
def busy(n: int) -> float:
    """Arithmetic that touches no memory."""
    total = 0.0
    for i in range(n):
        total += math.sin(i * 1e-3)
    return total


def ratio_of(name: str, work: Callable[[ThreadPoolExecutor], object], repeats: int) -> None:
    """Print the least time of one thread over that of two."""
    found = []
    for threads in (1, THREADS):
        with ThreadPoolExecutor(threads) as pool:
            work(pool)
            found.append(time_task(lambda pool=pool: work(pool), repeats, 30.0).least)  # type: ignore[misc]  # mypy cannot type a bound default
    one, two = found
    print(
        f"{name:16s} one thread {1e3 * one:8.1f} ms, two {1e3 * two:8.1f} ms, ratio {one / two:.2f}",
        flush=True,
    )


def kernel_tasks(scene: Scene, method: Method, high: float, tolerance: float) -> list[Callable[[], object]]:
    """Mean and error of one chunk of the curve each: nearly all of it kernels."""
    tasks: list[Callable[[], object]] = []
    for chunk in np.array_split(np.linspace(0.5, high, POINTS), POINTS // CHUNK):
        scenes = [scene.at(float(speed)) for speed in chunk]
        tasks.append(partial(method.solve, scenes, fl.Coulomb(mu=0.4), tolerance))
    return tasks


def study(scene: Scene, high: float, tolerance: float) -> dict[str, Any]:
    """The scene over 2,000 belt speeds, as a study."""
    return {
        "schema": 1,
        "scene": scene.given(),
        "laws": [{"kind": "coulomb", "mu": 0.4}],
        "sweep": {"scene.belt_speed": {"start": 0.5, "stop": high, "num": POINTS}},
        "tolerance": tolerance,
    }


def main(repeats: int) -> None:
    """Everything."""
    spin = compiled(busy)
    ratio_of("(busy loop)", lambda pool: list(pool.map(spin, [200_000] * 16)), repeats)
    works = {curve.name: curve.work for curve in bench.load_bench(STANDARD).curves}
    curves: list[tuple[str, Method, float, float]] = [
        ("W1", Exact(), 49.9, 1e-11),
        ("W3_4", Shooting(), 60.0, 1e-9),
    ]
    for name, method, high, tolerance in curves:
        scene = works[name].scenes[0]
        tasks = kernel_tasks(scene, method, high, tolerance)
        ratio_of(
            f"{name} kernel", lambda pool, tasks=tasks: [f.result() for f in map(pool.submit, tasks)], repeats
        )  # type: ignore[misc]  # mypy cannot type a bound default
        ready = study(scene, high, tolerance)
        ratio_of(f"{name} run", lambda pool, ready=ready: fl.run(ready, executor=pool), max(3, repeats // 10))  # type: ignore[misc]  # mypy cannot type a bound default


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 30)
