"""Settings that many would take, seen to fail, and what the methods here do on the same scenes.

Every case is a scene whose answer the failing setting gets wrong without a word.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import pytest
from scipy.integrate import solve_ivp

import frictionlab as fl
from frictionlab.methods.march.method import March
from frictionlab.methods.march.run import MarchRun
from frictionlab.methods.march.steppers import Resolution

# Strong friction at resonance: x'' + 0.2 x' + x + 4 Sgn(x' - v_b) = 10 sin(tau); slip reverses below v_b = 50.
DAMPING, LOAD, FRICTION, MU = 0.1, 10.0, 4.0, 0.4
PERIOD = 2.0 * math.pi
RESONANCE = fl.Scene(
    damping_ratio=DAMPING,
    normal_load=FRICTION / MU,
    belt_speed=1,
    drive=fl.Drive(amplitude=LOAD, frequency=1),
)
GRAZING = 0.5 + 52 * 59.5 / 63  # 49.6: slip comes to rest for a moment once a period and turns back
SPEEDS = (0.5, 10.0, 29.0, 43.0, 47.7, GRAZING, 51.5)


@cache
def ours(method: str) -> pd.DataFrame:
    """The curve by a method at its default settings."""
    return fl.curve(RESONANCE, fl.Coulomb(mu=MU), SPEEDS, method=method)


def assert_right(table: pd.DataFrame) -> None:
    """Two unrelated methods agree within the errors they state, and those are what is asked for by default."""
    exact, shooting = ours("exact"), ours("shooting")
    apart = (exact["mean_friction"] - shooting["mean_friction"]).abs()

    assert set(table["status"]) == {"ok"}
    assert (table["error"] <= 1e-8).all()
    assert (apart <= exact["error"] + shooting["error"]).all()


# An event-driven integrator as one writes it with a library: adaptive steps, and a sign looked at after each


class Settings(NamedTuple):
    """What the library is told."""

    method: str
    rtol: float
    longest_step: float = math.inf


SETTLED = 30  # periods from the friction-free orbit


def by_events(speed: float, settings: Settings) -> float:
    """The mean friction over the last of many periods."""
    state, side, before = np.array([-LOAD / (2.0 * DAMPING), 0.0, 0.0]), -math.copysign(1.0, speed), 0.0
    for period in range(SETTLED):
        before = state[2]
        time, end = period * PERIOD, (period + 1) * PERIOD
        while time < end:
            leg = _leg(speed, side, (time, end), state, settings)
            assert leg.success
            time, state = leg.t[-1], leg.y[:, -1]
            if leg.status == 1:  # an event
                side = _next_side(speed, side, time, state)
    return float(before - state[2]) / PERIOD * MU


def _leg(speed: float, side: float, span: tuple[float, float], state: Any, settings: Settings) -> Any:
    """Until slip comes to rest or stick breaks. side: of the slip velocity, 0 in stick."""

    def slip(time: float, state: Any) -> list[float]:
        return [state[1], _pull(time, state[0], state[1]) - side * FRICTION, side]

    def stick(time: float, state: Any) -> list[float]:
        return [speed, 0.0, _pull(time, state[0], speed) / FRICTION]

    def rests(_: float, state: Any) -> float:
        return float(side * (state[1] - speed))

    def breaks(time: float, state: Any) -> float:
        return FRICTION - abs(_pull(time, state[0], speed))

    event: Any = rests if side else breaks
    event.terminal, event.direction = True, -1
    return solve_ivp(
        slip if side else stick,
        span,
        state,
        method=settings.method,
        rtol=settings.rtol,
        atol=settings.rtol,
        max_step=settings.longest_step,
        events=event,
    )


def _pull(time: float, x: float, v: float) -> float:
    return LOAD * math.sin(time) - 2.0 * DAMPING * v - x


def _next_side(speed: float, side: float, time: float, state: Any) -> float:
    pull = _pull(time, state[0], speed)
    if side and abs(pull) <= FRICTION:
        return 0.0
    return math.copysign(1.0, pull)


def _errors(found: Sequence[float]) -> Any:
    return np.abs(np.array(found) - ours("exact")["mean_friction"].to_numpy())


def test_eighth_order_steps_that_look_for_events_at_their_nodes_alone_miss_a_grazing_stick() -> None:
    loose = Settings("DOP853", 1e-6)
    errors = _errors([by_events(speed, loose) for speed in SPEEDS])

    worst = SPEEDS.index(GRAZING)
    assert np.median(errors) < 1e-6
    assert errors.argmax() == worst
    assert 2e-3 < errors[worst] < 4e-3
    # short steps look in between, at the same tolerance
    looking = by_events(GRAZING, Settings("DOP853", 1e-6, longest_step=PERIOD / 60))
    assert looking == pytest.approx(ours("exact")["mean_friction"][worst], rel=0.0, abs=1e-7)


@pytest.mark.parametrize("method", ["auto", "exact", "shooting"])
def test_the_methods_here_see_the_grazing_stick_at_their_default_settings(method: str) -> None:
    assert_right(ours(method))
    assert (
        ours(method)["reversals"][SPEEDS.index(GRAZING)] == ours("exact")["reversals"][SPEEDS.index(GRAZING)]
    )


# Default settings of ODE solvers: rtol 1e-3, no events, sign() for friction


def by_default(speed: float) -> tuple[bool, float]:
    """Whether the solver calls its run a success, and the mean friction over the last period of it."""

    def motion(time: float, state: Any) -> list[float]:
        side = np.sign(state[1] - speed)
        return [state[1], _pull(time, state[0], state[1]) - side * FRICTION, side]

    ends = [(SETTLED - 1) * PERIOD, SETTLED * PERIOD]
    run = solve_ivp(motion, (0.0, ends[1]), [-LOAD / (2.0 * DAMPING), 0.0, 0.0], t_eval=ends)
    return bool(run.success), float(run.y[2, 0] - run.y[2, 1]) / PERIOD * MU


def test_the_default_settings_of_a_solver_of_differential_equations_are_off_by_percents_and_call_it_success() -> (
    None
):
    success, found = zip(*(by_default(speed) for speed in SPEEDS), strict=True)
    errors = _errors(found)

    assert all(success)
    assert 1e-2 < errors.max() < 1e-1
    assert np.median(errors) > 3e-3


# Time stepping as everybody does it: what it gets wrong, its error column says

HELD = fl.Scene(
    damping_ratio=DAMPING,
    normal_load=FRICTION / MU,
    belt_speed=1,
    drive=fl.Drive(amplitude=2.5, frequency=0.5),
)
"""The load is below friction: the mass sticks most of the time."""


def marched(scene: fl.Scene, speeds: Sequence[float], tolerance: float = 1e-6, **keys: Any) -> pd.DataFrame:
    """A curve by time stepping, with how far off it is in ``off``."""
    law, speeds = fl.Coulomb(mu=MU), list(speeds)
    table = fl.curve(scene, law, speeds, method=March(**keys), tolerance=tolerance)
    exact = fl.curve(scene, law, speeds, method="exact")
    return table.assign(off=(table["mean_friction"] - exact["mean_friction"]).abs())


@pytest.mark.parametrize(
    ("scene", "width", "bias"),
    [
        (RESONANCE, 1.0, 6e-3), (RESONANCE, 0.1, 9e-4), (RESONANCE, 0.01, 1.3e-4),
        (HELD, 1.0, 0.15), (HELD, 0.1, 0.038), (HELD, 0.01, 5e-3),
    ],
)  # fmt: skip
def test_smoothed_friction_keeps_its_bias_however_fine_the_steps_and_its_error_says_so(
    scene: fl.Scene, width: float, bias: float
) -> None:
    speeds = (0.5, 20.0, 49.5, 51.5) if scene is RESONANCE else (0.05, 0.38, 1.0, 2.4)
    table = marched(scene, speeds, stepper="smoothed", width=width)

    assert 0.6 * bias <= table["off"].max() <= 1.4 * bias
    assert (table["off"] <= table["error"] + 1e-8).all()
    assert "above the tolerance" in table["reason"][table["off"].idxmax()]


@pytest.mark.parametrize(("stepper", "least"), [("rk4", 0.15), ("moreau", 0.4)])
def test_a_hundred_steps_per_period_are_far_off_on_a_slow_belt_and_the_error_says_so(
    stepper: str, least: float
) -> None:
    table = marched(RESONANCE, [0.5], stepper=stepper, steps=100)

    assert table["off"][0] >= least * 5.1e-3  # of a mean of 5.1e-3
    assert table["error"][0] >= table["off"][0]
    assert table["status"][0] == "ok"
    assert "above the tolerance" in table["reason"][0]


@pytest.mark.parametrize(
    ("damping", "load", "speed", "low", "high"), [(0.1, 10.0, 20.0, 14, 60), (0.001, 5.0, 1.0, 35, 200)]
)
def test_a_motion_takes_many_periods_from_rest_until_it_repeats(
    damping: float, load: float, speed: float, low: int, high: int
) -> None:
    drive = fl.Drive(amplitude=load, frequency=1.0)
    slow = RESONANCE.model_copy(
        update={"damping_ratio": damping, "drive": drive, "initial": fl.Initial(), "belt_speed": speed}
    )
    hasty = marched(slow, [speed], stepper="moreau", steps=400, periods=8)
    patient = marched(slow, [speed], stepper="moreau", steps=400)
    walker = MarchRun(slow, fl.Coulomb(mu=MU), "moreau")

    assert hasty["status"][0] == "failed"
    assert "still changes by" in hasty["reason"][0]
    assert patient["off"][0] <= patient["error"][0]
    laps = [walker.run(Resolution(steps=400, enough=enough, most=1000)).laps for enough in (1e-6, 1e-12)]
    assert low <= laps[0] < laps[1] <= high
