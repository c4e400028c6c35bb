"""Describing functions: closed forms, quadrature, the plane, what they refuse."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from maxwell_slip import MaxwellSlip
from profiles import deep
from scipy.integrate import quad, solve_ivp

import frictionlab as fl
from frictionlab.theory.loops import (
    coulomb_describing_function,
    dahl_describing_function,
    jenkins_describing_function,
)

MU, STIFFNESS, OMEGA = 0.4, 40.0, 1.3
COULOMB = fl.Coulomb(mu=MU)
DAHL, JENKINS = fl.Dahl(mu=MU, stiffness=STIFFNESS), fl.Jenkins(mu=MU, stiffness=STIFFNESS)
ELEMENTS = [fl.Jenkins(mu=0.1, stiffness=10), fl.Jenkins(mu=0.2, stiffness=40)]
MAXWELL = MaxwellSlip(mu=[0.1, 0.2], stiffness=[10, 40])
AMPLITUDES = [1e-3, 0.012, 0.03, 1.0, 100.0]


def test_about_rest_coulomb_friction_is_equation_9_in_every_harmonic() -> None:
    found = fl.describing_function(COULOMB, AMPLITUDES, OMEGA, harmonics=3)
    x = np.array(AMPLITUDES) / OMEGA

    assert found.shape == (3, 5)
    assert found[0] == pytest.approx(MU * coulomb_describing_function(x) / (1j * OMEGA), rel=1e-11)
    assert np.abs(found[1] * AMPLITUDES).max() < 1e-11
    assert found[2] == pytest.approx(found[0] / 3.0, rel=1e-11)


@pytest.mark.parametrize(
    ("law", "closed"), [(DAHL, dahl_describing_function), (JENKINS, jenkins_describing_function)]
)
def test_about_rest_bristles_are_their_closed_forms(law: Any, closed: Any) -> None:
    x = np.array(AMPLITUDES) / OMEGA * STIFFNESS / MU
    exact = STIFFNESS * closed(x) / (1j * OMEGA)

    assert fl.describing_function(law, AMPLITUDES, OMEGA) == pytest.approx(exact, rel=1e-12)


def test_small_slip_about_rest_meets_the_impedance_there() -> None:
    law = fl.ElastoPlastic(mu_kinetic=0.3, stiffness=40, damping=1, viscosity=0.1)

    assert fl.describing_function(law, 1e-3, OMEGA) == pytest.approx(fl.impedance(law, 0, OMEGA), rel=1e-12)
    assert fl.describing_function(law, 1e-3, OMEGA, harmonics=2)[1] == pytest.approx(0.0, abs=1e-10)


def friction_harmonic(law: Any, size: float, belt_speed: float, k: int) -> complex:
    """Of friction without memory over a sine, by adaptive quadrature between its reversals."""
    turn = math.asin(min(belt_speed / size, 1.0))
    edges = [turn, math.pi - turn, 2.0 * math.pi + turn]

    def part(theta: float, wave: Any) -> float:
        slip = size * math.sin(theta) - belt_speed
        return float(law.sliding_vector(slip) * wave(k * theta))

    sine, cosine = (
        sum(quad(part, a, b, (wave,), epsabs=1e-13, limit=200)[0] for a, b in pairwise(edges))
        for wave in (math.sin, math.cos)
    )
    return complex(sine, cosine) / math.pi


@pytest.mark.parametrize("law", [COULOMB, fl.Stribeck(mu_kinetic=0.3, mu_static=0.4, viscosity=0.1)])
@pytest.mark.parametrize("ratio", [0.3, 0.9, 1.2])
def test_on_a_moving_belt_harmonics_are_those_of_quadrature(law: Any, ratio: float) -> None:
    found = fl.describing_function(law, 2.0, OMEGA, belt_speed=2.0 * ratio, harmonics=3)

    assert 2.0 * found == pytest.approx(
        [friction_harmonic(law, 2.0, 2.0 * ratio, k) for k in (1, 2, 3)], abs=1e-10
    )


def harmonic_of_bristles(law: Any, size: float, belt_speed: float) -> complex:
    """The first harmonic by steps of high order from one reversal to the next, over the third period from rest."""
    turn = math.asin(belt_speed / size)
    edges = np.array([turn + n * math.pi - (2.0 * turn if n % 2 else 0.0) for n in range(7)])

    def rates(theta: float, state: Any) -> list[float]:
        v = size * math.sin(theta) - belt_speed
        dz = law.rate(v, state[0])
        friction = law.friction(v, state[0], dz)
        return [dz / OMEGA, friction * math.sin(theta) / math.pi, friction * math.cos(theta) / math.pi]

    state, kept = np.zeros(3), []
    for span in pairwise(edges):
        kept.append(state[1:])
        state = solve_ivp(rates, span, state, method="DOP853", rtol=1e-13, atol=1e-15).y[:, -1]
    return complex(*(state[1:] - kept[4]))


@pytest.mark.parametrize("ratio", [0.0, 0.5, 0.9])
def test_only_bristles_push_in_phase_with_the_slip_and_a_moving_belt_weakens_both_parts(ratio: float) -> None:
    """Sulollari, van Dalen & Cabboi, section 4: Dahl friction has a part in phase and one in quadrature."""
    rigid = fl.describing_function(fl.Coulomb(mu=1), 1, 1, ratio)
    soft, stiff = (
        fl.describing_function(fl.Dahl(mu=1, presliding_length=length), 1, 1, ratio)
        for length in (1e-2, 1e-4)
    )
    printed = {0.0: (0.159, 1.26), 0.5: (0.148, 1.089), 0.9: (0.1, 0.521)}[ratio]  # two in docs/paper.md

    assert (-soft.imag, soft.real) == pytest.approx(printed, abs=5.1e-4)
    assert rigid == pytest.approx(4 / math.pi * math.sqrt(1 - ratio**2), abs=1e-10)
    assert soft.imag / stiff.imag == pytest.approx(10, rel=0.1)  # as the root of the presliding length
    assert abs(stiff.real - rigid.real) < 0.02 * abs(soft.real - rigid.real)


@pytest.mark.parametrize("ratio", [0.0, 0.4])
def test_damped_bristles_are_those_of_another_integrator(ratio: float) -> None:
    law = fl.LuGre(mu_kinetic=0.3, mu_static=0.4, stiffness=4, damping=0.3, viscosity=0.1)
    found = fl.describing_function(law, 2.0, OMEGA, belt_speed=2.0 * ratio)

    assert 2.0 * found == pytest.approx(harmonic_of_bristles(law, 2.0, 2.0 * ratio), rel=1e-9)


@deep("kernels of other counts")
@pytest.mark.parametrize("size", [1e-3, 7e-3, 1e-2, 1.0])
def test_sliders_in_parallel_add_up_whether_they_slip_or_not(size: float) -> None:
    for arguments in ((size, OMEGA), (size, OMEGA, 0.3 * size), ((size, 0.5j * size), OMEGA)):
        whole, *parts = (fl.describing_function(law, *arguments) for law in (MAXWELL, *ELEMENTS))

        assert whole == pytest.approx(sum(parts), rel=1e-9)


@deep("kernels of other counts")
def test_straight_slip_in_the_plane_meets_what_it_meets_along_the_belt() -> None:
    for law in (COULOMB, DAHL, JENKINS, MAXWELL):
        along = fl.describing_function(law, 0.05, OMEGA)
        plane = fl.describing_function(law, (0.03, 0.04), OMEGA)

        assert np.diag(plane) == pytest.approx([along, along], rel=1e-8)
        assert plane[0, 1] * 0.04 == pytest.approx(plane[0, 0] * 0.03, rel=1e-8)


def test_round_slip_meets_constant_friction_and_one_direction_alone_leaves_the_other_open() -> None:
    assert fl.describing_function(COULOMB, (2, 2j), OMEGA) == pytest.approx(
        np.array([[0.2, -0.2j], [0.2j, 0.2]]), abs=1e-12
    )
    across = fl.describing_function(COULOMB, (0, 2), OMEGA, belt_speed=1.0, harmonics=2)
    assert across.shape == (2, 2, 2)
    assert np.isnan(across[:, :, 0]).all()
    assert across[0, 0, 1] == pytest.approx(0.0, abs=1e-12)  # by symmetry


def test_law_by_axis_gives_each_axis_its_own_though_one_be_elastic() -> None:
    law = fl.Jenkins(mu=MU, stiffness=STIFFNESS, planar="per-axis")
    found = fl.describing_function(law, (1.0, 1e-3), OMEGA, belt_speed=0.1)

    assert found[0, 0] == pytest.approx(fl.describing_function(JENKINS, 1.0, OMEGA, 0.1), rel=1e-12)
    assert found[1, 1] == pytest.approx(STIFFNESS / (1j * OMEGA), rel=1e-12)


@pytest.mark.parametrize("amplitude", [1e-3, 0.03])
def test_contact_stiffness_is_taken_per_unit_of_load(amplitude: float) -> None:
    pressed = fl.Jenkins(mu=MU, contact_stiffness=10 * STIFFNESS)
    found = fl.describing_function(pressed, amplitude, OMEGA, normal_load=10)

    assert found == pytest.approx(fl.describing_function(JENKINS, amplitude, OMEGA), rel=1e-14)


def test_numbers_with_units_are_taken_in_si() -> None:
    written, plain = (fl.Dahl(mu=MU, presliding_length=length) for length in ("1 um", 1e-6))

    assert fl.describing_function(written, 1e-4, 100.0) == fl.describing_function(plain, 1e-4, 100.0)


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        ((COULOMB, 0.0, 1.0), "amplitude must be > 0, got 0.0"),
        ((COULOMB, (1, 2, 3), 1.0), "a tuple is two amplitudes"),
        ((COULOMB, (0, 0), 1.0), "not both 0"),
        ((COULOMB, [1, math.nan], 1.0), "amplitude must be finite numbers"),
        ((COULOMB, 1.0, -1.0), "Slip: frequency: must be > 0"),
        ((COULOMB, 1.0, 1.0, 0.0, 0.0), "normal_load: must be > 0"),
        ((COULOMB, 1.0, 1.0, 0.0, 1.0, 0), "harmonics must be a whole number of at least 1"),
        ((fl.Dahl(mu=MU, stiffness=4, exponent=2), (1, 2), 1.0), "a vector form for exponent 1 alone"),
    ],
)
def test_what_makes_no_sense_is_refused(arguments: Any, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        fl.describing_function(*arguments)
