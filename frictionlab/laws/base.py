"""Base classes of friction laws: a frozen record of parameters whose methods state the physics.

The label of a law: the name of its rows in a table, beside its parameters and no part of its physics.

Methods of a law that take one slip speed or, called in Python, an array of them.

The same methods run interpreted (with the record itself as ``self``) and compiled (with a named tuple of its
numbers as ``self``), and on the line (``float`` slip velocity) and in the plane (``complex``: x1 + i x2).
"""

from __future__ import annotations

import inspect
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from functools import partial
from types import FunctionType, MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator

from frictionlab.values.quantities import (
    Dimension,
    Finite,
    NonNegative,
    PerSpeed,
    Positive,
    Record,
    Speed,
    dimensions,
)
from frictionlab.values.units import in_units_of_law, unit_of_dimension

_LABEL = "_label"
"""Where a law holds it: no field and no private attribute of pydantic, so that equal laws are equal and every law is
made as it was."""


class Labelled(Record):
    """A record that may have a ``label``, one line of text, beside its values. Raises ValueError for another."""

    if TYPE_CHECKING:  # type checkers take the signature from the fields
        label: str = ""
    else:

        def __init__(self, /, *without_names: Any, label: str = "", **values: Any) -> None:
            super().__init__(*without_names, **values)
            if not isinstance(label, str) or not label.isprintable() or (label and not label.strip()):
                name = type(self).__name__
                raise ValueError(f"{name}: label must be one line of visible text, got {label!r}")
            vars(self)[_LABEL] = label

        _own, _values = inspect.signature(Record.__init__).parameters.values()
        _label_of = inspect.Parameter("label", inspect.Parameter.KEYWORD_ONLY, default="", annotation=str)
        __init__.__signature__ = inspect.Signature([_own, _label_of, _values])
        __init__.__pydantic_base_init__ = True  # as for Record
        del _own, _label_of, _values

        @property
        def label(self) -> str:
            """The name of its rows; '' where none was given: its registered name then."""
            return vars(self).get(_LABEL, "")

    def __repr_args__(self) -> Any:
        """The values, and the label where there is one."""
        yield from super().__repr_args__()
        if self.label:
            yield "label", self.label


OF_SPEED = "sliding_friction", "sliding_vector"
"""The methods whose one argument is a speed or a slip velocity."""


class OfEach:
    """A method of one number that its law, once made, also takes arrays for; a class has the method itself.

    So compiled code, which asks the class, is what it was.
    """

    def __init__(self, method: FunctionType) -> None:
        self.py_func = method

    def __get__(self, law: Any, kind: type | None = None) -> Callable[..., Any]:
        return self.py_func if law is None else partial(_of_each, self.py_func, law)


def as_written(member: Any) -> Any:
    """A method as its class defines it; anything else as it is."""
    return member.py_func if isinstance(member, OfEach) else member


def _of_each(method: FunctionType, law: Any, given: Any) -> Any:
    if isinstance(given, int | float | complex) or np.ndim(given) == 0:
        return method(law, given)
    numbers = np.asarray(given)
    found = [method(law, number) for number in numbers.ravel().tolist()]
    return np.array(found, dtype=numbers.dtype if numbers.dtype.kind == "c" else float).reshape(numbers.shape)


def accept_arrays(law: type) -> None:
    """Let the methods of a speed that this class defines take arrays."""
    for name in OF_SPEED:
        method = vars(law).get(name)
        if isinstance(method, FunctionType) and not getattr(method, "__isabstractmethod__", False):
            setattr(law, name, OfEach(method))


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
"""A parameter as compiled code receives it: a number, a whole number, or a tuple of numbers to index."""


class FrictionLaw(Labelled, ABC):
    """A law of dry friction: the friction coefficient, per unit normal load, that resists slip.

    ``in_words`` is what figures call it, its label where left out.
    The docstring of a law names its sources as in "Source: Dahl (1968)". ``bibtex`` holds their BibTeX entries as one
    string, except those already in frictionlab's bibliography; a source without an entry is cited as written.
    ``expected_failures`` maps each check of the conformance battery that the law must fail to the reason.
    ``memory_kind`` says what friction depends on beside slip: nothing, the deflection of one bristle, or several
    deflections or scalars; no method solves a law that declares none of them. ``compliant``: whether one bristle has
    a stiffness and a presliding length.

    In a scene in SI units its numbers are in them, and may be text with a unit: ``fl.Dahl(mu=0.3,
    presliding_length="1 um")``.

    >>> import frictionlab as fl
    >>> isinstance(fl.Dahl(mu=0.4, stiffness=40), fl.FrictionLaw)
    True
    >>> fl.Dahl(mu=0.4, stiffness=40).sliding_friction(3.0)
    0.4

    ``sliding_friction`` and ``sliding_vector`` of a law take arrays, too, of any shape:

    >>> fl.Stribeck(mu_kinetic=0.2, mu_static=0.4, curve="hyperbolic").sliding_friction([0, 1, 3])
    array([0.4 , 0.3 , 0.25])
    """

    in_words: ClassVar[str] = ""
    bibtex: ClassVar[str] = ""
    expected_failures: ClassVar[Mapping[str, str]] = MappingProxyType({})
    memory_kind: ClassVar[Literal["undeclared", "none", "bristle", "deflections", "scalars"]] = "undeclared"
    compliant: ClassVar[bool] = False

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        accept_arrays(cls)

    @model_validator(mode="before")
    @classmethod
    def _texts_with_units(cls, data: Any) -> Any:
        """Numbers in SI units in the place of texts such as ``1 um``."""
        if not isinstance(data, Mapping) or not any(isinstance(value, str) for value in data.values()):
            return data
        units = {name: unit_of_dimension(each) for name, each in dimensions(cls).items()}
        texts = {name: value for name, value in data.items() if name in units and isinstance(value, str)}
        return {**data, **{name: in_units_of_law(text, name, units) for name, text in texts.items()}}

    @classmethod
    def _in_order(cls) -> list[str]:
        """Coefficients first, since those of the contact are inherited by several laws."""
        return sorted(super()._in_order(), key=lambda name: not cls.model_fields[name].is_required())

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

    def count(self) -> int:
        """The number of memories."""
        return 0

    def elastic_deflection(self) -> float:
        """Deflection [scene length] up to which it follows the slip in every direction: the contact is elastic."""
        return 0.0

    def planar_form(self) -> Literal["vectorial", "rotated", "per-axis"]:
        """How the law of one direction extends to the plane; as a law of vectors where it does not say."""
        return "vectorial"

    def no_vector_form(self) -> str:
        """Why ``vectorial`` has no meaning for this law, as a sentence; empty where it has one."""
        return ""

    def damps_across(self, speed: float) -> bool:
        """Whether friction never does positive work on a motion across the slip, at slip speeds up to this.

        Spring and contact across then only lose energy, and without a load across the belt x2 decays.
        """
        return self.planar_form() != "rotated"

    def obeys(self, check: str) -> bool:
        """Tell whether the law claims to pass a check of the battery: ``expected_failures`` does not name it.

        A shortcut that rests on a property of laws asks for the check of that property: ``law.obeys("oddness")``.
        """
        return check not in self.expected_failures

    def constant_sliding_friction(self) -> bool:
        """Whether ``sliding_friction`` is the same number at every speed."""
        return False

    def steepest_fall(self) -> float:
        """Largest rate at which sliding friction falls as speed grows [1/scene velocity], rest included.

        If damping outweighs it, a law without memory has exactly one steady state. Infinite where friction may jump.
        """
        return 0.0 if self.constant_sliding_friction() else math.inf

    def monotone(self) -> bool:
        """Whether friction never falls as slip grows: (T(v) - T(w)).(v - w) >= 0, rest included.

        With constant normal load and damping the steady state is then unique (Leine & van de Wouw, 2008).
        """
        return False

    def presliding(self) -> float:
        """The slip [scene length] within which friction turns round after a reversal: 0 where it jumps."""
        return 0.0

    def largest_rate(self, speed: float) -> float:
        """Largest modulus of d(rate)/d(memory) [1/scene time] at this slip speed; it limits explicit steps."""
        return 0.0

    def rate_jumps(self, directions: int) -> bool:
        """Whether the rate of a memory may jump, in so many directions, while slip does not turn round."""
        return False

    def structure(self) -> tuple[str, ...]:
        """The properties of the parameters that select which kernels are compiled, as words."""
        return ()

    def numbers(self) -> dict[str, Number]:
        """The parameters that kernels receive: every number, whole number, tuple of numbers, and every property.

        Optional numbers (default ``None``) are left out: only properties read them, so the kernels of a law do not
        depend on which are given. Kernels receive a tuple as an array: use ``len`` and indices.
        """
        required = {name for name, field in type(self).model_fields.items() if field.default is not None}
        fields = {name: value for name, value in self if name in required and _is_number(value)}
        return fields | {name: _number(getattr(self, name)) for name in _properties(type(self))}


accept_arrays(FrictionLaw)


class SlidingLaw(FrictionLaw, ABC):
    """A law without memory: the slip velocity alone determines friction, which is set-valued at rest.

    At rest friction is any vector up to the static coefficient; the method determines which one.

    >>> import frictionlab as fl
    >>> class Falling(fl.SlidingLaw):
    ...     mu: fl.Positive
    ...     fall_speed: fl.Speed
    ...     def sliding_friction(self, speed):
    ...         return self.mu / (1 + speed / self.fall_speed)
    >>> law = Falling(mu=0.4, fall_speed=1)
    >>> law, law.static_friction(), law.sliding_friction(1.0)
    (Falling(mu=0.4, fall_speed=1), 0.4, 0.2)
    """

    memory_kind: ClassVar[Literal["none"]] = "none"

    def static_friction(self) -> float:
        """Friction coefficient [-] that slip must overcome to begin; not below ``sliding_friction(0)``."""
        return self.sliding_friction(0.0)

    def vanishes_at_rest(self) -> bool:
        """Whether friction vanishes with slip, as that of a film of fluid does, and nothing is held at rest.

        Dry friction does not: a law in which it does without saying so has the smoothing width of a method in it.
        """
        return False

    def steepest_fall(self) -> float:
        """0 where friction is monotone."""
        return 0.0 if self.monotone() else math.inf


def _is_number(value: object) -> bool:
    if isinstance(value, tuple):
        return all(isinstance(each, float) for each in value)
    return isinstance(value, float | int) and not isinstance(value, bool)


def _number(value: Any) -> Number:
    """A property as kernels receive it: ``int`` and tuples keep their type, everything else becomes ``float``."""
    if isinstance(value, tuple):
        return tuple(float(each) for each in value)
    return value if isinstance(value, int) and not isinstance(value, bool) else float(value)


def _properties(law: type[FrictionLaw]) -> list[str]:
    """The names of the properties of a law and of its base classes."""
    own = [name for kind in law.__mro__ if issubclass(kind, FrictionLaw) for name in vars(kind)]
    return [name for name in dict.fromkeys(own) if isinstance(getattr(law, name), property)]
