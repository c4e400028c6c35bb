"""Undriven contacts with memory, counted: python tests/benchmarks/random_undriven.py [SCENES] [COMPARED] [SEED].

SCENES (default 400) scenes go through ``auto`` at one of the tolerances 1e-4, 1e-6 and 1e-8: normal load 0.1 ... 10,
belt speed 1e-2 ... 3 and damping 1e-3 ... 1 or none, friction that falls or is the same at every speed,
presliding length 1e-5 ... 1 of what friction deflects the spring by, all log-uniform; a third set off somewhere else
than at rest on the belt. COMPARED (default 150) answers are compared with scipy's LSODA on the interpreted law, from
the scene's own start until the mean from one largest deflection to the next repeats; a scene that takes more than
CALLS calls of the equations of motion is passed over, and counted. Exit code 1 where an answer is no number, has an
error above the tolerance or one that does not cover the difference.
"""

from __future__ import annotations

import math
import sys
import time
from typing import Any

import numpy as np
from maxwell_slip import MaxwellSlip
from rate_and_state import RateAndState
from scipy.integrate import solve_ivp
from tally import Tally, TooSlow, log_uniform

import frictionlab as fl
from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Initial, Scene
from frictionlab.theory.sliding_stability import steady_deflection

KINDS = "dahl", "lugre", "lugre constant", "elasto-plastic", "jenkins", "maxwell-slip", "rate-and-state"
TOLERANCES = 1e-4, 1e-6, 1e-8
CALLS = 400_000
TURN = 2.0 * math.pi
SLOW = 3.0
"""Seconds for one scene that are worth a line."""
REPEATS = 1e-9
"""By how much two means in a row differ, and those before them, where a motion is taken to repeat."""


def draw(rng: np.random.Generator) -> tuple[str, Scene, FrictionLaw, float]:
    """Its kind, a scene, a law and a tolerance."""
    load, speed, kind = log_uniform(rng, 0.1, 10), log_uniform(rng, 1e-2, 3), str(rng.choice(KINDS))
    law = _law(rng, kind, load, speed)
    damping = 0.0 if rng.random() < 0.25 else log_uniform(rng, 1e-3, 1)
    side = float(rng.choice([-1.0, 1.0]))
    start = None
    if rng.random() < 0.33:
        far = load * law.sliding_friction(speed)
        start = Initial(x=float(rng.uniform(-2, 2)) * far, velocity=float(rng.uniform(-2, 2)) * speed)
    scene = Scene(damping_ratio=damping, normal_load=load, belt_speed=side * speed, initial=start)
    return kind, scene, law, float(rng.choice(TOLERANCES))


def _law(rng: np.random.Generator, kind: str, load: float, speed: float) -> FrictionLaw:
    mu = log_uniform(rng, 0.1, 1)
    if kind == "rate-and-state":
        a = mu * log_uniform(rng, 0.01, 0.1)
        b, state_law = a * float(rng.uniform(0.5, 3)), str(rng.choice(["ageing", "slip"]))
        length = load * a * log_uniform(rng, 0.03, 3)
        return RateAndState(mu=mu, a=a, b=b, slip_length=length, reference_speed=speed, state_law=state_law)
    length = load * mu * log_uniform(rng, 1e-5, 1)
    if kind == "maxwell-slip":
        share = rng.uniform(0.1, 1, 3)
        return MaxwellSlip(
            mu=(mu * share / share.sum()).tolist(), stiffness=[mu / length * 3.0**k for k in range(3)]
        )
    if kind == "dahl":
        return fl.Dahl(mu=mu, presliding_length=length, exponent=float(rng.choice([1.0, 0.5])))
    if kind == "jenkins":
        return fl.Jenkins(mu=mu, presliding_length=length)
    common: dict[str, Any] = {"mu_kinetic": mu, "presliding_length": length}
    if rng.random() < 0.6:  # up to that which is critical for the mass on its bristles
        common["damping"] = log_uniform(rng, 1e-2, 2) * math.sqrt(mu / length / load)
    if kind == "lugre constant":
        return fl.LuGre(**common)
    common |= {
        "mu_static": mu * float(rng.uniform(1, 2)),
        "stribeck_speed": log_uniform(rng, 0.03, 3) * speed,
    }
    if rng.random() < 0.5:
        common["viscosity"] = log_uniform(rng, 1e-3, 0.3) * mu / speed
    if kind == "lugre":
        return fl.LuGre(**common)
    return fl.ElastoPlastic(breakaway_ratio=float(rng.uniform(0.1, 0.95)), **common)


def count(tally: Tally, number: int, drawn: tuple[str, Scene, FrictionLaw, float]) -> bool:
    """Solve one scene; whether it has an answer to compare."""
    kind, scene, law, tolerance = drawn
    state = fl.steady_state(scene, law, tolerance=tolerance)
    what = state.model.partition(" (")[0].partition(", ")[0] if state.status == "ok" else state.status
    tally.found[f"{kind}: {what}"] += 1
    tally.seconds.append(state.seconds)
    if state.status == "ok" and not (math.isfinite(state.mean_friction) and 0.0 <= state.error <= tolerance):
        tally.wrong.append(f"{number}: mean {state.mean_friction}, error {state.error}; {scene!r}, {law!r}")
    elif state.status != "ok":
        print(f"{number}: {state.status}, {state.reason}; {tolerance}, {scene!r}, {law!r}", flush=True)
    return state.status == "ok"


class Motion:
    """The mass, its slip, what the contact remembers and friction's impulse, by the interpreted law."""

    def __init__(self, scene: Scene, law: FrictionLaw) -> None:
        self.scene, self.law, self.calls = scene, law, 0
        self.bristle, self.count = law.memory_kind == "bristle", law.count()
        self.load, self.damping, self.belt = scene.normal_load, 2.0 * scene.damping_ratio, scene.belt_speed
        self.side = math.copysign(1.0, self.belt)
        self.still = self.side * self.load * law.sliding_friction(abs(self.belt))

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
            raise TooSlow("too many calls")
        x, w, *memory, _ = y.tolist()
        if self.bristle:
            rates = [self.law.rate(w, memory[0])]
            rub = self.law.friction(w, memory[0], rates[0])
        else:
            if self.law.memory_kind == "scalars" and not self.law.within(memory):
                raise TooSlow("scipy left the set of memories")
            rates = [self.law.rate(w, memory, k) for k in range(self.count)]
            rub = self.law.friction(w, memory, rates)
        v = w + self.belt
        return [v, -x - self.damping * v - self.load * rub, *rates, rub]

    def mean(self, rtol: float) -> float:
        """In the long run. Raises TooSlow."""
        place, peaks, tau = self.start(), list[tuple[float, float, float]](), 0.0

        def turns(tau: float, y: Floats) -> float:
            return float(y[1] + self.belt)

        turns.direction = -self.side  # type: ignore[attr-defined]  # how solve_ivp is told
        while True:
            span = tau, tau + 2.0 * TURN
            options = {"rtol": rtol, "atol": rtol * self.sizes(), "events": turns}
            found = solve_ivp(self, span, place, "LSODA", **options)
            if found.status < 0 or not np.isfinite(found.y).all():
                raise TooSlow(str(found.message))
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


def compare(tally: Tally, number: int, drawn: tuple[str, Scene, FrictionLaw, float]) -> bool:
    """Compare one answer with LSODA; whether that came to an end."""
    kind, scene, law, tolerance = drawn
    state = fl.steady_state(scene, law, tolerance=tolerance)
    try:
        rough, true = (Motion(scene, law).mean(rtol) for rtol in (1e-9, 1e-11))
    except (TooSlow, ArithmeticError, ValueError) as why:
        tally.compared[f"passed over: {kind}, {why}"] += 1
        return False
    tally.compared[kind] += 1
    off, own = abs(state.mean_friction - true), 2.0 * abs(true - rough) + 3.0 * REPEATS
    if not off <= state.error + own:
        tally.wrong.append(
            f"{number}: UNCOVERED by {off - state.error:.2e}: mean {state.mean_friction!r}, error {state.error:.2e}, "
            f"LSODA {true!r} give or take {own:.1e}; {state.model}; tolerance {tolerance}, {scene!r}, {law!r}"
        )
    return True


def main(scenes: int, compared: int, seed: int) -> int:
    """Print the tally; 1 where something is wrong."""
    rng, tally, start = np.random.default_rng(seed), Tally(), time.perf_counter()
    drawn = [draw(rng) for _ in range(scenes)]
    answered = []
    for number, one in enumerate(drawn):
        begun = time.perf_counter()
        if count(tally, number, one):
            answered.append(number)
        if (spent := time.perf_counter() - begun) > SLOW:
            print(
                f"{number}: {spent:.1f} s, compiling included: {one[0]}, {one[3]:g}",
                file=sys.stderr,
                flush=True,
            )
    print(f"{scenes} scenes, {time.perf_counter() - start:.0f} s, kernels per scene [ms]:", end=" ")
    print(*(f"{1e3 * part:.2f}" for part in np.nanquantile(tally.seconds, [0.1, 0.5, 0.9, 0.99, 1.0])))
    for line in sorted(tally.found.items()):
        print("  ", *line)
    done, begun = 0, time.perf_counter()
    for number in answered:
        if done >= compared:
            break
        done += compare(tally, number, drawn[number])
    uncovered = sum("UNCOVERED" in text for text in tally.wrong)
    print(f"{done} compared with LSODA, {uncovered} uncovered; {time.perf_counter() - begun:.0f} s")
    for line in sorted(tally.compared.items()):
        print("  ", *line)
    for text in tally.wrong:
        print("WRONG", text)
    return int(bool(tally.wrong) or done < min(compared, len(answered)))


if __name__ == "__main__":
    given = [int(argument) for argument in sys.argv[1:]]
    sys.exit(main(*given, *(400, 150, 1)[len(given) :]))
