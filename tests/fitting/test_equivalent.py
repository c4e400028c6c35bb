"""The nearest curve of another model: itself, the two norms, what is varied, bad questions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import frictionlab as fl

SCENE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
SLIP = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=50, frequency=1))
SPEEDS = np.linspace(2.0, 58.0, 15)
SOFT: Any = (
    SLIP,
    fl.Dahl(mu=0.4, presliding_length=1.0),
    {"presliding_length": {"from": 0.1, "to": 1e3, "spacing": "log"}},
)


def test_a_model_among_itself_is_at_no_distance() -> None:
    law = fl.Dahl(mu=0.4, presliding_length=20.0)
    found = fl.equivalent((SLIP, law), SOFT, belt_speed=SPEEDS, starts=2)
    assert found.values["presliding_length"] == pytest.approx(20.0, rel=1e-5)
    assert found.distance <= found.distance_error + 1e-8


def test_each_norm_is_least_for_its_own_numbers() -> None:
    """Elastic contact under a slip that nothing brakes, against Coulomb friction that brakes its body."""
    of = SCENE, fl.Coulomb(mu=0.4)
    largest, rms = (
        fl.equivalent(of, SOFT, belt_speed=SPEEDS, norm=norm, starts=2) for norm in ("largest", "rms")
    )
    at_rms = np.abs(rms.curves["of"] - rms.curves["among"]).max()
    assert largest.distance < at_rms
    assert rms.distance < largest.rms
    assert largest.distance == pytest.approx(np.abs(largest.curves["of"] - largest.curves["among"]).max())
    assert 0.005 < largest.distance < 0.05


def test_numbers_are_found_anew_over_an_input() -> None:
    other = SCENE, fl.Coulomb(mu=0.4), {"mu": (0.1, 1.0)}
    over = {"drive.frequency": [1.0, 1.5]}
    found = fl.equivalent((SCENE, fl.Coulomb(mu=0.6)), other, belt_speed=SPEEDS, over=over, starts=1)
    assert found.table["mu"].to_list() == pytest.approx([0.6, 0.6], abs=1e-6)
    assert found.table["drive.frequency"].to_list() == [1.0, 1.5]
    assert len(found.plot().axes) == 2


def test_bad_questions_are_told() -> None:
    with pytest.raises(ValueError, match="norm must be 'largest' or 'rms', got 'mean'"):
        fl.equivalent((SCENE, fl.Coulomb(mu=0.4)), SOFT, norm="mean")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="over must name one input"):
        fl.equivalent(
            (SCENE, fl.Coulomb(mu=0.4)), SOFT, over={"drive.frequency": [1], "damping_ratio": [0.1]}
        )
