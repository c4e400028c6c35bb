"""Numbers written with their errors: as many digits as the error leaves, and nothing outside what is written."""

from __future__ import annotations

import math
import re
from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from frictionlab.values.printable import with_error


@pytest.mark.parametrize(
    ("value", "error", "written"),
    [
        (0.0577, 2e-4, "0.0577 ± 0.0002"),
        (0.057711, 1.31e-4, "0.05771 ± 0.00014"),
        (0.12, 0.003, "0.120 ± 0.003"),
        (9.996, 0.0096, "9.9960 ± 0.0096"),
        (-0.2732, 0.336, "-0.27 ± 0.34"),
        (1.2e-4, 3e-3, "0.0001 ± 0.0031"),
        (1234567.0, 300.0, "1234570 ± 310"),
        (1.23456e-7, 4e-9, "(1.235 ± 0.041)e-7"),
        (0.0, 3e-15, "(0 ± 3)e-15"),
        (0.1, math.inf, "0.1 ± inf"),
    ],
)
def test_a_number_has_the_digits_that_its_error_leaves(value: float, error: float, written: str) -> None:
    assert with_error(value, error) == written


@pytest.mark.parametrize(
    ("value", "error"), [(0.0505839238363, 3e-15), (0.0505839, math.nan), (0.0505839, None)]
)
def test_a_number_whose_error_is_below_its_last_digit_or_unknown_stands_alone(
    value: float, error: float | None
) -> None:
    assert with_error(value, error) == "0.0505839"


def test_more_digits_show_a_smaller_error() -> None:
    assert with_error(0.0505839238363, 3e-12, 12) == "0.0505839238363 ± 3e-12"


def test_there_is_nothing_to_write_of_no_number() -> None:
    assert with_error(math.nan, 0.1) == ""


@given(
    st.floats(-1e9, 1e9).filter(lambda value: value == 0.0 or abs(value) > 1e-12),
    st.floats(1e-18, 1e6),
    st.sampled_from([6, 12]),
)
def test_what_is_written_encloses_what_was_given(value: float, error: float, most: int) -> None:
    found = re.fullmatch(r"\(?(\S+) ± ([^)]+)\)?(e-?\d+)?", with_error(value, error, most))
    if found is None:
        assert error <= 0.5 * 10.0 ** (math.floor(math.log10(abs(value))) + 1 - most) * (1 + 1e-9)
        return
    power = found[3] or "" if found[0].startswith("(") else ""
    middle, bound = Decimal(found[1] + power), Decimal(found[2] + power)
    exact, allowed = Decimal(repr(value)), Decimal(repr(error))
    assert abs(middle - exact) + allowed <= bound * Decimal("1.00000001")
