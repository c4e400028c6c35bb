"""When every motion converges to one periodic motion (convergent systems)."""

from __future__ import annotations

from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.scene import Scene


def is_convergent(scene: Scene, law: FrictionLaw) -> bool:
    """Whether any two motions converge: damping outweighs the steepest fall of friction with speed.

    The steady state of a law without memory is then unique and attracts every start (Leine & van de Wouw, 2008).
    Without a load across the belt the motion across decays under every isotropic law, and only the damping along
    the belt matters. The theorem does not cover laws with memory.
    """
    return law.memory_kind == "none" and (law.monotone() or falls_slowly(scene, law))


def falls_slowly(scene: Scene, law: FrictionLaw) -> bool:
    """Whether damping outweighs the steepest fall of steady sliding friction."""
    mass = scene.mass()
    along, across = mass.damping, mass.transverse_damping
    damping = along if scene.load_along_belt_only else min(along, across)
    return law.steepest_fall() == 0.0 or mass.normal_load * law.steepest_fall() < damping
