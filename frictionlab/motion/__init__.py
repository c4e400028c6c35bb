"""Equation of motion, steppers, the map of one period and the orbit of a steady state."""

from __future__ import annotations
