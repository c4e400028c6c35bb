"""The experiment that tells models apart: what is known of Coulomb friction, all models at once, bad questions."""

from __future__ import annotations

import numpy as np
import pytest
from profiles import deep

import frictionlab as fl

pytestmark = deep("seconds of search")

SCENE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
MODELS = [(SCENE, fl.Coulomb(mu=mu)) for mu in (0.4, 0.5)]


def test_friction_coefficients_are_told_apart_where_slip_hardly_reverses() -> None:
    """From little below V_lin = 50 on means differ by the whole difference, on slower belts by less."""
    found = fl.discriminate(MODELS, {"belt_speed": (1, 60)}, sigma=0.02)
    assert found.best["belt_speed"] > 48.0
    apart = found.table.set_index("belt_speed")["apart"]
    assert apart[apart.index >= 49.0].to_numpy() == pytest.approx(5.0, abs=1e-9)
    assert (apart[apart.index < 47.0] < 4.999).all()
    assert found.table["apart"].is_monotonic_decreasing
    assert len(found.plot().axes) == 1


def test_of_several_models_the_two_nearest_count() -> None:
    three = [*MODELS, (SCENE, fl.Coulomb(mu=0.52))]
    found = fl.discriminate(three, {"belt_speed": (1, 60), "drive.frequency": (0.8, 1.5)}, sigma=0.02)
    assert set(found.table["nearest"].iloc[:10]) == {"2 and 3"}
    assert 1.0 <= found.table["apart"].iloc[0] < 1.05
    assert np.isfinite(found.table["mean_1"]).all()


def test_friction_above_the_load_is_told_from_bristles_on_the_slowest_belts() -> None:
    """Coulomb friction f leaves 1 - P/f of mu under a load P however slow the belt; bristles creep."""
    scene = fl.Scene(
        damping_ratio=0.1, normal_load=10, belt_speed=1, drive=fl.Drive(amplitude=2.5, frequency=0.5)
    )
    pair = [(scene, fl.Coulomb(mu=0.4)), (scene, fl.Dahl(mu=0.4, presliding_length=1.0))]
    slowest = fl.discriminate(pair, {"belt_speed": (1e-3, 2.5)}, sigma=0.01).table.iloc[0]

    assert slowest["belt_speed"] < 5e-3
    assert slowest["mean_1"] == pytest.approx(0.4 * (1 - 2.5 / 4), abs=6e-3)
    assert slowest["mean_2"] < 0.01


def test_an_elastic_contact_is_told_at_its_resonance_above_which_the_order_turns_round() -> None:
    """Of the mass on its spring and on a contact 15 times as stiff, at 4."""
    scene = fl.Scene(
        damping_ratio=0.1, normal_load=10, belt_speed=0.1, drive=fl.Drive(amplitude=3, frequency=4)
    )
    pair = [(scene, fl.Coulomb(mu=0.4)), (scene, fl.ElastoPlastic(mu_kinetic=0.4, contact_stiffness=15))]
    found = fl.discriminate(pair, {"drive.frequency": (2, 10)}, sigma=0.01)
    higher = (found.table["mean_2"] > found.table["mean_1"]).to_numpy()

    assert found.best["drive.frequency"] == pytest.approx(4, rel=0.12)
    assert not higher[found.table["drive.frequency"] < 6.0].any()
    assert higher[found.table["drive.frequency"] > 6.1].all()


def test_slip_along_the_belt_tells_soft_bristles_and_across_it_their_order_is_reversed() -> None:
    scene = fl.Scene(belt_speed=0.5, slip=fl.Slip(velocity_amplitude=1, frequency=1, direction=0))
    pair = [(scene, fl.Coulomb(mu=0.4)), (scene, fl.Dahl(mu=0.4, presliding_length=100))]
    found = fl.discriminate(pair, {"slip.direction": (0, 90)}, sigma=0.01)
    across = found.table[found.table["slip.direction"] == 90.0].iloc[0]

    assert found.best["slip.direction"] == pytest.approx(0.0, abs=0.1)
    assert found.table["mean_2"].iloc[0] / 0.4 == pytest.approx(0.696, abs=1e-3)
    assert (across["mean_1"] / 0.4, across["mean_2"] / 0.4) == pytest.approx((0.6426, 0.5961), abs=1e-4)


def test_bad_questions_are_told() -> None:
    with pytest.raises(ValueError, match="two or more are needed to tell apart, got 1"):
        fl.discriminate(MODELS[:1], {"belt_speed": (1, 60)}, sigma=0.02)
    with pytest.raises(ValueError, match="experiments must be ranges by input"):
        fl.discriminate(MODELS, {"belt_speed": (60, 1)}, sigma=0.02)
    with pytest.raises(ValueError, match="sigma must be a positive number, got 0"):
        fl.discriminate(MODELS, {"belt_speed": (1, 60)}, sigma=0)
