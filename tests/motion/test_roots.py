"""Zeros of many monotone functions at once."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from frictionlab.methods.reduced.harmonic_balance import monotone_root


@given(st.lists(st.floats(-0.99, 0.99), min_size=1, max_size=9))
def test_roots_of_monotone_functions_are_found_to_rounding(targets: list[float]) -> None:
    wanted = np.array(targets)

    found = monotone_root(
        lambda x, at: np.tanh(3 * (x - at)), np.full(len(wanted), -1.0), np.full(len(wanted), 1.0), wanted
    )

    np.testing.assert_allclose(found, wanted, rtol=1e-15, atol=1e-15)


def test_without_a_crossing_the_nearer_end_is_given() -> None:
    found = monotone_root(
        lambda x, at: x + at, np.full(3, -1.0), np.full(3, 1.0), np.array([3.0, -3.0, -1.0])
    )

    np.testing.assert_array_equal(found, [-1.0, 1.0, 1.0])
