"""Level lines by roots: every place on the line, turning points and pieces, errors that cover."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from frictionlab.curves.level_lines import LevelLine, level_lines
from frictionlab.values.quantities import Floats


def lines_of(
    value: Callable[[Floats, Floats], Floats], bound: float = 0.0, size: int = 11
) -> list[LevelLine]:
    def function(places: Floats) -> tuple[Floats, Floats]:
        return value(*places.T), np.full(len(places), bound)

    x, y = np.meshgrid(np.arange(size, dtype=float), np.arange(size, dtype=float))
    return level_lines(function, value(x, y))


@given(st.floats(2.6, 4.4), st.floats(1.6, 4.4), st.floats(-0.4, 0.4), st.floats(-0.4, 0.4))
@example(2.6, 2.6, 0.0, 0.4)
def test_an_ellipse_is_one_closed_line_with_every_turning_point(
    a: float, b: float, x0: float, y0: float
) -> None:
    (line,) = lines_of(lambda x, y: ((x - 5.0 - x0) / a) ** 2 + ((y - 5.0 - y0) / b) ** 2 - 1.0)
    x, y = (line.places - [5.0 + x0, 5.0 + y0]).T

    assert line.closed
    np.testing.assert_allclose((x / a) ** 2 + (y / b) ** 2, 1.0, atol=1e-6)
    for reached, half in ((x, a), (y, b)):
        assert np.abs([reached.min() + half, reached.max() - half]).max() < 0.05
    turned = np.unwrap(np.arctan2(y / b, x / a))  # once round, in order; twice at a corner of the grid
    assert np.all(np.diff(turned) >= 0.0) or np.all(np.diff(turned) <= 0.0)
    assert abs(turned[-1] - turned[0]) == pytest.approx(2.0 * np.pi)


def test_two_branches_of_a_saddle_are_two_pieces_and_end_at_the_rim() -> None:
    for sign in (-1.0, 1.0):
        lines = lines_of(lambda x, y, sign=sign: (x - 5.3) * (y - 4.4) - sign * 0.05)
        assert [line.closed for line in lines] == [False, False]
        ends = np.array([line.places[[0, -1]] for line in lines])
        assert np.all(np.any((ends < 1e-9) | (ends > 10.0 - 1e-9), axis=2))
        for line in lines:
            x, y = (line.places - [5.3, 4.4]).T
            np.testing.assert_allclose(x * y, sign * 0.05, atol=1e-6)
            assert len(set(np.sign(x[np.abs(x) > 0.01]))) == 1  # the branches do not mix


def test_a_line_ends_where_the_function_has_no_value() -> None:
    lines = lines_of(lambda x, y: np.where(x < 4.5, y - 3.3, np.nan))

    assert [line.places[:, 0].max() for line in lines] == [4.0]


@given(st.floats(0.1, 2.0), st.floats(0.1, 2.0), st.floats(1e-6, 0.1))
def test_errors_cover_what_an_error_of_the_function_moves_the_line_by(
    a: float, b: float, bound: float
) -> None:
    (line,) = lines_of(lambda x, y: a * (x - 4.6) + b * (y - 5.2), bound)
    moved = (line.places - [4.6, 5.2]) @ [a, b] + line.errors @ [a, b]

    np.testing.assert_allclose(moved, bound, rtol=1e-4, atol=1e-6)


def test_without_a_change_of_sign_there_is_no_line() -> None:
    assert lines_of(lambda x, y: 1.0 + x + y) == []


@given(st.floats(3.2, 6.8), st.floats(3.2, 6.8), st.floats(0.12, 0.45))
def test_a_line_that_crosses_no_edge_of_the_grid_is_seen(x0: float, y0: float, radius: float) -> None:
    lines = lines_of(lambda x, y: np.hypot(x - x0, y - y0) ** 2 - radius**2)

    assert [line.closed for line in lines] == [True]
    np.testing.assert_allclose(np.hypot(*(lines[0].places - [x0, y0]).T), radius, atol=1e-6)


def test_values_of_the_grid_beside_a_line_are_found_anew_and_places_asked_for_once() -> None:
    asked: list[tuple[float, ...]] = []

    def function(places: Floats) -> tuple[Floats, Floats]:
        asked.extend(map(tuple, np.round(places, 12).tolist()))
        return places[:, 1] - 4.1 - 0.2 * np.sin(places[:, 0]), np.zeros(len(places))

    y = np.repeat(np.arange(9.0), 9).reshape(9, 9)
    (line,) = level_lines(function, y - 3.3)  # the grid is wrong by 0.8 and 0.2 more

    np.testing.assert_allclose(line.places[:, 1], 4.1 + 0.2 * np.sin(line.places[:, 0]), atol=1e-6)
    assert {*line.places[[0, -1], 0]} == {0.0, 8.0}
    assert len(asked) == len(set(asked)) < 25 * len(line.places)
