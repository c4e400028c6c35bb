"""Scenes drawn at random: errors cover what the tests' own integration finds, and what a finer tolerance changes."""

from __future__ import annotations

import math
from typing import Any

import pytest
from draws_of_every_kind import Keys, convergent, creeping, driven, undriven_of_any_law
from hypothesis import assume, event, example, given, settings
from outside_forcing import BELT1, LOAD1, NORMAL, forcing
from outside_state import Outside, Unsettled, steady
from profiles import DEEP, deep
from truth import law_of

import frictionlab as fl

LEINE = {
    "kind": "stribeck",
    "curve": "hyperbolic",
    "mu_static": 1.0,
    "mu_kinetic": 0.0,
    "stribeck_speed": 1 / 3,
}
CUBIC = {"kind": "stribeck", "curve": "cubic", "mu_static": 0.4, "mu_kinetic": 0.25, "stribeck_speed": 0.5}
TWO_LEVELS = {"kind": "coulomb", "mu": 0.3, "mu_static": 0.6}
ROUNDING = 1e-11
"""Of some hundred steps of the integration."""
FEW = 200 if DEEP else 6
METHODS = (fl.Exact(), fl.Shooting(), fl.Mdsm(), fl.HarmonicBalance(), fl.HarmonicBalance(harmonics=4))

# Rate-and-state friction: scenes that were answered wrongly once.
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
LOOSE = {"damping_ratio": 0.0, "normal_load": 0.86, "belt_speed": -0.0828}
FALLS = {"mu": 0.226, "a": 0.014, "b": 0.0386, "slip_length": 8.2e-4, "reference_speed": 0.0828}
"""Set off at rest, where slip is zero and friction has a slope of 1e6."""

TOUCHES = {"belt_speed": -1.0, "slip": {"velocity_amplitude": 1.0, "frequency": 1.0, "waveform": "triangle"}}
"""Slip comes to rest where a straight piece of it ends, and sets off there again."""
EVEN = {"mu": 1.0, "a": 0.0111, "b": 0.0, "slip_length": 1.0, "reference_speed": 1.0}


def block(belt_speed: float) -> Keys:
    """Return a lightly damped mass that nothing drives."""
    return {"damping_ratio": 0.02, "normal_load": 1.0, "belt_speed": belt_speed}


def known(scene: Keys, law: Keys, state: fl.SteadyState) -> Outside | None:
    """Follow the motion from a state of the answer until it repeats; None if it takes long."""
    start: tuple[float, ...] = ()
    if "slip" not in scene:
        first = state.orbit(1)
        parts = first[["x1", "v1", "x2", "v2"] if "transverse" in scene else ["x1", "v1"]]
        start = tuple(float(each) for each in parts.iloc[0])
    try:
        return steady(scene, law, start, 1e-12, 100)
    except Unsettled:
        return None


def covered(drawn: tuple[Keys, Keys]) -> None:
    """Compare answers with an integration that shares no code with the package."""
    scene, law = fl.Scene(**drawn[0]), law_of(drawn[1])
    state = fl.steady_state(scene, law, tolerance=1e-6)
    if state.status == "not_unique" or state.error_kind == "statistical":
        return
    assert state.status == "ok", state.reason
    truth = known(*drawn, state)
    event("compared" if truth else "not compared")
    for method in (None, *METHODS) if truth else ():
        found = state if method is None else fl.steady_state(scene, law, method, tolerance=1e-6)
        assert found.status in ("ok", "refused"), found.reason
        if found.status == "ok":
            assert abs(found.mean_friction - truth.mean) <= found.error + truth.error + ROUNDING, method


def covered_at_two_tolerances(drawn: tuple[Keys, Keys], rough: float, fine: float) -> None:
    """Compare answers of two accuracies."""
    scene, law = drawn
    one, other = (fl.steady_state(fl.Scene(**scene), law_of(law), tolerance=each) for each in (rough, fine))
    assert one.status == other.status == "ok", one.reason + other.reason
    assert one.error <= rough or one.error_kind == "statistical"
    assert abs(one.mean_friction - other.mean_friction) <= one.error + other.error


BENT = {
    "damping_ratio": 0.1,
    "normal_load": 2.0,
    "belt_speed": 0.7,
    "drive": {"amplitude": 3.0, "frequency": 1.3, "offset": 2.5},
    "body": {"cubic_stiffness": 0.3},
}
"""A constant force hardens the spring."""


@settings(max_examples=FEW)
@example(drawn=(BENT, {"kind": "coulomb", "mu": 0.3}))
@given(drawn=driven("line"))
def test_means_on_the_line_are_those_of_an_unrelated_integration(drawn: Any) -> None:
    covered(drawn)


@settings(max_examples=FEW)
@given(
    drawn=driven("plane", () if DEEP else ("coulomb",))
)  # bristles in the plane are more kernels to compile
def test_means_in_the_plane_are_those_of_an_unrelated_integration(drawn: Any) -> None:
    covered(drawn)


@settings(max_examples=FEW)
@given(drawn=driven("prescribed"))
def test_means_under_a_prescribed_slip_are_those_of_an_unrelated_integration(drawn: Any) -> None:
    angle = abs(drawn[0]["slip"].get("direction", 0.0))
    assume(angle == 0.0 or angle > 1e-6)  # one of 1e-154 degrees, whose slip touches rest, is off by 2e-9
    covered(drawn)


@settings(max_examples=FEW)
@given(
    drawn=undriven_of_any_law()
    if DEEP
    else undriven_of_any_law(("coulomb", "static", "stribeck", "falling lugre"))
)
@example(drawn=(block(10.0**-0.9375), LEINE))
@example(drawn=(block(1e-4), CUBIC))
@example(drawn=(block(0.01), TWO_LEVELS))
def test_means_that_nothing_drives_have_errors_that_cover_what_a_finer_tolerance_changes(drawn: Any) -> None:
    covered_at_two_tolerances(drawn, 1e-5, 1e-9)


@deep("more kernels to compile")
@settings(max_examples=300)
@given(drawn=creeping())
@example(drawn=(SHAKEN, LANDS))
@example(drawn=(PRESSED, SETS_OFF))
@example(drawn=(LOOSE, FALLS))
@example(drawn=(TOUCHES, EVEN))
def test_means_of_contacts_that_creep_have_errors_that_cover_what_a_finer_tolerance_changes(
    drawn: Any,
) -> None:
    scene, law = drawn
    covered_at_two_tolerances((scene, {"kind": "rate-and-state"} | law), 1e-5, 1e-8)


@given(convergent())
@settings(max_examples=200 if DEEP else 10)
def test_signals_are_those_of_the_contract(drawn):
    """As the tests read them, and as the package does."""
    scene, _ = drawn
    own, signals = forcing(scene), fl.Scene(**scene).signals()
    assert own.edges[-1] == pytest.approx(signals.period, rel=1e-12)
    for span in range(len(own.pieces)):
        begin, end = own.edges[span], own.edges[span + 1]
        tau = begin + 0.37 * (end - begin)
        value = own.pieces[span, :, 0] + own.pieces[span, :, 1] * (tau - begin)
        for which, (rate, phase, size) in zip(own.which, own.sines, strict=True):
            value[which] += size * math.sin(rate * tau + phase)
        theirs = {LOAD1: signals.load[0], BELT1: signals.belt[0], NORMAL: signals.normal_load}
        for index, signal in theirs.items():
            mean_value = {BELT1: scene["belt_speed"], NORMAL: scene["normal_load"]}.get(index, 0.0)
            assert value[index] == pytest.approx(
                signal(tau) + mean_value, abs=1e-9 * (1.0 + abs(value).max())
            )
