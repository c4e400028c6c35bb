"""What answers where a method refuses: shooting, or what that asks for where it refuses too."""

from __future__ import annotations

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Scene


def suggest_shooting(reason: str, scene: Scene, law: FrictionLaw) -> str:
    """A refusal, with the way on."""
    return f"{reason}; {Shooting().refusal(scene, law) or 'use shooting'}"
