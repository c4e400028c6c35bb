"""Bounds of reduced models on random scenes: python tests/benchmarks/random_bounds.py [SCENES] [SEED] [KIND ...].

SCENES (default 5,000) scenes, two in five in the plane, of Coulomb friction: on the line those of random_reduced.py
and of tests/random_scenes.py in turn (friction from thousandths to a thousand times the load, belts that graze V_lin,
long sticks), answered by `mdsm` and `harmonic_balance` and compared with `exact`; in the plane those of
random_reduced.py and of falling and rising laws, `mdsm` against `shooting`. Prints per kind: answers, refusals, what
is not covered, bound over true error where that is above 1e-6 of mu, and the kernel time of a scene by itself.
Exit code 1 where a bound does not cover.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import random_reduced

sys.path.append(str(Path(__file__).parents[1]))

import random_scenes

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.stribeck import Stribeck
from frictionlab.methods.base import Method
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.reduced.harmonic_balance import HarmonicBalance
from frictionlab.methods.reduced.mdsm import Mdsm
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Scene
from frictionlab.theory import friction_free_velocity

Draw = Callable[[np.random.Generator], tuple[Scene, FrictionLaw]]
NOT_CONSTANT: list[FrictionLaw] = [
    Stribeck(mu_kinetic=0.3, mu_static=0.5, stribeck_speed=20.0),
    Stribeck(mu_kinetic=0.3, mu_static=0.3, viscosity=0.01),
    Stribeck(mu_kinetic=0.3, mu_static=0.35, stribeck_speed=5.0, viscosity=0.002),
]


def on_the_line(rng: np.random.Generator) -> tuple[Scene, FrictionLaw]:
    """Moderate scenes and extreme ones by turns."""
    if rng.random() < 0.5:
        return random_reduced.draw(rng, planar=False), random_reduced.LAW
    return random_scenes.draw(rng)


def in_the_plane(rng: np.random.Generator) -> tuple[Scene, FrictionLaw]:
    """Of constant friction."""
    return random_reduced.draw(rng, planar=True), random_reduced.LAW


def not_constant(rng: np.random.Generator) -> tuple[Scene, FrictionLaw]:
    """Of friction that falls or rises with speed, in the plane."""
    return random_reduced.draw(rng, planar=True), NOT_CONSTANT[rng.integers(len(NOT_CONSTANT))]


KINDS: dict[str, tuple[float, Draw, Method, tuple[Method, ...]]] = {
    "line": (0.6, on_the_line, Exact(), (Mdsm(), HarmonicBalance())),
    "plane": (0.3, in_the_plane, Shooting(), (Mdsm(),)),
    "laws": (0.1, not_constant, Shooting(), (Mdsm(),)),
}
"""Share of the scenes, how they are drawn, the truth and the models."""


@dataclass
class Found:
    """Of one model: bound over true error, by how much friction, and what else became of its scenes."""

    ratios: list[float] = field(default_factory=list)
    micros: list[float] = field(default_factory=list)
    answered: int = 0
    refused: int = 0
    in_reach: int = 0
    in_reach_answered: int = 0
    uncovered: list[str] = field(default_factory=list)

    def told(self) -> str:
        """In a line."""
        quantiles = np.quantile(self.ratios, [0.5, 0.9, 0.99]) if self.ratios else [math.nan] * 3
        return (
            f"{self.answered} answered ({self.in_reach_answered} of {self.in_reach} with friction below a third of "
            f"the loads), {self.refused} refused, {len(self.uncovered)} uncovered; bound/true 50, 90, 99 %: "
            f"{quantiles[0]:.5g} {quantiles[1]:.3g} {quantiles[2]:.3g}; {np.median(self.micros):.0f} us"
        )


def judge(found: Found, model: Method, scene: Scene, law: FrictionLaw, true: float, own: float) -> None:
    """Add one scene whose mean is known."""
    mass = scene.mass()
    size = law.sliding_friction(abs(scene.belt_speed))
    loads = math.hypot(abs(mass.force), abs(mass.transverse_force))
    weak = 3.0 * size * mass.normal_load < loads
    answer = model.solve([scene], law, 1e-8)
    found.in_reach += weak
    if answer.status[0] != "ok":
        found.refused += 1
        return
    found.answered += 1
    found.in_reach_answered += weak
    assert answer.seconds is not None
    found.micros.append(1e6 * answer.seconds[0])
    apart, error = abs(float(answer.mean[0].real) - true), float(answer.error[0])
    if not apart <= error + own:
        found.uncovered.append(
            f"{model.name}: true {apart:.3e}, bound {error:.3e}, truth to {own:.1e}: {scene!r} {law!r}"
        )
    if apart > max(1e-6 * size, 10.0 * own):
        found.ratios.append(error / apart)


def main(scenes: int, seed: int, kinds: list[str]) -> int:
    """Print the tallies; 1 where a bound does not cover."""
    uncovered = 0
    for kind in kinds:
        share, draw, truth, models = KINDS[kind]
        rng, found = np.random.default_rng(seed), {model.name: Found() for model in models}
        known = 0
        while known < share * scenes:
            scene, law = draw(rng)
            if any(model.refusal(scene, law) for model in models) or truth.refusal(scene, law):
                continue
            if kind == "line" and not math.isfinite(friction_free_velocity(scene)):
                continue
            answer = truth.solve([scene], law, 1e-9)
            if answer.status[0] != "ok":
                continue
            known += 1
            for model in models:
                judge(
                    found[model.name], model, scene, law, float(answer.mean[0].real), float(answer.error[0])
                )
        for name, one in found.items():
            print(f"{kind}, {name}: {one.told()}", flush=True)
            print(*one.uncovered, sep="\n", end="\n" if one.uncovered else "", flush=True)
            uncovered += len(one.uncovered)
    return int(uncovered > 0)


if __name__ == "__main__":
    numbers = [int(argument) for argument in sys.argv[1:] if argument.isdigit()]
    chosen = [kind for kind in KINDS if kind in sys.argv[1:]]
    scenes_wanted, first_seed = numbers + [5_000, 1][len(numbers) :]
    sys.exit(main(scenes_wanted, first_seed, chosen or list(KINDS)))
