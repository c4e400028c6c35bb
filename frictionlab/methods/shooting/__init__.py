"""Shooting: fixed points of the period map for any law."""
