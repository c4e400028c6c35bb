"""The body of the paper's Fig. 4b, driven at resonance."""

from __future__ import annotations

from typing import Any

from frictionlab.scene.scene import Drive, Scene


def at_resonance(belt_speed: float, frequency: float = 1.0, **changes: Any) -> Scene:
    """One degree of freedom, gamma^2 = 10, but for the changes."""
    drive = Drive(unbalance=10.0, frequency=frequency)
    given = {"damping_ratio": 0.1, "normal_load": 10.0, "drive": drive}
    return Scene(belt_speed=belt_speed, **(given | changes))
