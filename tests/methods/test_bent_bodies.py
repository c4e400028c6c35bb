"""Bodies whose spring and dashpot are not linear: limits, symmetries, balances, integrations of the tests' own."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from profiles import deep
from scipy.integrate import solve_ivp

import frictionlab as fl
from frictionlab.methods.periodic import problem
from frictionlab.runner.curve_loads import start_is_known
from frictionlab.study import registry
from frictionlab.theory.rest import resonates_once

LINE: dict[str, Any] = {
    "damping_ratio": 0.1,
    "normal_load": 10,
    "belt_speed": 5,
    "drive": {"unbalance": 10, "frequency": 1},
}
BENT = {"cubic_stiffness": 0.01, "amplitude_damping": 0.02, "curvature": 0.01}
compiling = deep("more kernels to compile")
COULOMB, DAHL = {"kind": "coulomb", "mu": 0.4}, {"kind": "dahl", "mu": 0.4, "stiffness": 40}


def answered(scene: dict[str, Any], law: dict[str, Any] = COULOMB, **given: Any) -> fl.SteadyState:
    made = registry.law_class(law["kind"])(**{name: law[name] for name in law if name != "kind"})
    return fl.steady_state(fl.Scene(**scene), made, **given)


@pytest.mark.parametrize("law", [COULOMB, pytest.param(DAHL, marks=compiling)])
def test_a_body_that_hardly_bends_is_the_linear_one(law: dict[str, Any]) -> None:
    linear = answered(LINE, law, method="shooting", tolerance=1e-12)
    small = {name: 1e-13 * value for name, value in BENT.items()}
    bent = answered(LINE | {"body": small}, law, tolerance=1e-12)

    assert bent.status == "ok"
    assert abs(bent.mean_friction - linear.mean_friction) <= 1e-12 + bent.error + linear.error


@pytest.mark.parametrize("body", [{"cubic_stiffness": 0.01}, {"curvature": 0.004}, BENT])
def test_the_mirrored_body_has_the_opposite_mean(body: dict[str, float]) -> None:
    mirrored = body | {"curvature": -body.get("curvature", 0.0)}
    drive = LINE["drive"] | {"phase": 180}
    one, other = (
        answered(LINE | {"body": body}),
        answered(LINE | {"body": mirrored, "belt_speed": -5, "drive": drive}),
    )

    assert one.mean_friction == pytest.approx(-other.mean_friction, abs=one.error + other.error)


def test_the_work_of_the_loads_is_what_dashpots_and_friction_take() -> None:
    state = answered(LINE | {"body": BENT})

    assert state.energy_input == pytest.approx(state.energy_viscous + state.energy_friction, rel=1e-9)
    alone = answered(LINE | {"body": BENT | {"amplitude_damping": 0.0}})
    assert abs(alone.energy_viscous / state.energy_viscous - 1.0) > 0.01


def test_next_to_no_friction_leaves_the_oscillator_of_duffing() -> None:
    force, omega, damping, cubic = 0.8, 1.3, 0.2, 0.5

    def rates(tau: float, state: Any) -> list[float]:
        x, v = state
        return [v, force * math.sin(omega * tau) - damping * v - x - cubic * x**3]

    period = 2.0 * math.pi / omega
    ends = solve_ivp(rates, (0.0, 60.0 * period), [0.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-12).y[
        :, -1
    ]
    last = solve_ivp(
        rates, (0.0, period), ends, "DOP853", np.linspace(0.0, period, 20001), rtol=1e-12, atol=1e-12
    )
    scene = {
        "damping_ratio": 0.5 * damping,
        "normal_load": 1e-9,
        "belt_speed": 0.3,
        "drive": {"amplitude": force, "frequency": omega},
        "body": {"cubic_stiffness": cubic},
        "initial": {"x": 0, "velocity": 0},
    }
    state = answered(scene)

    assert state.velocity_amplitude == pytest.approx(0.5 * np.ptp(last.y[1]), rel=1e-6)


@deep("an integrator to compile")
def test_both_states_of_a_bistable_oscillator_are_found_and_are_those_of_another_integration() -> None:
    scene: dict[str, Any] = {
        "damping_ratio": 0.02,
        "normal_load": 0.05,
        "belt_speed": 0.1,
        "drive": {"amplitude": 1, "frequency": 1.8},
        "body": {"cubic_stiffness": 0.3},
    }
    low, high = 0.0031881074, 0.0310087817  # Runge-Kutta steps from event to event (outside_state.py)
    state = answered(scene)

    assert state.status == "not_unique"
    assert [state.mean_low, state.mean_high] == pytest.approx(sorted([low, high]), abs=1e-7)
    assert low < 0.5 * high
    assert state.reason.startswith("springs and dashpots are not linear: ")
    for x, mean in ((3, low), (0, high)):
        chosen = answered(scene | {"initial": {"x": x}})
        assert (chosen.status, chosen.unique) == ("ok", "no")
        assert chosen.mean_friction == pytest.approx(mean, abs=1e-7)


@pytest.mark.parametrize("method", ["auto", "march"])
@pytest.mark.parametrize("cubic", [-0.05, -1.0, -100.0])
def test_a_body_without_a_steady_state_fails_with_the_reason(cubic: float, method: str) -> None:
    scene = LINE | {"normal_load": 1, "belt_speed": 0.5, "drive": {"amplitude": 3, "frequency": 1}}
    state = answered(scene | {"body": {"cubic_stiffness": cubic}}, method=method)

    assert state.status == "failed"
    assert "starts run away" in state.reason


def test_starts_that_run_away_beside_a_steady_state_are_told() -> None:
    scene = LINE | {"normal_load": 1, "belt_speed": 0.5, "drive": {"amplitude": 3, "frequency": 1}}
    scene |= {"body": {"cubic_stiffness": -0.01}}
    state = answered(scene)

    assert (state.status, state.unique) == ("ok", "no")
    assert "starts run away: far out the spring along the belt pushes outward" in state.reason
    assert state.mean_friction == pytest.approx(0.0210087821, abs=1e-8)  # outside_state.py
    lost = answered(scene | {"initial": {"x": 30}})
    assert lost.status == "failed"
    assert lost.reason.startswith("from scene.initial the motion runs away")


@pytest.mark.parametrize("speed", [0.0, 0.5, 3.0])
def test_an_undriven_body_slides_or_sticks_as_its_integration_says(speed: float) -> None:
    cubic, mu, load = 0.5, 0.4, 2.0
    scene = {
        "damping_ratio": 0.1,
        "normal_load": load,
        "belt_speed": speed,
        "body": {"cubic_stiffness": cubic},
    }
    state = answered(scene | {"initial": {"x": 1.5, "velocity": 0.0}}, tolerance=1e-9)

    assert state.status == "ok", state.reason
    if speed:
        assert state.mean_friction == pytest.approx(mu, abs=1e-9)
        return
    # at rest where the spring holds less than friction, after swings that it loses
    x, side = 1.5, -1.0
    while x + cubic * x**3 > mu * load or x + cubic * x**3 < -mu * load:

        def rates(tau: float, now: Any, side: float = side) -> list[float]:
            return [now[1], -0.2 * now[1] - now[0] - cubic * now[0] ** 3 - side * mu * load]

        def stops(tau: float, now: Any) -> float:
            return float(now[1])

        event: Any = stops
        event.terminal, event.direction = True, -side
        x = solve_ivp(rates, (0, 9), [x, side * 1e-13], "DOP853", events=event, rtol=1e-12, atol=1e-13).y[
            0, -1
        ]
        side = -side
    assert state.mean_friction == pytest.approx((x + cubic * x**3) / load, abs=1e-8)


def test_a_curve_starts_at_zero_unless_its_spring_is_another_to_either_side() -> None:
    scene = fl.Scene(**LINE)
    slow = answered(LINE | {"body": {"cubic_stiffness": 0.01}, "belt_speed": 1e-3})

    assert start_is_known(scene.with_(body={"cubic_stiffness": 0.01}), fl.Coulomb(mu=0.4))
    assert abs(slow.mean_friction) < 1e-4
    assert not start_is_known(scene.with_(body={"curvature": 0.004}), fl.Coulomb(mu=0.4))
    assert abs(answered(LINE | {"body": {"curvature": 0.004}, "belt_speed": 1e-3}).mean_friction) > 1e-3


def test_needs_takes_the_terms_of_a_body_away() -> None:
    scene = fl.Scene(**LINE, body={"cubic_stiffness": 0.01, "amplitude_damping": 1e-7})
    needs = fl.needs(scene, fl.Coulomb(mu=0.4), within=1e-3)

    told = needs.table.set_index("without")["verdict"]
    assert told["cubic stiffness"] == "needed"
    assert told["amplitude damping"] == "not needed"
    assert told["friction's effect on the motion"] == "refused"


def test_the_mean_changes_with_the_numbers_of_the_body_as_quotients_say() -> None:
    scene, law = fl.Scene(**LINE, body=BENT), fl.Coulomb(mu=0.4)
    found = fl.sensitivities(scene, law, [f"scene.body.{name}" for name in BENT]).derivative.tolist()
    for derivative, (name, value) in zip(found, BENT.items(), strict=True):
        low, high = (
            fl.steady_state(
                scene.with_(**{f"body.{name}": share * value}), law, tolerance=1e-11
            ).mean_friction
            for share in (0.999, 1.001)
        )
        assert derivative == pytest.approx((high - low) / (0.002 * value), rel=1e-3), name


def test_few_starts_are_tried_where_the_spring_resonates_once() -> None:
    once = answered(LINE | {"body": {"cubic_stiffness": 0.01}})
    often = answered(LINE | {"body": {"cubic_stiffness": 0.01}, "drive": {"unbalance": 1, "frequency": 3.5}})

    soft, softer = (answered(LINE | {"body": {"cubic_stiffness": each}}) for each in (-4e-5, -7e-5))

    for few in (once, soft):
        assert few.reason.startswith("tested: 2 starts ")
    for many in (often, softer):
        assert not many.reason.startswith("tested: 2 starts ")


def test_few_starts_find_what_many_do(monkeypatch: pytest.MonkeyPatch) -> None:
    rng, law, compared = np.random.default_rng(5), fl.Coulomb(mu=0.4), 0
    while compared < 12:
        frequency, friction, bend = np.exp(rng.uniform(np.log([0.2, 0.02, 0.02]), np.log([5.0, 1.2, 0.6])))
        damping, side = 0.02 + 0.3 * rng.random(), rng.choice([-1.0, 1.0])
        amplitude = 1.0 / abs(complex(1.0 - frequency**2, 2.0 * damping * frequency))
        scene = fl.Scene(
            damping_ratio=damping,
            normal_load=friction / 0.4,
            belt_speed=0.5 * frequency * amplitude * rng.random(),
            drive=fl.Drive(amplitude=1, frequency=frequency),
            body=fl.Body(cubic_stiffness=side * bend / (max(1.5, amplitude) + friction) ** 2),
        )
        if not resonates_once(scene, law):
            continue
        compared += 1
        few = fl.steady_state(scene, law, method="shooting")
        with monkeypatch.context() as patched:
            patched.setattr(problem, "resonates_once", lambda *_: False)
            many = fl.steady_state(scene, law, method="shooting")

        assert (few.status, few.unique) == (many.status, many.unique) == ("ok", "tested")
        assert few.reason.startswith("tested: 2 starts ")
        assert not many.reason.startswith("tested: 2 starts ")
        assert abs(few.mean_friction - many.mean_friction) <= few.error + many.error
