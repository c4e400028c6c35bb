"""The record of a check: its name, a sentence, the laws it applies to, and a function that tests one example."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw
from frictionlab.testing.example import Given

CheckFunction = Callable[[Given], None]
Skips = Callable[[type[FrictionLaw]], str]
BASES = (FrictionLaw, SlidingLaw, BristleLaw, MemoryLaw)


@dataclass(frozen=True)
class Check:
    """A property of every law to which the check applies.

    name: a few words with underscores, as used in ``expected_failures``. about: the property, in a sentence.
    skips: why a law does not need the check, or ''. share: fraction of the examples to run, below one where examples
    are slow; 0 for a single one. seldom: the reason to skip if no drawn parameters let the check run. declares: the
    method by which a law declares the property; a law that does not override it needs no check. after: tests what all
    examples noted. patience: factor on the time limit. change: what to change in a law that fails.
    """

    name: str
    about: str
    body: CheckFunction
    skips: Skips
    share: float = 1.0
    seldom: str = ""
    declares: str = ""
    after: CheckFunction | None = None
    patience: float = 1.0
    change: str = "correct the method"

    def needless(self, law: type[FrictionLaw]) -> str:
        """Why this law does not need the check, or ''."""
        if reason := self.skips(law):
            return reason
        if not self.declares:
            return ""
        owner = next(kind for kind in law.__mro__ if self.declares in vars(kind))
        return f"{self.declares}() is not declared" if owner in BASES else ""


def for_laws_of(*kinds: Any, without: str) -> Skips:
    """For laws of these classes; ``without`` is the reason to skip others."""
    return lambda law: "" if issubclass(law, kinds) else without


def law_check(*, skips: Skips = lambda law: "", **told: Any) -> Callable[[CheckFunction], Check]:
    """Make a check of a function: its name is the check's, its docstring what it is about; told: fields of Check."""

    def made(body: CheckFunction) -> Check:
        return Check(body.__name__, " ".join((body.__doc__ or "").split()), body, skips, **told)

    return made
