"""Friction that falls faster than damping makes up for: how many ``ok`` answers of shooting are not alone.

STARTS starts of this file's own are followed in each scene: at rest, flung, spread over ellipses of energy up to
several times the free motion, each until it repeats, nears a known orbit as the multipliers of that say, or for LONG
periods; a scene is left once two different states are found in it, or a motion that does not repeat.
"""

from __future__ import annotations

import math

import numpy as np
from campaign import WRONG, Campaign, Drawn, Keys, Verdicts, law_of, log_uniform

import frictionlab as fl
from frictionlab.methods.periodic.attraction import ARRIVED
from frictionlab.methods.periodic.follow import Attractor, closed_orbit, orbit_at_the_end
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.scene.scene import Initial, Scene
from frictionlab.theory.linear import velocity_scale
from frictionlab.theory.rest import falls_slowly

LONG, STARTS = 4000, 64
BRISTLES = 0.03
"""Share of falling bristle laws."""


def draw(rng: np.random.Generator) -> Drawn | None:
    """A driven line; friction is .02 ... 3 of the load, and the belt a share of the free motion's speed."""
    frequency, damping = log_uniform(rng, 0.3, 4.0), log_uniform(rng, 0.003, 0.3)
    load = log_uniform(rng, 0.3, 30.0)
    stiffness = math.hypot(1.0 - frequency**2, 2.0 * damping * frequency)
    speed = load * frequency / max(stiffness, 0.02)
    scene: Keys = {
        "damping_ratio": damping,
        "normal_load": load * log_uniform(rng, 0.02, 3.0) / 0.4,
        "belt_speed": speed * log_uniform(rng, 0.01, 3.0) * float(rng.choice([1.0, 1.0, 1.0, -1.0])),
        "drive": {"amplitude": load, "frequency": frequency, "phase": float(rng.uniform(0.0, 360.0))},
    }
    law = _law(rng, speed)
    steep = not falls_slowly(fl.Scene(**scene), law_of(law))
    return Drawn(law["kind"], scene, law, method="shooting") if steep else None


def _law(rng: np.random.Generator, speed: float) -> Keys:
    law: Keys = {
        "mu_static": 0.4,
        "mu_kinetic": 0.4 * float(rng.uniform(0.2, 0.95)),
        "stribeck_speed": speed * log_uniform(rng, 0.03, 3.0),
        "stribeck_exponent": float(rng.choice([1.0, 2.0, rng.uniform(1.0, 3.0)])),
    }
    if rng.random() < BRISTLES:
        return law | {"kind": "lugre", "presliding_length": speed * log_uniform(rng, 1e-3, 1e-1)}
    if rng.random() < 0.3:
        del law["stribeck_exponent"]
        law["curve"] = str(rng.choice(["hyperbolic", "hess-soom"]))
    if rng.random() < 0.15:
        return {"kind": "coulomb", "mu": law["mu_kinetic"], "mu_static": 0.4}
    return law | {"kind": "stribeck"}


def starts(scene: Scene, limit: float, rng: np.random.Generator) -> list[Initial]:
    """Rest at places up to where friction lets go, flung ones, the others by energy around the mean deflection."""
    belt, swing = scene.belt_speed, velocity_scale(scene)
    found = [Initial(x=limit * share, velocity=belt) for share in (-0.9, 0.0, 0.9)]
    flung = 4.0 * (abs(belt) + swing)
    found += [Initial(x=side * 4.0 * limit, velocity=side * flung) for side in (-1.0, 1.0)]
    reach = max(swing, limit, abs(belt))
    while len(found) < STARTS:
        size, angle = reach * 5.0 * rng.random() ** 2, rng.uniform(0.0, 2.0 * math.pi)
        middle = math.copysign(limit, belt) * rng.random()
        found.append(Initial(x=middle + size * math.cos(angle), velocity=size * math.sin(angle)))
    return found


State = tuple[float, float, float]
"""Its period in drive periods (0: it does not repeat), its mean, the error of that."""


def states(one: Drawn) -> list[State]:
    """Different states that the starts end in: two at most."""
    scene, law = one.made()
    problem = PeriodicProblem(scene, law, one.tolerance)
    curve, _ = problem.close([scene])
    candidate = closed_orbit(curve, curve.results[0, :1])
    found = [] if candidate is None else [_told(candidate)]
    known = None if candidate is None else candidate.known
    rng = np.random.default_rng([*repr(one).encode()])
    for start in starts(scene, problem.mass.normal_load * 0.4, rng):
        way = problem.carried(scene.belt_speed, problem.state_at(scene.belt_speed, start), LONG, known)
        if way.period == ARRIVED:
            continue
        orbit, _ = orbit_at_the_end(problem, scene, way)
        known = orbit.known if orbit.period == 1 else known
        if not any(_same(each, _told(orbit)) for each in found):
            found.append(_told(orbit))
        if len(found) > 1 or orbit.period == 0:
            break
    return found


def _told(orbit: Attractor) -> State:
    return orbit.period, orbit.mean, math.nan if orbit.curve is None else float(orbit.curve.results[0, 2])


def _same(one: State, other: State) -> bool:
    return one[0] == other[0] and abs(one[1] - other[1]) <= one[2] + other[2] + 1e-9


def judge(one: Drawn) -> Verdicts:
    """Whether an answer is the only state."""
    answer = one.answered()
    if answer.status != "ok":
        yield answer.status, ""
        return
    own = (1, answer.mean_friction, answer.error)
    other = next((each for each in states(one) if not _same(each, own)), None)
    yield ("ok, alone" if other is None else f"{WRONG}: ok beside another state"), (own, other)


CAMPAIGN = Campaign(draw, judge, scenes=2000)
