"""One example of a check: what was drawn for it, by name, and what is required of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hypothesis import assume
from hypothesis import strategies as st

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.bristle import BristleLaw
from frictionlab.laws.memory import MemoryLaw
from frictionlab.testing import drawing
from frictionlab.testing.contact import Memory, Response, no_plane, noise, response, size_of


class Violation(AssertionError):
    """What a law must not do; the message says what it did."""


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
        law = self.draw("law", drawing.laws(self.kind))
        assume(when(law))
        return law

    def planar_law(self, when: Callable[[Any], bool] = lambda law: True) -> Any:
        """The same with a meaning in the plane."""
        return self.law(lambda law: not no_plane(law) and when(law))

    def slip(self) -> float:
        """A slip velocity on the line, twelve decades of it."""
        return float(self.draw("slip velocity", st.builds(lambda s, v: s * v, drawing.signs, drawing.speeds)))

    def planar_slip(self) -> complex:
        """A slip velocity in the plane."""
        return complex(
            self.draw("slip velocity", st.builds(lambda v, t: v * t, drawing.speeds, drawing.turns))
        )

    def memory(self, law: FrictionLaw, planar: bool = False) -> Memory:
        """A memory that the law can have."""
        shares = st.floats(-1.0, 1.0).map(lambda share: round(share, 12))  # no denormal numbers
        directions = drawing.turns if planar else st.just(1.0)
        vectors = st.builds(lambda share, turn: share * turn, shares, directions)
        if isinstance(law, BristleLaw):
            if planar and law.planar == "rotated":
                vectors = shares.map(complex)
            return (self.draw("deflection", vectors.map(lambda share: share * size_of(law))),)
        if isinstance(law, MemoryLaw):
            return self._memories(law, vectors if law.memory_kind == "deflections" else None)
        return ()

    def _memories(self, law: MemoryLaw, vectors: st.SearchStrategy[Any] | None) -> Memory:
        """Each that of steady sliding at some speed, deflections by any share of it and in any direction."""
        speed = self.draw("speed slid at before", drawing.speeds)
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
        self, law: FrictionLaw, at: tuple[Any, Memory], got: Response, should: Response, what: str
    ) -> None:
        """Two responses differ by rounding alone, against their terms and what rounding of the arguments does."""
        v, memory = at
        base, own = response(law, v, memory), noise(law, v, memory)
        pairs = zip(got.rates, should.rates, base.rates, own.rates, strict=True)
        for k, (a, b, rate, rounding) in enumerate(pairs):
            room = 1e-12 * (abs(rate) + _scale(law, v)) + 20.0 * rounding
            self.require(abs(a - b) <= room, f"{what}: rate of memory {k}", got=a, expected=b)
        room = 1e-12 * (abs(base.friction) + law.sliding_friction(abs(v))) + 20.0 * own.friction
        gap = abs(got.friction - should.friction)
        self.require(gap <= room, f"{what}: friction", got=got.friction, expected=should.friction)

    def told(self) -> str:
        """The numbers drawn, in one line."""
        return ", ".join(f"{name} {_short(value)}" for name, value in self.drawn.items())


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
