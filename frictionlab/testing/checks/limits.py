"""Checks by steady states: the Coulomb limit at the rate it must be reached, and two methods on one curve."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import assume

from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.memory import BristleLaw, MemoryLaw
from frictionlab.methods.march.method import March
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Drive, Scene, Slip
from frictionlab.scene.units import Units, scaled_law
from frictionlab.testing.checks.declared import WITH_MEMORY
from frictionlab.testing.contact import deflection_scale
from frictionlab.testing.example import Given, law_check
from frictionlab.testing.strategies import sizes

NOT_CONSTANT = (
    "sliding friction varies with speed for all parameters drawn: Coulomb friction is no limit of it"
)
SWING = 10.0
"""Velocity amplitude of the prescribed slip [scene velocity]."""


def as_stiff(law: FrictionLaw, presliding: float) -> FrictionLaw:
    """Law in lengths and times so small that its deflection is of this length, and its speeds what they were."""
    times = _deflection(law) / presliding
    return scaled_law(law, Units(times, times, 1.0))


def _deflection(law: FrictionLaw) -> float:
    if isinstance(law, BristleLaw):
        return deflection_scale(law)
    assert isinstance(law, MemoryLaw)
    steady = max(abs(law.steady(1.0, k)) for k in range(law.count()))
    return steady or 1.0


def _with_deflections(law: FrictionLaw) -> bool:
    return isinstance(law, BristleLaw) or getattr(law, "memory_kind", "") == "deflections"


def _settles(law: FrictionLaw) -> bool:
    """Check whether bristles tend to one friction within some of their lengths: not where they near it as a power."""
    if not (law.constant_sliding_friction() and _with_deflections(law)):
        return False
    if not isinstance(law, BristleLaw) or not law.exact_path():
        return True
    size = deflection_scale(law)
    return abs(law.deflected(-size, 30.0 * size) - size) <= 0.01 * size


def _settles_gently(law: FrictionLaw) -> bool:
    """Return the same, and no bristle that bends over resists by its damping more than it does when it has."""
    if not _settles(law):
        return False
    bending = law.friction(SWING, 0.0, law.rate(SWING, 0.0)) if isinstance(law, BristleLaw) else 0.0
    return abs(bending) <= law.sliding_friction(SWING)


REACHED_BY_STEPS = 1e-3
"""Distance of time stepping to shooting, over the friction coefficient, that short steps reach."""


@law_check(
    change="correct rate and friction: a stiff contact slides; or let constant_sliding_friction() be false",
    declares="constant_sliding_friction",
    patience=10.0,
    skips=WITH_MEMORY,
    share=0.02,
    seldom=NOT_CONSTANT,
)
def coulomb_limit_of_prescribed_slip(one: Given) -> None:
    """Under a prescribed slip the mean nears that of Coulomb friction as one over stiffness."""
    law = one.law(_settles)
    mu = law.sliding_friction(1.0)
    scene = Scene(belt_speed=0.5 * SWING, slip=Slip(velocity_amplitude=SWING, frequency=1.0))
    coulomb = 2.0 / math.pi * math.asin(0.5) * mu
    gaps = [
        abs(_mean(one, scene, as_stiff(law, length * SWING), 1e-9 * mu) - coulomb) for length in (1e-2, 1e-3)
    ]
    one.require(gaps[0] < 0.1 * mu, "the mean of stiff bristles is not that of Coulomb friction", gap=gaps[0])
    near = 5.0 <= gaps[0] / max(gaps[1], 1e-300) <= 20.0 or gaps[0] < 1e-7 * mu
    one.require(near, "ten times the stiffness must leave a tenth of the gap", gaps=tuple(gaps))


@law_check(
    change="correct rate and friction: a stiff contact slides; or let constant_sliding_friction() be false",
    declares="constant_sliding_friction",
    patience=10.0,
    skips=WITH_MEMORY,
    share=0.01,
    seldom=NOT_CONSTANT,
)
def coulomb_limit_of_a_body(one: Given) -> None:
    """Mean friction of a body driven above resonance nears Coulomb's as one over the root of stiffness."""
    law = one.law(_settles_gently)  # else it nears Coulomb friction as one over stiffness first
    mu = law.sliding_friction(1.0)
    scene = _body(friction=4.0, mu=mu, belt_speed=15.0, frequency=1.5)
    coulomb = _mean(one, scene, Coulomb(mu=mu), 1e-9 * mu)
    lengths = (1e-2, 1e-3, 1e-4)
    gaps = [abs(_mean(one, scene, as_stiff(law, length), 1e-9 * mu) - coulomb) for length in lengths]
    slope = float(np.polyfit(np.log(lengths), np.log(gaps), 1)[0])
    one.require(
        0.4 <= slope <= 0.6, "the gap to Coulomb friction falls as stiffness to the power", got=-slope
    )


@law_check(
    change="check what the law declares (largest_rate, exact_path, yield_deflection): the methods use it",
    patience=10.0,
    share=0.02,
    seldom="no parameters drawn give a state that both methods find",
)
def two_methods(one: Given) -> None:
    """Time stepping comes as near to the mean of shooting on a short curve as its steps allow."""
    law = one.law()
    if not isinstance(law, SlidingLaw) and _with_deflections(law):
        law = as_stiff(law, one.draw("presliding length", sizes(0.1, 1.0)))
    mu = law.sliding_friction(20.0)
    assume(mu > 0.0)
    curve = [_body(friction=4.0, mu=mu, belt_speed=speed, frequency=1.5) for speed in (8.0, 16.0, 24.0)]
    shooting, march = Shooting(), March()
    assume(not any(method.refusal(curve[0], law) for method in (shooting, march)))
    marched = march.solve(curve, law, REACHED_BY_STEPS * mu)
    found = [i for i in range(3) if marched.status[i] == "ok"]
    assume(found)
    for i in found:
        one.require(
            marched.error[i] <= REACHED_BY_STEPS * mu,
            f"at belt speed {curve[i].belt_speed:g} ever shorter steps do not come near to the mean of shooting",
            apart=float(marched.error[i]),
            march=float(marched.mean[i].real),
        )


def _body(friction: float, mu: float, belt_speed: float, frequency: float) -> Scene:
    """A driven body whose sliding friction is this force."""
    drive = Drive(unbalance=10.0, frequency=frequency)
    return Scene(damping_ratio=0.1, normal_load=friction / mu, belt_speed=belt_speed, drive=drive)


def _mean(one: Given, scene: Scene, law: FrictionLaw, tolerance: float) -> float:
    answers = Shooting().solve([scene], law, tolerance)
    assume(answers.status[0] != "not_unique")  # several states, or one that takes too long to be sure of
    ok = answers.status[0] == "ok"
    one.require(ok, f"shooting finds no steady state of the stiff law: {answers.reason[0]}")
    return float(answers.mean[0].real)
