"""The table of harmonics: of every kept orbit velocity and friction by harmonics, a row each."""

from __future__ import annotations

import pandas as pd

from frictionlab.columns import BELT_SPEED, HARMONICS
from frictionlab.quantities import Floats
from frictionlab.results.curve_table import curve_inputs
from frictionlab.results.derived import beside_in_si
from frictionlab.results.part import KeptRows
from frictionlab.results.table import Inputs, scales_of_row


def harmonic_table(given: Inputs, harmonics: KeptRows) -> pd.DataFrame:
    """The inputs that are equal along a curve, the belt speed, then ``HARMONICS``; in the order of the result table.

    Columns across the belt are left out where no orbit has them.
    """
    keys = curve_inputs(given.columns)
    frames = [_rows(given, keys, row, columns) for row, columns in sorted(harmonics.items())]
    if not frames:
        return pd.DataFrame(columns=[*keys, *HARMONICS])
    return pd.concat(frames, ignore_index=True)


def _rows(given: Inputs, keys: list[str], row: int, columns: dict[str, Floats]) -> pd.DataFrame:
    head = {name: given.columns[name][row] for name in keys}
    own = {
        "belt_speed": given.columns[BELT_SPEED][row],
        **columns,
        "harmonic": columns["harmonic"].astype(int),
    }
    return pd.DataFrame(head | own | beside_in_si(own, scales_of_row(given, row)))
