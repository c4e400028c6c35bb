"""Orbits, curves, onsets, harmonics and attractors of a scene in SI units have columns in them."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

import frictionlab as fl
from frictionlab.columns import ALSO_IN_SI, ATTRACTORS, CURVES, HARMONICS, ONSETS

STUDY = {
    "schema": 1,
    "scene": {
        "dimensional": {
            "mass": "0.5 kg",
            "stiffness": "5 kN/m",
            "damping": "5 N s/m",
            "length": "1 mm",
            "drive": {"amplitude": "20 N", "frequency": "60 Hz"},
        }
    },
    "laws": [{"kind": "coulomb", "mu": 0.3}],
    "sweep": {"scene.dimensional.belt_speed": {"start": "1 mm/s", "stop": "200 mm/s", "num": 20}},
    "columns": ["usual", "shape", "onsets"],
    "keep": {"orbit": 8, "harmonics": 2, "attractors": 2},
}


def found(length: str) -> dict[str, pd.DataFrame]:
    """The tables of the study with this length scale, only what is in SI units."""
    done = fl.run(STUDY, overrides=[f"scene.dimensional.length={length}"])
    tables = {
        "orbits": done.orbits,
        "curves": done.curves,
        "onsets": done.onsets,
        "harmonics": done.harmonics,
    }
    tables |= {"attractors": done.attractors}
    return {name: each[[n for n, _ in ALSO_IN_SI.values() if n in each]] for name, each in tables.items()}


def test_no_number_in_si_units_depends_on_the_length_scale() -> None:
    """Each column that has a dimension has one in SI units, which stays as it is in other scales."""
    one, other = found("1 mm"), found("7 um")

    for name, own in (
        ("curves", CURVES),
        ("onsets", ONSETS),
        ("harmonics", HARMONICS),
        ("attractors", ATTRACTORS),
    ):
        assert {column for of, (column, _) in ALSO_IN_SI.items() if of in own} <= {*one[name]}
    assert {"tau_s", "x1_m", "v1_m_per_s", "slip_m_per_s", "load_N", "work_J"} <= {*one["orbits"]}
    for name, table in one.items():
        sizes = table.abs().max().to_numpy(dtype=float)
        assert np.abs((table - other[name]).to_numpy(dtype=float)).max(axis=0) == pytest.approx(
            0.0, abs=1e-9 * max(sizes)
        )
