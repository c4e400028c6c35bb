"""Numbers that laws, scenes and studies hold: finite and real; strings and booleans are refused.

Values and parameters are shown as one would type them in Python: 10 for 10.0, ``float | None`` for a checked
number.
"""

from __future__ import annotations

import inspect
import math
import types
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from numbers import Integral, Real
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeVar, Union, cast, get_args, get_origin

import numpy as np
from numpy.typing import NDArray
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationError,
    ValidatorFunctionWrapHandler,
    WrapValidator,
)
from pydantic.fields import FieldInfo

from frictionlab.values.notes import Unfit, python_text
from frictionlab.values.validation import unnamed, wrong_values


def typed(value: Any) -> str:
    """Return a value as one would type it."""
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e16:
        return str(int(value)) if value or math.copysign(1.0, value) > 0.0 else "-0.0"
    return repr(value)


class _Type(str):
    """Name of a type; in a signature without quotes."""

    __slots__ = ()
    __repr__ = str.__str__


def keywords(
    fields: Iterable[tuple[str, FieldInfo]], others: Iterable[inspect.Parameter]
) -> inspect.Signature:
    """Return the signature of a class that takes these fields by name: plain types and defaults, without checks.

    Those of ``others`` that are keywords follow the fields.
    """
    beside = [other for other in others if other.kind is inspect.Parameter.KEYWORD_ONLY]
    return inspect.Signature([*(_keyword(name, field) for name, field in fields), *beside])


def _keyword(name: str, field: FieldInfo) -> inspect.Parameter:
    default = inspect.Parameter.empty if field.is_required() else field.get_default(call_default_factory=True)
    kind = _Type(_type_text(field.annotation))
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=kind)


def _type_text(annotation: Any) -> str:
    """Return a type without the checks written beside it; records made of text or mappings as these types."""
    origin = get_origin(annotation)
    if origin is Annotated:
        return _type_text(get_args(annotation)[0])
    if origin in (Union, types.UnionType):
        return " | ".join(map(_type_text, get_args(annotation)))
    if origin is Literal:
        return f"Literal[{', '.join(map(repr, get_args(annotation)))}]"
    if annotation is types.NoneType:
        return "None"
    if isinstance(annotation, type) and origin is None:
        return str(annotation.given_as()) if hasattr(annotation, "given_as") else annotation.__name__
    return str(annotation).replace("typing.", "")


if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass as _ModelType
else:
    _ModelType = type(BaseModel)


class Written(float):
    """Number that was written as text with a unit: it is in SI units, and has that text.

    Arithmetic makes a plain number of it.
    """

    text: str
    si: str

    def __new__(cls, number: float, text: str, si: str) -> Written:
        """Make the number in this SI unit, with its text, such as ``2 mm/s``."""
        made = super().__new__(cls, number)
        made.text, made.si = text, si
        return made

    # pickle makes a float again from its value alone
    def __getnewargs__(self) -> tuple[float, str, str]:  # type: ignore[override]
        """Return the values from which the number is made again in another process."""
        return float(self), self.text, self.si

    @property
    def unit(self) -> str:
        """Unit in the text."""
        return self.text.partition(" ")[2]


def _a_number(value: object, checked: ValidatorFunctionWrapHandler) -> float:
    """Accept real numbers, those of numpy included; refuse values that could only be converted to one."""
    if type(value) is float:  # most values; the check for a Real takes as long as all the rest
        return cast(float, checked(value))
    if isinstance(value, Unfit):
        raise ValueError(value.what)
    if getattr(value, "shape", None) == () and hasattr(value, "item"):  # of numpy and xarray
        value = value.item()
    if isinstance(value, bool) or not isinstance(value, Real):
        raise ValueError("must be a number")
    number = checked(value if isinstance(value, Written) else float(value))
    return value if isinstance(value, Written) else cast(float, number)


def document(kind: Any, text: str) -> None:
    """Give a type of numbers the docstring that ``help`` shows."""
    kind.__doc__ = inspect.cleandoc(text)


Finite = Annotated[float, Field(allow_inf_nan=False), WrapValidator(_a_number)]
document(
    Finite,
    """Real number, as the parameter of a law; without a dimension.

    Text, booleans, NaN and infinities raise WrongValues.

    Examples
    --------
    >>> import frictionlab as fl
    >>> class Tilted(fl.SlidingLaw):
    ...     mu: fl.Positive
    ...     slope: fl.Finite = 0.0
    ...     def sliding_friction(self, speed):
    ...         return self.mu + self.slope * speed / (1 + speed)
    >>> Tilted(mu=0.5, slope=-0.25).sliding_friction(1.0)
    0.375
    """,
)
NonNegative = Annotated[float, Field(allow_inf_nan=False, ge=0), WrapValidator(_a_number)]
document(
    NonNegative,
    """Number of at least 0, as the parameter of a law; without a dimension. Smaller ones raise WrongValues.

    Examples
    --------
    >>> import frictionlab as fl
    >>> class Lubricated(fl.SlidingLaw):
    ...     mu: fl.NonNegative = 0
    ...     def sliding_friction(self, speed):
    ...         return self.mu
    >>> Lubricated(mu=-0.1)
    Traceback (most recent call last):
    frictionlab.values.notes.WrongValues: Lubricated: mu: must be >= 0, got -0.1
    """,
)
Positive = Annotated[float, Field(allow_inf_nan=False, gt=0), WrapValidator(_a_number)]
document(
    Positive,
    """Number above 0, as the parameter of a law; without a dimension. Others raise WrongValues.

    Examples
    --------
    >>> import frictionlab as fl
    >>> class Rough(fl.SlidingLaw):
    ...     mu: fl.Positive
    ...     def sliding_friction(self, speed):
    ...         return self.mu
    >>> Rough(mu=0)
    Traceback (most recent call last):
    frictionlab.values.notes.WrongValues: Rough: mu: must be > 0, got 0
    """,
)


def gone(value: object, why: str) -> BeforeValidator:
    """Make the mark of a field that no longer takes a value: it is refused by this sentence."""

    def refuse(given: Any) -> Any:
        if type(given) is type(value) and given == value:
            raise ValueError(why)
        return given

    return BeforeValidator(refuse)


def at_least_one(name: str, value: object) -> int:
    """Return the value of this parameter as a whole number. Raises ValueError if it is none, or below 1."""
    if isinstance(value, bool) or not isinstance(value, Integral) or value < 1:
        raise ValueError(f"{name} must be a whole number of at least 1, got {python_text(value)}")
    return int(value)


@dataclass(frozen=True, repr=False)
class Dimension:
    """Physical dimension of a number as powers of force, length and time.

    It is written beside the number's limits in an annotation and gives the unit of the number if a scene is
    in SI units. A number without it is dimensionless.

    Parameters
    ----------
    force : int, default 0
        Power of force.
    length : int, default 0
        Power of length.
    time : int, default 0
        Power of time.

    Examples
    --------
    >>> from typing import Annotated
    >>> import frictionlab as fl
    >>> Acceleration = Annotated[fl.Positive, fl.Dimension(length=1, time=-2)]
    >>> fl.Dimension(length=1, time=-2)
    Dimension(length=1, time=-2)
    """

    force: int = 0
    length: int = 0
    time: int = 0

    def __repr__(self) -> str:
        """Return the call that makes it again."""
        powers = ", ".join(f"{name}={power}" for name, power in vars(self).items() if power)
        return f"Dimension({powers})"


Speed = Annotated[Positive, Dimension(length=1, time=-1)]
document(
    Speed,
    """Speed > 0 [m/s in a scene given in SI units, else omega_1 L], as the parameter of a law.

    Examples
    --------
    >>> import frictionlab as fl
    >>> class Falling(fl.SlidingLaw):
    ...     mu: fl.Positive
    ...     fall_speed: fl.Speed
    ...     def sliding_friction(self, speed):
    ...         return self.mu / (1 + speed / self.fall_speed)
    >>> Falling(mu=0.4, fall_speed=2).sliding_friction(2.0)
    0.2
    """,
)
PerSpeed = Annotated[NonNegative, Dimension(length=-1, time=1)]
document(
    PerSpeed,
    """Coefficient >= 0 per speed [s/m in a scene given in SI units, else 1/(omega_1 L)], as parameter of a law.

    Examples
    --------
    >>> import frictionlab as fl
    >>> class Viscous(fl.SlidingLaw):
    ...     mu: fl.Positive
    ...     viscosity: fl.PerSpeed = 0
    ...     def sliding_friction(self, speed):
    ...         return self.mu + self.viscosity * speed
    >>> Viscous(mu=0.5, viscosity=0.25).sliding_friction(2.0)
    1.0
    """,
)


Floats = NDArray[np.float64]
"""Array of real numbers of any shape."""


EPSILON = 2.0**-52
"""Distance from one to the next floating-point number."""


class _Listed(_ModelType):
    """Type of records: ``dir``, ``help`` and completion show what a record adds to those of pydantic."""

    def __dir__(cls) -> list[str]:  # noqa: N805 - of a class
        return [name for name in super().__dir__() if not hasattr(BaseModel, name) and name[:2] != "__"]


class Record(BaseModel, metaclass=_Listed):
    """Frozen record that refuses keys it does not know, shown as one would type it.

    If made in Python it raises WrongValues, with mistakes worded as in a study; TypeError for values without
    names.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    if not TYPE_CHECKING:  # type checkers and pydantic take the signature from the fields

        def __init__(self, /, *without_names: Any, **values: Any) -> None:
            """Make the record.

            Raises WrongValues with every mistake in the values, TypeError for values without names.
            """
            if without_names:
                raise unnamed(type(self), without_names)
            try:
                super().__init__(**values)
            except ValidationError:
                raise wrong_values(type(self), values) from None

        __init__.__signature__ = inspect.signature(BaseModel.__init__)
        __init__.__pydantic_base_init__ = True  # mappings inside other mappings are not made by __init__

    @classmethod
    def __pydantic_init_subclass__(cls, **_options: Any) -> None:
        beside = inspect.signature(cls.__init__).parameters.values()
        cls.__signature__ = keywords([(name, cls.model_fields[name]) for name in cls._in_order()], beside)

    @classmethod
    def called(cls) -> str:
        """Return what one would type in Python to make it."""
        return cls.__name__

    @classmethod
    def _in_order(cls) -> list[str]:
        """Return the names of its values in the order in which they are shown: choices among words last."""
        fields = cls.model_fields
        return sorted(fields, key=lambda name: isinstance(fields[name].default, str))

    def _shown(self) -> dict[str, Any]:
        """Return values from which it can be made again, without those that it has by default."""
        fields, held = type(self).model_fields, dict(self)
        given = {name: held[name] for name in self._in_order() if held[name] != fields[name].default}
        return {name: value for name, value in given.items() if self._differs_without(name, given)}

    def _differs_without(self, name: str, given: dict[str, Any]) -> bool:
        """Check whether the record that is made without this value is another, or none."""
        if type(self).model_fields[name].is_required():
            return True
        try:
            return bool(type(self).model_validate({key: given[key] for key in given if key != name}) != self)
        except ValidationError:
            return True

    def __repr__(self) -> str:
        """Return the call that makes it again."""
        values = ", ".join(f"{name}={typed(value)}" for name, value in self.__repr_args__())
        return f"{self.called()}({values})"

    __str__ = __repr__

    def __repr_args__(self) -> list[tuple[str, Any]]:
        """Return the values for rich and other printers."""
        return [*self._shown().items()]

    def __setattr__(self, name: str, value: Any) -> None:
        """Set a value. Raises AttributeError if the record is frozen: it is made again to be changed."""
        if not self.model_config.get("frozen"):
            super().__setattr__(name, value)
            return
        again = f"{name}={typed(value)}"
        hint = f"scene.with_({again})" if hasattr(self, "with_") else f"another with {again}"
        raise AttributeError(f"a {type(self).__name__} cannot be changed: make {hint}")

    def __dir__(self) -> list[str]:
        """Return the names of its values, and of what its class adds to that of pydantic."""
        return [*type(self).model_fields, *dir(type(self))]


_RecordT = TypeVar("_RecordT", bound=Record)


def rebuilt(record: _RecordT) -> _RecordT:
    """Return the record if making it again from its values gives an equal one, else the record made again.

    Raises WrongValues if ``model_copy`` put in a value that the record refuses.
    """
    made = type(record)(**given_values(record))
    return record if _exactly(made) == _exactly(record) else made


def _exactly(record: Record) -> str:
    """Return everything a record holds as text, numbers with their types."""
    return repr({name: _exactly(value) if isinstance(value, Record) else value for name, value in record})


def given_values(record: Record) -> dict[str, Any]:
    """Return nested plain values that were given for a record, whether or not they are valid."""
    held = {name: value for name, value in vars(record).items() if name in record.model_fields_set}
    return {name: given_values(value) if isinstance(value, Record) else value for name, value in held.items()}


@cache
def dimensions(record: type[Record]) -> dict[str, Dimension]:
    """Return the dimension of every field of a record that has one."""
    found = {
        name: _dimension(field.annotation, field.metadata) for name, field in record.model_fields.items()
    }
    return {name: dimension for name, dimension in found.items() if dimension is not None}


def _dimension(annotation: Any, metadata: Any) -> Dimension | None:
    """Return the ``Dimension`` in the annotation of a type, or of one of the alternatives of an optional type."""
    for mark in metadata:
        if isinstance(mark, Dimension):
            return mark
    inner = (
        _dimension(None, kind.__metadata__) for kind in get_args(annotation) if hasattr(kind, "__metadata__")
    )
    return next((dimension for dimension in inner if dimension is not None), None)
