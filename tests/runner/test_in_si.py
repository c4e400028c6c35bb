"""Orbits, curves, onsets, harmonics and attractors of a scene in SI units have columns in them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from fig_4b import COULOMB

import frictionlab as fl
from frictionlab.runner.words import TOLD, in_si_words
from frictionlab.values.columns import ALSO_IN_SI, ATTRACTORS, CURVES, HARMONICS, ONSETS

BODY: dict[str, Any] = {"mass": "0.5 kg", "stiffness": "5 kN/m", "damping": "5 N s/m", "length": "1 mm"}
BODY |= {"drive": {"amplitude": "20 N", "frequency": "60 Hz"}}
LAWS = [COULOMB | {"mu": 0.3}, COULOMB | {"mu": 5, "label": "holds"}]
KEPT = {"columns": ["usual", "shape", "onsets"], "keep": {"orbit": 8, "harmonics": 2, "attractors": 2}}
SWEEP = {"scene.dimensional.belt_speed": {"start": "0 mm/s", "stop": "200 mm/s", "num": 21}}
STUDY = {"schema": 1, "scene": {"dimensional": BODY}, "laws": LAWS, "sweep": SWEEP, **KEPT}
TABLES = {"curves": CURVES, "onsets": ONSETS, "harmonics": HARMONICS, "attractors": ATTRACTORS}


def found(length: str) -> dict[str, pd.DataFrame]:
    """The tables of the study with this length scale, only what is in SI units."""
    done = fl.run(STUDY, overrides=[f"scene.dimensional.length={length}"])
    tables = {name: getattr(done, name) for name in ("orbits", *TABLES)}
    return {name: each[[n for n, _ in ALSO_IN_SI.values() if n in each]] for name, each in tables.items()}


def test_no_number_in_si_units_depends_on_the_length_scale() -> None:
    """Each column that has a dimension has one in SI units, which stays as it is in other scales."""
    one, other = found("1 mm"), found("7 um")

    for name, own in TABLES.items():
        assert {column for of, (column, _) in ALSO_IN_SI.items() if of in own} <= {*one[name]}
    assert {"tau_s", "x1_m", "v1_m_per_s", "slip_m_per_s", "load_N", "work_J"} <= {*one["orbits"]}
    for name, table in one.items():
        off, most = ((each.abs().max().to_numpy(dtype=float)) for each in (table - other[name], table))
        assert off == pytest.approx(0.0, abs=1e-9 * max(most))


def test_orbits_are_scaled_by_length_natural_frequency_and_stiffness() -> None:
    """L = 1 mm, omega_1 = 100 rad/s, K_1 = 5 kN/m."""
    body = fl.Scene.si(**BODY, belt_speed="50 mm/s")
    orbit = fl.steady_state(body, fl.Coulomb(mu=0.3)).orbit(8)

    scales = {"tau": 1e-2, "x1": 1e-3, "v1": 0.1, "slip": 0.1, "load": 5.0, "normal_load": 5.0, "work": 5e-3}
    for name, scale in scales.items():
        np.testing.assert_allclose(orbit[ALSO_IN_SI[name][0]], scale * orbit[name], rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("words", TOLD)
def test_a_sentence_with_a_number_in_the_scales_of_the_scene_is_said_somewhere(words: str) -> None:
    """Where a sentence changes, its numbers would stay nondimensional."""
    before = words.partition("(NUMBER)")[0].partition(" .* ")[0].rstrip()

    assert any(f"{before} {{" in path.read_text() for path in Path(fl.__file__).parent.rglob("*.py"))


def test_sentences_have_lengths_and_speeds_in_si_units_once() -> None:
    scales = {"length": 5e-6, "velocity": 5e-4}
    told = "tested: starts up to {} apart; points below the end of reversal, {}: 5 of the 8 needed".format
    wanted = told("1.2 mm", "3.7699 mm/s")

    assert in_si_words(told("240", "7.53982"), scales) == in_si_words(wanted, scales) == wanted
    told = "no point between belt speeds {} and {}, more than 5%".format
    assert in_si_words(told("2", "4e-3"), scales) == told("1 mm/s", "2 µm/s")


def test_what_a_curve_needs_is_told_in_the_units_of_its_scene() -> None:
    body = fl.Scene.si(**BODY, belt_speed="2 mm/s")
    found = fl.needs(body, fl.Dahl(mu=0.3, presliding_length="1 um"))

    assert "at belt speed 2 mm/s" in found.sentences[0]
    assert "presliding_length 1 µm" in repr(found) or "Coulomb" in repr(found)
