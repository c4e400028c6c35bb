"""Onsets of random curves against dense scans of the same curves.

python tests/benchmarks/random_onsets.py [--count 100] [--seed 1] [--points 40] [--dense 10]

Curves of Coulomb friction on the line and in the plane, on the line also of more friction at rest and of falling
friction, with so many points; the scan has so many times as many. Of each kind of onset it counts

- right: the scan changes its kind within a step of the place, and the motions just outside belt_speed_error are of
  both kinds;
- wrong: they are not, and each is printed; the column counts sign changes at nodes, so for the end of reversal a step
  of the scan is allowed for;
- between rows: not located, and the change of the scan lies within the error;
- missed: a change of the scan without an onset.
"""

from __future__ import annotations

import argparse
import random
import sys
import time
from collections import Counter
from typing import Any

import numpy as np
import pandas as pd

import frictionlab as fl

KINDS = ("stick_begins", "stick_ends", "reversal_ends")


def draw(rng: random.Random) -> tuple[dict[str, Any], dict[str, Any], float]:
    """A scene, a law and the largest friction-free velocity along the belt."""
    frequency, damping, load = 10.0 ** rng.uniform(-0.5, 0.5), 10.0 ** rng.uniform(-1.3, -0.3), 10.0
    swing = load * frequency / float(np.hypot(1.0 - frequency**2, 2.0 * damping * frequency))
    mu = 0.4
    scene: dict[str, Any] = {
        "damping_ratio": damping, "normal_load": load * 10.0 ** rng.uniform(-1.3, 0.3) / mu, "belt_speed": 1.0,
        "drive": {"amplitude": load, "frequency": frequency},
    }  # fmt: skip
    if rng.random() < 0.5:
        across = {"amplitude": load * 10.0 ** rng.uniform(-0.7, 0.5), "phase": rng.choice((0.0, 90.0, 40.0))}
        scene["transverse"] = {
            "natural_frequency": 10.0 ** rng.uniform(-0.4, 1.0), "damping_ratio": 10.0 ** rng.uniform(-1.3, -0.3),
            "load": across,
        }  # fmt: skip
    kind = rng.random()
    # in the plane friction that falls has its starts compared: a tenth of a second a motion
    if kind < 0.7 or "transverse" in scene:
        return scene, {"kind": "coulomb", "mu": mu}, swing
    falling = {"kind": "stribeck", "mu_kinetic": 0.3, "mu_static": 0.4, "stribeck_speed": swing}
    return scene, (falling if kind < 0.9 else {"kind": "coulomb", "mu": mu, "mu_static": 0.44}), swing


def study(scene: dict[str, Any], law: dict[str, Any], speeds: Any) -> dict[str, Any]:
    """One curve."""
    sweep = {"scene.belt_speed": [float(speed) for speed in speeds]}
    return {"schema": 1, "scene": scene, "laws": [law], "sweep": sweep, "tolerance": 1e-8}


def kinds(table: pd.DataFrame) -> tuple[Any, Any, Any]:
    """Of the rows with a motion: belt speed, stick, reversal or stick."""
    rows = table[table["status"] == "ok"]
    stick = (rows["stick_fraction"] > 0.0).to_numpy()
    return rows["scene.belt_speed"].to_numpy(), stick, stick | (rows["reversals"] > 0.0).to_numpy()


def changes(table: pd.DataFrame) -> list[tuple[str, float, float]]:
    """Every change of kind in a table: its name, and the belt speeds around it."""
    speed, stick, reverses = kinds(table)
    found = []
    for k in range(len(speed) - 1):
        if stick[k] != stick[k + 1]:
            found.append(("stick_begins" if stick[k + 1] else "stick_ends", speed[k], speed[k + 1]))
        if reverses[k] and not reverses[k + 1]:
            found.append(("reversal_ends", speed[k], speed[k + 1]))
    return found


def both_kinds_beside(scene: dict[str, Any], law: dict[str, Any], onset: Any) -> bool:
    """Whether the motions just outside the error differ as the onset says."""
    place, error = onset["belt_speed"], 1.01 * onset["belt_speed_error"]
    speed, stick, _ = kinds(fl.run(study(scene, law, [place - error, place + error])).table)
    return len(speed) == 2 and [*stick] == (
        [False, True] if onset["onset"] == "stick_begins" else [True, False]
    )


def judged(scene: dict[str, Any], law: dict[str, Any], done: Any, scan: pd.DataFrame) -> Counter[str]:
    """The counts of one curve."""
    counts: Counter[str] = Counter()
    open_changes = changes(scan)
    for _, onset in done.onsets.iterrows():
        if onset["onset"] not in KINDS:
            continue
        place, error = onset["belt_speed"], onset["belt_speed_error"]
        own = [
            each for each in open_changes
            if each[0] == onset["onset"] and each[1] - error <= place <= each[2] + error
        ]  # fmt: skip
        located = "between" not in onset["how"]
        sure = onset["onset"] == "reversal_ends" or not located or both_kinds_beside(scene, law, onset)
        # a window of stick below the step of the scan is seen by its own two sides alone
        seen = bool(own) or (located and sure and onset["onset"] != "reversal_ends")
        verdict = ("right" if located else "between rows") if seen and sure else "wrong"
        counts[f"{onset['onset']} {verdict}"] += 1
        if own:
            open_changes.remove(own[0])
        if verdict == "wrong":
            print(
                "wrong:",
                scene,
                law,
                dict(onset[["onset", "belt_speed", "belt_speed_error", "how"]]),
                flush=True,
            )
    for name, low, high in open_changes:
        counts[f"{name} missed"] += 1
        print("missed:", scene, law, name, low, high, flush=True)
    return counts


def main() -> int:
    """Draw, scan, count."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--points", type=int, default=40)
    parser.add_argument("--dense", type=int, default=10)
    given = parser.parse_args()
    rng, counts, spent = random.Random(given.seed), Counter[str](), np.zeros(2)
    for number in range(given.count):
        scene, law, swing = draw(rng)
        speeds = np.linspace(0.02, 1.3, given.points) * swing
        start = time.process_time()
        done = fl.run(study(scene, law, speeds))
        middle = time.process_time()
        _ = done.onsets
        spent += [middle - start, time.process_time() - middle]
        dense = np.linspace(0.02, 1.3, given.points * given.dense) * swing
        counts += judged(scene, law, done, fl.run(study(scene, law, dense)).table)
        if number % 10 == 9:
            print(number + 1, dict(counts), f"runs {spent[0]:.1f} s, onsets {spent[1]:.1f} s", flush=True)
    print(dict(sorted(counts.items())))
    return int(any("wrong" in name for name in counts))


if __name__ == "__main__":
    sys.exit(main())
