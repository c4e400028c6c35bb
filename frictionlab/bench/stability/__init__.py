"""Stability maps: step or tolerance against local rate, true error, and whether a wrong answer says so."""

from __future__ import annotations

from frictionlab.bench.stability.reader import read_stability

__all__ = ["read_stability"]
