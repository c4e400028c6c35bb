"""Tables in the units in which their numbers were written; what was read of them in units of a handy size."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from frictionlab.columns import BELT_SPEEDS, IN_SI_UNITS, SHOWN_IN
from frictionlab.quantities import Written
from frictionlab.units.text import factor_of

if TYPE_CHECKING:
    import pandas as pd

SIX_DIGITS = 1e-5
"""Of a number told in a sentence what rounding may have taken, relative to it."""
_PREFIXES = {"n": 1e-9, "µ": 1e-6, "m": 1e-3, "": 1.0, "k": 1e3, "M": 1e6}


class ShownUnit(NamedTuple):
    """A unit, and its size in SI units."""

    unit: str
    size: float = 1.0

    def text(self, value: float) -> str:
        """A number in SI units in this one."""
        return f"{value / self.size:.6g} {self.unit}"


def units_written(values: Mapping[str, Any]) -> dict[str, ShownUnit]:
    """The units of those numbers, by their columns, that were written as text with one."""
    written = {name: value for name, value in values.items() if isinstance(value, Written)}
    return {
        name: ShownUnit(value.unit, float(factor_of(value.unit, value.si))) for name, value in written.items()
    }


def in_shown_units(table: pd.DataFrame, written: Mapping[str, ShownUnit]) -> pd.DataFrame:
    """The table with numbers in SI units in others, whose names say so: ``law.presliding_length in um``.

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
    """The unit with a prefix, of which the largest number is 1 to 1000; as it is where there is none."""
    if not 0.0 < largest < math.inf:
        return ShownUnit(unit)
    below = [(prefix, size) for prefix, size in _PREFIXES.items() if size <= largest * (1.0 + SIX_DIGITS)]
    prefix, size = below[-1] if below else ("n", 1e-9)
    return ShownUnit(f"{prefix}{unit}", size)
