"""The body of the paper's Fig. 4b, driven at resonance, and reference curves."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np

from frictionlab.scene.scene import Drive, Load, Scene, Transverse
from frictionlab.theory import friction_free_velocity


def at_resonance(belt_speed: float, frequency: float = 1.0, **changes: Any) -> Scene:
    """One degree of freedom, gamma^2 = 10, but for the changes."""
    drive = Drive(unbalance=10.0, frequency=frequency)
    given = {"damping_ratio": 0.1, "normal_load": 10.0, "drive": drive}
    return Scene(belt_speed=belt_speed, **(given | changes))


def in_the_plane(belt_speed=5.0, frequency=1.0, normal_load=1.0, omega_r=2.0, **load: Any) -> Scene:
    """Paper, Figs. 8 and 9: equal loads along and across the belt, but for the changes."""
    load = Load(**({"unbalance": 10.0} | load))
    across = Transverse(natural_frequency=omega_r, damping_ratio=0.1, load=load)
    return at_resonance(belt_speed, frequency, normal_load=normal_load, transverse=across)


def of_unit_load(frequency: float, damping: float, ratio: float, share: float) -> Scene:
    """ratio: friction of coefficient 0.4 over the load; share: belt speed over V_lin."""
    drive = Drive(amplitude=1.0, frequency=frequency)
    still = Scene(damping_ratio=damping, normal_load=ratio / 0.4, belt_speed=0.0, drive=drive)
    return still.at(share * friction_free_velocity(still))


def reference_curve(file: str) -> dict[str, Any]:
    """The columns of a reference file."""
    with (Path(__file__).parent / "reference" / file).open() as lines:
        rows = list(csv.DictReader(lines))
    return {name: np.array([float(row[name] or "nan") for row in rows]) for name in rows[0]}
