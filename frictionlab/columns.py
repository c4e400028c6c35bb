"""The columns of the result table: one place for their names, their order and what they mean."""

from __future__ import annotations

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
    "period": "period of the response in drive periods",
    "floquet": "largest modulus of the Floquet multipliers",
    "normalized_friction": "mean_friction / steady sliding friction at the belt speed",
    "velocity_ratio": "belt_speed / V_lin, the friction-free velocity amplitude",
    "friction_to_drive": "friction coefficient * normal_load / force amplitude",
    "presliding_ratio": "presliding length * frequency / V_lin",
    "model": "what produced the number, and for auto why",
    "seconds": "kernel time",
}
"""The columns after the inputs, in the order of the table, with one line each."""

TEXT: frozenset[str] = frozenset({"error_kind", "status", "reason", "model"})
"""The result columns that hold text; every other one holds a number, empty where it does not apply."""

STATUSES: tuple[str, ...] = ("ok", "refused", "failed", "not_unique", "killed")
