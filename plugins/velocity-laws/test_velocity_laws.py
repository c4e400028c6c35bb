"""Laws that vanish at rest: their values, slopes and limits, and their means beside an independent integration."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import pytest
from ambrosio import Ambrosio
from bengisu_akay import BengisuAkay
from brown_mcphee import BrownMcphee
from makkar import Makkar
from periodic_mean import mean_by_integration
from profiles import deep, some
from scipy.integrate import quad
from threlfall import Threlfall

import frictionlab as fl

THRELFALL = Threlfall(mu=0.4, rise_speed=0.3)
BENGISU = BengisuAkay(mu_kinetic=0.3, mu_static=0.4, peak_speed=0.3, fall=0.2)
AMBROSIO = Ambrosio(mu=0.4, free_speed=0.05, full_speed=0.3)
BROWN = BrownMcphee(mu_kinetic=0.3, mu_static=0.4, transition_speed=0.3, viscosity=0.01)
MAKKAR = Makkar(mu_kinetic=0.3, mu_excess=0.1, excess_rise=8, excess_fall=0.5, kinetic_rise=9, viscosity=0.01)
LAWS = [THRELFALL, BENGISU, AMBROSIO, BROWN, MAKKAR]
every_law = pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
WIDTH = 1e-9
ALONG = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=1, drive=fl.Drive(amplitude=3, frequency=1.5))
ACROSS = fl.Transverse(natural_frequency=0.5, damping_ratio=0.1, load=fl.Load(amplitude=2))


@every_law
def test_friction_vanishes_at_rest_and_says_so(law):
    assert law.sliding_friction(0.0) == law.static_friction() == 0.0
    assert law.vanishes_at_rest()


@pytest.mark.parametrize(
    ("law", "slope"),
    [
        (THRELFALL, 3 * 0.4 / 0.3),
        (BENGISU, 2 * 0.4 / 0.3),
        (AMBROSIO, 0.0),
        (BROWN, (4 * 0.3 + 0.1 / 0.75**2) / 0.3 + 0.01),
        (MAKKAR, 0.1 * (8 - 0.5) + 0.3 * 9 + 0.01),
    ],
    ids=lambda value: type(value).__name__,
)
def test_slope_at_rest_is_that_of_the_formula(law, slope):
    assert law.sliding_friction(1e-8) / 1e-8 == pytest.approx(slope, rel=1e-6)


@pytest.mark.parametrize(
    ("law", "mu"),
    [
        (Threlfall(mu=0.4, rise_speed=WIDTH), 0.4 * (1 - math.exp(-3))),
        (BengisuAkay(mu_kinetic=0.4, mu_static=0.4, peak_speed=WIDTH, fall=1), 0.4),
        (Ambrosio(mu=0.4, free_speed=0, full_speed=WIDTH), 0.4),
        (BrownMcphee(mu_kinetic=0.4, mu_static=0.5, transition_speed=WIDTH), 0.4),
        (
            Makkar(mu_kinetic=0.4, mu_excess=0.1, excess_rise=2e9, excess_fall=1e9, kinetic_rise=1e9),
            0.4,
        ),
    ],
    ids=lambda value: type(value).__name__,
)
def test_as_its_width_vanishes_friction_is_coulombs(law, mu):
    for speed in (1e-4, 0.01, 1.0, 100.0):
        assert law.sliding_friction(speed) == pytest.approx(mu, abs=1e-12)


@pytest.mark.parametrize(
    ("law", "mu"),
    [
        (THRELFALL, 0.4 * (1 - math.exp(-3))),
        (BENGISU, 0.3),
        (AMBROSIO, 0.4),
        (BrownMcphee(mu_kinetic=0.3, mu_static=0.4, transition_speed=0.3), 0.3),
        (Makkar(mu_kinetic=0.3, mu_excess=0.1, excess_rise=8, excess_fall=0.5, kinetic_rise=9), 0.3),
    ],
    ids=lambda value: type(value).__name__,
)
def test_far_from_rest_friction_is_kinetic(law, mu):
    assert law.sliding_friction(1e4) == pytest.approx(mu, abs=1e-11)


@pytest.mark.parametrize(
    ("law", "kink", "value"),
    [
        (THRELFALL, 0.3, 0.4 * (1 - math.exp(-3))),
        (BENGISU, 0.3, 0.4),
        (AMBROSIO, 0.05, 0.0),
        (AMBROSIO, 0.3, 0.4),
    ],
)
def test_friction_does_not_jump_where_its_formula_changes(law, kink, value):
    for speed in (kink * (1 - 1e-12), kink, kink * (1 + 1e-12)):
        assert law.sliding_friction(speed) == pytest.approx(value, abs=1e-11)


def test_bengisu_akay_peaks_at_static_friction():
    assert BENGISU.sliding_friction(0.3) == 0.4
    assert all(BENGISU.sliding_friction(0.3 * share) < 0.4 for share in (0.5, 0.99, 1.01, 2.0))


def test_ambrosio_is_free_up_to_one_speed_and_halfway_up_between_the_two():
    assert {AMBROSIO.sliding_friction(speed) for speed in (0.0, 0.02, 0.05)} == {0.0}
    assert AMBROSIO.sliding_friction(0.175) == pytest.approx(0.2)


def test_brown_mcphee_is_within_a_thousandth_of_its_static_friction_at_the_transition_speed():
    law = BrownMcphee(mu_kinetic=0.3, mu_static=0.4, transition_speed=0.3)

    assert law.sliding_friction(0.3) == pytest.approx(0.4 - 0.3 * (1 - math.tanh(4)), abs=1e-15)
    assert max(law.sliding_friction(0.003 * k) for k in range(1000)) < 0.4


def test_makkar_without_excess_is_a_smooth_step_and_viscosity():
    law = Makkar(mu_kinetic=0.3, mu_excess=0, excess_rise=8, excess_fall=0.5, kinetic_rise=9, viscosity=0.01)

    assert law.sliding_friction(0.2) == 0.3 * math.tanh(1.8) + 0.002
    assert law.monotone()


@pytest.mark.parametrize(
    ("law", "values", "told"),
    [
        (
            BengisuAkay,
            {"mu_kinetic": 0.5, "mu_static": 0.4, "peak_speed": 1, "fall": 1},
            "at least mu_kinetic, 0.5",
        ),
        (Ambrosio, {"mu": 0.4, "free_speed": 1, "full_speed": 1}, "above free_speed, 1"),
        (
            BrownMcphee,
            {"mu_kinetic": 0.5, "mu_static": 0.4, "transition_speed": 1},
            "at least mu_kinetic, 0.5",
        ),
        (
            Makkar,
            {"mu_kinetic": 0.4, "mu_excess": 0.1, "excess_rise": 1, "excess_fall": 2, "kinetic_rise": 1},
            "at most excess_rise, 1",
        ),
    ],
)
def test_parameters_that_contradict_each_other_are_refused(law, values, told):
    with pytest.raises(ValueError, match=told):
        law(**values)


@every_law
def test_methods_of_constant_friction_refuse_it_and_say_why(law):
    for method in ("exact", "harmonic_balance"):
        state = fl.steady_state(ALONG, law, method=method)
        assert state.status == "refused"
        assert "needs friction that does not vary with speed" in state.reason
    more = fl.HarmonicBalance(harmonics=3)
    assert (more.refusal(ALONG, law) is None) == ("harmonics: 3 or more take it" in state.reason)


@some(1, "kernels of its own")
@every_law
def test_along_the_belt_its_mean_is_that_of_an_independent_integration(law):
    state = fl.steady_state(ALONG, law, tolerance=1e-10)

    assert state.mean_friction == pytest.approx(mean_by_integration(ALONG, law.sliding_friction), rel=1e-8)
    assert state.status == "ok"


@deep("kernels of its own")
@every_law
def test_in_the_plane_its_mean_is_that_of_an_independent_integration(law):
    scene = ALONG.with_(transverse=ACROSS)

    state = fl.steady_state(scene, law, tolerance=1e-10)

    assert state.mean_friction == pytest.approx(mean_by_integration(scene, law.sliding_friction), rel=1e-8)
    assert state.status == "ok"


@pytest.mark.parametrize(
    ("law", "corners"), [(Threlfall(mu=0.4, rise_speed=1), [1]), (AMBROSIO, [0.05, 0.3])]
)
@pytest.mark.parametrize("belt_speed", [0.1, 1.0, 2.2, 3.2])
def test_under_a_prescribed_slip_its_mean_is_that_between_corners(law, corners, belt_speed):
    def friction(angle):
        slip = 3 * math.sin(angle) - belt_speed
        return -math.copysign(law.sliding_friction(abs(slip)), slip)

    shares = [(belt_speed + side * corner) / 3 for corner in [0, *corners] for side in (1, -1)]
    turns = [math.asin(share) for share in shares if abs(share) < 1]
    edges = sorted([0, math.tau, *(each % math.tau for turn in turns for each in (turn, math.pi - turn))])
    parts = [quad(friction, *pair, epsabs=1e-14, epsrel=1e-13)[0] for pair in pairwise(edges)]
    scene = fl.Scene(belt_speed=belt_speed, slip=fl.Slip(velocity_amplitude=3, frequency=1))

    state = fl.steady_state(scene, law)

    assert (state.status, state.mean_friction) == ("ok", pytest.approx(sum(parts) / math.tau, abs=1e-13))
    assert state.error < 1e-12


def test_friction_that_is_zero_at_the_speed_of_a_measure_has_one_elsewhere():
    scene = ALONG.with_(drive=fl.Drive(amplitude=10, frequency=1.5))
    law = Ambrosio(mu=0.4, free_speed=3, full_speed=5)

    assert fl.steady_state(scene, law, method=fl.March(stepper="smoothed")).status == "ok"
    assert fl.needs(scene, law, belt_speed=[0.1, 1, 3]).smallest is not None


@deep("kernels of its own")
@every_law
def test_as_the_belt_slows_down_the_mean_vanishes_in_proportion(law):
    means = [fl.steady_state(ALONG.with_(belt_speed=speed), law).mean_friction for speed in (1e-3, 2e-3)]

    assert means[1] == pytest.approx(2 * means[0], rel=1e-3)
    assert abs(fl.steady_state(ALONG.with_(belt_speed=0), law).mean_friction) < 1e-8


@deep("kernels of its own")
def test_its_curve_starts_at_zero_though_its_friction_is_that_of_quick_slip_at_every_point():
    law, speeds = Threlfall(mu=0.4, rise_speed=0.05), [0.1, 0.5, 1, 2, 3, 4, 5]

    row = fl.compare(ALONG, law, belt_speed=speeds).curves.iloc[0]

    assert {law.sliding_friction(speed) for speed in speeds} == {law.sliding_friction(1.0)}
    assert row["shape_start"] == row["shape_start_error"] == 0.0
    assert row["reversal_end_error"] > 0.01


@deep("kernels of its own")
def test_without_vibration_the_mean_is_that_of_steady_sliding_none_below_free_speed():
    for belt_speed, mean in ((0.01, 0.0), (0.175, 0.2), (1.0, 0.4)):
        state = fl.steady_state(ALONG.with_(drive=None, belt_speed=belt_speed), AMBROSIO)
        assert (state.status, state.stick_fraction) == ("ok", 0.0)
        assert state.mean_friction == pytest.approx(mean, abs=1e-12)


@deep("kernels of its own")
def test_its_study_keeps_its_promises():
    done = fl.run(Path(__file__).parent / "study.yaml")

    assert [verdict.sentence for verdict in done.verdicts if not verdict.passed] == []
    assert set(done.table["status"]) == {"ok"}


@deep("kernels of its own")
def test_a_chaotic_mean_of_a_law_without_friction_at_rest_is_told():
    scene = fl.Scene(
        damping_ratio=0.0324,
        normal_load=0.3042,
        belt_speed=0.00296,
        drive=fl.Drive(amplitude=0.0559, frequency=0.618),
    )
    law = Makkar(
        mu_kinetic=0.52,
        mu_excess=0.156,
        excess_rise=1145,
        excess_fall=114.5,
        kinetic_rise=1145,
        viscosity=0.4657,
    )

    state = fl.steady_state(scene, law)

    assert state.status == "ok"
    assert state.mean_friction == pytest.approx(0.3932, abs=2e-3)  # midpoint steps over 1000 periods
