"""The describing function of a law: harmonics of friction over the amplitude of a harmonic slip velocity."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw, bristle_in_the_plane, bristle_on_the_line
from frictionlab.methods.prescribed.memory import MemoryPoint
from frictionlab.orbit.harmonics import HarmonicParts
from frictionlab.quantities import Written, at_least_one
from frictionlab.response.impedance import finite
from frictionlab.results.state import OrbitOf
from frictionlab.runner.arguments import given_law
from frictionlab.runner.steady_state import steady_state
from frictionlab.scene.scene import Scene, Slip, TransverseSlip
from frictionlab.theory.loops import Complexes

_TOLERANCE = 1e-12
_SAMPLES = 64
"""Of a period and a harmonic, of friction within the elastic range."""


def describing_function(
    law: FrictionLaw,
    amplitude: ArrayLike | tuple[complex, complex],
    frequency: ArrayLike,
    belt_speed: ArrayLike = 0.0,
    normal_load: ArrayLike = 1.0,
    harmonics: int = 1,
) -> Any:
    """Complex harmonics of the friction coefficient over the amplitude of the slip velocity.

    The slip velocity is -belt_speed + amplitude sin(frequency time); Im(amplitude D_k exp(i k frequency time)) is the
    k-th harmonic of friction. A real part of D_1 above 0 damps, an imaginary one below 0 is stiffness.

    amplitude [velocity], > 0: of the slip velocity along the belt; a tuple of two is slip in the plane.
    frequency [rad/time], > 0: circular.
    belt_speed [velocity]: that about which slip oscillates; 0: about rest.
    normal_load [force], > 0: of which laws of a contact_stiffness or contact_damping are taken per unit.
    harmonics: the number of D_k; where larger than 1 the first axis is the harmonic.

    Arrays are broadcast. In the plane, amplitudes along x1 and x2 (complex ones lead by their angle), D_k has 2 x 2
    numbers: row i of friction along i, column j over the slip velocity along j, NaN where that is 0.

    The closed loop of the law under that slip, its harmonics integrated; where the start decides on the mean, from an
    undeflected contact. Coulomb at rest gives 4 mu/(pi amplitude): Sulollari, van Dalen & Cabboi, Eq. 9.

    >>> import frictionlab as fl
    >>> fl.describing_function(fl.Coulomb(mu=0.4), [1, 2], 1).real.round(4)
    array([0.5093, 0.2546])
    >>> complex(fl.describing_function(fl.Dahl(mu=0.4, stiffness=40), 0.01, 1).round(4))
    (12.1419-29.3003j)

    Raises ValueError where no closed loop is found, ValueError or TypeError for what makes no sense.
    """
    law, count = _without_units(given_law(law)), at_least_one("harmonics", harmonics)
    names = {"frequency": frequency, "belt_speed": belt_speed, "normal_load": normal_load}
    others = [finite(name, value) for name, value in names.items()]
    if isinstance(amplitude, tuple):
        pair, grid = _pair(amplitude), np.broadcast(*others)
        share = np.array([1.0 / size if size else complex(np.nan, np.nan) for size in pair.tolist()])
        cells = [_friction(law, pair, count, *each).T[:, :, None] * share for each in grid]
    else:
        sizes = finite("amplitude", amplitude)
        if not (sizes > 0.0).all():
            raise ValueError(f"amplitude must be > 0, got {amplitude!r}")
        grid = np.broadcast(sizes, *others)
        cells = [_friction(law, np.array([size, 0j]), count, *each)[0] / size for size, *each in grid]
    found = np.array(cells).reshape(*grid.shape, *cells[0].shape)
    found = np.moveaxis(found, len(grid.shape), 0)
    return found if count > 1 else found[0][()]


def _without_units(law: FrictionLaw) -> FrictionLaw:
    """The law with numbers alone: all arguments are in its units."""
    texts = {name: float(value) for name, value in law if isinstance(value, Written)}
    return law.model_copy(update=texts)


def _pair(amplitudes: tuple[complex, ...]) -> Complexes:
    pair = np.array(amplitudes, dtype=complex)
    if pair.shape != (2,) or not np.isfinite(pair).all() or not pair.any():
        raise ValueError(
            f"amplitude: a tuple is two amplitudes, along x1 and x2, not both 0; got {amplitudes!r}; "
            "several amplitudes along x1 are a list"
        )
    return pair


def _friction(
    law: FrictionLaw, pair: Complexes, count: int, frequency: float, belt_speed: float, normal_load: float
) -> Complexes:
    """Harmonics 1 to ``count`` along x1 and x2 [2, count]: friction is Im(sum of F_k exp(i k frequency tau))."""
    along, across = pair.tolist()
    if along and across and law.planar_form() == "per-axis":  # each axis by itself: one may be elastic alone
        ways = (np.array([along, 0j]), belt_speed), (np.array([0j, across]), 0.0)
        rows = [_friction(law, way, count, frequency, speed, normal_load) for way, speed in ways]
        return np.array([rows[0][0], rows[1][1]])
    slip = Slip(velocity_amplitude=abs(along), frequency=frequency, phase=_degrees(along))
    other = TransverseSlip(velocity_amplitude=abs(across), phase=_degrees(across)) if across else None
    scene = Scene(belt_speed=belt_speed, normal_load=normal_load, slip=slip, transverse_slip=other)
    state = steady_state(scene, law, "shooting", _TOLERANCE)
    motion = state.motion
    if state.status == "not_unique" and isinstance(law, BristleLaw):
        return _elastic(law.under_load(normal_load), pair, frequency, count)
    if state.status == "not_unique" and isinstance(law, MemoryLaw):
        orbit = MemoryPoint(scene, law, _TOLERANCE).orbit_from_rest()
        motion = OrbitOf(lambda _: orbit, scene, law)
    found = [motion and motion.harmonics(count, across) for across in (False, True)]
    if not all(found):
        raise ValueError(f"describing_function: {state.reason}")
    return np.array([_phasors(each) for each in found if each])


def _degrees(amplitude: complex) -> float:
    return math.degrees(cmath.phase(amplitude))


def _phasors(parts: HarmonicParts) -> Complexes:
    """Of friction; its phase is not known where it is none."""
    turn = np.exp(1j * np.radians(np.nan_to_num(parts.friction_phase[1:])))
    return np.asarray(parts.friction_amplitude[1:] * turn)


def _elastic(law: BristleLaw, pair: Complexes, frequency: float, count: int) -> Complexes:
    """Of deflections that follow a slip about rest, about no deflection: any other mean changes no harmonic."""
    theta = np.arange(_SAMPLES * count) * (2.0 * math.pi / (_SAMPLES * count))
    slips, deflections = (
        (each[:, None] * np.exp(1j * theta)).imag for each in (pair, pair / (1j * frequency))
    )
    if pair[1]:
        both = slips[0] + 1j * slips[1], deflections[0] + 1j * deflections[1]
        friction = [bristle_in_the_plane(law, v, z)[1] for v, z in np.transpose(both).tolist()]
    else:
        friction = [
            bristle_on_the_line(law, v, z)[1] for v, z in np.transpose([slips[0], deflections[0]]).tolist()
        ]
    turns = np.exp(-1j * np.outer(theta, np.arange(1, count + 1)))
    return np.asarray(2j / theta.size * np.array([np.real(friction), np.imag(friction)]) @ turns)
