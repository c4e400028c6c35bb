"""What a run costs by how many points it has: python tests/benchmarks/many_points.py [LARGEST | curves SIDE].

Coulomb friction on a line, every column, curves of up to 50,000 belt speeds, from 1e2 points to LARGEST (1e6); or
SIDE drive frequencies by as many normal loads, the shapes of their curves of 40 points drawn as a map. Each run is a
command of its own into an empty folder, with kernels compiled before. Wall and processor time, the most memory it
held, and the sizes of what it wrote; then the same study into another folder, which finds every piece.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

CURVE = 50_000
RUN = "import sys; from frictionlab.cli import main; sys.exit(main())"


class Cost(NamedTuple):
    """Wall and processor time [s], memory [MB]."""

    wall: float
    processor: float
    memory: float


def study(points: int) -> str:
    """A study of so many points."""
    curves = max(1, points // CURVE)
    loads = f"scene.normal_load: {{start: 1, stop: 20, num: {curves}}}, " if curves > 1 else ""
    speeds = f"scene.belt_speed: {{start: 0.01, stop: 12, num: {points // curves}}}"
    scene = "{damping_ratio: 0.1, normal_load: 10, drive: {unbalance: 10, frequency: 1}}"
    return f"schema: 1\nscene: {scene}\nlaws: [{{kind: coulomb, mu: 0.4}}]\nsweep: {{{loads}{speeds}}}\n"


def short_curves(side: int) -> str:
    """A study of so many by so many curves."""
    over = {"drive.frequency": (0.4, 2.0, side), "normal_load": (1, 24, side), "belt_speed": (0.2, 60, 40)}
    told = [f"scene.{n}: {{start: {a}, stop: {b}, num: {k}}}" for n, (a, b, k) in over.items()]
    sweep = ", ".join(told).replace("num: 40}", "num: 40, spacing: log}")
    scene = "{damping_ratio: 0.1, normal_load: 10, belt_speed: 5, drive: {amplitude: 10, frequency: 1}}"
    return f"schema: 1\nscene: {scene}\nlaws: [{{kind: coulomb, mu: 0.4}}]\nsweep: {{{sweep}}}\ncolumns: [shape]\n"


def run(file: Path, out: Path) -> Cost:
    """One command, whose children are waited for."""
    before = time.perf_counter()
    command = [sys.executable, "-c", RUN, "run", str(file), "-o", str(out)]
    environment = os.environ | {"FRICTIONLAB_COMPILE": "always"}
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0
    wall = time.perf_counter() - before
    kilobytes = used.ru_maxrss / (1024.0 if sys.platform == "darwin" else 1.0)
    return Cost(wall, used.ru_utime + used.ru_stime, kilobytes / 1024.0)


def size(folder: Path) -> float:
    """What the files below a folder hold [MB]."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file()) / 1e6


def measured(text: str) -> tuple[Cost, Cost, float, float]:
    """A run of a study, another that finds its chunks, and the sizes of the table and of the kept chunks [MB]."""
    with tempfile.TemporaryDirectory() as folder:
        file, out = Path(folder) / "study.yaml", Path(folder) / "runs" / "study"
        file.write_text(text)
        first, again = run(file, out), run(file, out.with_name("other"))
        return first, again, (out / "results.parquet").stat().st_size / 1e6, size(out.parent / ".cache")


def main(studies: dict[int, str]) -> None:
    """Measure and print a row for each study, by its number of points."""
    run_once, _, _, _ = measured(study(100))  # kernels are compiled here
    assert run_once.wall > 0.0
    print(
        "|  points | wall, s | processor, s | us a point | memory, MB | table, MB | pieces, MB | found again, s |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for points, text in studies.items():
        cost, again, table, chunks = measured(text)
        print(
            f"| {points:,} | {cost.wall:.1f} | {cost.processor:.1f} | {1e6 * cost.processor / points:.1f} | "
            f"{cost.memory:.0f} | {table:.1f} | {chunks:.1f} | {again.wall:.1f} |",
            flush=True,
        )


if __name__ == "__main__":
    if sys.argv[1:2] == ["curves"]:
        main({40 * int(sys.argv[2]) ** 2: short_curves(int(sys.argv[2]))})
    else:
        largest = float(sys.argv[1]) if len(sys.argv) > 1 else 1e6
        main({10**power: study(10**power) for power in range(2, 9) if 10**power <= largest})
