"""What scenes need: known scenes keep what the paper says they need, and a scene that needs nothing loses it all."""

from __future__ import annotations

import numpy as np
import pytest
from profiles import deep

import frictionlab as fl
from frictionlab.analysis.needs.motion import WithoutRest
from frictionlab.analysis.needs.needs import Needs
from frictionlab.scene.scenes import Scenes

STRONG = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))


def verdicts(found: Needs) -> dict[str, str]:
    """Of every set of things taken away."""
    return dict(zip(found.table["without"], found.table["verdict"], strict=True))


def test_strong_friction_at_resonance_keeps_its_effect_on_the_motion() -> None:
    found = fl.needs(STRONG, fl.Coulomb(mu=0.4), np.linspace(4, 60, 8))

    assert verdicts(found)["friction's effect on the motion"] == "needed"
    row = found.table.set_index("without").loc["friction's effect on the motion"]
    assert abs(row["change"]) == pytest.approx(0.09, abs=2e-3)
    assert row["change_error"] < 1e-6


@deep("more kernels to compile")
def test_a_scene_that_needs_nothing_comes_down_to_the_closed_form() -> None:
    scene = fl.Scene(
        damping_ratio=0.1,
        normal_load=0.05,
        belt_speed=5,
        drive=fl.Drive(unbalance=10, frequency=4),
        transverse=fl.Transverse(natural_frequency=3, damping_ratio=0.2, load=fl.Load(amplitude=0.1)),
    )
    law = fl.Dahl(mu=0.4, presliding_length=1e-3)
    found = fl.needs(scene, law, np.linspace(8, 48, 6))

    assert set(found.table["verdict"]) <= {"not needed", "refused"}
    assert found.smallest.scene.degrees_of_freedom == 1
    assert found.smallest.law == fl.Coulomb(mu=0.4)
    assert found.smallest.way is not None
    assert found.smallest.way.name == "mdsm"


def test_the_motion_without_rest_is_the_motion_where_that_never_rests() -> None:
    speeds = np.linspace(2, 48, 8)
    table = fl.curve(STRONG, fl.Coulomb(mu=0.4), speeds)
    slips = table["stick_fraction"] == 0.0
    means = WithoutRest().model_means(Scenes(STRONG, speeds), fl.Coulomb(mu=0.4))

    assert 3 <= slips.sum() < len(speeds)
    apart = np.abs(means - table["mean_friction"])
    assert apart[slips].max() < 1e-12
    assert apart[~slips].min() > 1e-6
