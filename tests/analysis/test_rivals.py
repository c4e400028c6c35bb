"""What docs/rivals.md says of other models that make the concave curve of a resonant body."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from profiles import deep
from rivals_figures import (
    COULOMB,
    MU,
    REFERENCES,
    SPEEDS,
    body,
    means,
    nearest_linear,
    no_slip_is_nearer,
    under_slip,
    with_term,
)

import frictionlab as fl

RESONANT = "resonant Coulomb body"


@deep("seconds of search")
@pytest.mark.parametrize(
    ("terms", "free", "found"),
    [
        (
            {"fractional": fl.Fractional(coefficient=0.25, order=0.9)},
            {"scene.body.fractional.coefficient": (0.15, 0.3), "scene.body.fractional.order": (0.8, 1.0)},
            [0.2, 1.0],
        ),
        ({"cubic_stiffness": 1e-6}, {"scene.body.cubic_stiffness": (-2e-6, 1e-5)}, [0.0]),
    ],
)
def test_a_rival_that_holds_the_linear_body_finds_it(terms: Any, free: Any, found: list[float]) -> None:
    """A fractional element of order 1 is the dashpot, and no cubic term is none."""
    scene = body(1, 10, damping=0.0 if "fractional" in terms else 0.1, **terms)
    near = fl.equivalent(REFERENCES[RESONANT], (scene, COULOMB, free), SPEEDS[::4], starts=1)

    assert [*near.values.values()] == pytest.approx(found, rel=1e-4, abs=1e-7)
    assert near.distance <= near.distance_error + 1e-8


@deep("seconds of search")
def test_a_dahl_contact_is_known_to_be_no_nearer_than_it_is_found() -> None:
    least = no_slip_is_nearer(RESONANT, 20, 60)
    apart = means(*under_slip(50.88, 54.5), SPEEDS) - means(*REFERENCES[RESONANT], SPEEDS)

    assert 0.02 < least < np.abs(apart).max() < 0.028


@deep("seconds of search")
@pytest.mark.parametrize(("kind", "apart"), [("fractional", 2e-4), ("dashpot that grows", 1e-3)])
def test_a_linear_body_makes_the_curve_of_one_that_remembers_or_bends(kind: str, apart: float) -> None:
    assert nearest_linear(with_term(kind, 1.0)).distance / MU < apart
