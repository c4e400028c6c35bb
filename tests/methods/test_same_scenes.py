"""Scenes that are the same one told in two ways, and signals as the tests read them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from draws_of_every_kind import convergent
from hypothesis import given, settings
from outside_forcing import BELT1, LOAD1, NORMAL, forcing
from profiles import DEEP, deep
from scenes_of_every_kind import (
    line,
    plane,
)
from scipy.integrate import solve_ivp

import frictionlab as fl
from frictionlab.scene.scene import Scene


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


def mean(scene: dict[str, Any]) -> float:
    """Mean Coulomb friction."""
    found = fl.steady_state(fl.Scene(**scene), fl.Coulomb(mu=0.4), tolerance=1e-11)
    assert found.status == "ok", found.reason
    return found.mean_friction


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
