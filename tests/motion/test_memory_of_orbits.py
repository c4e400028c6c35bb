"""The work of friction and what laws remember along orbits, as tables have them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest
from profiles import deep, some

import frictionlab as fl
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw, bristle_in_the_plane

LINE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
CHANGING = LINE.with_(normal_load_variation={"amplitude": 0.3, "phase": 90})
PLANE = LINE.with_(transverse={"natural_frequency": 2, "damping_ratio": 0.2, "load": {"unbalance": 3}})
DAHL = fl.Dahl(mu=0.4, stiffness=4.0)
COULOMB = fl.Coulomb(mu=0.4)


@pytest.mark.parametrize(
    ("scene", "law"), [(LINE, COULOMB), (CHANGING, COULOMB), (LINE, DAHL), (PLANE, COULOMB)]
)
def test_over_a_period_friction_works_as_much_as_it_takes(scene: fl.Scene, law: FrictionLaw) -> None:
    state = fl.steady_state(scene, law)
    orbit, n = state.orbit(20_000), 20_000
    step = orbit.tau[1]
    # from the last sample to the end of the period by the power there
    power = -scene.normal_load * (orbit.friction * orbit.v1 + orbit.friction_transverse * orbit.v2)
    end = orbit.work.iloc[-1] + 0.5 * step * (power.iloc[-1] + power.iloc[0])
    assert end == pytest.approx(-state.energy_friction, rel=1e-6)
    assert orbit.work[0] == 0.0
    rates = np.gradient(orbit.work.to_numpy(), step)
    assert np.median(np.abs(rates - power)) < 1e-4 * np.abs(power).max()
    assert len(orbit) == n


def _obeys(orbit: pd.DataFrame, law: BristleLaw) -> tuple[float, float]:
    """By how much friction is not that of the deflection, and in the median its rate not that of the law."""
    z = (orbit.memory_0 + 1j * orbit.memory_0_transverse).to_numpy()
    slip = (orbit.slip + 1j * orbit.slip_transverse).to_numpy()
    told = [bristle_in_the_plane(law, w, each) for w, each in zip(slip.tolist(), z.tolist(), strict=True)]
    rates, friction = (np.array(part) for part in zip(*told, strict=True))
    moved = np.gradient(z, orbit.tau[1])
    recorded = (orbit.friction + 1j * orbit.friction_transverse).to_numpy()
    share = orbit.normal_load.to_numpy() / 10.0
    return np.abs(share * friction - recorded).max(), float(np.median(np.abs(moved - rates)))


@some(2, "seconds of steps")
@pytest.mark.parametrize(
    ("scene", "law"),
    [
        (LINE, DAHL),
        pytest.param(CHANGING, DAHL, marks=deep("a kernel slow to compile")),
        (LINE, fl.LuGre(mu_kinetic=0.4, mu_static=0.5, stiffness=4.0, damping=0.02, viscosity=0.001)),
        (LINE, fl.Dupont(mu_kinetic=0.4, mu_static=0.5, stiffness=4.0, damping=0.1)),
    ],
)
def test_the_deflection_is_that_of_the_law(scene: fl.Scene, law: BristleLaw) -> None:
    friction, rate = _obeys(fl.steady_state(scene, law).orbit(2000), law)
    assert friction < 1e-6
    assert rate < 1e-3


@deep("a kernel slow to compile")
def test_in_the_plane_the_deflection_of_jenkins_friction_never_leaves_its_circle() -> None:
    law = fl.Jenkins(mu=0.4, stiffness=4.0)
    orbit = fl.steady_state(PLANE, law).orbit(2000)
    assert np.hypot(orbit.memory_0, orbit.memory_0_transverse).max() == pytest.approx(0.1, rel=1e-6)
    friction, rate = _obeys(orbit, law)
    assert friction < 1e-9
    assert rate < 1e-3


def test_without_memory_there_is_no_column_of_it() -> None:
    assert not [name for name in fl.steady_state(LINE, COULOMB).orbit(3) if name.startswith("memory")]


def test_work_goes_on_from_period_to_period() -> None:
    motion = fl.trajectory(LINE, DAHL, periods=4, samples=50, initial=fl.Initial(x=3.0))
    assert motion.memory_0.abs().max() <= 0.1 * (1 + 1e-9)
    power = -10.0 * motion.friction * motion.v1
    steps = motion.tau.diff().iloc[1:]
    guessed = (0.5 * (power + power.shift()).iloc[1:] * steps).cumsum()
    assert np.abs(motion.work.iloc[1:] - guessed).max() < 0.02 * np.abs(motion.work).max()


def test_orbits_of_laws_with_and_without_memory_are_kept_side_by_side() -> None:
    laws: list[dict[str, Any]] = [{"kind": "coulomb", "mu": 0.4}, {"kind": "dahl", "mu": 0.4, "stiffness": 4}]
    study = {"schema": 1, "scene": LINE.given(), "laws": laws, "keep": {"orbit": 4}}
    orbits = fl.run(study).orbits
    assert orbits is not None
    assert orbits.memory_0.isna().tolist() == [True] * 4 + [False] * 4
    assert orbits.work.notna().all()
