"""Two laws are one where no number of theirs differs."""

from __future__ import annotations

import itertools

import pytest

import frictionlab as fl
from frictionlab.laws.base import FrictionLaw
from frictionlab.runner.batch import are_one_law

BRISTLE = {"mu_kinetic": 0.4, "presliding_length": 0.5}
ONE: list[tuple[FrictionLaw, FrictionLaw]] = [
    (fl.Coulomb(mu=0.4), fl.Stribeck(mu_kinetic=0.4, mu_static=0.4)),
    (fl.Dahl(mu=0.4, presliding_length=0.5), fl.LuGre(**BRISTLE)),
    (fl.Dahl(mu=0.4, presliding_length=0.5), fl.Dahl(mu=0.4, stiffness=0.8)),
    (fl.Jenkins(mu=0.4, presliding_length=0.5), fl.Dahl(mu=0.4, presliding_length=0.5, exponent=0.0)),
]
DIFFERENT: list[FrictionLaw] = [
    fl.Coulomb(mu=0.4),
    fl.Coulomb(mu=0.4, mu_static=0.5),
    fl.Stribeck(mu_kinetic=0.4, mu_static=0.4, viscosity=1e-6),
    fl.Dahl(mu=0.4, presliding_length=0.5),
    fl.Dahl(mu=0.4, presliding_length=0.5, exponent=1.001),
    fl.Jenkins(mu=0.4, presliding_length=0.5),
    fl.LuGre(**BRISTLE, damping=1e-6),
    fl.LuGre(**BRISTLE, mu_static=0.401, stribeck_speed=1e-4),
    fl.ElastoPlastic(**BRISTLE, breakaway_ratio=0.7),
    fl.ElastoPlastic(**BRISTLE, breakaway_ratio=0.99),
]


@pytest.mark.parametrize("laws", ONE, ids=lambda laws: type(laws[1]).__name__)
def test_a_law_by_another_name_is_the_same_law(laws: tuple[FrictionLaw, FrictionLaw]) -> None:
    assert are_one_law(*laws)


def test_laws_that_differ_by_little_are_not_one() -> None:
    assert [pair for pair in itertools.combinations(DIFFERENT, 2) if are_one_law(*pair)] == []
