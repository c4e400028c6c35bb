"""A belt that vibrates as a sine, and the drive that does the same over a steady one."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from resonance import at_resonance

from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.exact.method import Exact
from frictionlab.scene.scene import Drive, Scene
from frictionlab.theory import friction_free_velocity
from frictionlab.theory.one_harmonic import equivalent_drive

LAW = Coulomb(mu=0.4)
VIBRATION = {"velocity_amplitude": 2.0, "phase": 70.0}


def vibrating(belt_speed: float = 1.0, **keys: Any) -> Scene:
    drive = Drive(amplitude=10.0, frequency=1.5, phase=20.0)
    given = {"normal_load": 1.0, "drive": drive, "belt_vibration": VIBRATION}
    return at_resonance(belt_speed, **(given | keys))


@given(
    phases=st.tuples(st.floats(0.0, 360.0), st.floats(0.0, 360.0)),
    frequency=st.floats(0.2, 4.0),
    size=st.floats(0.1, 9.0),
    speed=st.floats(-9, 9),
)
@settings(max_examples=25)
def test_a_sine_of_the_belt_is_an_equivalent_drive(phases, frequency, size, speed) -> None:
    drive = Drive(amplitude=10.0, frequency=frequency, phase=phases[0])
    one = vibrating(speed, drive=drive, belt_vibration={"velocity_amplitude": size, "phase": phases[1]})
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
        assert equivalent_drive(vibrating(belt_vibration={**VIBRATION, **vibration})) is None
    assert equivalent_drive(vibrating(normal_load_variation={"amplitude": 0.1})) is None
    assert equivalent_drive(at_resonance(1.0)) is None
