"""Bristles under random prescribed slips in the plane: python tests/benchmarks/random_prescribed.py [SCENES] [SEED].

SCENES (default 200), Dahl, LuGre, elasto-plastic and Jenkins friction in turn, against explicit steps between events
(tests/event_split.py): log-uniform in presliding length 0.01 ... 3, amplitude across 0.05 ... 3 and belt speed
0.02 ... 1.5 of the amplitude along. Exit code 1 where the stated error does not cover the difference.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from tally import log_uniform

sys.path.append(str(Path(__file__).parent.parent))

from event_split import planar_mean

import frictionlab as fl
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Scene, Slip, TransverseSlip

TOLERANCES = 1e-6, 1e-9
KNOWN = 2e-11
"""Of the explicit steps."""


def drawn_law(rng: np.random.Generator, kind: int) -> BristleLaw:
    """Unit friction in quick slip."""
    length = log_uniform(rng, 0.01, 3.0)
    falls = {"mu_static": float(rng.uniform(1.0, 1.6)), "stribeck_speed": log_uniform(rng, 0.1, 2.0)}
    more = falls if rng.random() < 0.5 else {}
    damping = float(rng.choice([0.0, 0.1]))
    if kind == 0:
        return fl.Dahl(mu=1.0, presliding_length=length)
    if kind == 1:
        return fl.LuGre(mu_kinetic=1.0, presliding_length=length, damping=damping, **more)
    if kind == 2:
        ratio = float(rng.uniform(0.1, 0.95))
        return fl.ElastoPlastic(
            mu_kinetic=1.0, presliding_length=length, breakaway_ratio=ratio, damping=damping, **more
        )
    return fl.Jenkins(mu=1.0, presliding_length=length)


def drawn_scene(rng: np.random.Generator) -> Scene:
    """Slip of unit amplitude along the belt."""
    angle = float(rng.choice([0.0, 60.0, 90.0, rng.uniform(0.0, 360.0)]))
    across = TransverseSlip(velocity_amplitude=log_uniform(rng, 0.05, 3.0), phase=angle)
    slip = Slip(velocity_amplitude=1.0, frequency=log_uniform(rng, 0.3, 3.0))
    return Scene(belt_speed=log_uniform(rng, 0.02, 1.5), slip=slip, transverse_slip=across)


def main(count: int, seed: int, kinds: list[int]) -> int:
    """Draw, solve, compare; the number of means whose stated error does not cover the difference."""
    rng, wrong, told = np.random.default_rng(seed), 0, 0
    for n in range(count):
        law, scene = drawn_law(rng, kinds[n % len(kinds)]), drawn_scene(rng)
        found = [Shooting().solve([scene], law, tolerance) for tolerance in TOLERANCES]
        if any(answers.status[0] != "ok" for answers in found):
            print(
                n,
                law,
                scene.belt_speed,
                [answers.status[0] for answers in found],
                found[-1].reason[0],
                flush=True,
            )
            continue
        mean, left = planar_mean(scene, law)
        told += 1
        for answers, tolerance in zip(found, TOLERANCES, strict=True):
            off = abs(float(answers.mean[0].real) - mean)
            error = float(answers.error[0])
            if not off <= error + KNOWN + 10.0 * left:
                wrong += 1
                print(
                    f"{n}: {law!r}\n  {scene!r}\n  at {tolerance:g}: stated {error:.1e}, off {off:.1e} ({left:.0e})"
                )
            elif error > tolerance:
                print(f"{n}: at {tolerance:g}: stated {error:.1e}, off {off:.1e}", flush=True)
    print(f"{told} scenes answered of {count}; errors that do not cover: {wrong}")
    return wrong


if __name__ == "__main__":
    numbers = [int(one) for one in sys.argv[1:]]
    kinds = numbers[2:] or [0, 1, 2, 3]
    sys.exit(1 if main(*(numbers[:2] + [200, 1][len(numbers[:2]) :]), kinds) else 0)
