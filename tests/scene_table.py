"""Which method takes which scene with which law, asked of the methods themselves: python tests/scene_table.py.

Writes the tables of docs/which.md between their marks.
"""

from __future__ import annotations

import sys
from functools import cache
from pathlib import Path
from typing import Any

from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.scene import Scene
from frictionlab.study import registry

PROJECT = Path(__file__).parents[1]
PAGE = PROJECT / "docs" / "which.md"
BEGIN, END = "<!-- made by tests/scene_table.py -->\n", "<!-- end -->\n"
METHODS = ("auto", "exact", "shooting", "march", "mdsm", "harmonic_balance")

LAWS: dict[str, dict[str, Any]] = {
    "coulomb": {"mu": 0.4},
    "stribeck": {"mu_kinetic": 0.3, "mu_static": 0.5, "stribeck_speed": 0.5},
    "dahl": {"mu": 0.4, "presliding_length": 0.1},
    "jenkins": {"mu": 0.4, "presliding_length": 0.1},
    "lugre": {"mu_kinetic": 0.3, "mu_static": 0.5, "presliding_length": 0.1, "damping": 0.1},
    "elasto-plastic": {"mu_kinetic": 0.4, "presliding_length": 0.1},
    "maxwell-slip": {"mu": [0.3, 0.1], "stiffness": [3.0, 2.0]},
    "rate-and-state": {"mu": 0.4, "a": 0.01, "b": 0.005, "slip_length": 0.1, "reference_speed": 1.0},
}
"""One law of each family: without memory, of one bristle, of several deflections, of a scalar."""

LINE: dict[str, Any] = {"damping_ratio": 0.1, "normal_load": 1, "belt_speed": 0.5}
DRIVE = {"amplitude": 1, "frequency": 2}
PLANE = LINE | {"drive": DRIVE, "transverse": {"natural_frequency": 1.5, "damping_ratio": 0.1}}
LOADED = {"natural_frequency": 1.5, "damping_ratio": 0.1, "load": {"amplitude": 1}}
FASTER = {"amplitude": 1, "frequency_ratio": "3/2"}
SLIP = {"velocity_amplitude": 1, "frequency": 1}
LOAD = {"amplitude": 0.3, "phase": 90}

SCENES: dict[str, dict[str, Any]] = {
    "along the belt: a sine": LINE | {"drive": DRIVE},
    "a square wave, triangle or sawtooth": LINE | {"drive": DRIVE | {"waveform": "square"}},
    "a sum of harmonics": LINE
    | {"drive": DRIVE | {"waveform": {"harmonics": [{"order": o, "amplitude": 1 / o} for o in (1, 3)]}}},
    "the belt vibrates, too": LINE | {"drive": DRIVE, "belt_vibration": {"velocity_amplitude": 1}},
    "the belt alone vibrates": LINE | {"belt_vibration": {"velocity_amplitude": 1, "frequency": 2}},
    "normal load varies": LINE | {"drive": DRIVE, "normal_load_variation": LOAD},
    "normal load varies, constant contact": LINE
    | {"drive": DRIVE, "normal_load_variation": LOAD | {"contact": "constant"}},
    "nothing shakes it": LINE,
    "in the plane: a sine along the belt": PLANE,
    "in the plane: sines along and across": PLANE | {"transverse": LOADED},
    "in the plane: a sine at an angle": PLANE | {"drive": DRIVE | {"direction": 30}},
    "in the plane: a square wave at an angle": PLANE
    | {"drive": DRIVE | {"direction": 30, "waveform": "square"}},
    "in the plane: across at 3/2 of the frequency": PLANE | {"transverse": LOADED | {"load": FASTER}},
    "in the plane: the belt vibrates at an angle": PLANE
    | {"belt_vibration": {"velocity_amplitude": 1, "direction": 60}},
    "in the plane, normal load varies": PLANE | {"normal_load_variation": LOAD},
    "in the plane, constant contact": PLANE | {"normal_load_variation": LOAD | {"contact": "constant"}},
    "in the plane, nothing shakes it": LINE | {"transverse": PLANE["transverse"]},
    "prescribed slip: a sine": {"belt_speed": 0.5, "slip": SLIP},
    "slip of another waveform": {"belt_speed": 0.5, "slip": SLIP | {"waveform": "triangle"}},
    "slip at an angle": {"belt_speed": 0.5, "slip": SLIP | {"direction": 30}},
    "slip along and across": {"belt_speed": 0.5, "slip": SLIP, "transverse_slip": {"velocity_amplitude": 1}},
    "slip, normal load varies": {"belt_speed": 0.5, "slip": SLIP, "normal_load_variation": LOAD},
    "slip, constant contact": {
        "belt_speed": 0.5,
        "slip": SLIP,
        "normal_load_variation": LOAD | {"contact": "constant"},
    },
}
"""One scene of each kind."""


@cache
def law_of(name: str) -> FrictionLaw:
    """The law of this family."""
    law: FrictionLaw = registry.law_class(name)(**LAWS[name])
    return law


def refusal(method: str, scene: str, law: str) -> str | None:
    """Why the method refuses the scene with the law; None where it takes it."""
    return registry.method_class(method)().refusal(Scene(**SCENES[scene]), law_of(law))


def tables() -> str:
    """Scenes, alike ones in a row, by methods, with the laws that are taken; below, reasons of refusals by number."""
    reasons: dict[str, int] = {}
    alike: dict[str, list[str]] = {}
    for scene in SCENES:
        alike.setdefault(" | ".join(_cell(each, scene, reasons) for each in METHODS), []).append(scene)
    rows = [f"| {'; '.join(scenes)} | {cells} |" for cells, scenes in alike.items()]
    head = [
        "| scene | " + " | ".join(f"`{name}`" for name in METHODS) + " |",
        "|---" * (len(METHODS) + 1) + "|",
    ]
    told = [f"{number}. {reason}" for reason, number in reasons.items()]
    return "\n".join([*head, *rows, "", "Refused because:", "", *told]) + "\n"


def _cell(method: str, scene: str, reasons: dict[str, int]) -> str:
    found = {law: _without_advice(method, refusal(method, scene, law)) for law in LAWS}
    taken = [law for law, reason in found.items() if reason is None]
    against = dict.fromkeys(reason for reason in found.values() if reason is not None)
    numbers = ", ".join(str(reasons.setdefault(reason, len(reasons) + 1)) for reason in against)
    if not against:
        return "all"
    if not taken:
        return f"- ({numbers})"
    left = [law for law in LAWS if law not in taken]
    said = ", ".join(taken) if len(taken) <= len(left) else f"all but {', '.join(left)}"
    return f"{said} ({numbers})"


def _without_advice(method: str, reason: str | None) -> str | None:
    """The reason alone: which method to use instead is in the same row. Those of auto are the others' reasons."""
    return reason if reason is None or method == "auto" else reason.partition("; ")[0]


def written() -> str:
    """The page with its tables made anew."""
    text = PAGE.read_text(encoding="utf-8")
    before, after = text.partition(BEGIN)[0], text.partition(END)[2]
    return f"{before}{BEGIN}\n{tables()}\n{END}{after}"


if __name__ == "__main__":
    sys.path[:0] = [str(PROJECT)]
    import conftest  # noqa: F401 - lets plugins be seen that are not installed

    PAGE.write_text(written(), encoding="utf-8")
