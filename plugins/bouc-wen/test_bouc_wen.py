"""Bouc-Wen friction: what it is at the ends of its exponent, where it makes energy, how it turns with the slip."""

from __future__ import annotations

import cmath
import math
from pathlib import Path

import pytest
from bouc_wen import BoucWen
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

import frictionlab as fl

speeds = st.floats(-10.0, 10.0).filter(lambda v: abs(v) > 1e-6)
shares = st.floats(-1.0, 1.0)


def slid(law: BoucWen, z: complex, path: complex) -> complex:
    """Return the deflection after a slip along a straight path, by integration."""

    def rate(_: float, pair: list[float]) -> list[float]:
        dz = law.rate(path, complex(*pair))
        return [dz.real, dz.imag]

    found = solve_ivp(rate, (0.0, 1.0), [z.real, z.imag], rtol=1e-11, atol=1e-13, method="DOP853")
    return complex(*found.y[:, -1])


@given(v=speeds, share=shares, stiffness=st.floats(0.1, 1e3))
def test_exponent_one_without_gamma_is_dahl_along_a_line(v, share, stiffness):
    law, dahl = BoucWen(mu=0.4, stiffness=stiffness, beta_share=1), fl.Dahl(mu=0.4, stiffness=stiffness)
    z = share * law.largest_deflection()

    assert law.rate(v, z) == pytest.approx(dahl.rate(v, z), abs=1e-14 * abs(v))
    assert law.friction(v, z, 0.0) == dahl.friction(v, z, 0.0)


@pytest.mark.parametrize("beta_share", [0.5, 0.7, 2.0])
def test_exponent_two_loads_along_a_hyperbolic_tangent(beta_share):
    law = BoucWen(mu=0.4, stiffness=2, exponent=2, beta_share=beta_share)

    for path in (0.05, 0.2, 1.0):
        assert slid(law, 0.0, path).real == pytest.approx(0.2 * math.tanh(path / 0.2), abs=1e-9)


def test_a_large_exponent_is_an_ideal_spring_that_slips():
    law, jenkins = BoucWen(mu=0.4, stiffness=2, exponent=20), fl.Jenkins(mu=0.4, stiffness=2)

    for path in (0.1, 0.3, 0.1 + 0.1j):
        assert slid(law, 0.05j, path) == pytest.approx(jenkins.deflected(0.05j, path), abs=2e-3)


@given(exponent=st.floats(1, 20), beta_share=st.floats(1e-6, 2.0), turn=st.floats(0, 6.3))
@example(exponent=10.5, beta_share=0.005, turn=math.pi)  # a thousandth outside its set slip leads away
def test_slip_leads_no_deflection_out_of_its_set(exponent, beta_share, turn):
    law = BoucWen(mu=1, stiffness=1, exponent=exponent, beta_share=beta_share)
    outward = cmath.rect(1, turn)

    assert (law.rate(1.0, outward) * outward.conjugate()).real <= 1e-12


def test_unloading_is_elastic_where_beta_is_gamma_and_stiffer_where_it_is_more():
    for beta_share, stiffer in ((0.5, 1.0), (0.75, 1.5), (1.0, 2.0)):
        law = BoucWen(mu=1, stiffness=1, exponent=3, beta_share=beta_share)
        assert law.rate(-1.0, law.limit) == -stiffer
        assert law.elastic_unloading() == (stiffer == 1.0)


@given(
    v=speeds, share=shares, angle=st.floats(-3.1, 3.1), turn=st.floats(-3.1, 3.1), exponent=st.floats(1, 4)
)
def test_in_the_plane_it_turns_with_the_slip(v, share, angle, turn, exponent):
    law, turned = BoucWen(mu=0.4, stiffness=2, exponent=exponent, beta_share=0.8), cmath.rect(1.0, turn)
    z = share * law.limit * cmath.rect(1.0, angle)

    dz = law.rate(complex(v), z)
    assert abs(law.rate(turned * v, turned * z) - turned * dz) <= 1e-12 * abs(v)


def test_a_cycle_of_exponent_two_has_the_mean_of_its_closed_form():
    law, amplitude, belt = BoucWen(mu=0.4, presliding_length=10, exponent=2), 10.0, 5.0
    scene = fl.Scene(belt_speed=belt, slip=fl.Slip(velocity_amplitude=amplitude, frequency=1))

    def after(z: float, path: float) -> float:
        """Elastic back to zero, from there towards the limit as a hyperbolic tangent."""
        if z * path < 0.0:
            back = min(abs(z), abs(path))
            z, path = z + math.copysign(back, path), path - math.copysign(back, path)
        return 10.0 * math.tanh(path / 10.0 + math.atanh(z / 10.0)) if z * path >= 0.0 and path else z

    def way(tau: float) -> float:
        return belt * tau - amplitude * math.cos(tau)

    turns = -math.asin(0.5), math.pi + math.asin(0.5), 2 * math.pi - math.asin(0.5)
    z = 0.0
    for _ in range(200):
        high = after(z, way(turns[1]) - way(turns[0]))
        z = after(high, way(turns[2]) - way(turns[1]))
    legs = (
        quad(lambda tau: after(z, way(tau) - way(turns[0])), *turns[:2], limit=200, epsabs=1e-11)[0],
        quad(lambda tau: after(high, way(tau) - way(turns[1])), *turns[1:], limit=200, epsabs=1e-11)[0],
    )

    state = fl.steady_state(scene, law)
    assert state.mean_friction == pytest.approx(0.04 * sum(legs) / (2 * math.pi), abs=1e-8)


def test_its_study_keeps_its_promises():
    done = fl.run(Path(__file__).parent / "study.yaml")

    assert [verdict.sentence for verdict in done.verdicts if not verdict.passed] == []
    assert set(done.table["status"]) == {"ok"}


def test_it_gives_back_more_than_its_spring_stores_where_beta_is_less_than_gamma():
    law, z = BoucWen(mu=1, stiffness=1, exponent=1, beta_share=0.1), 0.9
    given_back = quad(lambda left: law.friction(-1.0, left, 0.0) / -law.rate(-1.0, left), 0.0, z)[0]

    assert not law.passive()
    assert given_back > law.bristle_stiffness * z * z / 2
