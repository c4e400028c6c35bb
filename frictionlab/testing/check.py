"""What a check is: a name, a sentence, the laws it is for, and a body that draws an example and judges it."""

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
    """One thing that holds for every law it is for.

    name: of a few words with underscores, as ``expected_failures`` takes it. about: what holds, in a sentence.
    skips: why a law needs no such check, or ''. share: of the examples asked for, below one where examples are dear;
    0 for what is looked at once. seldom: what it means where no parameters drawn let the check run. declares: the
    method by which a law says that it is for it; one that leaves it as its base has it needs no check. after: judges
    what all examples noted. patience: how many times the time limit it may take.
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

    def needless(self, law: type[FrictionLaw]) -> str:
        """Why this law needs no such check, or ''."""
        if reason := self.skips(law):
            return reason
        return self.seldom if self.declares and _owner(law, self.declares) in BASES else ""


def _owner(law: type[FrictionLaw], method: str) -> type:
    """The class that a law has a method from."""
    return next(kind for kind in law.__mro__ if method in vars(kind))


def for_every_law(law: type[FrictionLaw]) -> str:
    """No reason to skip."""
    return ""


def for_laws_of(*kinds: Any, without: str) -> Skips:
    """For laws of these kinds; ``without`` is why the others need it not."""
    return lambda law: "" if issubclass(law, kinds) else without


def make_check(name: str, *, skips: Skips = for_every_law, **told: Any) -> Callable[[CheckFunction], Check]:
    """Make a check of a body; its docstring is what the check is about, ``told`` the fields of Check."""

    def made(body: CheckFunction) -> Check:
        return Check(name, " ".join((body.__doc__ or "").split()), body, skips, **told)

    return made
