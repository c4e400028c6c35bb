"""The impedance of a contact: limits, closed forms, differences of the integrated law, stability of sliding."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from generalised_maxwell_slip import GeneralisedMaxwellSlip
from maxwell_slip import MaxwellSlip
from memory_laws import AGEING
from profiles import deep, some
from rate_and_state import RateAndState
from scipy.integrate import solve_ivp
from scipy.optimize import newton

import frictionlab as fl
from frictionlab.analysis.response import linearized
from frictionlab.theory import SteadySliding

FALLING: dict[str, Any] = {
    "mu_kinetic": 0.3,
    "mu_static": 0.4,
    "stiffness": 5,
    "damping": 0.2,
    "viscosity": 0.02,
}
LUGRE, ELASTO_PLASTIC = fl.LuGre(**FALLING), fl.ElastoPlastic(**FALLING)
SEVERAL = GeneralisedMaxwellSlip(
    share=[1, 2], stiffness=[10, 40], mu_kinetic=0.3, mu_static=0.4, attraction=3, viscosity=0.05
)
RATED: list[Any] = [fl.Stribeck(mu_kinetic=0.3, mu_static=0.4), LUGRE, ELASTO_PLASTIC, SEVERAL, AGEING]
"""Laws whose friction of steady sliding changes with its speed."""
ON_THE_PATH: list[Any] = [
    fl.Coulomb(mu=0.4),
    fl.Dahl(mu=0.4, stiffness=5),
    fl.Dahl(mu=0.4, stiffness=5, exponent=0.5),
    fl.Dahl(mu=0.4, stiffness=5, exponent=1.3),
    fl.Jenkins(mu=0.4, stiffness=5),
    fl.ElastoPlastic(mu_kinetic=0.4, stiffness=5),
    MaxwellSlip(mu=[0.1, 0.3], stiffness=[1, 4]),
]
SPEED = 1.3


def lugre_in_closed_form(law: fl.LuGre, speed: float) -> SteadySliding:
    """The linearized law."""
    fall = (law.peak - law.mu_kinetic) * math.exp(-((speed / law.stribeck_speed) ** 2))
    stiffness = law.bristle_stiffness
    return SteadySliding(
        slope=-2.0 * speed / law.stribeck_speed**2 * fall,
        lag=(law.mu_kinetic + fall) / (stiffness * speed),
        lead=law.bristle_damping / stiffness,
        viscosity=law.viscosity,
    )


@pytest.mark.parametrize("law", RATED)
def test_slow_changes_follow_the_curve_of_steady_friction(law: Any) -> None:
    h = np.array([1e-3, -1e-3, 2e-3, -2e-3])
    ahead, behind, far, back = law.sliding_friction(SPEED + h)
    slope = (8.0 * (ahead - behind) - (far - back)) / 12e-3

    assert fl.impedance(law, SPEED, 0.0) == pytest.approx(slope, abs=1e-11)


@pytest.mark.parametrize("law", [*RATED, *ON_THE_PATH])
def test_slow_changes_across_the_belt_turn_steady_friction(law: Any) -> None:
    if why := law.no_vector_form():
        with pytest.raises(ValueError, match=why):
            fl.impedance(law, SPEED, 0.0, across=True)
        return
    assert fl.impedance(law, SPEED, 0.0, across=True) == pytest.approx(
        law.sliding_friction(SPEED) / SPEED, rel=1e-10
    )


@pytest.mark.parametrize("law", ON_THE_PATH)
def test_friction_of_the_path_alone_does_not_change_along_the_belt(law: Any) -> None:
    assert fl.impedance(law, SPEED, [0.0, 1.0, 1e3]).tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize("law", [fl.Coulomb(mu=0.4), fl.Stribeck(mu_kinetic=0.3, mu_static=0.4)])
@pytest.mark.parametrize("across", [False, True])
def test_without_memory_it_is_the_same_real_number_at_every_frequency(law: Any, across: bool) -> None:
    found = fl.impedance(law, SPEED, [0.0, 1.0, 1e6], across=across)

    assert (found == found[0]).all()
    assert found[0].imag == 0.0


def test_changes_too_quick_for_bristles_meet_their_dashpots() -> None:
    spring = fl.impedance(LUGRE, SPEED, 1e9, across=True)

    assert spring == pytest.approx(LUGRE.bristle_damping + LUGRE.viscosity, rel=1e-7)


@pytest.mark.parametrize("law", [LUGRE, ELASTO_PLASTIC, SEVERAL, *ON_THE_PATH[1:]])
def test_about_rest_a_contact_is_a_spring_and_a_dashpot(law: Any) -> None:
    stiffness = 50.0 if law is SEVERAL else 5.0
    damping = getattr(law, "bristle_damping", 0.0) + getattr(law, "viscosity", 0.0)

    assert fl.impedance(law, 0.0, 2.0) == pytest.approx(damping + stiffness / 2.0j, rel=1e-12)
    assert fl.impedance(law, 0.0, 0.0) == math.inf


def test_it_does_not_depend_on_the_direction_of_the_belt_nor_on_the_order_of_frequencies() -> None:
    one = fl.impedance(LUGRE, [[SPEED], [2.0]], [0.5, 3.0])

    assert one.shape == (2, 2)
    assert fl.impedance(LUGRE, -SPEED, [3.0, -0.5]).tolist() == [one[0, 1], one[0, 0].conjugate()]


def test_canudas_de_wits_contact_in_the_digits_of_its_closed_form() -> None:
    law = fl.LuGre(
        mu_kinetic=1, mu_static=1.5, stribeck_speed=1e-3, stiffness=1e5, damping=math.sqrt(1e5), viscosity=0.4
    )
    omega = 2.0 * np.pi * np.array([1, 10, 100, 1000])
    found = fl.impedance(law, 2e-3, omega)

    assert found.round(4).tolist() == [
        -36.2175 + 0.4331j,
        -34.9824 + 3.9392j,
        -23.7947 + 3.9228j,
        -22.571 + 0.4309j,
    ]
    assert found == pytest.approx(lugre_in_closed_form(law, 2e-3).impedance(1j * omega), rel=1e-10)


@pytest.mark.parametrize("speed", [0.03, 0.3, 1.3, 5.0])
def test_elasto_plastic_bristles_in_steady_sliding_are_those_of_lugre(speed: float) -> None:
    exact = lugre_in_closed_form(LUGRE, speed).impedance(1j * np.array([0.0, 1.0, 50.0]))
    for law in (LUGRE, ELASTO_PLASTIC):
        assert fl.impedance(law, speed, [0.0, 1.0, 50.0]) == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize(
    ("law", "across"),
    [
        *((law, across) for law in (LUGRE, ELASTO_PLASTIC) for across in (False, True)),
        (AGEING, False),
        pytest.param(AGEING, True, marks=deep("more kernels to compile")),
    ],
)
def test_it_is_the_answer_of_the_integrated_law_to_a_small_vibration(law: Any, across: bool) -> None:
    sizes, omega = 4e-3 * 0.5 ** np.arange(4), 1.7
    if across:
        found = [fl.describing_function(law, (0, size), omega, SPEED)[1, 1] for size in sizes]
    else:
        found = fl.describing_function(law, sizes, omega, SPEED)
    left = np.array(found)
    for order in (
        1,
        2,
        3,
    ):  # without what is of these powers of the vibration: all where friction bends suddenly
        left = (2.0**order * left[1:] - left[:-1]) / (2.0**order - 1.0)

    assert fl.impedance(law, SPEED, omega, across=across) == pytest.approx(left[0], abs=1e-9)


@some(1, "seconds of maps")
@pytest.mark.parametrize("law", [LUGRE, ELASTO_PLASTIC, fl.Stribeck(mu_kinetic=0.3, mu_static=0.4)])
def test_steady_sliding_is_lost_where_friction_feeds_what_the_dashpot_takes(law: Any) -> None:
    load = 2.0

    def unbalanced(omega: float) -> float:
        return 1.0 - omega**2 - load * omega * fl.impedance(law, SPEED, omega).imag

    omega = newton(unbalanced, 1.0)
    damping = -load * fl.impedance(law, SPEED, omega).real
    body = {"normal_load": load, "belt_speed": SPEED}
    more, less = (fl.steady_state(fl.Scene(damping_ratio=k * damping / 2, **body), law) for k in (1.1, 0.9))

    assert more.velocity_amplitude < 1e-10
    assert less.velocity_amplitude > 0.1


def test_body_and_impedance_give_the_multiplier_of_a_small_vibration() -> None:
    load, damping, drive = 2.0, 0.2, fl.Drive(amplitude=1e-6, frequency=1.7)
    contact = linearized(LUGRE, SPEED, across=False)

    def left(s: complex) -> complex:
        return s * s + damping * s + 1.0 + load * s * complex(contact.impedance(np.array(s)))

    decay = newton(left, 1j).real
    scene = fl.Scene(damping_ratio=damping / 2, normal_load=load, belt_speed=SPEED, drive=drive)

    state = fl.steady_state(scene, LUGRE, "shooting")

    assert state.floquet == pytest.approx(math.exp(2.0 * math.pi / 1.7 * decay), abs=1e-6)


def multipliers(scene: fl.Scene, law: Any, time: float) -> Any:
    """Of small motions about steady sliding over this time: central differences of the integrated body."""
    speed, load = scene.belt_speed, scene.normal_load
    bristle = isinstance(law, fl.LuGre)

    def rates(_: float, state: Any) -> list[float]:
        slip = state[1] - speed
        dz = [law.rate(slip, state[2])] if bristle else []
        friction = law.friction(slip, state[2], dz[0]) if bristle else law.sliding_vector(slip)
        return [state[1], -2.0 * scene.damping_ratio * state[1] - state[0] - load * friction, *dz]

    steady = law.sliding_friction(speed)
    bent = [-(steady - law.viscosity * speed) / law.bristle_stiffness] if bristle else []
    still = np.array([load * steady, 0.0, *bent])

    def after(change: Any) -> Any:
        return solve_ivp(rates, (0, time), still + change, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]

    ways = 1e-4 * np.eye(len(still))
    return np.linalg.eigvals(np.column_stack([(after(way) - after(-way)) / 2e-4 for way in ways]))


@deep("seconds of maps")
def test_impedance_and_body_tell_whether_steady_sliding_is_stable() -> None:
    """By Nyquist's criterion, and by the characteristic equation that multipliers above differences' noise obey."""
    draw, stable = np.random.default_rng(5), []
    omega = np.array([0.0, *np.geomspace(1e-3, 1e4, 4000)])
    for place in range(20):
        speed, load, peak = draw.uniform(0.3, 2), 10 ** draw.uniform(-0.5, 1), draw.uniform(0.4, 0.6)
        falling: Any = {"mu_kinetic": 0.3, "mu_static": peak, "stribeck_speed": draw.uniform(0.5, 2)}
        bristles = {"stiffness": draw.uniform(3, 30), "damping": draw.uniform(0, 0.3), "viscosity": 0.02}
        law: Any = fl.LuGre(**falling, **bristles) if place % 2 else fl.Stribeck(**falling)
        fed = -0.5 * load * fl.impedance(law, speed, 1.0).real
        damping = max(draw.choice([0.5, 0.8, 1.2, 2]) * fed, 1e-3)
        scene = fl.Scene(damping_ratio=damping, normal_load=load, belt_speed=speed)
        answer = 1.0 - omega**2 + 1j * omega * (2.0 * damping + load * fl.impedance(law, speed, omega))
        turned = np.unwrap(np.angle(answer))
        found = multipliers(scene, law, 0.2)
        contact = linearized(law, speed, across=False)
        for s in np.log(found[np.abs(found) > 0.01].astype(complex)) / 0.2:
            left = s * s + 2.0 * damping * s + 1.0 + load * s * complex(contact.impedance(np.array(s)))
            assert abs(left) < 1e-5 * max(1.0, abs(s)) ** 2

        stable.append(np.abs(found).max() < 1.0)
        assert turned[-1] - turned[0] == pytest.approx(math.pi if stable[-1] else -math.pi, abs=0.01)
    assert 5 <= sum(stable) <= 15


class Bent(fl.SlidingLaw):
    """Friction with a corner at this speed."""

    mu: fl.Positive = 0.4

    def sliding_friction(self, speed: float) -> float:
        """Level, then rising."""
        return self.mu + max(speed - SPEED, 0.0)


class Adrift(RateAndState):
    """An age that is not that of steady sliding."""

    def steady(self, v: Any, k: int) -> Any:
        """Twice as old."""
        return 2.0 * super().steady(v, k)


@pytest.mark.parametrize(
    ("law", "speed", "frequencies", "why"),
    [
        (Bent(), SPEED, 1.0, r"Bent\(\) has a corner in steady sliding at this speed"),
        (Adrift(**AGEING.model_dump()), SPEED, 1.0, "does not vanish where steady puts its memory"),
        (AGEING, 0.0, 1.0, "no sliding to renew the memory"),
        (fl.Coulomb(mu=0.4), 0.0, 1.0, "jumps where slip turns round; use fl.describing_function"),
        (LUGRE, math.nan, 1.0, "belt_speed must be finite numbers"),
        (LUGRE, 1.0, ["1"], "frequencies must be finite numbers"),
        (fl.Dahl(mu=0.4, contact_stiffness=4), 1.0, 1.0, "needs the normal load"),
    ],
)
def test_what_has_no_impedance_is_refused_with_the_reason(
    law: Any, speed: float, frequencies: Any, why: str
) -> None:
    with pytest.raises(ValueError, match=why):
        fl.impedance(law, speed, frequencies)


@pytest.mark.parametrize(("law", "lines"), [(LUGRE, [3, 3]), (fl.Coulomb(mu=0.4), [2, 2])])
def test_the_figure_has_a_line_for_each_belt_speed(law: Any, lines: list[int]) -> None:
    speeds = [[SPEED + k] for k in range(lines[0])]
    modulus, phase, plane = fl.impedance(law, speeds, np.geomspace(0.1, 100, 30), plot=True).axes

    assert [len(modulus.lines), len(phase.lines)] == lines
    assert len(plane.lines) == 2 * lines[0] + 2  # each with its mark, and two axes
    assert modulus.lines[0].get_ydata() == pytest.approx(
        np.abs(fl.impedance(law, SPEED, np.geomspace(0.1, 100, 30)))
    )
