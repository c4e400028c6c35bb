"""Random scenes of every kind, marched and compared with shooting, or with the tests' own integration.

python tests/benchmarks/random_march.py [--count 300] [--seed 1] [--steps 200]

Each scene (tests/draws_of_every_kind.py) is marched by a stepper of its law, drawn with it. What shooting does not
take (a contact of constant stiffness) is compared with tests/outside_state.py. Prints every mean farther off than the
errors say, what was refused or failed and why, and the counts; exits with code 1 where an error does not cover.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from draws_of_every_kind import Numpy, scene_of_every_kind
from outside_state import Unsettled, steady

from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.stribeck import Stribeck
from frictionlab.methods.march.method import March
from frictionlab.methods.march.refusal import STEPPERS
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Scene

LAWS: dict[str, Any] = {
    "coulomb": Coulomb,
    "stribeck": Stribeck,
    "dahl": Dahl,
    "lugre": LuGre,
    "elasto-plastic": ElastoPlastic,
}


class Known(NamedTuple):
    """What is known of a scene: mean and error, or the status instead."""

    status: str
    mean: float = 0.0
    error: float = 0.0


def known(keys: dict[str, Any], told: dict[str, Any], scene: Scene, law: Any) -> Known:
    """By shooting; what it refuses by the tests' own integration."""
    shooting = Shooting()
    if shooting.refusal(scene, law) is None:
        found = shooting.solve([scene], law, 1e-7)
        return Known(found.status[0], float(found.mean[0].real), float(found.error[0]))
    try:
        outside = steady(keys, told)
    except Unsettled as why:
        return Known(f"outside: {why}")
    return Known("ok", outside.mean, 10.0 * outside.error + 1e-9)


def main() -> int:
    """Draw, march, compare, count."""
    reader = argparse.ArgumentParser(description=__doc__)
    reader.add_argument("--count", type=int, default=300)
    reader.add_argument("--seed", type=int, default=1)
    reader.add_argument(
        "--steps", type=int, default=200, help="per period, doubled for rk4; or what is stable"
    )
    reader.add_argument("--kind", default="", help="of law, alone")
    asked = reader.parse_args()
    counts, compared, uncovered, slowest = Counter(), Counter(), 0, 0.0
    for number in range(asked.count):
        source = Numpy(np.random.default_rng([asked.seed, number]))
        keys, told = scene_of_every_kind(source)
        scene = Scene(**keys)
        law = LAWS[told["kind"]](**{name: value for name, value in told.items() if name != "kind"})
        stepper = source.among(STEPPERS[law.memory_kind])
        if asked.kind not in ("", told["kind"]):
            continue
        own = {} if stepper == "smoothed" else {"steps": asked.steps * (2 if stepper == "rk4" else 1)}
        method = March(stepper=stepper, **own)
        if (reason := method.refusal(scene, law)) and "steps per period" in reason:
            method = March(stepper=stepper)
        where = f"{number} {stepper} {told['kind']} {scene.degrees_of_freedom}DOF"
        if reason := method.refusal(scene, law):
            counts[stepper, "refused"] += 1
            print(where, "refused:", reason, flush=True)
            continue
        start = time.perf_counter()
        found = method.solve([scene], law, 1e-3)
        slowest = max(slowest, float(found.seconds[0]))
        counts[stepper, found.status[0]] += 1
        truth = known(keys, told, scene, law)
        if found.status[0] != "ok" or truth.status != "ok":
            said = f"{found.status[0]} ({found.reason[0][:90]}), else {truth.status}"
            print(where, said, f"{time.perf_counter() - start:.1f} s", flush=True)
            continue
        compared[stepper] += 1
        off, error = abs(float(found.mean[0].real) - truth.mean), float(found.error[0])
        if not off <= error + truth.error:
            uncovered += 1
            print(
                where,
                f"UNCOVERED: off by {off:.2e}, error {error:.2e} + {truth.error:.2e}",
                keys,
                told,
                flush=True,
            )
    print(f"{uncovered} uncovered of {sum(compared.values())} compared: {dict(compared)}; {dict(counts)}")
    print(f"slowest kernel: {slowest:.1f} s")
    return 1 if uncovered else 0


if __name__ == "__main__":
    sys.exit(main())
