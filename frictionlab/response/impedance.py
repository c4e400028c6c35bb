"""The impedance of a contact: change of friction per change of slip velocity."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.response.linearized import linearized
from frictionlab.runner.arguments import given_law


def impedance(
    law: FrictionLaw,
    belt_speed: ArrayLike,
    frequencies: ArrayLike,
    plot: bool = False,
    *,
    across: bool = False,
) -> Any:
    """Complex change of the friction coefficient per change of slip velocity, about steady sliding on the belt.

    Z [1/velocity], one for each frequency, in the units of the law, for changes as exp(i frequency time): a real part
    above 0 damps, an imaginary part above 0 is inertia, below 0 stiffness.

    belt_speed [velocity]: of steady sliding; 0: about rest, at an undeflected bristle.
    frequencies [rad/time]: circular; an array of belt speeds is broadcast against them.
    plot: whether to return the figure, Bode and Nyquist, instead of the numbers.
    across: whether slip and friction change across the belt, in the plane.

    Z = f_v + f_z (i frequency - r_z)^-1 r_v, with derivatives of friction f and of the rate r of what is remembered,
    each by differences extrapolated to zero; 0 in sliding where friction depends on the path alone (Dahl, Jenkins).
    LuGre in closed form: Canudas de Wit et al. (1995), IEEE TAC 40, 419, linearized.

    >>> import frictionlab as fl
    >>> law = fl.LuGre(mu_kinetic=0.3, mu_static=0.4, stribeck_speed=2, stiffness=40, damping=1)
    >>> fl.impedance(law, 2, [0, 1, 100]).round(4)
    array([-0.0368+0.j    , -0.0368-0.0008j, -0.0641-0.065j ])

    Raises ValueError where there is no steady sliding or the law has a corner there, ValueError or TypeError for what
    makes no sense.
    """
    law = given_law(law)
    speeds, circular = np.broadcast_arrays(
        finite("belt_speed", belt_speed), finite("frequencies", frequencies)
    )
    found = np.empty(circular.shape, complex)
    for speed in np.unique(np.abs(speeds)).tolist():
        here = np.abs(speeds) == speed
        found[here] = linearized(law, speed, across).impedance(1j * circular[here])
    if not plot:
        return found[()]
    from frictionlab.charts.impedance import impedance_figure  # imports matplotlib: only where it is needed

    return impedance_figure(speeds, circular, found)


def finite(name: str, values: ArrayLike) -> Floats:
    """The values of an argument of this name as an array. Raises ValueError."""
    given = np.asarray(values)
    if given.dtype.kind not in "iuf" or not given.size or not np.isfinite(given).all():
        raise ValueError(f"{name} must be finite numbers, got {values!r}")
    return given.astype(np.float64)
