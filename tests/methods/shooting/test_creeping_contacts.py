"""Contacts that creep where others stick: every scene has a mean, whose error covers; stiff steps of scipy agree."""

from __future__ import annotations

from typing import Any

import pytest
from draws_of_every_kind import CREEPING, creeping
from hypothesis import example, given, settings
from outside_creep import REPEATS, Creep
from profiles import DEEP, deep
from rate_and_state import RateAndState

import frictionlab as fl

SHAKEN = {
    "damping_ratio": 0.098,
    "normal_load": 0.63,
    "drive": {"amplitude": 0.154, "frequency": 1.68, "waveform": "sawtooth", "phase": 239.0},
    "belt_speed": 0.0159,
}
"""It lands, creeps, sets off and turns round in every period."""
LANDS = {"mu": 0.147, "a": 0.0069, "b": 0.0, "slip_length": 0.022, "reference_speed": 0.00457}
PRESSED = {
    "damping_ratio": 0.193,
    "normal_load": 705.6,
    "drive": {"amplitude": 34.3, "frequency": 2.896, "waveform": "sawtooth", "phase": 202.5},
    "belt_speed": 0.586,
}
"""Slip that sets off from 1e-16 of the belt speed was missed by steps a hundred thousand times too long."""
SETS_OFF = {"mu": 0.1274, "a": 0.001462, "b": 0.001343, "slip_length": 3.17, "reference_speed": 0.155}
PLANAR = {
    "damping_ratio": 1.33,
    "normal_load": 1.81,
    "transverse": {"natural_frequency": 1.008, "damping_ratio": 0.139},
    "drive": {"amplitude": 0.578, "frequency": 0.4636, "waveform": "square", "direction": -150.0},
    "normal_load_variation": {"waveform": "square", "phase": 299.0, "frequency_ratio": 3, "amplitude": 0.8},
    "belt_speed": 0.044,
}
IDLE = {
    "mu": 0.281,
    "a": 0.00658,
    "b": 0.0,
    "slip_length": 0.187,
    "reference_speed": 4.7e-4,
    "state_law": "slip",
}
"""Friction does not know the age: quotients by it were taken over e^1000."""
LOOSE = {"damping_ratio": 0.0, "normal_load": 0.86, "belt_speed": -0.0828}
FALLS = {"mu": 0.226, "a": 0.014, "b": 0.0386, "slip_length": 8.2e-4, "reference_speed": 0.0828}
"""Set off at rest, where slip is zero and friction has a slope of 1e6."""

TOUCHES = {"belt_speed": -1.0, "slip": {"velocity_amplitude": 1.0, "frequency": 1.0, "waveform": "triangle"}}
"""Slip comes to rest where a straight piece of it ends, and sets off there again."""
EVEN = {"mu": 1.0, "a": 0.0111, "b": 0.0, "slip_length": 1.0, "reference_speed": 1.0}


def answered(scene: dict[str, Any], law: dict[str, Any], tolerance: float) -> Any:
    law = {name: value for name, value in law.items() if name != "kind"}
    return fl.steady_state(fl.Scene(**scene), RateAndState(**law), tolerance=tolerance)


@deep("more kernels to compile")
@settings(max_examples=300 if DEEP else 12)
@given(drawn=creeping(CREEPING if DEEP else ("line", "undriven")))  # the others are more kernels to compile
@example(drawn=(SHAKEN, LANDS))
@example(drawn=(PRESSED, SETS_OFF))
@example(drawn=(LOOSE, FALLS))
@example(drawn=(TOUCHES, EVEN))
def test_every_scene_has_a_mean_whose_error_covers_that_of_finer_maps(drawn: Any) -> None:
    rough, fine = (answered(*drawn, tolerance) for tolerance in (1e-5, 1e-8))

    assert rough.status == fine.status == "ok", rough.reason + fine.reason
    assert rough.error <= 1e-5 or rough.error_kind == "statistical"
    assert abs(rough.mean_friction - fine.mean_friction) <= rough.error + fine.error


@deep("more kernels to compile")
@pytest.mark.parametrize("tolerance", [1e-4, 1e-8])
@pytest.mark.parametrize(
    ("scene", "law"),
    [
        pytest.param(SHAKEN, LANDS | {"state_law": "ageing"}, id="line"),
        pytest.param(PLANAR, IDLE, id="plane", marks=deep("more kernels to compile")),
    ],
)
def test_means_are_those_of_stiff_steps_on_formulas_written_anew(
    scene: Any, law: Any, tolerance: float
) -> None:
    known, found = Creep(scene, law).mean(100), answered(scene, law, tolerance)

    assert found.error <= tolerance
    assert abs(found.mean_friction - known) <= found.error + 3.0 * REPEATS
