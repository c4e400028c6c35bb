"""Rest of the mass under static friction, and convergence of all motions to one.

If static friction balances the loads at all times, the mass never slips. Under the conditions below, every
motion of a scene converges to one periodic motion (convergent systems).

Two motions of one scene, e their difference, obey e'' + c e' + k e = -N(tau) (T - T'), with T and T' the
friction coefficients at their slip velocities w and w'. Loads and the motion of the belt are the same for
both and cancel, whatever their waveforms. With energy E = (e'^2 + k e^2)/2 and w - w' = e',

    E' = -c e'^2 - N(tau) (T - T')(w - w') <= -(c - N_max fall) e'^2,

for N > 0 and a coefficient that falls by at most ``fall`` per velocity (0 if it never falls). If the bracket
is positive, E never grows, and two periodic motions have e' = 0 throughout: they have the same slip, at a
constant distance e. While they slip, T = T' and k e = 0. So they differ only if the mass never slips. On a
belt of mean speed other than 0 that is impossible: the mass would be carried off. In the plane the same holds
by vectors, with the lesser damping.

If no dashpot damps and friction never falls, E still never grows. The map of a period then moves no two
states apart, and its fixed points form a convex set. A fixed point that attracts its neighbours is therefore
the only one.

None of this holds for springs and dashpots that are not linear: a Duffing oscillator has several periodic
motions.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.body import one_harmonic_motions
from frictionlab.scene.scene import Scene
from frictionlab.scene.signals import Signal, highest
from frictionlab.theory.linear import velocity_scale
from frictionlab.theory.piecewise import PieceNumbers, piecewise
from frictionlab.values.quantities import Floats

CREEP = 1e-9
"""Slip speed at which the friction of slow slip is evaluated."""


def friction_at_rest(law: Any) -> float:
    """Return the friction coefficient at the onset of slip."""
    if law.memory_kind == "none":
        return float(law.static_friction())
    at_rest: float = law.sliding_friction(0.0)
    return at_rest or float(law.sliding_friction(CREEP))  # a law that is zero at rest: take slow slip


def size_of_friction(scene: Scene, law: FrictionLaw) -> float:
    """Return the friction coefficient that errors are measured by: that at rest, else that of quick slip, above 0."""
    scale = velocity_scale(scene)
    return friction_at_rest(law) or law.sliding_friction(scale if 0.0 < scale < math.inf else 1.0) or 1.0


def can_hold(scene: Scene, law: FrictionLaw) -> bool:
    """Check whether static friction can keep a mass at rest on the belt at all times.

    The spring of the mass balances the mean of the load.
    """
    if not scene.is_harmonic:
        held = _held_with_the_belt(scene)
        return held is not None and bool(np.all(np.abs(held.force) <= held.pressed * friction_at_rest(law)))
    mass = scene.mass()
    along, across = mass.force, mass.transverse_force
    # the longer half axis of the ellipse of loads
    sizes = abs(along) ** 2 + abs(across) ** 2 + abs(along**2 + across**2)
    return math.sqrt(0.5 * sizes) <= mass.normal_load * friction_at_rest(law)


def stays_at_rest(scene: Scene, law: FrictionLaw) -> bool:
    """Check whether static friction balances the loads at all times on a belt of mean speed 0.

    The belt may vibrate.

    The mass then never slips, wherever in a range it stays. Bristles always deflect: False.
    """
    return law.memory_kind == "none" and scene.belt_speed == 0.0 and resting_range(scene, law) > -math.inf


def resting_range(scene: Scene, law: FrictionLaw, side: float = 1.0) -> float:
    """Return the largest mean friction coefficient of a mass that never slips on a belt of mean speed 0.

    It is multiplied by ``side``: side -1 gives the least mean. It is -inf if the mass must slip. The spring
    force k and friction balance the force that keeps the mass at rest on the belt: |force - k| <= limit at
    all times, a convex set of k; the mean is k1/normal_load.
    """
    held = _held_with_the_belt(scene)
    if held is None:
        return -math.inf
    force, limit = side * held.force, held.pressed * friction_at_rest(law)
    if force.imag.any():
        return largest_spring_force(force, limit) / held.mean
    pieces = np.flatnonzero(np.diff(held.k)) + 1
    upper = -max(map(highest, np.split(-force.real - limit, pieces)))
    lower = max(map(highest, np.split(force.real - limit, pieces)))
    return upper / held.mean if lower <= upper else -math.inf


def largest_spring_force(load: NDArray[np.complex128], limit: Floats) -> float:
    """Return the largest spring force along x1 that friction balances together with the load, in the plane.

    Friction may reach the limit.
    """
    most = float(limit.max())
    low, high, best = -most, most, -math.inf
    for _ in range(6):
        across = np.linspace(low, high, 201)
        room = limit[:, None] ** 2 - (load.imag[:, None] - across) ** 2
        half = np.sqrt(np.maximum(room, 0.0))
        uppers, lowers = (load.real[:, None] + half).min(axis=0), (load.real[:, None] - half).max(axis=0)
        reach = np.where((room >= 0.0).all(axis=0) & (lowers <= uppers), uppers, -np.inf)
        at = int(reach.argmax())
        best = max(best, float(reach[at]))
        width = (high - low) / 50.0
        low, high = across[at] - width, across[at] + width
    return best


class _Held(NamedTuple):
    """Force of friction that keeps the mass at rest on the belt, x1 + i x2, and the normal load.

    Both are given over a period, at times in the pieces k.

    mean: of the normal load.
    """

    force: NDArray[np.complex128]
    pressed: Floats
    mean: float
    k: PieceNumbers


def _held_with_the_belt(scene: Scene) -> _Held | None:
    """Return the force at many times; None if the belt's velocity jumps, which no force can follow."""
    mass = scene.mass()
    if scene.is_harmonic:
        turn = np.exp(1j * np.linspace(0.0, np.pi, 721))  # the other half of the ellipse follows by symmetry
        load = (mass.force * turn).imag + 1j * (mass.transverse_force * turn).imag
        return _Held(
            np.concatenate([load, -load]),
            np.full(2 * len(load), mass.normal_load),
            mass.normal_load,
            np.repeat([0, 1], len(load)),
        )
    signals = scene.signals()
    edges = signals.edges()
    times = _times(edges, mass.varying.quickest)
    springs = (mass.damping, mass.stiffness), (mass.transverse_damping, mass.transverse_stiffness)
    along, across = (
        _against_the_belt(load, belt, own, times)
        for load, belt, own in zip(signals.load, signals.belt, springs, strict=True)
    )
    if along is None or across is None:
        return None
    pressed = piecewise(signals.normal_load, edges, mass.normal_load).at(times.tau, times.k)[0]
    return _Held(along + 1j * across, pressed, mass.normal_load, times.k)


class _Times(NamedTuple):
    """Many times on pieces between edges, and the pieces of these times."""

    edges: Floats
    tau: Floats
    k: PieceNumbers


def _times(edges: Floats, quickest: float) -> _Times:
    """Return many times, both ends of every piece included."""
    dense = min(quickest * 1440.0 / (2.0 * math.pi), 20000.0 / edges[-1])
    counts = 3 + np.ceil(np.diff(edges) * dense).astype(int)
    pairs = zip(edges[:-1], edges[1:], counts.tolist(), strict=True)
    tau = np.concatenate([np.linspace(start, stop, n) for start, stop, n in pairs])
    return _Times(edges, tau, np.repeat(np.arange(len(counts)), counts))


def _against_the_belt(load: Signal, belt: Signal, own: tuple[float, float], times: _Times) -> Floats | None:
    """Return load less inertia, dashpot and spring (own) of a mass at rest on the belt, in one direction.

    The mean of the load is left out: the spring balances it.
    """
    (damping, stiffness), (edges, tau, k) = own, times
    path = piecewise(belt, edges)
    places = np.arange(len(edges) - 1)
    first, last = path.at(edges[:-1], places)[0], path.at(edges[1:], places)[0]
    if np.abs(np.roll(first, -1) - last).max() > 1e-9 * path.size():
        return None
    gone = path.integral(edges[:-1], edges[1:], places)
    before = np.concatenate([[0.0], np.cumsum(gone)])
    x = before[k] + path.integral(edges[k], tau, k)
    # subtract the mean over the period, by the trapezoidal rule at these times
    x = x - float(np.trapezoid(x, tau)) / path.period
    velocity, acceleration = path.at(tau, k)
    pushed = piecewise(load, edges).at(tau, k)[0] - load.mean
    return np.asarray(pushed - acceleration - damping * velocity - stiffness * x)


NEARLY_LINEAR = 0.15
"""Largest force of the cubic spring, of either sign, over that of the linear spring."""


def is_unique(scene: Scene, law: FrictionLaw) -> bool:
    """Check whether the scene has exactly one periodic motion, which attracts every start (theorem T1).

    The theorem holds for every periodic load, motion of the belt and positive normal load. It needs a law
    without memory on a mass with damping above ``largest normal load * steepest fall``. It also needs a mean
    belt speed other than 0, or loads that make the mass slip all the same.

    Parameters
    ----------
    scene : Scene
        Scene.
    law : FrictionLaw
        Law of friction.

    Returns
    -------
    bool
        True if the theorem says so; False leaves it open.

    References
    ----------
    Source: Leine & van de Wouw (2008)

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> fl.is_unique(scene, fl.Coulomb(mu=0.4)), fl.is_unique(scene, fl.Dahl(mu=0.4, stiffness=40))
    (True, False)
    """
    return is_unique_in_slip(scene, law) and not stays_at_rest(scene, law)


def is_unique_in_slip(scene: Scene, law: FrictionLaw) -> bool:
    """Check whether a theorem gives this scene one steady state at every belt speed at which the mass slips.

    The theorem is for laws without memory under a drive.
    """
    free = scene.degrees_of_freedom > 0 and not scene.undriven
    return free and _damping(scene) > 0.0 and is_convergent(scene, law)


def is_convergent(scene: Scene, law: FrictionLaw) -> bool:
    """Check whether no two motions part: damping outweighs the steepest fall of friction with speed.

    The steady state of a law without memory is then unique and attracts every start (Leine & van de Wouw,
    2008), under the further conditions of ``is_unique``. Without a load across the belt the motion across
    decays under every isotropic law, and only the damping along the belt matters. The theorem does not cover
    laws with memory.
    """
    return law.memory_kind == "none" and not scene.bends and (law.monotone() or falls_slowly(scene, law))


def falls_slowly(scene: Scene, law: FrictionLaw) -> bool:
    """Check whether damping outweighs the steepest fall of sliding friction under the largest normal load.

    It never does on a body that is not linear, whose motions may part whatever the friction.
    """
    return not scene.bends and falls_slower_than_dashpots(scene, law)


def falls_slower_than_dashpots(scene: Scene, law: FrictionLaw) -> bool:
    """Check the same, whatever the springs."""
    fall = law.steepest_fall()
    return fall == 0.0 or largest_normal_load(scene) * fall < _damping(scene)


def resonates_once(scene: Scene, law: FrictionLaw) -> bool:
    """Check whether a body that is not linear has no two resonances, so that few starts suffice. No theorem.

    The spring must act alike to both sides, under a sine. In the first kind of scenes the spring hardens
    under a sine no quicker than the free motion, or it is linear. Twice the frequency of the sine exceeds
    that of the free motion within reach of the load, so that no harmonic resonates either. In the second kind
    the spring is nearly linear within reach of load and friction, and one harmonic balances one motion, with
    friction and without. In all of 3,600 random scenes of either kind two starts found what twenty did.
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
    """Return the largest normal load in a period [K_1 L]."""
    assert scene.normal_load is not None
    if scene.is_harmonic:
        return scene.normal_load
    signals = scene.signals()
    return scene.normal_load + max(0.0, signals.normal_load.extremes(signals.period)[1])


def _damping(scene: Scene) -> float:
    """Return the lesser damping of the directions in which the body moves."""
    mass = scene.mass()
    along = mass.damping
    return along if scene.load_along_belt_only else min(along, mass.transverse_damping)
