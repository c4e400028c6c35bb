"""Every registered law: symmetry, dimension, compilation, what it declares and what it refuses."""

from __future__ import annotations

import cmath
import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from strategies import LAWS, angles, speeds, velocities, velocities_on_the_line

from frictionlab.kernel import compiled, njit
from frictionlab.laws.coulomb import Coulomb
from frictionlab.registry import law_class, law_names

every_law = pytest.mark.parametrize("name", LAWS)
EXACT = 1e-12  # relative: a thousand roundings


@njit
def vectors(law, v, out):
    for i in range(v.size):
        out[i] = law.sliding_vector(v[i])


@njit
def coefficients(law, speed, out):
    for i in range(speed.size):
        out[i] = law.sliding_friction(speed[i])


def dot(a: complex, b: complex) -> float:
    return (a * b.conjugate()).real


def test_every_law_of_ours_is_tested_here():
    ours = {name for name in law_names() if law_class(name).__module__.startswith("frictionlab.")}

    assert ours == set(LAWS)


@every_law
def test_the_registered_name_is_the_name_of_the_class_and_of_its_file(name):
    kind = law_class(name)

    assert kind.__module__ == f"frictionlab.laws.{name}"
    assert kind.__name__.lower() == name.replace("_", "")


@every_law
@given(data=st.data(), v=velocities)
def test_friction_turns_round_with_the_slip(name, data, v):
    law = data.draw(LAWS[name])

    assert law.sliding_vector(-v) == pytest.approx(-law.sliding_vector(v), rel=EXACT)
    assert law.sliding_vector(-abs(v)) == -law.sliding_vector(abs(v))


@every_law
@given(data=st.data(), v=velocities, angle=angles)
def test_friction_turns_with_the_slip_and_is_mirrored_with_it(name, data, v, angle):
    law, turn = data.draw(LAWS[name]), cmath.rect(1.0, angle)
    friction = law.sliding_vector(v)

    assert law.sliding_vector(turn * v) == pytest.approx(turn * friction, rel=EXACT)
    assert law.sliding_vector((turn * v).conjugate()) == pytest.approx(
        (turn * friction).conjugate(), rel=EXACT
    )


@every_law
@given(data=st.data(), v=velocities_on_the_line)
def test_slip_along_the_line_is_the_one_dimensional_law_with_nothing_across(name, data, v):
    law = data.draw(LAWS[name])
    planar, scalar = law.sliding_vector(complex(v, 0.0)), law.sliding_vector(v)

    assert planar.real == scalar
    assert planar.imag == 0.0
    assert isinstance(scalar, float)


@every_law
@given(data=st.data(), v=velocities)
def test_friction_points_along_the_slip_with_the_length_of_the_coefficient(name, data, v):
    law = data.draw(LAWS[name])
    friction, coefficient = law.sliding_vector(v), law.sliding_friction(abs(v))

    assert abs(friction) == pytest.approx(coefficient, rel=EXACT)
    assert dot(friction, v) == pytest.approx(coefficient * abs(v), rel=EXACT)
    assert coefficient > 0.0


@every_law
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


@every_law
@given(data=st.data())
def test_interpreted_and_compiled_coefficients_agree_to_rounding(name, data):
    law = data.draw(LAWS[name])
    speed = np.array(data.draw(st.lists(speeds | st.just(0.0), min_size=1, max_size=20)))
    interpreted, machine = np.empty_like(speed), np.empty_like(speed)
    coefficients.py_func(law, speed, interpreted)
    compiled(coefficients, law)(speed, machine)

    np.testing.assert_allclose(machine, interpreted, rtol=1e-14)


@every_law
@given(data=st.data(), v=velocities, w=velocities)
def test_a_law_that_calls_itself_monotone_never_lets_friction_fall_as_slip_grows(name, data, v, w):
    law = data.draw(LAWS[name])
    if law.monotone():
        work = dot(law.sliding_vector(v) - law.sliding_vector(w), v - w)
        scale = max(law.sliding_friction(abs(v)), law.sliding_friction(abs(w))) * (abs(v) + abs(w))

        assert work >= -EXACT * scale


@every_law
@given(data=st.data(), slow=speeds | st.just(0.0), fast=speeds)
def test_a_law_that_calls_its_friction_constant_has_one_coefficient_at_all_speeds(name, data, slow, fast):
    law = data.draw(LAWS[name])
    if law.constant_sliding_friction():
        assert law.sliding_friction(slow) == law.sliding_friction(fast)


@given(data=st.data(), v=velocities, share=st.floats(0.0, 1.0), angle=angles)
def test_coulomb_friction_dissipates_more_than_any_other_force_within_its_limit(data, v, share, angle):
    law = data.draw(LAWS["coulomb"])
    other = cmath.rect(share * law.sliding_friction(0.0), angle)

    assert dot(law.sliding_vector(v), v) >= dot(other, v) * (1.0 - math.copysign(EXACT, dot(other, v)))


def test_coulomb_declares_constant_and_monotone_friction():
    law = Coulomb(mu=0.3)

    assert law.constant_sliding_friction()
    assert law.monotone()
    assert law.numbers() == {"mu": 0.3}
    assert law.sliding_vector(-7.0) == pytest.approx(-0.3, rel=1e-15)


@every_law
@given(data=st.data())
def test_a_law_is_frozen_hashes_and_survives_pickling(name, data):
    law = data.draw(LAWS[name])
    twin = pickle.loads(pickle.dumps(law))

    assert twin == law
    assert hash(twin) == hash(law)
    assert type(twin) is type(law)
    for field in type(law).model_fields:
        with pytest.raises(ValidationError, match="frozen"):
            setattr(law, field, 1.0)


@every_law
def test_an_unknown_parameter_is_refused_by_its_name(name):
    with pytest.raises(ValidationError, match="wobble"):
        law_class(name)(**dict.fromkeys(law_class(name).model_fields, 1.0), wobble=1.0)


@every_law
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, "0.4", True, None, [0.4], 1j])
def test_what_is_no_finite_number_is_refused_by_the_name_of_its_parameter(name, value):
    fields = law_class(name).model_fields
    for field in fields:
        with pytest.raises(ValidationError) as caught:
            law_class(name)(**{**dict.fromkeys(fields, 1.0), field: value})
        assert [problem["loc"] for problem in caught.value.errors()] == [(field,)]


@pytest.mark.parametrize("mu", [0.0, -0.0, -0.4])
def test_a_friction_coefficient_that_is_not_positive_is_refused(mu):
    with pytest.raises(ValidationError, match="mu"):
        Coulomb(mu=mu)


@pytest.mark.parametrize("mu", [1, np.float64(0.25), np.int64(2), np.float32(0.5)])
def test_numbers_of_other_kinds_become_floats(mu):
    law = Coulomb(mu=mu)

    assert type(law.mu) is float
    assert law.mu == float(mu)


def test_a_missing_parameter_is_named():
    with pytest.raises(ValidationError, match="mu\n"):
        Coulomb()


def test_the_static_coefficient_has_not_come_yet():
    with pytest.raises(ValidationError, match="mu_static: not available yet"):
        Coulomb(mu=0.4, mu_static=0.5)
