"""Brings rows of truth.csv up to date whose source is the tests' own integration (tests/outside_state.py).

python tests/reference/make_outside.py NAME...: the rows named, each from rest on the belt until it repeats. A new row
has its scene, law and tolerances filled in by hand, 0 for the numbers, and ``outside_state.py`` in its source.
"""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from outside_state import steady

TABLE = Path(__file__).parent / "truth.csv"
ENERGIES = "energy_input", "energy_viscous", "energy_friction", "energy_contact"


def written(row: dict[str, str]) -> dict[str, str]:
    """Return a row with the numbers of the integration; columns that it tells besides keep their accuracies."""
    law, also = json.loads(row["law"]), json.loads(row["also"])
    found = steady(
        json.loads(row["scene"]), law, tolerance=1e-14 if law["kind"] == "elasto-plastic" else 1e-13
    )
    values = {name: getattr(found, name) for name in (*ENERGIES, "stick_fraction", "reversals")}
    values |= {"period": found.drive_periods, "mean_friction_transverse": found.mean_transverse}
    told = {name: [values[name], within] for name, (_, within) in also.items()}
    accuracy = f"{max(1e-12, 3.0 * found.error):.3g}"
    return row | {"mean_friction": repr(found.mean), "accuracy": accuracy, "also": json.dumps(told)}


if __name__ == "__main__":
    with TABLE.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    for place, row in enumerate(rows):
        if row["name"] in sys.argv[1:] and "outside_state.py" in row["source"]:
            rows[place] = written(row)
            print(*(rows[place][name] for name in ("name", "mean_friction", "accuracy")), flush=True)
    with TABLE.open("w", encoding="utf-8", newline="") as out:
        writer = csv.DictWriter(out, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
