"""Numbers of laws, scenes and studies: real, finite, and nothing that merely converts to one."""

from __future__ import annotations

import math
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from frictionlab.values.notes import WrongValues
from frictionlab.values.quantities import Finite, NonNegative, Positive, Record


class Numbers(Record):
    """One of each kind."""

    any: Finite = 1.0
    none_below: NonNegative = 1.0
    above: Positive = 1.0


@given(value=st.floats(allow_nan=False, allow_infinity=False) | st.integers(-(2**60), 2**60))
def test_a_finite_number_is_taken_as_the_float_it_is(value):
    taken = Numbers(any=value).any

    assert type(taken) is float
    assert taken == float(value)


@pytest.mark.parametrize("value", [np.float64(2.5), np.float32(2.5), np.int32(2), Fraction(5, 2)])
def test_real_numbers_of_other_libraries_are_numbers(value):
    taken = Numbers(above=value).above

    assert type(taken) is float
    assert taken == float(value)


@pytest.mark.parametrize(
    "value", ["1.0", b"1", True, False, np.bool_(True), None, [1.0], {}, 1j, Decimal(1), np.ones(1)]
)
@pytest.mark.parametrize("field", ["any", "none_below", "above"])
def test_what_is_no_real_number_is_refused(field, value):
    with pytest.raises(WrongValues, match=rf"Numbers: {field}: must be a number, got"):
        Numbers(**{field: value})


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, np.float64("nan")])
@pytest.mark.parametrize("field", ["any", "none_below", "above"])
def test_nan_and_infinity_are_refused(field, value):
    with pytest.raises(WrongValues, match=rf"Numbers: {field}: must be (a finite number|>=? 0), got"):
        Numbers(**{field: value})


@pytest.mark.parametrize(
    ("field", "value", "words"),
    [
        ("none_below", -1e-300, "must be >= 0, got -1e-300"),
        ("above", 0.0, "must be > 0, got 0"),
        ("above", -0.0, "must be > 0, got 0"),
        ("above", -1.0, "must be > 0, got -1"),
    ],
)
def test_the_sign_is_checked(field, value, words):
    with pytest.raises(WrongValues, match=words):
        Numbers(**{field: value})


def test_the_limits_themselves_are_allowed_where_they_should_be():
    assert Numbers(none_below=0.0).none_below == 0.0
    assert Numbers(above=5e-324).above == 5e-324
    assert Numbers(any=-1.0).any == -1.0


def test_a_record_is_frozen_and_refuses_keys_it_does_not_know():
    record = Numbers()

    with pytest.raises(AttributeError, match="cannot be changed"):
        record.any = 2.0
    with pytest.raises(WrongValues, match="wobble: unknown key; allowed: any, none_below, above"):
        Numbers(wobble=1.0)
    assert hash(Numbers()) == hash(record)
    assert Numbers() == record
    assert Numbers(any=2.0) != record
