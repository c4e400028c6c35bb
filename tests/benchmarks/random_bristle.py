"""Bristle laws on random scenes, counted: python tests/benchmarks/random_bristle.py [SCENES] [COMPARED] [SEED].

SCENES (default 2,000) scenes go through ``curve`` and ``auto`` at one of the tolerances 1e-4, 1e-6 and 1e-8:
damping 0.02 ... 0.5, frequency 0.3 ... 5, friction over load 0.01 ... 2, belt speed 0.01 ... 1.5 V_lin and presliding
length over the friction-free amplitude 1e-6 ... 1e2, all log-uniform; half of them in the plane. COMPARED (default
200) answers are compared with scipy's LSODA at rtol 1e-11 on the interpreted law, followed from the answer's own
position and velocity, bristles at rest, until the mean of one period of the response repeats; a scene that takes more
than CALLS calls of the equations of motion is passed over, and counted. Jenkins friction, whose rate jumps, is
followed from jump to jump by solve_ivp with no more than JUMPING calls. Exit code 1 where an answer is missing, is no
number, has an error above the tolerance or one that does not cover the difference.
"""

from __future__ import annotations

import math
import sys
import time
from typing import Any

import numpy as np
from tally import Tally, TooSlow, log_uniform

import frictionlab as fl
from frictionlab.bench.peers import scipy_bristle
from frictionlab.bench.peers.bristle_motion import BristleMotion
from frictionlab.bench.peers.scipy_bristle import absolute_scales
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.jenkins import Jenkins
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.memory import BristleLaw
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Drive, Load, Scene, Transverse
from frictionlab.theory import friction_free_velocity

KINDS = "dahl", "dahl exponent", "lugre", "lugre stribeck", "elasto-plastic", "jenkins"
TOLERANCES = 1e-4, 1e-6, 1e-8
CALLS, JUMPING = 1_500_000, 300_000
SLOW = 3.0
"""Seconds for one scene that are worth a line."""
SETTLED = 3e-10
"""Of the mean, still to come, where a motion is taken to have settled."""


def draw(rng: np.random.Generator) -> tuple[str, Scene, BristleLaw, float]:
    """Its kind, a scene, a law and a tolerance."""
    load, frequency, planar = log_uniform(rng, 0.1, 100), log_uniform(rng, 0.3, 5), bool(rng.random() < 0.5)
    mu, ratio = log_uniform(rng, 0.1, 1.0), log_uniform(rng, 0.01, 2)
    scene = Scene(
        damping_ratio=log_uniform(rng, 0.02, 0.5),
        normal_load=ratio * load / mu,
        belt_speed=0.0,
        drive=Drive(amplitude=load, frequency=frequency, phase=float(rng.uniform(0, 360))),
        transverse=_across(rng, load) if planar else None,
    )
    v_lin = friction_free_velocity(scene)
    kind = str(rng.choice([kind for kind in KINDS if not planar or kind != "dahl exponent"]))
    law = _law(rng, kind, mu, v_lin, log_uniform(rng, 1e-6, 1e2) * v_lin / frequency, planar)
    speed = log_uniform(rng, 0.01, 1.5) * v_lin
    name = f"{kind}, {'plane' if planar else 'line'}"
    return name, scene.model_copy(update={"belt_speed": speed}), law, float(rng.choice(TOLERANCES))


def _across(rng: np.random.Generator, load: float) -> Transverse:
    phase = 0.0 if rng.random() < 0.5 else float(rng.uniform(0, 360))
    return Transverse(
        natural_frequency=log_uniform(rng, 0.3, 5),
        damping_ratio=log_uniform(rng, 0.02, 0.5),
        load=Load(amplitude=load * log_uniform(rng, 0.1, 10), phase=phase),
    )


def _law(
    rng: np.random.Generator, kind: str, mu: float, v_lin: float, presliding: float, planar: bool
) -> BristleLaw:
    common: dict[str, Any] = {"presliding_length": presliding}
    if planar and rng.random() < 0.2:
        common["planar"] = str(rng.choice(["rotated", "per-axis"]))
    if kind == "dahl":
        return Dahl(mu=mu, **common)
    if kind == "dahl exponent":
        return Dahl(mu=mu, exponent=float(rng.uniform(0.5, 2.0)), **common)
    if kind == "jenkins":
        return Jenkins(mu=mu, **common)
    if rng.random() < 0.7:  # damping up to that of the load of friction at the speed of the mass
        common["damping"] = log_uniform(rng, 1e-4, 1.0) * mu / v_lin
    if kind == "lugre":
        return LuGre(mu_kinetic=mu, **common)
    if kind == "lugre stribeck":
        curve = {
            "mu_static": mu * float(rng.uniform(1, 2)),
            "stribeck_speed": log_uniform(rng, 0.01, 1) * v_lin,
        }
        viscosity = log_uniform(rng, 1e-3, 0.3) * mu / v_lin if rng.random() < 0.5 else 0.0
        return LuGre(mu_kinetic=mu, viscosity=viscosity, **curve, **common)
    return ElastoPlastic(mu_kinetic=mu, breakaway_ratio=float(rng.uniform(0.1, 0.95)), **common)


def count(tally: Tally, number: int, drawn: tuple[str, Scene, BristleLaw, float]) -> bool:
    """Solve one scene; whether it has an answer to compare."""
    kind, scene, law, tolerance = drawn
    table = fl.curve(scene, law, [scene.belt_speed], tolerance=tolerance)
    if len(table) != 1:
        tally.wrong.append(f"{number}: {len(table)} rows")
        return False
    row = table.iloc[0]
    status, mean, error = str(row["status"]), float(row["mean_friction"]), float(row["error"])
    tally.found[f"{kind}: {status}"] += 1
    tally.seconds.append(float(row["seconds"]))
    trouble = ""
    if status == "ok" and not (math.isfinite(mean) and 0.0 <= error <= tolerance):
        trouble = f"mean {mean}, error {error}"
    elif status not in ("ok", "not_unique", "refused"):
        trouble = str(row["reason"])
    elif status == "refused" and not row["reason"]:
        trouble = "refused without a reason"
    elif status == "not_unique" and not float(row["mean_low"]) <= float(row["mean_high"]):
        trouble = "not unique between no numbers"
    if trouble:
        tally.wrong.append(f"{number}: {status}, {trouble}; tolerance {tolerance}, {scene!r}, {law!r}")
    return status == "ok"


def compare(tally: Tally, number: int, drawn: tuple[str, Scene, BristleLaw, float]) -> bool:
    """Compare one answer with LSODA; whether that came to an end."""
    kind, scene, law, tolerance = drawn
    state = fl.steady_state(scene, law, tolerance=tolerance)
    try:
        true, left = followed(scene, law, state)
    except TooSlow as why:
        tally.compared[f"passed over: {why}"] += 1
        return False
    tally.compared[kind] += 1
    own = 0.0
    if abs(state.mean_friction - true) > state.error + left:  # LSODA's own error may be what is seen
        try:
            finer, left = followed(scene, law, state, 1e-13)
        except TooSlow as why:
            tally.compared[f"not told from LSODA's own error: {why}"] += 1
            return True
        true, own = finer, abs(finer - true)
    off = abs(state.mean_friction - true)
    if not off <= state.error + left + own:
        tally.wrong.append(
            f"{number}: UNCOVERED by {off - state.error:.2e}: mean {state.mean_friction!r}, error {state.error:.2e}, "
            f"LSODA {true!r} give or take {left + own:.1e}; {state.model}; tolerance {tolerance}, {scene!r}, {law!r}"
        )
    return True


class _Jumping(BristleMotion):
    """Jenkins friction, on one side of its jump whatever rounding says."""

    def __init__(self, scene: Scene, law: BristleLaw, most_calls: int) -> None:
        super().__init__(scene, law, most_calls)
        self.sliding, rate = False, self.law.rate
        self.law.rate = lambda v, z: rate(
            v, z * (1.001 if self.sliding else 0.999)
        )  # no factor changes the rate

    def deflection(self) -> slice:
        return slice(4, 6) if self.planar else slice(2, 3)

    def stretched(self, t: float, y: Floats) -> float:
        """The spring against its reach."""
        return float(np.linalg.norm(y[self.deflection()]) / self.law.reach - 1.0)

    def stretching(self, t: float, y: Floats) -> float:
        """How fast the slip stretches it."""
        along = (y[1] - self.belt_speed) * y[self.deflection()][0]
        return float(along + y[3] * y[5] if self.planar else along)


def one_period(motion: BristleMotion, place: Floats, rtol: float, sizes: Floats) -> Floats:
    """The state at the end. Raises ArithmeticError where scipy gives up."""
    if not isinstance(motion, _Jumping):
        return scipy_bristle.one_period(motion, place, "LSODA", rtol, sizes)
    from scipy.integrate import solve_ivp

    def full(t: float, y: Floats) -> float:
        return motion.stretched(t, y)

    def back(t: float, y: Floats) -> float:
        return motion.stretching(t, y)

    for event, direction in ((full, 1.0), (back, -1.0)):
        event.terminal, event.direction = True, direction  # type: ignore[attr-defined]  # how solve_ivp is told
    t, solver = 0.0, "LSODA" if motion.planar else "DOP853"
    while t < motion.period:
        settings = {"method": solver, "rtol": rtol, "atol": sizes}
        event = back if motion.sliding else full
        found = solve_ivp(motion, (t, motion.period), place, events=event, **settings)
        if found.status < 0:
            raise ArithmeticError(f"solve_ivp: {found.message}")
        t, place = float(found.t[-1]), found.y[:, -1]
        if found.status == 1:
            motion.sliding = not motion.sliding
            part = motion.deflection()
            place[part] *= motion.law.reach / np.linalg.norm(place[part])
    return place


def followed(
    scene: Scene, law: BristleLaw, state: fl.SteadyState, rtol: float = 1e-11
) -> tuple[float, float]:
    """The mean over a period of the response by LSODA, and what may still be to come. Raises TooSlow."""
    jumps = isinstance(law, Jenkins)
    motion = _Jumping(scene, law, JUMPING) if jumps else BristleMotion(scene, law, CALLS)
    multiplier, turns = state.floquet, round(state.period) if state.period > 0.0 else 1
    if multiplier > 0.995:
        raise TooSlow("a multiplier above 0.995")
    place, sizes = _start(motion, state), absolute_scales(motion, law, scene) * rtol
    means: list[float] = []
    try:
        while True:
            total = 0.0
            for _ in range(turns):
                end = one_period(motion, place, rtol, sizes)
                place, total = np.append(end[:-1], 0.0), total - float(end[-1])
            means.append(total / (turns * motion.period))
            left = _left(means, multiplier)
            if left < SETTLED:
                return means[-1], left
    except (ArithmeticError, ValueError) as problem:  # of brentq, where an event is at its end
        raise TooSlow(str(problem)) from None


def _start(motion: BristleMotion, state: fl.SteadyState) -> Floats:
    first = state.orbit(1)
    x1, v1, x2, v2 = (float(part[0]) for part in (first.x1, first.v1, first.x2, first.v2))
    return np.array([x1, v1, x2, v2, 0.0, 0.0, 0.0] if motion.planar else [x1, v1, 0.0, 0.0])


def _left(means: list[float], multiplier: float) -> float:
    """What is still to come of changes that shrink by the multiplier or as they did, whichever is slower."""
    if len(means) < 4:
        return math.inf
    changes = np.abs(np.diff(means[-4:]))
    seen = math.sqrt(changes[-1] / changes[-3]) if changes[-3] > 0.0 else 0.0
    ratio = min(max(seen, multiplier if math.isfinite(multiplier) else 0.9, 0.1), 0.999)
    return float(changes.max() if changes[-1] < 1e-13 else changes[-1] * ratio / (1.0 - ratio))


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
                f"{number}: {spent:.1f} s, compilation included: {one[0]}, {one[3]:g}",
                file=sys.stderr,
                flush=True,
            )
    print(f"{scenes} scenes, {time.perf_counter() - start:.0f} s, kernels per scene [us]:", end=" ")
    print(*(f"{1e6 * part:.0f}" for part in np.nanquantile(tally.seconds, [0.1, 0.5, 0.9, 0.99])))
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
    sys.exit(main(*given, *(2_000, 200, 1)[len(given) :]))
