"""Conformance battery any friction law must pass: ``check_law(MyLaw)`` in Python or in one line of a test."""

from __future__ import annotations

from frictionlab.testing.battery import CHECKS, EXAMPLES, check_law
from frictionlab.testing.example import Check
from frictionlab.testing.running import LawFailed, Outcome, Report, heading

__all__ = ["CHECKS", "EXAMPLES", "Check", "LawFailed", "Outcome", "Report", "check_law", "heading"]
