"""Closed forms of compliant contacts against limits, quadrature, and the laws they are closed forms of."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.special import i1e
from strategies import sizes

from frictionlab import theory
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.elasto_plastic import breakaway_share
from frictionlab.laws.jenkins import Jenkins

NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)
below_one = st.floats(1e-3, 0.999)


# Loops and their first harmonic


def test_the_stiffness_of_dahl_is_a_bessel_function_at_every_amplitude() -> None:
    a = np.logspace(-8, 8, 400)
    wanted = 4 * i1e(a) / a / (1 + np.exp(-2 * a))

    np.testing.assert_allclose(theory.dahl_describing_function(a).real, wanted, rtol=1e-14)


@given(sizes(10, 1e8))
def test_stiff_dahl_friction_is_coulombs_but_its_stiffness_fades_slowly(a: float) -> None:
    found, limit = complex(theory.dahl_describing_function(a)), 4 / math.sqrt(2 * math.pi * a)

    assert abs(found.real * a - limit) <= limit / (2 * a)
    assert abs(found.imag / complex(theory.coulomb_describing_function(a)).imag - 1) <= 1.01 / a


@given(sizes(1e-8, 1e-2))
def test_soft_dahl_friction_is_a_spring_that_loses_the_cube_of_the_amplitude(a: float) -> None:
    found = complex(theory.dahl_describing_function(a))

    assert found.real == pytest.approx(1 - 3 * a**2 / 8, abs=a**4 + 1e-14)
    assert theory.dahl_loop_area(a) == pytest.approx(4 / 3 * a**3 * (1 - 2 * a**2 / 5), rel=a**4 + 1e-14)
    assert found.imag == pytest.approx(4 / (3 * math.pi) * a, rel=a**2 + 1e-14)


def test_jenkins_friction_is_a_spring_until_its_slider_moves_and_coulombs_far_beyond() -> None:
    a = np.logspace(2, 8, 50)
    found = theory.jenkins_describing_function(a)

    assert complex(theory.jenkins_describing_function(0.7)) == pytest.approx(1.0, abs=1e-14)
    assert complex(theory.jenkins_describing_function(2.0)) == pytest.approx(0.5 + 1j / math.pi, rel=1e-15)
    np.testing.assert_allclose(found.real * a, 16 / (3 * np.pi) / np.sqrt(a), rtol=1 / a[0])
    np.testing.assert_allclose(found.imag * a, 4 / np.pi * (1 - 1 / a), rtol=1e-14)


@given(st.floats(-0.999, 0.999), st.floats(-0.999, 0.999))
def test_creep_needs_forces_of_unequal_size_and_goes_the_way_of_the_larger(low: float, high: float) -> None:
    assert theory.dahl_drift(-high, high) == 0
    assert theory.dahl_drift(low, high) == -theory.dahl_drift(high, low)
    assume(abs(high) > abs(low) + 1e-6)
    assert theory.dahl_drift(low, high) > 0


@given(st.floats(-3, 3), sizes(1e-6, 1e3), st.floats(1e-12, 1e-4))
def test_exponents_near_one_are_the_exponential(start: float, path: float, gap: float) -> None:
    one = float(theory.dahl_path(start, path))

    assert abs(float(theory.dahl_path(start, path, 1 + gap)) - one) <= 20 * gap + 1e-14
    assert abs(float(theory.dahl_path(start, path, 1 - gap)) - one) <= 20 * gap + 1e-14


# Means under a prescribed slip


def test_soft_means_are_those_computed_by_quadrature_elsewhere() -> None:
    longitudinal = theory.mean_soft_dahl([0.1, 0.5, 0.9])
    transverse = theory.mean_soft_transverse([0.05, 0.3, 1.0, 3.0])

    np.testing.assert_allclose(longitudinal, [0.15629749, 0.69638313, 0.97924352], atol=5e-9)
    np.testing.assert_allclose(transverse, [0.07806354, 0.41403702, 0.82236387, 0.97349718], atol=5e-9)
    assert theory.mean_soft_transverse(0.5) == pytest.approx(0.5961, abs=5e-5)
    assert theory.mean_soft_circular(0.3) == pytest.approx(0.293, abs=5e-4)


def one_period(law: Dahl | Jenkins, ratio: float) -> float:
    """The mean friction under slip at ratio + cos(angle), amplitude 1, path by path on the law's own update."""
    turn = math.acos(-ratio)
    legs = [(turn, 2 * math.pi - turn, -1.0), (2 * math.pi - turn, 2 * math.pi + turn, 1.0)]

    def place(angle: float) -> float:
        return ratio * angle + math.sin(angle)

    back, forth = float(theory.slip_back_and_forth(ratio)[0]), float(theory.slip_back_and_forth(ratio)[1])
    z, before = law.largest_deflection(), math.inf
    while abs(z - before) > 1e-15 * law.largest_deflection():
        z, before = law.deflected(law.deflected(z, -back), forth), z
    total = 0.0
    for low, high, side in legs:
        inside = [low, *(low + (high - low) * np.linspace(0, 1, 61)[1:-1] ** 3), high]  # finest after turning
        for begin, end in pairwise(inside):
            angle = 0.5 * (begin + end) + 0.5 * (end - begin) * NODES
            gone = [side * abs(place(a) - place(low)) for a in angle.tolist()]
            friction = np.array([law.friction(side, law.deflected(z, way), 0.0) for way in gone])
            total += 0.5 * (end - begin) * float(np.sum(WEIGHTS * friction))
        z = law.deflected(z, side * abs(place(high) - place(low)))
    return total / (2 * math.pi)


@pytest.mark.parametrize("exponent", [0.5, 1.0, 1.5])
@pytest.mark.parametrize("ratio", [0.2, 0.6, 0.9])
def test_soft_and_stiff_bristles_tend_to_their_limits_at_the_right_rates(
    exponent: float, ratio: float
) -> None:
    gaps = []
    for presliding in (100.0, 1000.0):
        law = Dahl(mu=1, presliding_length=presliding, exponent=exponent)
        gaps.append((float(theory.mean_soft_dahl(ratio, exponent)) - one_period(law, ratio)) * presliding**2)
    assert gaps[0] == pytest.approx(gaps[1], rel=0.015)

    stiff = Dahl(mu=1, presliding_length=1e-4, exponent=exponent)
    more = (one_period(stiff, ratio) - float(theory.mean_prescribed_longitudinal(ratio))) / 1e-4
    assert more == pytest.approx(float(theory.stiff_correction(ratio, exponent)), rel=0.015)


def test_a_stiff_spring_that_slips_is_felt_as_long_as_dahl_bristles() -> None:
    more = one_period(Jenkins(mu=1, presliding_length=1e-3), 0.6) - float(
        theory.mean_prescribed_longitudinal(0.6)
    )

    assert more / 1e-3 == pytest.approx(float(theory.stiff_correction(0.6, 0.0)), rel=0.01)
    assert (
        theory.stiff_correction(0.6, 0.0)
        == theory.stiff_correction(0.6, 1.0)
        == -theory.stiff_correction(-0.6)
    )
    assert theory.stiff_correction(0.6, 2.0) == math.inf


@pytest.mark.parametrize("ratio", [0.05, 0.3, 0.8, 0.99])
@pytest.mark.parametrize("presliding", [1.0, 3.0])
def test_a_spring_whose_slider_never_slips_back_has_its_mean_in_closed_form(
    ratio: float, presliding: float
) -> None:
    wanted = one_period(Jenkins(mu=1, presliding_length=presliding), ratio)

    assert theory.mean_soft_jenkins(ratio, presliding) == pytest.approx(wanted, abs=2e-6)
    assert theory.mean_soft_jenkins(-ratio, presliding) == -theory.mean_soft_jenkins(ratio, presliding)
    assert math.isnan(float(theory.mean_soft_jenkins(0.05, 0.5)))
    assert theory.mean_soft_jenkins(1.2, 0.5) == pytest.approx(1.0, abs=1e-14)
    back = float(theory.slip_back_and_forth(0.3)[0])
    assert math.isnan(float(theory.mean_soft_jenkins(0.3, back / 2.01)))
    assert theory.mean_soft_jenkins(0.3, back / 1.99) < 1.0


@given(below_one, st.floats(0.05, 0.95))
def test_soft_elasto_plastic_contacts_balance_what_breaks_away_and_never_fall_below_breaking_away(
    ratio: float, breakaway: float
) -> None:
    mean = float(theory.mean_soft_elasto_plastic(ratio, breakaway))
    back, forth = (float(way) for way in theory.slip_back_and_forth(ratio))

    assert mean * breakaway_share(mean, breakaway, 1.0) == pytest.approx(1 - back / forth, abs=1e-12)
    assert breakaway <= mean <= 1
    assert theory.mean_soft_elasto_plastic(-ratio, breakaway) == -mean


# Steady sliding, and reversals


@given(sizes(1e-2, 1e2), sizes(1e-3, 1e1), st.floats(-3, 1), st.floats(0, 1), st.floats(0, 1))
def test_a_mass_slides_steadily_where_every_root_of_its_equation_decays(
    stiffness: float, lag: float, slope: float, lead: float, damping: float
) -> None:
    contact = theory.SteadySliding(slope=slope, lag=lag, lead=lead, viscosity=0.1)
    damped = damping + contact.viscosity
    roots = np.roots([lag, 1 + damped * lag + slope * lead, stiffness * lag + damped + slope, stiffness])
    assume(abs(roots.real.max()) > 1e-6)

    assert contact.stable(damping, stiffness) == (roots.real.max() < 0)
    # they are the roots of mass, dashpot, spring and the impedance
    for s in roots[abs(1 + lag * roots) > 1e-3]:
        held = s * contact.impedance(s)
        size = abs(s) ** 2 + stiffness + abs(held)
        assert s**2 + damping * s + stiffness + held == pytest.approx(0, abs=1e-6 * size)


@given(friction=sizes(1e-2, 1e2), acceleration=sizes(1e-2, 1e2))
def test_the_kick_of_a_reversal_is_what_dahl_friction_adds_to_the_velocity(
    friction: float, acceleration: float
) -> None:
    length = 1e-4

    def motion(t: float, y: np.ndarray) -> list[float]:
        return [y[1], acceleration + 2 * friction * math.exp(-y[0] / length)]

    fast = math.sqrt(length / acceleration)
    found = solve_ivp(motion, (0, 40 * fast), [0, 0], rtol=1e-10, atol=1e-14 * length, method="DOP853")
    gained = found.y[1, -1] - acceleration * 40 * fast

    assert gained == pytest.approx(theory.reversal_kick(friction, acceleration) * math.sqrt(length), rel=1e-6)


@given(st.floats(0.9, 1.0))
def test_the_slip_back_loses_no_digits_where_it_ends(ratio: float) -> None:
    angle = math.acos(ratio)
    back, forth = theory.slip_back_and_forth(ratio)
    lead = 2 * angle**3 / 3 * (1 - angle**2 / 10 + angle**4 / 280 - angle**6 / 15120 + angle**8 / 1330560)

    assert back == pytest.approx(lead, rel=1e-11)
    assert forth - back == pytest.approx(2 * math.pi * ratio, rel=1e-14)
    assert float(theory.slip_back_and_forth(1.3)[0]) == 0.0
