"""A seeded bug: a law with one mistake in it, its twin without, and the check meant to catch it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from frictionlab.laws.base import FrictionLaw
from frictionlab.testing import CHECKS

OF_PYTHON = [each.name for each in CHECKS if each.patience == 1.0]
OF_EVERY_LAW = OF_PYTHON[OF_PYTHON.index("oddness") :]
"""Checks that ``laws/test_laws.py`` puts every law of frictionlab to."""


@dataclass(frozen=True)
class Case:
    """law: with the mistake; twin: the law it is a variation of; check: the one that must fail.

    examples: as many as that needs with some to spare.
    """

    law: type[FrictionLaw]
    twin: type[FrictionLaw]
    check: str
    examples: int = 30

    def __str__(self) -> str:
        return f"{self.law.__name__}-{self.check}"


def bug(name: str, twin: type[FrictionLaw], check: str, *, examples: int = 30, **methods: Any) -> Case:
    """The twin with these methods in place of its own."""
    told = {"__module__": __name__, "__doc__": twin.__doc__}
    return Case(type(name, (twin,), told | methods), twin, check, examples)
