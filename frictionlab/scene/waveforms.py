"""The shape in time of a load, a slip, a belt's vibration or a normal load, and frequencies in whole numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from difflib import get_close_matches
from fractions import Fraction
from numbers import Real
from typing import Annotated, Any, Literal, NamedTuple, get_args

from pydantic import BeforeValidator, Field, PlainSerializer, PlainValidator, WithJsonSchema

Name = Literal["sine", "square", "triangle", "sawtooth"]
WAVEFORMS: tuple[str, ...] = get_args(Name)
MOST_TERMS = 64
"""Of a sum of harmonics, and the largest order among them."""
LONGEST_PERIOD = 64
"""Periods of the drive after which everything must have repeated."""


class Term(NamedTuple):
    """amplitude*sin(order*theta + phase), phase in degrees."""

    order: int
    amplitude: float
    phase: float


class Form(NamedTuple):
    """A shape by its name, or a sum of harmonics."""

    shape: str
    terms: tuple[Term, ...] = ()

    def plain(self) -> Any:
        """As a study gives it."""
        return {"harmonics": [term._asdict() for term in self.terms]} if self.terms else self.shape


SINE = Form("sine")


def _form(value: Any) -> Form:
    """Raises ValueError for what is neither a shape nor a sum of harmonics."""
    if isinstance(value, Form):
        return value
    if isinstance(value, str) and value in WAVEFORMS:
        return Form(value)
    if isinstance(value, Mapping):
        return _sum_of_harmonics(value)
    near = get_close_matches(value, WAVEFORMS, 1) if isinstance(value, str) else []
    meant = f"; did you mean '{near[0]}'?" if near else ""
    raise ValueError(f"must be {', '.join(WAVEFORMS)} or {{harmonics: [...]}}, got {value!r}{meant}")


def _sum_of_harmonics(value: Mapping[str, Any]) -> Form:
    terms = value.get("harmonics")
    if set(value) != {"harmonics"} or not isinstance(terms, list | tuple) or not terms:
        raise ValueError("a sum of harmonics is {harmonics: [{order: 1, amplitude: 1, phase: 0}, ...]}")
    if len(terms) > MOST_TERMS:
        raise ValueError(f"harmonics are at most {MOST_TERMS}, got {len(terms)}")
    return Form("harmonics", tuple(_term(place, each) for place, each in enumerate(terms)))


def _term(place: int, value: Any) -> Term:
    if isinstance(value, Term):
        return value
    where = f"harmonics[{place}]"
    if not isinstance(value, Mapping) or not {"order", "amplitude"} <= set(value) <= set(Term._fields):
        raise ValueError(f"{where} must be a mapping of order, amplitude and phase, got {value!r}")
    order, amplitude, phase = value["order"], value["amplitude"], value.get("phase", 0.0)
    if not _is_number(order) or order != round(order) or not 1 <= order <= MOST_TERMS:
        raise ValueError(f"{where}.order must be a whole number from 1 to {MOST_TERMS}, got {order!r}")
    for name, number in (("amplitude", amplitude), ("phase", phase)):
        if not _is_number(number):
            raise ValueError(f"{where}.{name} must be a finite number, got {number!r}")
    return Term(int(order), float(amplitude), float(phase))


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)


_TERM_SCHEMA = {
    "type": "object",
    "properties": {
        "order": {"type": "integer", "minimum": 1, "maximum": MOST_TERMS},
        "amplitude": {"type": "number"},
        "phase": {"type": "number", "default": 0},
    },
    "required": ["order", "amplitude"],
    "additionalProperties": False,
}
_FORM_SCHEMA = {
    "oneOf": [
        {"enum": list(WAVEFORMS)},
        {
            "type": "object",
            "properties": {
                "harmonics": {"type": "array", "minItems": 1, "maxItems": MOST_TERMS, "items": _TERM_SCHEMA}
            },
            "required": ["harmonics"],
            "additionalProperties": False,
        },
    ]
}
Waveform = Annotated[Form, PlainValidator(_form), PlainSerializer(Form.plain), WithJsonSchema(_FORM_SCHEMA)]
"""sine: sin(theta). square: sign(sin(theta)). triangle: (2/pi) arcsin(sin(theta)). sawtooth: rises through 0 at theta
= 0 from -1 to 1, and jumps at theta = pi. {harmonics: [{order, amplitude, phase}, ...]}: their sum."""


def as_fraction(ratio: float) -> Fraction:
    """The fraction of small whole numbers that a ratio of frequencies is."""
    return Fraction(ratio).limit_denominator(LONGEST_PERIOD)


def _ratio(value: Any) -> float:
    """Of numbers and of texts such as 3/2. Raises ValueError where it is no ratio of small whole numbers."""
    wanted = f'must be p/q with whole numbers, q up to {LONGEST_PERIOD}, such as 2, 0.5 or "3/2"'
    try:
        exact = Fraction(value) if isinstance(value, str) else None
    except (ValueError, ZeroDivisionError):
        exact = Fraction(-1)
    if exact is None and not _is_number(value):
        raise ValueError(f"{wanted}, got {value!r}")
    near = as_fraction(float(value if exact is None else exact))
    if near <= 0 or abs(near - (Fraction(value) if exact is None else exact)) > 1e-9 * near:
        raise ValueError(f"{wanted}, got {value!r}")
    return near.numerator / near.denominator


Ratio = Annotated[
    float,
    BeforeValidator(_ratio),
    Field(gt=0),
    WithJsonSchema(
        {"anyOf": [{"type": "number", "exclusiveMinimum": 0}, {"type": "string", "pattern": r"^\d+(/\d+)?$"}]}
    ),
]
"""A frequency in shares of the drive's, p/q."""
