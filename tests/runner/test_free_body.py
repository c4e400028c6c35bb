"""Bodies that no spring holds: their drift against integrations, what symmetry and balance ask, forces, studies."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from profiles import deep
from scipy.integrate import simpson, solve_ivp
from scipy.optimize import brentq

import frictionlab as fl
from frictionlab.values.notes import StudyError

MU, NORMAL = 0.3, 1.0
WAVES = {"harmonics": [{"order": 1, "amplitude": 1}, {"order": 2, "amplitude": 0.5, "phase": 40}]}


def plate(
    normal_load: float = NORMAL, belt_speed: float = 0.0, waveform: Any = WAVES, **more: Any
) -> fl.Scene:
    shaken = {"velocity_amplitude": 1, "frequency": 1, "waveform": waveform}
    more = {"damping_ratio": 0, "belt_vibration": shaken} | more
    return fl.Scene(spring=False, normal_load=normal_load, belt_speed=belt_speed, **more)


def velocity(tau: Any) -> Any:
    return np.sin(tau) + 0.5 * np.sin(2 * tau + math.radians(40))


def acceleration(tau: Any) -> Any:
    return np.cos(tau) + np.cos(2 * tau + math.radians(40))


SLIP = {"velocity_amplitude": 1, "frequency": 1}
PERIOD = 2 * math.pi
GRID = np.linspace(0.0, PERIOD, 4001)


def first(condition: Any, start: float) -> float:
    """Instant after this one at which a function of time becomes negative; the end of the period if it does not."""
    times = np.append(GRID[start + 1e-9 < GRID], PERIOD)
    below = np.flatnonzero(condition(times) < 0.0)
    if not len(below):
        return PERIOD
    before = times[below[0] - 1] if below[0] else start + 1e-9
    return (
        float(brentq(condition, before, times[below[0]], xtol=1e-15)) if condition(before) > 0.0 else before
    )


def drift_by_legs(decelerates: float, push: float, periods: int) -> float:
    """Mean velocity of a free block under Coulomb friction, its velocity straight in slip, the plate's in stick."""
    u, way = 0.0, 0.0
    for _ in range(periods):
        tau, way = 0.0, 0.0
        while tau < PERIOD - 1e-12:
            slip, jerk = velocity(tau) - u, acceleration(tau) - push
            if abs(slip) < 1e-12 and abs(jerk) <= decelerates:
                end = first(lambda t: decelerates - np.abs(acceleration(t) - push), tau)
                times = np.linspace(tau, end, 2001)
                way, tau, u = way + simpson(velocity(times), x=times), end, float(velocity(end))
                continue
            side = math.copysign(1.0, slip if abs(slip) >= 1e-12 else acceleration(tau + 1e-7) - push)
            a, start = side * decelerates + push, tau
            tau = first(lambda t, s=side, a=a, b=u, at=tau: s * (velocity(t) - b - a * (t - at)), tau)
            way, u = way + u * (tau - start) + 0.5 * a * (tau - start) ** 2, u + a * (tau - start)
    return way / PERIOD


@pytest.mark.parametrize(
    ("normal_load", "push", "periods"), [(0.2, 0.0, 400), (4.0, 0.0, 20), (1.0, 0.05, 150)]
)
def test_the_drift_of_a_block_is_that_of_its_legs_with_stick_and_without(
    normal_load: float, push: float, periods: int
) -> None:
    found = fl.drift_speed(plate(normal_load), fl.Coulomb(mu=MU), force=push)

    assert found.speed == pytest.approx(
        drift_by_legs(MU * normal_load, push, periods), abs=found.error + 1e-11
    )
    assert found.error < 1e-8
    there = fl.steady_state(found.scene, fl.Coulomb(mu=MU))
    assert there.mean_friction * normal_load == pytest.approx(-push, abs=1e-8)
    assert (there.stick_fraction > 0.1) is (normal_load >= 1.0)


@deep("stiff bristles for hundreds of periods")
@pytest.mark.parametrize(
    "law", [fl.Dahl(mu=MU, stiffness=3), fl.LuGre(mu_kinetic=MU, stiffness=20, damping=0.5)]
)
def test_held_by_its_mean_friction_a_body_on_bristles_stays(law: Any) -> None:
    state = fl.steady_state(plate(belt_speed=0.3), law)

    def rates(tau: float, y: Any) -> Any:
        slip = y[1] - 0.3 - velocity(tau)
        rate = law.rate(slip, y[2])
        return y[1], -law.friction(slip, y[2], rate) - state.mean_friction, rate

    moved, begun = [], np.array([0.0, 0.0, 0.0])
    for _ in range(40):
        done = solve_ivp(rates, (0.0, PERIOD), begun, "LSODA", rtol=1e-10, atol=1e-12)
        moved.append(done.y[0, -1] - begun[0])
        begun = done.y[:, -1]
    assert state.error < 1e-8
    assert np.abs(np.diff(moved))[-1] < 1e-7
    assert moved[-1] == pytest.approx(0.0, abs=1e-6)


def test_no_unit_no_sense_and_no_symmetry_changes_a_drift() -> None:
    law = fl.Coulomb(mu=MU)
    found = fl.drift_speed(plate(), law).speed
    mirrored = {"harmonics": [term | {"phase": term.get("phase", 0) + 180} for term in WAVES["harmonics"]]}
    in_si = fl.Scene.si(
        mass="2 kg", stiffness=0, normal_load=f"{2 * 3 * 5} N", belt_speed="1 m/s", length="1 m",
        belt_vibration={"velocity_amplitude": "3 m/s", "frequency": "5 rad/s", "waveform": WAVES},
    )  # fmt: skip

    assert fl.drift_speed(plate(waveform="sine"), law).speed == pytest.approx(0.0, abs=1e-9)
    assert found == pytest.approx(fl.drift_speed(plate(), law, within=(-0.5, 0.5)).speed, abs=1e-8)
    assert found == pytest.approx(fl.drift_speed(in_si, law).speed / 3, abs=1e-8)
    assert found == pytest.approx(-fl.drift_speed(plate(waveform=mirrored), law).speed, abs=1e-8)


def test_a_constant_load_is_a_force_and_a_dashpot_brakes() -> None:
    law, pushed = fl.Coulomb(mu=MU), plate(drive={"offset": 0.05})
    drift, damped = fl.drift_speed(pushed, law), plate(drive={"offset": 0.05}, damping_ratio=0.1)
    slower = fl.drift_speed(damped, law)

    assert drift.speed == pytest.approx(fl.drift_speed(plate(), law, force=0.05).speed, abs=1e-8)
    there = fl.steady_state(slower.scene, law).mean_friction
    assert there * NORMAL + 0.05 == pytest.approx(0.2 * slower.speed, abs=1e-7)


def test_above_all_velocities_of_the_plate_friction_is_that_of_sliding() -> None:
    state = fl.steady_state(plate(belt_speed=2.0), fl.Coulomb(mu=MU))

    assert state.mean_friction == pytest.approx(MU, abs=state.error)
    assert state.velocity_ratio > 1.0
    assert state.orbit(3)["slip"].to_numpy() == pytest.approx(
        -2.0 - velocity(PERIOD * np.arange(3) / 3), abs=1e-9
    )
    assert state.harmonics(2).friction_amplitude[0] == pytest.approx(-MU, abs=1e-9)


@pytest.mark.parametrize("law", [fl.Coulomb(mu=MU), fl.Coulomb(mu=MU, mu_static=0.4)])
def test_a_plate_too_weak_to_move_a_body_leaves_it_at_rest(law: fl.Coulomb) -> None:
    still = plate(belt_vibration=SLIP | {"velocity_amplitude": 0.1}, normal_load=2)

    pushed = still.with_(drive={"offset": -0.3})
    assert fl.drift_speed(still, law).speed == fl.drift_speed(still, law, force=0.3).speed == 0.0
    assert fl.drift_speed(pushed, law).speed == fl.drift_speed(pushed, law, force=0.6).speed == 0.0
    held = fl.steady_state(still.with_(initial={"x": 0}), law)
    assert held.velocity_amplitude == pytest.approx(0.1, rel=1e-9)


@pytest.mark.parametrize("waveform", ["triangle", {"points": [[0, 0], [0.2, 1], [0.5, -0.5], [1, 0]]}])
def test_a_force_with_corners_drives_a_free_body_however_soft_the_springs(waveform: Any) -> None:
    drive = {"amplitude": 0.47, "frequency": 3.7, "waveform": waveform}
    scene = plate(0.09, 0.0013, belt_vibration=None, damping_ratio=0.05, drive=drive)
    law = fl.Coulomb(mu=0.4)

    auto, shot = (fl.steady_state(scene, law, method) for method in ("auto", "shooting"))
    assert auto.error < 1e-8
    assert auto.mean_friction == pytest.approx(shot.mean_friction, abs=auto.error + shot.error)


def test_a_study_asks_for_the_drift_in_si_units() -> None:
    scene = {
        "mass": "10 g",
        "stiffness": 0,
        "belt_speed": "20 mm/s",
        "belt_vibration": {"velocity_amplitude": "0.1 m/s", "frequency": "50 Hz", "waveform": WAVES},
    }
    laws = [{"kind": "coulomb", "mu": 0.2}]
    study = {"schema": 1, "scene": {"dimensional": scene}, "laws": laws, "columns": ["usual", "drift"]}
    row = fl.run(study).table.iloc[0]
    found = fl.drift_speed(fl.Scene.si(**scene), fl.Coulomb(mu=0.2))

    assert row["status"] == "ok"
    assert row["drift_speed_m_per_s"] == pytest.approx(found.speed, abs=found.error)
    assert row["drift_speed_error_m_per_s"] == pytest.approx(found.error)
    assert "soft springs" in row["model"]


@pytest.mark.parametrize(
    ("ask", "said"),
    [
        (
            lambda: fl.drift_speed(fl.Scene(damping_ratio=0, normal_load=1, belt_speed=1), fl.Coulomb(mu=1)),
            "spring=False",
        ),
        (lambda: fl.drift_speed(plate(), fl.Coulomb(mu=MU), force=1.0), "more than friction balances"),
        (lambda: fl.drift_speed(plate(), fl.Coulomb(mu=MU), within=(0.5, 0.6)), "one sign from 0.5 to 0.6"),
        (lambda: fl.trajectory(plate(), fl.Coulomb(mu=MU)), "no spring holds the body: give it a soft one"),
        (lambda: fl.needs(plate(), fl.Coulomb(mu=MU)), "takes no body without a spring"),
        (lambda: plate(belt_vibration=None), "spring: a body that nothing shakes needs a spring"),
        (lambda: plate(body={"cubic_stiffness": 1}), "body: leave it out where no spring holds the body"),
        (
            lambda: fl.Scene.si(mass="1 kg", stiffness=0, damping_ratio=0.1, belt_speed=0),
            "damping_ratio: is of a spring",
        ),
        (lambda: fl.Scene.si(mass="1 kg", stiffness=0, belt_speed=0), "stiffness: a body that nothing"),
        (lambda: fl.Scene(spring=False, normal_load=1, belt_speed=1, slip=SLIP), "spring: leave it out"),
        (lambda: fl.Drive(offset=0.1, waveform="square"), "waveform: is of a force that varies"),
        (lambda: fl.drift_speed(plate(), fl.Coulomb(mu=MU), force=math.nan), "must be a number, got nan"),
        (lambda: fl.drift_speed(plate(), fl.Coulomb(mu=MU), within=(1.0,)), "within: must be two speeds"),  # type: ignore[arg-type]  # mistyped
        (lambda: fl.drift_speed(plate(), fl.Coulomb(mu=MU), within=(1, 1)), "within: must be two different"),
    ],
)
def test_what_a_free_body_cannot_do_is_told(ask: Any, said: str) -> None:
    with pytest.raises((ValueError, StudyError), match=said):
        ask()
