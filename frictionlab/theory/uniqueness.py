"""When every motion converges to one periodic motion (convergent systems)."""

from __future__ import annotations

from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.scene.scene import Scene


def is_convergent(scene: Scene, law: FrictionLaw) -> bool:
    """Whether no two motions ever move apart, by friction's fall being slower than damping can make up for.

    The steady state of a law without memory is then unique and attracts every start (Leine & van de Wouw, 2008).
    Where nothing pushes across the belt the motion across dies out under every isotropic law, and only damping along
    it counts. No theorem covers laws with memory.
    """
    return isinstance(law, SlidingLaw) and (law.monotone() or falls_slowly(scene, law))


def falls_slowly(scene: Scene, law: FrictionLaw) -> bool:
    """Whether damping makes up for the steepest fall of steady sliding friction."""
    mass = scene.mass()
    along, across = mass.damping, mass.transverse_damping
    damping = along if scene.load_along_belt_only else min(along, across)
    return law.steepest_fall() == 0.0 or mass.normal_load * law.steepest_fall() < damping
