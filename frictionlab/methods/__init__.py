"""Ways to find a steady state, one per file."""

from __future__ import annotations
