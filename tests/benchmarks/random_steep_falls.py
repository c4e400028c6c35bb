"""Random scenes whose friction falls faster than damping makes up for: how many ``ok`` answers are not alone.

python tests/benchmarks/random_steep_falls.py follow STATES.csv [--count 5000] [--seed 1] [--starts 64]
python tests/benchmarks/random_steep_falls.py compare STATES.csv OUT.csv

``follow`` draws scenes and follows so many starts of this file's own in each: at rest, flung, spread over ellipses of
energy up to several times the free motion. Each is followed until it repeats, nears a known orbit as the
multipliers of that say, or for ``LONG`` periods; a scene is left once two different states are found in it, or a
motion that does not repeat. ``states`` are their periods in drive periods (0: does not repeat), means and errors.

``compare`` solves the same scenes by ``shooting``, each alone, and counts the answers that are ``ok`` though another
state was found, and what they cost. The rows of both files are kept: the same command goes on with what is left.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import random
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import frictionlab as fl
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.periodic.attraction import ARRIVED
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.methods.shooting.attractors import Attractor, closed_orbit, orbit_at_the_end
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Initial, Scene
from frictionlab.theory.linear import velocity_scale
from frictionlab.theory.uniqueness import falls_slowly

FOLLOWED = "number", "states", "starts", "seconds", "scene", "law"
COMPARED = "number", "status", "unique", "mean", "error", "other", "seconds", "reason"
LONG = 4000
BRISTLES = 0.03
"""Share of falling bristle laws."""
TOLERANCE = 1e-8


def _log(rng: random.Random, low: float, high: float) -> float:
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def draw(rng: random.Random) -> tuple[dict[str, Any], dict[str, Any]]:
    """A scene and a law, as plain values: one whose sliding friction falls faster than damping makes up for."""
    while True:
        scene, law = _scene(rng), {}
        law = _law(rng, scene.pop("speed"), rng.random() < BRISTLES)
        if not falls_slowly(fl.Scene(**scene), law_of(law)):
            return scene, law


def _scene(rng: random.Random) -> dict[str, Any]:
    """A driven line; friction is .02 ... 3 of the load, and the belt a share of the free motion's speed."""
    frequency, damping, load = _log(rng, 0.3, 4.0), _log(rng, 0.003, 0.3), _log(rng, 0.3, 30.0)
    stiffness = math.hypot(1.0 - frequency**2, 2.0 * damping * frequency)
    speed = load * frequency / max(stiffness, 0.02)
    drive = {"amplitude": load, "frequency": frequency, "phase": rng.uniform(0.0, 360.0)}
    return {
        "damping_ratio": damping,
        "normal_load": load * _log(rng, 0.02, 3.0) / 0.4,
        "belt_speed": speed * _log(rng, 0.01, 3.0) * rng.choice((1.0, 1.0, 1.0, -1.0)),
        "drive": drive,
        "speed": speed,
    }


def _law(rng: random.Random, speed: float, bristle: bool) -> dict[str, Any]:
    law: dict[str, Any] = {
        "mu_static": 0.4,
        "mu_kinetic": 0.4 * rng.uniform(0.2, 0.95),
        "stribeck_speed": speed * _log(rng, 0.03, 3.0),
        "stribeck_exponent": rng.choice((1.0, 2.0, rng.uniform(1.0, 3.0))),
    }
    if bristle:
        return law | {"kind": "lugre", "presliding_length": speed * _log(rng, 1e-3, 1e-1)}
    if rng.random() < 0.3:
        del law["stribeck_exponent"]
        law["curve"] = rng.choice(("hyperbolic", "hess-soom"))
    if rng.random() < 0.15:
        return {"kind": "coulomb", "mu": law["mu_kinetic"], "mu_static": 0.4}
    return law | {"kind": "stribeck"}


def law_of(values: dict[str, Any]) -> FrictionLaw:
    """The law of plain values."""
    kinds = {"stribeck": fl.Stribeck, "coulomb": fl.Coulomb, "lugre": fl.LuGre}
    return kinds[values["kind"]](**{name: value for name, value in values.items() if name != "kind"})


def starts(scene: Scene, limit: float, count: int, rng: random.Random) -> list[Initial]:
    """Rest at places up to where friction lets go, flung ones, the others by energy around the mean deflection."""
    belt, swing = scene.belt_speed, velocity_scale(scene)
    found = [Initial(x=limit * share, velocity=belt) for share in (-0.9, 0.0, 0.9)]
    found += [
        Initial(x=side * 4.0 * limit, velocity=side * 4.0 * (abs(belt) + swing)) for side in (-1.0, 1.0)
    ]
    reach = max(swing, limit, abs(belt))
    while len(found) < count:
        size, angle = reach * 5.0 * rng.random() ** 2, rng.uniform(0.0, 2.0 * math.pi)
        middle = math.copysign(limit, belt) * rng.random()
        found.append(Initial(x=middle + size * math.cos(angle), velocity=size * math.sin(angle)))
    return found[:count]


def followed(number: int, seed: int, count: int) -> dict[str, Any]:
    """The states of one scene, as ``[period, mean, error]``."""
    rng = random.Random(f"{seed} {number}")
    values, parameters = draw(rng)
    scene, law, begun = fl.Scene(**values), law_of(parameters), time.process_time()
    problem = PeriodicProblem(scene, law, TOLERANCE)
    curve, _ = problem.close([scene])
    candidate = closed_orbit(curve, curve.closed.mean)
    states = [] if candidate is None else [_told(candidate)]
    known = None if candidate is None else candidate.known
    for tried, start in enumerate(starts(scene, problem.mass.normal_load * 0.4, count, rng), 1):  # noqa: B007  # told after the loop
        way = problem.transient(scene.belt_speed, start, LONG, known)
        if way.period == ARRIVED:
            continue
        orbit, _ = orbit_at_the_end(problem, scene, way)
        known = orbit.known if orbit.period == 1 else known
        found = _told(orbit)
        if not any(_same(one, found) for one in states):
            states.append(found)
        if len(states) > 1 or orbit.period == 0:
            break
    return {
        "number": number,
        "states": json.dumps(states),
        "starts": tried,
        "seconds": time.process_time() - begun,
        "scene": json.dumps(values),
        "law": json.dumps(parameters),
    }


def _told(orbit: Attractor) -> list[float]:
    return [orbit.period, orbit.mean, math.nan if orbit.curve is None else float(orbit.curve.closed.error[0])]


def _same(one: list[float], other: list[float]) -> bool:
    return one[0] == other[0] and abs(one[1] - other[1]) <= one[2] + other[2] + 1e-9


def compared(row: dict[str, str]) -> dict[str, Any]:
    """The answer to a scene, and the first state in which it does not end."""
    scene, law = fl.Scene(**json.loads(row["scene"])), law_of(json.loads(row["law"]))
    begun = time.process_time()
    answer = Shooting().solve([scene], law, TOLERANCE)
    seconds, mean, error = time.process_time() - begun, float(answer.mean[0].real), float(answer.error[0])
    states = json.loads(row["states"]) if answer.status[0] == "ok" else []
    other = next((one for one in states if not _same(one, [1, mean, error])), None)
    return {
        "number": row["number"],
        "status": answer.status[0],
        "unique": (answer.unique or [""])[0],
        "mean": mean,
        "error": error,
        "other": "" if other is None else json.dumps(other),
        "seconds": seconds,
        "reason": answer.reason[0],
    }


def main() -> None:
    """Find what is left, and count."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("what", choices=("follow", "compare"))
    parser.add_argument("states", type=Path)
    parser.add_argument("out", type=Path, nargs="?")
    parser.add_argument("--count", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--starts", type=int, default=64)
    given = parser.parse_args()
    if given.what == "follow":
        fill(given.states, FOLLOWED, range(given.count), lambda n: followed(n, given.seed, given.starts))
        return
    known = {int(row["number"]): row for row in read(given.states)}
    numbers = [number for number in known if number < given.count]
    fill(given.out, COMPARED, numbers, lambda number: compared(known[number]))
    tell(read(given.out))


def read(path: Path) -> list[dict[str, str]]:
    """The rows of a file; none where there is no file."""
    if not path.exists():
        return []
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def fill(
    path: Path, columns: Sequence[str], numbers: Iterable[int], find: Callable[[int], dict[str, Any]]
) -> None:
    """Write the rows that are not there yet."""
    done = {int(row["number"]) for row in read(path)}
    with path.open("a", newline="") as file:
        writer = csv.DictWriter(file, columns)
        if not done:
            writer.writeheader()
        for number in numbers:
            if number not in done:
                writer.writerow(find(number))
                file.flush()


def tell(rows: list[dict[str, str]]) -> None:
    """The counts, and the price."""
    ok = [row for row in rows if row["status"] == "ok"]
    wrong = [row for row in ok if row["other"]]
    repeating = [row for row in wrong if json.loads(row["other"])[0] > 0]
    seconds = np.array([float(row["seconds"]) for row in rows])
    print(
        f"{len(rows)} scenes, {len(ok)} ok, {len(wrong)} of them with another state ({len(repeating)} periodic)"
    )
    print(
        f"seconds a scene: median {np.median(seconds):.2g}, mean {seconds.mean():.2g}, largest {seconds.max():.2g}"
    )
    for row in wrong:
        print(row["number"], row["mean"], row["other"], row["reason"])


if __name__ == "__main__":
    main()
