"""Reduced models where a belt vibrates, a load has another waveform, or the normal load changes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from answered import with_columns
from hypothesis import given, settings
from hypothesis import strategies as st

from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.stribeck import Stribeck
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.reduced.harmonic_balance import HarmonicBalance
from frictionlab.methods.reduced.mdsm import Mdsm
from frictionlab.scene.scene import Scene
from frictionlab.theory import friction_free_velocity
from frictionlab.theory.equivalent_drive import equivalent_drive

LAW = Coulomb(mu=0.4)
VIBRATION = {"velocity_amplitude": 2.0, "phase": 70.0}
angles = st.floats(0.0, 360.0)


def scene(belt_speed: float = 1.0, **keys: Any) -> Scene:
    drive = {"amplitude": 10.0, "frequency": 1.5, "phase": 20.0}
    given = {"damping_ratio": 0.1, "normal_load": 1.0, "belt_speed": belt_speed, "drive": drive}
    return Scene(**{**given, **keys})


@given(
    phases=st.tuples(angles, angles),
    frequency=st.floats(0.2, 4.0),
    size=st.floats(0.1, 9.0),
    speed=st.floats(-9, 9),
)
@settings(max_examples=25)
def test_a_sine_of_the_belt_is_an_equivalent_drive(
    phases: tuple[float, float], frequency: float, size: float, speed: float
) -> None:
    one = scene(
        speed,
        drive={"amplitude": 10.0, "frequency": frequency, "phase": phases[0]},
        belt_vibration={"velocity_amplitude": size, "phase": phases[1]},
    )
    other = equivalent_drive(one)
    assert other is not None

    assert other.scene.is_harmonic
    assert friction_free_velocity(other.scene) == pytest.approx(friction_free_velocity(one), rel=1e-13)
    found = [Exact().solve([each], LAW, 1e-9) for each in (one, other.scene)]
    assert found[0].status == found[1].status
    if found[0].status == ["ok"]:
        assert found[0].mean[0].real == pytest.approx(found[1].mean[0].real, abs=1e-10)


def test_what_is_no_sine_of_the_drive_has_no_equivalent_drive() -> None:
    for vibration in ({"waveform": "square"}, {"frequency_ratio": 2}, {"frequency_ratio": "3/2"}):
        assert equivalent_drive(scene(belt_vibration={**VIBRATION, **vibration})) is None
    pulsating = scene(belt_vibration=VIBRATION, normal_load_variation={"amplitude": 0.1})
    assert equivalent_drive(pulsating) is None
    assert equivalent_drive(scene()) is None


@pytest.mark.parametrize("method", [Mdsm(), HarmonicBalance()], ids=lambda method: method.name)
@pytest.mark.parametrize("drive", [True, False], ids=["driven", "by the belt alone"])
def test_models_of_one_harmonic_take_a_belt_that_vibrates_as_a_sine(method: Any, drive: bool) -> None:
    own = {} if drive else {"drive": None, "belt_vibration": {**VIBRATION, "frequency": 1.5}}
    scenes = [scene(speed, **{"belt_vibration": VIBRATION, **own}) for speed in (0.1, 1.0, 3.0, 11.0, 20.0)]
    found, exact = with_columns(method, scenes, LAW, 1e-6), with_columns(Exact(), scenes, LAW, 1e-9)

    assert found.status == ["ok"] * 5
    assert np.all(np.abs(found.mean.real - exact.mean.real) <= found.error + exact.error)
    # the columns are those of x1, not of its distance from the belt's vibration
    near = 0.2 if method.name == "mdsm" and not drive else 0.02
    amplitude = exact.columns["velocity_amplitude"]
    if method.name == "harmonic_balance" or drive:
        assert found.columns["velocity_amplitude"] == pytest.approx(amplitude, rel=0.2, abs=near)
    assert found.columns["velocity_harmonic"][-1] == pytest.approx(
        exact.columns["velocity_harmonic"][-1], abs=1e-9
    )
    assert found.columns["velocity_phase"] == pytest.approx(
        exact.columns["velocity_phase"], abs=20.0, nan_ok=True
    )
    assert np.all(np.isnan(found.columns["velocity_phase"]) == (not drive))


def test_bristles_are_balanced_over_a_vibrating_belt_too() -> None:
    law, one = Dahl(mu=0.4, presliding_length=0.3), scene(belt_vibration=VIBRATION)
    other = equivalent_drive(one)
    assert other is not None
    found, known = (HarmonicBalance().solve([each], law, 1e-3) for each in (one, other.scene))

    assert found.status == ["ok"]
    assert found.mean[0] == known.mean[0]
    assert found.error[0] == known.error[0]


@given(
    waveform=st.sampled_from(["square", "triangle", "sawtooth", "sine"]),
    phase=angles,
    lead=angles,
    speed=st.floats(0.05, 15.0),
)
@settings(max_examples=12)
def test_separation_of_motion_takes_every_waveform_with_an_error_that_covers(
    waveform: str, phase: float, lead: float, speed: float
) -> None:
    one = scene(
        speed,
        drive={"amplitude": 8.0, "frequency": 1.5, "waveform": waveform, "phase": phase},
        normal_load_variation={"amplitude": 0.3, "phase": lead, "frequency_ratio": 2},
    )
    found, exact = Mdsm().solve([one], LAW, 1e-3), Exact().solve([one], LAW, 1e-9)

    assert found.status == ["ok"]
    assert abs(found.mean[0].real - exact.mean[0].real) <= found.error[0] + exact.error[0]
    assert found.error[0] < 0.2
    if speed > friction_free_velocity(one, LAW):
        assert found.mean[0].real == pytest.approx(0.4, abs=1e-12)


def test_the_model_motion_is_the_friction_free_one() -> None:
    one = scene(30.0, drive={"amplitude": 8.0, "frequency": 1.5, "waveform": "square", "phase": 30.0})
    found, exact = (with_columns(method, [one], LAW, 1e-6) for method in (Mdsm(), Exact()))

    for column in ("velocity_amplitude", "velocity_harmonic", "velocity_phase", "energy_input", "period"):
        assert found.columns[column][0] == pytest.approx(exact.columns[column][0], rel=1e-9), column


def test_refusals_say_why() -> None:
    square = scene(drive={"amplitude": 8.0, "frequency": 1.5, "waveform": "square"})
    assert "takes sines" in (HarmonicBalance().refusal(square, LAW) or "")
    assert Mdsm().refusal(square, LAW) is None
    undamped = square.model_copy(update={"damping_ratio": 0.0})
    assert "damping" in (Mdsm().refusal(undamped, LAW) or "")
    falls = Stribeck(mu_kinetic=0.4, mu_static=0.5, stribeck_speed=1.0, curve="hyperbolic")
    gentle = square.model_copy(update={"normal_load": 0.9 * 0.2 / falls.steepest_fall()})
    assert Mdsm().refusal(gentle, falls) is None
    pulsating = scene(normal_load=gentle.normal_load, normal_load_variation={"amplitude": 0.5})
    assert "falls" in (Mdsm().refusal(pulsating, falls) or "") or "fall of friction" in (
        Mdsm().refusal(pulsating, falls) or ""
    )
    still = scene(0.0, drive={"amplitude": 0.2, "frequency": 1.5, "waveform": "triangle"})
    found = Mdsm().solve([still], LAW, 1e-6)
    assert found.status == ["refused"]
    assert "rest anywhere" in found.reason[0]


def test_a_prescribed_slip_has_no_closed_form_of_another_waveform() -> None:
    across = {"velocity_amplitude": 1.0, "frequency": 1.0, "waveform": "square", "direction": 90.0}
    one = Scene(belt_speed=0.5, slip=across)
    # square across: slip always at the same angle
    assert Mdsm().solve([one], LAW, 1e-9).mean[0].real == pytest.approx(0.4 * 0.5 / math.hypot(0.5, 1.0))
