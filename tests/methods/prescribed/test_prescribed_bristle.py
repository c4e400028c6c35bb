"""Bristle laws under a prescribed slip: closed forms, limits, orderings, and an independent way to the numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from answered import with_columns
from hypothesis import assume, example, given
from hypothesis import strategies as st
from profiles import some

from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.jenkins import Jenkins
from frictionlab.laws.lugre import LuGre
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.shooting.method import Shooting
from frictionlab.motion.orbit.recorder import WEIGHTS
from frictionlab.motion.orbit.sample import sample
from frictionlab.scene.scene import Scene, Slip, TransverseSlip

TOLERANCE = 1e-9
RATIOS = (0.1, 0.3, 0.5, 0.7, 0.9)
NODES_OF_A_LEG, WEIGHTS_OF_A_LEG = np.polynomial.legendre.leggauss(400)


def slip(ratio, along=1.0, across=None, angle=0.0, frequency=1.0, normal_load=1.0):
    """Slip on a belt of speed ``ratio``; ``across`` leads by ``angle`` degrees."""
    own = frequency if along is None else None
    return Scene(
        belt_speed=ratio,
        normal_load=normal_load,
        slip=Slip(velocity_amplitude=along, frequency=frequency) if along is not None else None,
        transverse_slip=(
            TransverseSlip(velocity_amplitude=across, phase=angle, frequency=own)
            if across is not None
            else None
        ),
    )


def transverse(ratio, size=1.0):
    return slip(ratio, None, size)


def circular(ratio):
    return slip(ratio, 1.0, 1.0, 90.0)


def dahl(softness, **more):
    return Dahl(mu=1.0, presliding_length=softness, **more)


def elasto_plastic(softness, **more):
    return ElastoPlastic(mu_kinetic=1.0, presliding_length=softness, **more)


def answer(scene, law, tolerance=TOLERANCE):
    method = Exact() if Exact().refusal(scene, law) is None else Shooting()
    return with_columns(method, scene, law, tolerance)


def mean(scene, law):
    """The mean friction, whose error is below the tolerance."""
    answers = answer(scene, law)
    assert answers.status == ["ok"], answers.reason
    assert answers.columns["error"][0] <= TOLERANCE
    return answers.columns["mean_friction"][0]


def closed_form(ratio, softness):
    """Dahl friction of two legs: end forces in closed form, the mean by the trapezoidal rule on a stretched grid."""
    turn, height = math.pi - math.acos(ratio), math.sqrt(1.0 - ratio * ratio)
    p = math.exp(-2.0 * (ratio * turn + height) / softness)
    q = math.exp(-2.0 * (ratio * (turn - math.pi) + height) / softness)
    first, second = (-1 + 2 * q - p * q) / (1 - p * q), (1 - 2 * p + p * q) / (1 - p * q)
    ahead = turn * NODES_OF_A_LEG
    path = ratio * (ahead + turn) + np.sin(ahead) + height
    total = turn * (WEIGHTS_OF_A_LEG * (1.0 - (1.0 - first) * np.exp(-path / softness))).sum()
    back = math.pi + (math.pi - turn) * NODES_OF_A_LEG
    path = height - ratio * (back - turn) - np.sin(back)
    total += (math.pi - turn) * (WEIGHTS_OF_A_LEG * (-1.0 + (1.0 + second) * np.exp(-path / softness))).sum()
    return total / (2.0 * math.pi)


@given(ratio=st.floats(0.01, 0.99), softness=st.floats(-1.3, 2.0).map(lambda power: 10.0**power))
def test_dahl_friction_along_the_belt_has_its_closed_form(ratio, softness):
    assert mean(slip(ratio), dahl(softness)) == pytest.approx(closed_form(ratio, softness), abs=1e-11)


def test_softer_dahl_contacts_lose_less_friction_along_the_belt_and_more_across_it():
    soft = [1e-3, 0.1, 1.0, 10.0, 1e5]
    for ratio in RATIOS:
        stiffest = [
            answer(one(ratio), Coulomb(mu=1.0)).columns["mean_friction"][0] for one in (slip, transverse)
        ]
        along = [stiffest[0], *(mean(slip(ratio), dahl(one)) for one in soft)]
        across = [stiffest[1], *(mean(transverse(ratio), dahl(one)) for one in [*soft[:-1], 1e4])]

        assert (np.diff(along) > 0.0).all()
        assert (np.diff(across) < 0.0).all()
        assert along[-1] == pytest.approx(soft_limit(ratio), abs=1e-9)


def soft_limit(ratio):
    return 0.5 * math.pi * ratio / (ratio * math.asin(ratio) + math.sqrt(1.0 - ratio * ratio))


@pytest.mark.parametrize("ratio", [0.1, 0.5, 0.9])
def test_a_stiff_dahl_contact_differs_from_coulomb_by_its_first_term(ratio):
    coulomb = 2.0 / math.pi * math.asin(ratio)
    for softness, within in ((1e-3, 2e-2), (1e-5, 1e-3)):
        slope = (mean(slip(ratio), dahl(softness)) - coulomb) / softness
        assert slope == pytest.approx(2.0 / (3.0 * math.pi) * ratio / (1.0 - ratio**2), rel=within)


@pytest.mark.parametrize("ratio", [0.1, 0.5, 0.9])
def test_soft_contacts_have_their_closed_forms(ratio):
    turn, height = math.pi - math.acos(ratio), math.sqrt(1.0 - ratio**2)
    legs = (ratio * (turn - math.pi) + height) / (ratio * turn + height)
    for exponent in (0.5, 2.0, 3.0):
        share = legs ** (1.0 / exponent)
        found = mean(slip(ratio), dahl(1e7, exponent=exponent))
        assert found == pytest.approx((1.0 - share) / (1.0 + share), abs=1e-6)
    y = mean(slip(ratio), elasto_plastic(100.0))
    alpha = 0.5 + 0.5 * math.sin(math.pi * (y - 0.85) / 0.3)
    assert y > 0.7
    assert y * alpha == pytest.approx(1.0 - legs, abs=6e-3)  # of the mean: 6e-4 times its slope there
    assert 1.0 - mean(slip(ratio), Jenkins(mu=1.0, presliding_length=1e6)) < 4e-6


@given(
    ratio=st.floats(0.0, 1.2),
    softness=st.floats(-3.0, 2.0).map(lambda power: 10.0**power),
    speed=st.floats(0.1, 50.0),
    frequency=st.floats(0.1, 20.0),
    load=st.floats(0.1, 20.0),
)
def test_only_the_two_ratios_count(ratio, softness, speed, frequency, load):
    scene = slip(ratio * speed, speed, frequency=frequency, normal_load=load)
    stretched = dahl(softness * speed / frequency)
    at_load = Dahl(mu=1.0, contact_stiffness=load / (softness * speed / frequency))

    assert mean(scene, stretched) == pytest.approx(mean(slip(ratio), dahl(softness)), abs=1e-11)
    assert mean(scene, at_load) == pytest.approx(mean(scene, stretched), abs=1e-12)


def test_the_initial_curvature_along_the_belt_changes_sign_with_softness():
    def curvature(softness):
        one, two = (mean(slip(ratio), dahl(softness)) for ratio in (0.01, 0.02))
        return two - 2.0 * one

    assert curvature(0.93) > 0.0 > curvature(0.95)


@pytest.mark.parametrize("ratio", [0.2, 0.5, 0.8])
@pytest.mark.parametrize("softness", [0.1, 0.3])
def test_dahl_friction_of_vanishing_exponent_is_jenkins(ratio, softness):
    jenkins = mean(slip(ratio), Jenkins(mu=1.0, presliding_length=softness))
    off = [abs(mean(slip(ratio), dahl(softness, exponent=one)) - jenkins) for one in (0.1, 0.01, 0.001)]

    assert off[0] <= (0.02 if ratio < 0.8 else 0.1) * 0.1
    assert 8.0 < off[0] / off[1] < 12.0
    assert 8.0 < off[1] / off[2] < 12.0
    assert mean(slip(ratio), dahl(softness, exponent=0.0)) == pytest.approx(jenkins, abs=1e-13)


def test_slip_that_turns_and_comes_to_rest_for_an_instant_is_between_its_neighbours():
    slower, at_rest, faster = (mean(circular(ratio), elasto_plastic(0.3)) for ratio in (0.999, 1.0, 1.001))

    assert slower < at_rest < faster


@some(1, "whole curves")
@pytest.mark.parametrize("law", [dahl, elasto_plastic, lambda one: Jenkins(mu=1.0, presliding_length=one)])
@pytest.mark.parametrize("scene", [slip(0.5), slip(0.5, 1.0, 1.0, 60.0)])
def test_thirteen_decades_of_stiffness_are_one_smooth_curve_of_small_error(law, scene):
    means = np.array([mean(scene, law(10.0**power)) for power in range(-9, 5)])
    coulomb = answer(scene, Coulomb(mu=1.0)).columns["mean_friction"][0]

    assert abs(means[0] - coulomb) < 1e-8
    assert means[-1] == pytest.approx(means[-2], abs=1e-3)
    assert (np.abs(means) <= 1.0).all()


@pytest.mark.parametrize("law", [dahl(0.4), elasto_plastic(0.4)])
def test_a_belt_that_outruns_the_slip_feels_full_friction(law):
    for ratio in (1.0, 1.0 + 1e-9, 1.7):
        for side in (1.0, -1.0):
            assert mean(slip(side * ratio), law) == pytest.approx(side, abs=1e-12)


def test_viscosity_adds_its_mean():
    plain, viscous = (LuGre(mu_kinetic=1.0, presliding_length=0.4, viscosity=one) for one in (0.0, 0.3))
    for ratio in (0.4, 1.3):
        assert mean(slip(ratio), viscous) == pytest.approx(mean(slip(ratio), plain) + 0.3 * ratio, abs=1e-12)


def test_per_axis_friction_along_the_belt_is_that_of_the_line():
    for law in (dahl(0.3, planar="per-axis"), elasto_plastic(0.3, planar="per-axis")):
        assert mean(slip(0.4, 1.0, 0.7, 50.0), law) == mean(slip(0.4), law)


@pytest.mark.parametrize(
    ("scene", "law"),
    [
        (slip(0.4), dahl(0.3)),
        (slip(-0.4), elasto_plastic(0.3)),
        (slip(0.4, 1.0, 0.7, 50.0), dahl(0.3)),
        (slip(0.4, 1.0, 0.7, 50.0), dahl(0.3, planar="per-axis")),
    ],
)
def test_the_orbit_has_the_mean_and_the_energies_of_the_columns(scene, law):
    answers = answer(scene, law)
    orbit = answers.orbit(0)
    weights = 0.5 * (orbit.tau[:, -1:] - orbit.tau[:, :1]) * WEIGHTS
    period = 2.0 * math.pi

    assert (orbit.tau[0, 0], orbit.tau[-1, -1]) == (0.0, pytest.approx(period))
    friction = (weights * orbit.friction).sum() / period
    assert -friction.real == pytest.approx(answers.columns["mean_friction"][0], abs=1e-8)
    taken = (weights * (orbit.friction * orbit.v.conjugate()).real).sum()
    assert taken == pytest.approx(answers.columns["energy_friction"][0], abs=1e-7)
    heat = (weights * (orbit.friction * (orbit.v - scene.belt_speed).conjugate()).real).sum()
    assert heat == pytest.approx(answers.columns["energy_contact"][0], abs=1e-7)
    assert len(sample(orbit, scene, law, 50).tau) == 50


@given(
    ratio=st.floats(-1.5, 1.5).filter(lambda ratio: abs(ratio) > 1e-3),
    size=st.floats(0.0, 2.0),
    angle=st.floats(-180.0, 180.0),
    softness=st.floats(-9.0, 4.0).map(lambda power: 10.0**power),
)
@example(ratio=1.0, size=0.0, angle=0.0, softness=0.1)
@example(ratio=1e-3, size=1.0, angle=0.0, softness=1e-9)
def test_any_ellipse_at_any_stiffness_has_a_mean_within_the_coefficient_and_its_error(
    ratio, size, angle, softness
):
    assert abs(mean(slip(ratio, 1.0, size, angle), dahl(softness))) <= 1.0 + TOLERANCE


@given(
    belt_speed=st.floats(0.1, 3.0),
    along=st.floats(0.0, 2.0),
    across=st.floats(0.3, 2.0),
    phase=st.floats(20.0, 160.0),
)
def test_coulombs_mean_is_the_gradient_of_the_mean_slip_speed(
    belt_speed: float, along: float, across: float, phase: float
) -> None:
    """C1: <T> = mu grad <|slip|> over the steady part of slip, on any ellipse."""
    angle = np.arange(4096) * 2 * np.pi / 4096
    shaken = along * np.sin(angle) + 1j * across * np.sin(angle + np.radians(phase))

    def mean_speed(steady: complex) -> float:
        return float(np.abs(shaken - steady).mean())

    closest = np.abs(shaken - belt_speed).min()
    assume(closest > 0.02)
    h = 1e-5
    gradient = (mean_speed(belt_speed + h) - mean_speed(belt_speed - h)) / (2 * h)
    gradient += 1j * (mean_speed(belt_speed + 1j * h) - mean_speed(belt_speed - 1j * h)) / (2 * h)
    scene = Scene(
        belt_speed=belt_speed,
        slip=Slip(velocity_amplitude=along, frequency=1.0),
        transverse_slip=TransverseSlip(velocity_amplitude=across, phase=phase),
    )
    answers = with_columns(Shooting(), [scene], Coulomb(mu=0.4), 1e-9)
    means = answers.columns["mean_friction"][0], answers.columns["mean_friction_transverse"][0]
    assert abs(means[0] - 0.4 * gradient.real) <= 1e-7
    assert abs(means[1] - 0.4 * gradient.imag) <= 1e-7
