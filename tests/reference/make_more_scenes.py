"""Writes more_scenes.csv: the mean friction of the scenes of every kind by the tests' own integration.

python tests/reference/make_more_scenes.py [NAME ...]: all of them, or those named anew.
"""

from __future__ import annotations

import csv
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from outside_state import steady
from scenes_of_every_kind import SCENES

HERE = Path(__file__).parent
HEAD = (
    "name",
    "mean_friction",
    "mean_friction_transverse",
    "accuracy",
    "energy_input",
    "energy_viscous",
    "energy_friction",
    "energy_contact",
    "stick_fraction",
    "reversals",
    "period",
)


def row(name):
    """The values of one scene."""
    scene, law = SCENES[name]
    found = steady(scene, law, tolerance=1e-14 if law["kind"] == "elasto-plastic" else 1e-13)
    energies = found.energy_input, found.energy_viscous, found.energy_friction, found.energy_contact
    accuracy = max(1e-12, 3.0 * found.error)
    more = found.stick_fraction, found.reversals, found.drive_periods
    values = found.mean, found.mean_transverse + 0.0, accuracy, *energies, *more
    return [name, *(repr(value) for value in values)]


def main(names):
    """Keep the rows of other names where some are given."""
    file = HERE / "more_scenes.csv"
    kept = {line[0]: line for line in csv.reader(file.open(encoding="utf-8"))} if names else {}
    for name in SCENES:
        if name not in kept or name in names:
            begun = time.perf_counter()
            kept[name] = row(name)
            print(*kept[name][:4], f"{time.perf_counter() - begun:.1f} s", flush=True)
    with file.open("w", encoding="utf-8", newline="") as out:
        lines = csv.writer(out, lineterminator="\n")
        lines.writerow(HEAD)
        lines.writerows(kept[name] for name in SCENES)


if __name__ == "__main__":
    main(sys.argv[1:])
