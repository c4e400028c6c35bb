"""The formulas that docs/theory displays, written out here by their labels, are what the code computes."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy import cos, exp, log, pi, sin, sqrt
from scipy.integrate import quad
from scipy.special import ellipe, ellipk

import frictionlab as fl
from frictionlab import theory
from frictionlab.laws.elasto_plastic import breakaway_share
from frictionlab.scene.body import bent_force, on_the_line
from frictionlab.scene.receptance import RememberingBody
from frictionlab.theory.linear import friction_free_velocity
from frictionlab.theory.periodic_response import periodic_response
from frictionlab.theory.sliding_stability import SteadySliding

PAGES = Path(__file__).parents[2] / "docs" / "theory"

kappa, v, z, softness = 0.37, -1.3 + 0.8j, -0.11 + 0.07j, 0.02
"""Belt speed over slip amplitude; a slip velocity and a deflection in the plane, and their parts along the belt."""
s, w, y = abs(v), v.real, 0.17
mu, mu_k, mu_s, v_s, delta, sigma_0, sigma_1, sigma_2, r_ba = 0.4, 0.3, 0.45, 1.7, 0.2, 2.0, 0.05, 0.03, 0.7
beta, gamma2, v_b, alpha, omega, n, phi = 0.1, 10.0, 5.0, 10.0, 1.5, 0.3, 0.6

coulomb = fl.Coulomb(mu=mu)
dahl = fl.Dahl(mu=mu, presliding_length=delta)
bent = fl.Dahl(mu=mu, presliding_length=delta, exponent=1.4)
jenkins = fl.Jenkins(mu=mu, stiffness=sigma_0)
falling = {"mu_kinetic": mu_k, "mu_static": mu_s, "stribeck_speed": v_s, "viscosity": sigma_2}
lugre = fl.LuGre(**falling, stiffness=sigma_0, damping=sigma_1)
dupont = fl.ElastoPlastic(**falling, stiffness=sigma_0, damping=sigma_1, breakaway_ratio=r_ba)
scene = fl.Scene(
    damping_ratio=beta, normal_load=gamma2, belt_speed=v_b, drive=fl.Drive(unbalance=alpha, frequency=omega)
)
shaken = fl.Scene(
    damping_ratio=beta,
    normal_load=gamma2,
    belt_speed=v_b,
    transverse=fl.Transverse(natural_frequency=2.0, damping_ratio=beta),
    drive=fl.Drive(amplitude=3.0, frequency=omega, phase=20.0, waveform="triangle", direction=40.0),
    belt_vibration=fl.BeltVibration(
        velocity_amplitude=0.7, phase=50.0, frequency_ratio="3/2", waveform="sawtooth", direction=60.0
    ),
    normal_load_variation=fl.NormalLoadVariation(amplitude=n, phase=35.0, waveform="square"),
)
TIMES = np.linspace(0.05, 12.0, 40)


class Formula(NamedTuple):
    """One displayed equation: its label, what it says and what the code says."""

    label: str
    both: Callable[[], tuple[Any, Any]]
    within: float = 1e-13


def wave(name: str, theta: Any) -> Any:
    """The table of waveforms below the equation of a load."""
    return {
        "sine": sin(theta),
        "square": np.sign(sin(theta)),
        "triangle": 2.0 / pi * np.arcsin(sin(theta)),
        "sawtooth": (np.mod(theta + pi, 2.0 * pi) - pi) / pi,
    }[name]


def g(speed: float, exponent: float = 2.0) -> float:
    """The exponential Stribeck curve."""
    return mu_k + (mu_s - mu_k) * float(exp(-((speed / v_s) ** exponent)))


def curve(name: str) -> float:
    """The table of Stribeck curves, at the speed s."""
    u, d = s / v_s, mu_s - mu_k
    return {
        "exponential": g(s),
        "hyperbolic": mu_k + d / (1.0 + u),
        "hess-soom": mu_k + d / (1.0 + u**2),
        "cubic": mu_s - 0.5 * d * (3.0 * u - u**3),
    }[name]


def alpha_of(size: float) -> float:
    """The share of slip that elasto-plastic bristles do not follow, at the slip speed s."""
    z_max, z_ba = g(s) / sigma_0, r_ba * mu_k / sigma_0
    if size <= z_ba or size >= z_max:
        return float(size >= z_max)
    return 0.5 + 0.5 * float(sin(pi * (size - 0.5 * (z_max + z_ba)) / (z_max - z_ba)))


def stribeck_vector(name: str) -> complex:
    return fl.Stribeck(**falling, curve=name).sliding_vector(v)


def bristle_friction(law: Any, slip: Any, deflection: Any) -> Any:
    return law.friction(slip, deflection, law.rate(slip, deflection))


def back_and_forth() -> tuple[float, float]:
    t = np.arccos(kappa)
    back = 2.0 * (sin(t) - t * cos(t))
    return back, back + 2.0 * pi * kappa


def mean_of(slip: Callable[[float], complex], of: Callable[[complex], float]) -> float:
    """Mean over one turn of a function of the slip velocity."""
    return quad(lambda theta: of(slip(theta)), 0.0, 2.0 * pi, epsabs=1e-12, limit=200)[0] / (2.0 * pi)


def one_harmonic_residual() -> float:
    """Left-hand side over right-hand side, at the velocity of the code."""
    a_, a, c, load = 1.0 - omega**2, 2.0 * beta * omega, 4.0 * mu * gamma2 / pi, alpha * omega**2
    velocity = float(theory.one_harmonic_velocity(scene, mu * gamma2, kappa))
    left = (a_ * velocity) ** 2 + (a * velocity + c * omega * sqrt(1.0 - kappa**2)) ** 2
    return left / (load * omega) ** 2


def one_harmonic_solved() -> float:
    a_, a, c, load = 1.0 - omega**2, 2.0 * beta * omega, 4.0 * mu * gamma2 / pi, alpha * omega**2
    held = c * sqrt(1.0 - kappa**2)
    return omega * (-a * held + sqrt(load**2 * (a_**2 + a**2) - (a_ * held) ** 2)) / (a_**2 + a**2)


def soft_dahl(exponent: float) -> float:
    back, forth = back_and_forth()
    r = (back / forth) ** (1.0 / exponent)
    return (1.0 - r) / (1.0 + r)


def impedance(p: complex) -> complex:
    slope = -(mu_s - mu_k) * 2.0 * s / v_s**2 * exp(-((s / v_s) ** 2))
    lag = g(s) / (sigma_0 * s)
    return slope * (1.0 + p * sigma_1 / sigma_0) / (1.0 + p * lag) + sigma_2


def linearized() -> SteadySliding:
    """Of the code's own LuGre law: its slope by differences."""
    step = 1e-6
    ends = [lugre.sliding_friction(s + side * step) - sigma_2 * (s + side * step) for side in (-1.0, 1.0)]
    return SteadySliding(
        (ends[1] - ends[0]) / (2.0 * step), lugre.sliding_friction(s) / (sigma_0 * s) - sigma_2 / sigma_0,
        sigma_1 / sigma_0, sigma_2,
    )  # fmt: skip


def stable_by_routh(damping: float, slope: float) -> bool:
    lag, lead = 0.3, 0.1
    c, h = damping, slope
    second, first = 1.0 + c * lag + h * lead, c + h + lag
    return second > 0.0 and first > 0.0 and second * first > lag


@cache
def state() -> fl.SteadyState:
    """The steady state of the scene, by its own method."""
    return fl.steady_state(scene, coulomb)


@cache
def orbit() -> Any:
    return state().orbit(4000)


def acceleration_less_forces() -> float:
    """The largest residual of the equation of motion, at samples next to which slip does not reverse."""
    tau, x, u, t = (orbit()[name].to_numpy() for name in ("tau", "x1", "v1", "friction"))
    middle = (u[2:] - u[:-2]) / (tau[2:] - tau[:-2])
    load = alpha * omega**2 * sin(omega * tau)
    residual = middle + (2.0 * beta * u + x + gamma2 * t - load)[1:-1]
    same = (abs(t[2:] - t[1:-1]) < 1e-9) & (abs(t[1:-1] - t[:-2]) < 1e-9)
    assert same.mean() > 0.9
    return float(np.abs(residual[same]).max())


def energy(integrand: Callable[[Any], Any]) -> float:
    """Over one period of the samples, by the rule of rectangles."""
    return float(np.mean(integrand(orbit()))) * 2.0 * pi / omega


def held_by_bends(x: float, rate: float) -> float:
    """The force of dashpot and spring along the belt by the text of the page."""
    r, k_3, c_3 = 0.2, -0.3, 0.4
    strained = (1 + 2 * r * x) ** 2 * 2 * beta * rate + (1 + r * x) * (1 + 2 * r * x) * x
    return strained + k_3 * x**3 + c_3 * x**2 * rate


def held_by_code(x: float, rate: float) -> float:
    body = fl.Body(curvature=0.2, cubic_stiffness=-0.3, amplitude_damping=0.4)
    return float(bent_force(on_the_line(scene.with_(body=body).mass()), x, rate))


REMEMBERS = RememberingBody(
    0.2,
    relaxation=fl.Relaxation(stiffness=0.5, time=2.0, order=0.7),
    fractional=fl.Fractional(coefficient=0.3, order=0.4),
)


def stiffness_that_remembers(p: complex) -> complex:
    """The dynamic stiffness of that body."""
    power = (2.0 * p) ** 0.7
    return p**2 + 0.2 * p + 1.0 + 0.5 * power / (1.0 + power) + 0.3 * p**0.4


def answer_to_a_step(tau: float, harmonics: int) -> float:
    """V of the relay locus, its sum cut off, at the frequency 0.8."""
    k = np.arange(1.0, harmonics + 1.0)
    terms = [exp(0.8j * m * tau) / stiffness_that_remembers(0.8j * m) for m in k]
    return 0.8 / (2.0 * pi) * (1.0 + 2.0 * float(np.sum(terms).real))


def velocity_after_a_step(tau: float) -> float:
    """The same as the package has it."""
    found = periodic_response(REMEMBERS, 0.8)
    panel = int(tau / found.period * found.panels)
    place = 2.0 * (tau / found.period * found.panels - panel) - 1.0
    return float(np.polynomial.chebyshev.chebval(place, found.value[panel]))


MODEL = [
    Formula("motion", lambda: (0.0, acceleration_less_forces()), 2e-3),
    Formula("motion-bent", lambda: (held_by_bends(0.7, -1.1), held_by_code(0.7, -1.1))),
    Formula("dynamic-stiffness", lambda: (stiffness_that_remembers(0.3j), REMEMBERS.dynamic_stiffness(0.3j))),
    Formula("relay-locus", lambda: (answer_to_a_step(3.0, 5_000), velocity_after_a_step(3.0)), 1e-8),
    Formula("slip", lambda: ((orbit()["v1"] - v_b).to_numpy(), orbit()["slip"].to_numpy())),
    Formula(
        "load",
        lambda: (
            3.0 * cos(np.radians(40.0)) * wave("triangle", omega * TIMES + np.radians(20.0)),
            shaken.signals().load[0](TIMES),
        ),
        1e-12,
    ),
    Formula(
        "varying",
        lambda: (
            0.7 * sin(np.radians(60.0)) * wave("sawtooth", 1.5 * omega * TIMES + np.radians(50.0)),
            shaken.signals().belt[1](TIMES),
        ),
        1e-12,
    ),
    Formula(
        "varying",
        lambda: (
            gamma2 * (1.0 + n * wave("square", omega * TIMES + np.radians(35.0))),
            gamma2 + shaken.signals().normal_load(TIMES),
        ),
        1e-12,
    ),
    Formula("mean", lambda: (-orbit()["friction"].mean(), state().mean_friction), 1e-3),
    Formula("balance", lambda: (orbit()["x1"].mean(), gamma2 * state().mean_friction), 1e-8),
    Formula(
        "vlin",
        lambda: (
            alpha * omega**3 / sqrt((1.0 - omega**2) ** 2 + (2.0 * beta * omega) ** 2),
            friction_free_velocity(scene),
        ),
        1e-12,
    ),
    Formula("energies", lambda: (energy(lambda o: 2.0 * beta * o["v1"] ** 2), state().energy_viscous), 1e-3),
    Formula(
        "energies",
        lambda: (energy(lambda o: gamma2 * o["friction"] * (o["v1"] - v_b)), state().energy_contact),
        0.5,
    ),
    Formula(
        "energy-balance",
        lambda: (
            state().energy_friction + v_b * gamma2 * state().mean_friction * 2.0 * pi / omega,
            state().energy_contact,
        ),
        1e-8,
    ),
]
CURVES = ("exponential", "hyperbolic", "hess-soom", "cubic")
LAWS = [
    Formula("coulomb", lambda: (mu * v / s, coulomb.sliding_vector(v))),
    Formula(
        "stribeck",
        lambda: ([(curve(name) + sigma_2 * s) * v / s for name in CURVES], [*map(stribeck_vector, CURVES)]),
    ),
    Formula("bristle", lambda: (v - s / (g(s) / sigma_0) * z, lugre.rate(v, z))),
    Formula("dahl", lambda: (abs(1.0 + sigma_0 * y / mu) ** 1.4 * w, bent.rate(w, y))),
    Formula("dahl-vector", lambda: (v - s / delta * z, dahl.rate(v, z))),
    Formula("dahl-vector", lambda: (mu / delta * z, bristle_friction(dahl, v, z))),
    Formula("dahl-path", lambda: (1.0 - 1.6 * exp(-0.8), theory.dahl_path(-0.6, 0.8))),
    Formula(
        "dahl-path",
        lambda: (
            1.0 - (1.6 ** (1.0 - 1.4) + 0.4 * 0.8) ** (1.0 / (1.0 - 1.4)),
            theory.dahl_path(-0.6, 0.8, 1.4),
        ),
    ),
    Formula("jenkins", lambda: (v, jenkins.rate(v, 0.5 * mu / sigma_0 * v / s))),
    Formula(
        "jenkins",
        lambda: (
            v - (z / abs(z)) * (z * v.conjugate()).real / abs(z),
            jenkins.rate(v, (1.0 + 1e-9) * mu / sigma_0 * z / abs(z)),
        ),
    ),
    Formula(
        "lugre",
        lambda: (
            sigma_0 * z + sigma_1 * (v - sigma_0 * s / g(s) * z) + sigma_2 * v,
            bristle_friction(lugre, v, z),
        ),
    ),
    Formula(
        "passive",
        lambda: (
            [viscosity >= sigma_1 * (mu_s / mu_k - 1.0) for viscosity in (0.024, 0.026)],
            [lugre.model_copy(update={"viscosity": viscosity}).passive() for viscosity in (0.024, 0.026)],
        ),
    ),
    Formula("elasto-plastic", lambda: (w, dupont.rate(w, y))),  # unloading
    Formula("elasto-plastic", lambda: (v - alpha_of(abs(z)) * sigma_0 * s / g(s) * z, dupont.rate(v, z))),
    Formula(
        "breakaway",
        lambda: (
            [alpha_of(size) for size in (0.05, 0.13, 0.3)],
            [breakaway_share(size, r_ba * mu_k / sigma_0, g(s) / sigma_0) for size in (0.05, 0.13, 0.3)],
        ),
    ),
]
WAVES = ("sine", "triangle", "sawtooth", "square")
ANGLES = np.linspace(0.0, 2.0 * pi, 1_000_001)
SLOPES = (-0.6, -0.24, -0.15, 0.1)
MEANS = [
    Formula(
        "gradient",
        lambda: (
            mean_of(lambda theta: kappa + 1j * sin(theta), lambda slip: slip.real / abs(slip)),
            theory.mean_prescribed_transverse(kappa),
        ),
        1e-8,
    ),
    Formula(
        "distribution",
        lambda: (
            [2.0 * np.mean(wave(name, ANGLES) < kappa) - 1.0 for name in WAVES],
            [theory.mean_prescribed_longitudinal(kappa, name) for name in WAVES],
        ),
        1e-5,
    ),
    Formula(
        "pulsating",
        lambda: (
            2.0 / pi * (np.arcsin(kappa) - n * sqrt(1.0 - kappa**2) * cos(phi)),
            theory.mean_prescribed_pulsating(kappa, n, phi),
        ),
    ),
    Formula(
        "across",
        lambda: (
            2.0 / pi * (kappa / sqrt(1.0 + kappa**2)) * ellipk(1.0 / (1.0 + kappa**2)),
            theory.mean_prescribed_transverse(kappa),
        ),
    ),
    Formula(
        "circle",
        lambda: (
            2.0 / pi * (ellipe(kappa**2) - (1.0 - kappa**2) * ellipk(kappa**2)) / kappa,
            theory.mean_prescribed_circular(kappa),
        ),
    ),
    Formula("circle", lambda: (2.0 / pi * ellipe(kappa**2), theory.mean_prescribed_circular(1.0 / kappa))),
    Formula(
        "mdsm",
        lambda: (
            2.0 * mu / pi * np.arcsin(v_b / friction_free_velocity(scene)),
            fl.steady_state(scene, coulomb, fl.Mdsm()).mean_friction,
        ),
    ),
    Formula("one-harmonic", lambda: (1.0, one_harmonic_residual())),
    Formula(
        "one-harmonic-solved",
        lambda: (one_harmonic_solved(), theory.one_harmonic_velocity(scene, mu * gamma2, kappa)),
        1e-12,
    ),
    Formula("concave", lambda: (1.0 - 4.0 / pi + 8.0 * 0.29 / pi**2, theory.chord_area_at_resonance(0.29))),
    Formula("concave", lambda: (pi / 16.0, theory.CONCAVE_BY_INITIAL_CURVATURE)),
    Formula(
        "stiff",
        lambda: (
            2.0 / (3.0 * pi) * 2.0 ** (1.0 - 0.6) / (2.0 - 0.6) * kappa / (1.0 - kappa**2),
            theory.stiff_correction(kappa, 0.6),
        ),
    ),
    Formula("soft", lambda: (soft_dahl(1.4), theory.mean_soft_dahl(kappa, 1.4))),
    Formula("soft", lambda: (back_and_forth(), theory.slip_back_and_forth(kappa))),
    Formula("drift", lambda: (log((1.0 - 0.2**2) / (1.0 - 0.7**2)), theory.dahl_drift(-0.2, 0.7))),
    Formula("impedance", lambda: (impedance(0.7j), linearized().impedance(0.7j)), 1e-8),
    Formula(
        "routh",
        lambda: (
            [stable_by_routh(0.2, slope) for slope in SLOPES],
            [SteadySliding(slope, 0.3, 0.1).stable(0.2, 1.0) for slope in SLOPES],
        ),
    ),
]
FORMULAS = {"model": MODEL, "laws": LAWS, "means": MEANS}
WITHOUT_A_NUMBER = {"motion-si", "stick", "prescribed"}
"""The same motion in SI units, the condition of stick and a given slip: checked where SI units and events are."""


@pytest.mark.parametrize("formula", [*MODEL, *LAWS, *MEANS], ids=lambda each: each.label)
def test_a_displayed_formula_is_what_the_code_computes(formula: Formula) -> None:
    says, code = formula.both()

    assert code == pytest.approx(says, rel=formula.within, abs=formula.within)


@pytest.mark.parametrize("page", FORMULAS)
def test_every_labelled_formula_of_the_model_the_laws_and_the_means_is_checked(page: str) -> None:
    shown = re.findall(r"^<!-- formula ([\w-]+) -->$", (PAGES / f"{page}.md").read_text(), re.MULTILINE)

    assert {each.label for each in FORMULAS[page]} == set(shown) - WITHOUT_A_NUMBER
