"""The long-run mean of rate-and-state friction, from the plain keys of a study, by stiff steps of scipy.

Written for tests alone, from the formulas; it shares no code with the package. The state is position, slip, the
logarithm of the age and an integral: of the deflection, which the balance of momentum makes friction's, or under a
prescribed slip of friction. Next to rest friction is taken to be straight in slips slower than ``STRAIGHT`` of the
belt's: what creeps there creeps faster, by less than anyone sees, and nothing is too steep.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from outside_forcing import BELT1, BELT2, LOAD1, LOAD2, NORMAL, Forcing, forcing
from scipy.integrate import solve_ivp

STRAIGHT = 1e-9
TURN = 2.0 * math.pi
REPEATS = 2e-9
"""By how much the mean of a period is still to change, where a motion is taken to repeat."""


class Unsettled(ArithmeticError):
    """The motion does not repeat, or scipy gives up."""


class Creep:
    """The motion of a scene and a law from one period to the next."""

    def __init__(self, scene: dict[str, Any], law: dict[str, Any], accuracy: float = 1e-10) -> None:
        self.law, self.belt, self.accuracy = law, scene["belt_speed"], accuracy
        self.moved, across = "slip" in scene, scene.get("transverse") or {}
        self.driven = self.moved or any(
            name in scene for name in ("drive", "belt_vibration", "normal_load_variation")
        )
        self.forcing = forcing(scene) if self.driven else _nothing(scene)
        planar = bool(across) or "direction" in (scene.get("slip") or {})
        self.size, natural = 1 + planar, across.get("natural_frequency", 1.0)
        self.mean_load = scene.get("normal_load", 1.0)
        dashpots = 2.0 * scene.get("damping_ratio", 0.0), 2.0 * across.get("damping_ratio", 0.0) * natural
        self.dashpots, self.springs = (
            np.array(dashpots)[: self.size],
            np.array([1.0, natural**2])[: self.size],
        )
        start = scene.get("initial") or {"x": 0.0, "velocity": self.belt}
        x, slip = np.zeros(self.size), -self.signals(0, 0.0)[0][[BELT1, BELT2]][: self.size]
        if not self.driven:
            x[0], slip[0] = start["x"], start["velocity"] - self.belt
        age = [math.log(law["slip_length"] / abs(self.belt)), 0.0]
        self.state = np.array(age if self.moved else [*x, *slip, *age])

    def signals(self, span: int, tau: float) -> tuple[Any, Any]:
        """All signals and their rates."""
        given = self.forcing
        value, rate = given.pieces[span].T
        value, rate = value + rate * (tau - given.edges[span]), rate.copy()
        for signal, (speed, phase, size) in zip(given.which, given.sines, strict=True):
            value[signal] += size * math.sin(speed * tau + phase)
            rate[signal] += size * speed * math.cos(speed * tau + phase)
        return value, rate

    def friction(self, far: float, age: float) -> float:
        """Its coefficient at a speed of slip and a logarithm of the age."""
        law = self.law
        power = (law["mu"] + law["b"] * (math.log(law["reference_speed"] / law["slip_length"]) + age)) / law[
            "a"
        ]
        power += math.log(max(far, 1e-300) / law["reference_speed"])
        return law["a"] * (power if power > 40.0 else math.asinh(0.5 * math.exp(power)))

    def ageing(self, far: float, age: float) -> float:
        """The rate of the logarithm of the age."""
        renewed = far / self.law["slip_length"]
        if self.law["state_law"] == "ageing":
            return math.exp(-age) - renewed
        return -renewed * (math.log(renewed) + age) if renewed > 0.0 else 0.0

    def rates(self, tau: float, state: Any, span: int) -> Any:
        """Of the state."""
        d, (value, rate) = self.size, self.signals(span, tau)
        load, belt, pressed = value[[LOAD1, LOAD2]][:d], value[[BELT1, BELT2]][:d], value[NORMAL]
        if self.moved:
            far = math.sqrt(belt @ belt)
            rubs = pressed / self.mean_load * self.friction(far, state[0]) * -belt[0] / max(far, 1e-300)
            return np.array([self.ageing(far, state[0]), rubs])
        x, slip, age = state[:d], state[d : 2 * d], state[2 * d]
        far = math.sqrt(slip @ slip)
        rubs = pressed * self.friction(far, age) / math.hypot(far, STRAIGHT * abs(self.belt)) * slip
        pushed = load - self.dashpots * (slip + belt) - self.springs * x - rubs - rate[[BELT1, BELT2]][:d]
        return np.concatenate([slip + belt, pushed, [self.ageing(far, age), x[0] - load[0]]])

    def period(self) -> float:
        """Follow one; its mean friction."""
        edges, d, scale = self.forcing.edges, self.size, abs(self.belt) * self.forcing.edges[-1]
        sizes = [1.0, 1.0] if self.moved else [*[scale] * d, *[0.01 * abs(self.belt)] * d, 1.0, scale]
        self.state[-1] = 0.0
        for span in range(len(edges) - 1):
            found = solve_ivp(
                self.rates, edges[span : span + 2], self.state, "LSODA", args=(span,), rtol=self.accuracy,
                atol=self.accuracy * np.array(sizes),
            )  # fmt: skip
            if found.status < 0:
                raise Unsettled(found.message)
            self.state = found.y[:, -1].copy()
            if not self.moved:  # the belt's velocity may jump, the mass's does not
                end, after = edges[span + 1], (span + 1) % (len(edges) - 1)
                begun = self.signals(after, end if after else 0.0)[0]
                self.state[d : 2 * d] += (self.signals(span, end)[0] - begun)[[BELT1, BELT2]][:d]
        share = self.state[-1] / edges[-1]
        return -share if self.moved else share / self.mean_load

    def mean(self, periods: int) -> float:
        """Of the period that repeats, among so many at most. Raises Unsettled."""
        means: list[float] = []
        for _ in range(periods):
            before = self.state[:-1].copy()
            means.append(self.period())
            still = np.abs(self.state[:-1] - before).max() < 1e-5 * (1.0 + np.abs(before).max())
            if still and _left(means) < REPEATS:
                return means[-1]
        raise Unsettled(f"not repeated within {periods} periods")


def _left(means: list[float]) -> float:
    """As the last three, which differ by no more than that themselves, go on to shrink."""
    if len(means) < 3 or np.ptp(means[-3:]) > REPEATS:
        return math.inf
    before, last = np.abs(np.diff(means[-3:]))
    return last if last < 0.1 * REPEATS else last * last / (before - last) if last < before else math.inf


def _nothing(scene: dict[str, Any]) -> Forcing:
    """The belt alone."""
    pieces = np.zeros((1, 5, 2))
    pieces[0, BELT1, 0], pieces[0, NORMAL, 0] = scene["belt_speed"], scene["normal_load"]
    return Forcing(np.array([0.0, TURN]), pieces, np.zeros(0, np.int64), np.zeros((0, 3)), 1, 1.0)
