"""Runs whose workers are killed (SIGKILL) give the table of one that is left alone, row by row.

``python tests/killed_workers.py processes|cluster|parts KILLS POINTS [SEED]`` says what it did and what came of it:
processes of a pool of its own, two workers of a dask cluster on this machine, or parts in random order (sixteen of a
large study), some of them killed and begun anew.
"""

from __future__ import annotations

import math
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
from pandas.testing import assert_frame_equal

import frictionlab as fl
from frictionlab.runner import workforce

PARTS, MANY_POINTS = (4, 16), 100_000
"""Of a small and of a large run."""
COMMAND = [sys.executable, "-c", "import sys; from frictionlab.cli import main; sys.exit(main())"]


def study(points: int) -> dict[str, Any]:
    """Curves of at most 2,000 belt speeds, so many points in all."""
    curves = -(-points // 2000)
    speeds = {"start": 0.5, "stop": 12, "num": points // curves}
    return {
        "schema": 1,
        "scene": {"damping_ratio": 0.1, "normal_load": 10, "drive": {"unbalance": 10, "frequency": 1}},
        "laws": [{"kind": "coulomb", "mu": 0.4}],
        "methods": ["exact"],
        "sweep": {
            "scene.normal_load": {"start": 5, "stop": 10, "num": max(2, curves)},
            "scene.belt_speed": speeds,
        },
    }


def points_of(given: dict[str, Any]) -> int:
    """The points of such a study."""
    return math.prod(values["num"] for values in given["sweep"].values())


def children(parent: int) -> list[int]:
    """The processes that a process began."""
    found = subprocess.run(["ps", "-o", "pid=", "--ppid", str(parent)], capture_output=True, text=True)
    return [int(word) for word in found.stdout.split()]


def workers_of_this_process() -> list[int]:
    """Those whose command is that of a worker of a pool."""
    return [pid for pid in children(os.getpid()) if "spawn_main" in _command(pid)]


def _command(pid: int) -> str:
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes().decode(errors="replace")
    except OSError:
        return ""


class Killer:
    """Kills a process that is alive, so often, at random shares of the points of a run."""

    def __init__(self, alive: Callable[[], list[int]], kills: int, draw: random.Random) -> None:
        self.alive, self.draw, self.killed = alive, draw, 0
        self.shares = sorted(draw.uniform(0.0, 0.9) for _ in range(kills))

    def __call__(self, points: int, of: int, *_how: Any) -> None:
        """Kill one where its share is reached."""
        due = self.killed < len(self.shares) and points > self.shares[self.killed] * of
        if due and (found := self.alive()):
            os.kill(self.draw.choice(found), signal.SIGKILL)
            self.killed += 1


def by_processes(given: dict[str, Any], out: Path, kills: int, draw: random.Random) -> tuple[Any, int]:
    """The table found by two processes, and how many were killed."""
    killer = Killer(workers_of_this_process, kills, draw)
    with workforce.processes(2) as force:
        return fl.run(given, out=out, executor=force, progress=killer).table, killer.killed


def by_cluster(given: dict[str, Any], out: Path, kills: int, draw: random.Random) -> tuple[Any, int]:
    """The table found by two workers of a cluster, each begun anew by its nanny when it is killed."""
    from distributed import LocalCluster

    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:

        def alive() -> list[int]:
            return [
                nanny.process.pid for nanny in cluster.workers.values() if nanny.process and nanny.process.pid
            ]

        killer = Killer(alive, kills, draw)
        with workforce.cluster(cluster.scheduler_address) as force:
            return fl.run(given, out=out, executor=force, progress=killer).table, killer.killed


def by_parts(given: dict[str, Any], out: Path, kills: int, draw: random.Random) -> tuple[Any, int]:
    """The table gathered from parts that were solved by processes of their own, in random order."""
    from frictionlab.study.written import yaml_text

    file = out.parent / "study.yaml"
    file.write_text(yaml_text(given))
    parts = PARTS[points_of(given) >= MANY_POINTS]
    order, killed, taken = list(range(1, parts + 1)), 0, 0.0
    draw.shuffle(order)
    for part in order:
        command = [*COMMAND, "run", str(file), "-o", str(out), "--part", f"{part}/{parts}"]
        if killed < kills and taken:
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
            time.sleep(draw.uniform(0.2, 0.9) * taken)
            process.kill()
            killed += process.wait() < 0
        before = time.perf_counter()
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        taken = time.perf_counter() - before
    done = fl.run(file, out=out)
    assert done.computed == 0
    return done.table, killed


WAYS = {"processes": by_processes, "cluster": by_cluster, "parts": by_parts}


def main(way: str, kills: int, points: int, seed: int) -> int:
    """Run a study both ways; 1 where the tables differ or too few were killed."""
    given, draw = study(points), random.Random(seed)
    with tempfile.TemporaryDirectory() as folder:
        table, killed = WAYS[way](given, Path(folder) / "run", kills, draw)
        whole = fl.run(given, out=Path(folder) / "alone" / "run").table
        begun = [path for path in Path(folder).rglob(".*") if path.is_file()]
    try:
        assert_frame_equal(table, whole, check_exact=True)
    except AssertionError as problem:
        print(f"{way}: another table: {problem}")
        return 1
    print(f"{way}: {len(table)} points, {killed} kills, {len(begun)} files left over, tables equal")
    print(table["status"].value_counts().to_dict())
    return int(killed < kills or bool(begun))


if __name__ == "__main__":
    pd.set_option("display.width", 200)
    sys.exit(
        main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4]) if len(sys.argv) > 4 else 0)
    )
