"""Scenes whose mean friction is known from elsewhere: ``reference/truth.csv``, and curves in files of their own.

Rows named ``curve/point`` are one curve: one scene at several belt speeds. ``reference/README.md`` tells the columns.
"""

from __future__ import annotations

import csv
import json
import re
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from memory_laws import BrokenAway, Elements

from frictionlab.study import registry

FOLDER = Path(__file__).parent
REFERENCE = FOLDER / "reference"
OF_TESTS = {"elements": Elements, "broken away": BrokenAway}
"""Laws that the tests alone know."""
COULOMB = {"kind": "coulomb", "mu": 0.4}
PAPER = {"damping_ratio": 0.1, "normal_load": 10.0, "drive": {"unbalance": 10.0, "frequency": 1.0}}
W4 = {"a": 5e-2, "b": 5e-4, "c": 5e-2, "d": 5e-4, "_0.5": 0.5, "_5e-06": 5e-6}
"""Presliding lengths of bench curves; c and d are Dahl's."""
MODELS = ("harmonic_balance", "mdsm")
Curve = list["Row"]


class Row(NamedTuple):
    """A scene and a law as keys of a study, its mean and other columns, and how well each is known.

    mean: NaN where the start decides. tolerances: asked of methods, the largest first. default: methods that the
    default run asks.
    """

    scene: dict[str, Any]
    law: dict[str, Any]
    mean: float
    accuracy: float
    tolerances: tuple[float, ...]
    also: dict[str, tuple[float, float]] = {}  # noqa: RUF012  # never changed
    default: tuple[str, ...] = ()


def law_of(keys: dict[str, Any], normal_load: float | None = None) -> Any:
    """Return the law that keys of a study tell, under a normal load where they need one."""
    kind = OF_TESTS.get(keys["kind"]) or registry.law_class(keys["kind"])
    per_load = {"contact_damping", "contact_stiffness"} & {*keys}
    law = kind(**{name: value for name, value in keys.items() if name != "kind"})
    return law.under_load(normal_load) if per_load else law


@cache
def table(name: str) -> list[dict[str, str]]:
    """Return the rows of a file."""
    with (FOLDER / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def _numbers(words: str) -> tuple[float, ...]:
    return tuple(map(float, words.split()))


def _told(row: dict[str, str]) -> Row:
    scene, law, also = (json.loads(row[name]) for name in ("scene", "law", "also"))
    mean, accuracy = float(row["mean_friction"] or "nan"), float(row["accuracy"])
    return Row(scene, law, mean, accuracy, _numbers(row["tolerances"]), also, tuple(row["default"].split()))


def _figures(folder: Path = REFERENCE) -> dict[str, Curve]:
    """Return the curves of the paper, on the line and in the plane."""
    found = {}
    for path in sorted(folder.glob("*_fig*_Om*.csv")):
        numbers = [float(each) for each in re.findall(r"(?<=Om|_g|wr)[\d.]+(?=_|\.csv)", path.name)]
        scene = PAPER | {"normal_load": numbers[1], "drive": {"unbalance": 10.0, "frequency": numbers[0]}}
        read, rows = (
            (_in_the_plane if len(numbers) > 2 else _on_the_line),
            table(f"reference/{path.name}")[1:],
        )
        if len(numbers) > 2:
            across = {"natural_frequency": numbers[2], "damping_ratio": 0.1, "load": {"unbalance": 10.0}}
            scene |= {"transverse": across}
        values = [{name: float(value or "nan") for name, value in row.items()} for row in rows]
        most = max(
            each["E_visc"] + each.get("E_fric_on_mass", each.get("E_fric_corrected_eq7")) for each in values
        )
        found[path.stem] = [read(scene | {"belt_speed": each["v_b"]}, each, most) for each in values]
    return found


def _on_the_line(scene: dict[str, Any], known: dict[str, float], most: float) -> Row:
    energy = 2e-11 * most
    also = {
        "velocity_amplitude": (0.5 * (known["xdot_max"] - known["xdot_min"]), 2e-9),
        "velocity_harmonic": (known["V_first_harmonic"], 2e-9),
        "velocity_phase": (known["phase_first_harmonic_vs_load_deg"], 2e-9),
        "energy_input": (known["E_input"], energy),
        "energy_viscous": (known["E_visc"], energy),
        "energy_friction": (known["E_fric_corrected_eq7"], energy),
        "energy_contact": (known["heat_in_contact"], energy),
        "stick_fraction": (known["stick_fraction"], 1e-8),
    }
    return Row(
        scene,
        COULOMB,
        known["mu_bar_exact"],
        1e-11,
        (3e-4, 1e-9, 1e-11),
        also,
        ("exact", "shooting", *MODELS),
    )


def _in_the_plane(scene: dict[str, Any], known: dict[str, float], most: float) -> Row:
    energy, taken = 1e-9 * most, known["E_visc"] + known["E_fric_on_mass"]
    also = {
        "mean_friction_transverse": (known["mu2_bar"], 1e-9),
        "velocity_harmonic": (known["V1"], 1e-8),
        "velocity_phase": (known["phase_x1dot_vs_load_deg"], 1e-8),
        "transverse_velocity_harmonic": (known["V2"], 1e-8),
        "transverse_velocity_phase": (known["phase_x2dot_vs_load_deg"], 1e-8),
        "energy_viscous": (known["E_visc"], energy),
        "energy_friction": (known["E_fric_on_mass"], energy),
        "energy_contact": (known["heat"], energy),
        "energy_input": (taken, energy),
        "stick_fraction": (known["stick_frac"], 0.0),
        # a difference quotient, which blurs where the slip nearly stops
        "floquet": (known["max_abs_floquet_multiplier"], 1e-6 if known["min_vrel"] > 0.002 else 1e-4),
    }
    tolerances = (1e-4, 1e-6, 1e-8, 1e-10)  # collocation confirms the reference to 6e-12
    return Row(scene, COULOMB, known["mu_bar_dop853"], 5e-11, tolerances, also, ("shooting", "mdsm"))


def _of_the_bench() -> dict[str, Curve]:
    """Return curves of bristles by collocation, known to 1e-12."""
    found = {}
    for name, length in W4.items():
        law: dict[str, Any] = {
            "kind": "lugre",
            "mu_kinetic": 0.4,
            "damping": 4e-4,
            "presliding_length": length,
        }
        if name in "cd":
            law = {"kind": "dahl", "mu": 0.4, "presliding_length": length}
        default = ("shooting",) if name in ("a", "_0.5") else ()
        found[f"bench W4{name}"] = [
            Row(
                PAPER | {"belt_speed": float(row["belt_speed"])}, law, float(row["mean_friction"]), 1e-12,
                (1e-5, 1e-6, 1e-7), {}, default,
            )
            for row in table(f"benchmarks/bristle_W4{name}.csv")
        ]  # fmt: skip
    return found


def _moved() -> dict[str, Curve]:
    """Return curves of contacts that are moved along the belt, by presliding length."""
    known: dict[str, tuple[float, tuple[str, ...], dict[str, Any]]] = {
        "dahl_exact": (5e-9, ("exact", "shooting"), {"kind": "dahl", "mu": 1.0}),
        "dahl_numeric": (5e-9, (), {"kind": "dahl", "mu": 1.0}),
        "lugre_numeric_sig0p1": (5e-9, (), {"kind": "lugre", "mu_kinetic": 1.0}),
        "dupont_rba0p7_numeric": (1e-6, (), {"kind": "elasto-plastic", "mu_kinetic": 1.0}),
    }
    found: dict[str, Curve] = {}
    for row in table("reference/rigid_kinematics.csv"):
        for column, (accuracy, default, law) in known.items():
            length = float(row["lam"])
            damped = {"damping": 0.1 / length} if law["kind"] == "lugre" else {}
            scene = {"belt_speed": float(row["kappa"]), "slip": {"velocity_amplitude": 1.0, "frequency": 1.0}}
            law = law | {"presliding_length": length} | damped
            if row[column]:
                one = Row(scene, law, float(row[column]), accuracy, (1e-8,), {}, default)
                found.setdefault(f"rigid {column} {row['lam']}", []).append(one)
    return found


ROWS = {row["name"]: _told(row) for row in table("reference/truth.csv")}
"""By name."""


def curves() -> dict[str, Curve]:
    """Return every curve by its name; most have one point."""
    found: dict[str, Curve] = {}
    for name, row in ROWS.items():
        found.setdefault(name.rpartition("/")[0] or name, []).append(row)
    return found | _figures() | _of_the_bench() | _moved()
