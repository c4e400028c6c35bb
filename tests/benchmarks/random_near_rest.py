"""Random planar scenes that are hard near rest, solved by shooting in a process of its own.

python tests/benchmarks/random_near_rest.py OUT.csv [--count 300] [--seed 1] [--tolerance 1e-8] [--limit 4]
    [--python /other/.venv/bin/python]

Prints how many have no answer or an error above the tolerance, how many took longer than the limit in seconds of
processor time, the median and the largest time. The rows of OUT.csv are kept: the same command goes on with what is
left.
"""

from __future__ import annotations

import argparse
import csv
import json
import statistics
import sys
from collections import Counter
from pathlib import Path

import numpy as np
from random_pair import Solver

sys.path.append(str(Path(__file__).parents[1]))

from random_scenes import draw_near_rest

COLUMNS = ("number", "status", "mean_friction", "error", "cpu", "reason", "scene", "mu")


def solve(out: Path, given: argparse.Namespace) -> None:
    """Solve what OUT does not have yet."""
    rng, solver = np.random.default_rng(given.seed), Solver(given.python)
    done = sum(1 for _ in out.open()) - 1 if out.exists() else -1
    with out.open("a", newline="") as file:
        rows = csv.DictWriter(file, COLUMNS, lineterminator="\n", extrasaction="ignore")
        if done < 0:
            rows.writeheader()
        for number in range(given.count):
            scene, mu = draw_near_rest(rng)
            if number < done:
                continue
            one = {
                "scene": scene,
                "law": {"kind": "coulomb", "mu": mu},
                "method": {"kind": "shooting"},
                "tolerance": given.tolerance,
            }
            # the first call of a process may compile
            answer = solver.solve(one, given.limit if solver.process and number > done else 600.0)
            rows.writerow({"number": number, "scene": json.dumps(scene), "mu": mu, **answer})
            file.flush()
    solver.end()


def summary(out: Path, tolerance: float) -> str:
    """What of the rows is wanted."""
    with out.open(newline="") as file:
        rows = list(csv.DictReader(file))
    coarse = sum(row["status"] == "ok" and float(row["error"]) > tolerance for row in rows)
    times = [float(row["cpu"]) for row in rows[1:] if row["cpu"]]
    count = dict(Counter(row["status"] for row in rows))
    return (
        f"{count}, error above the tolerance: {coarse}, median {statistics.median(times):.4f} s, "
        f"largest {max(times):.3f} s"
    )


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("out", type=Path)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tolerance", type=float, default=1e-8)
    parser.add_argument("--limit", type=float, default=4.0)
    parser.add_argument("--python", default=sys.executable)
    given = parser.parse_args()
    solve(given.out, given)
    print(summary(given.out, given.tolerance))


if __name__ == "__main__":
    main()
