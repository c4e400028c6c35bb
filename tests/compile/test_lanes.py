"""Numbers in lanes are computed with as numpy computes with arrays: every operator, with every kind of partner."""

from __future__ import annotations

import math
import operator
from typing import Any

import numpy as np
import pytest

from frictionlab.compile.decorators import inner, njit
from frictionlab.compile.interpret import interpreted, over_lanes
from frictionlab.compile.lane_arrays import (
    any_lane,
    lane,
    least_of_eight,
    read_lanes,
    room_for,
    select,
    with_lane,
    write_lanes,
)
from frictionlab.compile.lanes import LANE_COUNT

A = np.array([1.5, -2.0, 0.25, 3.0, -0.125, 7.0, 1e-3, -40.0])
B = np.array([0.5, 2.0, -0.75, 3.0, 4.0, -7.0, 2e3, 1.0])
PLANAR_A, PLANAR_B = A + 1j * B[::-1], B - 0.5j * A
NAMES = {"+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv}
COMPARISONS = operator.lt, operator.le, operator.gt, operator.ge, operator.eq, operator.ne
SIGNS = dict(zip(("<", "<=", ">", ">=", "==", "!="), COMPARISONS, strict=True))


def kernel_of(expression: str) -> Any:
    """A kernel that computes this of lanes a, b, planar p, q, a number x and a complex c, into two rows."""
    source = (
        "def computed(rows, x, c, out):\n"
        "    a, b = read_lanes(rows[0]), read_lanes(rows[1])\n"
        "    p, q = complex(a, read_lanes(rows[2])), complex(b, read_lanes(rows[3]))\n"
        f"    found = {expression}\n"
        "    write_lanes(out[0], found.real)\n"
        "    write_lanes(out[1], (found + 0j).imag)\n"
    )
    scope = {
        "read_lanes": read_lanes,
        "write_lanes": write_lanes,
        "select": select,
        "math": math,
        "__name__": "lanes_computed",
    }
    exec(source, scope)
    return njit(scope["computed"])


def computed(expression: str) -> np.ndarray:
    """What machine code and Python make of it, which must agree."""
    rows, found = np.array([A, B, PLANAR_A.imag, PLANAR_B.imag]), np.empty((2, 2, LANE_COUNT))
    kernel = kernel_of(expression)
    kernel(rows, 1.25, 0.5 - 2.0j, found[0])

    with np.errstate(all="ignore"):
        interpreted(over_lanes(kernel))(rows, 1.25, 0.5 - 2.0j, found[1])
    np.testing.assert_allclose(found[0], found[1], rtol=1e-14, atol=1e-14)
    return found[0, 0] + 1j * found[0, 1]


PARTNERS = {"a": A, "b": B, "p": PLANAR_A, "q": PLANAR_B, "x": 1.25, "c": 0.5 - 2.0j, "3": 3}


@pytest.mark.parametrize("sign", NAMES)
@pytest.mark.parametrize("left", PARTNERS)
def test_every_operator_with_every_partner(left, sign):
    rights = ["b", "q"] if left in "xc3" else PARTNERS
    expected = sum(NAMES[sign](PARTNERS[left], PARTNERS[right]) for right in rights)

    found = computed(" + ".join(f"({left} {sign} {right})" for right in rights))

    np.testing.assert_allclose(found, expected + 0j * A, rtol=1e-14, atol=1e-12)


@pytest.mark.parametrize("sign", SIGNS)
def test_every_comparison(sign):
    expected = sum(np.where(SIGNS[sign](A, other), 1.0, 2.0) for other in (B, 3.0))
    expected = expected + np.where(SIGNS[sign](1.5, A), PLANAR_A, B)

    found = computed(
        f"select(a {sign} b, 1.0, 2.0) + select(a {sign} 3.0, 1.0, 2.0) + select(1.5 {sign} a, p, b)"
    )

    np.testing.assert_array_equal(found, expected)


def test_what_is_not_a_number_differs_from_all_and_compares_with_none():
    nan = "(a - a) / (a - a)"
    assert (computed(f"select({nan} < b, 1.0, 0.0) + select({nan} >= b, 1.0, 0.0) + 0.0 * a") == 0.0).all()
    assert (computed(f"select({nan} != b, 1.0, 0.0) + 0.0 * a") == 1.0).all()


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("-a - (-p)", PLANAR_A - A),
        ("p.conjugate() * q + a.conjugate()", PLANAR_A.conjugate() * PLANAR_B + A),
        ("p.real * q.imag + a.real", PLANAR_A.real * PLANAR_B.imag + A),
        ("math.sqrt(a * a + b * b)", np.hypot(A, B)),
        ("min(a, b) + 2.0 * min(1.0, a)", np.minimum(A, B) + 2.0 * np.minimum(1.0, A)),
        ("max(a, b) + 2.0 * max(a, 0.5)", np.maximum(A, B) + 2.0 * np.maximum(A, 0.5)),
        ("select((a < b) & (a > 0.0), p, c) + select((a < b) | (a > 0.0), x, b)",
         np.where((A < B) & (A > 0), PLANAR_A, 0.5 - 2j) + np.where((A < B) | (A > 0), 1.25, B)),
    ],
)  # fmt: skip
def test_functions_and_choices(expression, expected):
    np.testing.assert_allclose(computed(expression), expected + 0j * A, rtol=1e-14, atol=1e-14)


@inner
def _halved(number):
    return 0.5 * number


@njit
def _one_by_one(row, out):
    """Every lane halved by itself; whether any is above 6, or above 60; how many fit."""
    lanes = read_lanes(row)
    found = lanes
    for k in range(LANE_COUNT):
        found = with_lane(found, k, _halved(lane(lanes, k)))
    write_lanes(out, found)
    return any_lane(lanes > 6.0), any_lane(lanes > 60.0), room_for(3)


def test_lanes_are_taken_apart_and_put_together():
    out = np.empty(LANE_COUNT)
    assert _one_by_one(A, out) == (True, False, LANE_COUNT)
    np.testing.assert_array_equal(out, 0.5 * A)


def test_rows_may_lie_anywhere():
    """numba aligns arrays to eight bytes alone."""
    numbers, out = np.arange(3.0 + LANE_COUNT), np.empty(1 + LANE_COUNT)
    _one_by_one(numbers[1 : 1 + LANE_COUNT], out[1:])
    np.testing.assert_array_equal(out[1:], 0.5 * numbers[1 : 1 + LANE_COUNT])


@njit
def _least(row, out):
    write_lanes(out, least_of_eight(read_lanes(row)))


def test_the_least_of_eight_is_in_every_lane():
    """On arrays, of every eight beside each other."""
    out, longer = np.empty(LANE_COUNT), np.empty(2 * LANE_COUNT)
    _least(A, out)
    interpreted(over_lanes(_least))(np.concatenate([A, B]), longer)
    assert (out == -40.0).all()
    assert longer.tolist() == [-40.0] * LANE_COUNT + [-7.0] * LANE_COUNT
