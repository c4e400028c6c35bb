"""The campaigns by name; each is imported where it is asked for."""

from __future__ import annotations

from importlib import import_module

from campaign import Campaign

KINDS = {
    "bristles": "bristle laws against LSODA on the interpreted law",
    "undriven": "contacts with memory that nothing drives, against LSODA",
    "exact": "Coulomb friction on the line over decades, against tests/outside_state.py",
    "varying": "waveforms, vibrating belts and changing normal loads by exact, against the same",
    "every_kind": "every kind of scene and law by auto, against the same",
    "convergent": "scenes of theorem T1 from three starts by the same: one answer, which auto's error covers",
    "marched": "every kind of scene and law, marched, against shooting or the same",
    "near_rest": "planar scenes that are hard near rest, by shooting",
    "planar_curves": "curves in the plane, whose points are solved together, against each alone at 1e-12",
    "multipliers": "floquet of every law against central differences of fine period maps over three shifts",
    "sensitivities": "derivatives of the mean friction against differences of steady states",
    "onsets": "onsets of curves of 40 points against scans five times as dense",
    "reduced": "mdsm and harmonic_balance against exact and shooting",
    "chosen_speeds": "chosen belt speeds against the curve itself",
    "proofs": "proofs of exact's means against its estimates",
    "steep_falls": "friction that falls faster than damping makes up for: whether what is ok is alone",
}
"""Name of the campaign, a module beside this one -> what it is about."""


def campaign_of(kind: str) -> Campaign:
    """The campaign of this name."""
    found: Campaign = import_module(f"drawers.{kind}").CAMPAIGN
    return found
