"""The end of a refusal: the advice to use shooting, or the reason why shooting refuses as well."""

from __future__ import annotations

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Scene


def suggest_shooting(reason: str, scene: Scene, law: FrictionLaw) -> str:
    """A refusal with advice on what to use instead."""
    return f"{reason}; {Shooting().refusal(scene, law) or 'use shooting'}"
