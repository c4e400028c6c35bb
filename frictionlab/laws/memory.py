"""Laws that remember more than one bristle deflection: several deflections, or scalars such as a contact's age.

A law names how many numbers it remembers and gives each of them its rate; methods keep them in an array. Written
once, as every law: interpreted and compiled, on the line and in the plane.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Any, ClassVar, Literal

from frictionlab.laws.base import FrictionLaw


class MemoryLaw(FrictionLaw, ABC):
    """A law whose memory is a fixed number of numbers, all of one kind.

    memory_kind: ``deflections`` [scene length] turn round and turn with the slip: ``float`` on the line and
    ``complex`` (x1 + i x2) in the plane, as the slip velocity. ``scalars`` know no direction: ``float`` everywhere.
    """

    memory_kind: ClassVar[Literal["deflections", "scalars"]] = "deflections"

    @abstractmethod
    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """Rate of the k-th memory [its unit/scene time] at slip velocity ``v``; ``memory`` is indexed by 0, 1, ..."""

    @abstractmethod
    def friction(self, v: Any, memory: Any, rates: Any) -> Any:
        """Friction coefficient [-] along ``v`` that resists slip, at a memory that moves at ``rates``."""

    @property
    def turning(self) -> float:
        """``memory_kind`` as kernels know it: 1 for deflections, 0 for scalars."""
        return 1.0 if self.memory_kind == "deflections" else 0.0

    def structure(self) -> tuple[str, ...]:
        """Which kind of memory it is."""
        return (self.memory_kind,)

    def count(self) -> int:
        """How many numbers the law remembers."""
        return 1

    def steady(self, v: Any, k: int) -> Any:
        """The k-th memory in steady sliding at slip velocity ``v`` (not zero); zero where a law does not say."""
        return 0.0 * v

    def stored(self, memory: Any) -> float:
        """The work [scene length, per unit load] that the memory can give back; used where a law is passive."""
        return 0.0

    def within(self, memory: Any) -> bool:
        """Whether the memory lies in the set that no slip history leaves."""
        return True

    def largest_rate(self, speed: float) -> float:
        """Largest modulus of d(rate)/d(memory) [1/scene time] at this slip speed; infinite where none is known."""
        return math.inf

    def rate_independent(self) -> bool:
        """Whether friction depends on the path of the slip alone, not on how fast it is travelled."""
        return False

    def passive(self) -> bool:
        """Whether the work of friction from any slip history is at least minus what was ``stored``."""
        return False
