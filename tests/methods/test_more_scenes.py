"""Every method on scenes of every kind, against the tests' own integration; scenes that are the same one.

``reference/more_scenes.csv`` holds what ``outside_state`` found for each; ``make_outside.py`` wrote it.
"""

from __future__ import annotations

import csv
import math
from typing import Any

import numpy as np
import pytest
from answered import with_columns
from collocation import REFERENCE
from draws_of_every_kind import convergent
from hypothesis import given, settings
from outside_forcing import BELT1, LOAD1, NORMAL, forcing
from profiles import DEEP, deep
from scenes_of_every_kind import (
    COULOMB,
    ON_THE_LINE,
    SCENES,
    line,
    plane,
)
from scipy.integrate import solve_ivp

from frictionlab import steady_state
from frictionlab.laws.dahl import Dahl
from frictionlab.methods.auto import Auto
from frictionlab.scene.scene import Scene
from frictionlab.study import registry

ROWS = (REFERENCE / "more_scenes.csv").read_text(encoding="utf-8").splitlines()
TRUTH = {row["name"]: row for row in csv.DictReader(ROWS)}
ENERGIES = "energy_input", "energy_viscous", "energy_friction", "energy_contact"
PLAIN = [name for name, (_, law) in ON_THE_LINE.items() if law == COULOMB]
"""Coulomb friction on the line: the scenes of the exact method."""
REST = [name for name in SCENES if name not in PLAIN]


def law_of(keys: dict[str, Any]) -> Any:
    return registry.law_class(keys["kind"])(**{name: keys[name] for name in keys if name != "kind"})


def solve(method, keys, tolerance=1e-10):
    """The columns of one scene; its status and reason."""
    scene, law = keys
    found = with_columns(method, [Scene(**scene)], law_of(law), tolerance)
    return found, {name: found.columns[name][0] for name in found.columns} if found.status[0] == "ok" else {}


def mean(scene: dict[str, Any], law: dict[str, Any] = COULOMB, tolerance: float = 1e-11) -> float:
    found, columns = solve(Auto(), (scene, law), tolerance)
    assert found.status[0] == "ok", found.reason
    return float(columns["mean_friction"])


def agrees(name: str, method: Any, tolerance: float, within: float) -> bool:
    """Compare with the truth where the method does not refuse; whether it did not."""
    refusal = method.refusal(Scene(**SCENES[name][0]), law_of(SCENES[name][1]))
    if refusal is not None:
        return False
    found, columns = solve(method, SCENES[name], tolerance)
    assert found.status[0] in ("ok", "not_unique"), f"{name}: {found.status[0]}, {found.reason[0]}"
    true, accuracy = float(TRUTH[name]["mean_friction"]), float(TRUTH[name]["accuracy"])
    if found.status[0] == "not_unique":
        assert columns == {}
        return True
    off = abs(columns["mean_friction"] - true)
    assert off <= columns["error"] + accuracy, f"{name}: off by {off:.1e}, error {columns['error']:.1e}"
    assert off <= within, f"{name}: off by {off:.1e}"
    return True


def test_there_are_sixty_and_each_has_its_truth():
    assert len(SCENES) == len(TRUTH) == 60
    assert list(TRUTH) == list(SCENES)
    assert max(float(row["accuracy"]) for row in TRUTH.values()) <= 1e-10


@pytest.mark.parametrize("name", PLAIN)
def test_exact_agrees_on_the_line(name):
    """The mean to 1e-9; work, rest, reversals and the period of the same motion."""
    found, columns = solve(registry.method_class("exact")(), SCENES[name])
    assert found.status[0] == "ok", found.reason
    true = TRUTH[name]
    off = abs(columns["mean_friction"] - float(true["mean_friction"]))
    assert off <= min(columns["error"] + float(true["accuracy"]), 1e-9)
    for energy in ENERGIES:
        slack = columns[f"{energy}_error"] + 1e-11 * (1.0 + abs(float(true["energy_contact"])) * 10.0)
        assert columns[energy] == pytest.approx(float(true[energy]), rel=0.0, abs=slack), energy
    assert columns["stick_fraction"] == pytest.approx(float(true["stick_fraction"]), abs=1e-10)
    assert columns["reversals"] == float(true["reversals"])
    assert columns["period"] == float(true["period"])


@deep("kernels of every law, on the line and in the plane")
@pytest.mark.parametrize("name", REST)
def test_auto_agrees(name):
    assert agrees(name, Auto(), 1e-9, 1e-9) or "constant contact" in name


@deep("minutes of steps and of compiling")
@pytest.mark.parametrize("method", ["exact", "shooting", "march", "harmonic_balance", "mdsm"])
def test_no_error_of_any_method_is_too_small(method):
    """On those of the sixty scenes that it does not refuse, with a reason."""
    one = registry.method_class(method)()
    accepted = [name for name in SCENES if agrees(name, one, 1e-6, math.inf)]
    assert accepted or method in ("harmonic_balance", "mdsm")


def test_a_slider_pulled_over_a_plate_is_the_scene_seen_from_the_plate():
    """By its own equations, with scipy: the far end of the spring moves evenly, the plate vibrates, no stick."""
    speed, mu, load, damping, swing, omega = 3.0, 0.4, 2.0, 0.2, 5.0, 1.4

    def rates(tau, state, side):
        end, x, v, _ = state
        force = (end - x) + 2.0 * damping * (speed - v)
        return [speed, v, force - mu * load * side, force]

    def reversal(tau, state, side):
        return side * (state[2] - swing * math.sin(omega * tau))

    reversal.terminal, reversal.direction = True, -1.0
    period = 2.0 * math.pi / omega
    state, tau, side, pulls = np.array([0.0, 0.0, 1.0, 0.0]), 0.0, 1.0, []
    for turn in range(1, 60):
        state[3] = 0.0
        while tau < turn * period:
            leg = solve_ivp(
                rates,
                (tau, turn * period),
                state,
                "DOP853",
                events=reversal,
                args=(side,),
                rtol=1e-12,
                atol=1e-12,
                max_step=0.2,
            )
            tau, state = float(leg.t[-1]), leg.y[:, -1].copy()
            if leg.status == 1:
                side, tau = -side, tau
                plate = swing * math.sin(omega * tau)
                needed = (state[0] - state[1]) + 2.0 * damping * (speed - plate)
                assert abs(needed - swing * omega * math.cos(omega * tau)) > mu * load  # it does not stick
                state[2] = plate + side * 1e-15
        pulls.append(state[3] / period / load)
        state[:2] -= state[0]  # the origin follows, so that positions stay small
    scene = line(speed, damping_ratio=damping, normal_load=load) | {
        "belt_vibration": {"velocity_amplitude": swing, "frequency": omega, "phase": 180.0}
    }
    assert abs(pulls[-1] - pulls[-2]) < 1e-11
    assert pulls[-1] == pytest.approx(mean(scene), abs=1e-10)


@deep("kernels in the plane")
@pytest.mark.parametrize("angle", [35.0, -120.0])
@pytest.mark.parametrize("waveform", ["sine", "square"])
def test_a_direction_is_two_loads(angle, waveform):
    turned = plane(3.0, {"direction": angle, "waveform": waveform}, None)
    along, across = 10.0 * math.cos(math.radians(angle)), 10.0 * math.sin(math.radians(angle))
    one = {"amplitude": abs(along), "phase": 180.0 * (along < 0.0), "waveform": waveform}
    other = {"amplitude": abs(across), "phase": 180.0 * (across < 0.0), "waveform": waveform}
    assert mean(turned) == pytest.approx(mean(plane(3.0, one, other)), abs=1e-10)


@given(convergent())
@settings(max_examples=200 if DEEP else 10)
def test_signals_are_those_of_the_contract(drawn):
    """As the tests read them, and as the package does."""
    scene, _ = drawn
    own, signals = forcing(scene), Scene(**scene).signals()
    assert own.edges[-1] == pytest.approx(signals.period, rel=1e-12)
    for span in range(len(own.pieces)):
        begin, end = own.edges[span], own.edges[span + 1]
        tau = begin + 0.37 * (end - begin)
        value = own.pieces[span, :, 0] + own.pieces[span, :, 1] * (tau - begin)
        for which, (rate, phase, size) in zip(own.which, own.sines, strict=True):
            value[which] += size * math.sin(rate * tau + phase)
        theirs = {LOAD1: signals.load[0], BELT1: signals.belt[0], NORMAL: signals.normal_load}
        for index, signal in theirs.items():
            mean_value = {BELT1: scene["belt_speed"], NORMAL: scene["normal_load"]}.get(index, 0.0)
            assert value[index] == pytest.approx(
                signal(tau) + mean_value, abs=1e-9 * (1.0 + abs(value).max())
            )


@deep("seconds of steps")
def test_where_an_orbit_repels_motions_that_never_repeat_have_a_long_mean():
    """Bristles of constant contact under a square normal load: the orbit of one period has a multiplier of 1.6."""
    scene = Scene(
        damping_ratio=0.17521587733291477,
        normal_load=0.27365081285124804,
        normal_load_variation={
            "waveform": "square",
            "phase": 193.24079948189194,
            "amplitude": 0.23361105079360167,
            "frequency": 2.165853915667782,
            "contact": "constant",
        },
        belt_speed=0.031018767596622785,
    )
    state = steady_state(scene, Dahl(mu=0.8690975812796703, presliding_length=0.039844205871870646))

    assert (state.status, state.error_kind) == ("ok", "statistical")
    assert "does not repeat (chaotic)" in state.reason
    assert state.error < 3e-4
    assert abs(state.mean_friction - 0.87033) < state.error + 3e-4
