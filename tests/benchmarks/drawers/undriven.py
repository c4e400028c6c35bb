"""Contacts with memory on scenes that nothing drives.

Normal load .1 ... 10, belt speed 1e-2 ... 3 and damping 1e-3 ... 1 or none, friction that falls or is the same at
every speed, presliding length 1e-5 ... 1 of what friction deflects the spring by, all log-uniform; a third set off
somewhere else than at rest on the belt. Answers are compared with scipy's LSODA on the interpreted law, from the
scene's own start until the mean from one largest deflection to the next repeats, with CALLS calls at most.
"""

from __future__ import annotations

import math
import random

import numpy as np
from campaign import Campaign, Drawn, Keys, Unknown, covered, law_of, log_uniform, sound
from scipy.integrate import solve_ivp

import frictionlab as fl
from drawers import every_law
from frictionlab.theory.sliding_stability import steady_deflection
from frictionlab.values.quantities import Floats

KINDS = (
    "dahl",
    "exponent",
    "lugre",
    "falling lugre",
    "elasto-plastic",
    "jenkins",
    "maxwell-slip",
    "rate-and-state",
)
CALLS = 400_000
TURN = 2.0 * math.pi
REPEATS = 1e-9
"""By how much two means in a row differ, and those before them, where a motion is taken to repeat."""


def draw(rng: np.random.Generator) -> Drawn:
    """A scene and a law."""
    load, speed, kind = log_uniform(rng, 0.1, 10), log_uniform(rng, 1e-2, 3), str(rng.choice(KINDS))
    law = _law(rng, kind, load, speed)
    scene: Keys = {
        "damping_ratio": 0.0 if rng.random() < 0.25 else log_uniform(rng, 1e-3, 1),
        "normal_load": load,
        "belt_speed": float(rng.choice([-1.0, 1.0])) * speed,
    }
    if rng.random() < 0.33:
        far = load * law_of(law).sliding_friction(speed)
        start = {"x": float(rng.uniform(-2, 2)) * far, "velocity": float(rng.uniform(-2, 2)) * speed}
        scene["initial"] = start
    return Drawn(kind, scene, law, float(rng.choice([1e-4, 1e-6, 1e-8])))


def _law(rng: np.random.Generator, kind: str, load: float, speed: float) -> Keys:
    if kind == "rate-and-state":
        mu = log_uniform(rng, 0.1, 1)
        a = mu * log_uniform(rng, 0.01, 0.1)
        told = {"a": a, "b": a * float(rng.uniform(0.5, 3)), "state_law": str(rng.choice(["ageing", "slip"]))}
        length = load * a * log_uniform(rng, 0.03, 3)
        return {"kind": kind, "mu": mu, "slip_length": length, "reference_speed": speed, **told}
    length = 0.4 * load * log_uniform(rng, 1e-5, 1)
    law = every_law.law(random.Random(int(rng.integers(2**32))), kind, length, speed)
    if "damping" in law:  # up to that which is critical for the mass on its bristles
        law["damping"] = log_uniform(rng, 1e-2, 2) * math.sqrt(law["mu_kinetic"] / length / load)
    return law


class Motion:
    """The mass, its slip, what the contact remembers and friction's impulse, by the interpreted law."""

    def __init__(self, one: Drawn) -> None:
        (self.scene, self.law), self.calls = one.made(), 0
        self.bristle, self.count = self.law.memory_kind == "bristle", self.law.count()
        self.load, self.damping, self.belt = (
            self.scene.normal_load,
            2.0 * self.scene.damping_ratio,
            self.scene.belt_speed,
        )
        self.side = math.copysign(1.0, self.belt)
        self.still = self.side * self.load * self.law.sliding_friction(abs(self.belt))

    def start(self) -> Floats:
        """As the documentation says: no deflection; ages of steady sliding on this belt."""
        memory = [0.0] * self.count
        if self.law.memory_kind == "scalars":
            memory = [self.law.steady(-self.belt, k) for k in range(self.count)]
        return np.array([self.scene.start.x, self.scene.start.velocity - self.belt, *memory, 0.0])

    def sizes(self) -> Floats:
        """Of every number, for absolute tolerances."""
        if self.bristle:
            memory = [abs(steady_deflection(self.law, self.belt))]
        else:
            memory = [abs(self.law.steady(self.belt, k)) for k in range(self.count)]
        return np.array([abs(self.still), abs(self.belt), *memory, 1.0])

    def __call__(self, tau: float, y: Floats) -> list[float]:
        self.calls += 1
        if self.calls > CALLS:
            raise Unknown("too many calls")
        x, w, *memory, _ = y.tolist()
        if self.bristle:
            rates = [self.law.rate(w, memory[0])]
            rub = self.law.friction(w, memory[0], rates[0])
        else:
            if self.law.memory_kind == "scalars" and not self.law.within(memory):
                raise Unknown("scipy left the set of memories")
            rates = [self.law.rate(w, memory, k) for k in range(self.count)]
            rub = self.law.friction(w, memory, rates)
        v = w + self.belt
        return [v, -x - self.damping * v - self.load * rub, *rates, rub]

    def mean(self, rtol: float) -> float:
        """In the long run. Raises Unknown."""
        place, peaks, tau = self.start(), list[tuple[float, float, float]](), 0.0

        def turns(tau: float, y: Floats) -> float:
            return float(y[1] + self.belt)

        turns.direction = -self.side  # type: ignore[attr-defined]  # how solve_ivp is told
        while True:
            span = tau, tau + 2.0 * TURN
            options = {"rtol": rtol, "atol": rtol * self.sizes(), "events": turns}
            found = solve_ivp(self, span, place, "LSODA", **options)
            if found.status < 0 or not np.isfinite(found.y).all():
                raise Unknown(str(found.message))
            velocity = found.y[1] + self.belt
            if np.abs(velocity).max() < 1e-10 * abs(self.belt):
                return float(found.y[0, -1] / self.load)
            for at, y in zip(found.t_events[0], found.y_events[0], strict=True):
                if self.side * (y[0] - self.still) > 0.0:
                    peaks.append((float(at), float(y[-1]), float(y[0] - self.still)))
            if (mean := _repeated(peaks)) is not None:
                return mean
            place, tau = found.y[:, -1], span[1]


def _repeated(peaks: list[tuple[float, float, float]]) -> float | None:
    """The mean over so few peaks as it repeats after."""
    for back in 1, 2, 3, 4:
        if len(peaks) < 5 * back + 1:
            return None
        means, lengths = [], []
        for k in range(4):
            (begun, before, _), (at, impulse, _) = peaks[-1 - (k + 1) * back], peaks[-1 - k * back]
            means.append(-(impulse - before) / (at - begun))
            lengths.append(at - begun)
        # what dies out repeats its mean long before it ends: deflections must repeat, too
        ends = np.array([far for _, _, far in peaks[-1::-back][:4]])
        dies_out = np.abs(np.diff(ends)).max() > 1e-6 * np.abs(ends).max()
        if not dies_out and np.abs(np.diff(means)).max() < REPEATS and np.ptp(lengths) < 1e3 * REPEATS:
            return float(means[0])
    return None


def followed(one: Drawn, state: fl.SteadyState) -> tuple[float, float]:
    """The mean by LSODA, and how far it may be off."""
    rough, true = (Motion(one).mean(rtol) for rtol in (1e-9, 1e-11))
    return true, 2.0 * abs(true - rough) + 3.0 * REPEATS


CAMPAIGN = Campaign(draw, sound, covered(followed), scenes=400, compared=150)
