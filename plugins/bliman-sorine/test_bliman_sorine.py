"""Bliman-Sorine friction: its first slip, the laws it is in its limits, its energy, an independent integration."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from bliman_sorine import BlimanSorine
from hypothesis import given
from hypothesis import strategies as st
from period_by_scipy import ACROSS, BODY, DIRECTION, DRIVE, mean_over_period, pushed
from profiles import deep

import frictionlab as fl

LAW = BlimanSorine(mu_kinetic=0.3, mu_slow=0.6, presliding_length=2, ratio=0.25)
sizes = st.floats(0.01, 100.0)
ratios = st.floats(0.01, 0.99)
vectors = st.builds(complex, st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))
laws = st.builds(BlimanSorine, mu_kinetic=sizes, mu_slow=sizes, presliding_length=sizes, ratio=ratios)
compiling = deep("kernels of its own")
SLIDER = fl.Scene(**BODY, drive=fl.Drive(**DRIVE))
SHAKER = SLIDER.with_(transverse=fl.Transverse(**ACROSS), drive=fl.Drive(**DRIVE, direction=DIRECTION))


def first_slip(law: BlimanSorine, path: float) -> float:
    """Return friction after slip from rest over a straight path."""
    memory = [length * -math.expm1(-path / length) for length in law.lengths]
    return float(law.friction(1.0, memory, memory))


@given(law=laws)
def test_friction_of_the_first_slip_peaks_where_and_as_high_as_the_closed_form_says(law):
    path, height = law.peak_path, law.peak

    assert first_slip(law, path) == pytest.approx(height, rel=1e-9)
    for other in (0.5, 0.9, 1.1, 2.0):
        assert first_slip(law, other * path) <= height * (1.0 + 1e-12)
    assert height >= law.mu_kinetic


def test_the_first_slip_has_the_peak_of_the_numbers_in_its_study():
    paths = np.linspace(0.0, 20.0, 200_001)
    forces = 0.9 * -np.expm1(-paths / 0.5) - 0.6 * -np.expm1(-paths / 2.0)

    assert LAW.peak == pytest.approx(forces.max(), rel=1e-8)
    assert LAW.peak_path == pytest.approx(paths[forces.argmax()], abs=2e-4)
    assert forces[-1] == pytest.approx(LAW.mu_kinetic, abs=1e-4)


@given(law=laws, v=vectors, quick=vectors, slow=vectors)
def test_forces_of_both_springs_obey_the_equations_of_the_source(law, v, quick, slow):
    memory, eta, epsilon = [quick, slow], law.ratio, law.presliding_length
    forces = [stiffness * z for stiffness, z in zip(law.stiffnesses, memory, strict=True)]
    rates = [law.rate(v, memory, k) * law.stiffnesses[k] for k in range(2)]
    f1, f2 = law.mu_quick, law.mu_slow

    assert rates[0] == pytest.approx((-abs(v) * forces[0] + f1 * v) / (eta * epsilon), rel=1e-9, abs=1e-9)
    assert rates[1] == pytest.approx((-abs(v) * forces[1] - f2 * v) / epsilon, rel=1e-9, abs=1e-9)
    assert f1 - f2 == pytest.approx(law.mu_kinetic, rel=1e-9, abs=1e-12)


@given(mu=sizes, length=sizes, ratio=ratios, v=vectors, z=vectors)
def test_without_the_slower_spring_it_is_dahl(mu, length, ratio, v, z):
    law = BlimanSorine(mu_kinetic=mu, mu_slow=0, presliding_length=length, ratio=ratio)
    dahl = fl.Dahl(mu=mu, presliding_length=ratio * length)

    assert law.rate(v, [z, z], 0) == pytest.approx(dahl.rate(v, z), rel=1e-12, abs=1e-12)
    assert law.friction(v, [z, z], [v, v]) == pytest.approx(dahl.friction(v, z, v), rel=1e-12, abs=1e-12)
    assert (law.peak, law.peak_path) == (mu, math.inf)


@given(law=laws, slip=vectors, quick=vectors, slow=vectors)
def test_friction_loses_at_least_the_work_that_is_no_longer_stored(law, slip, quick, slow):
    v = slip / abs(slip) if slip else 0j
    memory = [quick * law.lengths[0], slow * law.lengths[1]]
    rates = [law.rate(v, memory, k) for k in range(2)]
    work = (law.friction(v, memory, rates) * v.conjugate()).real
    p11, p12, p22 = law.storage
    gained = p11 * (memory[0].conjugate() * rates[0]).real + p22 * (memory[1].conjugate() * rates[1]).real
    gained += p12 * (memory[0].conjugate() * rates[1] + memory[1].conjugate() * rates[0]).real

    assert law.stored(memory) >= -1e-12 * law.mu_quick * law.presliding_length
    assert work - gained >= -1e-9 * law.mu_quick * (1.0 + abs(quick) + abs(slow)) ** 2


@given(law=laws)
def test_no_smaller_store_would_do(law):
    """Loss is a quadratic form of both forces: it is zero for one ratio of theirs."""
    p11, p12, p22 = law.storage
    a, b = (1.0 / length for length in law.lengths)

    assert 4.0 * a * b * p11 * p22 == pytest.approx(((a + b) * p12) ** 2, rel=1e-6)


@pytest.mark.parametrize(
    ("name", "value"), [("ratio", 1.0), ("ratio", 0.0), ("mu_slow", -0.1), ("mu_kinetic", 0.0)]
)
def test_what_makes_no_law_is_refused(name, value):
    with pytest.raises(ValueError, match=name):
        BlimanSorine(**(LAW.model_dump(exclude={"label"}) | {name: value}))


@compiling
def test_under_a_given_slip_the_means_of_its_springs_add_up_and_near_coulomb_as_their_length_goes_to_zero():
    scene, means = fl.Scene(belt_speed=5, slip=fl.Slip(velocity_amplitude=10, frequency=1)), []
    for length in (20.0, 0.2, 0.02):
        law = BlimanSorine(mu_kinetic=0.3, mu_slow=0.6, presliding_length=length, ratio=0.25)
        quick, slow = fl.Dahl(mu=0.9, presliding_length=length / 4), fl.Dahl(mu=0.6, presliding_length=length)
        parts = [fl.steady_state(scene, spring, method="exact").mean_friction for spring in (quick, slow)]
        state = fl.steady_state(scene, law, tolerance=1e-10)
        assert abs(state.mean_friction - parts[0] + parts[1]) <= state.error + 1e-12
        means.append(state.mean_friction)

    limit = fl.steady_state(scene, fl.Coulomb(mu=0.3)).mean_friction
    assert abs(means[2] - limit) <= 0.11 * abs(means[1] - limit) <= 0.11 * 0.02


@compiling
@pytest.mark.parametrize("plane", [False, True], ids=["line", "plane"])
def test_the_mean_of_a_driven_mass_is_that_of_an_independent_integration(plane):
    def rates(tau, y):
        x, u, quick, slow = y[:8:2] + 1j * y[1:8:2] if plane else y[:4]
        v, friction = u - 2.0, 0.9 * quick / 0.5 - 0.6 * slow / 2.0
        each = [u, pushed(tau, x, u, friction, plane), v - abs(v) * quick / 0.5, v - abs(v) * slow / 2.0]
        parts = [part for rate in each for part in ((rate.real, rate.imag) if plane else (rate.real,))]
        return [*parts, -friction.real]

    def reverses(_tau, y):
        return y[1] - 2.0

    independent = mean_over_period(rates, 8 if plane else 4, 2 * math.pi / 1.5, () if plane else (reverses,))
    state = fl.steady_state(SHAKER if plane else SLIDER, LAW, tolerance=1e-11)

    assert state.status == "ok"
    assert abs(state.mean_friction - independent) <= state.error + 1e-12
    assert state.mean_friction == pytest.approx(independent, rel=1e-8)


@compiling
def test_its_study_keeps_its_promises():
    done = fl.run(Path(__file__).parent / "study.yaml")

    assert [verdict.sentence for verdict in done.verdicts if not verdict.passed] == []
    assert set(done.table["status"]) == {"ok"}
