"""One harmonic of bristle friction: closed forms, both its parts, its balance, and its stated error."""

from __future__ import annotations

import csv
import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from answered import with_columns
from resonance import at_resonance as scene

from frictionlab.laws.dahl import Dahl
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.jenkins import Jenkins
from frictionlab.laws.lugre import LuGre
from frictionlab.methods.reduced.bristle import over_sine
from frictionlab.methods.reduced.harmonic_balance import HarmonicBalance
from frictionlab.theory import dahl_describing_function, friction_free_velocity, jenkins_describing_function

REFERENCE = Path(__file__).parents[2] / "reference"
MU = 0.4


@cache
def rows(file):
    """The rows of a reference file."""
    with (REFERENCE / file).open() as lines:
        return list(csv.DictReader(lines))


def dahl(presliding):
    return Dahl(mu=MU, presliding_length=presliding)


def relative(law, kappa):
    """Mean and first harmonic of friction over the slip sin(theta) - kappa, relative to mu."""
    found = over_sine(law, 1.0, kappa, 1.0)
    return found._replace(mean=found.mean / MU, first=found.first / MU)


def solve(scenes, law):
    return with_columns(HarmonicBalance(), scenes, law, 1e-8)


@pytest.mark.parametrize(
    ("kind", "presliding", "within"),
    [(Dahl, size, 1e-9) for size in (30.0, 3.0, 0.3, 0.03, 1e-4)]
    + [(Jenkins, size, 1e-11) for size in (1.5, 0.9, 0.3, 1e-3)],
)
def test_friction_over_a_sine_is_its_describing_function(kind, presliding: float, within: float) -> None:
    describing = dahl_describing_function if kind is Dahl else jenkins_describing_function
    closed = describing(1.0 / presliding) / presliding

    found = relative(kind(mu=MU, presliding_length=presliding), 0.0)

    assert found.first == pytest.approx(complex(closed.imag, -closed.real), rel=within, abs=0.1 * within)
    assert abs(found.mean) < 1e-12


def test_means_over_a_biased_sine_are_those_of_the_reference_loops() -> None:
    for row in rows("rigid_kinematics.csv")[::5]:
        presliding, kappa = float(row["lam"]), float(row["kappa"])
        damped = LuGre(mu_kinetic=MU, presliding_length=presliding, damping=0.1 * MU / presliding)
        laws = {
            "dahl_exact": (dahl(presliding), 5e-9),
            "lugre_numeric_sig0p1": (damped, 5e-9),
            "dupont_rba0p7_numeric": (ElastoPlastic(mu_kinetic=MU, presliding_length=presliding), 2e-6),
        }
        for column, (law, accuracy) in laws.items():
            if row[column] and kappa != 0.0:
                assert -relative(law, kappa).mean == pytest.approx(float(row[column]), abs=accuracy)


def test_friction_has_an_in_phase_and_a_quadrature_part_and_the_former_dies_in_the_coulomb_limit() -> None:
    for kappa in (0.0, 0.25, 0.5, 0.75, 0.95):
        for presliding in (10.0, 1.0, 0.1, 0.01):
            found = relative(dahl(presliding), kappa)
            assert -found.first.imag > 0.01 * (1.0 - kappa**2)
            assert found.first.real > 0.0
    for kappa in (0.0, 0.3, 0.8):
        stiff, stiffer = (relative(dahl(size), kappa).first for size in (1e-4, 1e-6))
        coulomb = 4.0 / math.pi * math.sqrt(1.0 - kappa**2)
        assert stiff.imag / stiffer.imag == pytest.approx(10.0, rel=2e-3)  # as the root of the length
        assert stiffer.real == pytest.approx(coulomb, rel=1e-5)
        assert abs(stiff.real - coulomb) > 50.0 * abs(stiffer.real - coulomb)


@pytest.mark.parametrize(("frequency", "presliding"), [(0.8, 3.0), (1.0, 1.0), (1.5, 0.1), (4.0, 1.0)])
def test_on_a_belt_at_rest_the_amplitude_is_that_of_the_closed_forms(
    frequency: float, presliding: float
) -> None:
    one = scene(0.0, frequency)

    found = solve(one, dahl(presliding))

    velocity = found.columns["velocity_amplitude"][0]
    reach = velocity / frequency / presliding
    held = MU * one.normal_load / presliding * complex(dahl_describing_function(reach))
    dynamic = 1.0 - frequency**2 + 2j * one.damping_ratio * frequency + held
    assert velocity == pytest.approx(10.0 * frequency**3 / abs(dynamic), rel=1e-9)
    lag = math.degrees(math.atan2(dynamic.imag, dynamic.real))
    assert found.columns["velocity_phase"][0] == pytest.approx(90.0 - lag, abs=1e-7)
    assert abs(found.columns["mean_friction"][0]) <= found.columns["error"][0] < 1e-8


def test_a_belt_faster_than_v_lin_meets_steady_friction() -> None:
    v_lin = friction_free_velocity(scene(0.0))

    found = solve([scene(v_lin * 1.2)], dahl(0.1))

    assert found.columns["mean_friction"][0] == pytest.approx(MU, abs=1e-12)
    assert found.columns["error"][0] < 1e-7
    assert found.columns["reversals"][0] == 0.0


def test_viscous_bristles_that_damp_more_than_the_mass_resists_are_balanced() -> None:
    law = LuGre(mu_kinetic=MU, presliding_length=0.3, damping=0.1, viscosity=0.05)

    found = solve([scene(speed) for speed in (10.0, 30.0)], law).columns

    assert np.all(found["error"] < 1e-2)
    # beyond reversal friction is linear in the slip, and its mean that of the mean slip
    assert found["mean_friction"][1] == pytest.approx(MU + 0.05 * 30.0, abs=1e-9)
