"""Run by test_motion.py with compilation switched off: every method, with one function of time replaced.

Prints one line of JSON for each case: its name, mean and error as for the changed scene, and with the function
replaced in the table that kernels read, which leaves all numbers beside the table as they are.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

sys.path += [str(Path(__file__).parents[1]), str(Path(__file__).parents[2] / "plugins" / "maxwell-slip")]

from maxwell_slip import MaxwellSlip
from profiles import DEEP

from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.lugre import LuGre
from frictionlab.methods.march.method import March
from frictionlab.methods.shooting.method import Shooting
from frictionlab.motion.orbit.read import read_columns
from frictionlab.scene import body
from frictionlab.scene.scene import Scene
from frictionlab.scene.varying import Packed, Varying

COULOMB = Coulomb(mu=0.4)
DAHL, LUGRE = (
    Dahl(mu=0.4, presliding_length=1.0),
    LuGre(mu_kinetic=0.4, presliding_length=1.0, damping=0.01),
)
ELEMENTS = MaxwellSlip(mu=(0.2, 0.2), stiffness=(1.0, 3.0))
STICKS = {
    "damping_ratio": 0.1,
    "normal_load": 10.0,
    "belt_speed": 0.5,
    "drive": {"amplitude": 6.0, "frequency": 0.5},
}
PLANE = {
    **STICKS,
    "belt_speed": 2.0,
    "drive": {"amplitude": 10.0, "frequency": 1.3, "phase": 30.0},
    "transverse": {
        "natural_frequency": 2.1,
        "damping_ratio": 0.05,
        "load": {"amplitude": 8.0, "phase": 100.0},
    },
}
BLOCK = {"damping_ratio": 0.05, "normal_load": 4.0, "belt_speed": 0.7}
STICKY = Coulomb(mu=0.4, mu_static=0.6)
CASES: dict[str, tuple[Any, Any, dict[str, Any]]] = {
    "shooting, stick and slip": (Shooting(), COULOMB, STICKS),
    "shooting, the plane": (Shooting(), COULOMB, PLANE),
    "shooting, undriven": (Shooting(), STICKY, BLOCK),
    "shooting, by the way slid": (Shooting(), DAHL, STICKS),
    "shooting, a bristle": (Shooting(), LUGRE, STICKS),
    "shooting, elements": (Shooting(), ELEMENTS, STICKS),
    "moreau": (March(stepper="moreau", steps=100), COULOMB, STICKS),
    "moreau in the plane": (March(stepper="moreau", steps=50), COULOMB, PLANE),
    "rk4": (March(stepper="rk4", steps=100), COULOMB, {**STICKS, "belt_speed": 2.9}),
    "smoothed": (March(stepper="smoothed", width=0.3), COULOMB, {**STICKS, "belt_speed": 6.0}),
    "rk4 of a bristle": (March(stepper="rk4", steps=100), DAHL, STICKS),
    "sdirk2": (March(stepper="sdirk2", steps=50), DAHL, STICKS),
    "rk4 of elements": (March(stepper="rk4", steps=800), ELEMENTS, STICKS),
}


SLOW = "shooting, elements", "rk4 of elements"
"""Cases that Python takes half a minute for; in kernels they share the map and the step of one bristle."""


def more_load(varying: Varying, normal_load: float) -> Varying:
    """Half as much again."""
    return varying._replace(load=varying.load.scaled(1.5))


def more_normal_load(varying: Varying, normal_load: float) -> Varying:
    """A fifth more."""
    press = varying.normal_load
    return varying._replace(normal_load=press._replace(lines=press.lines + 0.2 * normal_load))


def stronger(part: dict[str, Any] | None) -> dict[str, Any] | None:
    """A force half as large again."""
    return {**part, "amplitude": 1.5 * part["amplitude"]} if part else None


def under_load(scene: dict[str, Any]) -> dict[str, Any]:
    """The scene with every force half as large again."""
    changed = {**scene, "drive": stronger(scene["drive"])}
    if "transverse" in scene:
        changed["transverse"] = {**scene["transverse"], "load": stronger(scene["transverse"]["load"])}
    return changed


Changed = Callable[[dict[str, Any]], dict[str, Any]]
CHANGES: dict[str, tuple[Callable[[Varying, float], Varying], Changed, float]] = {
    "load": (more_load, under_load, 1.0),
    "normal_load": (
        more_normal_load,
        lambda scene: {**scene, "normal_load": 1.2 * scene["normal_load"]},
        1.2,  # friction is told in shares of the mean normal load
    ),
}
"""What is replaced; the scene that is the same; and by what it multiplies the mean."""


def answer(case: str, change: Callable[[dict[str, Any]], dict[str, Any]] | None) -> list[Any]:
    """Status, mean, error, work put in and heat of a case, its scene changed or left."""
    method, law, given = CASES[case]
    scene = Scene(**(change(given) if change else given))
    found = method.solve([scene], law, 1e-6)
    columns = read_columns([scene], found.orbit, found.orbits)
    energies = [float(columns[name][0]) for name in ("energy_input", "energy_contact")]
    return [found.status[0], float(found.mean[0].real), float(found.error[0]), *energies]


def main(name: str, cases: list[str]) -> None:
    """Compare the two ways to change one thing."""
    replaced, change, factor = CHANGES[name]
    cases = [case for case in cases if name != "load" or "drive" in CASES[case][2]]
    expected = {case: answer(case, change) for case in cases}
    pack, now = body.packed, cases[0]

    def packed(varying: Varying, balanced: tuple[complex, complex], drive: float) -> Packed:
        other = replaced(varying, CASES[now][2]["normal_load"])
        return pack(other._replace(fastest=math.inf), balanced, drive)

    body.packed = packed
    for now in cases:
        status, mean, *others = answer(now, None)
        print(json.dumps([now, expected[now], [status, mean / factor, *others]]), flush=True)


if __name__ == "__main__":
    quick = [case for case in CASES if DEEP or case not in SLOW]
    main(sys.argv[1], sys.argv[2:] or quick)
