"""One harmonic of Coulomb friction against its own equation, its limits, the paper's claims and its stated error."""

from __future__ import annotations

import math

import numpy as np
import pytest
from answered import beside_full_answers, with_columns
from hypothesis import given
from hypothesis import strategies as st
from profiles import some
from resonance import at_resonance as scene
from resonance import of_unit_load as driven
from resonance import reference_curve

from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.reduced.harmonic_balance import HarmonicBalance
from frictionlab.methods.reduced.mdsm import Mdsm
from frictionlab.theory import friction_free_velocity

LAW = Coulomb(mu=0.4)
ONE = HarmonicBalance()
FIG_4 = {1.0: "sdof_fig4b_fig7a_Om1_g10.csv", 1.5: "sdof_fig4a_Om1.5_g10.csv"}

decades = st.floats(-2.5, 0.0).map(lambda exponent: 10.0**exponent)
frequencies = st.floats(-0.5, 1.0).map(lambda exponent: 10.0**exponent)


def balance(one, amplitude):
    """Left side less right side of Eq. 8."""
    omega, friction, force = one.frequency, LAW.mu * one.normal_load, abs(one.mass().force)
    c = 4.0 * friction / math.pi
    held = c * omega * math.sqrt(max(0.0, 1.0 - (one.belt_speed / amplitude) ** 2))
    spring = (1.0 - omega**2) * amplitude
    return spring**2 + (2.0 * one.damping_ratio * omega * amplitude + held) ** 2 - (force * omega) ** 2


@given(frequencies, decades, decades, st.floats(0.01, 1.2))
def test_the_amplitude_is_the_one_root_of_a_balance_that_rises_with_it(
    frequency, damping, ratio, share
) -> None:
    one = driven(frequency, damping, 3.0 * ratio, share)
    amplitudes = friction_free_velocity(one) * np.linspace(1e-3, 1.5, 300)
    values = [balance(one, amplitude) for amplitude in amplitudes]
    found = with_columns(ONE, [one], LAW, 1e-8)

    assert np.all(np.diff(values) >= -1e-12 * np.abs(values).max())
    assert values[-1] > 0.0
    assert found.status == ["ok"]
    amplitude = found.columns["velocity_amplitude"][0]
    assert balance(one, amplitude * (1.0 - 1e-10)) < 0.0 < balance(one, amplitude * (1.0 + 1e-10))


@some(1, "whole curves")
@pytest.mark.parametrize(
    ("frequency", "most", "within", "at", "mean"),
    [(1.0, 4.85e-3, 5e-6, 45.0, 1.4e-3), (1.5, 2.17e-2, 5e-5, 25.5, 1.9e-3)],
)
def test_means_and_amplitudes_are_those_of_the_reference_curves_and_errors_cover_the_exact_ones(
    frequency, most, within, at, mean
) -> None:
    known = reference_curve(FIG_4[frequency])
    sticks = known["stick_fraction"] > 0.0
    calm = (known["v_b"] > 0) & (known["v_b"] < 20)

    found = with_columns(ONE, [scene(v, frequency) for v in known["v_b"]], LAW, 1e-8)
    columns, true = found.columns, np.abs(found.columns["mean_friction"] - known["mu_bar_exact"])

    assert set(found.status) == {"ok"}
    np.testing.assert_allclose(columns["mean_friction"], known["mu_bar_hb_eq8"], rtol=0, atol=1e-11)
    np.testing.assert_allclose(columns["velocity_amplitude"], known["V_hb_eq8"], rtol=1e-11)
    assert true.max() == pytest.approx(most, abs=within)
    assert known["v_b"][true.argmax()] == at
    assert sticks[true.argmax()]
    assert true.mean() == pytest.approx(mean, abs=5e-5)
    assert np.all(true <= columns["error"] + 1e-11)
    assert np.all(columns["error"][sticks] < 7e-2)
    if frequency == 1.5:
        phases, exact = columns["velocity_phase"][calm], known["phase_first_harmonic_vs_load_deg"][calm]
        np.testing.assert_allclose(phases, exact, atol=1.0)
        np.testing.assert_allclose(
            columns["velocity_harmonic"][calm], known["V_first_harmonic"][calm], rtol=0.02
        )


@pytest.mark.parametrize(
    ("frequency", "closed", "balanced"),
    [(1.1, 0.0685, None), (1.2, 0.0519, None), (1.3, 0.0444, None), (1.4, 0.0390, 0.0214)],
)
def test_surfaces_of_both_models_merge_as_the_frequency_leaves_resonance(
    frequency: float, closed: float, balanced: float | None
) -> None:
    scenes = [scene(v, frequency) for v in np.arange(0.0, 61.0)]
    for method, most in ((Mdsm(), closed), (ONE, balanced)):
        apart, _ = beside_full_answers(method, scenes, LAW)
        assert most is None or np.abs(apart).max() == pytest.approx(most, abs=5e-5)


def test_it_tends_to_the_closed_form_in_proportion_to_friction() -> None:
    differences = [
        abs(
            np.subtract(
                *(method.model_means([scene(20.0, normal_load=load)], LAW) for method in (Mdsm(), ONE))
            )[0]
        )
        for load in (0.1, 0.05, 0.025, 0.0125)
    ]
    ratios = np.divide(differences[:-1], differences[1:])

    assert np.all((ratios > 1.8) & (ratios < 2.2))
    np.testing.assert_allclose(ratios[-1], 2.0, atol=0.01)


@pytest.mark.parametrize("frequency", [0.7, 1.0, 3.0])
def test_the_kink_is_at_v_lin(frequency: float) -> None:
    v_lin = friction_free_velocity(scene(0.0, frequency))

    scenes = [scene(v_lin * share, frequency, normal_load=1.0) for share in (1 - 1e-6, 1 - 1e-9, 1.0, 1.5)]
    found = with_columns(ONE, scenes, LAW, 1e-8).columns

    assert found["mean_friction"][0] < found["mean_friction"][1] < 0.4
    np.testing.assert_array_equal(found["mean_friction"][2:], 0.4)
    np.testing.assert_allclose(found["velocity_amplitude"][1:], v_lin, rtol=1e-8)
    # the velocity exceeds the belt's by the square of the distance to V_lin: at 1e-9 less than rounding leaves
    np.testing.assert_array_equal(found["reversals"][[0, 2, 3]], [2.0, 0.0, 0.0])
