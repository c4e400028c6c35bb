"""Shooting against references by unrelated methods, closed forms, the exact method and its own error."""

from __future__ import annotations

import math

import collocation
import numpy as np
import pytest
from answered import with_columns
from collocation import REFERENCE
from profiles import DEEP, some

import frictionlab as fl
from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.shooting.method import Shooting
from frictionlab.motion.orbit.recorder import DERIVATIVE
from frictionlab.scene.scene import Drive, Initial, Load, Scene, Transverse
from frictionlab.theory.rest import resting_range, stays_at_rest

PLANAR = sorted(REFERENCE.glob("planar_fig*.csv"))
LAW = Coulomb(mu=0.4)


def scene(belt_speed, **changes):
    """Both loads at resonance along the belt, gamma^2 = 10, but for the changes."""
    values = {
        "damping_ratio": 0.1,
        "normal_load": 10.0,
        "drive": Drive(unbalance=10.0, frequency=1.0),
        "transverse": Transverse(natural_frequency=10.0, damping_ratio=0.1, load=Load(unbalance=10.0)),
        **changes,
    }
    return Scene(belt_speed=belt_speed, **values)


def solve(scenes, tolerance=1e-10, law=LAW):
    return with_columns(Shooting(), scenes, law, tolerance)


def of_reference(path, belt_speeds):
    """The scenes of a planar reference file."""
    numbers = collocation.numbers_of(path, 0.0)
    across = Transverse(
        natural_frequency=numbers.natural_frequency, damping_ratio=0.1, load=Load(unbalance=10.0)
    )
    drive = Drive(unbalance=10.0, frequency=numbers.frequency)
    return [
        scene(float(v), normal_load=numbers.friction / 0.4, drive=drive, transverse=across)
        for v in belt_speeds
    ]


def table_of(path):
    """A reference curve at belt speeds above zero."""
    return np.genfromtxt(path, delimiter=",", names=True)[1:]


def comfortable(path):
    """Ten belt speeds of a file, spread over those whose slip stays away from rest."""
    table = table_of(path)
    speeds = table["v_b"][table["min_vrel"] >= 0.01]
    return speeds[np.linspace(0, len(speeds) - 1, 10).round().astype(int)]


@some(1, "seconds of collocation")
@pytest.mark.parametrize("path", PLANAR, ids=lambda path: path.stem)
def test_below_the_accuracy_of_the_references_the_error_is_true_by_collocation(path):
    speeds = comfortable(path)[:: 1 if DEEP else 4]
    found = [collocation.solve(collocation.numbers_of(path, v)) for v in speeds]
    along, across = (
        -0.4 * np.array(mean) for mean in zip(*((f.along, f.across) for f in found), strict=True)
    )
    multipliers = [f.multiplier for f in found]
    assert max(f.change for f in found) < 1e-13
    for tolerance in (1e-8, 1e-9, 1e-10, 1e-12):
        columns = solve(of_reference(path, speeds), tolerance).columns
        assert np.all(columns["error"] <= tolerance)
        assert np.all(np.abs(columns["mean_friction"] - along) <= columns["error"] + 1e-13)
        assert np.all(np.abs(columns["mean_friction_transverse"] - across) <= tolerance)
        np.testing.assert_allclose(columns["floquet"], multipliers, rtol=0, atol=1e-7)


STICKING = np.arange(0.5, 60.01, 0.5)


def test_stick_in_the_plane_is_found_exactly_in_its_window():
    speeds = STICKING if DEEP else STICKING[78:104]  # 39.5 ... 52
    answers = solve([scene(float(v)) for v in speeds], 1e-8)
    assert answers.status == ["ok"] * len(speeds)
    assert np.all(answers.columns["error"] <= 1e-8)
    stuck = answers.columns["stick_fraction"] > 0.0
    assert list(speeds[stuck]) == list(np.arange(44.5, 49.51, 0.5))
    assert answers.columns["stick_fraction"].max() < 0.05


def stick_rich(belt_speed, **more):
    """Friction 4 above a load of 2.5: the mass stops twice a period."""
    drive = Drive(amplitude=2.5, frequency=0.5)
    return scene(float(belt_speed), drive=drive, **{"transverse": None, **more})


LINES = {
    "stick": [stick_rich(v) for v in np.linspace(0.05, 2.5, 64)],
    "grazing": [scene(float(v), transverse=None) for v in np.linspace(49.0, 50.02, 52)],
}


@pytest.mark.parametrize("name", LINES)
def test_one_degree_of_freedom_is_that_of_the_exact_method(name):
    scenes = LINES[name]
    ours, exact = solve(scenes, 1e-9), with_columns(Exact(), scenes, LAW, 1e-12)
    error = ours.columns["error"]
    assert ours.status == ["ok"] * len(scenes)
    assert np.all(error <= 1e-9)
    gap = np.abs(ours.columns["mean_friction"] - exact.columns["mean_friction"])
    assert np.all(gap <= error + exact.columns["error"])
    np.testing.assert_allclose(
        ours.columns["stick_fraction"], exact.columns["stick_fraction"], rtol=0, atol=1e-5
    )
    sticks = [each.columns["stick_fraction"] > 1e-8 for each in (ours, exact)]  # for longer than rounding can
    assert (sticks[0] == sticks[1]).all()


ORBITS = {
    "stick": scene(46.0),
    "ellipse": scene(
        20.0,
        drive=Drive(amplitude=8.0, frequency=0.7, phase=40.0),
        transverse=Transverse(
            natural_frequency=0.8, damping_ratio=1.5, load=Load(amplitude=11.0, phase=-75.0)
        ),
    ),
    "stops": scene(
        0.4,
        drive=Drive(amplitude=3.0, frequency=0.6),
        transverse=Transverse(natural_frequency=0.9, damping_ratio=0.2, load=Load(amplitude=2.0)),
    ),
    "line with stops": stick_rich(0.7),
}


@pytest.mark.parametrize("one", ORBITS.values(), ids=ORBITS)
def test_the_orbit_closes_and_obeys_coulomb_friction_and_the_equation_of_motion(one):
    orbit, mass = solve(one).orbit(0), one.mass()
    tau, x, v, stick = orbit.tau, orbit.x, orbit.v, orbit.stick
    half, slip, turn = (
        0.5 * np.ptp(tau, axis=1)[:, None],
        v - one.belt_speed,
        np.exp(1j * one.frequency * tau),
    )
    assert (tau[0, 0], tau[-1, -1]) == (0.0, pytest.approx(2.0 * math.pi / one.frequency, rel=1e-14))
    np.testing.assert_allclose(tau[1:, 0], tau[:-1, -1], rtol=1e-14)
    assert (np.diff(tau, axis=1) > 0.0).all()
    for values in (x, v):
        # slip below what matters is let go at once: the velocity steps by that much
        np.testing.assert_allclose(values[1:, 0], values[:-1, -1], rtol=0, atol=1e-5)
        assert abs(values[-1, -1] - values[0, 0]) <= 1e-8

    assert not slip[stick].any()
    assert (np.abs(orbit.friction[stick]) <= 0.4 * (1.0 + 1e-9)).all()
    sliding = ~stick[:, None] & (np.abs(slip) > 1e-3)
    np.testing.assert_allclose(
        orbit.friction[sliding], 0.4 * slip[sliding] / np.abs(slip[sliding]), atol=1e-9
    )

    long = (half > 1e-4)[:, 0]  # differences of rounded numbers over less mean nothing
    np.testing.assert_allclose((x @ DERIVATIVE.T / half)[long], v[long], rtol=0, atol=1e-5 * np.abs(v).max())
    along = (mass.force * turn).imag - mass.damping * v.real - mass.stiffness * x.real
    across = (mass.transverse_force * turn).imag - mass.transverse_damping * v.imag
    across -= mass.transverse_stiffness * x.imag
    forces, scale = (
        along + 1j * across - one.normal_load * orbit.friction,
        max(abs(mass.force), one.normal_load),
    )
    assert np.abs(v @ DERIVATIVE.T / half - forces)[long & ~stick].max() <= 3e-3 * scale
    assert np.abs(forces)[long & stick].max(initial=0.0) <= 1e-9 * scale


def pushed(belt_speed, along, across, turn=0.0, **more):
    """Friction 4 against loads of these sizes, the one across leading by ``turn`` degrees."""
    return scene(
        belt_speed,
        drive=Drive(amplitude=along, frequency=0.7),
        transverse=Transverse(
            natural_frequency=1.3, damping_ratio=0.1, load=Load(amplitude=across, phase=turn)
        ),
        **more,
    )


RESTING = {
    "planar": (pushed(0.0, 0.0, 2.4), math.sqrt(4.0**2 - 2.4**2)),
    "in phase, weak": (pushed(0.0, 1.5, 1.5), 4.0 - 1.5),
    "in phase, strong": (pushed(0.0, 2.5, 2.5), math.sqrt(4.0**2 - 12.5) / math.sqrt(2.0)),
    "circular": (pushed(0.0, 2.5, 2.5, 90.0), 4.0 - 2.5),
    "elliptic": (pushed(0.0, 3.0, 1.0, 60.0), None),
}


@some(2, "seconds of maps")
@pytest.mark.parametrize("name", RESTING)
def test_where_friction_holds_the_loads_on_a_belt_at_rest_every_rest_state_is_in_the_range(name):
    one, force = RESTING[name]
    answers = solve(one)
    low, high = answers.columns["mean_low"][0], answers.columns["mean_high"][0]
    assert answers.status == ["not_unique"]
    assert "scene.initial" in answers.reason[0]
    assert np.isnan(answers.columns["mean_friction"][0])
    assert low == -high
    if force is not None:
        assert high == pytest.approx(force / 10.0, abs=1e-5)
    turn = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 5000))
    along, across = (phasor * turn for phasor in (one.mass().force, one.mass().transverse_force))
    held = []
    for x, x2 in np.random.default_rng(1).uniform(-4.0, 4.0, (1000, 2)):
        gap = np.hypot(along.imag - x, across.imag - 1.3**2 * x2)
        if gap.max() < 4.0 * (1.0 - 1e-6):
            held.append((x, x2))
    assert len(held) > 5
    for x, x2 in held[:: max(1, len(held) // 5)]:
        told = solve(one.model_copy(update={"initial": Initial(x=x, x2=x2)}))
        assert told.status == ["ok"]
        assert "scene.initial" in told.reason[0]
        assert told.columns["mean_friction"][0] == pytest.approx(x / 10.0, abs=1e-9)
    furthest = max(x for x, _ in held) / 10.0
    assert 0.7 * high <= furthest <= high


def test_loads_in_phase_together_above_friction_leave_no_rest_though_each_is_below_it():
    assert resting_range(pushed(0.0, 2.8, 2.8), LAW) == pytest.approx(
        math.sqrt((4.0**2 - 2 * 2.8**2) / 2.0) / 10.0, abs=1e-6
    )
    assert resting_range(pushed(0.0, 3.0, 3.0), LAW) < 0.0
    assert not stays_at_rest(pushed(0.0, 3.0, 3.0), LAW)


def test_on_the_line_a_start_beyond_the_range_slides_into_it():
    for x in (-9.0, 2.5, 8.0):
        told = solve(stick_rich(0.0, initial=Initial(x=x)))
        assert told.status == ["ok"]
        assert told.columns["stick_fraction"][0] == 1.0
        assert abs(told.columns["mean_friction"][0]) <= 0.15


def test_loads_above_friction_move_the_mass_on_a_belt_at_rest():
    answers = solve(pushed(0.0, 4.1, 0.5))
    assert answers.status == ["ok"]
    assert abs(answers.columns["mean_friction"][0]) <= answers.columns["error"][0]
    assert 0.0 < answers.columns["stick_fraction"][0] < 1.0


UNDAMPED = {
    "resonance along": scene(5.0, damping_ratio=0.0),
    "resonance across": scene(
        5.0, transverse=Transverse(natural_frequency=1.0, damping_ratio=0.0, load=Load(unbalance=10.0))
    ),
    "both resonances": scene(
        5.0,
        damping_ratio=0.0,
        transverse=Transverse(
            natural_frequency=1.0, damping_ratio=0.0, load=Load(unbalance=10.0, phase=90.0)
        ),
    ),
    "resonance on the line": scene(5.0, damping_ratio=0.0, transverse=None, normal_load=1.0),
    "resonance held by friction": scene(5.0, damping_ratio=0.0, transverse=None, normal_load=30.0),
    "off resonance": scene(5.0, damping_ratio=0.0, drive=Drive(amplitude=3.0, frequency=0.6)),
    "critical": scene(5.0, damping_ratio=1.0),
    "overdamped": scene(5.0, damping_ratio=40.0),
}


@some(2, "seconds of maps")
@pytest.mark.parametrize("name", UNDAMPED)
def test_corner_cases_are_answered_or_fail_with_a_reason(name):
    answers = solve(UNDAMPED[name], 1e-7)
    columns = {key: values[0] for key, values in answers.columns.items()}
    if answers.status == ["ok"]:
        assert columns["error"] <= 1e-7
        assert abs(columns["mean_friction"]) <= 0.4 * (1.0 + 1e-12)
    else:
        assert answers.reason[0]
        assert np.isnan(columns["mean_friction"])


@pytest.mark.parametrize("belt_speed", [0.005, 0.0077, 0.012])
def test_slip_that_starts_and_stops_on_one_side_does_not_reverse(belt_speed):
    scene = fl.Scene(
        damping_ratio=0.08,
        normal_load=1,
        belt_speed=belt_speed,
        drive=fl.Drive(amplitude=0.21, offset=0.34, frequency=1.7),
        normal_load_variation=fl.NormalLoadVariation(amplitude=0.14, phase=45, frequency_ratio=1),
    )

    state = fl.steady_state(scene, fl.Coulomb(mu=0.47, mu_static=0.536))

    assert (state.status, state.reversals) == ("ok", 0)
    assert 0.1 < state.stick_fraction < 1
