"""Deflections that end at their limit: which laws have them, and how fast the limit is approached."""

from __future__ import annotations

import math
from typing import Any

import pytest

import frictionlab as fl
from frictionlab.theory.sliding_stability import SHORT, remaining_share, saturates

SOFT: Any = {"presliding_length": 0.1, "planar": "rotated"}


@pytest.mark.parametrize(
    "law", [fl.Dahl(mu=0.4, **SOFT), fl.Jenkins(mu=0.4, **SOFT), fl.LuGre(mu_kinetic=0.4, **SOFT)]
)
def test_a_deflection_along_the_slip_with_one_sliding_friction_ends_at_its_limit(law: fl.BristleLaw) -> None:
    assert saturates(law)


@pytest.mark.parametrize(
    "law",
    [
        fl.Coulomb(mu=0.4),
        fl.Dahl(mu=0.4, presliding_length=0.1),
        fl.Dahl(mu=0.4, presliding_length=0.1, planar="per-axis"),
        fl.LuGre(mu_kinetic=0.4, mu_static=0.6, stribeck_speed=1.0, **SOFT),
    ],
)
def test_no_other_does(law: fl.FrictionLaw) -> None:
    assert not saturates(law)


def test_what_a_deflection_lacks_decays_along_the_path_as_the_law_says() -> None:
    law = fl.Dahl(mu=0.4, **SOFT)

    assert float(remaining_share(law, 0.25)) == pytest.approx(math.exp(-2.5), rel=1e3 * SHORT)
