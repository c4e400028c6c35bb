"""Closed forms of vibrated friction, with the numbers of their equations.

Velocities are in the scale of the scene (omega_1 L). A mean friction is relative to the friction coefficient
of steady sliding.
"""

from __future__ import annotations

from frictionlab.theory.linear import friction_free_velocity
from frictionlab.theory.loops import (
    coulomb_describing_function,
    dahl_describing_function,
    dahl_drift,
    dahl_loop_area,
    dahl_loop_end,
    dahl_path,
    jenkins_describing_function,
)
from frictionlab.theory.one_harmonic import (
    CONCAVE_BY_AREA,
    CONCAVE_BY_INITIAL_CURVATURE,
    chord_area_at_resonance,
    initial_concavity,
    one_harmonic_least_ratio,
    one_harmonic_velocity,
)
from frictionlab.theory.prescribed import (
    mean_prescribed_circular,
    mean_prescribed_longitudinal,
    mean_prescribed_pulsating,
    mean_prescribed_transverse,
    mean_soft_circular,
    mean_soft_dahl,
    mean_soft_elasto_plastic,
    mean_soft_jenkins,
    mean_soft_transverse,
    reversal_kick,
    slip_back_and_forth,
    stiff_correction,
)
from frictionlab.theory.sliding_stability import SteadySliding
from frictionlab.values.quantities import Floats

__all__ = [
    "CONCAVE_BY_AREA",
    "CONCAVE_BY_INITIAL_CURVATURE",
    "Floats",
    "SteadySliding",
    "chord_area_at_resonance",
    "coulomb_describing_function",
    "dahl_describing_function",
    "dahl_drift",
    "dahl_loop_area",
    "dahl_loop_end",
    "dahl_path",
    "friction_free_velocity",
    "initial_concavity",
    "jenkins_describing_function",
    "mean_prescribed_circular",
    "mean_prescribed_longitudinal",
    "mean_prescribed_pulsating",
    "mean_prescribed_transverse",
    "mean_soft_circular",
    "mean_soft_dahl",
    "mean_soft_elasto_plastic",
    "mean_soft_jenkins",
    "mean_soft_transverse",
    "one_harmonic_least_ratio",
    "one_harmonic_velocity",
    "reversal_kick",
    "slip_back_and_forth",
    "stiff_correction",
]
