"""The exact method against closed forms, high-precision references, an unrelated integration and its own error."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from answered import with_columns
from hypothesis import example, given, settings
from hypothesis import strategies as st
from resonance import at_resonance as scene

from frictionlab.compile.cache import compiled
from frictionlab.compile.decorators import njit
from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.exact import continuation as curve
from frictionlab.methods.exact.forcing import forcing_of
from frictionlab.methods.exact.legs import first_zero
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.exact.oscillator import oscillator_at
from frictionlab.methods.exact.return_map import Fixed, impulse_error, passage
from frictionlab.motion.orbit.recorder import WEIGHTS
from frictionlab.scene.scene import Drive, Initial, Scene, Slip, TransverseSlip
from frictionlab.theory import (
    friction_free_velocity,
    mean_prescribed_circular,
    mean_prescribed_longitudinal,
    mean_prescribed_transverse,
)

REFERENCE = Path(__file__).parents[2] / "reference"
LAW = Coulomb(mu=0.4)


def solve(scenes, tolerance=1e-11, law=LAW):
    return with_columns(Exact(), scenes, law, tolerance)


def driven(load, frequency, damping, friction, belt_speed=0.0, waveform=None, **more):
    """P, Omega, b, f of the textbook; mu = 0.4."""
    drive = Drive(amplitude=load, frequency=frequency, waveform=waveform)
    return Scene(
        damping_ratio=damping, normal_load=friction / 0.4, belt_speed=belt_speed, drive=drive, **more
    )


def test_points_without_stick_agree_with_forty_digits():
    table = np.genfromtxt(
        REFERENCE / "sdof_bvp_highprecision.csv", delimiter=",", names=True, dtype=None, encoding=None
    )
    for row in table:
        drive = Drive(unbalance=10.0, frequency=float(row["Omega"]))
        answers = solve(scene(float(row["v_b"]), normal_load=float(row["gamma2"]), drive=drive), 1e-13)
        error = answers.columns["error"][0]
        assert error <= 1e-12
        assert abs(answers.columns["mean_friction"][0] - row["mu_bar_bvp_40digits"]) <= min(error, 1e-13)


@pytest.mark.parametrize(
    ("load", "frequency", "damping", "friction", "peak"),
    [
        (1.0, 0.8, 0.0, 0.2, 2.71141526),
        (1.0, 0.8, 0.001, 0.9, 0.06806752),  # with two stops (Shaw, 1986)
        (1.0, 1.5, 0.05, 0.8, 0.05223260),
    ],
)
def test_a_belt_at_rest_gives_den_hartogs_amplitude(load, frequency, damping, friction, peak):
    answers = solve(driven(load, frequency, damping, friction))
    orbit = answers.orbit(0)
    assert answers.status == ["ok"]
    assert abs(answers.columns["mean_friction"][0]) <= answers.columns["error"][0] + 1e-15
    peaks = orbit.x.real[np.isclose(orbit.v.real, 0.0, atol=1e-6)]
    assert np.abs(peaks).max() == pytest.approx(peak, abs=1e-8)


@pytest.mark.parametrize(
    ("frequency", "limit"), [(0.8, 0.81741), (0.9, 0.81965), (1.5, 0.64658), (2.0, 0.59629)]
)
def test_stops_begin_at_den_hartogs_limit(frequency, limit):
    below, above = (solve(driven(1.0, frequency, 0.0, limit * part)) for part in (0.999, 1.001))
    assert below.columns["stick_fraction"][0] == 0.0
    assert above.columns["stick_fraction"][0] > 0.0


@given(
    frequency=st.floats(0.2, 5.0),
    damping=st.floats(0.01, 3.0),
    ratio=st.floats(0.01, 3.0),
    speed=st.floats(-1.2, 1.2).filter(lambda value: abs(value) > 1e-3),
)
def test_mean_position_balances_mean_friction_and_energies_close(frequency, damping, ratio, speed):
    one = driven(1.0, frequency, damping, ratio, 1.0)
    one = driven(1.0, frequency, damping, ratio, speed * friction_free_velocity(one))
    answers = solve(one)
    columns, orbit = {name: values[0] for name, values in answers.columns.items()}, answers.orbit(0)
    assert answers.status == ["ok"]
    assert abs(columns["mean_friction"]) <= 0.4 * (1.0 + 1e-12)
    period = orbit.tau[-1, -1] - orbit.tau[0, 0]
    half = 0.5 * (orbit.tau[:, -1:] - orbit.tau[:, :1])
    mean_x = (half * WEIGHTS * orbit.x.real).sum() / period
    assert mean_x == pytest.approx(one.normal_load * columns["mean_friction"], abs=1e-11 * (1.0 + ratio))
    work = abs(columns["energy_input"]) + abs(columns["energy_viscous"]) + abs(columns["energy_friction"])
    closure = columns["energy_input"] - columns["energy_viscous"] - columns["energy_friction"]
    assert abs(closure) <= 1e-11 * (work + ratio * abs(one.belt_speed))
    assert columns["energy_contact"] >= -1e-12


def test_grazing_just_below_the_kink_is_not_missed():
    speeds = 50.0 * (1.0 - np.logspace(-2, -9, 36))
    answers = solve([scene(v) for v in speeds])
    lost = 0.4 - answers.columns["mean_friction"]
    assert np.all(answers.columns["error"] <= 1e-11)
    assert np.all(lost > 0.0)
    rate = np.diff(np.log(lost)) / np.diff(np.log(50.0 - speeds))
    assert rate[-1] == pytest.approx(1.0, abs=0.05)


def test_stick_rich_curves_are_solved_everywhere():
    answers = solve([driven(2.5, 0.5, 0.1, 4.0, v) for v in np.linspace(0.05, 2.5, 64)])
    assert answers.status == ["ok"] * 64
    assert np.all(answers.columns["error"] <= 1e-11)
    assert answers.columns["stick_fraction"].max() > 0.5
    assert np.all(np.diff(answers.columns["mean_friction"]) >= 0.0)


@njit
def first_zero_of(g, g1, g2, bound):
    return first_zero(g, g1, g2, bound)


coarse = st.integers(-1000, 1000).map(lambda hundredths: hundredths / 100.0)


@given(g=coarse.map(abs), g1=coarse, g2=coarse, bound=st.floats(0.01, 100.0))
@settings(max_examples=100)
def test_a_step_never_passes_the_first_zero_and_stays_close_to_it(g, g1, g2, bound):
    if g == 0.0:
        g1 = abs(g1)
    step = first_zero_of(g, g1, g2, bound)
    roots = np.roots([-bound / 6.0, 0.5 * g2, g1, g])
    zeros = roots[(np.abs(roots.imag) < 1e-7) & (roots.real > 1e-9)].real
    if len(zeros) == 0 or len(zeros) == 2:  # a zero at the origin, or a double one
        return
    inside = np.linspace(0.0, step, 200)[1:-1]
    below = g + inside * (g1 + inside * (0.5 * g2 - inside * bound / 6.0))
    size = g + abs(g1) * step + abs(g2) * step**2 + bound * step**3
    assert np.all(below >= -1e-12 * size)
    assert step >= 0.2 * min(zeros)


@njit
def one_period_from(forcing, belt_speed, x, w):
    """Mean friction over one period that starts anywhere, and the error that its failure to close gives it."""
    body = oscillator_at(forcing, belt_speed)
    here = passage(body, x, w, 0.0, body.period)
    unit = forcing.normal_load * body.period
    return -here.friction / unit, impulse_error(body, Fixed(x, w, here, 0.0, 1)) / unit


@pytest.mark.parametrize(
    "one", [scene(20.0), scene(46.0), driven(2.5, 0.5, 0.1, 4.0, 0.3), driven(2.5, 0.5, 0.1, 4.0, 1.0)]
)
def test_the_error_of_a_period_that_does_not_close_covers_its_mean_and_is_not_absurdly_wide(one):
    rows, forcing = np.zeros((1, 9)), forcing_of(one.mass(), 0.4)
    compiled(curve.continue_in_speed)(forcing, np.array([one.belt_speed]), rows)
    mean, x, w = rows[0, [curve.MEAN, curve.STATE_X, curve.STATE_W]]
    ratios = []
    for angle in np.arange(0.1, 6.0, 0.5):
        start = x + 1e-6 * math.cos(angle), w + 1e-6 * math.sin(angle)
        off, error = one_period_from(forcing, one.belt_speed, *start)
        ratios.append(abs(off - mean) / error)
    assert max(ratios) <= 1.0
    assert max(ratios) >= 0.03


@pytest.mark.parametrize(
    ("frequency", "ratio", "speed"), [(1.0, 0.4, 0.9), (30.0, 3.0, 0.1), (200.0, 1.5, 0.01), (0.05, 0.3, 0.5)]
)
def test_rounding_scatters_the_mean_by_less_than_the_error(frequency, ratio, speed):
    v_lin = friction_free_velocity(driven(1.0, frequency, 0.05, ratio, 1.0))
    means, errors = [], []
    for scale in np.linspace(1.0, 2.0, 41):  # the same scene in another unit of force and length
        answers = solve(driven(scale, frequency, 0.05, scale * ratio, scale * speed * v_lin))
        means.append(answers.columns["mean_friction"][0])
        errors.append(answers.columns["error"][0])
    assert np.ptp(means) <= min(errors) <= 1e4 * max(np.ptp(means), np.finfo(float).eps)


def test_permanent_stick_is_not_unique_and_the_start_decides():
    still = {"drive": Drive(unbalance=10.0, frequency=0.5)}
    answers = solve(scene(0.0, **still))
    assert answers.status == ["not_unique"]
    assert "the belt is at rest" in answers.reason[0]
    assert answers.columns["mean_low"][0] == pytest.approx(-0.15)
    assert answers.columns["mean_high"][0] == pytest.approx(0.15)
    assert answers.columns["window"][0] == 1.0
    for x, mean in ((-1.4, -0.14), (0.0, 0.0), (1.4, 0.14)):
        told = solve(scene(0.0, initial=Initial(x=x), **still))
        assert told.status == ["ok"]
        assert "reached from scene.initial" in told.reason[0]
        assert abs(told.columns["mean_friction"][0] - mean) <= told.columns["error"][0] <= 1e-11


def test_a_free_start_comes_to_rest_where_coulomb_friction_leaves_it():
    # (-1)^n (x0 - 2 n f), n = ceil((x0/f - 1)/2), undamped and without load
    still = Drive(amplitude=0.0, frequency=1.0)
    one = Scene(damping_ratio=0.0, normal_load=2.5, belt_speed=0.0, drive=still, initial=Initial(x=7.3))
    assert solve(one).columns["mean_friction"][0] * 2.5 == pytest.approx(-0.7, abs=1e-11)


@pytest.mark.parametrize("belt_speed", [0.0, 1.0, 30.0])
def test_undamped_resonance_is_bounded_exactly_where_friction_reaches_pi_over_4_of_the_load(belt_speed):
    third = {"harmonics": [{"order": 1, "amplitude": 1.0}, {"order": 3, "amplitude": 0.1}]}
    for shape in ({}, {"waveform": third}):
        below, above = (driven(1.0, 1.0, 0.0, 0.25 * math.pi * k, belt_speed, **shape) for k in (0.99, 1.01))
        below, above = solve(below), solve(above)
        assert below.status == ["failed"]
        assert "without bound" in below.reason[0]
        assert above.status == ["ok"]
        assert above.columns["error"][0] <= 1e-10


def test_near_undamped_resonance_no_digits_are_lost():
    at, near = (solve(driven(1.0, w, 0.0, 1.2, 0.3)).columns for w in (1.0, 1.0 + 1e-12))
    assert at["mean_friction"][0] == pytest.approx(near["mean_friction"][0], abs=1e-10)
    assert near["error"][0] <= 1e-11


def slip(belt_speed, along, across=None, turn=0.0):
    """Prescribed slip of amplitudes along and across, the second one leading by ``turn`` degrees."""
    part = Slip(velocity_amplitude=along, frequency=2.0) if along is not None else None
    own = 2.0 if part is None else None
    other = (
        TransverseSlip(velocity_amplitude=across, phase=turn, frequency=own) if across is not None else None
    )
    return Scene(belt_speed=belt_speed, slip=part, transverse_slip=other)


RATIOS = np.array([-3.0, -1.0, -0.4, 0.05, 0.3, 0.9, 0.999999, 1.0, 1.5])


@pytest.mark.parametrize(
    ("scenes", "closed_form"),
    [
        ([slip(2.0 * k, 2.0) for k in RATIOS], mean_prescribed_longitudinal),
        ([slip(2.0 * k, None, 2.0) for k in RATIOS], mean_prescribed_transverse),
        ([slip(2.0 * k, 2.0, 2.0, 90.0) for k in RATIOS], mean_prescribed_circular),
    ],
    ids=["longitudinal", "transverse", "circular"],
)
def test_prescribed_slip_meets_its_closed_forms(scenes, closed_form):
    answers = solve(scenes)
    error = answers.columns["error"]
    assert answers.status == ["ok"] * len(scenes)
    assert np.all(error <= 1e-13)
    assert np.all(np.abs(answers.columns["mean_friction"] - 0.4 * closed_form(RATIOS)) <= error + 1e-14)


def test_slip_through_rest_jumps_in_direction_and_no_slip_at_all_is_not_unique():
    through = solve([slip(0.0, 1.0, 1.0)])
    assert through.status == ["ok"]
    assert through.columns["mean_friction"][0] == through.columns["mean_friction_transverse"][0] == 0.0
    nothing = solve([slip(0.0, 0.0)])
    assert nothing.status == ["not_unique"]
    assert (nothing.columns["mean_low"][0], nothing.columns["mean_high"][0]) == (-0.4, 0.4)


@given(across=st.floats(1e-6, 10.0), turn=st.floats(0.0, 360.0), ratio=st.floats(-3.0, 3.0))
@example(across=1.0, turn=0.0, ratio=2.225073858507203e-309)
def test_an_elliptic_slip_agrees_with_a_fine_sum_and_keeps_its_energies(across, turn, ratio):
    answers = solve(slip(ratio, 1.0, across, turn))
    columns = {name: values[0] for name, values in answers.columns.items()}
    theta = (np.arange(400_000) + 0.5) * (2.0 * np.pi / 400_000)
    v = np.sin(theta) + 1j * across * np.sin(theta + np.radians(turn)) - ratio
    direction = v / np.maximum(np.abs(v), 1e-300)
    assert columns["error"] <= 1e-11
    assert columns["mean_friction"] == pytest.approx(-0.4 * direction.real.mean(), abs=2e-5)
    assert columns["mean_friction_transverse"] == pytest.approx(-0.4 * direction.imag.mean(), abs=2e-5)
    carried = ratio * columns["mean_friction"] * np.pi
    assert columns["energy_contact"] == pytest.approx(columns["energy_friction"] + carried, abs=1e-10)
