"""The periodic motion of any scene and law, given as the plain keys of a study: means, work, an error.

Written for tests alone; it shares no code with the package. Periods of ``outside_motion`` follow each other until the
state repeats; Newton's method, with a derivative by differences, shortens the way where it does come nearer.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from outside_forcing import BELT1, BELT2, LOAD1, LOAD2, NORMAL, Forcing, forcing
from outside_motion import (
    COULOMB,
    CUBIC,
    DAHL,
    ELASTO_PLASTIC,
    EXPONENTIAL,
    HESS_SOOM,
    HYPERBOLIC,
    IMPULSE1,
    IMPULSE2,
    INPUT,
    LUGRE,
    SIZE,
    STATES,
    STRIBECK,
    W1,
    X1,
    Z1,
    Body,
    Friction,
    Signals,
    period,
    signals_at,
)

KINDS = {
    "coulomb": COULOMB,
    "stribeck": STRIBECK,
    "dahl": DAHL,
    "lugre": LUGRE,
    "elasto-plastic": ELASTO_PLASTIC,
    "dupont": ELASTO_PLASTIC,
}
CURVES = {"exponential": EXPONENTIAL, "hyperbolic": HYPERBOLIC, "hess-soom": HESS_SOOM, "cubic": CUBIC}


class Outside(NamedTuple):
    """Time means of friction over the mean normal load, work per period of the response, how well it repeats."""

    mean: float
    mean_transverse: float
    error: float
    energy_input: float
    energy_viscous: float
    energy_friction: float
    energy_contact: float
    stick_fraction: float
    reversals: int
    force_reversals: int
    drive_periods: int
    closing: float
    steps: int


MOST_STEPS = 500
"""For each period that is allowed until the motion repeats."""
ROUNDING = 2e-14
"""Of a mean, over some hundred steps."""


class Unsettled(Exception):
    """The motion does not repeat after as many periods as were allowed, or takes too many steps."""


def body(scene: dict[str, Any]) -> Body:
    """The mass, or a contact that is moved without one."""
    across = scene.get("transverse") or {}
    free = "slip" not in scene and "transverse_slip" not in scene
    prescribed_across = "transverse_slip" in scene or bool((scene.get("slip") or {}).get("direction"))
    natural = across.get("natural_frequency", 1.0)
    damping, bends = 2.0 * scene.get("damping_ratio", 0.0), scene.get("body", {})
    return Body(
        free,
        bool(across) or prescribed_across,
        damping,
        1.0,
        2.0 * across.get("damping_ratio", 0.0) * natural,
        float(natural**2),
        max(1.0, float(natural) if across else 0.0, damping),
        # numbers of one type, for one compiled period
        *(float(bends.get(name, 0.0)) for name in ("cubic_stiffness", "amplitude_damping", "curvature")),
    )


def friction(law: dict[str, Any], scene: dict[str, Any]) -> Friction:
    """Of a law by its keys, under the mean normal load of a scene."""
    kind, load = KINDS[law["kind"]], scene.get("normal_load", 1.0)
    mu = float(law.get("mu", law.get("mu_kinetic")))
    stiffness = law.get("stiffness", law.get("contact_stiffness", 0.0) / load)
    if "presliding_length" in law:
        stiffness = mu / law["presliding_length"]
    curve = law.get("curve", "exponential")
    return Friction(
        kind,
        mu,
        float(law.get("mu_static", mu)),
        float(law.get("stribeck_speed", 1.0)),
        float(law.get("exponent", 1.0) if kind == DAHL else law.get("stribeck_exponent", 2.0)),
        float(law.get("viscosity", 0.0)),
        float(stiffness),
        float(law.get("damping", law.get("contact_damping", 0.0) / load)),
        float(law.get("breakaway_ratio", 0.7)),
        CURVES[curve],
        (scene.get("normal_load_variation") or {}).get("contact", "per_load") == "constant",
        float(load),
    )


def steady(
    scene: dict[str, Any],
    law: dict[str, Any],
    start: tuple[float, ...] = (),
    tolerance: float = 1e-13,
    periods: int = 4000,
) -> Outside:
    """The mean friction once the motion repeats, from a start (x1, x1', x2, x2') or on the belt. Raises Unsettled.

    Its error: the change from a hundred times the tolerance, and what may be still to come.
    """
    problem = _Problem(scene, law, tolerance, MOST_STEPS * periods)
    fine, closing, last = problem.settled(problem.state_of(start), periods)
    coarse, _, _ = _Problem(scene, law, 100.0 * tolerance, MOST_STEPS * periods).settled(last, periods)
    return fine._replace(error=abs(fine.mean - coarse.mean) + closing + ROUNDING, closing=closing)


def period_map(scene: dict[str, Any], law: dict[str, Any], start: tuple[float, ...]) -> tuple[float, float]:
    """Position and velocity along a belt that does not vibrate, a period after this start."""
    problem = _Problem(scene, law, 1e-13)
    end = problem.map(problem.state_of(start))[0]
    return float(end[X1]), float(end[W1] + scene["belt_speed"])


class _Problem:
    """A scene and a law in numbers, and its period map."""

    def __init__(
        self, scene: dict[str, Any], law: dict[str, Any], tolerance: float, most_steps: float = math.inf
    ) -> None:
        self.force: Forcing = forcing(scene)
        self.body, self.law, self.tolerance = body(scene), friction(law, scene), tolerance
        self.lasts = float(self.force.edges[-1])
        self.load = scene.get("normal_load", 1.0)
        self.scale = self._scale()
        quickest = max(self.body.quickest, self.force.fastest)
        self.longest = min(2.0 * math.pi / quickest / 40.0, self.lasts / 20.0)
        self.side, self.signs, self.steps, self.most_steps = 1, np.zeros(2), 0.0, most_steps

    def _scale(self) -> np.ndarray:
        """A size of each number of the state and of the integrals, rather too small than too large."""
        swing = np.zeros(5)
        for signal in range(5):
            pieces = self.force.pieces[:, signal]
            ends = pieces[:, 0] + pieces[:, 1] * np.diff(self.force.edges)
            sines = np.abs(self.force.sines[self.force.which == signal, 2]).sum()
            swing[signal] = max(np.abs(pieces[:, 0]).max(), np.abs(ends).max()) + sines
        rub = self.law.mu * self.load
        omega = max(self.force.fastest, 1.0)
        push = max(swing[LOAD1], swing[LOAD2], rub)
        belt = max(swing[BELT1], swing[BELT2])
        size = np.ones(SIZE)
        size[X1::2][:2] = 1e-2 * (push / omega**2 + belt / omega) + 1e-300
        size[W1::2][:2] = 1e-2 * (push / omega) + belt + 1e-300
        size[Z1 : Z1 + 2] = self.law.mu / self.law.stiffness if self.law.kind >= DAHL else 1.0
        size[IMPULSE1 : IMPULSE2 + 1] = rub * min(self.lasts, 1.0)
        size[INPUT:] = 1.0
        return size * (1.0 + 0.0 * swing[NORMAL])

    def map(self, state: np.ndarray, turns: int = 1) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The state after so many periods, with the integrals and the tally of them."""
        total, tallies = np.zeros(SIZE), np.zeros(4)
        for _ in range(turns):
            f = self.force
            end, self.side, tally = period(
                self.body,
                self.law,
                f.edges,
                f.pieces,
                f.which,
                f.sines,
                state,
                self.side,
                self.tolerance,
                self.scale,
                self.longest,
                self.signs,
            )
            self.steps += tally[3]
            if not np.isfinite(end).all() or self.steps > self.most_steps:
                raise Unsettled("too many steps")
            state, total, tallies = end[:STATES].copy(), total + end, tallies + tally
        return state, total, tallies

    def distance(self, one: np.ndarray, other: np.ndarray) -> float:
        return float((np.abs(one - other) / self.scale[:STATES]).max())

    def state_of(self, start: tuple[float, ...]) -> np.ndarray:
        """The state just before tau = 0; at rest on the belt where no start is given, or slip is but rounding."""
        state = np.zeros(STATES)
        state[: len(start)] = start
        if start:
            last, f = len(self.force.pieces) - 1, self.force
            now = Signals(f.edges[last], f.pieces[last], f.which, f.sines)
            velocity = signals_at(now, f.edges[last + 1])[0]
            for k, signal in ((W1, BELT1), (W1 + 2, BELT2)):
                state[k] = 0.0 if len(start) <= k else state[k] - velocity[signal]
                state[k] *= abs(state[k]) > 1e-12 * self.scale[W1]
        return state

    def settled(self, state: np.ndarray, periods: int) -> tuple[Outside, float, np.ndarray]:
        """Means of the motion that repeats, what may be to come of them, its state."""
        taken, turns, left, before = 0, 1, math.inf, math.inf
        while left > 1e-14:
            trail = [state]
            for _ in range(12):
                trail.append(self.map(trail[-1])[0])
            state = trail[-1]
            off = [self.distance(state, trail[-1 - k]) for k in range(1, 7)]
            turns = next((k for k in range(2, 7) if off[k - 1] < 1e-3 * off[0]), 1) if off[0] > 1e-9 else 1
            state, used, left = self._newton(state, turns)
            taken += 12 + used
            if left < 1e3 * self.tolerance and left > 0.5 * before:
                break  # as near as steps and rounding let it come
            before = left
            if taken > periods:
                raise Unsettled(f"{taken} periods: still {left:.1e} from repeating")
        end, total, tally = self.map(self.map(state, turns)[0], turns)
        mean = -total / (turns * self.lasts * self.load)
        later = -self.map(end, turns)[1] / (turns * self.lasts * self.load)
        change = abs(float(later[IMPULSE1] - mean[IMPULSE1]))
        found = Outside(
            float(mean[IMPULSE1]),
            float(mean[IMPULSE2]),
            0.0,
            *(float(value) for value in total[INPUT:]),
            float(tally[0] / (turns * self.lasts)),
            int(tally[1]),
            int(tally[2]),
            turns * self.force.drive_periods,
            0.0,
            int(tally[3]),
        )
        return found, change * 30.0, end

    def _newton(self, state: np.ndarray, turns: int) -> tuple[np.ndarray, int, float]:
        """Newton's method as long as it comes nearer by ten times; the periods it took, and what is left."""
        used = turns
        end = self.map(state, turns)[0]
        left = self.distance(state, end)
        while left > 1e-14:
            matrix, active = np.zeros((STATES, STATES)), self._active()
            for k in active:
                nudge = max(1e-7 * self.scale[k], min(1e-3 * self.scale[k], 10.0 * left * self.scale[k]))
                moved = state.copy()
                moved[k] += nudge
                matrix[:, k] = (self.map(moved, turns)[0] - end) / nudge
            used += turns * (len(active) + 2)
            try:
                trial = state + np.linalg.solve(np.eye(STATES) - matrix, end - state)
            except np.linalg.LinAlgError:
                break
            trial[np.abs(trial) < 1e-15 * self.scale[:STATES]] = 0.0
            trial_end = self.map(trial, turns)[0]
            trial_left = self.distance(trial, trial_end)
            if not trial_left < 0.1 * left:
                break
            state, end, left = trial, trial_end, trial_left
        return end, used, left

    def _active(self) -> list[int]:
        free = [X1, W1, 2, 3] if self.body.planar else [X1, W1]
        deflections = [Z1, Z1 + 1] if self.body.planar else [Z1]
        return (free if self.body.free else []) + (deflections if self.law.kind >= DAHL else [])
