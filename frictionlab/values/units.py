"""Numbers with units: texts such as ``2 mm/s`` in SI units, and tables shown in the units that were written.

Conversion is by pint, which is imported where such a text is read. Its registry is made of the units below alone: in
it an angle has a dimension, so that 60 Hz are 60 cycles a second and never 60 rad/s, and 60 1/s is neither.

Tables in the units in which their numbers were written; what was read of them in units of a handy size.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

from frictionlab.values.columns import BELT_SPEEDS, IN_SI_UNITS, SHOWN_IN
from frictionlab.values.notes import Unfit
from frictionlab.values.quantities import Dimension, Written

if TYPE_CHECKING:
    import pandas as pd


DEFINITIONS = """
nano- = 1e-9 = n-
micro- = 1e-6 = u- = µ- = μ-
milli- = 1e-3 = m-
centi- = 1e-2 = c-
kilo- = 1e3 = k-
mega- = 1e6 = M-
meter = [length] = m = metre
second = [time] = s = sec
gram = [mass] = g
radian = [angle] = rad
percent = 0.01
minute = 60 * second = min
hour = 3600 * second = h
turn = 6.283185307179586476925286766559005768 * radian
degree = turn / 360 = deg
hertz = turn / second = Hz
revolutions_per_minute = turn / minute = rpm
newton = kilogram * meter / second ** 2 = N
newton_meter = newton * meter = Nm
newton_second = newton * second = Ns
micron = 1e-6 * meter
joule = newton * meter = J
standard_gravity = 9.80665 * meter / second ** 2 = g_0
tonne = 1000 * kilogram = t
inch = 0.0254 * meter = in
foot = 0.3048 * meter = ft
pound = 0.45359237 * kilogram = lb
pound_force = pound * standard_gravity = lbf
"""
ALLOWED = (
    "m, s, min, h, g, t, N, J, Hz, rpm, rad, deg, %, g_0, in, ft, lb and lbf, with n, u, m, c, k or M before them, "
    "their products, with a space as in N mm, and quotients"
)
NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?"
_FACTOR = r"(?:[^\W\d_]+(?:_0)?|%|°)(?:(?:\^|\*\*)?-?[1-9]|[⁻]?[¹²³])?"
_TEXT = re.compile(
    rf"\s*(?P<number>{NUMBER})\s*(?P<unit>(?:1?\s*/\s*)?{_FACTOR}(?:\s*[*·/]\s*{_FACTOR}|\s+{_FACTOR})*)\s*"
)
_THOUSANDS = re.compile(r"[+-]?\d{1,3}(?:[ ,']\d{3})+(?:\D.*)?")
_POWER = re.compile(r"(?<=[^\W\d_]|%|°)(?:\^|\*\*)?(-?[1-9])")
_BASE = {"force": "N", "length": "m", "time": "s"}
_PLAIN = str.maketrans("⁻¹²³·", "-123*")


class Kind(NamedTuple):
    """Kind of number: a word for it, its unit and how a person writes one."""

    word: str
    unit: str
    example: str

    def __str__(self) -> str:
        """With the unit."""
        return f"{self.word} [{self.unit}]" if self.unit else self.word


QUANTITIES = [
    Kind("a speed", "m/s", "2 mm/s"),
    Kind("a length", "m", "5 um"),
    Kind("a frequency", "rad/s", "60 Hz"),
    Kind("a mass", "kg", "0.5 kg"),
    Kind("a force", "N", "20 N"),
    Kind("a stiffness", "N/m", "5 kN/m"),
    Kind("a damping coefficient", "N s/m", "5 N s/m"),
    Kind("an acceleration", "m/s^2", "3 m/s^2"),
    Kind("an unbalance, mass times length", "kg m", "3 kg mm"),
    Kind("an angle", "deg", "90 deg"),
    Kind("a stiffness per force, or a curvature", "1/m", "40 1/mm"),
    Kind("a cubic stiffness", "N/m^3", "5 N/mm^3"),
    Kind("a damping by amplitude", "N s/m^3", "2 N s/mm^3"),
    Kind("a time over a length", "s/m", "0.1 s/m"),
    Kind("a time", "s", "2 s"),
    Kind("an energy", "J", "2 mJ"),
    Kind("one over a time (Hz and rpm count cycles, rad/s angles)", "1/s", "1 1/s"),
    Kind("a number without a dimension", "", "30 %"),
]


def in_units(text: str, unit: str) -> float | Unfit:
    """Return the number that a text with a unit is in this one; what is wrong with it where it is none.

    It keeps the text where it has a dimension.
    """
    example = quantity_in(unit).example
    if not (read := _TEXT.fullmatch(text)):
        return Unfit(text, f"must be a number, or text with a unit such as {example}{_meant(text.strip())}")
    try:
        number = float(Fraction(read["number"]) * factor_of(read["unit"], unit))
        shown = f"{read['number']} {read['unit']}"
        return Written(number, shown, unit) if unit not in ("", "deg") else number
    except _Wrong as problem:
        return Unfit(text, f"'{text.strip()}' {problem}")
    except OverflowError:
        return Unfit(text, "must be a finite number")


def _meant(text: str) -> str:
    """Return what to write where digits are parted by commas or spaces, as the end of a sentence."""
    whole = re.sub(r"(?<=\d)[ ,'](?=\d)", "", text) if _THOUSANDS.fullmatch(text) else ""
    meant = [each for each in (whole, text.replace(",", ".", 1)) if _TEXT.fullmatch(each)]
    return f"; write {' or '.join(meant)}" if meant else ""


def number_before_unit(text: str) -> float | str:
    """Return the number of a text with whatever unit; the text where it is none."""
    read = _TEXT.fullmatch(text)
    return float(Fraction(read["number"])) if read else text


def dimension_of(text: Any) -> Dimension | None:
    """Return the dimension of a text with a unit; None of anything else, and of an unknown unit."""
    import pint

    if not isinstance(text, str) or not (read := _TEXT.fullmatch(text)):
        return None
    try:
        powers = {str(name)[1:-1]: int(power) for name, power in _parsed(read["unit"]).dimensionality.items()}
    except pint.UndefinedUnitError:
        return None
    force, length, time = (powers.get(name, 0) for name in ("mass", "length", "time"))
    return Dimension(force, length - force, time + 2 * force)


def in_units_of_law(text: str, name: str, units: Mapping[str, str]) -> float | Unfit:
    """Number of a text for a parameter of a law; of one that is not per unit normal load, where that belongs.

    units: of all its parameters.
    """
    found, contact = in_units(text, units[name]), f"contact_{name}"
    if isinstance(found, Unfit) and isinstance(in_units(text, units.get(contact, units[name])), float):
        return Unfit(text, f"{found.what}; {contact} takes what is not per unit normal load")
    return found


def unit_of_dimension(dimension: Dimension) -> str:
    """Return the unit of a number with this dimension."""
    powers = [(unit, getattr(dimension, name)) for name, unit in _BASE.items()]
    over = " ".join(_power(unit, power) for unit, power in powers if power > 0)
    under = [_power(unit, -power) for unit, power in powers if power < 0]
    return "/".join([over or ("1" if under else ""), *under])


def _power(unit: str, power: int) -> str:
    return unit if power == 1 else f"{unit}^{power}"


def quantity_in(unit: str) -> Kind:
    """Return what a number in this unit is."""
    return next((kind for kind in QUANTITIES if kind.unit == unit), Kind("a number", unit, f"2 {unit}"))


class _Wrong(ValueError):
    """A unit that is unknown or of another kind, as the end of a sentence."""


@cache
def factor_of(given: str, wanted: str) -> Fraction:
    """By which a number in a unit is multiplied to be in another. Raises _Wrong."""
    import pint

    try:
        unit = _parsed(given)
    except pint.UndefinedUnitError as problem:
        names = [problem.unit_names] if isinstance(problem.unit_names, str) else problem.unit_names
        raise _Wrong(f"has the unknown unit {' and '.join(map(repr, names))}; allowed: {ALLOWED}") from None
    try:
        return _registry().convert(Fraction(1), unit, _parsed(wanted))
    except pint.DimensionalityError:
        raise _Wrong(f"is {_kind_of(unit, given)}; give {quantity_in(wanted)}{_such_as(wanted)}") from None


def _such_as(unit: str) -> str:
    return f" such as {quantity_in(unit).example}"


def _kind_of(unit: Any, given: str) -> str:
    """Return what a number in a unit is, in words."""
    own = unit.dimensionality
    return next((str(kind) for kind in QUANTITIES if _parsed(kind.unit).dimensionality == own), f"in {given}")


def _parsed(unit: str) -> Any:
    """Return the unit as pint has it. Raises pint.UndefinedUnitError."""
    plain = _POWER.sub(r"**\1", unit.translate(_PLAIN)).replace("%", "percent").replace("°", "degree")
    return _registry().parse_units(f"1{plain.strip()}" if plain.strip().startswith("/") else plain)


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry(DEFINITIONS.strip().splitlines(), non_int_type=Fraction, cache_folder=None)


SIX_DIGITS = 1e-5
"""Rounding of a number told in a sentence, relative to it."""
_PREFIXES = {"n": 1e-9, "µ": 1e-6, "m": 1e-3, "": 1.0, "k": 1e3, "M": 1e6}


class ShownUnit(NamedTuple):
    """A unit, and its size in SI units."""

    unit: str
    size: float = 1.0

    def text(self, value: float) -> str:
        """A number in SI units in this one."""
        return f"{value / self.size:.6g} {self.unit}"


def units_written(values: Mapping[str, Any]) -> dict[str, ShownUnit]:
    """Return the units of those numbers, by their columns, that were written as text with one."""
    written = {name: value for name, value in values.items() if isinstance(value, Written)}
    return {
        name: ShownUnit(value.unit, float(factor_of(value.unit, value.si))) for name, value in written.items()
    }


def in_shown_units(table: pd.DataFrame, written: Mapping[str, ShownUnit]) -> pd.DataFrame:
    """Return the table with numbers in SI units in others, whose names say so: ``law.presliding_length in um``.

    written: the units of inputs, by their columns; without any the table stays as it is. Of what was found a speed is
    in the unit of the belt speed, all else in one of which the largest is 1 to 1000.
    """
    if not written:
        return table
    chosen = {name: unit for name, unit in written.items() if name in table}
    found = {name: unit for name, unit in IN_SI_UNITS.items() if name in table}
    speed = written.get(BELT_SPEEDS[1], ShownUnit("m/s"))
    handy = {
        name: handy_unit(unit, float(table[name].abs().max()))
        for name, unit in found.items()
        if unit != "m/s"
    }
    chosen |= {name: handy.get(name.replace("_error", ""), speed) for name in found}
    shown = table.assign(**{name: table[name] / unit.size for name, unit in chosen.items()})
    shown = shown.rename(columns={name: f"{name}{SHOWN_IN}{unit.unit}" for name, unit in chosen.items()})
    shown.attrs = table.attrs
    return shown


def as_shown(
    table: pd.DataFrame, units: Mapping[str, ShownUnit], words: Mapping[str, Mapping[str, str]]
) -> pd.DataFrame:
    """A table of a run in the units in which it is shown, laws and methods in words, as pages and figures have it."""
    said = {name: table[name].replace(told) for name, told in words.items() if name in table and told}
    return in_shown_units(table.assign(**said) if said else table, units)


def handy_unit(unit: str, largest: float) -> ShownUnit:
    """Return the unit with a prefix, of which the largest number is 1 to 1000; as it is where there is none."""
    if not 0.0 < largest < math.inf:
        return ShownUnit(unit)
    below = [(prefix, size) for prefix, size in _PREFIXES.items() if size <= largest * (1.0 + SIX_DIGITS)]
    prefix, size = below[-1] if below else ("n", 1e-9)
    return ShownUnit(f"{prefix}{unit}", size)
