"""Prescribed slip of any waveform and direction under a normal load that may change."""

from __future__ import annotations

import copy
import itertools
import math
from typing import Any

import numpy as np
import pytest
from answered import with_columns
from hypothesis import given, settings
from hypothesis import strategies as st
from profiles import deep
from scipy.integrate import quad

from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.jenkins import Jenkins
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.stribeck import Stribeck
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.prescribed.varying_slip import VaryingPoint, VaryingSlip
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Scene
from frictionlab.theory import mean_prescribed_longitudinal, mean_prescribed_pulsating

LAW = Coulomb(mu=0.4)
FALLING = Stribeck(mu_kinetic=0.3, mu_static=0.5, stribeck_speed=0.4, stribeck_exponent=1.5, viscosity=0.02)
DAHL = Dahl(mu=0.4, presliding_length=0.1)
A_SINE = {"harmonics": [{"order": 1, "amplitude": 1.0}]}  # not solved as one
ONE_SIDED = {"harmonics": [{"order": 1, "amplitude": 1.0}, {"order": 2, "amplitude": 0.5, "phase": 50.0}]}
angles = st.floats(0.0, 360.0)
waveforms = st.sampled_from(["sine", "square", "triangle", "sawtooth", ONE_SIDED])


def scene(ratio: float, waveform: Any = "sine", phase: float = 0.0, **keys: Any) -> Scene:
    parts = {"velocity_amplitude": 1.0, "frequency": 1.3, "phase": phase, "waveform": waveform}
    return Scene(belt_speed=ratio, slip={**parts, **keys.pop("slip", {})}, normal_load=2.0, **keys)


def answer(one: Scene, law: Any, method: Any = None, tolerance: float = 1e-9) -> Any:
    return with_columns(method or Shooting(), one, law, tolerance)


def mean(one: Scene, law: Any, method: Any = None) -> float:
    found = answer(one, law, method)
    assert found.status == ["ok"], found.reason
    assert found.error[0] <= 1e-9
    return float(found.mean[0].real)


@pytest.mark.parametrize("method", [Exact(), Shooting()], ids=lambda method: method.name)
@given(
    waveform=st.sampled_from(["sine", "square", "triangle", "sawtooth"]),
    ratio=st.floats(-0.99, 0.99) | st.sampled_from([0.0, 1.2, 1.5, -2.0, -3.0]),
    phase=angles,
)
@settings(max_examples=20)
def test_friction_along_the_belt_has_the_closed_form_of_its_waveform(
    method: Any, waveform: str, ratio: float, phase: float
) -> None:
    closed = 0.4 * float(mean_prescribed_longitudinal(ratio, waveform))
    found = answer(scene(ratio, waveform, phase), LAW, method)

    assert found.mean[0].real == pytest.approx(closed, abs=1e-13)
    assert found.error[0] <= (1e-13 if method.name == "exact" else 1e-9)


@given(ratio=st.floats(-0.99, 0.99), amplitude=st.floats(0.0, 0.99), lead=angles, phase=angles)
@settings(max_examples=20)
def test_a_normal_load_that_pulsates_with_slip_moves_the_mean(
    ratio: float, amplitude: float, lead: float, phase: float
) -> None:
    one = scene(ratio, "sine", phase, normal_load_variation={"amplitude": amplitude, "phase": phase + lead})
    closed = 0.4 * float(mean_prescribed_pulsating(ratio, amplitude, math.radians(lead)))

    assert mean(one, LAW) == pytest.approx(closed, abs=1e-13)


PER_AXIS = Dahl(mu=0.4, presliding_length=0.1, planar="per-axis")
KINKED = LuGre(mu_kinetic=0.4, mu_static=0.6, stribeck_speed=0.3, stiffness=40, damping=0.1)
ON_THE_LINE = [
    LAW,
    FALLING,
    DAHL,
    Dahl(mu=0.4, presliding_length=0.02, exponent=0.5),
    Jenkins(mu=0.4, stiffness=3.0),
]
IN_THE_PLANE = [LAW, FALLING, PER_AXIS, KINKED, ElastoPlastic(mu_kinetic=0.4, stiffness=40)]


@given(
    law=st.sampled_from(ON_THE_LINE),
    ratio=st.floats(-1.5, 1.5).filter(lambda ratio: abs(ratio) > 1e-3),
    phase=angles,
)
@settings(max_examples=15)
def test_a_sine_given_as_a_sum_of_harmonics_is_a_sine(law: Any, ratio: float, phase: float) -> None:
    is_a_sine(law, ratio, phase)


@deep("more kernels to compile")
@given(
    law=st.sampled_from(IN_THE_PLANE),
    ratio=st.floats(-1.5, 1.5),
    direction=st.floats(5.0, 85.0),
    phase=angles,
)
@settings(max_examples=60)
def test_in_the_plane_too(law: Any, ratio: float, direction: float, phase: float) -> None:
    is_a_sine(law, ratio, phase, slip={"direction": direction})


def is_a_sine(law: Any, ratio: float, phase: float, **keys: Any) -> None:
    """Compare all that a prescribed slip has of columns; one that is not unique is so in both."""
    one, sine = (answer(scene(ratio, form, phase, **copy.deepcopy(keys)), law) for form in (A_SINE, "sine"))
    assert one.status == sine.status
    if one.status == ["ok"]:
        assert one.mean[0] == pytest.approx(sine.mean[0], abs=one.error[0] + sine.error[0] + 1e-13)
        for column in ("energy_contact", "energy_friction", "velocity_amplitude"):
            assert one.columns[column][0] == pytest.approx(sine.columns[column][0], abs=1e-7), column


def test_a_direction_is_two_slips() -> None:
    for waveform in ("square", "sawtooth", "sine"):
        turned = scene(0.3, waveform, 20.0, slip={"direction": 30.0})
        along, across = math.cos(math.radians(30.0)), math.sin(math.radians(30.0))
        two = scene(
            0.3,
            waveform,
            20.0,
            slip={"velocity_amplitude": along},
            transverse_slip={"velocity_amplitude": across, "phase": 20.0, "waveform": waveform},
        )
        for law in (LAW, FALLING):
            assert mean(turned, law) == pytest.approx(mean(two, law), abs=1e-13)
        assert answer(turned, LAW).columns["mean_friction_transverse"][0] == pytest.approx(
            answer(two, LAW).columns["mean_friction_transverse"][0], abs=1e-13
        )


def test_a_sine_straight_against_the_belt_is_one_half_a_period_later() -> None:
    back, later = scene(0.3, "sine", 10.0, slip={"direction": 180.0}), scene(0.3, "sine", 190.0)

    assert mean(back, LAW) == pytest.approx(mean(later, LAW), abs=1e-13)
    assert mean(back, DAHL) == pytest.approx(mean(later, DAHL), abs=1e-12)


@given(waveform=waveforms, load=waveforms, phase=angles, ratio=st.floats(0.05, 0.9), size=st.floats(0.1, 0.4))
@settings(max_examples=6)
def test_the_mean_in_the_plane_is_that_of_an_adaptive_quadrature(
    waveform: Any, load: Any, phase: float, ratio: float, size: float
) -> None:
    one = scene(
        ratio,
        waveform,
        phase,
        transverse_slip={"velocity_amplitude": 0.8, "phase": 60.0, "waveform": "triangle"},
        normal_load_variation={"amplitude": size, "waveform": load, "phase": 33.0, "frequency_ratio": 2},
    )
    signals = one.signals()

    def friction(tau: float) -> float:
        at = np.array(tau)
        slip = complex(float(signals.belt[0](at)) - ratio, float(signals.belt[1](at)))
        share = 1.0 + float(signals.normal_load(at)) / 2.0
        return -share * FALLING.sliding_friction(abs(slip)) * slip.real / max(abs(slip), 1e-300)

    ends = [0.0, *signals.corners(), signals.period]
    total = sum(
        quad(friction, start, stop, limit=400, epsabs=1e-10)[0] for start, stop in itertools.pairwise(ends)
    )
    assert mean(one, FALLING) == pytest.approx(total / signals.period, abs=2e-8)


def test_stiff_bristles_tend_to_coulomb_friction_as_the_root_of_their_length() -> None:
    # the sawtooth turns round slowly once and jumps back: the two layers do not cancel as those of a sine
    load = {"amplitude": 0.4, "waveform": "sawtooth", "phase": 20.0}
    one = scene(0.3, "sawtooth", 40.0, normal_load_variation=load)
    off = [
        mean(one, Dahl(mu=0.4, presliding_length=length)) - mean(one, LAW) for length in (1e-4, 1e-6, 1e-8)
    ]

    assert off[0] == pytest.approx(10 * off[1], rel=0.02)
    assert off[1] == pytest.approx(10 * off[2], rel=0.002)
    assert off[2] < 1e-4


def test_an_elastic_contact_on_a_belt_at_rest_keeps_its_mean() -> None:
    law, load = Jenkins(mu=0.4, presliding_length=1.0), {"amplitude": 0.5, "waveform": "square"}
    one = scene(0.0, "triangle", 90.0, normal_load_variation=load)  # 90 degrees: forward where it is heavy
    found = answer(one, law)

    assert found.status == ["not_unique"]
    swing = math.pi / 4.0 / 1.3  # half of the way that the slip goes back and forth
    room = 0.4 * (1.0 - swing)
    middle = 0.5 * (found.columns["mean_low"][0] + found.columns["mean_high"][0])
    assert found.columns["mean_high"][0] - found.columns["mean_low"][0] == pytest.approx(2 * room, abs=1e-9)
    assert middle != pytest.approx(0.0, abs=1e-3)  # the contact is bent forward while it is heavy


def test_slip_that_comes_to_rest_at_the_end_of_a_long_period_ends_its_panels() -> None:
    # between 8 and this period two neighbours among numbers are farther apart than 2e-16 of it
    straight = scene(0.0, A_SINE, slip={"frequency": 2 * math.pi / 8.76, "direction": 40.0})

    assert abs(mean(straight, LAW)) <= 1e-13


@pytest.mark.parametrize("frequency", [1.0, 0.3, 7.0])
def test_a_slip_that_touches_rest_takes_few_panels(frequency: float) -> None:
    load = {"amplitude": 0.6, "phase": 20.0}
    one = scene(1.0, slip={"frequency": frequency}, normal_load_variation=load)

    assert len(VaryingSlip.of(one.signals(), 2.0).panels(1.0)[1]) < 2000
    point = VaryingPoint(one, Coulomb(mu=1.0))
    assert abs(point.found.mean - 1.0) <= point.found.error < 1e-5


def test_columns_keep_their_meaning() -> None:
    load = {"amplitude": 0.3, "frequency_ratio": 1.5}
    found = answer(scene(0.4, "triangle", 25.0, normal_load_variation=load), LAW).columns
    slower = answer(scene(0.4, "triangle", 25.0), LAW).columns

    assert found["period"][0] == 2.0
    assert found["reversals"][0] == pytest.approx(2 * slower["reversals"][0])
    assert slower["reversals"][0] == 2.0
    assert slower["velocity_amplitude"][0] == pytest.approx(1.0, abs=1e-12)
    assert slower["velocity_harmonic"][0] == pytest.approx(8 / math.pi**2, abs=1e-9)
    assert math.isnan(slower["velocity_phase"][0])  # no load to lead
    assert math.isnan(slower["energy_input"][0])
    # heat: friction 2*.4 times the mean size of the slip, .5 (1 + .4^2), and the period
    heat = 2.0 * 0.4 * 0.5 * (1 + 0.4**2) * 2 * math.pi / 1.3
    assert slower["energy_contact"][0] == pytest.approx(heat, rel=1e-12)
    taken = heat - 0.4 * 2.0 * slower["mean_friction"][0] * 2 * math.pi / 1.3
    assert slower["energy_friction"][0] == pytest.approx(taken, rel=1e-12)


@given(
    stiffness=st.floats(-6, 6).map(lambda power: 10.0**power),
    exponent=st.floats(1, 3),
    ratio=st.floats(1.5, 9),
)
def test_slip_that_never_reverses_saturates_every_contact(
    stiffness: float, exponent: float, ratio: float
) -> None:
    law = Dahl(mu=0.4, stiffness=stiffness, exponent=exponent)

    assert mean(scene(-ratio, A_SINE, 40.0), law) == pytest.approx(-0.4, abs=1e-14)
