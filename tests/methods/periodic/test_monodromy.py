"""The derivative of the period map over the same steps, against difference quotients of much finer maps."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from profiles import deep

import frictionlab as fl
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.methods.periodic.continuation import DIFFERENTIATED
from frictionlab.methods.periodic.problem import PeriodicProblem

SCENE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
ACROSS = fl.Transverse(natural_frequency=0.7, damping_ratio=0.1, load=fl.Load(unbalance=6))
DAHL = fl.Dahl(mu=0.4, presliding_length=0.5)
LUGRE = fl.LuGre(mu_kinetic=0.25, mu_static=0.4, stribeck_speed=10, presliding_length=0.1)
DUPONT = ElastoPlastic(mu_kinetic=0.4, presliding_length=1.0)


def by_quotients(problem: PeriodicProblem, belt_speed: float, state: Any) -> Any:
    """Central, of maps at a ten-thousandth of the shift's square."""
    shift, columns = 1e-4, []
    for unit in np.eye(state.size):
        ends = [
            problem._iterate(belt_speed, state + side * shift * unit, 1, 1e-12).state for side in (1.0, -1.0)
        ]
        columns.append((ends[0] - ends[1]) / (2.0 * shift))
    return np.array(columns).T


@pytest.mark.parametrize(
    ("law", "planar"),
    [
        pytest.param(DAHL, False, id="exact path"),
        pytest.param(LUGRE, False, id="memory"),
        pytest.param(DUPONT, True, id="events in the plane", marks=deep("more kernels to compile")),
    ],
)
@pytest.mark.parametrize("belt_speed", [2.0, 20.0])
def test_the_monodromy_is_that_of_finer_maps(law: Any, planar: bool, belt_speed: float) -> None:
    scene = SCENE.model_copy(update={"belt_speed": belt_speed, "transverse": ACROSS if planar else None})
    problem = PeriodicProblem(scene, law, 1e-6)
    curve, _ = problem.close([scene], wanted=DIFFERENTIATED)

    expected = by_quotients(problem, belt_speed, curve.states[0])

    found, known = (np.abs(np.linalg.eigvals(each)).max() for each in (curve.matrices[0], expected))
    assert found == pytest.approx(known, abs=1e-5)
    assert curve.matrices[0] == pytest.approx(expected, abs=3e-4)
