"""All that march knows of a stepper, but for its step: what it suits, what a study may give it, order and limits.

How short the steps of an explicit stepper must be, from what the law says of its memory.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np

from frictionlab.compile.stack import count_of
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.march.adapters import Moreau, Rk4, Sdirk2, Smoothed, Stepper
from frictionlab.motion.contact import ARCTAN, TANH, friction_of, rate_of
from frictionlab.motion.steppers import rk4
from frictionlab.scene.scene import Scene
from frictionlab.theory.linear import velocity_scale
from frictionlab.values.quantities import Floats

StepperName = Literal["moreau", "rk4", "smoothed", "sdirk2"]
SMOOTHINGS = {"tanh": TANH, "arctan": ARCTAN}


@dataclass(frozen=True)
class Resolution:
    """Fineness of steps and of closing: numbers of one run."""

    steps: int = 1  # per period of the drive, or per 2 pi; of fixed steps
    theta: float = 0.5
    width: float = 1.0
    smoothing: str = "tanh"
    accuracy: float = 1.0  # of each adaptive step, in the norm of energy
    enough: float = 0.0  # distance from the closed orbit, in the same norm
    most: int = 1  # laps
    work: int = 1_000_000_000  # steps
    refined: int = 1  # times as many as in the coarsest run: a power of two
    rate: float = 0.0  # at which gaps are known to shrink, 0: unknown


class StepperFacts(NamedTuple):
    """Facts of a stepper.

    kinds: of memory that it steps. keys: of a study, beside ``periods``.
    record: its numbers in a run. held: largest stable step times frequency of a mass held by its contact. decay:
    largest stable step times decay rate of the memory, infinite where that does not limit steps. bears_jumps: whether
    rates may jump at yield. gridded: whether it meets loads at half steps alone. adaptive: whether it chooses its
    steps. sticks: whether it knows a mass at rest on the belt.
    """

    kinds: tuple[str, ...]
    keys: tuple[str, ...]
    record: Callable[[Resolution], Stepper]
    held: float = math.inf
    decay: float = math.inf
    bears_jumps: bool = True
    gridded: bool = False
    adaptive: bool = False
    sticks: bool = False

    @property
    def limited_by_rates(self) -> bool:
        """Check whether the decay of the memory limits steps, too."""
        return math.isfinite(self.decay)


STEPPERS: dict[StepperName, StepperFacts] = {
    "moreau": StepperFacts(
        ("none",),
        ("theta", "steps"),
        lambda pace: Moreau(pace.theta),
        gridded=True,
        sticks=True,
    ),
    "rk4": StepperFacts(
        ("none", "bristle", "deflections", "scalars"),
        ("steps",),
        lambda _: Rk4(),
        held=rk4.DECAY,
        decay=rk4.DECAY,
        gridded=True,
    ),
    "smoothed": StepperFacts(
        ("none",),
        ("width", "smoothing"),
        lambda pace: Smoothed(pace.width, SMOOTHINGS[pace.smoothing], pace.accuracy),
        adaptive=True,
    ),
    "sdirk2": StepperFacts(("bristle",), ("steps",), lambda _: Sdirk2(), bears_jumps=False),
}
"""Steppers; the first that steps a kind of memory is taken where none is named."""


def steppers_of(kind: str) -> list[StepperName]:
    """Return the steppers of a law with this kind of memory; none for a kind that march does not know."""
    return [name for name, facts in STEPPERS.items() if kind in facts.kinds]


MARGIN = 1.02
"""Steps used over the steps that a stability limit requires."""
AGE = 1.0
"""Largest step times decay rate of a scalar, so that no stage of a step becomes negative."""
SLOW = np.geomspace(1e-30, 1.0, 241)
"""Speeds at which friction near rest is evaluated, over that of the motion."""


# --- what changes in time -----------------------------------------------------------------------------------------


def shares_of_load(scene: Scene) -> tuple[float, float]:
    """Return the least and the largest normal load, over its mean."""
    if scene.normal_load_variation is None:
        return 1.0, 1.0
    signals = scene.signals()
    assert scene.normal_load is not None
    low, high = signals.normal_load.extremes(signals.period)
    return 1.0 + low / scene.normal_load, 1.0 + high / scene.normal_load


def lightest_contact(scene: Scene) -> float:
    """Least share of the mean load under which bristles are bent as the law says it; 1 where they follow it."""
    return shares_of_load(scene)[0] if scene.constant_contact else 1.0


# --- the motion ---------------------------------------------------------------------------------------------------


def expected_slip(scene: Scene) -> float:
    """Return the largest slip speed of the friction-free motion, and at ``scene.initial`` [scene velocity]."""
    along = velocity_scale(scene) + abs(scene.belt_speed)
    mass, start = scene.mass(), scene.start if scene.undriven else scene.initial
    dynamic = complex(mass.transverse_stiffness - mass.frequency**2, mass.transverse_damping * mass.frequency)
    across = abs(mass.transverse_force) * mass.frequency
    speed = math.hypot(along, across / abs(dynamic) if dynamic else (math.inf if across else 0.0))
    speed = speed if math.isfinite(speed) else abs(scene.belt_speed)
    speed = speed + float(mass.varying.belt_swing) if mass.varying else speed
    if start is not None:
        speed = max(speed, math.hypot(start.velocity - scene.belt_speed, start.velocity2))
    return speed


def usual_slip(scene: Scene) -> float:
    """A slip speed of the motion, above zero [scene velocity]."""
    return expected_slip(scene) or 1.0


# --- the contact --------------------------------------------------------------------------------------------------


def steady_memory(law: Any, speed: float) -> Floats:
    """Return what a law of several numbers remembers in steady sliding."""
    return np.array([law.steady(speed, k) for k in range(count_of(law))])


def first_memory(scene: Scene, law: FrictionLaw) -> Floats:
    """Return the memory at the start: no deflection; scalars as in steady sliding at the speed of the motion."""
    if law.memory_kind == "scalars":
        return steady_memory(law, usual_slip(scene))
    return np.zeros(max(1, count_of(law)))


def elastic_stiffness(law: FrictionLaw) -> float:
    """Friction coefficient per slip from rest, while the contact is elastic [1/scene length]; 0 where it is not."""
    if law.memory_kind in ("none", "scalars"):
        return 0.0
    depth = law.presliding()
    depth = depth if 0.0 < depth < math.inf else 1e-6
    n = count_of(law)
    return float(friction_of(law, np.full(n, depth), np.zeros(n), 0.0)) / depth


def friction_at_once(law: FrictionLaw, speed: float, memory: Floats) -> float:
    """Friction at a speed with this memory."""
    rates = np.array([rate_of(law, memory, k, speed) for k in range(count_of(law))])
    return float(friction_of(law, memory, rates, speed))


def contact_damping(scene: Scene, law: FrictionLaw) -> float:
    """Slope of friction over slip velocity; for deflections, friction from rest over the speed."""
    memory = first_memory(scene, law)
    speed = 1.0 if law.memory_kind == "bristle" else usual_slip(scene)
    if law.memory_kind != "scalars":
        return friction_at_once(law, speed, memory) / speed
    change = friction_at_once(law, 1.01 * speed, memory) - friction_at_once(law, speed, memory)
    return max(0.0, change / (0.01 * speed))


def memory_stiffness(scene: Scene, law: FrictionLaw) -> Floats:
    """Return the stiffness of each memory in the energy norm; of a scalar, from its effect on friction."""
    if law.memory_kind in ("none", "bristle"):
        return np.array([scene.mass().normal_load * elastic_stiffness(law)])
    speed, load = usual_slip(scene), scene.mass().normal_load
    most, n = law.sliding_friction(speed), count_of(law)
    steady, still = steady_memory(law, speed), np.zeros(n)
    size = np.where(steady == 0.0, 1.0, np.abs(steady))
    change = [
        friction_of(law, steady + shift, still, speed) - friction_of(law, steady - shift, still, speed)
        for shift in 1e-3 * size * np.eye(n)
    ]
    slope = np.maximum(np.abs(change) / (2e-3 * size), 1e-6 * most / size)
    if law.memory_kind == "deflections":
        return np.asarray(load * slope)
    return np.asarray((load * slope / scene.mass().frequency) ** 2)


# --- steps --------------------------------------------------------------------------------------------------------


def stable_decay(law: FrictionLaw, facts: StepperFacts) -> float:
    """Largest stable step of a stepper times decay rate of this law's memory."""
    return min(AGE, facts.decay) if law.memory_kind == "scalars" else facts.decay


def fastest_slip(law: FrictionLaw, facts: StepperFacts, h: float) -> float:
    """Return the slip speed at which the memory decays at the largest rate for which steps of length h are stable."""
    low, high, decay = 0.0, 1e12, stable_decay(law, facts)
    if law.memory_kind == "none":
        return 1e300
    if h * law.largest_rate(high) <= decay:
        return high
    for _ in range(200):
        middle = math.sqrt(low * high) if low > 0.0 else 1e-12 if high > 1e-12 else 0.5 * high
        if h * law.largest_rate(middle) <= decay:
            low = middle
        else:
            high = middle
        if high - low <= 1e-9 * high:
            break
    return low


def fewest_steps(scene: Scene, law: FrictionLaw, facts: StepperFacts) -> int:
    """Steps per period that a stepper needs; 1 where any number is stable, 0 where the law names no rate.

    For slip as fast as that of the friction-free motion on this belt, and for a mass held by its contact.
    """
    if law.memory_kind == "none" or math.isinf(facts.held):
        return 1
    lap = 2.0 * math.pi / scene.frequency
    held = quickest_when_held(scene, law)
    if not facts.limited_by_rates:
        return math.ceil(MARGIN * lap * held / facts.held)
    rate = law.largest_rate(expected_slip(scene)) / lightest_contact(scene)
    if not math.isfinite(rate):
        return 0
    return math.ceil(MARGIN * lap * max(held / facts.held, rate / stable_decay(law, facts)))


def quickest_when_held(scene: Scene, law: FrictionLaw) -> float:
    """Return the largest frequency, or rate of decay, of a mass held by its springs and by its contact."""
    mass = scene.mass()
    heaviest = mass.normal_load * shares_of_load(scene)[1]
    stiffness = max(mass.stiffness, mass.transverse_stiffness) + heaviest * elastic_stiffness(law)
    damping = max(mass.damping, mass.transverse_damping) + heaviest * contact_damping(scene, law)
    return max(math.sqrt(stiffness), damping)


def steps_through_rest(scene: Scene, law: FrictionLaw, facts: StepperFacts) -> float:
    """Steps per period that a stepper needs where slip comes to rest: friction may be steep there. 0 for laws that
    say how their one deflection slows down, and for those without memory.
    """
    if law.memory_kind in ("none", "bristle"):
        return 0.0
    speeds, memory = usual_slip(scene) * SLOW, first_memory(scene, law)
    steepest = max(friction_at_once(law, float(speed), memory) / float(speed) for speed in speeds)
    heaviest = scene.mass().normal_load * shares_of_load(scene)[1]
    return 2.0 * math.pi / scene.frequency * heaviest * steepest / facts.decay
