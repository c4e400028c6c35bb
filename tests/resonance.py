"""The body of the paper's Fig. 4b, driven at resonance, and reference curves."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np

from frictionlab.scene.scene import Drive, Scene


def at_resonance(belt_speed: float, frequency: float = 1.0, **changes: Any) -> Scene:
    """One degree of freedom, gamma^2 = 10, but for the changes."""
    drive = Drive(unbalance=10.0, frequency=frequency)
    given = {"damping_ratio": 0.1, "normal_load": 10.0, "drive": drive}
    return Scene(belt_speed=belt_speed, **(given | changes))


def reference_curve(file: str) -> dict[str, Any]:
    """The columns of a reference file."""
    with (Path(__file__).parent / "reference" / file).open() as lines:
        rows = list(csv.DictReader(lines))
    return {name: np.array([float(row[name] or "nan") for row in rows]) for name in rows[0]}
