"""Time stepping of laws with several memories or scalars: against another law, and against shooting."""

from __future__ import annotations

import pytest
from answered import with_columns
from memory_laws import elements
from profiles import deep
from rate_and_state import RateAndState

from frictionlab.methods.march.method import March
from frictionlab.methods.march.steppers import STEPPERS, fewest_steps
from frictionlab.scene.scene import Drive, Scene

compiling = deep("more kernels to compile")
ONE = elements(stiffness=(4.0,), reach=(0.1,))
THREE = elements(stiffness=(10.0, 2.0, 0.5), reach=(0.015, 0.05, 0.3))
AGEING = RateAndState(mu=0.4, a=0.01, b=0.008, slip_length=2.0)


def driven(belt_speed, **changes):
    """A body that forgets where it started within some ten periods, shaken at a speed of 13."""
    drive = Drive(unbalance=10.0, frequency=1.5)
    return Scene(
        **({"damping_ratio": 0.4, "normal_load": 10.0, "belt_speed": belt_speed, "drive": drive} | changes)
    )


def solve(method, scene, law, tolerance):
    """Mean and error of an answer that is ok."""
    answers = with_columns(method, scene, law, tolerance)
    assert answers.status == ["ok"], answers.reason
    return float(answers.columns["mean_friction"][0]), float(answers.columns["error"][0])


def agree(one, other):
    """Whether two answers agree within their errors."""
    return abs(one[0] - other[0]) <= one[1] + other[1]


@deep("more kernels to compile")
def test_where_slip_comes_to_rest_an_age_is_refused_by_march_and_left_to_shooting():
    answers = with_columns(March(), [driven(5.0)], AGEING, 1e-3)

    assert answers.status == ["refused"]
    assert "comes to rest" in answers.reason[0]
    assert "use method shooting" in answers.reason[0]


@deep("more kernels to compile")
def test_an_age_that_grows_too_quickly_for_the_steps_asked_for_is_refused_with_those_that_would_do():
    scene = driven(20.0)
    refused = March(steps=50).refusal(scene, AGEING)
    fewest = int(refused.split("about ")[1].split()[0])

    assert "with 50 steps per period" in refused
    assert March(steps=fewest - 1).refusal(scene, AGEING) is not None
    assert solve(March(steps=fewest), scene, AGEING, 1e-2)[0] == pytest.approx(0.4039, abs=1e-3)


@deep("more kernels to compile")
def test_a_motion_faster_than_without_friction_takes_more_steps_by_itself():
    """The longer spring brings the body to resonance."""
    soft = elements(stiffness=(0.1, 0.35), reach=(4.0, 0.07))
    scene = driven(2.0, damping_ratio=0.1)
    fewest = fewest_steps(scene, soft, STEPPERS["rk4"])
    given = with_columns(March(steps=fewest), [scene], soft, 1e-2)

    assert given.status == ["refused"]
    assert "are enough" in given.reason[0]
    assert agree(solve(March(), scene, soft, 1e-3), solve(March(steps=32 * fewest), scene, soft, 1e-4))
