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
            problem.followed_on(belt_speed, state + side * shift * unit, 1, 1e-12).state
            for side in (1.0, -1.0)
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


@pytest.mark.parametrize("law", [pytest.param(DAHL, id="exact path"), pytest.param(LUGRE, id="memory")])
@pytest.mark.parametrize("belt_speed", [2.0, 20.0])
def test_the_multiplier_of_the_table_is_within_its_error(law: Any, belt_speed: float) -> None:
    scene = SCENE.model_copy(update={"belt_speed": belt_speed})
    row = fl.curve(scene, law, [belt_speed], "shooting", 1e-8, columns=["floquet", "floquet_error"]).iloc[0]
    problem = PeriodicProblem(scene, law.under_load(10.0), 1e-10)
    curve, _ = problem.close([scene], wanted=DIFFERENTIATED)

    known = np.abs(np.linalg.eigvals(by_quotients(problem, belt_speed, curve.states[0]))).max()

    assert row["floquet_error"] < 1e-4
    assert abs(row["floquet"] - known) <= row["floquet_error"] + 1e-8
    rough = np.abs(np.linalg.eigvals(curve.matrices[0])).max()
    assert abs(row["floquet"] - known) < 0.1 * abs(rough - known) + 1e-7


def test_where_the_map_has_no_derivative_there_is_no_multiplier_but_a_reason() -> None:
    # of tests/benchmarks/campaign.py multipliers: slip that hardly reverses, on a slow belt
    drive = fl.Drive(amplitude=0.18977730933120288, frequency=3.7205439413744097, phase=344.0896473998927)
    scene = fl.Scene(
        damping_ratio=0.06874662892719423,
        normal_load=0.6570155620257131,
        belt_speed=0.05493628650494744,
        drive=drive,
    )
    law = fl.LuGre(
        mu_kinetic=0.3295774612701697, presliding_length=0.49855881722710593, damping=1.091685038792133
    )

    row = fl.curve(scene, law, [scene.belt_speed], "shooting", 1e-8, columns="all").iloc[0]

    assert row["status"] == "ok"
    assert np.isnan(row["floquet"])
    assert np.isnan(row["floquet_error"])
    assert "no multiplier: the period map has no derivative here" in row["reason"]
