"""What every reduced model must do: refuse with a reason, mirror, balance, and state an error that covers."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from answered import beside_full_answers, moves_as_its_velocity, with_columns
from profiles import deep, some
from resonance import at_resonance as scene
from resonance import in_the_plane as planar
from resonance import of_unit_load as driven

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.jenkins import Jenkins
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.stribeck import Stribeck
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.reduced.harmonic_balance import HarmonicBalance
from frictionlab.methods.reduced.mdsm import Mdsm
from frictionlab.motion.orbit.recorder import WEIGHTS
from frictionlab.scene.scene import Drive, Load, Scene, Slip, Transverse
from frictionlab.theory.one_harmonic import equivalent_drive

LAW = Coulomb(mu=0.4)
SOFT = Dahl(mu=0.4, presliding_length=0.5)
STRIBECK = Stribeck(mu_kinetic=0.3, mu_static=0.4, stribeck_speed=30.0)
MILD = Stribeck(mu_kinetic=0.39, mu_static=0.4, stribeck_speed=5.0)
FALLING = Stribeck(mu_kinetic=0.1, mu_static=0.4, stribeck_speed=0.1)
GENTLE = Stribeck(mu_kinetic=0.4, mu_static=0.5, stribeck_speed=1.0, curve="hyperbolic")
STICTION = Coulomb(mu=0.4, mu_static=0.5)
MDSM, ONE, THREE = Mdsm(), HarmonicBalance(), HarmonicBalance(harmonics=3)
WITH_A_TAIL = HarmonicBalance(harmonics=2, tail=True)
SLIPPING = Scene(belt_speed=1, slip=Slip(velocity_amplitude=2, frequency=1))
UNDRIVEN = Scene(belt_speed=1, damping_ratio=0.1, normal_load=1)
UNDAMPED = scene(5.0, damping_ratio=0.0)
LIGHT = 0.9 * 0.2 / GENTLE.steepest_fall()
PULSATING = scene(1.0, normal_load=LIGHT, normal_load_variation={"amplitude": 0.5})
VIBRATION = {"velocity_amplitude": 2.0, "phase": 70.0}


class Remembering(FrictionLaw):
    """Friction with a memory, as far as a method can see."""

    def sliding_friction(self, speed):
        return 0.4


def shaped(belt_speed, waveform, amplitude=8.0, **changes):
    """A load of another waveform."""
    drive = Drive(amplitude=amplitude, frequency=1.5, waveform=waveform, phase=30.0)
    return scene(belt_speed, drive=drive, **changes)


# --- refusals -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("method", "one", "law", "because"),
    [
        (MDSM, UNDRIVEN, LAW, "needs a drive"),
        (MDSM, UNDAMPED, LAW, "undamped resonance"),
        (MDSM, scene(5.0), STICTION, "mu_static"),
        (MDSM, planar(), STICTION, "fall of friction"),
        (MDSM, scene(5.0), FALLING, "fall of friction"),
        (MDSM, scene(5.0), Remembering(), "without memory"),
        (MDSM, planar().model_copy(update={"damping_ratio": 0.0}), LAW, "needs damping"),
        (MDSM, shaped(1.0, "square", damping_ratio=0.0), LAW, "damping"),
        (MDSM, shaped(1.0, "square", normal_load=LIGHT), GENTLE, ""),
        (MDSM, PULSATING, GENTLE, "fall of friction"),
        (ONE, SLIPPING, LAW, "prescribed slip"),
        (ONE, UNDRIVEN, LAW, "needs a drive"),
        (ONE, planar(), LAW, "transverse"),
        (ONE, UNDAMPED, LAW, "undamped resonance"),
        (ONE, scene(5.0), STICTION, "mu_static"),
        (ONE, scene(5.0), Remembering(), "memory"),
        (ONE, shaped(1.0, "square"), LAW, "takes sines"),
        (ONE, SLIPPING, SOFT, "prescribed slip"),
        (ONE, planar(unbalance=0.0), SOFT, "two directions"),
        (ONE, UNDRIVEN, SOFT, "needs a drive"),
        (ONE, UNDAMPED, SOFT, "undamped resonance"),
        (WITH_A_TAIL, scene(5.0), LAW, "leave tail out"),
        (THREE, scene(5.0), LAW, ""),
        (THREE, scene(5.0), FALLING, "outweighs the fall"),
        (THREE, scene(5.0), SOFT, "one harmonic alone"),
        (THREE, scene(1.0, 0.5, damping_ratio=0.0), LAW, "harmonic 2 of friction"),
    ],
)
def test_scenes_outside_a_model_are_refused_with_the_reason(method, one, law, because: str) -> None:
    reason = method.refusal(one, law)

    assert (reason is not None) == bool(because)
    assert because in (reason or "")


HELD = "static friction balances"
STICKS = scene(0.5, drive=Drive(amplitude=2.5, frequency=0.5))
SWINGS = Drive(amplitude=0.2, frequency=3.0)
FALLS = LuGre(mu_kinetic=0.4, mu_static=0.8, stribeck_speed=5.0, presliding_length=0.1)
RESONANT = scene(0.68, damping_ratio=0.01, drive=Drive(amplitude=1.0, frequency=2.0))
WITHIN = scene(0.0, drive=Drive(amplitude=0.3, frequency=2.0))
slow = deep("a kernel slow to compile")


@some(6, "methods of every kind")
@pytest.mark.parametrize(
    ("method", "one", "law", "because"),
    [
        (MDSM, scene(0.0, normal_load=30.0), LAW, HELD),
        (MDSM, planar(0.0, normal_load=50.0), LAW, HELD),
        (MDSM, shaped(0.0, "triangle", amplitude=0.2), LAW, "rest anywhere"),
        (ONE, driven(1.0, 0.1, 0.7, 0.0), LAW, ""),  # of a load above the first harmonic of friction
        (ONE, driven(1.0, 0.1, 0.85, 0.0), LAW, "4/pi"),
        (ONE, driven(1.0, 0.1, 1.1, 0.0), LAW, HELD),
        (ONE, driven(2.0, 0.0, 0.1, 0.5), LAW, ""),
        (ONE, driven(2.0, 0.0, 0.1, 1.1), LAW, "does not decay"),  # undamped, it never reverses
        (ONE, RESONANT, Dahl(mu=0.4, contact_stiffness=4.0), "balances at velocity amplitudes 0.6666, "),
        (ONE, WITHIN, Jenkins(mu=0.4, presliding_length=1.0), "depends on the start"),
        pytest.param(ONE, scene(8.0, drive=SWINGS), FALLS, "use shooting", marks=slow),
        (HarmonicBalance(harmonics=40), STICKS, LAW, "does not settle on a motion of 40 harmonics"),
        (HarmonicBalance(harmonics=40), STICKS, MILD, "use shooting"),
    ],
)
def test_points_without_one_mean_are_refused_with_the_reason(method, one, law, because: str) -> None:
    found = method.solve([one], law, 1e-6)

    assert method.refusal(one, law) is None
    assert found.status == ["refused" if because else "ok"]
    assert because in found.reason[0]
    assert np.isnan(found.mean[0]) == np.isnan(found.error[0]) == bool(because)
    assert (found.orbit(0) is None) == bool(because)
    if one.belt_speed == 0.0 and not because:
        assert found.mean[0] == 0.0
        assert found.error[0] < 1e-9


# --- what models have in common -------------------------------------------------------------------------------------


LINE, PLANE = ([one(v) for v in (1.0, 20.0, 60.0)] for one in (scene, lambda v: planar(v, 4.0, 1.0, 4.0)))
SHAKEN = [scene(v, belt_vibration=VIBRATION) for v in (1.0, 20.0, 60.0)]
SIX = HarmonicBalance(harmonics=6, tail=False)


@pytest.mark.parametrize(
    ("model", "scenes", "law"),
    [
        (MDSM, LINE, LAW),
        (MDSM, SHAKEN, LAW),
        (MDSM, PLANE, LAW),
        (ONE, LINE, LAW),
        (ONE, SHAKEN, LAW),
        (ONE, LINE, Dahl(mu=0.4, contact_stiffness=8.0)),
        (SIX, LINE, LAW),
        (SIX, LINE, STRIBECK),
        (SIX, PLANE, LAW),
    ],
)
def test_a_belt_that_moves_back_has_the_same_motion_and_minus_the_mean_which_the_model_alone_has_too(
    model, scenes, law
) -> None:
    back = with_columns(model, [one.at(-one.belt_speed) for one in reversed(scenes)], law, 1e-8)
    forth = with_columns(model, scenes, law, 1e-8)

    assert forth.status == back.status == ["ok"] * 3
    within = 1e-14 if model is ONE else 1e-12
    np.testing.assert_allclose(back.mean[::-1].real, -forth.mean.real, rtol=within, atol=within)
    np.testing.assert_allclose(back.error[::-1], forth.error, rtol=within, atol=within)
    for name in ("velocity_amplitude", "velocity_phase", "energy_input", "energy_contact"):
        np.testing.assert_allclose(back.columns[name][::-1], forth.columns[name], rtol=1e-11, atol=1e-9)
    alone = model.model_means(scenes, law)
    assert alone.real == pytest.approx(forth.mean.real, rel=0.0, abs=1e-13)


@pytest.mark.parametrize(
    ("method", "law", "within"),
    [(ONE, LAW, 1e-8), (ONE, SOFT, 1e-5), (SIX, LAW, 1e-8), (SIX, STRIBECK, 1e-6)],
)
def test_energies_balance_and_columns_are_those_of_the_orbit(method, law, within) -> None:
    scenes = [scene(v, 1.2) for v in (-15.0, 1.0, 25.0, 60.0)]
    found = with_columns(method, scenes, law, 1e-8)
    columns, period = found.columns, 2 * math.pi / 1.2

    for i, one in enumerate(scenes):
        orbit = found.orbit(i)
        weights = 0.5 * np.ptp(orbit.tau, axis=1)[:, None] * WEIGHTS
        friction, x, v = orbit.friction.real, orbit.x.real, orbit.v.real
        load, mean = 10 * 1.2**2 * np.sin(1.2 * orbit.tau), columns["mean_friction"][i]
        put_in, taken = (weights * load * v).sum(), 10 * (weights * friction * v).sum()
        assert weights.sum() == pytest.approx(period)
        assert moves_as_its_velocity(orbit)
        assert -(weights * friction).sum() / period == pytest.approx(mean, abs=0.1 * within)
        assert (weights * x).sum() / period == pytest.approx(10 * mean, abs=within)
        assert put_in == pytest.approx(columns["energy_input"][i], rel=1e-7)
        assert taken == pytest.approx(columns["energy_friction"][i], rel=within, abs=within)
        contact = taken + one.belt_speed * 10 * mean * period
        assert contact == pytest.approx(columns["energy_contact"][i], rel=within)
        assert 0.5 * np.ptp(v) == pytest.approx(columns["velocity_amplitude"][i], rel=0.02)
        assert put_in == pytest.approx(taken + columns["energy_viscous"][i], rel=1e-7)


def test_without_a_load_across_the_belt_the_plane_is_the_line() -> None:
    across = Transverse(natural_frequency=3.0, damping_ratio=0.1, load=Load(unbalance=0.0))
    for method, law in ((MDSM, LAW), (ONE, LAW), (SIX, LAW), (SIX, STRIBECK)):
        line, plane = (
            with_columns(method, [one], law, 1e-8) for one in (scene(20.0), scene(20.0, transverse=across))
        )
        assert plane.columns["mean_friction"][0] == line.columns["mean_friction"][0]
        assert plane.columns["mean_friction_transverse"][0] == 0.0
        assert np.isnan(line.columns["mean_friction_transverse"][0])
        assert "x2 decays" in plane.model[0]


# --- errors ---------------------------------------------------------------------------------------------------------


VISCOUS = Stribeck(mu_kinetic=0.4, mu_static=0.4, stribeck_speed=5, viscosity=0.01)
STIFF_ACROSS = Transverse(natural_frequency=8.7, damping_ratio=0.0056, load=Load(amplitude=0.0101))
SOFT_DRIVE = {"drive": Drive(amplitude=0.154, frequency=0.305), "damping_ratio": 0.154}


@pytest.mark.parametrize(
    ("model", "scenes", "law", "times"),
    [
        *[(MDSM, [planar(v, 1.0, 20.0, wr) for v in (5.0, 15.0, 30.0)], LAW, 2.0) for wr in (0.5, 2.0, 10.0)],
        # friction that holds the mass for most of the period, or is far above the load
        (MDSM, [scene(0.5, normal_load=30.0)], LAW, 2.0),
        (MDSM, [planar(0.5, 1.0, 45.0, 2.0)], LAW, 2.0),
        (ONE, [driven(1.0, 0.1, 3.0, 0.2)], LAW, 1.01),
        # a high harmonic that meets a stiff direction across the belt
        (MDSM, [scene(0.0127, normal_load=0.002475, transverse=STIFF_ACROSS, **SOFT_DRIVE)], LAW, 1.3),
        *[
            (MDSM, [scene(v, 1.5, normal_load=1.0) for v in (3.0, 24.0, 30.0)], law, math.inf)
            for law in (VISCOUS, MILD)
        ],
        (MDSM, [planar(v, 1.5) for v in (3.0, 24.0, 30.0)], MILD, math.inf),
    ],
)
def test_errors_cover_what_is_left_out_and_little_more(model, scenes, law, times) -> None:
    apart, found = beside_full_answers(model, scenes, law)

    assert np.all(found.error <= times * np.abs(apart) + 1e-8)
    assert times != 1.3 or abs(apart[0]) > 1e-4


def test_an_error_above_the_tolerance_is_said_and_bounds_are_gone() -> None:
    found = MDSM.solve([scene(5.0), scene(70.0)], LAW, 1e-8)

    assert found.status == ["ok", "ok"]
    assert "above the tolerance" in found.reason[0]
    assert found.reason[1] == ""
    assert 1e-11 < found.error[1] < 1e-9
    with pytest.raises(ValueError, match="its distance to the full answer"):
        Mdsm(error="bound")  # type: ignore[arg-type]  # what is refused


# --- belts that vibrate ---------------------------------------------------------------------------------------------


def vibrating(belt_speed: float = 1.0, frequency: float = 1.5, **keys: Any) -> Scene:
    drive = Drive(amplitude=10.0, frequency=frequency, phase=20.0)
    return scene(belt_speed, **({"normal_load": 1.0, "drive": drive, "belt_vibration": VIBRATION} | keys))


@pytest.mark.parametrize("method", [MDSM, ONE], ids=lambda method: method.name)
@pytest.mark.parametrize("drive", [True, False], ids=["driven", "by the belt alone"])
def test_models_of_one_harmonic_take_a_belt_that_vibrates_as_a_sine(method: Any, drive: bool) -> None:
    own = {} if drive else {"drive": None, "belt_vibration": {**VIBRATION, "frequency": 1.5}}
    scenes = [vibrating(speed, **own) for speed in (0.1, 1.0, 3.0, 11.0, 20.0)]
    found, exact = with_columns(method, scenes, LAW, 1e-6), with_columns(Exact(), scenes, LAW, 1e-9)

    assert found.status == ["ok"] * 5
    assert np.all(np.abs(found.mean.real - exact.mean.real) <= found.error + exact.error)
    # the columns are those of x1, not of its distance from the belt's vibration
    near = 0.2 if method is MDSM and not drive else 0.02
    known, columns = exact.columns, found.columns
    if method is ONE or drive:
        assert columns["velocity_amplitude"] == pytest.approx(known["velocity_amplitude"], rel=0.2, abs=near)
    assert columns["velocity_harmonic"][-1] == pytest.approx(known["velocity_harmonic"][-1], abs=1e-9)
    assert columns["velocity_phase"] == pytest.approx(known["velocity_phase"], abs=20.0, nan_ok=True)
    assert np.all(np.isnan(columns["velocity_phase"]) == (not drive))
    assert all(moves_as_its_velocity(found.orbit(i)) for i in range(5))


def test_bristles_are_balanced_over_a_vibrating_belt_too() -> None:
    one, law = vibrating(), Dahl(mu=0.4, presliding_length=0.3)
    other = equivalent_drive(one)
    assert other is not None
    found, known = (ONE.solve([each], law, 1e-3) for each in (one, other.scene))

    assert found.status == ["ok"]
    assert (found.mean[0], found.error[0]) == (known.mean[0], known.error[0])
