"""The numbers a law, a scene or a study may hold: finite, real and not a string or a truth value in disguise."""

from __future__ import annotations

from numbers import Real
from typing import Annotated

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field


def _a_number(value: object) -> object:
    """Let real numbers through (numpy's included); refuse what merely converts to one."""
    if isinstance(value, bool) or not isinstance(value, Real):
        raise ValueError(f"must be a number, not {value!r}")
    return float(value)


Finite = Annotated[float, BeforeValidator(_a_number), Field(allow_inf_nan=False)]
NonNegative = Annotated[float, BeforeValidator(_a_number), Field(allow_inf_nan=False, ge=0)]
Positive = Annotated[float, BeforeValidator(_a_number), Field(allow_inf_nan=False, gt=0)]


class Record(BaseModel):
    """A frozen record that refuses keys it does not know."""

    model_config = ConfigDict(frozen=True, extra="forbid")
