"""Studies whose every number is pinned: groups of scenes, laws and methods, each a study as a user writes it.

``tests/reference/make_golden.py`` writes what they give to golden.csv and golden_curves.csv beside this file, and the
tests of ``tests/golden`` compare. Only ``frictionlab.run`` and the names of the study file are used, so that moving
modules changes nothing here. The laws of plugins/ must be installed or their folders open (conftest.py at the root).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

import frictionlab as fl

NOT_PINNED = ("seconds",)
"""Columns of the result table that no two runs share."""


@dataclass(frozen=True)
class Group:
    """A study by its name; deep: of the deep profile alone, for its kernels are slow to compile or run."""

    name: str
    study: dict[str, Any]
    deep: bool = False

    @property
    def family(self) -> str:
        """What its laws remember, and the dimension: kernels are compiled for both."""
        kinds = {law["kind"] for law in self.study["laws"]}
        memory = next((MEMORIES[kind] for kind in MEMORIES if kind in kinds), "nothing")
        return f"{memory}, {'plane' if 'transverse' in str(self.study['scene']) else 'line'}"


MEMORIES = {
    "maxwell-slip": "elements",
    "rate-and-state": "ages",
    **dict.fromkeys(("dahl", "lugre", "dupont", "elasto-plastic", "jenkins"), "bristles"),
}
"""What laws remember; those that are not here remember nothing."""


def _group(
    name: str,
    scene: dict[str, Any],
    laws: list[dict[str, Any]],
    methods: list[Any],
    sweep: dict[str, Any] | None = None,
    **more: Any,
) -> Group:
    """A group; more: tolerance, deep."""
    tolerance, deep = more.pop("tolerance", 1e-8), more.pop("deep", False)
    study = {"schema": 1, "scene": scene, "laws": laws, "methods": methods, "tolerance": tolerance, **more}
    return Group(name, study | ({"sweep": sweep} if sweep else {}), deep)


def _speeds(*speeds: float) -> dict[str, Any]:
    return {"scene.belt_speed": list(speeds)}


COULOMB = {"kind": "coulomb", "mu": 0.4}
STICKY = {"kind": "coulomb", "mu": 0.4, "mu_static": 0.6, "label": "more at rest"}
MILD = {"kind": "stribeck", "mu_kinetic": 0.3, "mu_static": 0.4, "stribeck_speed": 8.0}
STEEP = {
    "kind": "stribeck",
    "mu_kinetic": 0.2,
    "mu_static": 0.4,
    "stribeck_speed": 1.0,
    "stribeck_exponent": 1.0,
}
CURVES = [
    {**MILD, "label": "exponential"},
    {**MILD, "viscosity": 0.003, "stribeck_exponent": 1.0, "label": "viscous"},
    {**MILD, "curve": "hyperbolic", "label": "hyperbolic"},
    {**MILD, "curve": "hess-soom", "label": "hess-soom"},
    {**MILD, "curve": "cubic", "label": "cubic"},
]
LEINE = {
    "kind": "stribeck",
    "curve": "hyperbolic",
    "mu_static": 1.0,
    "mu_kinetic": 0.0,
    "stribeck_speed": 1.0 / 3.0,
}
DAHL = {"kind": "dahl", "mu": 0.4, "presliding_length": 1.0}
DAHLS = [
    DAHL,
    {"kind": "dahl", "mu": 0.4, "stiffness": 40.0, "label": "stiff"},
    {"kind": "dahl", "mu": 0.4, "exponent": 0.5, "presliding_length": 1.0, "label": "exponent 0.5"},
    {"kind": "dahl", "mu": 0.4, "exponent": 2.0, "presliding_length": 1.0, "label": "exponent 2"},
    {"kind": "dahl", "mu": 0.4, "exponent": 0.0, "presliding_length": 1.0, "label": "exponent 0"},
]
LUGRE = {"kind": "lugre", "mu_kinetic": 0.4, "presliding_length": 1.0, "damping": 0.01}
FALLING = {
    "kind": "lugre", "mu_kinetic": 0.25, "mu_static": 0.4, "stribeck_speed": 10.0, "viscosity": 0.001,
    "presliding_length": 0.1, "contact_damping": 0.05, "label": "falling",
}  # fmt: skip
DUPONT = {"kind": "dupont", "mu_kinetic": 0.4, "presliding_length": 1.0}
ELASTO = {
    "kind": "elasto-plastic", "mu_kinetic": 0.4, "breakaway_ratio": 0.4, "contact_stiffness": 15.0, "damping": 0.001,
}  # fmt: skip
JENKINS = {"kind": "jenkins", "mu": 0.4, "presliding_length": 1.0}
BRISTLES = [DAHL, LUGRE, FALLING, DUPONT, ELASTO, JENKINS]
MAXWELL = {"kind": "maxwell-slip", "mu": [0.2, 0.15, 0.05], "stiffness": [1.0, 3.0, 10.0]}
ONE_ELEMENT = {"kind": "maxwell-slip", "mu": [0.4], "stiffness": [4.0], "label": "one element"}
AGEING = {
    "kind": "rate-and-state",
    "mu": 0.6,
    "a": 0.01,
    "b": 0.015,
    "slip_length": 1000.0,
    "label": "ageing",
}
RUINA = {**AGEING, "state_law": "slip", "label": "slip"}

SLIP = {"belt_speed": 5.0, "slip": {"velocity_amplitude": 10.0, "frequency": 1.5, "phase": 30.0}}
ELLIPSE = {**SLIP, "transverse_slip": {"velocity_amplitude": 7.0, "phase": 110.0}}
CIRCLE = {
    "belt_speed": 5.0,
    "slip": {"velocity_amplitude": 10.0, "frequency": 1.0},
    "transverse_slip": {"velocity_amplitude": 10.0, "phase": 90.0},
}
ACROSS = {"belt_speed": 5.0, "transverse_slip": {"velocity_amplitude": 10.0, "frequency": 1.5}}

W1 = {
    "damping_ratio": 0.1,
    "normal_load": 10.0,
    "belt_speed": 5.0,
    "drive": {"unbalance": 10.0, "frequency": 1.0},
}
W2 = {
    "damping_ratio": 0.1,
    "normal_load": 1.0,
    "belt_speed": 5.0,
    "drive": {"unbalance": 10.0, "frequency": 4.0},
}
W5 = {
    "damping_ratio": 0.1,
    "normal_load": 10.0,
    "belt_speed": 0.5,
    "drive": {"amplitude": 2.5, "frequency": 0.5},
}
W3 = {**W2, "transverse": {"natural_frequency": 4.0, "damping_ratio": 0.1, "load": {"unbalance": 10.0}}}
W3_SOFT = {
    **W2,
    "drive": {"amplitude": 120.0, "frequency": 4.0, "phase": 40.0},
    "transverse": {
        "natural_frequency": 0.5,
        "damping_ratio": 0.2,
        "load": {"amplitude": 90.0, "phase": -25.0},
    },
}
PLANE = {
    "damping_ratio": 0.1,
    "normal_load": 4.0,
    "belt_speed": 2.0,
    "drive": {"amplitude": 10.0, "frequency": 1.3, "phase": 30.0},
    "transverse": {
        "natural_frequency": 2.1,
        "damping_ratio": 0.05,
        "load": {"amplitude": 8.0, "phase": 100.0},
    },
}
NO_LOAD_ACROSS = {**W1, "transverse": {"natural_frequency": 2.0, "damping_ratio": 0.1}}
HEAVY = {
    "damping_ratio": 0.4, "normal_load": 10.0, "belt_speed": 5.0, "drive": {"unbalance": 10.0, "frequency": 1.5},
}  # fmt: skip
BLOCK = {"damping_ratio": 0.0, "normal_load": 1.0, "belt_speed": 0.2}
DIMENSIONAL = {
    "dimensional": {
        "mass_kg": 3000.0,
        "stiffness_N_per_m": 3.84e7,
        "damping_N_s_per_m": 2.0e4,
        "length_m": 1.0e-3,
        "belt_speed_m_per_s": 0.05,
        "drive": {"unbalance_kg_m": 1.0, "frequency_rad_per_s": 125.66},
        "transverse": {
            "stiffness_N_per_m": 4.7e7, "damping_N_s_per_m": 2.0e4, "load": {"unbalance_kg_m": 1.0, "phase": 90.0},
        },
    }
}  # fmt: skip

MOREAU = {"kind": "march", "steps": 200, "label": "moreau"}
IMPLICIT = {"kind": "march", "stepper": "moreau", "theta": 1.0, "steps": 200, "label": "moreau, theta 1"}
RK4 = {"kind": "march", "stepper": "rk4", "steps": 200, "label": "rk4"}
TANH = {"kind": "march", "stepper": "smoothed", "width": 1.0, "label": "tanh"}
ARCTAN = {"kind": "march", "stepper": "smoothed", "width": 1.0, "smoothing": "arctan", "label": "arctan"}
SDIRK2 = {"kind": "march", "stepper": "sdirk2", "steps": 256, "label": "sdirk2"}
BRISTLE_RK4 = {"kind": "march", "stepper": "rk4", "steps": 512, "label": "rk4"}
EVERY = ["auto", "exact", "shooting", "mdsm", "harmonic_balance"]


def _prescribed() -> Iterator[Group]:
    """No degree of freedom."""
    yield _group("slip along, every method", SLIP, [COULOMB], EVERY, _speeds(0, 2, -9.9, 12),
                 deep=True)  # fmt: skip
    yield _group("slip along, more at rest", SLIP, [STICKY], ["auto", "mdsm"], _speeds(0, 3))
    yield _group("slip along, curves", SLIP, CURVES, ["auto"], _speeds(2, 10, 15))
    yield _group("slip along, curves by other methods", SLIP, CURVES[:1], ["mdsm", "exact"], _speeds(3))
    yield _group("slip on an ellipse", ELLIPSE, [COULOMB, MILD], ["auto", "mdsm", "exact"], _speeds(0, 4, 20))
    yield _group("slip on a circle", CIRCLE, [COULOMB], ["auto", "mdsm"], _speeds(1, 10), deep=True)
    yield _group("slip across", ACROSS, [COULOMB, STICKY, MILD], ["auto", "mdsm"], _speeds(0, 6))
    yield _group("no slip at all", {"belt_speed": 1.0, "slip": {"velocity_amplitude": 0.0, "frequency": 1.0}},
                 [COULOMB, DAHL], ["auto", "mdsm"], _speeds(0, 1))  # fmt: skip
    yield _group("slip along on bristles", SLIP, BRISTLES, ["auto"], _speeds(0, 4, 9.5, 12), tolerance=1e-9)
    yield _group("slip along, Dahl exponents", SLIP, DAHLS[1:], ["auto"], _speeds(3, 9), tolerance=1e-7)
    yield _group("slip along on bristles, methods", SLIP, [DAHL, DUPONT], ["exact", "shooting", "mdsm",
                 "harmonic_balance"], _speeds(4), tolerance=1e-6,
                 deep=True)  # fmt: skip
    yield _group("slip on an ellipse on bristles", ELLIPSE, [DAHL, DUPONT, JENKINS], ["auto"], _speeds(4, 11),
                 tolerance=1e-6)  # fmt: skip
    yield _group("slip on an ellipse, LuGre", ELLIPSE, [LUGRE, FALLING], ["auto"], _speeds(4, 11),
                 tolerance=1e-6, deep=True)  # fmt: skip
    yield _group("slip across, planar forms", ACROSS, [{**DAHL, "planar": planar, "label": planar} for planar in
                 ("vectorial", "per-axis")], ["auto"], _speeds(3, 12), tolerance=1e-6)  # fmt: skip
    yield _group("slip along on elements", SLIP, [MAXWELL, ONE_ELEMENT], ["auto"], _speeds(2, 9),
                 tolerance=1e-7, deep=True)  # fmt: skip
    yield _group("slip along on ageing contacts", {"belt_speed": 10.0, "slip": {"velocity_amplitude": 5.0,
                 "frequency": 1.0}}, [AGEING, RUINA], ["auto"], _speeds(6, 20), tolerance=1e-6)  # fmt: skip


def _line() -> Iterator[Group]:
    """One degree of freedom, no memory."""
    every = [*EVERY, MOREAU, RK4]
    yield _group("W1", W1, [COULOMB], every, _speeds(0, 0.5, 20, 49.9, 55, -7))
    yield _group("W1, a curve", W1, [COULOMB], ["auto", "shooting", "mdsm", "harmonic_balance"], {
                 "scene.belt_speed": {"start": 5, "stop": 60, "num": 8}})  # fmt: skip
    yield _group("W2", W2, [COULOMB], ["exact", "shooting"], _speeds(0, 1, 30, 60), tolerance=1e-10)
    yield _group("W5", W5, [COULOMB], [*EVERY, MOREAU], _speeds(0, 0.05, 0.5, 2.4))
    yield _group("loads that friction holds", {**W5, "normal_load": 20.0}, [COULOMB, STICKY],
                 ["auto", "shooting", MOREAU], _speeds(0, 0.3))  # fmt: skip
    yield _group("loads that friction holds, from a start", {**W5, "initial": {"x": 1.0}}, [COULOMB],
                 ["auto", "shooting", MOREAU], _speeds(0, 0.3))  # fmt: skip
    yield _group("tolerances of shooting, loose", W1, [COULOMB], ["shooting", "mdsm"], _speeds(3, 33),
                 tolerance=1e-4)  # fmt: skip
    yield _group("tolerances of shooting, tight", W1, [COULOMB, MILD], ["shooting"], _speeds(3, 33),
                 tolerance=1e-10)  # fmt: skip
    yield _group("march of its own accord", W1, [COULOMB], [{"kind": "march", "label": "march"}], _speeds(2, 40),
                 tolerance=1e-3)  # fmt: skip
    yield _group("march smoothed", W1, [COULOMB], [TANH, ARCTAN, IMPLICIT], _speeds(10), tolerance=1e-2)
    yield _group("march, few periods", {**W1, "damping_ratio": 0.001}, [COULOMB],
                 [{"kind": "march", "steps": 50, "periods": 5, "label": "few periods"}], _speeds(45))  # fmt: skip
    yield _group(
        "undamped resonance", {**W1, "damping_ratio": 0.0}, [COULOMB], [*EVERY, MOREAU], _speeds(0, 5)
    )
    yield _group("undamped resonance without bound", {**W1, "damping_ratio": 0.0, "normal_load": 1.0}, [COULOMB],
                 ["auto", "exact", "shooting", "mdsm"], _speeds(5))  # fmt: skip
    yield _group("drives", W1, [COULOMB], ["auto"], {"scene.drive.frequency": [0.05, 0.5, 1.5, 10.0]})
    yield _group("a phase of the drive", {**W1, "drive": {"amplitude": 8.0, "frequency": 0.7, "phase": 75.0}},
                 [COULOMB, MILD], ["auto", "shooting"], _speeds(4))  # fmt: skip
    yield _group("more at rest", W1, [STICKY], [*EVERY, MOREAU, RK4], _speeds(0.5, 20), tolerance=1e-7)
    yield _group("curves of Stribeck", W1, CURVES, ["auto"], _speeds(0, 4, 30, 60))
    yield _group("curves of Stribeck by other methods", W1, CURVES[:2], ["exact", "mdsm", "harmonic_balance",
                 MOREAU, RK4], _speeds(20))  # fmt: skip
    yield _group("a steep fall", {"damping_ratio": 0.01, "normal_load": 10.0, "belt_speed": 0.3,
                 "drive": {"unbalance": 0.2, "frequency": 1.3}}, [STEEP], ["auto", "shooting"],
                 _speeds(0.3))  # fmt: skip


def _undriven() -> Iterator[Group]:
    """Nothing shakes the mass."""
    methods = [*EVERY, MOREAU]
    yield _group("Leine's block", BLOCK, [LEINE], methods, tolerance=1e-8)
    yield _group("stick-slip by two levels", {**BLOCK, "damping_ratio": 0.05}, [STICKY, COULOMB], methods,
                 _speeds(0.1))  # fmt: skip
    yield _group(
        "undriven, at rest", {**BLOCK, "damping_ratio": 0.1}, [COULOMB, MILD], ["auto", MOREAU], _speeds(0)
    )
    yield _group("undriven, from a start", {**BLOCK, "damping_ratio": 0.1, "initial": {"x": 3.0, "velocity": 0.0}},
                 [COULOMB, MILD], ["auto", "shooting", MOREAU], _speeds(0, 0.2))  # fmt: skip
    yield _group("undriven plane", {**BLOCK, "damping_ratio": 0.1, "transverse": {"natural_frequency": 2.0,
                 "damping_ratio": 0.1}}, [COULOMB, MILD], ["auto", "mdsm", MOREAU], _speeds(0.2))  # fmt: skip
    yield _group("undriven, pushed across", {**BLOCK, "damping_ratio": 0.1, "transverse": {"natural_frequency":
                 2.0, "damping_ratio": 0.1}, "initial": {"x2": 1.0}}, [COULOMB], ["auto", MOREAU],
                 _speeds(0.2))  # fmt: skip
    yield _group("undriven on bristles", {**BLOCK, "damping_ratio": 0.1}, [DAHL, LUGRE, DUPONT], ["auto",
                 BRISTLE_RK4], _speeds(0.2), tolerance=1e-3)  # fmt: skip


def _plane() -> Iterator[Group]:
    """Two degrees of freedom, no memory."""
    yield _group("W3", W3, [COULOMB], [*EVERY, MOREAU, RK4], _speeds(0.5, 25, 60), deep=True)
    yield _group("W3, a curve", W3, [COULOMB], ["auto"], {"scene.belt_speed": {"start": 5, "stop": 60, "num": 6}},
                 tolerance=1e-6)  # fmt: skip
    yield _group("W3 at rest", W3, [COULOMB], ["auto", "mdsm", MOREAU], _speeds(0))
    yield _group(
        "W3 soft across", W3_SOFT, [COULOMB, MILD], ["auto", "mdsm"], _speeds(-4, 40), tolerance=1e-9
    )
    yield _group(
        "loads of two phases", PLANE, [COULOMB, MILD], ["auto", MOREAU], _speeds(0.7, 6), tolerance=1e-7
    )
    yield _group("loads that friction holds in the plane", {**PLANE, "normal_load": 60.0}, [COULOMB],
                 ["auto", "mdsm", MOREAU], _speeds(0, 1), tolerance=1e-6)  # fmt: skip
    yield _group("no load across", NO_LOAD_ACROSS, [COULOMB, STICKY], ["auto", "exact", "mdsm", "harmonic_balance"],
                 _speeds(8))  # fmt: skip
    yield _group("more at rest in the plane", PLANE, [STICKY], [*EVERY, MOREAU], _speeds(2), tolerance=1e-6)
    yield _group("SI units", DIMENSIONAL, [COULOMB, {**MILD, "stribeck_speed": 0.1}], ["auto", "mdsm"],
                 {"scene.dimensional.belt_speed_m_per_s": [0.01, 0.1, 0.5]})  # fmt: skip


def _bristles() -> Iterator[Group]:
    """Bodies on bristles."""
    yield _group("W1 on bristles", W1, [DAHL, LUGRE, DUPONT, JENKINS], ["auto"], _speeds(0, 5, 30, 55),
                 tolerance=1e-6)  # fmt: skip
    yield _group("W1 on a falling curve", W1, [FALLING, ELASTO], ["auto"], _speeds(5, 45), tolerance=1e-8)
    yield _group("W1 on Dahl's, one harmonic", W1, [DAHL, JENKINS], ["harmonic_balance", "exact", "mdsm"],
                 _speeds(20), tolerance=1e-6)  # fmt: skip
    yield _group("W1 on others, one harmonic", W1, [LUGRE, DUPONT], ["harmonic_balance"], _speeds(20),
                 tolerance=1e-6)  # fmt: skip
    yield _group("W1 on Dahl's exponents", W1, DAHLS[1:4], ["auto"], _speeds(20), tolerance=1e-6)
    yield _group("W1 on bristles, marched", W1, [DAHL, LUGRE, DUPONT], [SDIRK2, BRISTLE_RK4],
                 _speeds(20), tolerance=1e-3, deep=True)  # fmt: skip
    yield _group("W1 on Jenkins's, marched", W1, [JENKINS], [SDIRK2, BRISTLE_RK4, MOREAU],
                 _speeds(20), tolerance=1e-3)  # fmt: skip
    yield _group("bristles too stiff for a stepper", W1, [{**DAHL, "presliding_length": 1e-6}], [BRISTLE_RK4],
                 _speeds(20), tolerance=1e-3)  # fmt: skip
    yield _group("two states on Dahl's", {"damping_ratio": 0.0348, "normal_load": 505.75868775, "belt_speed": 40.5,
                 "drive": {"unbalance": 10.0, "frequency": 3.567}}, [{"kind": "dahl", "mu": 0.4,
                 "contact_stiffness": 30.0}], ["auto"], _speeds(35, 40.5), tolerance=1e-6)  # fmt: skip
    yield _group("the plane on Dupont's", W3, [DUPONT], ["auto"], _speeds(5, 30), tolerance=1e-5,
                 deep=True)  # fmt: skip
    yield _group("the plane by axis", PLANE, [{**DAHL, "presliding_length": 0.3, "planar": "per-axis"}],
                 ["auto", "exact"], _speeds(0.7, 4), tolerance=1e-6)  # fmt: skip
    yield _group("the plane by axis, held", {**PLANE, "transverse": {**PLANE["transverse"], "load":
                 {"amplitude": 0.5}}}, [{**JENKINS, "presliding_length": 2.0, "planar": "per-axis"}], ["auto"],
                 _speeds(2), tolerance=1e-6)  # fmt: skip
    yield _group("no vector form", PLANE, [DAHLS[3]], ["auto", BRISTLE_RK4], _speeds(4))
    yield _group("no load across on Dahl's", NO_LOAD_ACROSS, [DAHL], ["auto"], _speeds(8), tolerance=1e-6)
    yield _group("the plane on others", W3, [DAHL, LUGRE, FALLING, JENKINS], ["auto"], _speeds(5, 30),
                 tolerance=1e-5, deep=True)  # fmt: skip


def _memory() -> Iterator[Group]:
    """Bodies on the laws of plugins/."""
    yield _group("on elements", HEAVY, [MAXWELL, ONE_ELEMENT], ["auto", "exact", "mdsm"], _speeds(1, 8),
                 tolerance=1e-6, deep=True)  # fmt: skip
    yield _group("on elements, marched", HEAVY, [ONE_ELEMENT], [{"kind": "march", "steps": 4096, "label": "rk4"},
                 SDIRK2], _speeds(5), tolerance=1e-2, deep=True)  # fmt: skip
    across = {"transverse": {"natural_frequency": 2.0, "damping_ratio": 0.4, "load": {"amplitude": 8.0}}}
    yield _group("on elements in the plane", {**HEAVY, **across}, [MAXWELL], ["auto"], _speeds(5),
                 tolerance=1e-5, deep=True)  # fmt: skip
    yield _group("on ageing contacts", {**HEAVY, "belt_speed": 20.0}, [{**AGEING, "slip_length": 2.0}], ["auto"],
                 _speeds(20), tolerance=1e-6, deep=True)  # fmt: skip


GROUPS: tuple[Group, ...] = (
    *_prescribed(), *_line(), *_undriven(), *_plane(), *_bristles(), *_memory(),
)  # fmt: skip


Rows = dict[str, dict[str, Any]]
"""Cells by column, by the key of the row; no cell that is empty."""


@cache
def solved(name: str) -> tuple[Rows, Rows]:
    """The rows of a group's result table and of its curves, each under its key."""
    (group,) = (group for group in GROUPS if group.name == name)
    done = fl.run(group.study, columns="all")
    swept = [_column(path) for path in group.study.get("sweep", {})]
    return _rows(done.table, name, swept), _rows(done.curves, name, swept)


def _column(path: str) -> str:
    return path if path.startswith("scene.") else f"law.{path.rpartition('.')[2]}"


def _rows(table: Any, name: str, swept: list[str]) -> Rows:
    """Each record under group/law/method/column=value, without its empty cells."""
    rows: Rows = {}
    for record in table.to_dict("records"):
        cells = {key: value for key, value in record.items() if _told(value) and key not in NOT_PINNED}
        along = [f"{path.rpartition('.')[2]}={cells[path]:g}" for path in swept if path in cells]
        key = "/".join([name, cells["law"], cells["method"], *along])
        assert key not in rows, f"{key} is there twice"
        rows[key] = cells
    return rows


def _told(value: Any) -> bool:
    return value is not None and value == value and value != ""
