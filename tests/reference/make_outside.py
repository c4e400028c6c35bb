"""Writes more_scenes.csv and random_line.csv: means by the tests' own integration (tests/outside_state.py).

python tests/reference/make_outside.py [NAME ...]: both, or the scenes of more_scenes.csv named anew. Those are the
scenes of every kind; those of random_line.csv have Coulomb friction on the line, 40 under one sine
(tests/random_scenes.py) and 40 under waveforms, vibrating belts and changing normal loads (tests/varying_scenes.py),
followed from a state of the exact method until they repeat.
"""

from __future__ import annotations

import csv
import json
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from outside_state import Unsettled, steady
from random_scenes import draw
from scenes_of_every_kind import SCENES
from varying_scenes import draw_varying

from frictionlab.methods.exact.method import Exact

HERE = Path(__file__).parent
HEAD = (
    *("name", "mean_friction", "mean_friction_transverse", "accuracy"),
    *("energy_input", "energy_viscous", "energy_friction", "energy_contact"),
    *("stick_fraction", "reversals", "period"),
)
MANY = 40


def row(name):
    """The values of one scene of every kind."""
    scene, law = SCENES[name]
    found = steady(scene, law, tolerance=1e-14 if law["kind"] == "elasto-plastic" else 1e-13)
    energies = found.energy_input, found.energy_viscous, found.energy_friction, found.energy_contact
    more = found.stick_fraction, found.reversals, found.drive_periods
    values = found.mean, found.mean_transverse + 0.0, accuracy(found), *energies, *more
    return [name, *(repr(value) for value in values)]


def accuracy(found):
    """What a mean is known to."""
    return max(1e-12, 3.0 * found.error)


def every_kind(names):
    """The rows of more_scenes.csv; where some names are given the others are kept."""
    with (HERE / "more_scenes.csv").open(encoding="utf-8") as file:
        kept = {line[0]: line for line in csv.reader(file)} if names else {}
    for name in SCENES:
        if name not in kept or name in names:
            begun = time.perf_counter()
            kept[name] = row(name)
            print(*kept[name][:4], f"{time.perf_counter() - begun:.1f} s", flush=True)
    return [kept[name] for name in SCENES]


def on_the_line(kind, drawn, rng):
    """So many rows of random_line.csv that the integration can follow."""
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
            told = repr(law.mu), repr(known.mean), repr(accuracy(known))
            found.append([kind, json.dumps(scene.given()), *told])
    return found


def write(name, head, rows):
    """A table beside this file."""
    with (HERE / name).open("w", encoding="utf-8", newline="") as out:
        csv.writer(out, lineterminator="\n").writerows([head, *rows])


if __name__ == "__main__":
    asked = sys.argv[1:]
    write("more_scenes.csv", HEAD, every_kind(asked))
    if not asked:
        sine = on_the_line("sine", draw, np.random.default_rng(20261121))
        more = on_the_line("varying", draw_varying, np.random.default_rng(0))
        write("random_line.csv", ("kind", "scene", "mu", "mean_friction", "accuracy"), [*sine, *more])
