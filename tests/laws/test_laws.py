"""Every registered law: symmetry, dimension, compilation, what it declares and what it refuses."""

from __future__ import annotations

import math

import numpy as np
import pytest
from broken_laws.case import OF_EVERY_LAW
from hypothesis import assume, given
from hypothesis import strategies as st
from profiles import DEEP
from strategies import BRISTLE_LAWS, EXAMPLES, LAWS, velocities, velocities_on_the_line

from frictionlab.compile.cache import compiled
from frictionlab.compile.decorators import njit
from frictionlab.laws.base import SlidingLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.stribeck import Stribeck
from frictionlab.study.registry import law_class, law_names
from frictionlab.testing import check_law
from frictionlab.values.notes import WrongValues

every_law = pytest.mark.parametrize("name", LAWS)


@njit
def vectors(law, v, out):
    for i in range(v.size):
        out[i] = law.sliding_vector(v[i])


def test_every_law_of_ours_is_tested_here():
    ours = {kind for kind in map(law_class, law_names()) if kind.__module__.startswith("frictionlab.")}

    assert ours == {law_class(name) for name in LAWS}
    assert {name for name in LAWS if issubclass(law_class(name), SlidingLaw)} == set(LAWS) - set(BRISTLE_LAWS)


def test_elasto_plastic_friction_goes_by_the_name_of_its_author_too():
    assert law_class("dupont") is law_class("elasto-plastic")


@every_law
def test_the_registered_name_is_the_name_of_the_class_and_of_its_file(name):
    kind = law_class(name)

    assert kind.__module__ == f"frictionlab.laws.{name.replace('-', '_')}"
    assert kind.__name__.lower() == name.replace("-", "")


@every_law
def test_the_law_conforms(name):
    """Symmetry, units and all that it declares: what the battery asks of any law in Python."""
    check_law(law_class(name), only=OF_EVERY_LAW, examples=12 if DEEP else 4)


@pytest.mark.parametrize("name", [name for name in LAWS if name not in BRISTLE_LAWS])
@pytest.mark.parametrize("kind", [float, complex])
@given(data=st.data())
def test_interpreted_and_compiled_friction_agree_to_rounding(name, kind, data):
    law = data.draw(LAWS[name])
    slips = velocities if kind is complex else velocities_on_the_line
    v = np.array(data.draw(st.lists(slips, min_size=1, max_size=20)), dtype=kind)
    interpreted, machine = np.empty_like(v), np.empty_like(v)
    vectors.py_func(law, v, interpreted)
    compiled(vectors, law)(v, machine)

    assert np.all(np.abs(machine - interpreted) <= 1e-14 * np.abs(interpreted))


def test_coulomb_declares_constant_and_monotone_friction():
    law = Coulomb(mu=0.3)

    assert law.constant_sliding_friction()
    assert law.monotone()
    assert law.numbers() == {"mu": 0.3, "at_rest": 0.3}
    assert law.sliding_vector(-7.0) == pytest.approx(-0.3, rel=1e-15)


@every_law
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, "0.4", True, [0.4], 1j])
def test_what_is_no_finite_number_is_refused_by_the_name_of_its_parameter(name, value):
    given_ = EXAMPLES[name].model_dump()
    for field in [field for field, number in given_.items() if isinstance(number, float)]:
        with pytest.raises(WrongValues) as caught:
            law_class(name)(**{**given_, field: value})
        assert [mistake.path for mistake in caught.value.mistakes] == [field]


@pytest.mark.parametrize("mu", [0.0, -0.0, -0.4])
def test_a_friction_coefficient_that_is_not_positive_is_refused(mu):
    with pytest.raises(WrongValues, match="mu: must be > 0"):
        Coulomb(mu=mu)


@pytest.mark.parametrize("mu", [1, np.float64(0.25), np.int64(2), np.float32(0.5)])
def test_numbers_of_other_kinds_become_floats(mu):
    law = Coulomb(mu=mu)

    assert type(law.mu) is float
    assert law.mu == float(mu)


def test_a_missing_parameter_is_named():
    with pytest.raises(WrongValues, match="Coulomb: mu: required key is missing"):
        Coulomb()


def test_rest_cannot_hold_less_than_slip():
    with pytest.raises(WrongValues, match=r"mu_static: must be >= mu = 0\.4, got 0\.3"):
        Coulomb(mu=0.4, mu_static=0.3)
    with pytest.raises(WrongValues, match=r"mu_static: must be >= mu_kinetic = 0\.4, got 0\.3"):
        Stribeck(mu_kinetic=0.4, mu_static=0.3)


def test_a_higher_coefficient_at_rest_is_a_jump():
    law = Coulomb(mu=0.4, mu_static=0.5)

    assert law.static_friction() == 0.5
    assert law.sliding_friction(0.0) == 0.4
    assert law.steepest_fall() == math.inf
    assert law.constant_sliding_friction()
    assert not law.monotone()


@given(data=st.data())
def test_the_steepest_fall_of_a_curve_is_met_somewhere_on_it(data):
    law = data.draw(LAWS["stribeck"])
    bound = law.steepest_fall()
    assume(0.0 < bound < math.inf)
    u = np.linspace(0.0, 2.0, 4001) * law.stribeck_speed
    friction = np.array([law.sliding_friction(float(speed)) for speed in u])

    own = (
        -np.diff(friction) / np.diff(u)
    ).max() + law.viscosity  # of the curve: viscosity may all but undo it
    assert own >= 0.99 * (bound + law.viscosity) - 1e-9 * friction.max() / law.stribeck_speed


@pytest.mark.parametrize(
    ("curve", "half", "far"),
    [
        ("exponential", 0.2 + 0.2 * math.exp(-0.25), 0.2),
        ("hyperbolic", 0.2 + 0.2 / 1.5, 0.2),
        ("hess-soom", 0.2 + 0.2 / 1.25, 0.2),
    ],
)
def test_each_curve_runs_from_static_to_kinetic_friction_as_published(curve, half, far):
    law = Stribeck(mu_kinetic=0.2, mu_static=0.4, stribeck_speed=2.0, curve=curve)

    assert law.sliding_friction(0.0) == pytest.approx(0.4, rel=1e-15)
    assert law.sliding_friction(1.0) == pytest.approx(half, rel=1e-15)
    assert law.sliding_friction(1e9) == pytest.approx(far, rel=1e-8)


def test_the_cubic_curve_has_its_minimum_at_the_stribeck_speed():
    # mu(v) = mu_s - k1 v + k3 v^3, k1 = (3/2)(mu_s - mu_m)/v_m, k3 = (1/2)(mu_s - mu_m)/v_m^3 (Thomsen 1999)
    law = Stribeck(mu_kinetic=0.25, mu_static=0.4, stribeck_speed=0.5, curve="cubic")
    k1, k3 = 1.5 * 0.15 / 0.5, 0.5 * 0.15 / 0.5**3

    for v in (0.0, 0.1, 0.3, 0.5, 0.8):
        assert law.sliding_friction(v) == pytest.approx(0.4 - k1 * v + k3 * v**3, rel=1e-14)
    assert law.sliding_friction(0.5) == pytest.approx(0.25, rel=1e-14)
    assert min(law.sliding_friction(0.499), law.sliding_friction(0.501)) > 0.25


def test_only_the_exponential_curve_has_an_exponent():
    with pytest.raises(WrongValues, match="stribeck_exponent: leave it out, the cubic curve has none"):
        Stribeck(mu_kinetic=0.2, mu_static=0.4, curve="cubic", stribeck_exponent=1.0)
    assert Stribeck(mu_kinetic=0.2, mu_static=0.4).stribeck_exponent == 2.0


def test_enough_viscosity_makes_a_falling_curve_monotone():
    falling = Stribeck(mu_kinetic=0.2, mu_static=0.4, curve="hyperbolic")
    made_up_for = Stribeck(mu_kinetic=0.2, mu_static=0.4, curve="hyperbolic", viscosity=0.2)

    assert falling.steepest_fall() == pytest.approx(0.2)
    assert not falling.monotone()
    assert made_up_for.monotone()
