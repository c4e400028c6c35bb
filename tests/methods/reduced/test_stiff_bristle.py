"""Coulomb friction for a stiff bristle: its error covers what the deflection changes, of the right order."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from profiles import DEEP

from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.jenkins import Jenkins
from frictionlab.laws.lugre import LuGre
from frictionlab.methods.reduced.stiff_bristle import StiffBristle
from frictionlab.methods.reduced.stiff_contact import AT_POINTS, LOOKED_AT, weight_after
from frictionlab.methods.shooting.method import Shooting
from frictionlab.orbit.panels import NODES
from frictionlab.scene.scene import Drive, Load, Scene, Transverse
from frictionlab.theory import friction_free_velocity
from frictionlab.theory.saturation import lost_on_reversal

RUNG = StiffBristle()
SHARES = (0.05, 0.4, 0.9, 0.99, 1.1)


def scenes_of(ratio=0.4, damping=0.1, frequency=1.0, **changes):
    """A scene of unit load at belt speeds in shares of V_lin; friction is ``ratio``."""
    values = {"damping_ratio": damping, "normal_load": ratio / 0.4, "belt_speed": 0.0}
    scene = Scene(**values, drive=Drive(amplitude=1.0, frequency=frequency), **changes)
    free = friction_free_velocity(scene)
    return [scene.at(share * free) for share in SHARES], free / frequency


LAWS = {
    "dahl": lambda length: Dahl(mu=0.4, presliding_length=length),
    "soft dahl": lambda length: Dahl(mu=0.4, presliding_length=length, exponent=0.5),
    "jenkins": lambda length: Jenkins(mu=0.4, presliding_length=length),
    "lugre": lambda length: LuGre(mu_kinetic=0.4, presliding_length=length),
    "damped lugre": lambda length: LuGre(mu_kinetic=0.4, presliding_length=length, damping=0.01 / length),
    "elasto-plastic": lambda length: ElastoPlastic(mu_kinetic=0.4, presliding_length=length),
}


@settings(max_examples=400 if DEEP else 12)
@given(
    ratio=st.floats(0.02, 1.2),
    damping=st.floats(0.05, 1.5),
    frequency=st.floats(0.3, 4.0),
    share=st.floats(-5.0, -1.0),
    name=st.sampled_from(["dahl", "jenkins", "damped lugre"]),
)
def test_the_error_covers_what_the_deflection_changes(ratio, damping, frequency, share, name):
    scenes, swing = scenes_of(ratio, damping, frequency)
    law = LAWS[name]((10.0 if name == "jenkins" else 1.0) * 10.0**share * swing)  # its swings at rest last
    ours, true = RUNG.solve(scenes, law, 1e-3), Shooting().solve(scenes, law, 1e-5)
    for i, status in enumerate(true.status):
        if status == "ok" and ours.status[i] == "ok":
            assert abs(ours.mean[i] - true.mean[i].real) <= ours.error[i] + true.error[i]


@pytest.mark.parametrize("name", LAWS)
def test_every_law_it_takes_is_covered_and_errors_fall_as_the_root_of_the_length(name):
    scenes, swing = scenes_of()
    errors = []
    for share in (1e-3, 1e-5):
        law = LAWS[name](share * swing)
        assert RUNG.takes(scenes[0], law)
        ours = RUNG.solve(scenes, law, 1e-3)
        errors.append(ours.error)
        if share == 1e-3 and name != "soft dahl":
            true = Shooting().solve(scenes, law, 1e-5)
            assert true.status == ours.status == ["ok"] * len(scenes)
            assert np.all(np.abs(ours.mean - true.mean.real) <= ours.error + true.error)
    if name == "damped lugre":  # as much damping over stiffness for both
        return
    falls = errors[0] / errors[1]  # a hundred times stiffer
    assert np.all((falls[:2] > 8.0) & (falls[:2] < 12.0))
    assert np.all(falls > 4.0)  # next to V_lin, where the mass rests for a moment
    assert np.all(errors[0] < 0.1)


def test_it_tells_what_coulomb_friction_cannot():
    scenes, swing = scenes_of()
    answers = RUNG.solve(scenes, LAWS["dahl"](1e-6 * swing), 1e-3)
    assert answers.error_kind == ["estimated"] * len(scenes)
    assert answers.floquet is None
    assert answers.unique is None
    assert not answers.balanced
    assert answers.orbit(0).stick is None


REFUSED = {
    "falling friction": (LuGre(mu_kinetic=0.4, mu_static=0.5, presliding_length=1e-4), {}),
    "viscosity": (LuGre(mu_kinetic=0.4, presliding_length=1e-4, viscosity=0.1), {}),
    "no memory": (Coulomb(mu=0.4), {}),
    "a limit never reached by a ductile contact": (Dahl(mu=0.4, presliding_length=1e-4, exponent=2.0), {}),
    "a load across": (
        LAWS["dahl"](1e-4),
        {"transverse": Transverse(natural_frequency=2.0, damping_ratio=0.1, load=Load(amplitude=1.0))},
    ),
    "no damping": (LAWS["dahl"](1e-4), {"damping": 0.0, "frequency": 1.3}),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_the_bound_does_not_cover_is_not_taken_or_never_within_a_tolerance(name):
    law, changes = REFUSED[name]
    scenes, _ = scenes_of(**changes)
    assert not RUNG.takes(scenes[0], law) or not RUNG.may_meet(scenes, law, 1e3)


def test_the_test_beforehand_never_says_no_to_an_error_within_the_tolerance():
    for ratio in (0.05, 0.4, 0.9):
        scenes, swing = scenes_of(ratio)
        for share in (1e-2, 1e-4, 1e-6):
            law = LAWS["dahl"](share * swing)
            error = float(RUNG.solve(scenes, law, 1e-3).error.max())
            assert RUNG.may_meet(scenes, law, error)
            assert not RUNG.may_meet(scenes, law, 1e-2 * error)


def test_the_loss_of_a_reversal():
    for exponent in (0.0, 0.5, 1.0):
        exact = 2.0 ** (2.0 - exponent) / (2.0 - exponent)
        law = Dahl(mu=0.4, presliding_length=0.01, exponent=exponent)
        assert lost_on_reversal(law) == pytest.approx(0.01 * exact, rel=1e-5)
    assert lost_on_reversal(LAWS["jenkins"](0.01)) == pytest.approx(0.02, rel=1e-12)
    assert 0.02 < lost_on_reversal(LAWS["elasto-plastic"](0.01)) < 0.022
    assert lost_on_reversal(Dahl(mu=0.4, presliding_length=0.01, exponent=2.0)) == math.inf


@pytest.mark.parametrize("damping", [0.2, 2.0, 3.0])
def test_the_weight_solves_its_equation(damping):
    times, step = np.linspace(0.1, 2.0, 7), 1e-4
    rows = np.array([[weight_after.py_func(damping, t + k * step) for k in (-1, 0, 1)] for t in times])
    before, now, after = rows[:, 0], rows[:, 1], rows[:, 2]
    first, second = (after - before) / (2.0 * step), (after - 2.0 * now + before) / step**2
    left = second - damping * first + now
    np.testing.assert_allclose(left[:, :2], np.broadcast_to([1.0, 0.0], (7, 2)), atol=1e-5)
    np.testing.assert_allclose(first[:, 1], now[:, 2], rtol=1e-6)


def test_panels_are_read_between_their_nodes_as_polynomials():
    for power in range(len(NODES)):
        np.testing.assert_allclose(AT_POINTS @ NODES**power, LOOKED_AT**power, atol=1e-12)
