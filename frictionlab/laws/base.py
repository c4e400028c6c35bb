"""What every friction law is: a frozen record of parameters with its physics as ordinary methods.

The same methods run interpreted (with the record itself as ``self``) and compiled (with a named tuple of its
numbers as ``self``), and on the line (``float`` slip velocity) and in the plane (``complex``: x1 + i x2).
"""

from __future__ import annotations

from abc import ABC, abstractmethod

from frictionlab.quantities import Finite, NonNegative, Positive, Record

__all__ = ["Finite", "FrictionLaw", "NonNegative", "Positive", "Record", "SlidingLaw"]


class FrictionLaw(Record, ABC):
    """A law of dry friction: the friction coefficient, per unit normal load, that resists slip."""

    @abstractmethod
    def sliding_friction(self, speed: float) -> float:
        """Friction coefficient [-] at steady sliding with this speed (>= 0) [scene length / scene time]."""

    def sliding_vector(self, v: complex) -> complex:
        """Friction coefficient [-] at steady sliding, along the slip velocity ``v`` (not zero).

        Isotropic: it points along ``v``. ``float`` in, ``float`` out; ``complex`` in, ``complex`` out.
        """
        speed = abs(v)
        return (self.sliding_friction(speed) / speed) * v  # one division fewer than along v / speed

    def constant_sliding_friction(self) -> bool:
        """Whether ``sliding_friction`` is the same number at every speed."""
        return False

    def monotone(self) -> bool:
        """Whether friction never falls as slip grows: (T(v) - T(w)).(v - w) >= 0, rest included.

        With constant normal load and damping the steady state is then unique (Leine & van de Wouw, 2008).
        """
        return False

    def numbers(self) -> dict[str, float]:
        """The parameters as the kernels see them: every numeric field that has a value."""
        return {name: float(value) for name, value in self if isinstance(value, float)}


class SlidingLaw(FrictionLaw, ABC):
    """A law without memory: friction is set by the slip velocity, and is set-valued at rest.

    At rest any vector up to the static coefficient is allowed; resolving that is the method's business.
    """
