"""Base classes of friction laws: a frozen record of parameters whose methods state the physics.

A law may have a label, which names its rows in a table; the label stands beside its parameters and is no part
of its physics. Methods of a law that take one slip speed also take an array of them if called in Python.

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
"""Key under which a law holds its label.

It is no field and no private attribute of pydantic, so that equal laws are equal whatever their labels, and a
law is made in the same way with and without a label."""


class Labelled(Record):
    """Record that may have a ``label``, one line of text, beside its values.

    Raises ValueError for any other label.
    """

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
            """Name of the law's rows in a table; '' if none was given: they then have its registered name."""
            return vars(self).get(_LABEL, "")

    def __repr_args__(self) -> Any:
        """Yield the values, and the label if there is one."""
        yield from super().__repr_args__()
        if self.label:
            yield "label", self.label


OF_SPEED = "sliding_friction", "sliding_vector"
"""Methods whose one argument is a speed or a slip velocity."""


class OfEach:
    """Method of one number that an instance of its law also calls with arrays.

    Its class has the plain method, and compiled code asks the class.
    """

    def __init__(self, method: FunctionType) -> None:
        self.py_func = method

    def __get__(self, law: Any, kind: type | None = None) -> Callable[..., Any]:
        return self.py_func if law is None else partial(_of_each, self.py_func, law)


def as_written(member: Any) -> Any:
    """Return a method as its class defines it, and anything else unchanged."""
    return member.py_func if isinstance(member, OfEach) else member


def _of_each(method: FunctionType, law: Any, speeds: Any) -> Any:
    """Call a method of a law with a number, or with each number of an array."""
    if isinstance(speeds, int | float | complex) or np.ndim(speeds) == 0:
        return method(law, speeds)
    numbers = np.asarray(speeds)
    coefficients = [method(law, number) for number in numbers.ravel().tolist()]
    return np.array(coefficients, dtype=numbers.dtype if numbers.dtype.kind == "c" else float).reshape(
        numbers.shape
    )


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
"""Parameter as compiled code receives it: a number, a whole number, or a tuple of numbers to index."""


class FrictionLaw(Labelled, ABC):
    """Law of dry friction: the friction coefficient, per unit normal load, that resists slip.

    Base class of every law. Its numbers are in the units of the scene. In a scene in SI units they are in SI
    units and may be text with a unit: ``fl.Dahl(mu=0.3, presliding_length="1 um")``. The methods
    ``sliding_friction`` and ``sliding_vector`` of a law also take arrays of any shape. The docstring of a law
    names its sources as in "Source: Dahl (1968)".

    Parameters
    ----------
    label : str, default ""
        One line of visible text that names the law in tables and figures, beside its values. Keyword of every
        law, no field.

    Attributes
    ----------
    in_words : str
        Name of the law in figures; its label is used if this is left out.
    bibtex : str
        BibTeX entries of the sources as one string, except those already in frictionlab's bibliography. A
        source without an entry is cited as written.
    expected_failures : mapping of str to str
        Each check of the conformance battery that the law must fail, with the reason.
    memory_kind : {"undeclared", "none", "bristle", "deflections", "scalars"}
        Memory of the law: what friction depends on beside slip, which is nothing, the deflection of one
        bristle, or several deflections or scalars. No method solves a law that declares none of them.
    compliant : bool
        True if the law has one bristle with a stiffness and a presliding length.

    Examples
    --------
    >>> import frictionlab as fl
    >>> isinstance(fl.Dahl(mu=0.4, stiffness=40), fl.FrictionLaw)
    True
    >>> fl.Dahl(mu=0.4, stiffness=40).sliding_friction(3.0)
    0.4
    >>> fl.Stribeck(mu_kinetic=0.2, mu_static=0.4, curve="hyperbolic").sliding_friction([0, 1, 3])
    array([0.4 , 0.3 , 0.25])
    """

    in_words: ClassVar[str] = ""
    bibtex: ClassVar[str] = ""
    expected_failures: ClassVar[Mapping[str, str]] = MappingProxyType({})
    memory_kind: ClassVar[Literal["undeclared", "none", "bristle", "deflections", "scalars"]] = "undeclared"
    compliant: ClassVar[bool] = False
    spellings: ClassVar[Mapping[str, str]] = MappingProxyType({})

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        accept_arrays(cls)

    @classmethod
    def __pydantic_init_subclass__(cls, **options: Any) -> None:
        super().__pydantic_init_subclass__(**options)
        one_coefficient = "mu_kinetic" in cls.model_fields and "mu" not in cls.model_fields
        cls.spellings = MappingProxyType({"mu": "mu_kinetic"} if one_coefficient else {})

    @model_validator(mode="before")
    @classmethod
    def _one_word_for_a_coefficient(cls, data: Any) -> Any:
        """Take ``mu`` for ``mu_kinetic`` where the law has that alone."""
        if not cls.spellings or not isinstance(data, Mapping) or "mu" not in data or "mu_kinetic" in data:
            return data
        return {cls.spellings.get(name, name): value for name, value in data.items()}

    @model_validator(mode="before")
    @classmethod
    def _texts_with_units(cls, data: Any) -> Any:
        """Replace texts such as ``1 um`` by numbers in SI units."""
        if not isinstance(data, Mapping) or not any(isinstance(value, str) for value in data.values()):
            return data
        units = {name: unit_of_dimension(dimension) for name, dimension in dimensions(cls).items()}
        texts = {name: value for name, value in data.items() if name in units and isinstance(value, str)}
        return {**data, **{name: in_units_of_law(text, name, units) for name, text in texts.items()}}

    @classmethod
    def _in_order(cls) -> list[str]:
        """Return the names of the fields, coefficients first: several laws inherit those of the contact."""
        return sorted(super()._in_order(), key=lambda name: not cls.model_fields[name].is_required())

    @abstractmethod
    def sliding_friction(self, speed: float) -> float:
        """Compute the friction coefficient [-] in steady sliding.

        Parameters
        ----------
        speed : float, >= 0
            Slip speed [scene length / scene time].

        Returns
        -------
        float
            Friction coefficient [-], >= 0.
        """

    def sliding_vector(self, v: complex) -> complex:
        """Compute the friction coefficient [-] in steady sliding, as a vector along the slip velocity.

        It is isotropic: it points along ``v``.

        Parameters
        ----------
        v : float or complex, not zero
            Slip velocity [scene velocity]; ``complex`` in the plane (x1 + i x2).

        Returns
        -------
        float or complex
            Friction coefficient times the direction of ``v`` [-]; ``float`` for ``float``, ``complex`` for
            ``complex``.
        """
        speed = abs(v)
        return (self.sliding_friction(speed) / speed) * v  # one division fewer than along v / speed

    def under_load(self, normal_load: float) -> Self:
        """Return the same law per unit of a normal load: contact parameters become parameters per unit load.

        Parameters
        ----------
        normal_load : float, > 0
            Normal load [scene force].

        Returns
        -------
        FrictionLaw
            Law of the same class; the law itself if it has no parameter of the contact.
        """
        return self

    def count(self) -> int:
        """Return the number of memories.

        Returns
        -------
        int
            Count of the numbers that the law remembers; 0 if it remembers nothing.
        """
        return 0

    def elastic_deflection(self) -> float:
        """Return the deflection up to which the contact is elastic: it follows the slip in every direction.

        Returns
        -------
        float
            Deflection [scene length]; 0 if not declared.
        """
        return 0.0

    def planar_form(self) -> Literal["vectorial", "per-axis"]:
        """Return how the law of one direction extends to the plane.

        Returns
        -------
        {"vectorial", "per-axis"}
            ``vectorial``, a law of vectors, if not declared.
        """
        return "vectorial"

    def no_vector_form(self) -> str:
        """Return why the form ``vectorial`` has no meaning for this law.

        Returns
        -------
        str
            Reason as a sentence; '' if the form has a meaning.
        """
        return ""

    def damps_across(self, speed: float) -> bool:
        """Check that friction never does positive work on a motion across the slip.

        Spring and contact across the slip then only lose energy, and without a load across the belt x2
        decays.

        Parameters
        ----------
        speed : float, >= 0
            Largest slip speed [scene velocity] for which this is asked.

        Returns
        -------
        bool
            True if this holds at all slip speeds up to ``speed``.
        """
        return True

    def obeys(self, check: str) -> bool:
        """Check whether the law claims to pass a check of the battery.

        It does unless ``expected_failures`` names the check.
        A shortcut that rests on a property of laws asks for the check of that property:
        ``law.obeys("oddness")``.

        Parameters
        ----------
        check : str
            Name of the check.

        Returns
        -------
        bool
            True if the law claims to pass it.
        """
        return check not in self.expected_failures

    def constant_sliding_friction(self) -> bool:
        """Check whether ``sliding_friction`` is the same number at every speed.

        Returns
        -------
        bool
            False if not declared.
        """
        return False

    def steepest_fall(self) -> float:
        """Return the largest rate at which sliding friction falls as speed grows, rest included.

        If damping outweighs it, a law without memory has exactly one steady state.

        Returns
        -------
        float
            Rate [1/scene velocity], >= 0; infinite if friction may jump.
        """
        return 0.0 if self.constant_sliding_friction() else math.inf

    def monotone(self) -> bool:
        """Check whether friction never falls as slip grows: (T(v) - T(w)).(v - w) >= 0, rest included.

        With constant normal load and damping the steady state is then unique (Leine & van de Wouw, 2008).

        Returns
        -------
        bool
            False if not declared.
        """
        return False

    def presliding(self) -> float:
        """Return the slip within which friction reverses its sign after a reversal of slip.

        Returns
        -------
        float
            Slip [scene length]; 0 if friction jumps.
        """
        return 0.0

    def largest_rate(self, speed: float) -> float:
        """Return the largest modulus of d(rate)/d(memory); it limits explicit steps.

        Parameters
        ----------
        speed : float, >= 0
            Slip speed [scene velocity].

        Returns
        -------
        float
            Modulus [1/scene time].
        """
        return 0.0

    def rate_jumps(self, directions: int) -> bool:
        """Check whether the rate of a memory may jump while slip does not reverse.

        Parameters
        ----------
        directions : int
            1 on the line, 2 in the plane.

        Returns
        -------
        bool
            True if it may jump.
        """
        return False

    def structure(self) -> tuple[str, ...]:
        """Return the properties of the parameters that select which kernels are compiled.

        Returns
        -------
        tuple of str
            Properties as words.
        """
        return ()

    def numbers(self) -> dict[str, Number]:
        """Return the parameters that kernels receive: numbers, tuples of numbers, and properties.

        Optional numbers (default ``None``) are left out: only properties read them, so the kernels of a law
        do not depend on which are given. Kernels receive a tuple as an array: use ``len`` and indices.

        Returns
        -------
        dict of str to number or tuple of float
            Values by name.
        """
        required = {name for name, field in type(self).model_fields.items() if field.default is not None}
        fields = {name: value for name, value in self if name in required and _is_number(value)}
        return fields | {name: _number(getattr(self, name)) for name in _properties(type(self))}


accept_arrays(FrictionLaw)


class SlidingLaw(FrictionLaw, ABC):
    """Law without memory: the slip velocity alone determines friction, which is set-valued at rest.

    At rest friction is any vector up to the static coefficient; the method determines which one. A subclass
    writes ``sliding_friction``.

    Examples
    --------
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
        """Return the friction coefficient that must be overcome for slip to begin.

        Returns
        -------
        float
            Coefficient [-]; not below ``sliding_friction(0)``, which it is if not declared.
        """
        return self.sliding_friction(0.0)

    def vanishes_at_rest(self) -> bool:
        """Check whether friction vanishes with slip, as that of a film of fluid does.

        Nothing is then held at rest.
        Dry friction does not vanish. The battery takes a law whose friction vanishes without this declaration
        to have the smoothing width of a method in it.

        Returns
        -------
        bool
            False if not declared.
        """
        return False

    def steepest_fall(self) -> float:
        """Return 0 if friction is monotone, else infinity.

        Returns
        -------
        float
            Largest rate at which sliding friction falls as speed grows [1/scene velocity].
        """
        return 0.0 if self.monotone() else math.inf


def _is_number(value: object) -> bool:
    """Check whether a value is a number or a tuple of numbers, and no boolean."""
    if isinstance(value, tuple):
        return all(isinstance(number, float) for number in value)
    return isinstance(value, float | int) and not isinstance(value, bool)


def _number(value: Any) -> Number:
    """Return a property as kernels receive it: ``int`` and tuples keep their type."""
    if isinstance(value, tuple):
        return tuple(float(number) for number in value)
    return value if isinstance(value, int) and not isinstance(value, bool) else float(value)


def _properties(law: type[FrictionLaw]) -> list[str]:
    """Return the names of the properties of a law and of its base classes."""
    own = [name for kind in law.__mro__ if issubclass(kind, FrictionLaw) for name in vars(kind)]
    return [name for name in dict.fromkeys(own) if isinstance(getattr(law, name), property)]
