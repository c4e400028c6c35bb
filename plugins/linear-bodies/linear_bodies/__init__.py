"""Steady states of any linear body under Coulomb friction, from its frequency response."""
