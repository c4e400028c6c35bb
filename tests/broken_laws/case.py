"""A seeded bug: a law with one mistake in it, its twin without, and the check meant to catch it."""

from __future__ import annotations

from dataclasses import dataclass

from frictionlab.laws.base import FrictionLaw


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
