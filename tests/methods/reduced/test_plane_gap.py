"""Bounds on the mean friction in the plane from trials of the friction, against shooting."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.stribeck import Stribeck
from frictionlab.methods.reduced.mdsm import Mdsm
from frictionlab.methods.reduced.plane_gap import plane_bounds
from frictionlab.methods.reduced.potential import potential_of
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Drive, Load, Scene, Transverse

LAW = Coulomb(mu=0.4)
RISES = Stribeck(mu_kinetic=0.3, mu_static=0.3, viscosity=0.01)
FALLS = Stribeck(mu_kinetic=0.3, mu_static=0.5, stribeck_speed=20.0)
DECADES = st.floats(-0.5, 0.5).map(lambda exponent: 10.0**exponent)


def planar(frequency: float, ratio: float, natural: float, phase: float, speed: float) -> Scene:
    """Loads of 10 along and across; ratio: of friction 0.4 normal_load to them."""
    return Scene(
        damping_ratio=0.1,
        normal_load=ratio * 10.0 / LAW.mu,
        belt_speed=speed,
        drive=Drive(amplitude=10.0, frequency=frequency),
        transverse=Transverse(
            natural_frequency=natural, damping_ratio=0.1, load=Load(amplitude=10.0, phase=phase)
        ),
    )


def bounds(one: Scene, law: FrictionLaw, mean: float) -> tuple[float, float]:
    """Around the mean of a model."""
    low, high = plane_bounds(one.mass(), law, np.array([one.belt_speed]), np.array([mean]))
    return float(low[0]), float(high[0])


@settings(derandomize=True, max_examples=15)
@given(
    DECADES,
    st.floats(-3.0, 0.2).map(lambda exponent: 10.0**exponent),
    DECADES,
    st.sampled_from([0.0, 3.0, 90.0]),
    st.floats(0.05, 30.0),
)
def test_the_bounds_hold_the_mean_that_shooting_finds(frequency, ratio, natural, phase, speed) -> None:
    """Also where slip nearly rests (loads in phase) and where the true motion rests."""
    one = planar(frequency, ratio, natural, phase, speed)
    true = Shooting().solve([one], LAW, 1e-8)

    low, high = bounds(one, LAW, float(Mdsm().model_means([one], LAW)[0].real))

    assert true.status == ["ok"]
    assert low - true.error[0] <= true.mean[0].real <= high + true.error[0]


@pytest.mark.parametrize("law", [LAW, RISES, FALLS], ids=["constant", "rises", "falls"])
def test_where_slip_turns_smoothly_the_error_is_the_true_one_for_every_law(law: FrictionLaw) -> None:
    scenes = [planar(1.0, 0.1, 1.5, 0.0, speed) for speed in (5.0, 15.0, 40.0)]
    found, true = Mdsm().solve(scenes, law, 1e-8), Shooting().solve(scenes, law, 1e-8)

    apart = np.abs(found.mean.real - true.mean.real)

    assert found.status == ["ok"] * 3
    assert np.all(apart <= found.error + true.error)
    assert np.all(found.error < 1.3 * apart)


def test_strong_friction_is_refused_with_the_remedy() -> None:
    one = planar(1.0, 3.0, 0.5, 0.0, 3.0)

    refused, told = (method.solve([one], LAW, 1e-6) for method in (Mdsm(), Mdsm(error="distance")))

    assert refused.status == ["refused"]
    assert "error: distance" in refused.reason[0]
    assert told.status == ["ok"]


@pytest.mark.parametrize("law", [LAW, RISES, FALLS], ids=["constant", "rises", "falls"])
@pytest.mark.parametrize("speed", [0.0, 1e-3, 0.7, 50.0, 99.0])
def test_a_potential_is_the_integral_of_friction_over_speed(law: FrictionLaw, speed: float) -> None:
    found = potential_of(law, 100.0, 0.02)

    wanted = quad(lambda v: law.sliding_friction(v) + 0.02 * v, 0.0, speed, epsabs=1e-13, limit=200)[0]

    assert found.at(np.array([speed]))[0] == pytest.approx(wanted, rel=1e-11, abs=1e-11)
    assert found.slope(np.array([speed]))[0] == pytest.approx(
        law.sliding_friction(speed) + 0.02 * speed, abs=1e-7
    )
    assert math.isnan(found.at(np.array([100.1]))[0])
