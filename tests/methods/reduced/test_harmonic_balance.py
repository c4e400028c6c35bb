"""One harmonic against its own equation, its limits, the paper's claims and its stated error."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from answered import with_columns
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from resonance import at_resonance as scene

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.reduced.harmonic_balance import HarmonicBalance
from frictionlab.methods.reduced.mdsm import Mdsm
from frictionlab.orbit.panels import WEIGHTS
from frictionlab.scene.scene import Drive, Load, Scene, Slip, Transverse
from frictionlab.theory import friction_free_velocity

REFERENCE = Path(__file__).parents[2] / "reference"
LAW = Coulomb(mu=0.4)
FIG_4 = {1.0: "sdof_fig4b_fig7a_Om1_g10.csv", 1.5: "sdof_fig4a_Om1.5_g10.csv"}

decades = st.floats(-2.5, 0.0).map(lambda exponent: 10.0**exponent)
frequencies = st.floats(-0.5, 1.0).map(lambda exponent: 10.0**exponent)


def driven(frequency, damping, ratio, share):
    """Unit load; friction over load, and belt speed over V_lin."""
    drive = Drive(amplitude=1.0, frequency=frequency)
    still = Scene(damping_ratio=damping, normal_load=ratio / LAW.mu, belt_speed=0.0, drive=drive)
    return still.model_copy(update={"belt_speed": share * friction_free_velocity(still)})


def solve(scenes):
    """Answers, each scene accepted."""
    scenes = [scenes] if isinstance(scenes, Scene) else scenes
    assert all(HarmonicBalance().refusal(one, LAW) is None for one in scenes)
    return with_columns(HarmonicBalance(), scenes, LAW, 1e-8)


def balance(one, amplitude):
    """Left side less right side of Eq. 8."""
    omega, friction, force = one.frequency, LAW.mu * one.normal_load, abs(one.mass().force)
    c = 4.0 * friction / math.pi
    held = c * omega * math.sqrt(max(0.0, 1.0 - (one.belt_speed / amplitude) ** 2))
    spring = (1.0 - omega**2) * amplitude
    return spring**2 + (2.0 * one.damping_ratio * omega * amplitude + held) ** 2 - (force * omega) ** 2


def read(file):
    """The columns of a reference file."""
    with (REFERENCE / file).open() as lines:
        rows = list(csv.DictReader(lines))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


@given(frequencies, decades, decades, st.floats(0.01, 0.999))
def test_the_amplitude_is_the_one_root_of_the_balance_found_by_bisection(
    frequency, damping, ratio, share
) -> None:
    one = driven(frequency, damping, ratio, share)
    low, high = one.belt_speed * 1e-12, friction_free_velocity(one) * (1 + 1e-12)
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if balance(one, middle) < 0.0 else (low, middle)

    found = with_columns(HarmonicBalance(), [one], LAW, 1e-8)

    assume(found.status[0] == "ok")
    assert found.columns["velocity_amplitude"][0] == pytest.approx(high, rel=1e-10)


@given(frequencies, decades, st.floats(0.01, 3.0), st.floats(0.01, 1.2))
def test_the_balance_rises_with_the_amplitude_so_that_it_has_one_root(
    frequency, damping, ratio, share
) -> None:
    one = driven(frequency, damping, ratio, share)
    amplitudes = friction_free_velocity(one) * np.linspace(1e-3, 1.5, 300)
    values = [balance(one, amplitude) for amplitude in amplitudes]

    assert np.all(np.diff(values) >= -1e-12 * np.abs(values).max())
    assert values[-1] > 0.0


@pytest.mark.parametrize("frequency", [1.0, 1.5])
def test_means_and_amplitudes_are_those_of_the_reference_curves(frequency: float) -> None:
    file = read(FIG_4[frequency])

    found = solve([scene(v, frequency) for v in file["v_b"]]).columns

    np.testing.assert_allclose(found["mean_friction"], file["mu_bar_hb_eq8"], rtol=0, atol=1e-11)
    np.testing.assert_allclose(found["velocity_amplitude"], file["V_hb_eq8"], rtol=1e-11)


def test_at_resonance_it_agrees_to_a_hundredth_of_friction() -> None:
    file = read(FIG_4[1.0])

    found = solve([scene(v) for v in file["v_b"]])
    true = np.abs(found.columns["mean_friction"] - file["mu_bar_exact"])

    assert set(found.status) == {"ok"}
    assert true.max() == pytest.approx(4.85e-3, abs=5e-6)
    assert file["v_b"][true.argmax()] == 45.0
    assert true.mean() == pytest.approx(1.4e-3, abs=5e-5)
    assert np.all(true <= found.columns["error"] + 1e-11)


def test_its_error_grows_off_resonance_and_covers_where_the_mass_sticks() -> None:
    file = read(FIG_4[1.5])

    found = solve([scene(v, 1.5) for v in file["v_b"]])
    true = np.abs(found.columns["mean_friction"] - file["mu_bar_exact"])
    sticks = file["stick_fraction"] > 0.0

    assert set(found.status) == {"ok"}
    assert true.max() == pytest.approx(2.17e-2, abs=5e-5)
    assert file["v_b"][true.argmax()] == 25.5
    assert sticks[true.argmax()]
    assert true.mean() == pytest.approx(1.9e-3, abs=5e-5)
    assert np.all(true <= found.columns["error"] + 1e-11)
    assert np.all(found.columns["error"][sticks] < 7e-2)


@pytest.mark.parametrize(
    ("frequency", "closed", "balanced"),
    [(1.1, 0.0685, None), (1.2, 0.0519, None), (1.3, 0.0444, None), (1.4, 0.0390, 0.0214)],
)
def test_surfaces_of_both_models_merge_as_the_frequency_leaves_resonance(
    frequency: float, closed: float, balanced: float | None
) -> None:
    scenes = [scene(v, frequency) for v in np.arange(0.0, 61.0)]
    true = with_columns(Exact(), scenes, LAW, 1e-9).columns["mean_friction"]
    free, one = with_columns(Mdsm(), scenes, LAW, 1e-8), solve(scenes)

    assert set(free.status) == set(one.status) == {"ok"}
    assert np.abs(free.columns["mean_friction"] - true).max() == pytest.approx(closed, abs=5e-5)
    assert np.all(np.abs(free.columns["mean_friction"] - true) <= free.columns["error"] + 1e-9)
    assert np.all(np.abs(one.columns["mean_friction"] - true) <= one.columns["error"] + 1e-9)
    if balanced is not None:
        assert np.abs(one.columns["mean_friction"] - true).max() == pytest.approx(balanced, abs=5e-5)


def test_it_tends_to_the_closed_form_in_proportion_to_friction() -> None:
    def apart(load):
        one = scene(20.0, normal_load=load)
        models = [with_columns(method, [one], LAW, 1e-8) for method in (Mdsm(), HarmonicBalance())]
        return abs(models[0].columns["mean_friction"][0] - models[1].columns["mean_friction"][0])

    differences = [apart(0.1 / 2**k) for k in range(4)]
    ratios = np.divide(differences[:-1], differences[1:])

    assert np.all((ratios > 1.8) & (ratios < 2.2))
    np.testing.assert_allclose(ratios[-1], 2.0, atol=0.01)


@pytest.mark.parametrize("frequency", [0.7, 1.0, 3.0])
def test_the_kink_is_at_v_lin(frequency: float) -> None:
    v_lin = friction_free_velocity(scene(0.0, frequency))

    scenes = [scene(v_lin * share, frequency, normal_load=1.0) for share in (1 - 1e-6, 1 - 1e-9, 1.0, 1.5)]
    found = with_columns(HarmonicBalance(), scenes, LAW, 1e-8).columns

    assert found["mean_friction"][0] < found["mean_friction"][1] < 0.4
    np.testing.assert_array_equal(found["mean_friction"][2:], 0.4)
    np.testing.assert_allclose(found["velocity_amplitude"][1:], v_lin, rtol=1e-8)
    # the velocity exceeds the belt's by the square of the distance to V_lin: at 1e-9 less than rounding leaves
    np.testing.assert_array_equal(found["reversals"][[0, 2, 3]], [2.0, 0.0, 0.0])


def test_means_are_odd_and_the_motion_is_the_same_for_a_belt_that_moves_back() -> None:
    forth, back = solve([scene(v) for v in (5.0, 40.0, 60.0)]), solve([scene(-v) for v in (5.0, 40.0, 60.0)])

    np.testing.assert_array_equal(back.columns["mean_friction"], -forth.columns["mean_friction"])
    np.testing.assert_array_equal(back.columns["error"], forth.columns["error"])
    for name in ("velocity_amplitude", "velocity_phase", "energy_input", "energy_contact"):
        np.testing.assert_allclose(back.columns[name], forth.columns[name], rtol=1e-12, atol=1e-9)


def test_energies_balance_and_columns_are_those_of_the_orbit() -> None:
    found = solve([scene(v, 1.2) for v in (1.0, 15.0, 29.0, 60.0)])
    columns = found.columns

    np.testing.assert_allclose(
        columns["energy_input"], columns["energy_viscous"] + columns["energy_friction"]
    )
    for i, v in enumerate((1.0, 15.0, 29.0, 60.0)):
        orbit = found.orbit(i)
        assert orbit is not None
        weights = 0.5 * np.ptp(orbit.tau, axis=1)[:, None] * WEIGHTS
        period = 2 * math.pi / 1.2
        load = 10 * 1.2**2 * np.sin(1.2 * orbit.tau)
        assert weights.sum() == pytest.approx(period)
        assert -(weights * orbit.friction.real).sum() / period == pytest.approx(columns["mean_friction"][i])
        assert (weights * orbit.x.real).sum() / period == pytest.approx(10 * columns["mean_friction"][i])
        assert (weights * load * orbit.v.real).sum() == pytest.approx(columns["energy_input"][i])
        taken = 10 * (weights * orbit.friction.real * orbit.v.real).sum()
        assert taken == pytest.approx(columns["energy_friction"][i], abs=1e-8)
        assert taken + v * 10 * columns["mean_friction"][i] * period == pytest.approx(
            columns["energy_contact"][i]
        )
        assert 0.5 * np.ptp(orbit.v.real) == pytest.approx(columns["velocity_amplitude"][i], rel=0.02)


def test_phase_and_amplitude_are_near_those_of_the_exact_first_harmonic() -> None:
    file = read(FIG_4[1.5])
    calm = (file["v_b"] > 0) & (file["v_b"] < 20)

    found = solve([scene(v, 1.5) for v in file["v_b"][calm]]).columns

    np.testing.assert_allclose(
        found["velocity_phase"], file["phase_first_harmonic_vs_load_deg"][calm], atol=1.0
    )
    np.testing.assert_allclose(found["velocity_harmonic"], file["V_first_harmonic"][calm], rtol=0.02)


def test_without_a_load_across_the_belt_the_plane_is_the_line() -> None:
    across = Transverse(natural_frequency=2.0, damping_ratio=0.1, load=Load(unbalance=0.0))

    line, plane = solve(scene(20.0)), solve(scene(20.0, transverse=across))

    assert plane.columns["mean_friction"][0] == line.columns["mean_friction"][0]
    assert plane.columns["mean_friction_transverse"][0] == 0.0
    assert np.isnan(line.columns["mean_friction_transverse"][0])
    assert "x2 decays" in plane.model[0]


@settings(derandomize=True, max_examples=40)  # an estimate: covers nearly always, and a test must not flicker
@given(frequencies, decades, st.floats(-3.0, 0.3).map(lambda e: 10.0**e), st.floats(0.01, 1.5))
def test_errors_cover_the_exact_mean(frequency, damping, ratio, share) -> None:
    one = driven(frequency, damping, ratio, share)
    true = with_columns(Exact(), [one], LAW, 1e-9).columns
    for method in (HarmonicBalance(), Mdsm()):
        found = with_columns(method, [one], LAW, 1e-8)
        if found.status[0] == "ok":
            apart = abs(found.columns["mean_friction"][0] - true["mean_friction"][0])
            assert apart <= found.columns["error"][0] + true["error"][0]
        else:
            assert "no useful bound" in found.reason[0]
            assert np.isnan(found.columns["mean_friction"][0])


@pytest.mark.parametrize("ratio", [0.7, 0.85])
def test_a_belt_at_rest_needs_a_load_above_the_first_harmonic_of_friction(ratio: float) -> None:
    found = with_columns(HarmonicBalance(), [driven(1.0, 0.1, ratio, 0.0)], LAW, 1e-8)

    if ratio < math.pi / 4:
        assert (found.status[0], found.columns["mean_friction"][0]) == ("ok", 0.0)
        assert found.columns["error"][0] < 1e-9
    else:
        assert found.status[0] == "refused"
        assert "4/pi" in found.reason[0]


def test_a_belt_at_rest_whose_load_never_beats_friction_is_refused() -> None:
    found = with_columns(HarmonicBalance(), [driven(1.0, 0.1, 1.1, 0.0)], LAW, 1e-8)

    assert found.status[0] == "refused"
    assert "static friction balances" in found.reason[0]


def test_friction_far_above_the_load_is_in_the_error() -> None:
    one = driven(1.0, 0.1, 3.0, 0.2)
    found = with_columns(HarmonicBalance(error="distance"), [one], LAW, 1e-8)
    true = with_columns(Exact(), [one], LAW, 1e-9)
    apart = abs(found.columns["mean_friction"][0] - true.columns["mean_friction"][0])

    assert found.status == ["ok"]
    assert apart <= found.columns["error"][0] < 1.01 * apart + 1e-8


def test_an_undamped_mass_that_never_reverses_is_refused() -> None:
    found = with_columns(
        HarmonicBalance(), [driven(2.0, 0.0, 0.1, 0.5), driven(2.0, 0.0, 0.1, 1.1)], LAW, 1e-8
    )

    assert found.status == ["ok", "refused"]
    assert "does not decay" in found.reason[1]


class Falling(FrictionLaw):
    """Friction with a memory, as far as a method can see."""

    def sliding_friction(self, speed):
        return 0.4


@pytest.mark.parametrize(
    ("one", "law", "because"),
    [
        (Scene(belt_speed=1, slip=Slip(velocity_amplitude=2, frequency=1)), LAW, "prescribed slip"),
        (Scene(belt_speed=1, damping_ratio=0.1, normal_load=1), LAW, "needs a drive"),
        (
            scene(5.0, transverse=Transverse(natural_frequency=1, damping_ratio=0.1, load=Load(unbalance=1))),
            LAW,
            "transverse",
        ),
        (scene(5.0, damping_ratio=0.0), LAW, "undamped resonance"),
        (scene(5.0), Coulomb(mu=0.4, mu_static=0.5), "mu_static"),
        (scene(5.0), Falling(), "memory"),
    ],
)
def test_scenes_outside_the_model_are_refused_with_the_reason(
    one: Scene, law: FrictionLaw, because: str
) -> None:
    reason = HarmonicBalance().refusal(one, law)

    assert reason is not None
    assert because in reason
