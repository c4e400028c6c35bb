"""Waveforms of a load, a slip, a belt's vibration or a normal load, and frequencies in whole numbers.

A waveform with a name is one record in ``WAVE_SHAPES``; signals, proofs, closed forms and the report read all
of it there.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping
from fractions import Fraction
from numbers import Real
from pathlib import Path
from typing import Annotated, Any, NamedTuple

from pydantic import BeforeValidator, Field, PlainSerializer, PlainValidator, WithJsonSchema

MOST_POINTS = 2000
"""Largest number of points between which a waveform is straight."""
MOST_TERMS = 64
"""Largest number of terms in a sum of harmonics, and the largest order among them."""
LONGEST_COMMON = 64
"""Number of periods of the drive after which everything must have repeated."""
LARGEST_RATIO = 1000
"""Largest ratio of a frequency to the drive's."""


class WaveLine(NamedTuple):
    """Straight part of a waveform: start [turns, from 0 to below 1], value there, slope per turn."""

    start: Fraction
    value: Fraction
    slope: Fraction


class WaveShape(NamedTuple):
    """Waveform with a name, for theta = 2 pi turns.

    formula: in theta. words: its name in a sentence. of, share: the shape that it is one of, and the share of the
    period for which that is 1 (square) or rises (sawtooth); none for the sine.
    """

    formula: str
    words: str
    of: str = ""
    share: Fraction = Fraction(1, 2)


WAVE_SHAPES = {
    "sine": WaveShape("sin(theta)", "a sine"),
    "square": WaveShape("1 in the first half of the period, -1 in the second", "a square wave", "square"),
    "triangle": WaveShape("(2/pi) arcsin(sin(theta))", "a triangle wave", "sawtooth"),
    "sawtooth": WaveShape(
        "rises evenly from -1 to 1, through 0 at theta = 0; jumps at theta = pi",
        "a sawtooth",
        "sawtooth",
        Fraction(1),
    ),
}


class Term(NamedTuple):
    """Sine in a sum of harmonics: amplitude*sin(order*theta + phase), phase in degrees."""

    order: int
    amplitude: float
    phase: float

    def __str__(self) -> str:
        """Return the term as a formula: 0.5 sin(3 theta + 90 deg)."""
        size = "" if self.amplitude == 1.0 else f"{_short(self.amplitude)} "
        angle = "theta" if self.order == 1 else f"{self.order} theta"
        shift = f" + {_short(self.phase)} deg" if self.phase else ""
        return f"{size}sin({angle}{shift})"


def _short(number: float) -> str:
    """Return a number as text that reads back the same."""
    return repr(number).removesuffix(".0")


class Form(NamedTuple):
    """Waveform: a shape by its name, a sum of harmonics, or straight lines between points.

    numbers: what the lines of a square wave or a sawtooth are made of, or shares of the period and values there.
    """

    shape: str
    terms: tuple[Term, ...] = ()
    numbers: tuple[float, ...] = ()

    @staticmethod
    def given_as() -> str:
        """Return the types of the values it is made of, for signatures."""
        return "str | dict"

    def __repr__(self) -> str:
        """Return the form as one would type it: 'square', or the mapping of its harmonics."""
        return repr(self.plain())

    def plain(self) -> Any:
        """Return the form as a study gives it."""
        if self.shape == "points":
            return {"points": [list(pair) for pair in self._pairs]}
        if self.numbers:
            return {self.shape: {_SHARES[self.shape]: self.numbers[0]}}
        return {"harmonics": [term._asdict() for term in self.terms]} if self.terms else self.shape

    def __str__(self) -> str:
        """Return the form for one cell of a table: the name with its share, the points, or the sum as a formula."""
        if self.shape == "points":
            return f"points {' '.join(f'{share!r},{value!r}' for share, value in self._pairs)}"
        if self.numbers:
            return f"{self.shape} {_SHARES[self.shape]} {self.numbers[0]!r}"
        return " + ".join(map(str, self.terms)) if self.terms else self.shape

    @property
    def words(self) -> str:
        """Words for it in a sentence."""
        if self.shape == "points":
            return f"straight lines between {len(self._pairs)} points"
        if self.numbers:
            return f"{WAVE_SHAPES[self.shape].words} of {_SHARES[self.shape]} {self.numbers[0]:g}"
        return str(self) if self.terms else WAVE_SHAPES[self.shape].words

    @property
    def _pairs(self) -> list[tuple[float, float]]:
        return list(zip(self.numbers[::2], self.numbers[1::2], strict=True))

    @property
    def lines(self) -> tuple[WaveLine, ...]:
        """Straight lines between its corners; none if it is a sum of sines."""
        return () if self.terms or self.shape == "sine" else _lines_between(self._corners())

    def _corners(self) -> list[tuple[Fraction, Fraction]]:
        """Return the shares of the period and the values at its corners, a jump as two of the same share."""
        if self.shape == "points":
            return [(Fraction(share), Fraction(value)) for share, value in self._pairs]
        _, _, of, usual = WAVE_SHAPES[self.shape]
        share, one = Fraction(self.numbers[0]) if self.numbers else usual, Fraction(1)
        if of == "square":
            return [(Fraction(0), one), (share, one), (share, -one), (one, -one)]
        return [(share / 2, one), (1 - share / 2, -one)]

    @property
    def mean(self) -> float:
        """Mean over the period."""
        ends = zip(self.lines, self.ends, strict=True)
        return float(sum((length * (line.value + end) / 2 for line, (length, end) in ends), Fraction(0)))

    @property
    def waves(self) -> tuple[Term, ...]:
        """Sines that it is a sum of; none if it is straight between corners."""
        return self.terms or (() if self.lines else (Term(1, 1.0, 0.0),))

    @property
    def ends(self) -> tuple[tuple[Fraction, Fraction], ...]:
        """Length [turns] and value at the end of each line."""
        following = [*self.lines[1:], *(line._replace(start=line.start + 1) for line in self.lines[:1])]
        lengths = [after.start - line.start for line, after in zip(self.lines, following, strict=True)]
        values = (line.value + line.slope * length for line, length in zip(self.lines, lengths, strict=True))
        return tuple(zip(lengths, values, strict=True))

    @property
    def jumps(self) -> bool:
        """True if its value jumps at a corner."""
        following = self.lines[1:] + self.lines[:1]
        return any(end != after.value for (_, end), after in zip(self.ends, following, strict=True))

    @property
    def antisymmetric(self) -> bool:
        """True if it is its own opposite half a period later."""
        opposite = {((line.start + Fraction(1, 2)) % 1, -line.value, -line.slope) for line in self.lines}
        return opposite == {*self.lines} and all(term.order % 2 == 1 for term in self.waves)


_SHARES = {"square": "duty", "sawtooth": "width"}
"""Shapes that have a share of the period, and its name: how long a square wave is 1, how long a sawtooth rises."""


def _lines_between(corners: list[tuple[Fraction, Fraction]]) -> tuple[WaveLine, ...]:
    """Return the lines from corner to corner, and from the last one to the first of the next period."""
    share, value = corners[0]
    following = [*corners[1:], (share + 1, value)]
    found = [
        WaveLine(start % 1, first, (last - first) / (end - start))
        for (start, first), (end, last) in zip(corners, following, strict=True)
        if end > start
    ]
    return tuple(sorted(found))


_TERM = re.compile(r"(?:(-?[\d.]\S*) )?sin\((?:(\d+) )?theta(?: \+ (\S+) deg)?\)")


def told(text: str) -> Form:
    """Return the form that the text in a cell of a table names or writes as a formula. Raises ValueError."""
    terms = [Term(int(b or 1), float(a or 1.0), float(c or 0.0)) for a, b, c in _TERM.findall(text)]
    if terms:
        return Form("harmonics", tuple(terms))
    shape, *rest = text.split()
    if shape == "points":
        return form_of({"points": [[*map(float, pair.split(","))] for pair in rest]})
    return form_of({shape: {rest[0]: float(rest[1])}} if rest else shape)


SINE = Form("sine")


def form_of(value: Any) -> Form:
    """Return the waveform of a value in a study. Raises ValueError with the path of the mistake in it."""
    if isinstance(value, Form):
        return value
    if isinstance(value, str) and value in WAVE_SHAPES:
        return Form(value)
    if isinstance(value, Mapping) and len(value) == 1:
        ((kind, given),) = value.items()
        if kind in _SHARES:
            return Form(kind, (), (_share(kind, given),))
        if kind == "points":
            return _through_points(given)
        if kind == "file":
            return _through_points(_points_of_file(given))
    if isinstance(value, Mapping):
        return _sum_of_harmonics(value)
    raise ValueError(
        f"must be {', '.join(map(repr, WAVE_SHAPES))}, {{square: {{duty: 0.3}}}}, {{sawtooth: {{width: 0.3}}}}, "
        f"{{points: [[0, 0], ...]}}, {{file: measured.csv}} or {{harmonics: [...]}}"
    )


def _share(kind: str, given: Any) -> float:
    name = _SHARES[kind]
    if not isinstance(given, Mapping) or [*given] != [name]:
        raise ValueError(f"{kind}: must be {{{name}: a share of the period}}, got {given!r}")
    share = given[name]
    most = "< 1" if kind == "square" else "<= 1"
    if not _is_number(share) or not (0.0 < share < 1.0 or (share == 1.0 and kind == "sawtooth")):
        raise ValueError(f"{kind}.{name}: must be > 0 and {most}, got {share!r}")
    return float(share)


def _points_of_file(given: Any) -> list[list[float]]:
    """Return shares of the period and values of a file of one period, whose last time ends it."""
    try:
        rows = list(csv.DictReader(Path(given).read_text(encoding="utf-8-sig").splitlines()))
        times, values = ([float(row[name]) for row in rows] for name in ("time", "value"))
    except (OSError, UnicodeError) as problem:
        raise ValueError(f"file: {given} cannot be read: {getattr(problem, 'strerror', problem)}") from None
    except (KeyError, TypeError, ValueError):
        raise ValueError(
            f"file: {given} must have the columns time and value, numbers in every row"
        ) from None
    if not times or times[0] != 0.0 or not math.isfinite(times[-1]) or times[-1] <= 0.0:
        raise ValueError(f"file: {given} must begin at time 0, and end with the period")
    return [[time / times[-1], value] for time, value in zip(times, values, strict=True)]


_POINTS = (
    "points are [[share of the period, value], ...], shares rising from 0 to 1, twice the same for a jump"
)


def _through_points(given: Any) -> Form:
    if not isinstance(given, list | tuple) or not 2 <= len(given) <= MOST_POINTS:
        raise ValueError(f"points: must be a list of 2 to {MOST_POINTS} pairs; {_POINTS}")
    for place, pair in enumerate(given):
        if not isinstance(pair, list | tuple) or len(pair) != 2 or not all(map(_is_number, pair)):
            raise ValueError(f"points[{place}]: must be two finite numbers, got {pair!r}; {_POINTS}")
        if not (given[place - 1][0] if place else 0.0) <= pair[0] <= 1.0:
            raise ValueError(
                f"points[{place}]: its share of the period must be from that before to 1; {_POINTS}"
            )
    if len({pair[1] for pair in given}) == 1:
        raise ValueError("points: the value never changes")
    return Form("points", (), tuple(float(number) for pair in given for number in pair))


_SUM = "a sum of harmonics is {harmonics: [{order: 1, amplitude: 1, phase: 0}, ...]}"


def _sum_of_harmonics(value: Mapping[str, Any]) -> Form:
    for key in value:
        if key != "harmonics":
            raise ValueError(f"{key}: unknown key; {_SUM}")
    terms = value.get("harmonics")
    if not isinstance(terms, list | tuple):
        raise ValueError(f"harmonics: must be a list; {_SUM}" if "harmonics" in value else _SUM)
    if not 1 <= len(terms) <= MOST_TERMS:
        raise ValueError(f"harmonics: must be 1 to {MOST_TERMS} terms, got {len(terms)}; {_SUM}")
    return Form("harmonics", tuple(_term(f"harmonics[{place}]", term) for place, term in enumerate(terms)))


def _term(where: str, value: Any) -> Term:
    if isinstance(value, Term):
        return value
    if not isinstance(value, Mapping):
        raise ValueError(f"{where}: must be a mapping such as {{order: 1, amplitude: 1}}, got {value!r}")
    for key in value:
        if key not in Term._fields:
            raise ValueError(f"{where}.{key}: unknown key; allowed: {', '.join(Term._fields)}")
    for key in ("order", "amplitude"):
        if key not in value:
            raise ValueError(f"{where}.{key}: required key is missing")
    order, amplitude, phase = value["order"], value["amplitude"], value.get("phase", 0.0)
    if not _is_number(order) or order != round(order) or not 1 <= order <= MOST_TERMS:
        raise ValueError(f"{where}.order: must be a whole number from 1 to {MOST_TERMS}, got {order!r}")
    for name, number in (("amplitude", amplitude), ("phase", phase)):
        if not _is_number(number):
            raise ValueError(f"{where}.{name}: must be a finite number, got {number!r}")
    return Term(int(order), float(amplitude), float(phase))


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)


_KINDS = "harmonics", *_SHARES, "points", "file"
_FORM_SCHEMA = {
    "oneOf": [
        {"enum": list(WAVE_SHAPES)},
        {
            "description": f"{_SUM}; {{square: {{duty: 0.3}}}}, {{sawtooth: {{width: 0.3}}}}; {_POINTS}",
            "type": "object",
            "propertyNames": {"enum": list(_KINDS)},
            "minProperties": 1,
            "maxProperties": 1,
        },
    ]
}
Waveform = Annotated[Form, PlainValidator(form_of), PlainSerializer(Form.plain), WithJsonSchema(_FORM_SCHEMA)]


def as_fraction(ratio: float) -> Fraction:
    """Return the fraction of small whole numbers that a ratio of frequencies is."""
    return Fraction(ratio).limit_denominator(LONGEST_COMMON)


def _ratio(value: Any) -> float:
    """Return the ratio that a number, or a text such as 3/2, is.

    Raises ValueError if it is no ratio of small whole numbers.
    """
    wanted = (
        f"must be p/q in whole numbers, q at most {LONGEST_COMMON} and p/q from 1/{LONGEST_COMMON} to "
        f'{LARGEST_RATIO}, such as 2, 0.5 or "3/2"'
    )
    if isinstance(value, str) and _FRACTION.fullmatch(value):
        exact = Fraction(value)
    elif _is_number(value):
        exact = Fraction(float(value))
    else:
        raise ValueError(wanted)
    near = as_fraction(float(exact))
    if not 0 < near <= LARGEST_RATIO or abs(near - exact) > 1e-9 * near:
        raise ValueError(wanted)
    return near.numerator / near.denominator


_FRACTION = re.compile(r"[0-9]{1,9}(/0*[1-9][0-9]{0,8})?")
Ratio = Annotated[
    float,
    BeforeValidator(_ratio),
    Field(gt=0),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "number", "exclusiveMinimum": 0, "maximum": LARGEST_RATIO},
                {"type": "string", "pattern": r"^[0-9]+(/[0-9]+)?$"},
            ]
        }
    ),
]
"""Frequency as a multiple of the drive's, p/q."""
