"""Bristle laws as kernels call them, on the line and in the plane."""

from __future__ import annotations

from frictionlab.kernel import by_dimension
from frictionlab.laws.bristle import in_the_plane, on_the_line

resistance = by_dimension(on_the_line, in_the_plane)
"""(law, slip velocity, deflection) -> (rate of deflection, friction coefficient), interpreted and compiled."""
