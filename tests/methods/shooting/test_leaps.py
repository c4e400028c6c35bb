"""Motions led over many periods at once end where plain periods lead them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from profiles import deep, some
from scipy.integrate import quad

import frictionlab as fl
from frictionlab.methods.periodic.leaps import Leaper, power_sum
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.methods.shooting.attractors import follow_all
from frictionlab.values.quantities import Floats


@given(arrays(float, (3, 3), elements=st.floats(-0.6, 0.6)), st.integers(1, 40))
def test_powers_of_an_affine_map_add_up(matrix: Floats, length: int) -> None:
    power, total = power_sum(matrix, length)

    assert np.allclose(power, np.linalg.matrix_power(matrix, length), rtol=1e-9, atol=1e-12)
    assert np.allclose((np.eye(3) - matrix) @ total, np.eye(3) - power, rtol=1e-9, atol=1e-12)


# --- a slider on a plate that vibrates a thousand times quicker ---


def plate(belt_speed: str, frequency: str = "26 kHz", amplitude: str = "2 um") -> fl.Scene:
    """Half a kilogram on a spring that is pulled over the plate."""
    vibration = {"displacement_amplitude": amplitude, "frequency": frequency}
    body = {"mass": "0.5 kg", "stiffness": "10 N/mm", "damping_ratio": "2 %", "normal_load": "20 N"}
    given = {**body, "belt_speed": belt_speed, "belt_vibration": vibration}
    return fl.Scene(dimensional=given)  # type: ignore[arg-type]


STRIBECK = fl.Stribeck(mu_kinetic=0.2, mu_static=0.25, stribeck_speed="1 mm/s")  # type: ignore[arg-type]
LUGRE = fl.LuGre(
    mu_kinetic=0.2,
    mu_static=0.25,
    stribeck_speed="1 mm/s",  # type: ignore[arg-type]
    presliding_length="1 um",  # type: ignore[arg-type]
    contact_damping="100 N s/m",  # type: ignore[arg-type]
)


@some(1, "maps of every law")
@pytest.mark.parametrize(
    ("law", "belt_speed", "mean", "off"),
    # quadrature with the mass at rest; Runge-Kutta of order 4 with 800 steps a period over 30,000 periods
    [
        (STRIBECK, "0.05 mm/s", 1.94848e-5, 1e-9),
        (STRIBECK, "1 mm/s", 3.8970e-4, 5e-8),
        (LUGRE, "0.05 mm/s", 2.700e-5, 3e-8),
        (LUGRE, "1 mm/s", 5.397e-4, 5e-7),
    ],
)
def test_a_slider_over_ultrasound_has_one_state(
    law: fl.FrictionLaw, belt_speed: str, mean: float, off: float
) -> None:
    """By periods alone starts had not ended after 7,000, and the answer was not unique."""
    state = fl.steady_state(plate(belt_speed), law)

    assert (state.status, state.unique) == ("ok", "tested")
    assert abs(state.mean_friction - mean) < off + state.error


@deep("thousands of periods")
@pytest.mark.parametrize(
    ("frequency", "amplitude"), [("260 Hz", "200 um"), ("2.6 kHz", "20 um"), ("260 kHz", "0.2 um")]
)
@pytest.mark.parametrize("law", [STRIBECK, LUGRE])
def test_the_same_velocity_at_other_frequencies_has_one_state(
    law: fl.FrictionLaw, frequency: str, amplitude: str
) -> None:
    state = fl.steady_state(plate("1 mm/s", frequency, amplitude), law)

    assert state.status == "ok"
    assert state.error < 1e-7


QUICK_LUGRE = fl.LuGre(mu_kinetic=0.3, mu_static=0.4, stribeck_speed=0.1, presliding_length=1e-3, damping=0.1)
QUICK_STRIBECK = fl.Stribeck(mu_kinetic=0.3, mu_static=0.4, stribeck_speed=0.1)


@pytest.mark.parametrize("frequency", [1e3, 1e5])
@pytest.mark.parametrize("law", [QUICK_STRIBECK, QUICK_LUGRE], ids=["stribeck", "lugre"])
def test_drives_far_quicker_than_the_body_leave_no_start_behind(
    law: fl.FrictionLaw, frequency: float
) -> None:
    """Some starts swing far out first, in and out of slip that reverses: leaps there are short."""
    drive = fl.Drive(amplitude=1e-2 * frequency, frequency=frequency)
    state = fl.steady_state(fl.Scene(damping_ratio=0.1, normal_load=1, belt_speed=1e-3, drive=drive), law)

    assert (state.status, state.unique) == ("ok", "tested")
    assert state.error < 1e-8


@deep("thousands of periods")
@given(
    frequency=st.floats(1.0, 5.0).map(lambda power: 10.0**power),
    swing=st.floats(-2.5, 0.5).map(lambda power: 10.0**power),
    share=st.floats(0.01, 0.95),
    width=st.floats(-1.0, 1.5).map(lambda power: 10.0**power),
    damping=st.floats(-2.5, -0.5).map(lambda power: 10.0**power),
    pressed=st.floats(-4.0, -1.0).map(lambda power: 10.0**power),
)
def test_quick_drives_leave_the_mean_over_the_slip_that_they_make(
    frequency: float, swing: float, share: float, width: float, damping: float, pressed: float
) -> None:
    """Friction moves the mass by its impulse over a period: the quadrature leaves that out, and the spring."""
    law = fl.Stribeck(mu_kinetic=0.2, mu_static=0.3, stribeck_speed=width * swing)
    scene = fl.Scene(
        damping_ratio=damping,
        normal_load=pressed * swing * frequency,
        belt_speed=share * swing,
        drive=fl.Drive(amplitude=swing * frequency, frequency=frequency),
    )
    state, turned = fl.steady_state(scene, law), math.acos(-share)

    def friction(angle: float) -> float:
        return law.sliding_friction(swing * abs(share + math.cos(angle)))

    mean = (quad(friction, 0.0, turned)[0] - quad(friction, turned, math.pi)[0]) / math.pi

    if state.status == "ok":
        assert abs(state.mean_friction - mean) <= 0.3 * pressed + frequency**-2 + state.error
    else:  # friction that falls steeply feeds a slow oscillation
        assert re.search("not repeat|had not ended", state.reason)


# --- against plain periods ---


def _ends(scene: fl.Scene, law: fl.FrictionLaw) -> list[tuple[int, float]]:
    """Period and mean of the end of each start; NaN of one that has not ended."""
    followed = follow_all(PeriodicProblem(scene, law, 1e-8), scene, None)
    return [(one.period, one.mean) for one in followed.reached]


def _draw(seed: int) -> tuple[fl.Scene, fl.FrictionLaw]:
    """A weakly damped mass under friction that falls, in stick now and then or never."""
    rng = np.random.default_rng(seed)
    drive = fl.Drive(amplitude=10 ** rng.uniform(-0.5, 0.7), frequency=10 ** rng.uniform(-0.4, 1.0))
    scene = fl.Scene(
        damping_ratio=10 ** rng.uniform(-3.5, -1.5),
        normal_load=10 ** rng.uniform(-1, 1),
        belt_speed=10 ** rng.uniform(-1, 0.7),
        drive=drive,
    )
    static = rng.uniform(0.25, 0.5)
    return scene, fl.Stribeck(mu_kinetic=0.2, mu_static=static, stribeck_speed=10 ** rng.uniform(-1, 0.5))


@deep("20,000 periods a start")
@pytest.mark.parametrize("seed", range(12))
def test_starts_end_where_plain_periods_lead_them(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    scene, law = _draw(seed)
    led = _ends(scene, law)
    plain: Callable[[Leaper], None] = lambda leaper: None  # noqa: E731
    monkeypatch.setattr(Leaper, "leap", plain)

    for (period, mean), (by_periods, mean_by_periods) in zip(led, _ends(scene, law), strict=False):
        if by_periods > 0:  # else plain periods have not ended
            assert period == by_periods
            assert math.isclose(mean, mean_by_periods, abs_tol=1e-7)
