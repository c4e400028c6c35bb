"""One example of a check: what was drawn for it, by name, and what is required of it.

The record of a check: its name, a sentence, the laws it applies to, and a function that tests one example.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from hypothesis import assume
from hypothesis import strategies as st
from pydantic import ValidationError

from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw
from frictionlab.testing import strategies
from frictionlab.testing.contact import (
    ContactMemory,
    Response,
    deflection_scale,
    no_plane,
    response,
    rounding_noise,
)


class Violation(AssertionError):
    """Failure of a law; the message says what it did."""


class Given:
    """An example: its law, drawn from the law's own limits, and whatever else a check draws."""

    def __init__(self, law: type[FrictionLaw], draw: Callable[..., Any], notes: set[str]) -> None:
        self.kind = law
        self.notes = notes  # what the examples of one check found so far
        self._draw = draw
        self.drawn: dict[str, Any] = {}

    def draw(self, name: str, strategy: st.SearchStrategy[Any]) -> Any:
        """A value, kept under its name for the counterexample."""
        self.drawn[name] = value = self._draw(strategy)
        return value

    def law(self, when: Callable[[Any], bool] = lambda law: True) -> Any:
        """A law of any parameters for which this holds."""
        law = self.draw("law", strategies.loaded_laws(self.kind))
        assume(when(law))
        return law

    def law_near_the_edge(self, when: Callable[[Any], bool]) -> Any:
        """Same, one number of it often driven to where this only just holds: bounds are wrong there first."""
        law = self.law(when)
        edges = {name: edge for name in _numbers(law) if (edge := _at_the_edge(law, name, when)) is not None}
        name = self.draw("parameter driven to the edge", st.sampled_from(["", *edges]))
        self.drawn["law"] = law = edges.get(name, law)
        return law

    def planar_law(self, when: Callable[[Any], bool] = lambda law: True) -> Any:
        """Return the same with a meaning in the plane."""
        return self.law(lambda law: not no_plane(law) and when(law))

    def slip(self) -> float:
        """A slip velocity on the line, twelve decades of it."""
        signed = st.builds(lambda s, v: s * v, strategies.signs, strategies.speeds)
        return float(self.draw("slip velocity", signed))

    def planar_slip(self, name: str = "slip velocity") -> complex:
        """A slip velocity in the plane."""
        turned = st.builds(lambda v, t: v * t, strategies.speeds, strategies.directions)
        return complex(self.draw(name, turned))

    def in_the_plane(self, law: FrictionLaw) -> bool:
        """Draw whether the plane is asked about, where the law has a meaning there."""
        return not no_plane(law) and bool(self.draw("in the plane", st.booleans()))

    def motion(self, law: FrictionLaw, planar: bool = False) -> tuple[Any, ContactMemory]:
        """A slip velocity and a memory that the law can have."""
        return self.planar_slip() if planar else self.slip(), self.memory(law, planar)

    def memory(self, law: FrictionLaw, planar: bool = False) -> ContactMemory:
        """A memory that the law can have."""
        directions = strategies.directions if planar else st.just(1.0)
        vectors = st.builds(lambda share, turn: share * turn, strategies.shares, directions)
        if isinstance(law, BristleLaw):
            return (self.draw("deflection", vectors.map(lambda share: share * deflection_scale(law))),)
        if isinstance(law, MemoryLaw):
            return self._memories(law, vectors if law.memory_kind == "deflections" else None)
        return ()

    def _memories(self, law: MemoryLaw, vectors: st.SearchStrategy[Any] | None) -> ContactMemory:
        """Each that of steady sliding at some speed, deflections by any share of it and in any direction."""
        speed = self.draw("speed slid at before", strategies.speeds)
        steady = [law.steady(speed, k) for k in range(law.count())]
        if vectors is None:
            return tuple(steady)
        shares = self.draw("shares of steady deflections", st.tuples(*[vectors for _ in steady]))
        return tuple(share * each for share, each in zip(shares, steady, strict=True))

    def require(self, holds: bool, what: str, **seen: Any) -> None:
        """Raise Violation, with the numbers seen, unless this holds."""
        if not holds:
            numbers = ", ".join(f"{name} {_short(value)}" for name, value in seen.items())
            raise Violation(f"{what}: {numbers}" if numbers else what)

    def require_same(
        self, law: FrictionLaw, at: tuple[Any, ContactMemory], got: Response, should: Response, what: str
    ) -> None:
        """Two responses differ by rounding alone, against their terms and what rounding of the arguments does."""
        v, memory = at
        base, own = response(law, v, memory), rounding_noise(law, v, memory)
        pairs = zip(got.rates, should.rates, base.rates, own.rates, strict=True)
        for k, (a, b, rate, rounding) in enumerate(pairs):
            room = 1e-12 * (abs(rate) + _scale(law, v)) + 20.0 * rounding
            self.require(abs(a - b) <= room, f"{what}: rate of memory {k}", got=a, expected=b)
        room = 1e-12 * (abs(base.friction) + law.sliding_friction(abs(v))) + 20.0 * own.friction
        gap = abs(got.friction - should.friction)
        self.require(gap <= room, f"{what}: friction", got=got.friction, expected=should.friction)

    def told(self) -> str:
        """Return the numbers drawn, in one line."""
        return ", ".join(f"{name} {_short(value)}" for name, value in self.drawn.items())


def _numbers(law: FrictionLaw) -> list[str]:
    return [name for name, value in law if isinstance(value, float)]


def _at_the_edge(law: FrictionLaw, name: str, when: Callable[[Any], bool]) -> FrictionLaw | None:
    """Law with one number so large or small that the condition only just holds; None if there is no such one."""
    value = getattr(law, name)
    for end in (1e6 * value, 1e-6 * value):
        beyond = _changed(law, name, end)
        if beyond is not None and not when(beyond):
            return _between(law, name, (value, end), when)
    return None


def _between(
    law: FrictionLaw, name: str, ends: tuple[float, float], when: Callable[[Any], bool]
) -> FrictionLaw:
    """Return where the condition only just holds, by bisection from where it does to where it does not."""
    inside, outside = ends
    best = law
    for _ in range(40):
        middle = math.sqrt(inside * outside)
        tried = _changed(law, name, middle)
        if tried is not None and when(tried):
            inside, best = middle, tried
        else:
            outside = middle
    return best


def _changed(law: FrictionLaw, name: str, value: float) -> FrictionLaw | None:
    try:
        return law.model_validate(law.model_dump(exclude_none=True) | {name: value})
    except ValidationError:
        return None


def _scale(law: FrictionLaw, v: Any) -> float:
    """Deflections move with the slip: their rates are differences of terms of its size."""
    return abs(v) if isinstance(law, BristleLaw) or getattr(law, "memory_kind", "") == "deflections" else 0.0


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, complex):
        return f"{value.real:.6g}{value.imag:+.6g}i"
    if isinstance(value, FrictionLaw):
        parameters = ", ".join(f"{name}={_short(given)}" for name, given in value if given is not None)
        return f"{type(value).__name__}({parameters})"
    if isinstance(value, tuple):
        return f"({', '.join(map(_short, value))})"
    return str(value)


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
