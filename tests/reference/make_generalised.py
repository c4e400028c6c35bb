"""Writes generalised_maxwell_slip.csv: python tests/reference/make_generalised.py [--only PATTERN].

Mean friction of bodies and prescribed slips on generalised Maxwell-slip elements, event by event
(generalised_events.py). Every row is solved twice, with relative tolerances of 1e-12 and 1e-13 and with at least 400
and 800 steps a period; ``accuracy`` is ten times the difference, no less than 1e-12, or what the mean position of the
body tells otherwise, if that is more. With --only, rows whose name matches PATTERN (of fnmatch) are solved and the
others kept.
"""

from __future__ import annotations

import argparse
import csv
import json
import time
from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from generalised_events import Contact

RESULTS = Path(__file__).with_name("generalised_maxwell_slip.csv")
COLUMNS = "name", "mean_friction", "accuracy", "reversals", "breakaways", "law", "scene"
PASSES = (1e-8, 50), (1e-12, 100), (1e-12, 400), (1e-13, 800)

ELEMENTS = {
    "1": {"share": [1.0], "stiffness": [4.0]},
    "3": {"share": [0.5, 0.375, 0.125], "stiffness": [1.0, 3.0, 10.0]},
    "10": {"share": [1.0] * 10, "stiffness": [0.1, 0.15, 0.25, 0.4, 0.6, 1.0, 1.5, 2.5, 4.0, 6.0]},
}
FRICTION = {
    "falling": {"mu_kinetic": 0.25, "mu_static": 0.4, "stribeck_speed": 5.0, "attraction": 2.0},
    "steep": {
        "mu_kinetic": 0.2, "mu_static": 0.4, "stribeck_speed": 1.0, "stribeck_exponent": 1.0, "attraction": 0.5,
        "viscosity": 0.002,
    },
    "constant": {"mu_kinetic": 0.4, "attraction": 3.0},
}  # fmt: skip


def _body(damping_ratio: float, frequency: float, belt_speed: float) -> dict[str, Any]:
    drive = {"unbalance": 10.0, "frequency": frequency}
    return {"damping_ratio": damping_ratio, "normal_load": 10.0, "belt_speed": belt_speed, "drive": drive}


def _in_the_plane(load: float) -> dict[str, Any]:
    across = {"natural_frequency": 2.0, "damping_ratio": 0.4, "load": {"amplitude": load, "phase": 50.0}}
    return {**_body(*BODIES[1]), "transverse": across}


BODIES = [(0.4, 1.5, 0.5), (0.4, 1.5, 5.0), (0.25, 1.2, 2.0), (0.1, 1.0, 10.0), (0.4, 1.5, 20.0)]
SLIP = {"velocity_amplitude": 10.0, "frequency": 1.5, "phase": 30.0}
ACROSS = {"wide": (7.0, 8.0), "narrow": (0.2, 1.0)}
"""Velocity and load across the belt: in a narrow motion slip turns faster than elements follow, and they unload."""


def rows() -> Iterator[tuple[str, dict[str, Any], dict[str, Any]]]:
    """Name, law and scene."""
    for count, elements in ELEMENTS.items():
        for kind, friction in FRICTION.items():
            law = elements | friction
            if kind == "falling":
                for speed in (2.0, 6.0, 12.0):
                    yield f"slip/{count}/{kind}/{speed:g}", law, {"belt_speed": speed, "slip": SLIP}
            for wide, (swing, load) in ACROSS.items() if kind != "steep" else ():
                slip = {"velocity_amplitude": swing, "phase": 110.0}
                scene = {"belt_speed": 4.0, "slip": SLIP, "transverse_slip": slip}
                yield f"ellipse/{count}/{kind}/{wide}", law, scene
                if count != "10":
                    yield f"plane/{count}/{kind}/{wide}", law, _in_the_plane(load)
            for numbers in BODIES if kind == "falling" else BODIES[1:3]:
                yield f"body/{count}/{kind}/{numbers[2]:g}", law, _body(*numbers)


def solved(law: dict[str, Any], scene: dict[str, Any]) -> dict[str, Any]:
    """The cells of a row."""
    contact, state, means = Contact(law, scene), None, []
    for rtol, steps in PASSES:
        state = contact.steady(rtol, steps, state)
        means.append(state.mean)
    assert state is not None
    told = abs(state.mean_by_position - state.mean) if contact.mechanics.driven else 0.0
    accuracy = max(10.0 * abs(means[-1] - means[-2]), told, 1e-12)
    return {
        "mean_friction": repr(float(means[-1])),
        "accuracy": f"{accuracy:.1e}",
        "reversals": state.reversals,
        "breakaways": state.breakaways,
        "law": json.dumps(law),
        "scene": json.dumps(scene),
    }


def main(only: str) -> None:
    """Solve and write."""
    kept: dict[str, dict[str, Any]] = {}
    if only != "*" and RESULTS.exists():
        with RESULTS.open(newline="") as file:
            kept = {row["name"]: row for row in csv.DictReader(file)}
    for name, law, scene in rows():
        if fnmatchcase(name, only):
            start = time.perf_counter()
            kept[name] = {"name": name, **solved(law, scene)}
            print(f"{time.perf_counter() - start:6.1f} s", *list(kept[name].values())[:5], flush=True)
    with RESULTS.open("w", newline="") as file:
        out = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        out.writeheader()
        out.writerows(kept[name] for name, _law, _scene in rows() if name in kept)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", default="*")
    main(parser.parse_args().only)
