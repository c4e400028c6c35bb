"""No shortcut of a method rests on a property that a law lacks by its own word (``expected_failures``)."""

from __future__ import annotations

from typing import Any, ClassVar

import pytest
from profiles import deep

import frictionlab as fl


class Scales(fl.CompliantLaw):
    """Bristles of a scaled skin, which hold less forward."""

    expected_failures: ClassVar[dict[str, str]] = {
        "oddness": "scales let go more easily forward",
        "rotation": "forward is a direction",
        "reflection": "forward is a direction",
        "steady_sliding": "two coefficients",
    }
    mu: fl.Positive
    share: fl.Positive = 0.8

    def sliding_friction(self, speed: float) -> float:
        """Backward friction, the larger one."""
        return self.mu

    def rate(self, v: Any, z: Any) -> Any:
        """Rate of Dahl's deflection to a limit that depends on the direction."""
        limit = self.mu / self.bristle_stiffness
        if v.real > 0.0:
            limit = limit * self.share
        return v - abs(v) * z / limit

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Force of the bristles."""
        return self.bristle_stiffness * z

    def largest_deflection(self) -> float:
        """Longer of the two limits."""
        return self.mu / self.bristle_stiffness


SKIN = Scales(mu=0.5, presliding_length=1e-3)
DRIVE = fl.Drive(amplitude=3, frequency=1.3)


@pytest.mark.parametrize(
    ("belt_speed", "mean"),
    # integrated by LSODA at a tolerance of 1e-11, to 1e-9; where slip never reverses the coefficient of its direction
    [(-0.3, -0.0379302664), (0.0, 0.0494004560), (0.3, 0.1367024792), (-2.0, -0.4), (2.0, 0.5)],
)
def test_a_law_that_is_not_odd_has_its_own_mean_in_each_direction(belt_speed: float, mean: float) -> None:
    scene = fl.Scene(belt_speed=belt_speed, slip=fl.Slip(velocity_amplitude=1, frequency=1))

    state = fl.steady_state(scene, SKIN)

    assert state.status == "ok"
    assert abs(state.mean_friction - mean) < state.error + 2e-9


@deep("kernels slow to compile")
@pytest.mark.parametrize("belt_speed", [-0.3, 0.0, 5.0])
def test_a_body_on_a_law_that_is_not_odd_moves_as_time_stepping_has_it(belt_speed: float) -> None:
    scene = fl.Scene(damping_ratio=0.1, normal_load=1, belt_speed=belt_speed, drive=DRIVE)

    state, marched = (
        fl.steady_state(scene, SKIN),
        fl.steady_state(scene, SKIN, method=fl.March(stepper="sdirk2")),
    )

    assert abs(state.mean_friction - marched.mean_friction) <= state.error + marched.error


def test_harmonic_balance_refuses_bristles_that_are_not_odd() -> None:
    """It solves one direction and turns the mean round: -.0674 +- 2e-6 for .0320 at a belt speed of -.3."""
    scene = fl.Scene(damping_ratio=0.1, normal_load=1, belt_speed=-0.3, drive=DRIVE)

    state = fl.steady_state(scene, SKIN, method="harmonic_balance")

    assert state.status == "refused"
    assert "not odd" in state.reason


def test_a_curve_under_a_law_that_is_not_odd_does_not_begin_at_zero() -> None:
    scene = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=1, frequency=1))

    done = fl.compare(scene, SKIN, belt_speed=[0.02, 0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 1.1])

    (curve,) = done.curves.to_dict("records")
    assert curve["shape_start"] != curve["shape_start"]  # not a number
    assert "to both sides" in curve["reason"]
