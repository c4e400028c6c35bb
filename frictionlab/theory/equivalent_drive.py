"""A belt that vibrates as a sine under a linear body, and the drive that does the same over a steady belt."""

from __future__ import annotations

import cmath
import math
from typing import Any, NamedTuple

from frictionlab.scene.scene import Drive, Load, Scene
from frictionlab.scene.signals import Signal


class EquivalentDrive(NamedTuple):
    """The scene of x - b over a steady belt, b the way of the belt's vibration; slip and friction are the same.

    velocity, transverse_velocity: phasors of b' along x1 and x2, to be added to what the scene answers.
    """

    scene: Scene
    velocity: complex
    transverse_velocity: complex


def equivalent_drive(scene: Scene) -> EquivalentDrive | None:
    """Of a body under sines of the drive's frequency; None where anything else changes in time, or nothing is left.

    With x = b + u the equation of motion u'' + c u' + k u + N T(u' - v_b) = F - (b'' + c b' + k b) has a steady belt,
    and a drive of phasor F - (i Omega + c + k/(i Omega)) B, where b' = Im(B exp(i Omega tau)).
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
    """Whether loads and belt are sines of one frequency, under a constant normal load."""
    signals, omega = scene.signals(), scene.frequency
    every = (*signals.load, *signals.belt)
    sines = all(wave.frequency == omega for each in every for wave in each.waves)
    return sines and not any(each.pieces for each in every) and signals.normal_load == Signal()
