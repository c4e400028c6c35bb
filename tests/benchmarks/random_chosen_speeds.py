"""Chosen belt speeds of random curves against the curves themselves.

python tests/benchmarks/random_chosen_speeds.py [--count 150] [--seed 5]

Curves of Coulomb friction along the belt, which may rise like a root to V_lin; each has belt speeds chosen within
1e-4 to 1e-2 and is compared with 2000 points of it, crowded at V_lin. Printed: how many were chosen, how many
``check`` foresees, and the largest deviation of straight lines from the curve as a multiple of what was asked.
"""

from __future__ import annotations

import argparse
import random

import numpy as np

import frictionlab as fl
from frictionlab.study.ranges import SpeedRange
from frictionlab.theory import friction_free_velocity


def draw(rng: random.Random) -> tuple[fl.Scene, fl.Coulomb, SpeedRange]:
    """A scene, a law, and the belt speeds to choose."""
    scene = fl.Scene(
        damping_ratio=10 ** rng.uniform(-2.0, 0.0),
        normal_load=10 ** rng.uniform(-0.3, 1.7),
        belt_speed=1,
        drive=fl.Drive(unbalance=10, frequency=10 ** rng.uniform(-0.5, 0.6)),
    )
    limit = friction_free_velocity(scene)
    ends = limit * 10 ** rng.uniform(-3.0, -1.0), limit * rng.uniform(0.6, 3.0)
    return scene, fl.Coulomb(mu=rng.uniform(0.1, 1.0)), SpeedRange(*ends, 10 ** rng.uniform(-4.0, -2.0))


def deviation(scene: fl.Scene, law: fl.Coulomb, along: SpeedRange) -> tuple[int, float]:
    """How many belt speeds were chosen, and how far lines between them are from the curve."""
    asked = {"start": along.start, "stop": along.stop, "within": along.within}
    table = fl.compare(scene, law, asked, columns=["mean_friction"]).table
    limit = friction_free_velocity(scene)
    near = along.start + (limit - along.start) * (1.0 - np.geomspace(1e-7, 1.0, 500))
    dense = np.union1d(np.linspace(along.start, along.stop, 1500), near)
    dense = dense[(dense >= along.start) & (dense <= along.stop)]
    exact = fl.curve(scene, law, dense, columns=["mean_friction"])["mean_friction"]
    lines = np.interp(dense, table["scene.belt_speed"], table["mean_friction"])
    return len(table), float(np.nanmax(np.abs(lines - exact)))


def main() -> None:
    """Draw, choose, compare."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--count", type=int, default=150)
    parser.add_argument("--seed", type=int, default=5)
    given = parser.parse_args()
    rng, found = random.Random(given.seed), []
    for number in range(given.count):
        scene, law, along = draw(rng)
        points, off = deviation(scene, law, along)
        found.append(off / along.within)
        foreseen = len(along.about())
        print(
            f"{number}: within {along.within:.1e}, {points} points ({foreseen} foreseen), off {found[-1]:.2f} of it"
        )
    worst = np.array(found)
    print(f"largest {worst.max():.2f}, median {np.median(worst):.2f}, above one {np.mean(worst > 1.0):.1%}")


if __name__ == "__main__":
    main()
