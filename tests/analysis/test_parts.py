"""Parts taken away leave the rest of a scene and of its law as they were."""

from __future__ import annotations

import cmath

import pytest

import frictionlab as fl
from frictionlab.analysis.needs.motion import CannotGo, LesserModel, friction_free_of
from frictionlab.analysis.needs.parts import (
    on_a_line,
    rigid,
    sines,
    steady_normal_load,
    undamped_bristles,
    without_fall,
    without_load_across,
    without_viscosity,
)
from frictionlab.laws.base import FrictionLaw

COULOMB, DAHL = fl.Coulomb(mu=0.4), fl.Dahl(mu=0.4, stiffness=40)
ACROSS = {"natural_frequency": 2, "damping_ratio": 0.2}
HARMONICS = {"harmonics": [{"order": 1, "amplitude": 0.5, "phase": 20}, {"order": 3, "amplitude": 1}]}


def model(law: FrictionLaw = COULOMB, **given: object) -> LesserModel:
    """A body with these parts and this law; a prescribed slip where one is given."""
    body = {} if "transverse_slip" in given else {"damping_ratio": 0.1, "normal_load": 2}
    return LesserModel(fl.Scene(**body | {"belt_speed": 3} | given), law)


@pytest.mark.parametrize("waveform", ["square", "triangle", "sawtooth", HARMONICS])
def test_a_waveform_leaves_its_first_harmonic(waveform: object) -> None:
    drive = {"unbalance": 3, "frequency": 2, "phase": 50, "waveform": waveform}
    full = model(drive=drive)
    left = sines(full)

    assert left is not None
    assert left.scene.is_harmonic
    assert left.scene.mass().force == pytest.approx(full.scene.mass().force)
    assert sines(left) is None


def test_a_drive_at_an_angle_leaves_its_part_along_the_belt() -> None:
    full = model(drive={"amplitude": 3, "frequency": 2, "phase": 10, "direction": 120}, transverse=ACROSS)
    line, free = on_a_line(full), without_load_across(full)

    assert line is not None
    assert free is not None
    assert line.scene.degrees_of_freedom == 1
    assert line.scene.mass().force == pytest.approx(full.scene.mass().force)
    assert free.scene.load_along_belt_only
    assert free.scene.mass().force == pytest.approx(full.scene.mass().force)
    with pytest.raises(CannotGo, match="backward"):
        on_a_line(full.with_scene(**{"drive.waveform": "sawtooth"}))


def test_a_slip_across_the_belt_alone_leaves_none() -> None:
    left = on_a_line(model(transverse_slip={"velocity_amplitude": 2, "frequency": 3}))

    assert left is not None
    assert not left.scene.planar
    assert left.scene.motion().velocity == 0


def test_a_belt_keeps_its_frequency_without_the_load_that_gave_it() -> None:
    shaken = {
        "normal_load_variation": {"amplitude": 0.2, "frequency": 2},
        "belt_vibration": {"velocity_amplitude": 1, "frequency_ratio": 3},
    }
    left = steady_normal_load(model(**shaken))

    assert left is not None
    assert left.scene.frequency == 6
    with pytest.raises(CannotGo, match="nothing else shakes"):
        steady_normal_load(model(normal_load_variation={"amplitude": 0.2, "frequency": 2}))


@pytest.mark.parametrize(
    "law",
    [
        fl.Dahl(mu=0.3, stiffness=10),
        fl.Jenkins(mu=0.3, stiffness=10),
        fl.LuGre(mu_kinetic=0.3, stiffness=10),
        fl.LuGre(
            mu_kinetic=0.3, mu_static=0.5, stribeck_speed=2, stribeck_exponent=1.5, stiffness=9, viscosity=0.1
        ),
        fl.ElastoPlastic(mu_kinetic=0.3, mu_static=0.5, stiffness=9),
    ],
)
def test_a_rigid_contact_has_the_friction_of_steady_sliding(law: FrictionLaw) -> None:
    left = rigid(model(law))

    assert left is not None
    assert left.law.memory_kind == "none"
    for speed in (0.0, 0.5, 3.0):
        assert left.law.sliding_friction(speed) == pytest.approx(law.sliding_friction(speed), rel=1e-14)


def test_what_the_friction_of_quick_sliding_leaves() -> None:
    stribeck = fl.Stribeck(mu_kinetic=0.3, mu_static=0.5, viscosity=0.1)
    flat = without_fall(model(stribeck))

    assert flat is not None
    assert flat.law.sliding_friction(0.0) == 0.3
    assert flat.law.sliding_friction(2.0) == pytest.approx(0.5)
    assert without_viscosity(flat) == model(fl.Coulomb(mu=0.3))
    assert without_fall(model(fl.Coulomb(mu=0.3, mu_static=0.4))) == model(fl.Coulomb(mu=0.3))
    assert without_fall(model()) is None
    assert undamped_bristles(model()) is None
    with pytest.raises(CannotGo, match="mu_kinetic is 0"):
        without_fall(model(fl.Stribeck(mu_kinetic=0, mu_static=0.5)))


class Peaked(fl.SlidingLaw):
    """Friction that needs both coefficients."""

    mu_kinetic: fl.Positive
    mu_static: fl.Positive

    def sliding_friction(self, speed: float) -> float:
        return self.mu_kinetic + (self.mu_static - self.mu_kinetic) / (1.0 + speed)


def test_a_law_that_must_have_static_friction_is_left_with_the_kinetic() -> None:
    flat = without_fall(model(Peaked(mu_kinetic=0.3, mu_static=0.4)))

    assert flat is not None
    assert flat.law.sliding_friction(0.0) == flat.law.sliding_friction(2.0) == 0.3


def test_bristles_on_the_friction_free_motion_have_their_slip_prescribed() -> None:
    full = model(
        DAHL,
        drive={"amplitude": 3, "frequency": 2, "phase": 10},
        transverse=ACROSS | {"load": {"amplitude": 1, "phase": 40}},
        belt_vibration={"velocity_amplitude": 0.5, "phase": 70, "direction": 90},
    )
    left = friction_free_of(full)

    assert left is not None
    assert left.scene.degrees_of_freedom == 0
    along = 3 * cmath.exp(1j * cmath.pi / 18) * 2j / (1 - 4 + 0.4j)
    across = cmath.exp(1j * cmath.pi * 2 / 9) * 2j / (4 - 4 + 1.6j) - 0.5 * cmath.exp(1j * cmath.pi * 7 / 18)
    assert left.scene.motion().velocity == pytest.approx(along)
    assert left.scene.motion().transverse_velocity == pytest.approx(across)


def test_the_friction_free_motion_of_a_body_that_remembers_is_that_of_its_receptance() -> None:
    body = {"relaxation": {"stiffness": 0.3, "time": 0.8}}
    left = friction_free_of(model(drive={"amplitude": 3, "frequency": 2, "phase": 10}, body=body))

    assert left is not None
    stiffness = 1 - 4 + 0.4j + 0.3 * 2j / (2j + 1 / 0.8)
    along = 3 * cmath.exp(1j * cmath.pi / 18) * 2j / stiffness
    assert left.scene.motion().velocity == pytest.approx(along)
    # what relaxes damps the resonance of the spring and mass beside it
    left = friction_free_of(model(drive={"amplitude": 3, "frequency": 1}, damping_ratio=0, body=body))
    assert left is not None
    assert left.scene.motion().velocity == pytest.approx(3 * (1j + 1 / 0.8) / 0.3)
    with pytest.raises(CannotGo, match="no sum of harmonics"):
        friction_free_of(model(drive={"amplitude": 1, "frequency": 2, "waveform": "square"}, body=body))


def test_what_has_no_friction_free_motion_says_so() -> None:
    with pytest.raises(CannotGo, match="nothing shakes"):
        friction_free_of(model())
    with pytest.raises(CannotGo, match="undamped resonance"):
        friction_free_of(model(DAHL, damping_ratio=0, drive={"amplitude": 1, "frequency": 1}))
    with pytest.raises(CannotGo, match="no sum of harmonics"):
        friction_free_of(model(DAHL, drive={"amplitude": 1, "frequency": 2, "waveform": "square"}))
