"""Proof of means in interval arithmetic: known digits, random scenes, next to bifurcations, wrong orbits."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import flint
import numpy as np
import pytest
from certified.forces import forces_of
from certified.method import Certified
from certified.motion import Mechanics, NotProved, values_at
from certified.prove import BITS, Unproved, enclosed_mean, prove, starts_of
from profiles import some
from random_scenes import draw
from varying_scenes import draw_varying

import frictionlab as fl

RESONANCE = fl.Scene(
    damping_ratio=0.1, normal_load=10, belt_speed=10, drive=fl.Drive(amplitude=10, frequency=1)
)
COULOMB = fl.Coulomb(mu=0.4)


def at_speed(scene: fl.Scene, speed: float) -> fl.Scene:
    return scene.model_copy(update={"belt_speed": float(speed)})


def orbit_of(scene: fl.Scene, law: Any) -> Any:
    return fl.Exact().solve([scene], law, 1e-8).orbit(0)


@pytest.mark.parametrize(
    ("speed", "digits", "within"),
    [
        (10, "0.0980719340744308784958", "6.6e-23"),
        (40, "0.3233113793031319011918", "8.2e-23"),
    ],
)
def test_a_mean_has_the_digits_known_from_elsewhere(speed: float, digits: str, within: str) -> None:
    """An enclosure by an unrelated program, of the numbers 1/10 and 2/5 themselves, not of doubles near them."""
    scene = at_speed(RESONANCE, speed)
    with flint.ctx.workprec(BITS):
        mechanics = Mechanics(flint.arb(1) / 10, flint.arb(2) / 5, forces_of(scene))
        starts = starts_of(orbit_of(scene, COULOMB), 2.0 * math.pi)
        mean = enclosed_mean(mechanics, starts) / 10
        known = flint.arb(digits, within)

        assert mean.overlaps(known)
        assert float(mean.rad()) < 1e-26


def test_forces_in_intervals_are_those_of_the_scene() -> None:
    rng = np.random.default_rng(5)
    for _ in range(40):
        scene, _law = draw_varying(rng)
        signals = scene.signals()
        with flint.ctx.workprec(BITS):
            forces = forces_of(scene)
            for piece in forces.pieces:
                for share in (0.01, 0.4, 0.99):
                    tau = piece.start + share * (piece.stop - piece.start)
                    at = float(tau.mid())
                    load, belt, normal = (
                        float(values_at(each, piece.start, tau).value.mid())
                        for each in (piece.load, piece.belt, piece.normal_load)
                    )
                    assert load == pytest.approx(signals.load[0](at), abs=1e-10)
                    assert belt == pytest.approx(scene.belt_speed + signals.belt[0](at), abs=1e-10)
                    assert normal == pytest.approx(scene.normal_load + signals.normal_load(at), abs=1e-9)


def provable(scene: fl.Scene, law: Any) -> bool:
    """Check whether the exact method answers it with an estimated error, and theorem T1 holds."""
    if scene.belt_speed == 0.0 or scene.damping_ratio == 0.0 or fl.Exact().refusal(scene, law):
        return False
    answers = fl.Exact().solve([scene], law, 1e-8)
    return answers.status[0] == "ok" and answers.error_kind[0] == "estimated"


@pytest.mark.parametrize("drawn", [draw, draw_varying])
def test_every_random_scene_is_proved_and_within_the_estimated_error(drawn: Any) -> None:
    rng = np.random.default_rng(11)
    for _ in range(40):
        scene, law = drawn(rng)
        if provable(scene, law):
            found = fl.Exact().solve([scene], law, 1e-8)
            proved = prove(scene, law.mu, found.orbit(0))

            assert abs(proved.mean - found.mean[0]) <= found.error[0] + proved.error
            assert proved.error <= 2e-16 * abs(proved.mean) + 1e-18


def leg_signs(scene: fl.Scene) -> tuple[int, ...]:
    """Return the signs of the legs of the orbit, from whichever leg makes the tuple least."""
    answers = fl.Exact().solve([scene], COULOMB, 1e-8)
    if answers.error_kind[0] != "estimated":
        return ()
    signs = [start.sign for start in starts_of(answers.orbit(0), 2.0 * math.pi / scene.frequency)]
    return tuple(min(signs[i:] + signs[:i] for i in range(len(signs))))


@some(1, "seconds of intervals")
@pytest.mark.parametrize(
    ("scene", "low", "high"),
    [
        (RESONANCE, 43.0, 44.5),  # stick begins
        (RESONANCE, 49.5, 49.99999),  # it ends
        (
            fl.Scene(
                damping_ratio=0.1, normal_load=10, belt_speed=1, drive=fl.Drive(amplitude=6, frequency=0.4)
            ),
            0.2,
            2.0,
        ),  # legs of slip and stick come and go
    ],
)
def test_scenes_an_ulp_from_a_bifurcation_are_proved(scene: fl.Scene, low: float, high: float) -> None:
    first = leg_signs(at_speed(scene, low))
    while (middle := 0.5 * (low + high)) not in (low, high):
        low, high = (middle, high) if leg_signs(at_speed(scene, middle)) == first else (low, middle)
    for speed in (np.nextafter(low, 0.0), low, high, np.nextafter(high, math.inf)):
        here = at_speed(scene, speed)
        if leg_signs(here):
            found = fl.Exact().solve([here], COULOMB, 1e-8)
            proved = prove(here, COULOMB.mu, found.orbit(0))

            assert abs(proved.mean - found.mean[0]) <= found.error[0] + proved.error


def test_a_wrong_orbit_proves_nothing_wrong() -> None:
    """Orbits of another belt speed: refused, or led to the orbit of the scene itself."""
    refused = 0
    for speed in (5.0, 20.0, 35.0, 46.0, 48.0):
        for other in (0.6 * speed, 0.9 * speed, 1.04 * speed):
            scene = at_speed(RESONANCE, speed)
            found = fl.Exact().solve([scene], COULOMB, 1e-8)
            try:
                proved = prove(scene, COULOMB.mu, orbit_of(at_speed(RESONANCE, other), COULOMB))
            except NotProved:
                refused += 1
            else:
                assert abs(proved.mean - found.mean[0]) <= found.error[0] + proved.error
    assert refused < 15  # a first guess may be far off


def test_legs_of_a_wrong_kind_are_refused() -> None:
    """Without repair: stick where the mass slides, slip where it sticks."""
    for speed, name in ((46.0, "the stick"), (20.0, "a reversal")):
        scene = at_speed(RESONANCE, speed)
        with flint.ctx.workprec(BITS):
            mechanics = Mechanics(flint.arb(0.1), flint.arb(0.4), forces_of(scene))
            starts = starts_of(orbit_of(scene, COULOMB), 2.0 * math.pi)
            enclosed_mean(mechanics, starts)
            wrong = [one._replace(sign={0: 1, 1: 0, -1: -1}[one.sign]) for one in starts]
            with pytest.raises(Unproved):
                enclosed_mean(mechanics, wrong)
            assert wrong != starts, name


def test_a_curve_is_guaranteed_where_it_is_asked_for() -> None:
    speeds = [5.0, 20.0, 46.0, 55.0]
    plain = fl.curve(RESONANCE, COULOMB, speeds, method="exact")
    table = fl.curve(RESONANCE, COULOMB, speeds, method=Certified())

    assert set(table["error_kind"]) == {"guaranteed"}
    assert set(plain["error_kind"]) == {"guaranteed", "estimated"}
    assert (table["error"] <= 1e-15).all()
    assert all(model.endswith("; proved in intervals") for model in table["model"][:3])
    assert ((table["mean_friction"] - plain["mean_friction"]).abs() <= plain["error"] + table["error"]).all()


def test_what_exact_refuses_is_refused_for_the_same_reason() -> None:
    assert Certified().refusal(RESONANCE, fl.Dahl(mu=0.4, stiffness=4)) == fl.Exact().refusal(
        RESONANCE, fl.Dahl(mu=0.4, stiffness=4)
    )


def test_under_a_prescribed_slip_errors_stay_those_of_exact() -> None:
    scene = fl.Scene(slip=fl.Slip(velocity_amplitude=2, frequency=1, waveform="triangle"), belt_speed=1)
    plain, state = (fl.steady_state(scene, COULOMB, method=each) for each in ("exact", "certified"))

    assert (state.mean_friction, state.error, state.error_kind) == (
        plain.mean_friction,
        plain.error,
        plain.error_kind,
    )
    assert state.error_kind == "guaranteed" or "prescribed slip" in state.reason


def test_its_study_keeps_its_promises() -> None:
    done = fl.run(Path(__file__).parent / "study.yaml")

    assert [verdict.sentence for verdict in done.verdicts if not verdict.passed] == []
    assert set(done.table["status"]) == {"ok"}


def test_where_no_theorem_says_so_errors_stay_estimated() -> None:
    """Without damping nothing but reversals brings motions together."""
    scene = fl.Scene(
        damping_ratio=0, normal_load=10, belt_speed=1, drive=fl.Drive(amplitude=10, frequency=0.5)
    )
    row = fl.curve(scene, COULOMB, [1.0], method=Certified()).iloc[0]

    assert row["status"] == "ok"
    assert row["error_kind"] == "estimated"
    assert "no theorem" in row["reason"]
