"""Curves of mean Coulomb friction by balance of one harmonic, and the drive equivalent to a vibrating belt.

A belt that vibrates as a sine under a linear body has the effect of a drive over a steady belt.
"""

from __future__ import annotations

import cmath
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from frictionlab.scene.scene import Drive, Load, Scene
from frictionlab.scene.signals import Signal
from frictionlab.values.quantities import Floats


def one_harmonic_velocity(scene: Scene, friction: float, ratio: ArrayLike) -> Floats:
    """Compute the velocity amplitude of x1 by balancing one harmonic of Coulomb friction.

    It is explicit in the ratio of belt speed to amplitude. With A = 1 - Omega^2, a = 2 beta Omega, c = 4
    friction/pi and s = sqrt(1 - ratio^2), V = Omega (P^2 - c^2 s^2) / (a c s + sqrt(P^2 (A^2 + a^2) - A^2 c^2
    s^2)): the positive root of Eq. 8, written without cancellation. The belt speed is then ratio*V and the
    mean (2/pi) arcsin(ratio): no root has to be searched.

    Parameters
    ----------
    scene : Scene
        Body under loads of one sine, on a steady belt, under a constant normal load.
    friction : float
        Friction force mu*normal_load [K_1 L].
    ratio : array_like of float
        Belt speed over velocity amplitude [-], in [0, 1].

    Returns
    -------
    numpy.ndarray of float
        Velocity amplitude V [omega_1 L]. It is zero where the load cannot overcome the first harmonic of
        friction, P <= c s.

    Raises
    ------
    ValueError
        If loads, belt or normal load of the scene vary otherwise.

    References
    ----------
    Sulollari, van Dalen & Cabboi, Eqs. 8-9, solved for V.
    """
    _needs_one_sine("one_harmonic_velocity", scene)
    mass = scene.mass()
    stiffness, damping = mass.stiffness - mass.frequency**2, mass.damping * mass.frequency
    force = abs(mass.force)
    held = 4.0 / np.pi * friction * np.sqrt(1.0 - np.asarray(ratio, dtype=np.float64) ** 2)
    surplus = np.maximum(0.0, (force - held) * (force + held))
    below = stiffness**2 * surplus + (damping * force) ** 2
    velocity = mass.frequency * surplus / np.where(surplus > 0.0, damping * held + np.sqrt(below), 1.0)
    return np.asarray(velocity)


def one_harmonic_least_ratio(scene: Scene, friction: float) -> float:
    """Compute the ratio of belt speed to velocity amplitude at which the one-harmonic curve starts.

    It is 0 for P >= 4 friction/pi. Below that load the first harmonic of friction holds the mass at a
    vanishing belt speed, and the curve of the mean starts at (2/pi) arcsin of sqrt(1 - (pi P/(4
    friction))^2).

    Parameters
    ----------
    scene : Scene
        Body under loads of one sine, on a steady belt, under a constant normal load.
    friction : float
        Friction force mu*normal_load [K_1 L].

    Returns
    -------
    float
        Least ratio [-].

    Raises
    ------
    ValueError
        As ``one_harmonic_velocity``.

    References
    ----------
    Sulollari, van Dalen & Cabboi, Eq. 8 at V -> 0.
    """
    _needs_one_sine("one_harmonic_least_ratio", scene)
    share = 0.25 * math.pi * abs(scene.mass().force) / friction
    return math.sqrt(max(0.0, (1.0 - share) * (1.0 + share)))


def _needs_one_sine(name: str, scene: Scene) -> None:
    if not scene.is_harmonic:
        raise ValueError(f"{name}: for loads of one sine on a steady belt under a constant normal load")


CONCAVE_BY_INITIAL_CURVATURE = math.pi / 16.0
"""Friction force over unbalance above which a curve at resonance starts concave, by one harmonic."""
CONCAVE_BY_AREA = math.pi / 4.0 * (2.0 - math.pi / 2.0)
"""Friction force over unbalance at which ``chord_area_at_resonance`` is zero."""


def chord_area_at_resonance(ratio: ArrayLike) -> Floats:
    """Compute the signed area between a curve at resonance and its chord, by one harmonic.

    It is 1 - 4/pi + 8 ratio/pi^2: twice the integral over v_b/V_lin in [0, 1] of the mean friction, relative
    to the friction coefficient, less v_b/V_lin. It is > 0 where the curve is concave, and independent of
    damping.

    Parameters
    ----------
    ratio : array_like of float
        Friction force over unbalance [-], mu gamma^2/alpha, from 0 to pi/4, where the body still slides on a
        belt at rest.

    Returns
    -------
    numpy.ndarray of float
        Signed area [-].

    References
    ----------
    Integral of Sulollari, van Dalen & Cabboi, Eqs. 5 and 8, at Omega = 1.
    """
    return np.asarray(1.0 - 4.0 / np.pi + 8.0 / np.pi**2 * np.asarray(ratio, dtype=np.float64))


def initial_concavity(scene: Scene, friction: float) -> float:
    """Compute the initial curvature of the curve of a scene, by one harmonic, > 0 if concave.

    It is 4 c (c + a V_0)/P^2 - 1, with forces of one harmonic at frequency Omega: P of the drive, c = (4/pi)
    friction, a V of the dashpot; V_0 is the velocity amplitude on a belt at rest. At resonance the sign
    changes at friction = (pi/16) unbalance, whatever the damping.

    Parameters
    ----------
    scene : Scene
        Driven body under loads of one sine, on a steady belt, under a constant normal load.
    friction : float
        Friction force, coefficient times normal_load [K_1 L].

    Returns
    -------
    float
        Initial curvature [-]; NaN if the body then sticks, P <= c.

    Raises
    ------
    ValueError
        If the scene has no drive, and as ``one_harmonic_velocity``.

    References
    ----------
    Expansion of Sulollari, van Dalen & Cabboi, Eqs. 5, 8 and 9, for small v_b.
    """
    if scene.degrees_of_freedom == 0 or not scene.mass().force:
        raise ValueError("initial_concavity: the scene has no drive")
    mass, harmonic = scene.mass(), 4.0 / math.pi * friction
    force = abs(mass.force)
    if force <= harmonic:
        return math.nan
    at_rest = float(one_harmonic_velocity(scene, friction, 0.0))
    return 4.0 * harmonic * (harmonic + mass.damping * at_rest) / force**2 - 1.0


class EquivalentDrive(NamedTuple):
    """Scene of x - b over a steady belt, b the displacement of the belt; slip and friction are the same.

    velocity, transverse_velocity: phasors of b' along x1 and x2, to be added to the motion of this scene.
    """

    scene: Scene
    velocity: complex
    transverse_velocity: complex


def equivalent_drive(scene: Scene) -> EquivalentDrive | None:
    """Return the equivalent drive of a body under sines of the drive's frequency.

    It is None if anything else changes in time, or if no load is left. With x = b + u the equation of motion
    u'' + c u' + k u + N T(u' - v_b) = F - (b'' + c b' + k b) has a steady belt, and a drive of phasor F - (i
    Omega + c + k/(i Omega)) B, where b' = Im(B exp(i Omega tau)).
    """
    if scene.degrees_of_freedom == 0 or scene.is_harmonic or not _of_one_sine(scene):
        return None
    mass, signals, omega = scene.mass(), scene.signals(), scene.frequency
    along, across = (each.harmonic(omega, signals.period) for each in signals.belt)
    impedance = complex(mass.damping, omega - mass.stiffness / omega)
    impedance_2 = complex(mass.transverse_damping, omega - mass.transverse_stiffness / omega)
    force, aside = mass.force - impedance * along, mass.transverse_force - impedance_2 * across
    if force == 0 and aside == 0:
        return None
    drive = Drive(amplitude=abs(force), phase=math.degrees(cmath.phase(force)), frequency=omega)
    changes: dict[str, Any] = {
        "drive": drive,
        "belt_vibration": None,
        "normal_load_variation": None,
        "dimensional": None,
    }
    if scene.transverse is not None:
        load = Load(amplitude=abs(aside), phase=math.degrees(cmath.phase(aside))) if aside != 0 else None
        changes["transverse"] = scene.transverse.model_copy(update={"load": load})
    return EquivalentDrive(scene.model_copy(update=changes), along, across)


def _of_one_sine(scene: Scene) -> bool:
    """Check whether loads and belt are sines of one frequency, under a constant normal load."""
    signals, omega = scene.signals(), scene.frequency
    every = (*signals.load, *signals.belt)
    sines = all(wave.frequency == omega for each in every for wave in each.waves)
    return sines and not any(each.pieces for each in every) and signals.normal_load == Signal()
