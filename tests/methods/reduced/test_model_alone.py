"""The answer of a reduced model without its error: the mean that it states."""

from __future__ import annotations

import numpy as np
import pytest

import frictionlab as fl
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import ReducedModel
from frictionlab.methods.reduced.harmonic_balance import HarmonicBalance
from frictionlab.methods.reduced.mdsm import Mdsm
from frictionlab.scene.scene import BeltVibration

COULOMB = fl.Coulomb(mu=0.4)
LINE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=1, drive=fl.Drive(unbalance=10, frequency=1))
PLANE = fl.Scene(
    damping_ratio=0.1,
    normal_load=1,
    belt_speed=1,
    drive=fl.Drive(unbalance=10, frequency=4),
    transverse=fl.Transverse(natural_frequency=4, damping_ratio=0.1, load=fl.Load(unbalance=10)),
)
SHAKEN = LINE.model_copy(update={"belt_vibration": BeltVibration(velocity_amplitude=5)})
SQUARE = LINE.model_copy(update={"drive": fl.Drive(unbalance=10, frequency=1, waveform="square")})


@pytest.mark.parametrize(
    ("model", "scene", "law"),
    [
        (Mdsm(), LINE, COULOMB),
        (Mdsm(), SHAKEN, COULOMB),
        (Mdsm(), SQUARE, COULOMB),
        (Mdsm(), PLANE, COULOMB),
        (HarmonicBalance(), LINE, COULOMB),
        (HarmonicBalance(), SHAKEN, COULOMB),
        (HarmonicBalance(), LINE, fl.Dahl(mu=0.4, stiffness=8)),
    ],
)
def test_the_model_alone_gives_the_mean_that_it_states_an_error_of(
    model: ReducedModel, scene: fl.Scene, law: FrictionLaw
) -> None:
    scenes = [scene.at(speed) for speed in (1.0, 20.0, 60.0)]
    stated = model.solve(scenes, law, 1e-6)
    answered = np.array(stated.status) == "ok"

    alone = model.model_means(scenes, law)

    assert answered.any()
    assert alone.shape == stated.mean.shape
    assert alone[answered] == pytest.approx(stated.mean[answered], rel=0.0, abs=1e-13)


def test_a_belt_that_runs_backward_turns_the_mean_round() -> None:
    for model in (Mdsm(), HarmonicBalance()):
        ahead, back = (model.model_means([LINE.at(speed)], COULOMB) for speed in (20.0, -20.0))
        assert back == pytest.approx(-ahead)
