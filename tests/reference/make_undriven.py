"""Writes undriven_memory.csv: python tests/reference/make_undriven.py [--only PATTERN].

Cycles of an undriven mass on contacts with memory, by scipy's Radau on formulas written here: from the start until
the mean friction from one largest deflection to the next repeats, with relative tolerances of 1e-9 and 1e-11.
``accuracy`` is ten times the difference of the means, no less than 1e-11, ``period_accuracy`` the same of periods.
The first row is Canudas de Wit et al. (1995), Table I: 1 kg on a spring of 2 N/m pulled at 0.1 m/s, sigma_0 = 1e5
N/m, sigma_1 = sqrt(1e5) N s/m, sigma_2 = 0.4 N s/m, 1 N and 1.5 N, v_s = 1e-3 m/s, in the scales of one metre.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import time
from collections.abc import Callable
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

RESULTS = Path(__file__).with_name("undriven_memory.csv")
COLUMNS = (
    "name",
    "mean_friction",
    "accuracy",
    "period",
    "period_accuracy",
    "deflection",
    "kind",
    "law",
    "scene",
)
REPEATS = 1e3
"""Relative tolerances by which means in a row differ where a motion is taken to repeat."""
MOST_TURNS = 400
Contact = Callable[[float, float], tuple[float, float]]
"""Rate of the memory and friction coefficient, from slip velocity and memory."""


def lugre(p: dict[str, float]) -> tuple[Contact, float, float]:
    """Contact, memory at the start and its size."""

    def contact(w: float, z: float) -> tuple[float, float]:
        curve = p["mu_kinetic"] + (p["mu_static"] - p["mu_kinetic"]) * math.exp(
            -((w / p["stribeck_speed"]) ** 2)
        )
        rate = w - p["stiffness"] * abs(w) / curve * z
        return rate, p["stiffness"] * z + p.get("damping", 0.0) * rate + p.get("viscosity", 0.0) * w

    return contact, 0.0, p["mu_static"] / p["stiffness"]


def elasto_plastic(p: dict[str, float]) -> tuple[Contact, float, float]:
    """The same: bristles elastic below breakaway and where they are unloaded."""

    def contact(w: float, z: float) -> tuple[float, float]:
        curve = p["mu_kinetic"] + (p["mu_static"] - p["mu_kinetic"]) * math.exp(
            -((w / p["stribeck_speed"]) ** 2)
        )
        ends, begins = curve / p["stiffness"], p["breakaway_ratio"] * p["mu_kinetic"] / p["stiffness"]
        middle, share = 0.5 * (begins + ends), 0.0
        if z * w > 0.0 and abs(z) > begins:
            share = (
                1.0 if abs(z) >= ends else 0.5 + 0.5 * math.sin(math.pi * (abs(z) - middle) / (ends - begins))
            )
        rate = w - share * abs(w) * z / ends
        return rate, p["stiffness"] * z + p.get("damping", 0.0) * rate + p.get("viscosity", 0.0) * w

    return contact, 0.0, p["mu_static"] / p["stiffness"]


def rate_and_state(p: dict[str, float]) -> tuple[Contact, float, float]:
    """The same of the ageing law; the memory is an age, at first that of steady sliding at the reference speed."""

    def contact(w: float, age: float) -> tuple[float, float]:
        power = (p["mu"] + p["b"] * math.log(p["reference_speed"] * age / p["slip_length"])) / p["a"]
        rub = p["a"] * math.asinh(0.5 * w / p["reference_speed"] * math.exp(power))
        return 1.0 - abs(w) * age / p["slip_length"], rub

    age = p["slip_length"] / p["reference_speed"]
    return contact, age, age


KINDS = {"lugre": lugre, "elasto-plastic": elasto_plastic, "rate-and-state": rate_and_state}
ROOT = math.sqrt(2.0)
ROWS: list[tuple[str, str, dict[str, Any], dict[str, Any]]] = [
    ("canudas", "lugre",
     {"mu_kinetic": 0.5, "mu_static": 0.75, "stribeck_speed": 1e-3 / ROOT, "stiffness": 5e4,
      "damping": math.sqrt(1e5) / ROOT, "viscosity": 0.4 / ROOT},
     {"damping_ratio": 0.0, "normal_load": 1.0, "belt_speed": 0.1 / ROOT}),
    ("soft", "lugre",
     {"mu_kinetic": 0.3, "mu_static": 0.5, "stribeck_speed": 0.2, "stiffness": 20.0, "damping": 1.0},
     {"damping_ratio": 0.02, "normal_load": 2.0, "belt_speed": 0.15}),
    ("hardly damped", "lugre",
     {"mu_kinetic": 0.3, "mu_static": 0.4, "stribeck_speed": 0.5, "stiffness": 300.0},
     {"damping_ratio": 0.05, "normal_load": 2.0, "belt_speed": 0.4, "initial": {"x": 0.2, "velocity": -0.3}}),
    ("breaks away", "elasto-plastic",
     {"mu_kinetic": 0.3, "mu_static": 0.5, "stribeck_speed": 0.2, "stiffness": 100.0, "damping": 5.0,
      "breakaway_ratio": 0.6},
     {"damping_ratio": 0.02, "normal_load": 2.0, "belt_speed": -0.15}),
    ("ages", "rate-and-state",
     {"mu": 0.4, "a": 0.03, "b": 0.06, "slip_length": 0.01, "reference_speed": 0.3},
     {"damping_ratio": 0.02, "normal_load": 2.0, "belt_speed": 0.3}),
]  # fmt: skip


def solved(kind: str, law: dict[str, Any], scene: dict[str, Any], rtol: float) -> tuple[float, float, float]:
    """Mean friction, period [2 pi] and largest deflection of the cycle that the motion ends on."""
    contact, memory, size = KINDS[kind](law)
    load, damping, belt = scene["normal_load"], 2.0 * scene["damping_ratio"], scene["belt_speed"]
    start = scene.get("initial", {"x": 0.0, "velocity": belt})
    side = math.copysign(1.0, belt)

    def rates(tau: float, y: Any) -> list[float]:
        x, w, z, _ = y.tolist()
        rate, rub = contact(w, z)
        return [w + belt, -x - damping * (w + belt) - load * rub, rate, rub]

    def turns(tau: float, y: Any) -> float:
        return float(y[1] + belt)

    turns.direction = -side  # type: ignore[attr-defined]  # how solve_ivp is told
    place, tau, peaks = np.array([start["x"], start["velocity"] - belt, memory, 0.0]), 0.0, []
    sizes = rtol * np.array([load, abs(belt), size, 1.0])
    while tau < MOST_TURNS * 2.0 * math.pi:
        span = tau, tau + 2.0 * math.pi
        found = solve_ivp(rates, span, place, "Radau", rtol=rtol, atol=sizes, events=turns)
        peaks += [
            (at, y) for at, y in zip(found.t_events[0], found.y_events[0], strict=True) if side * y[0] > 0.0
        ]
        place, tau = found.y[:, -1], span[1]
        pairs = list(zip(peaks[-4:], peaks[-3:], strict=False))
        means = [-(last[3] - first[3]) / (end - begin) for (begin, first), (end, last) in pairs]
        if len(means) == 3 and np.ptp(means) < REPEATS * rtol:
            (begin, _), (end, last) = pairs[-1]
            return float(means[-1]), float(end - begin) / (2.0 * math.pi), float(last[0])
    raise ArithmeticError("the motion does not repeat")


def row(kind: str, law: dict[str, Any], scene: dict[str, Any]) -> dict[str, Any]:
    """The cells of a row."""
    rough, fine = (solved(kind, law, scene, rtol) for rtol in (1e-9, 1e-11))
    accuracy, other = (max(10.0 * abs(fine[i] - rough[i]), 1e-11) for i in (0, 1))
    return {
        "mean_friction": repr(fine[0]), "accuracy": f"{accuracy:.1e}",
        "period": repr(fine[1]), "period_accuracy": f"{other:.1e}", "deflection": repr(fine[2]),
        "kind": kind, "law": json.dumps(law), "scene": json.dumps(scene),
    }  # fmt: skip


def main(only: str) -> None:
    """Solve and write."""
    kept: dict[str, dict[str, Any]] = {}
    if only != "*" and RESULTS.exists():
        with RESULTS.open(newline="") as file:
            kept = {row["name"]: row for row in csv.DictReader(file)}
    for name, kind, law, scene in ROWS:
        if fnmatchcase(name, only):
            start = time.perf_counter()
            kept[name] = {"name": name, **row(kind, law, scene)}
            print(f"{time.perf_counter() - start:6.1f} s", *list(kept[name].values())[:6], flush=True)
    with RESULTS.open("w", newline="") as file:
        out = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        out.writeheader()
        out.writerows(kept[name] for name, *_ in ROWS if name in kept)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", default="*")
    main(parser.parse_args().only)
