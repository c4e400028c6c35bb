"""What every friction law is: a frozen record of parameters with its physics as ordinary methods.

The same methods run interpreted (with the record itself as ``self``) and compiled (with a named tuple of its
numbers as ``self``), and on the line (``float`` slip velocity) and in the plane (``complex``: x1 + i x2).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, ClassVar, Self

from frictionlab.quantities import Dimension, Finite, NonNegative, PerSpeed, Positive, Record, Speed

__all__ = [
    "Dimension",
    "Finite",
    "FrictionLaw",
    "NonNegative",
    "PerSpeed",
    "Positive",
    "Record",
    "SlidingLaw",
    "Speed",
]


Number = float | int | tuple[float, ...]
"""What a law may know its parameters by: a number, a whole number to count with, numbers to choose from by index."""


class FrictionLaw(Record, ABC):
    """A law of dry friction: the friction coefficient, per unit normal load, that resists slip.

    Its docstring names its sources as in "Source: Dahl (1968)". ``bibtex`` holds their BibTeX entries as one string,
    but for those of frictionlab's own bibliography; without an entry, what follows "Source:" is cited as it stands.
    ``expected_failures`` names checks of the conformance battery that the law fails, and why it must.
    """

    bibtex: ClassVar[str] = ""
    expected_failures: ClassVar[Mapping[str, str]] = MappingProxyType({})

    @abstractmethod
    def sliding_friction(self, speed: float) -> float:
        """Friction coefficient [-] at steady sliding with this speed (>= 0) [scene length / scene time]."""

    def sliding_vector(self, v: complex) -> complex:
        """Friction coefficient [-] at steady sliding, along the slip velocity ``v`` (not zero).

        Isotropic: it points along ``v``. ``float`` in, ``float`` out; ``complex`` in, ``complex`` out.
        """
        speed = abs(v)
        return (self.sliding_friction(speed) / speed) * v  # one division fewer than along v / speed

    def under_load(self, normal_load: float) -> Self:
        """The same law per unit of this normal load [scene force]: parameters of the contact become per unit load."""
        return self

    def constant_sliding_friction(self) -> bool:
        """Whether ``sliding_friction`` is the same number at every speed."""
        return False

    def steepest_fall(self) -> float:
        """Largest rate at which sliding friction falls as speed grows [1/scene velocity], rest included.

        Slower than the damping can make up for, no law without memory has more than one steady state. Infinite where
        it may jump.
        """
        return 0.0 if self.constant_sliding_friction() else math.inf

    def monotone(self) -> bool:
        """Whether friction never falls as slip grows: (T(v) - T(w)).(v - w) >= 0, rest included.

        With constant normal load and damping the steady state is then unique (Leine & van de Wouw, 2008).
        """
        return False

    def structure(self) -> tuple[str, ...]:
        """What about the parameters decides which kernels are compiled, in words."""
        return ()

    def numbers(self) -> dict[str, Number]:
        """The parameters as the kernels see them: every number, whole number, tuple of numbers, and every property.

        A number that may be left out (``None``) is for a property to read: the kernels of a law are then the same
        whether it is given or not. To kernels a tuple is an array: ask for its ``len`` and index it.
        """
        required = {name for name, field in type(self).model_fields.items() if field.default is not None}
        fields = {name: value for name, value in self if name in required and _is_number(value)}
        return fields | {name: _number(getattr(self, name)) for name in _properties(type(self))}


class SlidingLaw(FrictionLaw, ABC):
    """A law without memory: friction is set by the slip velocity, and is set-valued at rest.

    At rest any vector up to the static coefficient is allowed; resolving that is the method's business.
    """

    def static_friction(self) -> float:
        """Friction coefficient [-] that slip must overcome to begin; not below ``sliding_friction(0)``."""
        return self.sliding_friction(0.0)

    def steepest_fall(self) -> float:
        """None where friction is monotone."""
        return 0.0 if self.monotone() else math.inf


def _is_number(value: object) -> bool:
    if isinstance(value, tuple):
        return all(isinstance(each, float) for each in value)
    return isinstance(value, float | int) and not isinstance(value, bool)


def _number(value: Any) -> Number:
    """A property as kernels see it; what is neither a whole number nor several numbers is ``float``."""
    if isinstance(value, tuple):
        return tuple(float(each) for each in value)
    return value if isinstance(value, int) and not isinstance(value, bool) else float(value)


def _properties(law: type[FrictionLaw]) -> list[str]:
    """The names of what a law derives from its parameters, its own and those of its bases."""
    own = [name for kind in law.__mro__ if issubclass(kind, FrictionLaw) for name in vars(kind)]
    return [name for name in dict.fromkeys(own) if isinstance(getattr(law, name), property)]
