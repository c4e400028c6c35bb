"""One harmonic of bristle friction: closed forms, both its parts, its balance, and its stated error."""

from __future__ import annotations

import csv
import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from answered import with_columns
from profiles import deep
from resonance import at_resonance as scene

from frictionlab.compile.cache import compiled
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.jenkins import Jenkins
from frictionlab.laws.lugre import LuGre
from frictionlab.methods.reduced.amplitudes import contact_of
from frictionlab.methods.reduced.contact import Harmonics, harmonic_friction
from frictionlab.methods.reduced.harmonic_balance import HarmonicBalance
from frictionlab.orbit.panels import WEIGHTS
from frictionlab.scene.scene import Drive, Scene, Slip, Transverse
from frictionlab.theory import dahl_describing_function, friction_free_velocity, jenkins_describing_function

REFERENCE = Path(__file__).parents[2] / "reference"
MU = 0.4


@cache
def rows(file):
    """The rows of a reference file."""
    with (REFERENCE / file).open() as lines:
        return list(csv.DictReader(lines))


def over_a_sine(law, kappa, exact=None):
    """Friction over the slip sin(theta) - kappa, relative to mu."""
    contact = contact_of(law)
    if exact is not None:
        contact = contact._replace(exact=exact)
    found = Harmonics(*compiled(harmonic_friction, law)(contact, 1.0, kappa, 1.0))
    return found._replace(mean=found.mean / MU, sine=found.sine / MU, cosine=found.cosine / MU)


def solve(scenes, law):
    """Answers, each scene accepted."""
    scenes = [scenes] if isinstance(scenes, Scene) else scenes
    assert all(HarmonicBalance().refusal(one, law) is None for one in scenes)
    return with_columns(HarmonicBalance(), scenes, law, 1e-8)


@pytest.mark.parametrize("presliding", [30.0, 3.0, 0.3, 0.03, 1e-4])
def test_dahl_friction_over_a_sine_is_its_describing_function(presliding: float) -> None:
    closed = dahl_describing_function(1.0 / presliding) / presliding

    found = over_a_sine(Dahl(mu=MU, presliding_length=presliding), 0.0)

    assert -found.cosine == pytest.approx(closed.real, rel=1e-9, abs=1e-10)
    assert found.sine == pytest.approx(closed.imag, rel=1e-9, abs=1e-10)
    assert abs(found.mean) < 1e-12


@pytest.mark.parametrize("presliding", [1.5, 0.9, 0.3, 1e-3])
def test_jenkins_friction_over_a_sine_is_its_describing_function(presliding: float) -> None:
    closed = jenkins_describing_function(1.0 / presliding) / presliding

    found = over_a_sine(Jenkins(mu=MU, presliding_length=presliding), 0.0)

    assert -found.cosine == pytest.approx(closed.real, rel=1e-11)
    assert found.sine == pytest.approx(closed.imag, abs=1e-11)


@pytest.mark.parametrize("kappa", [0.0, 0.25, 0.75, 0.95])
def test_the_exact_path_and_collocation_of_the_rate_agree_on_a_biased_loop(kappa: float) -> None:
    for presliding in (1.0, 0.1, 1e-3):
        law = Dahl(mu=MU, presliding_length=presliding)
        path, rate = over_a_sine(law, kappa, 1.0), over_a_sine(law, kappa, 0.0)

        np.testing.assert_allclose(path[:3], rate[:3], rtol=0, atol=2e-9)


def test_means_over_a_biased_sine_are_those_of_the_reference_loops() -> None:
    for row in rows("rigid_kinematics.csv")[::5]:
        presliding, kappa = float(row["lam"]), float(row["kappa"])
        laws = {
            "dahl_exact": (Dahl(mu=MU, presliding_length=presliding), 5e-9),
            "lugre_numeric_sig0p1": (
                LuGre(mu_kinetic=MU, presliding_length=presliding, damping=0.1 * MU / presliding),
                5e-9,
            ),
            "dupont_rba0p7_numeric": (ElastoPlastic(mu_kinetic=MU, presliding_length=presliding), 2e-6),
        }
        for column, (law, accuracy) in laws.items():
            if not row[column] or kappa == 0.0:
                continue
            assert -over_a_sine(law, kappa).mean == pytest.approx(float(row[column]), abs=accuracy)


@pytest.mark.parametrize("kappa", [0.0, 0.25, 0.5, 0.75, 0.95])
def test_dahl_friction_has_an_in_phase_and_a_quadrature_part_with_and_without_bias(kappa: float) -> None:
    for presliding in (10.0, 1.0, 0.1, 0.01):
        found = over_a_sine(Dahl(mu=MU, presliding_length=presliding), kappa)

        assert -found.cosine > 0.01 * (1.0 - kappa**2)
        assert found.sine > 0.0


@pytest.mark.parametrize("kappa", [0.0, 0.3, 0.8])
def test_in_the_coulomb_limit_the_in_phase_part_dies_as_the_root_of_the_presliding_length(
    kappa: float,
) -> None:
    stiff, stiffer = (over_a_sine(Dahl(mu=MU, presliding_length=size), kappa) for size in (1e-4, 1e-6))
    coulomb = 4.0 / math.pi * math.sqrt(1.0 - kappa**2)

    assert stiff.cosine / stiffer.cosine == pytest.approx(10.0, rel=2e-3)
    assert stiffer.sine == pytest.approx(coulomb, rel=1e-5)
    assert abs(stiff.sine - coulomb) > 50.0 * abs(stiffer.sine - coulomb)


def test_coulomb_friction_has_no_in_phase_part() -> None:
    one = scene(12.0)
    answers = with_columns(HarmonicBalance(), [one], Coulomb(mu=MU), 1e-8)
    orbit = answers.orbit(0)
    weights = WEIGHTS * 0.5 * np.diff(orbit.tau[:, [0, -1]])

    work_of_displacement = float((weights * orbit.friction.real * orbit.x.real).sum())
    mean = float((weights * orbit.friction.real).sum() / weights.sum())
    bias = mean * float((weights * orbit.x.real).sum())

    assert abs(work_of_displacement - bias) < 1e-10 * float((weights * np.abs(orbit.x)).sum())


@pytest.mark.parametrize(("frequency", "presliding"), [(0.8, 3.0), (1.0, 1.0), (1.5, 0.1), (4.0, 1.0)])
def test_on_a_belt_at_rest_the_amplitude_is_that_of_the_closed_forms(
    frequency: float, presliding: float
) -> None:
    one, law = scene(0.0, frequency), Dahl(mu=MU, presliding_length=presliding)

    found = solve(one, law)

    velocity = found.columns["velocity_amplitude"][0]
    reach = velocity / frequency / presliding
    held = MU * one.normal_load / presliding * complex(dahl_describing_function(reach))
    dynamic = 1.0 - frequency**2 + 2j * one.damping_ratio * frequency + held
    assert velocity == pytest.approx(10.0 * frequency**3 / abs(dynamic), rel=1e-9)
    assert found.columns["velocity_phase"][0] == pytest.approx(
        90.0 - math.degrees(math.atan2(dynamic.imag, dynamic.real)), abs=1e-7
    )
    assert abs(found.columns["mean_friction"][0]) <= found.columns["error"][0] < 1e-8


def law_of(row):
    """The law of a row of the reference of masses on dynamic laws."""
    presliding, stiffness, load = (float(row[name]) for name in ("z_ss", "s", "gamma2"))
    if row["law"] == "dahl":
        return Dahl(mu=MU, presliding_length=presliding)
    if row["law"] == "lugre":
        return LuGre(mu_kinetic=MU, presliding_length=presliding, damping=math.sqrt(stiffness) / load)
    return ElastoPlastic(mu_kinetic=MU, presliding_length=presliding)


def test_the_error_covers_the_reference_of_masses_on_dynamic_laws() -> None:
    line = [row for row in rows("dynamic_laws_system.csv") if row["omega_r"] == "none"]
    ratios = []
    for row in line[::7]:
        one = scene(float(row["v_b"]), float(row["Omega"]), normal_load=float(row["gamma2"]))
        found = solve(one, law_of(row))
        true = abs(found.columns["mean_friction"][0] - float(row["mu_bar"]))

        assert found.status == ["ok"]
        assert true <= found.columns["error"][0] + 2e-7
        if true > 1e-5:
            ratios.append(found.columns["error"][0] / true)

    assert len(ratios) > 10
    assert max(ratios) < 1.3


def test_means_are_odd_and_the_motion_is_the_same_for_a_belt_that_moves_back() -> None:
    law = Dahl(mu=MU, contact_stiffness=3.0)
    forth, back = solve([scene(5.0), scene(40.0)], law), solve([scene(-5.0), scene(-40.0)], law)

    np.testing.assert_array_equal(back.columns["mean_friction"], -forth.columns["mean_friction"])
    np.testing.assert_array_equal(back.columns["error"], forth.columns["error"])
    for name in ("velocity_amplitude", "velocity_phase", "energy_input", "energy_contact"):
        np.testing.assert_allclose(back.columns[name], forth.columns[name], rtol=1e-12, atol=1e-9)


def test_energies_balance_and_columns_are_those_of_the_orbit() -> None:
    scenes = [scene(speed, 1.2) for speed in (1.0, -15.0, 25.0)]
    found = solve(scenes, Dahl(mu=MU, presliding_length=0.5))
    columns = found.columns

    np.testing.assert_allclose(
        columns["energy_input"], columns["energy_viscous"] + columns["energy_friction"], rtol=1e-9
    )
    for i, one in enumerate(scenes):
        orbit = found.orbit(i)
        weights = WEIGHTS * 0.5 * np.diff(orbit.tau[:, [0, -1]])
        friction, slip = orbit.friction.real, orbit.v.real - one.belt_speed
        period = 2.0 * math.pi / one.frequency
        assert weights.sum() == pytest.approx(period, rel=1e-12)
        assert -(weights * friction).sum() / period == pytest.approx(columns["mean_friction"][i], abs=1e-7)
        friction_impulse = one.normal_load * float((weights * friction * slip).sum())
        assert friction_impulse == pytest.approx(columns["energy_contact"][i], rel=1e-6)
        mean = float((weights * orbit.x.real).sum()) / period
        assert mean == pytest.approx(one.normal_load * columns["mean_friction"][i], abs=1e-5)


def test_a_belt_faster_than_v_lin_meets_steady_friction() -> None:
    v_lin = friction_free_velocity(scene(0.0))

    found = solve([scene(v_lin * 1.2)], Dahl(mu=MU, presliding_length=0.1))

    assert found.columns["mean_friction"][0] == pytest.approx(MU, abs=1e-12)
    assert found.columns["error"][0] < 1e-7
    assert found.columns["reversals"][0] == 0.0


@pytest.mark.parametrize(
    ("one", "law", "reason"),
    [
        (
            Scene(belt_speed=1.0, slip=Slip(velocity_amplitude=2.0, frequency=1.0)),
            Dahl(mu=MU, stiffness=1.0),
            "prescribed slip",
        ),
        (
            scene(1.0, transverse=Transverse(natural_frequency=0.5, damping_ratio=0.1)),
            Dahl(mu=MU, stiffness=1.0),
            "two directions",
        ),
        (scene(1.0, drive=None), Dahl(mu=MU, stiffness=1.0), "needs a drive"),
        (scene(1.0, damping_ratio=0.0), Dahl(mu=MU, stiffness=1.0), "undamped resonance"),
    ],
)
def test_scenes_it_cannot_do_are_refused_with_the_reason(one: Scene, law: Dahl, reason: str) -> None:
    assert reason in HarmonicBalance().refusal(one, law)


def refusal_of(one, law):
    """The reason why ``solve`` refuses."""
    found = solve(one, law)
    assert found.status == ["refused"]
    assert math.isnan(found.columns["mean_friction"][0])
    assert found.orbit(0) is None
    return found.reason[0]


def test_contact_resonance_with_more_than_one_amplitude_is_refused() -> None:
    one = Scene(
        damping_ratio=0.01, normal_load=10.0, belt_speed=0.68, drive=Drive(amplitude=1.0, frequency=2.0)
    )

    reason = refusal_of(one, Dahl(mu=MU, contact_stiffness=3.0))

    assert "balances at velocity amplitudes 0.6666, " in reason


def test_slip_within_an_elastic_contact_is_refused_for_its_mean_depends_on_the_start() -> None:
    one = Scene(
        damping_ratio=0.1, normal_load=10.0, belt_speed=0.0, drive=Drive(amplitude=0.3, frequency=2.0)
    )

    assert "depends on the start" in refusal_of(one, Jenkins(mu=MU, presliding_length=1.0))


@deep("a kernel slow to compile")
def test_friction_that_falls_too_fast_for_one_steady_state_is_refused() -> None:
    law = LuGre(mu_kinetic=MU, mu_static=0.8, stribeck_speed=5.0, presliding_length=0.1)
    resting = scene(4.0, drive=Drive(amplitude=0.2, frequency=3.0))
    sliding = scene(8.0, drive=Drive(amplitude=0.2, frequency=3.0))

    assert "use shooting" in refusal_of(resting, law)
    assert "use shooting" in refusal_of(sliding, law)
