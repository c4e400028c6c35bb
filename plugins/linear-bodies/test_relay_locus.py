"""Method relay_locus beside exact on plain bodies, beside motions followed in time, and in its limits."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import outside_memory
import outside_weyl
import pytest
from answered import with_columns
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st
from linear_bodies import curve, search
from linear_bodies.method import UNSOLVED, RelayLocus
from profiles import deep
from strategies import sizes
from truth import ROWS, law_of

import frictionlab as fl
from frictionlab import steady_state
from frictionlab.compile import cache
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.methods import auto
from frictionlab.methods.auto import Auto
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.march.method import March
from frictionlab.methods.shooting.method import Shooting
from frictionlab.motion.orbit.sample import phasors_of_panels
from frictionlab.scene.receptance import linear_body
from frictionlab.scene.scene import Body, Drive, Fractional, Initial, Relaxation, Scene, Transverse
from frictionlab.study import registry
from frictionlab.theory import friction_free_velocity

LAW = Coulomb(mu=0.4)
REFERENCE = Path(__file__).parent / "fractional_bodies.csv"


def driven(load, frequency, damping, friction, belt_speed=1.0, **more):
    """P, Omega, b, f of the textbook; mu = 0.4."""
    drive = Drive(amplitude=load, frequency=frequency)
    return Scene(
        damping_ratio=damping, normal_load=friction / 0.4, belt_speed=belt_speed, drive=drive, **more
    )


def fractional(coefficient, order):
    return Body(fractional=Fractional(coefficient=coefficient, order=order))


def relaxing(stiffness, time, order=1.0):
    return Body(relaxation=Relaxation(stiffness=stiffness, time=time, order=order))


def answers(method, scene, speeds):
    """A method's answers along these belt speeds."""
    scenes = [scene.at(float(speed)) for speed in speeds]
    assert method.refusal(scene, LAW) is None
    return with_columns(method, scenes, LAW, 1e-9)


@st.composite
def plain_curves(draw):
    """A linear body, weak friction and friction above the load, belts from slow to V_lin, not at it to rounding."""
    scene = driven(1.0, draw(sizes(0.25, 6.0)), draw(sizes(0.02, 2.0)), draw(sizes(0.02, 4.0)))
    shares = draw(
        st.lists(sizes(1e-3, 1.2).filter(lambda share: abs(share - 1.0) > 1e-9), min_size=2, max_size=4)
    )
    return scene, np.sort(shares) * friction_free_velocity(scene)


@settings(max_examples=25)
@given(plain_curves())
def test_a_plain_body_has_the_mean_that_exact_finds(curve):
    scene, speeds = curve

    ours, exact = answers(RelayLocus(), scene, speeds), answers(Exact(), scene, speeds)
    assume(UNSOLVED not in ours.reason)  # some ways from V_lin end before a point: it says so

    for i in range(len(speeds)):
        assert ours.status[i] == "ok"
        assert ours.mean[i] == pytest.approx(exact.mean[i], abs=1e-12)
        assert abs(ours.mean[i] - exact.mean[i]) <= ours.error[i] + exact.error[i]


def test_a_rest_too_short_to_be_seen_between_samples_is_found():
    """Slip comes within 1e-3 of the fastest to zero, between two samples, and rests there for 0.05."""
    scene = driven(1.0, 0.15656229372058034, 0.012477302715197083, 0.3600288998630936)
    speeds = [0.0011613]

    ours, exact = answers(RelayLocus(), scene, speeds), answers(Exact(), scene, speeds)

    assert ours.mean[0] == pytest.approx(exact.mean[0], abs=1e-12)
    assert ours.columns["stick_fraction"][0] == pytest.approx(exact.columns["stick_fraction"][0], abs=1e-10)


@deep("seconds of searches")
def test_a_motion_at_another_belt_speed_is_no_answer():
    """From V_lin, five times as fast, the way to this belt takes more steps than are tried."""
    scene = driven(1.0, 0.282960394676952, 0.03700697673720942, 1.4310699293007985)
    body, speeds = fractional(0.5149226978266934, 0.001), np.array([0.04282199])

    ours = answers(RelayLocus(), scene.with_(body=body), speeds)

    near = stiffer(scene, 0.5149226978266934, 0.0, speeds)[0]
    assert ours.status == ["failed"] or ours.mean[0] == pytest.approx(near, abs=2e-3)


def test_all_columns_of_a_plain_body_are_those_of_exact():
    scene = driven(10.0, 1.0, 0.1, 4.0)
    speeds = [-20.0, 0.0, 0.3, 5.0, 30.0, 48.0, 49.9, 60.0]

    ours, exact = answers(RelayLocus(), scene, speeds), answers(Exact(), scene, speeds)

    assert ours.status == ["ok"] * len(speeds)
    for name, values in exact.columns.items():
        if "error" not in name and name not in ("floquet", "seconds"):
            np.testing.assert_allclose(ours.columns[name], values, rtol=1e-9, atol=1e-9, err_msg=name)


def test_waves_of_belt_and_load_have_the_mean_that_exact_finds():
    waveform = {"harmonics": [{"order": 1, "amplitude": 1.0}, {"order": 3, "amplitude": 0.5, "phase": 70.0}]}
    scene = Scene(
        damping_ratio=0.1,
        normal_load=2.0,
        belt_speed=1.0,
        drive=Drive(amplitude=2.0, frequency=0.7, phase=20.0, waveform=waveform),
        belt_vibration={"velocity_amplitude": 1.5, "phase": 40.0, "frequency_ratio": 2.0},
    )
    speeds = [-3.0, -0.5, 0.0, 0.1, 1.0, 2.0, 4.0, 9.0]

    ours, exact = answers(RelayLocus(), scene, speeds), answers(Exact(), scene, speeds)

    assert ours.status == ["ok"] * len(speeds)
    np.testing.assert_allclose(ours.mean, exact.mean, atol=1e-12)
    for name in ("velocity_amplitude", "stick_fraction", "energy_input", "energy_contact"):
        np.testing.assert_allclose(ours.columns[name], exact.columns[name], rtol=1e-9, atol=1e-9)


@settings(max_examples=15)
@given(plain_curves(), st.floats(0.0, 360.0))
def test_a_triangle_has_the_mean_that_exact_finds(curve, phase):
    plain, speeds = curve
    scene = plain.with_(
        drive=Drive(amplitude=1.0, frequency=plain.frequency, waveform="triangle", phase=phase)
    )

    ours, exact = answers(RelayLocus(), scene, speeds), answers(Exact(), scene, speeds)

    assert ours.status == ["ok"] * len(speeds)
    np.testing.assert_array_less(np.abs(ours.mean - exact.mean), np.minimum(ours.error + exact.error, 1e-11))
    for name in ("stick_fraction", "energy_input", "velocity_amplitude"):
        np.testing.assert_allclose(
            ours.columns[name], exact.columns[name], rtol=1e-7, atol=1e-9, err_msg=name
        )


def test_order_one_is_a_dashpot():
    scene, speeds = driven(10.0, 1.0, 0.1, 4.0), [0.5, 5.0, 20.0, 24.0]

    ours = answers(RelayLocus(), scene.with_(body=fractional(0.2, 1.0)), speeds)

    np.testing.assert_allclose(
        ours.mean, answers(Exact(), scene.with_(damping_ratio=0.2), speeds).mean, atol=1e-13
    )


def stiffer(scene, stiffness, dashpot, speeds):
    """Means by ``exact`` of the plain body with spring 1 + stiffness and so much more dashpot: times in 1/sqrt(k),
    forces over k, velocities over sqrt(k)."""
    k = 1.0 + stiffness
    root, drive = math.sqrt(k), scene.drive
    plain = driven(
        drive.amplitude / k,
        drive.frequency / root,
        (scene.damping_ratio + 0.5 * dashpot) / root,
        0.4 * scene.normal_load / k,
    )
    return answers(Exact(), plain, speeds / root).mean


LIMITS = {
    "an order near one is a dashpot": (lambda c, e: fractional(c, 1.0 - e), 0.0, 1.0),
    "an order near zero is a spring to every harmonic": (fractional, 1.0, 0.0),
    "a spring that relaxes slowly is a spring": (lambda c, e: relaxing(c, 1.0 / e), 1.0, 0.0),
    "a spring that relaxes at once is nothing": (relaxing, 0.0, 0.0),
}
"""Bodies of a strength c, e from a limit; there c times so much spring and so much dashpot."""


def closing_in(scene, made, limit, speeds, distances):
    """Return the distance of the means of these bodies to those of the limit, over that of their numbers."""
    found = [np.abs(answers(RelayLocus(), scene.with_(body=made(e)), speeds).mean - limit) for e in distances]
    return [off / e for off, e in zip(found, distances, strict=True)]


@pytest.mark.parametrize("name", LIMITS)
@settings(max_examples=3, phases=[Phase.generate])
@given(plain_curves(), sizes(0.05, 2.0))
def test_a_body_nears_its_limit_as_fast_as_its_number_does(name, curve, strength):
    (scene, speeds), (made, spring, dashpot) = curve, LIMITS[name]
    limit = stiffer(scene, spring * strength, dashpot * strength, speeds)

    far, near = closing_in(scene, lambda e: made(strength, e), limit, speeds, (1e-4, 1e-5))

    np.testing.assert_allclose(far, near, rtol=2e-2, atol=1e-6)


@pytest.mark.parametrize(
    ("made", "limit"),
    [
        (lambda e: relaxing(0.5, 2.0, 1.0 - e), relaxing(0.5, 2.0)),
        (lambda e: relaxing(0.2 / e, e * e, 0.5), fractional(0.2, 0.5)),
        (lambda e: relaxing(0.2 / e, e), fractional(0.2, 1.0)),
    ],
    ids=[
        "of order one it is the standard linear solid",
        "stiff and relaxing at once it is a power",
        "of order one as well, a dashpot",
    ],
)
def test_a_fractional_zener_element_nears_its_limits(made, limit):
    scene, speeds = driven(2.0, 0.8, 0.1, 0.7), np.array([0.2, 1.0])
    there = answers(RelayLocus(), scene.with_(body=limit), speeds).mean

    far, near = closing_in(scene, made, there, speeds, (2e-3, 1e-3))

    np.testing.assert_allclose(far, near, rtol=1e-2)


@pytest.mark.parametrize("case", outside_memory.CASES)
def test_a_relaxing_spring_is_the_motion_with_one_state_more(case):
    frequency, load, limit, belt_speed = case
    body = outside_memory.Body(0.2, [1.0 / 2.0], [0.5])
    mean, rested = outside_memory.Scene(body, load, frequency, limit, belt_speed).solved()
    scene = driven(load, frequency, 0.1, limit, body=relaxing(0.5, 2.0))

    ours = answers(RelayLocus(), scene, [belt_speed])

    assert ours.mean[0] == pytest.approx(0.4 * mean, abs=1e-12)
    assert ours.columns["stick_fraction"][0] == pytest.approx(rested, abs=1e-10)


@deep("seconds of steps")
def test_a_fractional_body_has_the_mean_of_elements_that_relax_and_of_steps_in_time():
    """Reference: ``python outside_memory.py``, 86 elements a body; they are good to about 1e-9."""
    table = np.genfromtxt(REFERENCE, delimiter=",", names=True)
    assert len(table) >= 20
    found = []

    for row in table:
        scene = driven(row["load"], row["frequency"], 0.1, row["limit"], body=fractional(0.2, row["q"]))
        ours = answers(RelayLocus(), scene, [row["belt_speed"]])
        case = row["frequency"], row["load"], row["limit"], row["belt_speed"]
        steps = [outside_weyl.mean_over_limit(0.2, row["q"], 0.2, case, n) for n in (100, 200, 400)]
        found.append((ours.mean[0] / 0.4, *steps))

        assert ours.mean[0] == pytest.approx(0.4 * row["mean"], abs=2e-9)
        assert ours.columns["stick_fraction"][0] == pytest.approx(row["stick_fraction"], abs=1e-6)

    off = np.abs(np.array(found)[:, 1:] - np.array(found)[:, :1])
    changes = np.abs(np.diff(np.array(found)[:, 1:]))
    assert (off[:, 2] <= changes[:, 1] + changes[:, 0] / 4.0).all()
    sizes_of_error = np.sqrt((off**2).mean(axis=0))
    assert sizes_of_error[2] < 2e-5
    assert sizes_of_error[0] / sizes_of_error[2] == pytest.approx(16.0, rel=0.3)  # of second order


@pytest.mark.parametrize(
    ("case", "mean", "apart"),
    [((1.0, 10.0, 4.0, 10.0), 0.1606837, 7.29e-4), ((0.7, 4.9, 1.0, 3.0), 0.1703979, 1.398e-3)],
)
def test_spring_and_dashpot_that_answer_the_drive_alike_leave_another_mean(case, mean, apart):
    frequency, load, limit, belt_speed = case
    scene, at = driven(load, frequency, 0.1, limit), 0.2 * (1j * frequency) ** 0.5

    ours = answers(RelayLocus(), scene.with_(body=fractional(0.2, 0.5)), [belt_speed]).mean[0]
    alike = stiffer(scene, at.real, at.imag / frequency, np.array([belt_speed]))[0]

    assert ours == pytest.approx(mean, abs=1e-7)
    assert ours / alike - 1.0 == pytest.approx(apart, rel=1e-3)


def test_what_the_load_gives_goes_to_dashpot_memory_and_friction():
    """Sum the loss in memory harmonic by harmonic; beyond, velocities fall with the square of the order."""
    body = Body(
        fractional=Fractional(coefficient=0.5, order=0.4),
        relaxation=Relaxation(stiffness=0.4, time=2.0, order=0.7),
    )
    scene = driven(2.0, 1.0, 0.1, 1.5, belt_speed=0.3, body=body)
    found = answers(RelayLocus(), scene, [0.3])
    orbit, omega = found.orbit(0), np.arange(1.0, 200.0)

    dashpots = (linear_body(scene).dynamic_stiffness(1j * omega) / (1j * omega)).real
    lost = math.pi * (dashpots * np.abs(phasors_of_panels(orbit.tau, orbit.v.real, omega)) ** 2).sum()

    assert found.columns["stick_fraction"][0] > 0.0
    assert found.columns["energy_viscous"][0] == pytest.approx(lost, rel=3e-8)


def test_velocity_and_friction_obey_the_frequency_response_in_every_harmonic():
    body = fractional(0.5, 0.4)
    scene = driven(2.0, 0.8, 0.1, 1.5, belt_speed=0.5, body=body)
    orbit = RelayLocus().solve([scene], LAW, 1e-9).orbit(0)
    omega = 0.8 * np.arange(1.0, 40.0)

    velocity, friction = (
        phasors_of_panels(orbit.tau, orbit.v.real, omega),
        phasors_of_panels(orbit.tau, orbit.friction.real, omega),
    )

    force = -scene.normal_load * friction
    force[0] += 2.0
    np.testing.assert_allclose(
        velocity, 1j * omega * linear_body(scene).receptance(omega) * force, atol=1e-11
    )


def test_a_belt_at_rest_that_holds_the_body_leaves_its_place_open():
    body = fractional(0.5, 0.4)

    ours = RelayLocus().solve([driven(1.0, 0.8, 0.1, 1.5, belt_speed=0.0, body=body)], LAW, 1e-9)

    assert ours.status == ["not_unique"]
    # friction is the load less the spring: it may be off by limit less load either way
    assert (ours.mean_low[0], ours.mean_high[0]) == pytest.approx((-0.5 / 3.75, 0.5 / 3.75))


def test_its_study_keeps_its_promises():
    done = fl.run(Path(__file__).parent / "study.yaml")

    assert [verdict.sentence for verdict in done.verdicts if not verdict.passed] == []
    assert set(done.table["status"]) == {"ok"}


def test_kernels_and_kept_answers_are_named_by_its_code(monkeypatch):
    before = cache._fingerprint(curve.follow_curve)
    monkeypatch.setattr(search, "MOST_NEWTONS", search.MOST_NEWTONS + 1)

    assert cache._fingerprint(curve.follow_curve) != before
    assert registry.method_code("relay_locus") != ""
    assert registry.method_code("auto") == registry.method_code("relay_locus")


def test_without_it_auto_says_what_to_install(monkeypatch):
    scene = driven(10.0, 1.0, 0.1, 4.0, body=relaxing(0.5, 2.0))
    monkeypatch.setattr(auto, "_for_memory", lambda: ())

    state = steady_state(scene, LAW)

    assert state.status == "refused"
    assert "frictionlab-linear-bodies" in state.reason
    assert "relay_locus" in state.reason
    assert friction_free_velocity(scene) > 0.0
    assert steady_state(scene.with_(body=None), LAW).status == "ok"


def test_auto_takes_it_where_a_body_remembers_and_tells_what_it_cannot_do():
    body = relaxing(0.5, 2.0)
    scene = driven(10.0, 1.0, 0.1, 4.0, body=body)

    assert Auto().choice(scene, LAW)[0] == RelayLocus()
    assert "Coulomb friction alone" in RelayLocus().refusal(scene, Dahl(mu=0.4, stiffness=10.0))
    across = Transverse(natural_frequency=1.0, damping_ratio=0.1)
    assert "one line" in RelayLocus().refusal(scene.with_(transverse=across), LAW)
    square = scene.with_(drive=Drive(amplitude=1.0, frequency=1.0, waveform="square"))
    assert "sines" in RelayLocus().refusal(square, LAW)
    cubic = scene.with_(body=Body(relaxation=body.relaxation, cubic_stiffness=0.1))
    assert RelayLocus().refusal(cubic, LAW) == "relay_locus does not take body.cubic_stiffness"


ACROSS = Transverse(natural_frequency=1.0, damping_ratio=0.1, load={"amplitude": 1.0})


@pytest.mark.parametrize("method", [Auto(), Shooting(), March()])
@pytest.mark.parametrize("body", [relaxing(0.5, 2.0), fractional(0.2, 0.5)])
@pytest.mark.parametrize(
    ("change", "law"),
    [
        ({}, Dahl(mu=0.4, stiffness=10.0)),
        ({}, Coulomb(mu=0.4, mu_static=0.5)),
        ({"transverse": ACROSS}, LAW),
        ({"drive": None, "initial": Initial(x=1.0)}, LAW),
    ],
)
def test_what_else_moves_a_body_that_remembers_is_refused_by_what_to_use(method, body, change, law):
    scene = driven(10.0, 1.0, 0.1, 4.0, body=body).with_(change)
    found = steady_state(scene, law, method=method)

    assert found.status == "refused"
    assert "relay_locus" in found.reason
    assert "springs and dashpots" in found.reason or "leave transverse" in found.reason
    assert method.refusal(scene.with_(body=None), law) is None


@pytest.mark.parametrize("name", ["random sine 2", "random sine 38"])
def test_a_rest_of_a_hundred_thousandth_of_the_period_is_no_reversal(name):
    row = ROWS[name]

    found = RelayLocus().solve([Scene(**row.scene)], law_of(row.law), 1e-9)

    assert found.status == ["ok"]
    assert abs(found.mean[0].real - row.mean) <= found.error[0] + row.accuracy
