"""What answers where a method refuses: shooting, or what that asks for where it refuses too."""

from __future__ import annotations

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.shooting import Shooting
from frictionlab.scene import Scene


def or_shooting(reason: str, scene: Scene, law: FrictionLaw) -> str:
    """A refusal, with the way on."""
    return f"{reason}; {Shooting().refusal(scene, law) or 'use shooting'}"
