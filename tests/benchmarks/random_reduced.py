"""The reduced models' error on random scenes: python tests/benchmarks/random_reduced.py [SCENES] [SEED] [METHOD ...].

SCENES (default 2,000) scenes for each kind, along the belt against ``exact`` and in the plane against
``shooting``, log-uniform in friction over load 1e-3 ... 2, frequency 0.3 ... 10, damping 1e-3 ... 1 and belt speed
0.01 ... 1.5 V_lin; in the plane also in the natural frequency and load across the belt, half of them in phase.
Exit code 1 where the error covers fewer than 99 % of the answers or is above ten times the true one in the median.
"""

from __future__ import annotations

import math
import sys
import time
from collections import Counter
from dataclasses import dataclass, field

import numpy as np
from campaign import log_uniform

from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.base import Method
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.reduced.harmonic_balance import HarmonicBalance
from frictionlab.methods.reduced.mdsm import Mdsm
from frictionlab.methods.shooting.method import Shooting
from frictionlab.runner.solve import number_columns
from frictionlab.scene.scene import Drive, Load, Scene, Transverse
from frictionlab.theory import friction_free_velocity

LAW = Coulomb(mu=0.4)
KINDS: dict[str, tuple[bool, Method, Method]] = {
    "mdsm along the belt": (False, Mdsm(), Exact()),
    "harmonic_balance along the belt": (False, HarmonicBalance(), Exact()),
    "mdsm in the plane": (True, Mdsm(), Shooting()),
}


@dataclass
class Tally:
    """What became of the scenes: status and reason, and error over true error."""

    found: Counter[str] = field(default_factory=Counter)
    ratios: list[float] = field(default_factory=list)
    seconds: float = 0.0
    uncovered: list[str] = field(default_factory=list)


def draw(rng: np.random.Generator, planar: bool) -> Scene:
    """One scene; its law is LAW."""
    load, frequency = log_uniform(rng, 0.1, 100), log_uniform(rng, 0.3, 10)
    across = None
    if planar:
        phase = 0.0 if rng.random() < 0.5 else float(rng.uniform(0, 360))
        across = Transverse(
            natural_frequency=log_uniform(rng, 0.3, 10),
            damping_ratio=log_uniform(rng, 1e-3, 1),
            load=Load(amplitude=load * log_uniform(rng, 0.01, 10), phase=phase),
        )
    scene = Scene(
        damping_ratio=log_uniform(rng, 1e-3, 1),
        normal_load=log_uniform(rng, 1e-3, 2) * load / LAW.mu,
        belt_speed=0.0,
        drive=Drive(
            amplitude=load, frequency=frequency, phase=float(rng.uniform(0, 360)) if not planar else 0.0
        ),
        transverse=across,
    )
    speed = log_uniform(rng, 0.01, 1.5) * friction_free_velocity(scene)
    return scene.model_copy(update={"belt_speed": speed})


def count(kind: str, scenes: int, seed: int) -> Tally:
    """Answers of one model against the truth."""
    planar, model, truth = KINDS[kind]
    rng, tally = np.random.default_rng(seed), Tally()
    for _ in range(scenes):
        scene = draw(rng, planar)
        _compare(tally, scene, model, truth)
    return tally


def _compare(tally: Tally, scene: Scene, model: Method, truth: Method) -> None:
    answer, known = model.solve([scene], LAW, 1e-8), truth.solve([scene], LAW, 1e-9)
    tally.seconds += answer.seconds[0]
    if known.status[0] != "ok":
        tally.found[f"truth {known.status[0]}"] += 1
        return
    tally.found[answer.status[0]] += 1
    if answer.status[0] != "ok":
        decade = next(edge for edge in (0.1, 0.3, 0.5, 1.0, math.inf) if _ratio(scene) < edge)
        tally.found[f"  friction/load < {decade}: {answer.reason[0].split('within')[0]}"] += 1
        return
    true = abs(float(answer.mean[0].real - known.mean[0].real))
    error, own = float(answer.error[0]), float(known.error[0])
    if true > 1e-6:
        tally.ratios.append(error / true)
    if true > error + own:
        stuck = number_columns(known, [scene], ["stick_fraction"])["stick_fraction"][0]
        tally.uncovered.append(f"true {true:.2e}, error {error:.2e}, in stick {stuck:.2f}: {scene.values()}")


def _ratio(scene: Scene) -> float:
    """Friction over the load, of both directions."""
    mass = scene.mass()
    return LAW.mu * mass.normal_load / math.hypot(abs(mass.force), abs(mass.transverse_force))


def main(scenes: int, seed: int, kinds: list[str]) -> int:
    """Print the tallies; 1 where one falls short."""
    short = 0
    for kind in kinds:
        start = time.perf_counter()
        tally = count(kind, scenes, seed)
        answered = tally.found["ok"]
        covered = 1.0 - len(tally.uncovered) / answered
        quantiles = np.quantile(tally.ratios, [0.1, 0.5, 0.9, 0.99])
        print(f"{kind}: {answered} answered, {covered:.2%} covered, {time.perf_counter() - start:.0f} s")
        print(
            f"  error / true error where that is above 1e-6 ({len(tally.ratios)} points), 10, 50, 90, 99 %:",
            quantiles,
        )
        print(f"  {1e6 * tally.seconds / scenes:.0f} us per scene, one at a time")
        for line in sorted(tally.found.items()):
            print("  ", *line)
        for text in tally.uncovered:
            print("  uncovered:", text)
        short += covered < 0.99 or quantiles[1] > 10.0
    return int(short > 0)


if __name__ == "__main__":
    numbers = [int(argument) for argument in sys.argv[1:] if argument.isdigit()]
    chosen = [kind for kind in KINDS if any(kind.startswith(name) for name in sys.argv[1:])]
    scenes_wanted, first_seed = numbers + [2_000, 1][len(numbers) :]
    sys.exit(main(scenes_wanted, first_seed, chosen or list(KINDS)))
