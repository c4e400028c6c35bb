"""Reference values of the planar benchmarks by collocation: python tests/benchmarks/collocate.py.

Writes W3_0.5.csv, W3_4.csv and W3_10.csv beside itself: 64 belt speeds in [0.5, 60], mu 0.4, normal load 1, damping
ratios 0.1, both loads of unbalance 10 at frequency 4, transverse natural frequency in the name. The mean moves by
less than 1e-13 where the mesh is refined.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent))

import collocation  # noqa: E402  # lies beside the tests it was written for

MU, POINTS = 0.4, 64


def write(omega_r: float) -> None:
    """One file."""
    with (HERE / f"W3_{omega_r:g}.csv").open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["belt_speed", "mean_friction"])
        for k in range(POINTS):
            belt_speed = 0.5 + 59.5 * k / (POINTS - 1)
            numbers = collocation.Numbers(0.1, 0.1, omega_r, 4.0, 160.0, 160.0, MU, belt_speed)
            rows.writerow([repr(belt_speed), repr(float(-MU * collocation.solve(numbers).along))])


if __name__ == "__main__":
    for omega_r in (0.5, 4.0, 10.0):
        write(omega_r)
