"""The experiment that tells models apart: what is known of Coulomb friction, all models at once, bad questions."""

from __future__ import annotations

import numpy as np
import pytest

import frictionlab as fl

SCENE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
MODELS = [(SCENE, fl.Coulomb(mu=mu)) for mu in (0.4, 0.5)]


def test_friction_coefficients_are_told_apart_where_slip_hardly_reverses() -> None:
    """From V_lin = 50 on means differ by the whole difference, just below by a little more: curves bend."""
    found = fl.discriminate(MODELS, {"belt_speed": (1, 60)}, sigma=0.02)
    assert 48.0 < found.best["belt_speed"] < 50.0
    assert 5.0 < found.table["apart"].iloc[0] < 5.1
    beyond = found.table[found.table["belt_speed"] >= 50.0]
    assert beyond["apart"].to_numpy() == pytest.approx(5.0)
    assert found.table["apart"].is_monotonic_decreasing
    assert len(found.plot().axes) == 1


def test_of_several_models_the_two_nearest_count() -> None:
    three = [*MODELS, (SCENE, fl.Coulomb(mu=0.52))]
    found = fl.discriminate(three, {"belt_speed": (1, 60), "drive.frequency": (0.8, 1.5)}, sigma=0.02)
    assert set(found.table["nearest"].iloc[:10]) == {"2 and 3"}
    assert 1.0 <= found.table["apart"].iloc[0] < 1.05
    assert np.isfinite(found.table["mean_1"]).all()


def test_bad_questions_are_told() -> None:
    with pytest.raises(ValueError, match="two or more are needed to tell apart, got 1"):
        fl.discriminate(MODELS[:1], {"belt_speed": (1, 60)}, sigma=0.02)
    with pytest.raises(ValueError, match="experiments must be ranges by input"):
        fl.discriminate(MODELS, {"belt_speed": (60, 1)}, sigma=0.02)
    with pytest.raises(ValueError, match="sigma must be a positive number, got 0"):
        fl.discriminate(MODELS, {"belt_speed": (1, 60)}, sigma=0)
