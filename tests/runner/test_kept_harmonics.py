"""The harmonics that a study keeps: their file, what they add up to, and that the next run takes them over."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from fig_4b import COULOMB, LAW, SCENE, over_speeds
from pandas.testing import assert_frame_equal
from profiles import deep

import frictionlab as fl
from frictionlab.values.columns import HARMONICS

pytestmark = deep("seconds of runs")

LAWS = [COULOMB, {"kind": "coulomb", "mu": 0.1, "label": "little"}]
KEPT = {"keep": {"harmonics": 3}, "columns": ["motion", "energies"]}
STUDY = over_speeds([5.0, 25.0], laws=LAWS, methods=["exact", "mdsm"], **KEPT)


def test_a_row_for_each_harmonic_of_every_orbit(tmp_path: Path) -> None:
    ran = fl.run(STUDY, out=tmp_path / "out")
    written = pd.read_csv(tmp_path / "out" / "harmonics.csv")

    assert list(written.columns[-len(HARMONICS) :]) == list(HARMONICS)
    assert "scene.belt_speed" not in written
    rows = written[(written["law"] == "coulomb") & (written["method"] == "exact")]
    assert rows["harmonic"].tolist() == [0, 1, 2, 3] * 2
    assert rows["belt_speed"].tolist() == [5.0] * 4 + [25.0] * 4
    table = ran.table[(ran.table["law"] == "coulomb") & (ran.table["method"] == "exact")]
    first = rows[rows["harmonic"] == 1]
    np.testing.assert_allclose(first["velocity_amplitude"], table["velocity_harmonic"], rtol=1e-12)
    np.testing.assert_allclose(first["velocity_phase"], table["velocity_phase"], rtol=1e-9)
    means = rows[rows["harmonic"] == 0]
    np.testing.assert_allclose(-means["friction_amplitude"], table["mean_friction"], rtol=1e-12)
    # friction's take from the mass: of each harmonic half the product of velocity and friction in phase with it
    power = (rows["velocity_amplitude"] * rows["friction_in_phase"]).groupby(rows["belt_speed"]).sum()
    taken = table["energy_friction"].to_numpy() / (2.0 * np.pi)
    np.testing.assert_allclose(0.5 * 10.0 * power, taken, rtol=1e-2)


def test_harmonics_across_the_belt_where_there_is_motion_across() -> None:
    across = {"natural_frequency": 0.5, "damping_ratio": 0.1, "load": {"unbalance": 10}}
    state = fl.steady_state(SCENE.with_(transverse=across, belt_speed=20.0), LAW, method="mdsm")
    along, over = state.harmonics(2), state.harmonics(2, across=True)
    assert along.velocity_amplitude[1] == pytest.approx(state.velocity_harmonic)
    assert over.velocity_amplitude[1] == pytest.approx(state.transverse_velocity_harmonic)


def test_a_state_without_an_orbit_has_no_harmonics() -> None:
    state = fl.steady_state(SCENE, fl.Dahl(mu=0.4, stiffness=4.0), method="exact")
    with pytest.raises(ValueError, match="no orbit: the steady state is 'refused'"):
        state.harmonics(3)
    with pytest.raises(ValueError, match="highest must be a whole number of at least 1, got 0"):
        state.harmonics(0)


def test_the_next_run_takes_them_over_and_makes_them_again_where_they_are_gone(tmp_path: Path) -> None:
    first, again = (fl.run(STUDY, out=tmp_path / "out") for _ in range(2))
    file = tmp_path / "out" / "harmonics.csv"
    assert again.computed == 0
    assert_frame_equal(again.harmonics, pd.read_csv(file))

    file.unlink()
    made = fl.run(STUDY, out=tmp_path / "out")
    assert made.computed == 0  # from kept chunks
    assert_frame_equal(made.harmonics, first.harmonics)
