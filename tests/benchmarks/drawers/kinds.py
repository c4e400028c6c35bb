"""The campaigns by name; each is imported where it is asked for."""

from __future__ import annotations

from importlib import import_module

from campaign import Campaign

OUTSIDE = {
    "exact": "Coulomb friction on the line over decades (tests/random_scenes.py)",
    "varying": "waveforms, vibrating belts, changing normal loads by exact (tests/varying_scenes.py)",
    "every_kind": "every kind of scene and law by auto at 1e-8 (tests/draws_of_every_kind.py)",
    "convergent": "scenes of theorem T1 from three starts: one answer, which auto's error covers",
    "near_rest": "planar scenes that are hard near rest, by shooting (tests/random_scenes.py)",
}
"""Campaigns against tests/outside_state.py: a constant of ``outside.py``, in capitals -> what it is about."""
KINDS = {
    **OUTSIDE,
    "bristles": "bristle laws against LSODA on the interpreted law",
    "undriven": "contacts with memory that nothing drives, against LSODA",
    "creep": "rate-and-state friction on every kind of scene, against LSODA",
    "planar_curves": "curves in the plane, whose points are solved together, against each alone at 1e-12",
    "multipliers": "floquet of every law against central differences of fine period maps over three shifts",
    "sensitivities": "derivatives of the mean friction against differences of steady states",
    "onsets": "onsets of curves of 40 points against scans ten times as dense",
    "reduced": "mdsm and harmonic_balance against exact and shooting",
    "chosen_speeds": "chosen belt speeds against the curve itself",
    "steep_falls": "friction that falls faster than damping makes up for: whether what is ok is alone",
}
"""Name of the campaign, of the others that of a module beside this one -> what it is about."""


def campaign_of(kind: str) -> Campaign:
    """The campaign of this name."""
    module, name = ("outside", kind.upper()) if kind in OUTSIDE else (kind, "CAMPAIGN")
    found: Campaign = getattr(import_module(f"drawers.{module}"), name)
    return found
