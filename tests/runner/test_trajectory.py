"""Motions from a start: they begin there, never jump, and end on the steady orbit."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fig_4b import LAW, SCENE
from scipy.integrate import solve_ivp

import frictionlab as fl
from frictionlab.laws.base import FrictionLaw

PLANAR = SCENE.with_(transverse={"natural_frequency": 2, "damping_ratio": 0.2, "load": {"unbalance": 3}})
START = fl.Initial(x=3.0, velocity=-2.0)


@pytest.mark.parametrize(
    ("scene", "law"),
    [(SCENE, LAW), (SCENE, fl.Dahl(mu=0.4, stiffness=4.0)), (PLANAR, LAW)],
)
def test_it_begins_at_the_start_and_ends_on_the_steady_orbit(scene: fl.Scene, law: FrictionLaw) -> None:
    motion = fl.trajectory(scene, law, periods=40, samples=60, initial=START)
    assert len(motion) == 40 * 60 + 1
    assert (motion.x1[0], motion.v1[0]) == pytest.approx((3.0, -2.0), abs=1e-12)
    np.testing.assert_allclose(np.diff(motion.tau), 2.0 * math.pi / 60, rtol=1e-9)
    steady = fl.steady_state(scene, law).orbit(60)
    for name in ("x1", "v1", "x2", "friction", "slip"):
        np.testing.assert_allclose(motion[name].to_numpy()[-61:-1], steady[name], atol=1e-6)


def test_the_mass_obeys_the_equation_of_motion_across_the_ends_of_periods() -> None:
    n = 4000
    motion = fl.trajectory(SCENE, LAW, periods=3, samples=n, initial=START)
    step = 2.0 * math.pi / n
    inertia = np.gradient(motion.v1.to_numpy(), step)
    force = motion.load - 0.2 * motion.v1 - motion.x1 - motion.normal_load * motion.friction
    slip = motion.slip.to_numpy()
    sign = np.where(np.abs(slip) < 1e-9, 0.0, np.sign(slip))  # at rest on the belt slip is rounding
    off = np.abs(inertia - force.to_numpy())[1:-1]
    smooth = (sign[:-2] == sign[1:-1]) & (sign[1:-1] == sign[2:])  # a difference across a reversal is none
    assert off[smooth].max() < 1e-4
    assert smooth.mean() > 0.99
    np.testing.assert_allclose(motion.slip, motion.v1 - 5.0, atol=1e-12)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"method": "exact"}, "no motion in time is known of this scene and law by exact"),
        (
            {"law": fl.Dahl(mu=0.4, stiffness=4, planar="per-axis"), "scene": PLANAR},
            "it needs a mass, a law",
        ),
        ({"periods": 0}, "periods must be a whole number of at least 1, got 0"),
        ({"samples": 2.5}, "samples must be a whole number of at least 1, got 2.5"),
    ],
)
def test_what_cannot_be_followed_is_told(given: dict[str, object], told: str) -> None:
    with pytest.raises(ValueError, match=told):
        fl.trajectory(**{"scene": SCENE, "law": LAW} | given)  # type: ignore[arg-type]


def let_go(x: float, damping_ratio: float = 0.0, normal_load: float = 1.0) -> fl.Scene:
    return fl.Scene(damping_ratio=damping_ratio, normal_load=normal_load, belt_speed=0, initial={"x": x})


@pytest.mark.parametrize("x", [10.5, -7.3, 0.9])
def test_a_block_let_go_swings_by_half_cycles_until_friction_holds_it(x: float) -> None:
    """Each half cycle takes pi and ends nearer to rest by twice the friction force over the stiffness."""
    motion = fl.trajectory(let_go(x), fl.Coulomb(mu=1), periods=8)
    ends = [x]
    while abs(ends[-1]) > 1.0:
        ends.append(-(ends[-1] - math.copysign(2.0, ends[-1])))
    half_cycles = len(ends) - 1

    events = ["reversal"] * (half_cycles - 1) + ["stick begins"]
    assert motion.events["event"].tolist() == events
    assert motion.events["tau"].to_numpy() == pytest.approx(
        math.pi * np.arange(1, half_cycles + 1) if half_cycles else [0]
    )
    assert motion.events["x1"].to_numpy() == pytest.approx(ends[1:] or [x], abs=1e-9)
    assert motion.x1.iloc[-1] == pytest.approx(ends[-1], abs=1e-9)


def test_a_damped_block_turns_round_where_its_closed_form_does() -> None:
    """In slip x is a damped swing about -+ the friction force; half a turn takes pi/omega_d."""
    ratio, start = 0.1, 8.0
    events = fl.trajectory(let_go(start, ratio, 0.5), fl.Coulomb(mu=1), periods=2).events
    left, end = math.exp(-ratio * math.pi / math.sqrt(1 - ratio**2)), start
    for _, event in events.iterrows():
        centre = math.copysign(0.5, end)
        end = centre - (end - centre) * left
        assert event["x1"] == pytest.approx(end, abs=1e-8)
    turns = math.pi / math.sqrt(1 - ratio**2)
    assert events["tau"].to_numpy() == pytest.approx(turns * np.arange(1, len(events) + 1), rel=1e-8)


def test_a_belt_carries_its_mass_until_the_spring_overcomes_static_friction() -> None:
    scene = fl.Scene(damping_ratio=0.05, normal_load=2, belt_speed=0.5)
    events = fl.trajectory(scene, fl.Coulomb(mu=0.3, mu_static=0.5), periods=4).events
    force = 2 * 0.5 - 0.1 * 0.5  # of the spring: the dashpot helps

    assert events["event"].tolist()[:2] == ["stick begins", "stick ends"]
    assert events["tau"].to_numpy()[:2] == pytest.approx([0.0, force / 0.5])
    assert set(events["event"]) == {"stick begins", "stick ends"}


def test_events_of_a_driven_motion_are_where_its_slip_is_zero() -> None:
    for law in (LAW, fl.Dahl(mu=0.4, stiffness=4)):
        events = fl.trajectory(SCENE, law, periods=3, initial=START).events
        assert len(events) >= 5
        assert events["v1"].to_numpy() == pytest.approx(SCENE.belt_speed, abs=1e-8)
        assert events["tau"].is_monotonic_increasing


def test_slip_turns_round_at_the_instant_at_which_rest_ends() -> None:
    shaken = {"velocity_amplitude": 1, "frequency": 0.4}
    scene = fl.Scene(damping_ratio=0.05, normal_load=1, belt_speed=0, belt_vibration=shaken)
    events = fl.trajectory(scene, fl.Coulomb(mu=0.4), periods=3).events
    ends, turns = (events[events["event"] == each] for each in ("stick ends", "reversal"))

    assert ends["tau"].tolist() == turns["tau"].tolist()
    assert ends["v1"].to_numpy() == pytest.approx(np.sin(0.4 * ends["tau"]), abs=1e-8)
    assert len(ends) > 3


def test_an_undriven_motion_on_bristles_is_that_of_an_unrelated_integration() -> None:
    scene, law = let_go(6.0, 0.02), fl.Dahl(mu=1, stiffness=5)
    motion = fl.trajectory(scene, law, periods=2, samples=20)
    times = motion.tau.to_numpy()

    def rates(_tau: float, y: list[float]) -> tuple[float, float, float]:
        rate = law.rate(y[1], y[2])
        return y[1], -0.04 * y[1] - y[0] - law.friction(y[1], y[2], rate), rate

    known = solve_ivp(rates, (0.0, times[-1]), [6.0, 0.0, 0.0], "DOP853", times, rtol=1e-11, atol=1e-12)
    assert motion.x1.to_numpy() == pytest.approx(known.y[0], abs=1e-6)
