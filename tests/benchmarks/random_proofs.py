"""Proofs of the exact method's means, counted: python tests/benchmarks/random_proofs.py [SCENES] [SEED].

SCENES (default 2,000) scenes of one sine over decades, a quarter as many with waveforms, vibrating belts and changing
normal loads, an eighth as many an ulp from where legs come and go, and a quarter as many orbits of other belt speeds.
Exit code 1 where a proved mean is farther from the estimated one than both errors.
"""

from __future__ import annotations

import math
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from random_scenes import draw
from varying_scenes import draw_varying

from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.base import Answers
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.exact.proof.motion import NotProved
from frictionlab.methods.exact.proof.nodes import starts_of
from frictionlab.methods.exact.proof.prove import prove
from frictionlab.scene.scene import Scene
from frictionlab.theory.uniqueness import is_unique

Drawn = tuple[Scene, Coulomb]


def provable(scene: Scene, law: Coulomb) -> Answers | None:
    """Its answer, if the error of that is an estimate and theorem T1 holds."""
    if not is_unique(scene, law) or Exact().refusal(scene, law):
        return None
    answers = Exact().solve([scene], law, 1e-8)
    return answers if (answers.status[0], answers.error_kind[0]) == ("ok", "estimated") else None


def drawn_by(function: Callable[[np.random.Generator], Drawn], rng: np.random.Generator) -> Iterator[Drawn]:
    """Without end."""
    while True:
        yield function(rng)


def legs(scene: Scene, law: Coulomb) -> tuple[int, ...] | None:
    """The signs of the legs, from whichever makes the tuple least."""
    if (answers := provable(scene, law)) is None:
        return None
    signs = [one.sign for one in starts_of(answers.orbit(0), 2.0 * math.pi * scene.periods / scene.frequency)]
    return tuple(min(signs[i:] + signs[:i] for i in range(len(signs))))


def at_speed(scene: Scene, speed: float) -> Scene:
    """The same on another belt."""
    return scene.model_copy(update={"belt_speed": float(speed)})


def next_to_bifurcations(rng: np.random.Generator) -> Iterator[Drawn]:
    """Scenes on both sides of a belt speed at which a leg comes or goes, the last two doubles before and after it."""
    for scene, law in drawn_by(draw, rng):
        low, high = 0.7 * abs(scene.belt_speed), 1.3 * abs(scene.belt_speed)
        first, last = legs(at_speed(scene, low), law), legs(at_speed(scene, high), law)
        if scene.damping_ratio < 1e-3 or first is None or first == last:
            continue
        while low < (middle := 0.5 * (low + high)) < high:
            low, high = (middle, high) if legs(at_speed(scene, middle), law) == first else (low, middle)
        for speed in (np.nextafter(low, 0.0), low, high, np.nextafter(high, math.inf)):
            yield at_speed(scene, speed), law


def count(name: str, scenes: int, source: Iterator[Drawn], other: float = 1.0) -> int:
    """Prove so many, from the orbit of ``other`` times the belt speed; how many contradict the exact method."""
    found, spent, wrong = Counter[str](), [], 0
    while found.total() < scenes:
        scene, law = next(source)
        if (answers := provable(scene, law)) is None:
            continue
        trial = answers if other == 1.0 else provable(at_speed(scene, other * scene.belt_speed), law)
        if trial is None:
            continue
        orbit, start = trial.orbit(0), time.perf_counter()
        try:
            proved = prove(scene, law.mu, orbit)
            outcome = "proved"
            if abs(proved.mean - answers.mean[0]) > answers.error[0] + proved.error:
                wrong, outcome = wrong + 1, "CONTRADICTS"
                print("CONTRADICTS", proved, answers.mean[0], answers.error[0], scene, law)
        except NotProved as why:
            outcome = f"not proved: {why}"
        found[outcome] += 1
        spent.append(1e3 * (time.perf_counter() - start))
    print(f"{name}: {np.median(spent):.2f} ms (median), {max(spent):.0f} ms (largest)")
    for what, number in found.most_common():
        print(f"  {number} {what}")
    return wrong


def main(scenes: int, seed: int) -> int:
    """Print what became of each kind; 1 where a proof contradicts."""
    rng = np.random.default_rng(seed)
    wrong = count("one sine", scenes, drawn_by(draw, rng))
    wrong += count("waveforms, belts, normal loads", scenes // 4, drawn_by(draw_varying, rng))
    wrong += count("an ulp from where legs come and go", scenes // 8, next_to_bifurcations(rng))
    wrong += count("from the orbit of another belt speed", scenes // 4, drawn_by(draw, rng), 1.1)
    return int(wrong > 0)


if __name__ == "__main__":
    given = [int(argument) for argument in sys.argv[1:]]
    sys.exit(main(*given, *(2000, 1)[len(given) :]))
