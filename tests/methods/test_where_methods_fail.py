"""Settings that many would take, seen to fail, and what the methods here do on the same scenes.

Every case is a scene whose answer the failing setting gets wrong without a word.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
import pandas as pd
import pytest
from profiles import some

import frictionlab as fl
from frictionlab.bench.peers.base import Peer
from frictionlab.bench.peers.equations import ScipySteps
from frictionlab.bench.peers.scipy_events import ScipyEvents
from frictionlab.methods.march.method import March
from frictionlab.methods.march.run import MarchRun
from frictionlab.methods.march.steppers import Resolution

# Strong friction at resonance: x'' + 0.2 x' + x + 4 Sgn(x' - v_b) = 10 sin(tau); slip reverses below v_b = 50.
DAMPING, FRICTION, MU = 0.1, 4.0, 0.4
RESONANCE = fl.Scene(
    damping_ratio=DAMPING,
    normal_load=FRICTION / MU,
    belt_speed=1,
    drive=fl.Drive(amplitude=10, frequency=1),
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


# Integrators of a library, as one sets them up around it: see frictionlab/bench/peers


def off(peer: Peer, tolerance: float) -> Any:
    """By how much the means of another library are wrong, which it does not say."""
    scenes = [RESONANCE.at(speed) for speed in SPEEDS]
    found = peer.solve(scenes, fl.Coulomb(mu=MU), tolerance)
    return np.abs(found - ours("exact")["mean_friction"].to_numpy())


def test_eighth_order_steps_that_look_for_events_at_their_nodes_alone_miss_a_grazing_stick() -> None:
    errors = off(ScipyEvents(), 1e-6)

    assert np.median(errors) < 1e-6
    assert 2e-3 < errors[SPEEDS.index(GRAZING)] < 4e-3
    assert off(ScipyEvents(), 1e-9).max() < 1e-7  # short steps look in between


@pytest.mark.parametrize("method", ["auto", "exact", "shooting"])
def test_the_methods_here_see_the_grazing_stick_at_their_default_settings(method: str) -> None:
    assert_right(ours(method))
    assert (
        ours(method)["reversals"][SPEEDS.index(GRAZING)] == ours("exact")["reversals"][SPEEDS.index(GRAZING)]
    )


def test_default_settings_of_a_solver_of_differential_equations_are_off_by_percents() -> None:
    errors = off(ScipySteps(solver="RK45"), 1e-3)

    assert 5e-3 < errors.max() < 1e-1
    assert np.median(errors) > 2e-3


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


@some(2, "seconds of steps")
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
