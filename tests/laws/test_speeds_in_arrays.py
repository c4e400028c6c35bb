"""Laws called in Python take arrays of speeds, number by number; their classes keep the method that is compiled."""

from __future__ import annotations

from types import FunctionType

import numpy as np
import pytest

import frictionlab as fl

LAWS = [
    fl.Coulomb(mu=0.4),
    fl.Stribeck(mu_kinetic=0.2, mu_static=0.4, stribeck_speed=2, viscosity=0.01),
    fl.Stribeck(mu_kinetic=0.2, mu_static=0.4, curve="cubic"),
    fl.Dahl(mu=0.4, stiffness=40),
    fl.Jenkins(mu=0.4, stiffness=40),
    fl.LuGre(mu_kinetic=0.2, mu_static=0.4, stiffness=40, damping=0.1),
    fl.ElastoPlastic(mu_kinetic=0.2, mu_static=0.4, stiffness=40),
]


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_an_array_is_taken_number_by_number(law: fl.FrictionLaw) -> None:
    speeds = np.array([[0.0, 0.5, 1.0], [2.0, 3.0, 40.0]])

    at_once = law.sliding_friction(speeds)  # type: ignore[arg-type]  # the interface is that of one speed

    assert np.array_equal(at_once, [[law.sliding_friction(v) for v in row] for row in speeds.tolist()])


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_slip_in_the_plane_is_taken_number_by_number(law: fl.FrictionLaw) -> None:
    slips = [1.0 + 1.0j, -2.0 + 0.5j, 3.0j]

    at_once = law.sliding_vector(slips)  # type: ignore[arg-type]  # the interface is that of one slip

    assert np.array_equal(at_once, [law.sliding_vector(v) for v in slips])
    assert np.allclose(np.abs(at_once), law.sliding_friction(np.abs(slips)), rtol=1e-14)


def test_the_class_has_the_method_that_is_compiled() -> None:
    assert isinstance(fl.Stribeck.sliding_friction, FunctionType)
    assert isinstance(LAWS[1].sliding_friction(1.0), float)
