"""The column ``unique``: what is known of other starts, and where that is told."""

from __future__ import annotations

import re
from typing import Any

import pytest
from fig_4b import GIVEN, LAW, SCENE
from profiles import deep

import frictionlab as fl
from frictionlab.runner.state import SteadyState

GENTLE = fl.Stribeck(mu_kinetic=0.39, mu_static=0.4)
STEEP = fl.Stribeck(mu_kinetic=0.2, mu_static=0.4)
TWO_STATES = fl.Stribeck(mu_static=0.8, mu_kinetic=0.2, stribeck_speed=0.1, viscosity=0.01)
DAHL = fl.Dahl(mu=0.4, stiffness=40.0)
SLIP = {"slip": fl.Slip(velocity_amplitude=3.0, frequency=1.0), "belt_speed": 1.0}
ACROSS = fl.Transverse(natural_frequency=0.5, damping_ratio=0.1, load={"unbalance": 1})
UNDAMPED = {"damping_ratio": 0.0, "drive": fl.Drive(unbalance=10, frequency=1.5)}


def state(law: fl.FrictionLaw, method: str = "auto", **changes: Any) -> SteadyState:
    given = {} if "slip" in changes else GIVEN
    return fl.steady_state(fl.Scene(**{**given, **changes}), law, method=method)


@pytest.mark.parametrize(
    ("law", "method", "changes", "said"),
    [
        *((LAW, "auto", {"belt_speed": speed}, "damped") for speed in (5.0, 60.0, 0.0)),
        (LAW, "auto", UNDAMPED, "neighbours"),
        (LAW, "shooting", {}, "damped"),
        (GENTLE, "auto", {}, "slow fall"),
        (LAW, "auto", {"transverse": ACROSS}, "damped"),
        (STEEP, "auto", SLIP, "slip"),
    ],
)
def test_a_theorem_is_named(law: fl.FrictionLaw, method: str, changes: dict[str, Any], said: str) -> None:
    one = state(law, method, **changes)

    assert (one.status, one.unique) == ("ok", "proved")
    assert f"; unique: {said}" in one.model
    assert "tested" not in one.reason


def test_starts_are_told_with_their_distance_and_time() -> None:
    many, two = state(STEEP), state(DAHL)

    assert (many.unique, two.unique) == ("tested", "tested")
    told = re.fullmatch(
        r"tested: (\d) starts up to (\S+) apart ended here, the starts followed for (\d+) periods "
        r"or more, (\S+) of the slowest time constant",
        two.reason,
    )
    assert told is not None
    assert told[1] == "2"
    # at rest on the belt: x = 0, v = 5; sliding: on the free orbit of amplitude 50 about 4, then at x = 4 - 50
    assert float(told[2]) == pytest.approx((46.0**2 + 5.0**2) ** 0.5, rel=2e-3)
    assert float(told[3]) >= 3
    assert many.reason.startswith("tested: 19 starts up to ")
    assert "unique: " not in many.model + two.model


@deep("seconds of maps")
def test_other_states_are_told() -> None:
    weak = fl.Drive(amplitude=0.05, frequency=3.0)
    falls = {"damping_ratio": 0.01, "normal_load": 1.0, "drive": weak, "belt_speed": 0.6}
    held = {"drive": fl.Drive(unbalance=2.0, frequency=1.0), "belt_speed": 0.0}
    chosen = state(LAW, **held, initial=fl.Initial(x=1.0))

    assert [state(TWO_STATES, **falls).unique, state(LAW, **held).unique] == ["no", "no"]
    assert state(LAW, "shooting", **held).unique == "no"
    assert (chosen.status, chosen.unique) == ("ok", "no")
    assert "unique: " not in chosen.model


@deep("seconds of maps")
def test_nothing_is_said_where_nothing_was_asked() -> None:
    asked = [state(LAW, "mdsm"), state(LAW, "march"), state(LAW, "shooting", drive=None), state(DAHL, **SLIP)]
    refused = state(STEEP, "exact")

    assert [each.unique for each in (*asked, refused)] == [""] * 5
    assert refused.status == "refused"


def test_the_column_is_in_the_table_and_empty_where_a_point_failed() -> None:
    failed = fl.steady_state(SCENE, LAW, tolerance=1e-30)

    assert (failed.status, failed.unique) == ("failed", "")
    assert fl.curve(SCENE, LAW, [5.0, 60.0])["unique"].tolist() == ["proved", "proved"]
