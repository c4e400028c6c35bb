"""Bodies known by a table of their receptance, solved by the relay locus: two modes, and what is refused."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
from linear_bodies.method import LocusCurve, RelayLocus
from profiles import deep
from scipy.linalg import expm
from scipy.optimize import brentq

from frictionlab.laws.coulomb import Coulomb
from frictionlab.scene.scene import Body, Drive, Receptance, Scene

LAW = Coulomb(mu=0.4)
SPEEDS = np.array([0.2, 1.0, 3.0, 6.0, 12.0, 40.0])


def two_modes(p, damping=0.2, coupling=0.5, mass=0.3, loss=0.1):
    """x1 over force of a mass with spring 1, to which another one is tied by a spring and a dashpot."""
    tie = coupling + loss * p
    return 1.0 / (p**2 + damping * p + 1.0 + tie - tie**2 / (tie + mass * p**2))


@dataclass(frozen=True)
class Known:
    """Two modes in closed form; above ``known_to`` a free mass where that is finite."""

    known_to: float = 6.0
    free: bool = False
    mass: float = 1.0
    damping: float = 0.0
    fastest: float = 3.0
    detail: float = 6.0
    smooth: bool = True
    dissipates: bool = True

    def receptance(self, omega):
        at = np.asarray(omega, dtype=float)
        known = two_modes(1j * at)
        return (
            np.where(at > self.known_to, self.beyond(1j * np.maximum(at, 1e-9)), known)
            if self.free
            else known
        )

    def beyond(self, p):
        return 1.0 / p**2 if self.free else two_modes(p)


def write(folder, omega, values, name="h.csv"):
    rows = [f"{float(a)!r},{float(b.real)!r},{float(b.imag)!r}" for a, b in zip(omega, values, strict=True)]
    file = folder / name
    file.write_text("\n".join(["frequency,real,imaginary", *rows]) + "\n")
    return str(file)


def measured(file, free_mass=1.0, belt_speed=1.0):
    body = Body(receptance=Receptance(file=file, free_mass=free_mass))
    return Scene(
        normal_load=10.0, belt_speed=belt_speed, drive=Drive(amplitude=10.0, frequency=1.0), body=body
    )


def closed_form(scene, known, speeds):
    return LocusCurve([scene.at(float(v)) for v in speeds], 0.4, 1e-9, known).told()


@pytest.mark.parametrize("count", [121, 481, 1921])
def test_a_table_is_as_far_from_the_closed_form_as_it_says(tmp_path, count):
    omega = np.linspace(0.0, 12.0, count)
    scene = measured(write(tmp_path, omega, two_modes(1j * omega)))

    found = RelayLocus().solve([scene.at(float(v)) for v in SPEEDS], LAW, 1e-9)
    true = closed_form(scene, Known(12.0, free=True, detail=12.0), SPEEDS)

    assert found.status == ["ok"] * len(SPEEDS) == true.status
    assert np.all(np.abs(found.mean - true.mean) <= found.error + true.error)
    assert true.error.max() < 1e-12
    assert found.error.max() < 3.0 * (120.0 / (count - 1)) ** 3


def followed(load, limit, frequency, belt_speed, periods=45, steps=400):
    """Mean friction over its limit of the two masses, in steps that are exact between reversals of slip."""
    flow = np.zeros((7, 7))  # x, v, x2, v2, sine and cosine of the load, friction
    flow[0, 1] = flow[2, 3] = 1.0
    flow[1] = [-1.5, -0.3, 0.5, 0.1, load, 0.0, -1.0]
    flow[3] = np.array([0.5, 0.1, -0.5, -0.1, 0.0, 0.0, 0.0]) / 0.3
    flow[4, 5], flow[5, 4] = frequency, -frequency
    h = 2.0 * math.pi / frequency / steps
    step, state = expm(flow * h), np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0, -limit])
    for _ in range(periods):
        impulse = 0.0
        for _ in range(steps):
            ahead = step @ state
            sign = math.copysign(1.0, state[6])
            if sign * (ahead[1] - belt_speed) > 0.0:
                impulse, state = impulse + h * state[6], ahead
                continue
            part = brentq(lambda r, at: (expm(flow * r) @ at)[1] - belt_speed, 0.0, h, (state,), xtol=1e-15)
            state, impulse = expm(flow * part) @ state, impulse + part * state[6]
            state[6] = -state[6]
            impulse, state = impulse + (h - part) * state[6], expm(flow * (h - part)) @ state
    return -impulse / limit / (2.0 * math.pi / frequency)


@deep("seconds of steps")
def test_two_modes_move_as_two_masses_followed_in_time():
    scene = Scene(
        damping_ratio=0.1, normal_load=2.0, belt_speed=1.0, drive=Drive(amplitude=10.0, frequency=1.0)
    )
    speeds = [2.0, 6.0]

    ours = closed_form(scene, Known(), speeds)

    assert all(len(np.unique(ours.orbit(i).stick)) == 1 for i in range(2))  # no rest
    np.testing.assert_allclose(ours.mean, [0.4 * followed(10.0, 0.8, 1.0, v) for v in speeds], atol=1e-10)


def test_without_a_free_mass_the_jumps_of_friction_are_refused(tmp_path):
    omega = np.linspace(0.0, 12.0, 121)
    scene = measured(write(tmp_path, omega, two_modes(1j * omega)), free_mass=None)

    assert "give body.receptance.free_mass" in RelayLocus().refusal(scene, LAW)
