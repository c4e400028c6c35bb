"""Floquet multipliers of the table against central differences of the period map, on random scenes of every law.

python tests/benchmarks/random_multipliers.py [--count 500] [--seed 1] [--limit 20] [--out FILE.csv]

Scenes are those of random_pair.py that are driven and answered with a number, on the line and in the plane. The map
is that of shooting, at an accuracy of 1e-13, from the orbit closed at 1e-11; differences are taken over three shifts,
and the change of the largest modulus from shift to shift is the doubt of the reference. A scene counts as

- agrees: the column is within floquet_error of the reference, or within 1e-6 of it, relative to the larger of it and
  1e-3, or within the doubt of the reference;
- empty: the column is empty, with the reason that the table gives;
- not differentiable: one-sided differences disagree at every shift, no number is right, and the column has one;
- wrong: none of these. Each is printed.
"""

from __future__ import annotations

import argparse
import csv
import random
import sys
import time
from collections import Counter
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import random_pair

import frictionlab as fl
from frictionlab.methods.periodic.continuation import CLOSED
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.methods.shooting.decoupled import axes_apart
from frictionlab.methods.shooting.saturated import saturates_in_the_plane
from frictionlab.study.grid import law_in_scene

RELATIVE, LEAST = 1e-6, 1e-3
SHIFTS = (1e-4, 1e-5, 1e-6)
"""Relative to the size of a state."""


class Reference(NamedTuple):
    """The largest modulus by differences of the map, its doubt, and how much one-sided differences disagree."""

    modulus: float
    doubt: float
    kink: float


def by_differences(scene: Any, law: Any, periods: int = 1) -> Reference | None:
    """Of the orbit at the belt speed of the scene; None where the fine search finds none."""
    problem = PeriodicProblem(scene, law, 1e-11)
    curve, _ = problem.close([scene], periods=float(periods), wanted=CLOSED)
    if not curve.closed.found[0]:
        return None
    # slip that never reverses is otherwise followed by its closed form
    problem.goal = problem.goal._replace(constant=False)
    state = curve.states[0]
    size = 1.0 + float(np.linalg.norm(state))
    way = abs(scene.belt_speed) * 2.0 * np.pi / scene.frequency
    found, kinks = [], []
    middle = image(problem, scene.belt_speed, state, periods)
    for relative in SHIFTS:
        shift = min(relative * size, max(0.01 * way, 1e-3 * relative * size))
        ends = {
            side: np.array(
                [
                    image(problem, scene.belt_speed, state + side * shift * unit, periods)
                    for unit in np.eye(state.size)
                ]
            ).T
            for side in (1.0, -1.0)
        }
        ahead, behind = (ends[1.0] - middle[:, None]) / shift, (middle[:, None] - ends[-1.0]) / shift
        moduli = [np.abs(np.linalg.eigvals(each)).max() for each in (0.5 * (ahead + behind), ahead, behind)]
        found.append(float(moduli[0]))
        kinks.append(float(abs(moduli[1] - moduli[2])))
    gaps = [abs(found[1] - found[0]), abs(found[2] - found[1])]
    best = 1 if gaps[0] < gaps[1] else 2
    return Reference(found[best], min(gaps), min(kinks))


def image(problem: PeriodicProblem, belt_speed: float, state: Any, periods: int) -> Any:
    """The state after so many periods, by a fine map."""
    return problem._iterate(belt_speed, state.copy(), periods, 1e-13).state


def draw(rng: random.Random) -> tuple[dict[str, Any], Any, Any] | None:
    """A driven scene with its law; None for one that is of no use here."""
    one = random_pair.draw(rng)
    if one["freedom"] == 0 or "drive" not in one["scene"] or one["scene"]["belt_speed"] == 0.0:
        return None
    keys = dict(one["law"])
    kind = keys.pop("kind")
    if kind in random_pair.PLUGINS:
        return None
    law = getattr(fl, random_pair.CLASSES[kind])(**keys)
    scene = fl.Scene(**{name: value for name, value in one["scene"].items() if name != "initial"})
    if saturates_in_the_plane(scene, law_in_scene(law, scene)) or axes_apart(scene, law_in_scene(law, scene)):
        return None
    return one, scene, law


def compared(scene: Any, law: Any, method: str) -> dict[str, Any]:
    """One row of the account."""
    row = fl.curve(scene, law, [scene.belt_speed], method, 1e-8).iloc[0]
    told = {
        "method": method,
        "status": row["status"],
        "floquet": row["floquet"],
        "error": row["floquet_error"],
        "reason": row["reason"],
    }
    if row["status"] != "ok":
        return told | {"verdict": "no answer"}
    found = row["floquet"]
    if scene.degrees_of_freedom == 2 and scene.load_along_belt_only:
        return told | {"verdict": "empty" if np.isnan(found) else "plane of a line"}
    reference = by_differences(scene, law_in_scene(law, scene))
    if reference is None:
        return told | {"verdict": "no reference"}
    told |= {"reference": reference.modulus, "doubt": reference.doubt, "kink": reference.kink}
    allowed = max(row["floquet_error"], RELATIVE * max(reference.modulus, LEAST), 3.0 * reference.doubt)
    if np.isnan(found):
        verdict = "empty, with reason" if row["reason"] == row["reason"] else "empty"
    elif abs(found - reference.modulus) <= allowed:
        verdict = "agrees"
    else:
        verdict = "not differentiable" if reference.kink > 1e-2 * max(reference.modulus, LEAST) else "wrong"
    return told | {"verdict": verdict, "off": abs(found - reference.modulus), "allowed": allowed}


def main() -> int:
    """Draw, compare, count."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    rng, rows, start = random.Random(given.seed), [], time.perf_counter()
    while len(rows) < given.count:
        drawn = draw(rng)
        if drawn is None:
            continue
        one, scene, law = drawn
        exact = scene.degrees_of_freedom == 1 and one["family"] == "coulomb" and len(rows) % 2
        row = compared(scene, law, "exact" if exact else "shooting")
        rows.append({"number": len(rows), "family": one["family"], "freedom": one["freedom"], **row})
        rows[-1]["scene"] = repr(scene.given())
        rows[-1]["law"] = repr(law)
        if row["verdict"] in ("wrong", "not differentiable"):
            print({name: value for name, value in rows[-1].items()}, flush=True)
        if len(rows) % 25 == 0:
            counts = Counter(each["verdict"] for each in rows)
            print(f"{len(rows)} scenes, {time.perf_counter() - start:.0f} s:", dict(counts), flush=True)
    if given.out is not None:
        names = list(dict.fromkeys(name for row in rows for name in row))
        with given.out.open("w", newline="") as file:
            writer = csv.DictWriter(file, names)
            writer.writeheader()
            writer.writerows(rows)
    for (family, freedom), counts in sorted(tables(rows).items()):
        print(family, freedom, dict(counts))
    print(dict(Counter(each["verdict"] for each in rows)))
    return int(any(each["verdict"] in ("wrong", "not differentiable") for each in rows))


def tables(rows: list[dict[str, Any]]) -> dict[Any, Counter[str]]:
    """Verdicts by family and degrees of freedom."""
    found: dict[Any, Counter[str]] = {}
    for row in rows:
        found.setdefault((row["family"], row["freedom"]), Counter())[row["verdict"]] += 1
    return found


if __name__ == "__main__":
    sys.exit(main())
