"""What a point costs with laws that remember several numbers, for one checkout or for several side by side.

python tests/benchmarks/memory_laws.py [--python PYTHON ...] [--only PATTERN] [--repeats 3]

PYTHON is that of a checkout's environment (default: this one); its plugins are used, and laws it does not have are
left out. Every case runs in a process of its own with an empty folder for kernels, by each checkout in turn. Columns:
milliseconds a point of a warm curve with every column of the table (shooting, tolerance 1e-6), and in the kernel that
finds its mean alone; seconds to compile for all of it, of processor time; the least of the repeats; points that are
not ok; the ratio of the kernel's time to that of the first checkout. Other work on the machine slows all of it down:
compare checkouts in one call, not with a table of another day.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import subprocess
import sys
import tempfile
import time
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

TOLERANCE, INNER = 1e-6, 3
STIFFNESS = {
    "1": [4.0],
    "3": [1.0, 3.0, 10.0],
    "10": [0.1, 0.15, 0.25, 0.4, 0.6, 1.0, 1.5, 2.5, 4.0, 6.0],
}
MU = {"1": [0.4], "3": [0.2, 0.15, 0.05], "10": [0.04] * 10}
STRIBECK = {"mu_kinetic": 0.25, "mu_static": 0.4, "stribeck_speed": 5.0, "attraction": 2.0}
BODY = {"damping_ratio": 0.4, "normal_load": 10.0, "drive": {"unbalance": 10.0, "frequency": 1.5}}
ACROSS = {"natural_frequency": 2.0, "damping_ratio": 0.4, "load": {"amplitude": 1.0, "phase": 50.0}}
SPEEDS = {"maxwell-slip": [1.0, 3.0, 5.0, 8.0], "generalised-maxwell-slip": [1.0, 3.0, 5.0, 8.0]}


def cases() -> dict[str, tuple[str, dict[str, Any], dict[str, Any], list[float]]]:
    """Law, its parameters, the scene and the belt speeds, by name."""
    laws: dict[str, tuple[str, dict[str, Any]]] = {}
    for count, stiffness in STIFFNESS.items():
        laws[f"maxwell-slip/{count}"] = "maxwell-slip", {"mu": MU[count], "stiffness": stiffness}
    laws["rate-and-state/1"] = "rate-and-state", {"mu": 0.6, "a": 0.01, "b": 0.015, "slip_length": 2.0}
    for count, stiffness in STIFFNESS.items():
        told = {"share": MU[count], "stiffness": stiffness, **STRIBECK}
        laws[f"generalised-maxwell-slip/{count}"] = "generalised-maxwell-slip", told
    return {
        f"{name}/{way}": (kind, told, {**BODY, **across}, SPEEDS.get(kind, [15.0, 20.0]))
        for name, (kind, told) in laws.items()
        for way, across in (("line", {}), ("plane", {"transverse": ACROSS}))
    }


def serve(name: str) -> None:
    """Time one case; print it as JSON."""
    import frictionlab as fl

    kind, told, scene, speeds = cases()[name]
    folder = Path(fl.__file__).parents[1] / "plugins" / kind
    if not folder.exists():
        print(json.dumps({}))
        return
    sys.path.insert(0, str(folder))
    module = importlib.import_module(kind.replace("-", "_"))
    law = getattr(module, "".join(word.capitalize() for word in kind.split("-")))(**told)
    scene = fl.Scene(belt_speed=speeds[0], **scene)
    times, kernels = [], []
    for _ in range(1 + INNER):
        start = time.process_time()
        table = fl.curve(scene, law, speeds, method="shooting", tolerance=TOLERANCE)
        times.append(time.process_time() - start)
        kernels.append(1e3 * float(table["seconds"].sum()) / len(speeds))
    warm = min(times[1:])
    failed = int((table["status"] != "ok").sum())
    found = {"ms": 1e3 * warm / len(speeds), "kernel": min(kernels[1:])}
    found |= {"compile": times[0] - warm, "failed": failed}
    print(json.dumps(found))


def timed(python: str, name: str) -> dict[str, float]:
    """A case in a process of its own, nothing compiled."""
    with tempfile.TemporaryDirectory() as cache:
        command = [python, __file__, "--serve", name]
        environment = {**os.environ, "FRICTIONLAB_CACHE": cache, "FRICTIONLAB_COMPILE": "always"}
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{name} with {python}:\n{done.stderr[-2000:]}")
    found: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return found


def main(pythons: list[str], only: str, repeats: int) -> None:
    """Print the table."""
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    for name in [name for name in cases() if fnmatchcase(name, only)]:
        runs = [[timed(python, name) for python in pythons] for _ in range(repeats)]
        cells, first = [], None
        for each in zip(*runs, strict=True):
            if not all(each):
                cells.append(f"{'-':>43s}")
                continue
            ms, kernel, compiling = (min(run[key] for run in each) for key in ("ms", "kernel", "compile"))
            first = first or kernel
            numbers = f"{ms:9.2f} ms {kernel:9.2f} ms {compiling:6.1f} s {each[0]['failed']:2.0f}"
            cells.append(f"{numbers} x{kernel / first:5.2f}")
        print(f"{name:36s}", *cells, sep=" | ", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--python", action="append")
    parser.add_argument("--only", default="*")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--serve", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.serve is not None:
        serve(given.serve)
    else:
        main(given.python or [sys.executable], given.only, given.repeats)
