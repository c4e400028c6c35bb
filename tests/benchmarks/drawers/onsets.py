"""Onsets of curves of POINTS points, on the line and in the plane, against scans DENSE times as dense.

An onset is right where the scan changes its kind within a step of the place, and the motions just outside
belt_speed_error are of both kinds; the column counts sign changes at nodes, so for the end of reversal a step of the
scan is allowed for. It lies between rows where it is not located and the change of the scan lies within the error;
a change of the scan without an onset is missed.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from campaign import WRONG, Campaign, Drawn, Keys, Verdicts

import frictionlab as fl
from frictionlab.theory import friction_free_velocity

KINDS = "stick_begins", "stick_ends", "reversal_ends"
POINTS, DENSE = 40, 10
Change = tuple[str, float, float]
"""Its name, and the belt speeds around it."""


def draw(rng: np.random.Generator) -> Drawn:
    """A scene and a law: Coulomb's, on the line also more friction at rest and falling friction."""
    frequency, load, mu = float(10.0 ** rng.uniform(-0.5, 0.5)), 10.0, 0.4
    scene: Keys = {
        "damping_ratio": float(10.0 ** rng.uniform(-1.3, -0.3)),
        "normal_load": load * float(10.0 ** rng.uniform(-1.3, 0.3)) / mu,
        "belt_speed": 1.0,
        "drive": {"amplitude": load, "frequency": frequency},
    }
    if rng.random() < 0.5:
        across = {
            "amplitude": load * float(10.0 ** rng.uniform(-0.7, 0.5)),
            "phase": float(rng.choice([0, 90, 40])),
        }
        scene["transverse"] = {
            "natural_frequency": float(10.0 ** rng.uniform(-0.4, 1.0)),
            "damping_ratio": float(10.0 ** rng.uniform(-1.3, -0.3)),
            "load": across,
        }
    kind = rng.random()
    # in the plane friction that falls has its starts compared: a tenth of a second a motion
    if kind < 0.7 or "transverse" in scene:
        return Drawn("coulomb", scene, {"kind": "coulomb", "mu": mu})
    if kind < 0.9:
        swing = friction_free_velocity(fl.Scene(**scene))
        falling = {"kind": "stribeck", "mu_kinetic": 0.3, "mu_static": 0.4, "stribeck_speed": swing}
        return Drawn("stribeck", scene, falling)
    return Drawn("more at rest", scene, {"kind": "coulomb", "mu": mu, "mu_static": 0.44})


def solved(one: Drawn, speeds: Any) -> Any:
    """A run of one curve."""
    sweep = {"scene.belt_speed": [float(speed) for speed in speeds]}
    return fl.run({"schema": 1, "scene": one.scene, "laws": [one.law], "sweep": sweep, "tolerance": 1e-8})


def kinds(table: pd.DataFrame) -> tuple[Any, Any, Any]:
    """Of the rows with a motion: belt speed, stick, reversal or stick."""
    rows = table[table["status"] == "ok"]
    stick = (rows["stick_fraction"] > 0.0).to_numpy()
    return rows["scene.belt_speed"].to_numpy(), stick, stick | (rows["reversals"] > 0.0).to_numpy()


def changes(table: pd.DataFrame) -> list[Change]:
    """Every change of kind in a table."""
    speed, stick, reverses = kinds(table)
    found: list[Change] = []
    for k in range(len(speed) - 1):
        if stick[k] != stick[k + 1]:
            found.append(("stick_begins" if stick[k + 1] else "stick_ends", speed[k], speed[k + 1]))
        if reverses[k] and not reverses[k + 1]:
            found.append(("reversal_ends", speed[k], speed[k + 1]))
    return found


def both_kinds_beside(one: Drawn, onset: Any) -> bool:
    """Whether the motions just outside the error differ as the onset says."""
    place, error = onset["belt_speed"], 1.01 * onset["belt_speed_error"]
    speed, stick, _ = kinds(solved(one, [place - error, place + error]).table)
    return len(speed) == 2 and [*stick] == [
        onset["onset"] != "stick_begins",
        onset["onset"] == "stick_begins",
    ]


def judge(one: Drawn) -> Verdicts:
    """The onsets of one curve."""
    swing = friction_free_velocity(one.made()[0])
    done = solved(one, np.linspace(0.02, 1.3, POINTS) * swing)
    left = changes(solved(one, np.linspace(0.02, 1.3, POINTS * DENSE) * swing).table)
    for _, onset in done.onsets.iterrows():
        if onset["onset"] in KINDS:
            yield _verdict(one, onset, left)
    yield from ((f"{name} missed", (low, high)) for name, low, high in left)


def _verdict(one: Drawn, onset: Any, left: list[Change]) -> tuple[str, Any]:
    """Of one onset; the change of the scan that it is of is taken from those that are left."""
    name, place, error = onset["onset"], onset["belt_speed"], onset["belt_speed_error"]
    own = [each for each in left if each[0] == name and each[1] - error <= place <= each[2] + error]
    located = "between" not in onset["how"]
    sure = name == "reversal_ends" or not located or both_kinds_beside(one, onset)
    # a window of stick below the step of the scan is seen by its own two sides alone
    seen = bool(own) or (located and sure and name != "reversal_ends")
    if own:
        left.remove(own[0])
    if not (seen and sure):
        return f"{WRONG}: {name}", dict(onset[["belt_speed", "belt_speed_error", "how"]])
    return f"{name} {'right' if located else 'between rows'}", ""


CAMPAIGN = Campaign(draw, judge, scenes=100)
