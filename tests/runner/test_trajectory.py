"""Motions from a start: they begin there, never jump, and end on the steady orbit."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fig_4b import LAW, SCENE

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


def test_a_motion_that_never_settles_is_followed_all_the_same() -> None:
    undamped = SCENE.with_(damping_ratio=0.0, belt_speed=60.0, **{"drive.frequency": 1.7})
    motion = fl.trajectory(undamped, LAW, periods=3, initial=START)
    assert np.isfinite(motion.x1).all()


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"method": "exact"}, "no motion in time is known of this scene and law by exact"),
        ({"scene": fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5)}, "it needs a driven mass"),
        ({"periods": 0}, "periods must be a whole number of at least 1, got 0"),
        ({"samples": 2.5}, "samples must be a whole number of at least 1, got 2.5"),
    ],
)
def test_what_cannot_be_followed_is_told(given: dict[str, object], told: str) -> None:
    with pytest.raises(ValueError, match=told):
        fl.trajectory(**{"scene": SCENE, "law": LAW} | given)  # type: ignore[arg-type]
