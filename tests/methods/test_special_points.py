"""Points at which something vanishes, coincides or has no bound: each has a number, or a reason true of it."""

from __future__ import annotations

import copy
import math
import re
import warnings
from collections.abc import Callable
from typing import Any

import pytest
from profiles import DEEP, some
from scenes_of_every_kind import BEATS, Keys, belt, line, load, plane, slip

import frictionlab as fl
from frictionlab.study.registry import law_class
from frictionlab.theory import friction_free_velocity

MU = 0.4
WAVES = {name: {"waveform": name} for name in ("sine", "square", "triangle")} | {"beats": {"waveform": BEATS}}
SCENES: dict[str, Keys] = {
    **{f"line, {name}": line(1.0, wave) for name, wave in WAVES.items()},
    **{f"plane, {name}": plane(1.0, wave, wave | {"phase": 90.0}) for name, wave in WAVES.items()},
    **{f"slip, {name}": slip(1.0, wave) for name, wave in WAVES.items()},
    "plane, in phase": plane(1.0, {}, {}),
    "slip, at an angle": slip(1.0, {"direction": 30.0}),
    "line, belt": line(1.0, {}, **belt(4.0, phase=50.0)),
    "plane, belt": plane(1.0, {}, {}, **belt(4.0, direction=60.0)),
    "line, load": line(1.0, {}, **load(0.5, phase=70.0)),
    "line, constant contact": line(1.0, {}, **load(0.5, phase=70.0, contact="constant")),
    "slip, load": slip(1.0, {}, **load(0.5, phase=70.0)),
}
LAWS: dict[str, Callable[[float, float], Keys]] = {
    "coulomb": lambda v, x: {"mu": MU},
    "stribeck": lambda v, x: {"mu_kinetic": MU, "mu_static": 1.5 * MU, "stribeck_speed": 0.3 * v},
    "dahl": lambda v, x: {"mu": MU, "presliding_length": x},
    "jenkins": lambda v, x: {"mu": MU, "presliding_length": x},
    "lugre": lambda v, x: {"mu_kinetic": MU, "presliding_length": x, "damping": 0.02 / v},
    "elasto-plastic": lambda v, x: {"mu_kinetic": MU, "presliding_length": x, "damping": 0.02 / v},
}
"""By V_lin and a presliding length."""


def undamped(scene: Keys, frequency: float | None = None, friction: float | None = None) -> None:
    """No dashpots; another frequency; friction over the load."""
    scene["damping_ratio"] = 0.0
    for part in (scene.get("transverse", {}), scene.get("drive", {})):
        part.update({"damping_ratio": 0.0} if "damping_ratio" in part else {})
        part.update({"frequency": frequency} if frequency and "frequency" in part else {})
    scene["normal_load"] = scene["normal_load"] if friction is None else 10.0 * friction / MU


def at(speed: Callable[[float], float]) -> Callable[[Keys, Keys, float], None]:
    return lambda scene, law, v: scene.update(belt_speed=speed(v))


def presliding(share: float) -> Callable[[Keys, Keys, float], None]:
    return lambda scene, law, v: law.update(presliding_length=share * v)


Special = Callable[[Keys, Keys, float], None]
BODY: dict[str, tuple[Special, str]] = {
    "resonance": (lambda scene, law, v: scene["drive"].update(frequency=1.0), ""),
    "no damping": (lambda scene, law, v: undamped(scene), ""),
    "no damping, a third": (lambda scene, law, v: undamped(scene, 1 / 3), "without damping"),
    "no damping, resonance": (lambda scene, law, v: undamped(scene, 1.0), "without bound"),
    "no damping, resonance, held": (lambda scene, law, v: undamped(scene, 1.0, 1e6), "steps|holds"),
    "load 1e-6": (lambda scene, law, v: scene.update(normal_load=1e-5 / MU), ""),
    "load 1e6": (lambda scene, law, v: scene.update(normal_load=1e7 / MU), "holds the mass"),
    "load = drive": (lambda scene, law, v: scene.update(normal_load=10.0 / MU), ""),
}
TOUCHES = "rests for a part|rounding errors remain"
BELT: dict[str, tuple[Special, str]] = {
    "V_lin": (at(lambda v: v), TOUCHES),
    "above V_lin": (at(lambda v: math.nextafter(v, math.inf)), TOUCHES),
    "below V_lin": (at(lambda v: math.nextafter(v, 0.0)), TOUCHES),
    "at rest": (at(lambda v: 0.0), "at rest"),
    "hardly moving": (at(lambda v: 1e-9 * v), ""),
}
SOFT: dict[str, tuple[Special, str]] = {
    "presliding 1e-9": (presliding(1e-9), ""),
    "presliding 1e3": (presliding(1e3), ""),
}
BREAKING: dict[str, tuple[Special, str]] = {
    f"breakaway {ratio}": (lambda scene, law, v, ratio=ratio: law.update(breakaway_ratio=ratio), "")
    for ratio in (0.99, 0.999999)
}
"""What makes a point special, and words of the reasons that are true where it has no number; "": it has one."""
SPECIAL = BODY | BELT | SOFT | BREAKING


def points() -> list[tuple[str, str, str]]:
    """Every scene, law and what makes it special, where that can be."""
    return [
        (scene, law, special)
        for scene in SCENES
        for law in LAWS
        for special in SPECIAL
        if not (special in BODY and scene.startswith("slip"))
        and not (special in SOFT and law in ("coulomb", "stribeck"))
        and not (special in BREAKING and law != "elasto-plastic")
    ]


def few(scene: str, law: str, special: str) -> bool:
    """Those of kernels that other tests need, too, and of few steps."""
    quick = scene in ("line, sine", "line, square", "line, load") or scene.startswith("slip")
    return law == "coulomb" and quick


def solved(name: str, kind: str, special: str) -> tuple[Any, Keys]:
    scene = copy.deepcopy(SCENES[name])
    v = friction_free_velocity(fl.Scene(**scene), fl.Coulomb(mu=MU))
    scene["belt_speed"], keys = 0.4 * v, LAWS[kind](v, 0.03 * v)
    SPECIAL[special][0](scene, keys, v)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        table = fl.curve(fl.Scene(**scene), law_class(kind)(**keys), [scene["belt_speed"]])
    return table.iloc[0], keys


def grouped(chosen: Callable[[str, str, str], bool]) -> dict[str, list[tuple[str, str, str]]]:
    every = [point for point in points() if chosen(*point)]
    groups = {
        f"{scene}, {law}": [point for point in every if point[:2] == (scene, law)]
        for scene in SCENES
        for law in LAWS
    }
    return {group: found for group, found in groups.items() if found}


def drawn(scene: str, law: str, special: str) -> bool:
    """One in twelve of all, with every scene, every law and all that makes a point special."""
    places = list(SCENES).index(scene), list(LAWS).index(law), list(SPECIAL).index(special)
    return (2 * places[0] + places[1] + 5 * places[2]) % 12 == 0


CHOSEN = grouped(lambda *point: few(*point) or (DEEP and drawn(*point)))


@some(1, "all methods each")
@pytest.mark.parametrize("group", CHOSEN)
def test_a_special_point_has_a_number_or_a_reason_that_is_true_of_it(group: str) -> None:
    for point in CHOSEN[group]:
        row, law = solved(*point)
        if row["status"] == "ok":
            # bristles of a constant contact keep what a high load bent them to, as Runge-Kutta steps find, too
            higher = 0.5 if "constant contact" in group else 1e-7
            assert abs(row["mean_friction"]) <= max(law.get("mu_static", MU), MU) * (1.0 + higher), point
            assert row["error"] <= 1e-8 or row["error_kind"] == "statistical", point
        else:
            words = SPECIAL[point[2]][1] or "a number"
            assert re.search(words, row["reason"]), (point, row["status"], row["reason"])
