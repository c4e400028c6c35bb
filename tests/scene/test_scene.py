"""Scenes: what they refuse and how they say it, and the numbers they hand to kernels."""

from __future__ import annotations

import cmath
import math
import pickle
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import scenes_in_the_plane, sizes

from frictionlab.scene.body import in_the_plane, on_the_line, restoring_force
from frictionlab.scene.scene import Drive, Initial, Load, Scene, Slip, Transverse, TransverseSlip
from frictionlab.scene.waveforms import WAVE_SHAPES
from frictionlab.values.notes import WrongValues

FREE = {
    "damping_ratio": 0.1,
    "normal_load": 10.0,
    "belt_speed": 5.0,
    "drive": {"unbalance": 10.0, "frequency": 1.5},
}
ACROSS = {"natural_frequency": 2.0, "damping_ratio": 0.2, "load": {"amplitude": 3.0, "phase": 30.0}}
PLANAR = FREE | {"transverse": ACROSS}
SLIDING = {"belt_speed": 5.0, "slip": {"velocity_amplitude": 3.0, "frequency": 2.0}}


def put(tree, path, value):
    """A copy with one value put at a dotted path."""
    head, _, rest = path.partition(".")
    return tree | {head: put(tree.get(head, {}), rest, value) if rest else value}


def without(tree, path):
    head, _, rest = path.partition(".")
    if rest:
        return tree | {head: without(tree[head], rest)}
    return {key: value for key, value in tree.items() if key != head}


NEGATIVE = ["damping_ratio", "drive.unbalance", "transverse.damping_ratio", "transverse.load.amplitude"]


@pytest.mark.parametrize("path", NEGATIVE)
def test_zero_is_allowed_where_it_makes_sense(path):
    assert Scene(**put(PLANAR, path, 0.0)).degrees_of_freedom == 2


def test_a_scene_without_a_drive_has_a_frequency_of_one_and_starts_at_rest_on_the_belt():
    one = Scene.model_validate(without(FREE, "drive"))

    assert one.undriven
    assert one.frequency == 1.0
    assert one.mass().force == 0.0
    assert one.load_along_belt_only
    assert (one.start.x, one.start.velocity) == (0.0, one.belt_speed)
    assert not Scene.model_validate(FREE).undriven
    assert not Scene.model_validate(SLIDING).undriven


def test_all_that_is_missing_is_named_at_once():
    with pytest.raises(WrongValues) as caught:
        Scene(belt_speed=5.0)
    assert [each.path for each in caught.value.mistakes] == ["damping_ratio", "normal_load"]


def test_a_prescribed_slip_has_the_frequency_of_the_one_that_has_one():
    across = {"velocity_amplitude": 1.0}

    assert Scene(**SLIDING, transverse_slip=across).frequency == 2.0
    assert Scene(belt_speed=1.0, transverse_slip=across | {"frequency": 3.0}).frequency == 3.0


def test_the_normal_load_of_a_prescribed_slip_is_one_unless_given():
    assert Scene(**SLIDING).normal_load == 1.0
    assert Scene(**SLIDING, normal_load=7.0).normal_load == 7.0
    assert Scene(**SLIDING).motion().normal_load == 1.0


@pytest.mark.parametrize(
    ("values", "degrees", "alone"),
    [
        (FREE, 1, True),
        (PLANAR, 2, False),
        (without(PLANAR, "transverse.load"), 2, True),
        (put(PLANAR, "transverse.load.amplitude", 0.0), 2, True),
        (SLIDING, 0, True),
        (SLIDING | {"transverse_slip": {"velocity_amplitude": 0.0}}, 0, True),
        (SLIDING | {"transverse_slip": {"velocity_amplitude": 1.0}}, 0, False),
    ],
)
def test_a_scene_knows_its_degrees_of_freedom_and_whether_anything_pushes_across(values, degrees, alone):
    scene = Scene(**values)
    assert (scene.degrees_of_freedom, scene.load_along_belt_only) == (degrees, alone)


@given(
    size=sizes(1e-3, 1e3),
    frequency=sizes(1e-2, 1e2),
    phase=st.floats(-720.0, 720.0),
    tau=st.floats(0.0, 50.0),
)
def test_a_load_is_a_sine_that_leads_by_its_phase(size, frequency, phase, tau):
    drives = (
        Drive(amplitude=size, frequency=frequency, phase=phase),
        Drive(unbalance=size / frequency**2, frequency=frequency, phase=phase),
    )
    expected = size * math.sin(frequency * tau + math.radians(phase))

    for drive in drives:
        load = (drive.phasor(frequency) * cmath.exp(1j * frequency * tau)).imag
        assert load == pytest.approx(expected, abs=1e-12 * size * (1.0 + frequency * tau))


def test_an_unbalance_pushes_with_the_square_of_the_frequency_on_both_axes():
    scene = Scene(**put(PLANAR, "transverse.load", {"unbalance": 2.0, "phase": 90.0}))

    assert scene.mass().force == pytest.approx(22.5)
    assert scene.mass().transverse_force == pytest.approx(4.5j)


def test_the_numbers_of_the_mass_are_those_of_the_equations_of_motion():
    mass = Scene(**PLANAR).mass()

    assert mass.damping == pytest.approx(0.2)
    assert mass.stiffness == 1.0
    assert mass.transverse_damping == pytest.approx(0.8)
    assert mass.transverse_stiffness == 4.0
    assert mass.normal_load == 10.0
    assert mass.frequency == 1.5
    assert mass.transverse_force == pytest.approx(cmath.rect(3.0, math.pi / 6.0))


def test_a_prescribed_motion_has_its_phases():
    scene = Scene(
        **put(SLIDING, "slip.phase", 60.0), transverse_slip={"velocity_amplitude": 2.0, "phase": -90.0}
    )
    motion = scene.motion()

    assert motion.velocity == pytest.approx(cmath.rect(3.0, math.pi / 3.0))
    assert motion.transverse_velocity == pytest.approx(-2.0j)
    assert motion.frequency == 2.0


def test_values_are_every_number_by_its_dotted_path():
    assert Scene(**PLANAR, initial={"x2": 1.5}).values() == {
        "damping_ratio": 0.1,
        "normal_load": 10.0,
        "belt_speed": 5.0,
        "drive.unbalance": 10.0,
        "drive.phase": 0.0,
        "drive.frequency": 1.5,
        "transverse.natural_frequency": 2.0,
        "transverse.damping_ratio": 0.2,
        "transverse.load.amplitude": 3.0,
        "transverse.load.phase": 30.0,
        "initial.x": 0.0,
        "initial.velocity": 0.0,
        "initial.x2": 1.5,
        "initial.velocity2": 0.0,
    }


@given(scene=scenes_in_the_plane())
def test_the_friction_free_response_solves_the_equations_of_motion(scene):
    mass, body = scene.mass(), in_the_plane(scene.mass())
    tau = np.linspace(0.0, 2.0 * math.pi / mass.frequency, 9)
    sine, cosine = np.sin(mass.frequency * tau), np.cos(mass.frequency * tau)
    x = body.reference_sine * sine + body.reference_cosine * cosine
    v = mass.frequency * (body.reference_sine * cosine - body.reference_cosine * sine)
    turn = np.exp(1j * mass.frequency * tau)
    load = (mass.force * turn).imag + 1j * (mass.transverse_force * turn).imag

    held = restoring_force(body, x, v) - mass.frequency**2 * x
    np.testing.assert_allclose(held, load, rtol=0, atol=1e-10 * (np.abs(load).max() + np.abs(x).max()))
    assert (body.balanced_sine, body.balanced_cosine) == (body.load_sine, body.load_cosine)


@given(scene=scenes_in_the_plane(), x=st.floats(-9, 9), v=st.floats(-9, 9))
def test_the_body_on_the_line_is_the_body_in_the_plane_without_what_is_across(scene, x, v):
    line, plane = on_the_line(scene.mass()), in_the_plane(scene.mass())

    assert restoring_force(line, x, v) == pytest.approx(restoring_force(plane, complex(x), complex(v)).real)
    assert restoring_force(plane, complex(x), complex(v)).imag == 0.0
    for name in ("load_sine", "load_cosine", "balanced_sine", "balanced_cosine"):
        assert getattr(line, name) == getattr(plane, name).real
    assert line.normal_load == plane.normal_load


no_smaller = st.floats(-9, 9, allow_subnormal=False)


@given(scene=scenes_in_the_plane(), x=no_smaller, v=no_smaller)
def test_springs_and_dashpots_act_along_their_own_axis(scene, x, v):
    mass, plane = scene.mass(), in_the_plane(scene.mass())
    across = restoring_force(plane, 1j * x, 1j * v)
    size = mass.transverse_damping * abs(v) + mass.transverse_stiffness * abs(x) + abs(x) + abs(v)

    assert across.real == pytest.approx(0.0, abs=1e-14 * size)
    expected = mass.transverse_damping * v + mass.transverse_stiffness * x
    assert across.imag == pytest.approx(expected, abs=1e-13 * size)


def test_at_undamped_resonance_the_load_drives_the_deviation_instead():
    body = on_the_line(
        Scene(**(FREE | {"damping_ratio": 0.0, "drive": {"amplitude": 3.0, "frequency": 1.0}})).mass()
    )

    assert (body.reference_sine, body.reference_cosine) == (0.0, 0.0)
    assert (body.load_sine, body.load_cosine) == (3.0, 0.0)
    assert (body.balanced_sine, body.balanced_cosine) == (0.0, 0.0)


def test_a_scene_is_frozen_hashes_and_survives_pickling():
    scene = Scene(**PLANAR)

    assert pickle.loads(pickle.dumps(scene)) == scene
    assert hash(Scene(**PLANAR)) == hash(scene)
    with pytest.raises(AttributeError, match="cannot be changed"):
        scene.belt_speed = 1.0


def test_parts_may_be_records_as_well_as_mappings():
    load = Load(amplitude=3.0, phase=30.0)
    across = Transverse(natural_frequency=2.0, damping_ratio=0.2, load=load)
    drive = Drive(unbalance=10.0, frequency=1.5)
    slip = Slip(velocity_amplitude=3.0, frequency=2.0)

    assert Scene(**(PLANAR | {"drive": drive, "transverse": across})) == Scene(**PLANAR)
    assert Scene(belt_speed=5.0, slip=slip) == Scene(**SLIDING)
    assert Scene(**PLANAR, initial=Initial(x=1.0)).initial == Initial(x=1.0)
    assert TransverseSlip(velocity_amplitude=1.0).frequency is None


@pytest.mark.parametrize("name", WAVE_SHAPES)
def test_the_page_on_scenes_has_the_formula_of_every_waveform(name: str) -> None:
    page = (Path(__file__).parents[2] / "docs" / "which.md").read_text(encoding="utf-8")

    assert f"| `{name}` | {WAVE_SHAPES[name].formula}".replace("-", "\u2212") in page
