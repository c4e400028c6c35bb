"""Writes random_line.csv: Coulomb friction of random scenes on the line, by the tests' own integration.

python tests/reference/make_random_line.py: 40 scenes under one sine (tests/random_scenes.py), 40 under waveforms,
vibrating belts and changing normal loads (tests/varying_scenes.py), followed from a state of the exact method until
they repeat.
"""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from outside_state import Unsettled, steady
from random_scenes import draw
from varying_scenes import draw_varying

from frictionlab.methods.exact.method import Exact

FILE = Path(__file__).parent / "random_line.csv"
MANY = 40


def rows(kind, drawn, rng):
    """So many that the integration can follow, with the mean and its error."""
    found = []
    while len(found) < MANY:
        scene, law = drawn(rng)
        if not 0.02 < scene.frequency < 200.0 or scene.damping_ratio > 10.0 or Exact().refusal(scene, law):
            continue
        answers = Exact().solve([scene], law, 1e-8)
        if answers.status == ["ok"]:
            orbit = answers.orbit(0)
            start = float(orbit.x[0, 0].real), float(orbit.v[0, 0].real)
            try:
                known = steady(scene.given(), {"kind": "coulomb", "mu": law.mu}, start)
            except Unsettled:
                continue
            accuracy = max(1e-12, 3.0 * known.error)
            found.append([kind, json.dumps(scene.given()), repr(law.mu), repr(known.mean), repr(accuracy)])
    return found


if __name__ == "__main__":
    with FILE.open("w", encoding="utf-8", newline="") as out:
        lines = csv.writer(out, lineterminator="\n")
        lines.writerow(("kind", "scene", "mu", "mean_friction", "accuracy"))
        lines.writerows(rows("sine", draw, np.random.default_rng(20261121)))
        lines.writerows(rows("varying", draw_varying, np.random.default_rng(0)))
