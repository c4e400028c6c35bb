"""When every motion converges to one periodic motion (convergent systems).

Two motions of one scene, e their difference, obey e'' + c e' + k e = -N(tau) (T - T'), with T and T' the friction
coefficients at their slip velocities w and w': loads and the motion of the belt are the same for both and cancel,
whatever their waveforms. With energy E = (e'^2 + k e^2)/2 and w - w' = e',

    E' = -c e'^2 - N(tau) (T - T')(w - w') <= -(c - N_max fall) e'^2,

for N > 0 and a coefficient that falls by at most ``fall`` per velocity (0 where it never does). Where the bracket is
positive E never grows, and two periodic motions have e' = 0 throughout: they have the same slip, at a constant
distance e. Where that slips, T = T' and k e = 0. So they differ only if the mass never slips, which it cannot on a
belt of mean speed other than 0: it would be carried off. In the plane the same holds by vectors, with the lesser
damping.

Where no dashpot damps and friction never falls, E still never grows, so that the map of a period moves no two states
apart, and the states it leaves as they are form a convex set: one of them that attracts its neighbours is alone.

What of the body remembers only takes energy: springs that relax add the sum of q^2/(2 k) to E, which decays.

None of this holds for springs and dashpots that are not linear: a Duffing oscillator has several periodic motions.
"""

from __future__ import annotations

import math

from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.body import one_harmonic_motions
from frictionlab.scene.scene import Scene
from frictionlab.theory.rest import friction_at_rest, stays_at_rest

NEARLY_LINEAR = 0.15
"""Of the force of the linear spring: the largest part of it that the cubic one adds or takes."""


def is_unique(scene: Scene, law: FrictionLaw) -> bool:
    """Whether the scene has exactly one periodic motion, which attracts every start (theorem T1).

    For every periodic load, motion of the belt and positive normal load: of a law without memory on a mass with
    damping above ``largest normal load * steepest fall``, where the mean belt speed is not 0, or loads make the mass
    slip all the same. Source: Leine & van de Wouw (2008).
    """
    return is_unique_in_slip(scene, law) and not stays_at_rest(scene, law)


def is_unique_in_slip(scene: Scene, law: FrictionLaw) -> bool:
    """Whether a theorem says that this scene has one steady state at every belt speed at which the mass slips.

    Of a law without memory under a drive.
    """
    free = scene.degrees_of_freedom > 0 and not scene.undriven
    return free and _damping(scene) > 0.0 and is_convergent(scene, law)


def is_convergent(scene: Scene, law: FrictionLaw) -> bool:
    """Whether no two motions part: damping outweighs the steepest fall of friction with speed.

    The steady state of a law without memory is then unique and attracts every start (Leine & van de Wouw, 2008),
    under the further conditions of ``is_unique``. Without a load across the belt the motion across decays under every
    isotropic law, and only the damping along the belt matters. The theorem does not cover laws with memory.
    """
    return law.memory_kind == "none" and not scene.bends and (law.monotone() or falls_slowly(scene, law))


def falls_slowly(scene: Scene, law: FrictionLaw) -> bool:
    """Whether damping outweighs the steepest fall of steady sliding friction under the largest normal load.

    Never on a body that is not linear, whose motions may part whatever the friction.
    """
    return not scene.bends and falls_slower_than_dashpots(scene, law)


def falls_slower_than_dashpots(scene: Scene, law: FrictionLaw) -> bool:
    """The same, whatever the springs."""
    fall = law.steepest_fall()
    return fall == 0.0 or largest_normal_load(scene) * fall < _damping(scene)


def resonates_once(scene: Scene, law: FrictionLaw) -> bool:
    """Whether a body that is not linear has no two resonances, so that few starts are tried of it. No theorem.

    Of a spring alike to both sides, under a sine. It may harden, or be linear: under one no quicker than the free
    motion, which is twice as quick as that within reach of the load, so that no harmonic resonates either. Or its
    force within reach of load and friction is nearly linear, and one harmonic balances one motion, with friction and
    without. In all of 3,600 random scenes of either kind two starts found what twenty did.
    """
    mass = scene.mass()
    if not mass.bends or not scene.is_harmonic or not scene.load_along_belt_only:
        return False
    hardens, limit = mass.bends.spring_3, mass.normal_load * friction_at_rest(law)
    motions = [[*map(abs, one_harmonic_motions(mass, rub))] for rub in (0.0, 4.0 / math.pi * limit)]
    reach = max([1.5 * abs(mass.force) / mass.stiffness, *motions[0]])
    stiffest = mass.stiffness + 0.75 * hardens * reach**2
    slow = hardens == 0.0 or mass.frequency**2 <= mass.stiffness
    once = hardens >= 0.0 and slow and stiffest < (2.0 * mass.frequency) ** 2
    reach = max([reach, *motions[1]]) + limit / mass.stiffness
    nearly = abs(hardens) * reach**2 <= NEARLY_LINEAR * mass.stiffness and max(map(len, motions)) < 2
    return mass.bends.spring_2 == 0.0 == mass.bends.dashpot_1 and (once or nearly)


def largest_normal_load(scene: Scene) -> float:
    """Of a period [K_1 L]."""
    assert scene.normal_load is not None
    if scene.is_harmonic:
        return scene.normal_load
    signals = scene.signals()
    return scene.normal_load + max(0.0, signals.normal_load.extremes(signals.period)[1])


def _damping(scene: Scene) -> float:
    """Of the directions in which the body moves, the lesser."""
    mass = scene.mass()
    along = mass.damping
    return along if scene.load_along_belt_only else min(along, mass.transverse_damping)
