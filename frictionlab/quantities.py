"""The numbers that laws, scenes and studies hold: finite and real; strings and booleans are refused."""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from numbers import Real
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from frictionlab.mistakes.validation import unnamed, wrong_values


def _a_number(value: object) -> object:
    """Accept real numbers, those of numpy included; refuse values that could only be converted to one."""
    if type(value) is float:  # by far the most, and asking for a Real takes as long as all the rest
        return value
    if isinstance(value, bool) or not isinstance(value, Real):
        raise ValueError("must be a number")
    return float(value)


Finite = Annotated[float, BeforeValidator(_a_number), Field(allow_inf_nan=False)]
NonNegative = Annotated[float, BeforeValidator(_a_number), Field(allow_inf_nan=False, ge=0)]
Positive = Annotated[float, BeforeValidator(_a_number), Field(allow_inf_nan=False, gt=0)]


@dataclass(frozen=True)
class Dimension:
    """Physical dimension of a number as powers of force, length and time; written beside its limits in an annotation.

    It gives the unit of the number where a scene is given in SI units. A number without it is dimensionless.
    """

    force: int = 0
    length: int = 0
    time: int = 0


Speed = Annotated[Positive, Dimension(length=1, time=-1)]
"""A speed > 0 [m/s in SI, else scene velocity]."""
PerSpeed = Annotated[NonNegative, Dimension(length=-1, time=1)]
"""A coefficient >= 0 per speed [s/m in SI, else 1/scene velocity]."""


Floats = NDArray[np.float64]
"""An array of real numbers of any shape."""


EPSILON = 2.0**-52
"""Distance from one to the next floating-point number."""


class Record(BaseModel):
    """A frozen record that refuses keys it does not know. Made in Python it raises WrongValues, which tells mistakes
    as a study does, and TypeError for values without names."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    if not TYPE_CHECKING:  # type checkers and pydantic take the signature from the fields

        def __init__(self, /, *without_names: Any, **values: Any) -> None:
            if without_names:
                raise unnamed(type(self), without_names)
            try:
                super().__init__(**values)
            except ValidationError:
                raise wrong_values(type(self), values) from None

        __init__.__signature__ = inspect.signature(BaseModel.__init__)
        __init__.__pydantic_base_init__ = True  # mappings inside other mappings are not made by __init__


_RecordT = TypeVar("_RecordT", bound=Record)


def rebuilt(record: _RecordT) -> _RecordT:
    """The record if it holds what making it again from its values gives, else that.

    Raises WrongValues where ``model_copy`` put in what the record refuses.
    """
    made = type(record)(**given_values(record))
    return record if repr(dict(made)) == repr(dict(record)) else made


def given_values(record: Record) -> dict[str, Any]:
    """Nested plain values that were given for a record, whether or not they are valid."""
    held = {name: value for name, value in vars(record).items() if name in record.model_fields_set}
    return {name: given_values(value) if isinstance(value, Record) else value for name, value in held.items()}
