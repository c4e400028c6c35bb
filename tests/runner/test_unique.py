"""The column ``unique``: what is known of other starts, and where that is told."""

from __future__ import annotations

import re
from typing import Any

import pytest
from profiles import deep

import frictionlab as fl
from frictionlab.runner.state import SteadyState

COULOMB = fl.Coulomb(mu=0.4)
GENTLE = fl.Stribeck(mu_kinetic=0.39, mu_static=0.4)
STEEP = fl.Stribeck(mu_kinetic=0.2, mu_static=0.4)
TWO_STATES = fl.Stribeck(mu_static=0.8, mu_kinetic=0.2, stribeck_speed=0.1, viscosity=0.01)
DAHL = fl.Dahl(mu=0.4, stiffness=40.0)
FULL = {"damping_ratio": 0.1, "normal_load": 10.0, "belt_speed": 5.0}
DRIVE = fl.Drive(unbalance=10.0, frequency=1.0)


def state(law: fl.FrictionLaw, method: str = "auto", **changes: Any) -> SteadyState:
    drive = {} if "slip" in changes else {**FULL, "drive": DRIVE}
    given = {name: value for name, value in {**drive, **changes}.items() if value is not None}
    return fl.steady_state(fl.Scene(**given), law, method=method)


@pytest.mark.parametrize(
    ("found", "said"),
    [
        (lambda: state(COULOMB), "damped"),
        (lambda: state(COULOMB, belt_speed=60.0), "damped"),
        (lambda: state(COULOMB, belt_speed=0.0), "damped"),
        (
            lambda: state(COULOMB, damping_ratio=0.0, drive=fl.Drive(unbalance=10, frequency=1.5)),
            "neighbours",
        ),
        (lambda: state(COULOMB, "shooting"), "damped"),
        (lambda: state(GENTLE), "slow fall"),
        (
            lambda: state(
                COULOMB,
                transverse=fl.Transverse(natural_frequency=0.5, damping_ratio=0.1, load={"unbalance": 1}),
            ),
            "damped",
        ),
        (
            lambda: state(STEEP, slip=fl.Slip(velocity_amplitude=3.0, frequency=1.0), belt_speed=1.0),
            "slip",
        ),
    ],
)
def test_a_theorem_is_named(found: Any, said: str) -> None:
    one = found()

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
    chosen = state(COULOMB, **held, initial=fl.Initial(x=1.0))

    assert [state(TWO_STATES, **falls).unique, state(COULOMB, **held).unique] == ["no", "no"]
    assert state(COULOMB, "shooting", **held).unique == "no"
    assert (chosen.status, chosen.unique) == ("ok", "no")
    assert "unique: " not in chosen.model


@deep("seconds of maps")
def test_nothing_is_said_where_nothing_was_asked() -> None:
    assert state(COULOMB, "mdsm", belt_speed=5.0).unique == ""
    assert state(COULOMB, "march").unique == ""
    assert state(COULOMB, "shooting", drive=None).unique == ""
    assert state(DAHL, slip=fl.Slip(velocity_amplitude=3.0, frequency=1.0), belt_speed=1.0).unique == ""
    refused = state(STEEP, "exact")
    assert (refused.status, refused.unique) == ("refused", "")


def test_an_answer_that_failed_is_no_state(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = fl.steady_state(fl.Scene(**FULL, drive=DRIVE), COULOMB, tolerance=1e-30)

    assert (asked.status, asked.unique) == ("failed", "")


def test_the_column_is_in_the_table() -> None:
    table = fl.curve(fl.Scene(**FULL, drive=DRIVE), COULOMB, [5.0, 60.0])

    assert table["unique"].tolist() == ["proved", "proved"]
