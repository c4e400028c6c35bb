"""The columns of the result table: one place for their names, their order and what they mean."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

INPUTS: dict[str, str] = {
    "law": "label of the law",
    "kind": "registered name of the law",
    "method": "label of the method",
}
"""The first columns; ``scene.<path>`` for every scene value and ``law.<parameter>`` for every law follow."""

RESULTS: dict[str, str] = {
    "mean_friction": "steady-state mean of the friction coefficient along x1, positive for belt_speed > 0",
    "error": "bound on the absolute error of mean_friction against the scene as stated",
    "error_kind": "guaranteed (proved) or estimated",
    "status": "ok, refused, failed, not_unique or killed",
    "reason": "why, where the status is not plainly ok",
    "mean_low": "smallest mean seen where the steady state is not unique",
    "mean_high": "largest mean seen where the steady state is not unique",
    "window": "periods averaged for mean_low and mean_high",
    "mean_friction_transverse": "time mean of the friction coefficient along x2",
    "velocity_amplitude": "half the peak-to-peak value of x1'",
    "velocity_harmonic": "amplitude of the first harmonic of x1'",
    "velocity_phase": "phase of that harmonic against the load along x1, in degrees, + = lead",
    "transverse_velocity_amplitude": "half the peak-to-peak value of x2'",
    "transverse_velocity_harmonic": "amplitude of the first harmonic of x2'",
    "transverse_velocity_phase": "phase of that harmonic against the load along x1, in degrees, + = lead",
    "stick_fraction": "share of the period in stick",
    "reversals": "sign changes of the slip velocity along x1, per period",
    "force_reversals": "sign changes of the friction force along x1, per period",
    "energy_input": "work of the loads, per period of the response",
    "energy_viscous": "loss in the dashpots, per period",
    "energy_friction": "what friction takes from the mass, per period",
    "energy_contact": "heat in the contact, per period",
    "period": "period of the response in drive periods, of an undriven one in units of 2 pi",
    "floquet": "largest modulus of the Floquet multipliers, without the trivial one of an undriven orbit",
    "normalized_friction": "mean_friction / steady sliding friction at the belt speed",
    "velocity_ratio": "belt_speed / V_lin, the friction-free velocity amplitude",
    "friction_to_drive": "friction coefficient * normal_load / force amplitude",
    "presliding_ratio": "presliding length * frequency / V_lin",
    "model": "what produced the number, and for auto why",
    "seconds": "kernel time",
}
"""The columns after the inputs, in the order of the table, with one line each."""


class InSI(NamedTuple):
    """A result column in SI units: the column it is made of, the scale that multiplies it, what it means."""

    column: str
    scale: str
    meaning: str


SI: dict[str, InSI] = {
    "mean_friction_N": InSI("mean_friction", "load", "mean friction force along x1 [N]"),
    "error_N": InSI("error", "load", "bound on the absolute error of mean_friction_N [N]"),
    "mean_friction_transverse_N": InSI(
        "mean_friction_transverse", "load", "mean friction force along x2 [N]"
    ),
    "velocity_amplitude_m_per_s": InSI("velocity_amplitude", "velocity", "velocity_amplitude [m/s]"),
    "velocity_harmonic_m_per_s": InSI("velocity_harmonic", "velocity", "velocity_harmonic [m/s]"),
    "transverse_velocity_amplitude_m_per_s": InSI(
        "transverse_velocity_amplitude", "velocity", "transverse_velocity_amplitude [m/s]"
    ),
    "transverse_velocity_harmonic_m_per_s": InSI(
        "transverse_velocity_harmonic", "velocity", "transverse_velocity_harmonic [m/s]"
    ),
    "energy_input_J": InSI("energy_input", "energy", "work of the loads, per period of the response [J]"),
    "energy_viscous_J": InSI("energy_viscous", "energy", "loss in the dashpots, per period [J]"),
    "energy_friction_J": InSI(
        "energy_friction", "energy", "what friction takes from the mass, per period [J]"
    ),
    "energy_contact_J": InSI("energy_contact", "energy", "heat in the contact, per period [J]"),
    "period_s": InSI("period", "drive period", "period of the response [s]"),
}
"""The columns at the end of the table of a scene given in SI units."""

BELT_SPEED = "scene.belt_speed"
_GIVEN_IN_SI = "scene.dimensional."
BELT_SPEEDS = (BELT_SPEED, f"{_GIVEN_IN_SI}belt_speed_m_per_s")
"""What runs along a curve, in either scale."""
SCALED = "law.nondimensional."
"""What the columns begin with that hold the parameters of a law given in SI units in the scale of the scene."""


def belt_speed(names: Iterable[str]) -> str:
    """The column of the belt speed as it was given."""
    return BELT_SPEEDS[1] if BELT_SPEEDS[1] in names else BELT_SPEEDS[0]


def given(names: Iterable[str]) -> list[str]:
    """The columns of scene and law values as they were given: those in SI units instead of those made from them."""
    columns = [name for name in names if name.startswith(("scene.", "law.")) and not name.startswith(SCALED)]
    in_si = [name for name in columns if name.startswith((_GIVEN_IN_SI, "law."))]
    return in_si if belt_speed(columns) != BELT_SPEED else columns


def results(names: Sequence[str]) -> list[str]:
    """The result columns of a table with these inputs."""
    return [*RESULTS, *SI] if belt_speed(names) != BELT_SPEED else [*RESULTS]


CURVES: dict[str, str] = {
    "reversal_end": "belt speed above which slip neither reverses nor sticks",
    "reversal_end_error": "bound on its error",
    "shape_area": "signed area between the curve and its chord up to there, > 0 above the chord: concave",
    "shape_area_error": "bound on its error",
    "shape_half": "mean friction at half that belt speed over mean friction there",
    "shape_half_error": "bound on its error",
    "shape_initial": "curvature at rest, in shares of that belt speed and of mean friction there",
    "shape_initial_error": "bound on its error",
    "shape": "verdict by area: concave, convex, mixed or undecided",
    "shape_by_initial": "verdict by the curvature at rest: concave, convex or undecided",
    "reduction": "largest fall of mean friction below that of steady sliding",
    "reduction_error": "bound on its error",
    "reason": "why a measure is empty",
}
"""The columns of the table of curves after the inputs."""

SHAPES: dict[str, tuple[str, ...]] = {
    "area": ("concave", "convex", "mixed", "undecided"),
    "initial": ("concave", "convex", "undecided"),
}
"""Measures of shape and the verdicts each can give."""

TEXT: frozenset[str] = frozenset({"error_kind", "status", "reason", "model"})
"""The result columns that hold text; every other one holds a number, empty where it does not apply."""

STATUSES: tuple[str, ...] = ("ok", "refused", "failed", "not_unique", "killed")
